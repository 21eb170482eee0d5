!> Empty cases, and a worker that sleeps.
module empty_cases
  use, intrinsic :: iso_c_binding, only: c_int
  use kinds, only: wp
  use clock, only: time => seconds
  use c_library, only: c_pause
  use byte_record, only: byte_record_t
  use dispatch, only: foreman_t, worker_t
  use sweep_case, only: case_t, pass_case
  implicit none
  private
  public :: counter_t, sleeper_t

  !> Cases without content.
  type, extends(foreman_t) :: counter_t
    integer :: left = 0
  contains
    procedure :: put_next
    procedure :: take_answer
  end type counter_t

  !> Sleeps for every case; answers with `case` if there is one.
  type, extends(worker_t) :: sleeper_t
    real(wp) :: milliseconds = 0
    type(case_t), allocatable :: case
  contains
    procedure :: work
  end type sleeper_t

contains

  subroutine put_next(self, batch, found)
    class(counter_t), intent(inout) :: self
    type(byte_record_t), intent(inout) :: batch
    logical, intent(out) :: found
    real(wp), allocatable :: values(:)

    found = self%left > 0
    if (.not. found) return
    call batch%pass(self%left)
    values = [1.0_wp, 2.0_wp]
    call batch%pass(values)
    self%left = self%left - 1
  end subroutine put_next

  subroutine take_answer(self, answers)
    class(counter_t), intent(inout) :: self
    type(byte_record_t), intent(inout) :: answers
    integer :: number

    call answers%pass(number)
    if (number <= self%left) error stop 'an answer to what was not asked'
  end subroutine take_answer

  subroutine work(self, job, cases, batch, answers, seconds)
    class(sleeper_t), intent(inout) :: self
    integer, intent(in) :: job, cases
    type(byte_record_t), intent(inout) :: batch, answers
    real(wp), intent(out) :: seconds
    real(wp), allocatable :: values(:)
    integer :: number, i

    seconds = time()
    if (job /= 1) error stop 'there is one job'
    if (self%milliseconds > 0) call c_pause(nint(1000*cases*self%milliseconds, c_int))
    seconds = time() - seconds
    if (self%milliseconds < 0) seconds = -0.001_wp*cases*self%milliseconds
    do i = 1, cases
      call batch%pass(number)
      call batch%pass(values)
      if (allocated(self%case)) then
        self%case%number = number
        self%case%values = values
        call pass_case(answers, self%case)
      else
        call answers%pass(number)
      end if
    end do
  end subroutine work

end module empty_cases

!> mpirun -n RANKS dispatcher CASES MILLISECONDS [FOLDER]: measures the time for handing out cases.
!> A case is a sleep of MILLISECONDS, or empty; a negative value means an empty case that is
!> reported to take that long. With a folder the cases are those of a sweep over two keys, whose
!> rows and journal are written there as by the program; the numbers are those of one scene. Output,
!> one line: processes that work, cases, milliseconds, total seconds, messages (0: not counted).
program dispatcher
  use kinds, only: wp
  use failure, only: failure_t
  use clock, only: time => seconds
  use c_library, only: c_prepare
  use progress, only: progress_t
  use mesh_store, only: mesh_store_t
  use scene, only: scene_t, read_scene
  use scene_problem, only: problem_of
  use results, only: results_t
  use ranks, only: crew_t
  use empty_cases, only: counter_t, sleeper_t
  use dispatch, only: hand_out, work_through, dismiss
  use sweep_case, only: run_case, sweep_tally_t
  use sweeps, only: run_sweep
  use joint_fit, only: joint_fit_t
  implicit none

  !> A million cases at most, of which the requested number is handed out.
  character(len=*), parameter :: deck = '&bodies radius = 1e-6, stiffness = 1e10 / ' // &
    '&force law = ''lennard_jones'', hamaker = 1e-19, z0 = 3e-10 / ' // &
    '&equilibrium_path h0_end = -1e-9 / &sweep scale = ''log'', ' // &
    'key = ''bodies.stiffness'', ''force.hamaker'', from = 1e8, 1e-20, to = 1e11, 1e-19, count = '

  type(crew_t) :: crew
  type(counter_t) :: counter
  type(sleeper_t) :: sleeper
  type(scene_t) :: scene
  type(results_t) :: results
  type(sweep_tally_t) :: tally
  type(joint_fit_t) :: joint
  type(mesh_store_t) :: store
  type(progress_t) :: unseen
  type(failure_t), allocatable :: error
  character(len=200) :: argument
  real(wp) :: began
  integer :: cases, messages

  call c_prepare()
  call get_command_argument(1, argument)
  read (argument, *) cases
  call get_command_argument(2, argument)
  read (argument, *) sleeper%milliseconds
  call get_command_argument(3, argument)
  call crew%begin(error)
  if (allocated(error)) error stop 'start this by mpirun, with two processes or more'
  if (argument /= '') then
    write (argument(150:), '(i0, a, i0)') max(2, cases/1000), ',', min(1000, cases/2)
    call read_scene('bench', scene, error, deck // trim(argument(150:)) // ' /')
    if (allocated(error)) error stop 'the deck of the measurement is wrong'
    argument(150:) = ''
    if (crew%rank > 0) then
      allocate (sleeper%case)
      sleeper%case%number = 1
      sleeper%case%values = scene%sweep%values(1)
      call run_case(scene, unseen, store, sleeper%case)
    else
      call results%open(trim(argument), scene, 'bench', problem_of(scene), 'bench', .false., error)
      if (allocated(error)) error stop 'cannot write there'
    end if
  end if
  ! All processes have reached this point.
  if (crew%first_of(.true.) < crew%rank) then
    call work_through(crew, sleeper)
  else
    began = time()
    messages = 0
    if (argument == '') then
      counter%left = cases
      call hand_out(crew, 1, counter, 1, messages)
    else
      call run_sweep(scene, crew, 1, results, tally, joint)
      cases = scene%sweep%cases()
    end if
    began = time() - began
    if (argument /= '') call results%finish(error)
    call dismiss(crew)
    print '(i0, 1x, i0, 1x, g0, 1x, f0.4, 1x, i0)', crew%workers, cases, sleeper%milliseconds, &
      began, messages
  end if
  call crew%end()

end program dispatcher
