!> ring_image DECK STRENGTH DEPTH: a deck's experiments with bodies that are not homogeneous, for
!> tests of what only knows a body by its `elastic_body`. Beside the half-space's kernel they have
!> that of its pressures' image at a depth [m], STRENGTH times
!>
!>     2 Int exp(-depth k) J0(k r) J0(k t) dk = 4 K(m)/(pi s),  s^2 = (r + t)^2 + depth^2 ,
!>
!> with m = 4 r t/s^2. Prints the rows of the curve, with eigenvalues for &stability, and the
!> summary, its derivatives, and the load and the contact radius at every place with their errors.
module ring_image_body
  use kinds, only: wp
  use elastic_body, only: elastic_body_t
  implicit none
  private
  public :: ring_image_t

  !> Strength; depth in lateral units.
  type, extends(elastic_body_t) :: ring_image_t
    real(wp) :: strength = 0, depth = 1
  contains
    procedure :: is_homogeneous
    procedure :: beside_half_space
    procedure :: growth
    procedure :: mean_beside
    procedure :: wave_range
  end type ring_image_t

contains

  pure logical function is_homogeneous(self)
    class(ring_image_t), intent(in) :: self

    is_homogeneous = .false.
  end function is_homogeneous

  pure function beside_half_space(self, k) result(value)
    class(ring_image_t), intent(in) :: self
    real(wp), intent(in) :: k(:)
    real(wp) :: value(size(k))

    value = self%strength*exp(-self%depth*k)
  end function beside_half_space

  pure function growth(self, k) result(value)
    class(ring_image_t), intent(in) :: self
    real(wp), intent(in) :: k(:)
    real(wp) :: value(size(k))

    value = -self%depth*k*self%beside_half_space(k)
  end function growth

  elemental real(wp) function mean_beside(self, k)
    class(ring_image_t), intent(in) :: self
    real(wp), intent(in) :: k

    mean_beside = self%strength*(1 - exp(-self%depth*k))/(self%depth*k)
  end function mean_beside

  pure function wave_range(self, digits) result(k)
    class(ring_image_t), intent(in) :: self
    real(wp), intent(in) :: digits
    real(wp) :: k(2)

    k = [1, 32]/self%depth
  end function wave_range

end module ring_image_body

!> Prints each state.
module printing_observer
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t
  use contact_state, only: state_t
  use equilibrium, only: cost_t
  use stability, only: smallest_eigenvalue
  use records, only: observer_t, record_t
  use tables, only: curve_row
  implicit none
  private
  public :: printing_observer_t

  type, extends(observer_t) :: printing_observer_t
    logical :: eigenvalues = .false.
  contains
    procedure :: take
  end type printing_observer_t

contains

  subroutine take(self, record, problem, grid, state, profile)
    class(printing_observer_t), intent(inout) :: self
    type(record_t), intent(in) :: record
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state
    logical, intent(in) :: profile
    type(cost_t) :: cost
    real(wp) :: eigenvalue
    logical :: certain

    eigenvalue = 0
    if (self%eigenvalues) call smallest_eigenvalue(problem, grid, state, eigenvalue, certain, cost)
    print '(a, es25.16)', 'row,' // curve_row(record) // ',', eigenvalue
  end subroutine take

end module printing_observer

program ring_image
  use kinds, only: wp
  use failure, only: failure_t
  use dimensionless_problem, only: problem_t
  use scene_groups, only: scene_t
  use scene, only: read_scene
  use scene_problem, only: problem_of
  use experiment, only: run_experiment
  use experiment_result, only: experiment_result_t
  use reported_place, only: of_load, of_radius
  use reported_values, only: readings_t, read_numbers
  use summarise, only: summary_of
  use summary, only: summary_t, summary_text
  use ring_image_body, only: ring_image_t
  use printing_observer, only: printing_observer_t
  implicit none

  type(scene_t) :: scene
  type(problem_t) :: problem
  type(experiment_result_t) :: outcome
  type(summary_t) :: summary
  type(printing_observer_t) :: observer
  type(failure_t), allocatable :: error
  character(len=1000) :: file, number(2)
  real(wp) :: strength, depth
  integer :: k

  call get_command_argument(1, file)
  call get_command_argument(2, number(1))
  call get_command_argument(3, number(2))
  read (number(1), *) strength
  read (number(2), *) depth
  call read_scene(trim(file), scene, error)
  if (allocated(error)) error stop 'the deck is wrong'
  problem = problem_of(scene)
  call give_body(problem)
  observer%eigenvalues = scene%stability
  call run_experiment(scene, problem, observer, outcome)
  summary = summary_of(scene, problem, outcome)
  print '(a)', summary_text(summary)
  do k = 1, merge(size(outcome%places%entry), 0, allocated(outcome%places%entry))
    associate (name => outcome%places%entry(k)%name)
      if (any(outcome%places%entry(:k - 1)%name == name)) cycle
      call tell_place(of_load, 'load')
      call tell_place(of_radius, 'radius')
    end associate
  end do

contains

  !> Prints the values of a quantity at the places of the name of entry k, then their errors.
  subroutine tell_place(quantity, what)
    integer, intent(in) :: quantity
    character(len=*), intent(in) :: what
      type(readings_t) :: found

    associate (name => outcome%places%entry(k)%name)
      found = read_numbers(outcome%places, problem, name, quantity)
      print '(5a, *(es25.16))', 'place,', trim(name), ',', what, ',', found%value, found%error
    end associate
  end subroutine tell_place

  subroutine give_body(to)
    type(problem_t), intent(inout) :: to

    if (strength > 0 .or. strength < 0) then
      deallocate (to%body)
      allocate (to%body, source=ring_image_t(strength, depth/to%lateral))
    end if
  end subroutine give_body

end program ring_image
