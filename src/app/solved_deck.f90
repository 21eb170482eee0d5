!> Equilibria of a deck for other Fortran programs. The input is the text of a deck; the output is
!> loads, profiles and summary, as the program computes them, without files. An example is
!> examples/one_state.f90.
module solved_deck
  use kinds, only: wp
  use failure, only: failure_t, fail, bad_input
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t
  use contact_state, only: state_t
  use records, only: record_t, observer_t
  use state_profile, only: state_profile_t, profile_of
  use scene, only: scene_t, read_scene
  use scene_problem, only: problem_of
  use experiment, only: run_experiment
  use experiment_result, only: experiment_result_t
  use summary, only: summary_t
  use summarise, only: summary_of
  use result_folder, only: to_stream
  use preflight, only: check_room
  use linear_algebra, only: claim_buffers
  implicit none
  private
  public :: solved_state_t, solved_deck_t, solve_deck

  !> Groups whose results are written to files only.
  character(len=*), parameter :: of_files(*) = [character(len=11) :: 'fit', 'measurement', &
    'sensitivity', 'stability']

  !> An equilibrium: its row of the curve (h0, h_centre, load, contact_radius, ... in SI units) and
  !> its profile.
  type, extends(record_t) :: solved_state_t
    type(state_profile_t) :: profile
  end type solved_state_t

  !> The equilibria that &profiles asks for, in the order of the curve; at one h0 there may be
  !> several. The summary has the numbers of summary.nml with their errors, such as
  !> `profiles_error`, and warnings. If `converged` is .false., no result is reliable.
  type, extends(observer_t) :: solved_deck_t
    type(solved_state_t), allocatable :: state(:)
    type(summary_t) :: summary
    logical :: converged = .false.
  contains
    procedure :: take
  end type solved_deck_t

contains

  !> Solves a deck, given as text. error: the deck is wrong, it asks for no profiles or for results
  !> that are written to files only, or memory does not suffice.
  subroutine solve_deck(text, solved, error)
    character(len=*), intent(in) :: text
    type(solved_deck_t), intent(out) :: solved
    type(failure_t), allocatable, intent(out) :: error
    type(scene_t) :: scene
    type(problem_t) :: problem
    type(experiment_result_t) :: outcome
    integer :: i

    allocate (solved%state(0))
    call read_scene('deck', scene, error, text)
    if (allocated(error)) return
    do i = 1, size(of_files)
      if (scene%deck%has_group(trim(of_files(i)))) call fail(error, bad_input, 'deck: the ' // &
        'results of &' // trim(of_files(i)) // ' are files; run the deck with the program')
    end do
    if (.not. allocated(scene%profile_h0)) call fail(error, bad_input, &
      'deck: &profiles is missing, which says at which h0 the states are wanted')
    if (.not. allocated(error)) call check_room(scene, to_stream, error)
    if (allocated(error)) return
    problem = problem_of(scene)
    if (.not. problem%rigid) call claim_buffers()
    call run_experiment(scene, problem, solved, outcome)
    solved%summary = summary_of(scene, problem, outcome)
    solved%converged = solved%summary%is_true('converged')
  end subroutine solve_deck

  !> Keeps the states that have a profile.
  subroutine take(self, record, problem, grid, state, profile)
    class(solved_deck_t), intent(inout) :: self
    type(record_t), intent(in) :: record
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state
    logical, intent(in) :: profile
    type(solved_state_t), allocatable :: longer(:)

    if (.not. profile) return
    ! Not by an array constructor: compiler note 1.
    allocate (longer(size(self%state) + 1))
    longer(:size(self%state)) = self%state
    longer(size(longer))%record_t = record
    longer(size(longer))%profile = profile_of(problem, grid, state)
    call move_alloc(longer, self%state)
  end subroutine take

end module solved_deck
