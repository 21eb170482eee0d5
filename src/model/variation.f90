!> Problems that differ in the values of parameters, for fits, and problems with one parameter
!> varied, with a rule for derivatives by finite differences. With this rule laws, shapes and bodies
!> need no formulas for derivatives by parameters. Reported derivatives are of sixth order; for a
!> search second order suffices.
module variation
  use kinds, only: wp
  use failure, only: failure_t
  use dimensionless_problem, only: problem_t, calm_gap
  use interpolation, only: polynomial_slope
  implicit none
  private
  public :: problem_family_t, parameter_t, variation_t, vary, find_rule, to_report, to_search

  !> A parameter: its value in the present problem, in SI units, and its scale, which is the value
  !> unless the value is zero. follows: the value is a factor that multiplies the parameter's
  !> default, which may depend on other parameters.
  type :: parameter_t
    character(len=:), allocatable :: name
    real(wp) :: value = 0, scale = 1
    logical :: follows = .false.
  end type parameter_t

  type, abstract :: problem_family_t
    type(parameter_t), allocatable :: parameter(:)
  contains
    !> Makes the problem with other values of the parameters; fails if a value is not allowed.
    procedure(pose_problem), deferred :: pose
  end type problem_family_t

  abstract interface
    subroutine pose_problem(self, value, problem, error)
      import :: problem_family_t, problem_t, failure_t, wp
      class(problem_family_t), intent(in) :: self
      real(wp), intent(in) :: value(:)
      type(problem_t), intent(out) :: problem
      type(failure_t), allocatable, intent(out) :: error
    end subroutine pose_problem
  end interface

  !> Number of varied problems on either side of the present one, and for each number the step
  !> between two problems, relative to the parameter's scale. For h^-n the error of differences of
  !> sixth order is about n^7/140 step^6, which is smaller than their rounding error of about
  !> 1e-16/step. Differences of second order have an error of n^3/6 step^2, which leaves six digits.
  integer, parameter :: to_report = 3, to_search = 1
  real(wp), parameter :: step(to_report) = [1.0e-4_wp, 1.0e-3_wp, 1.0e-3_wp]
  !> For reported derivatives of pressures and heights: the relative difference of the two rules
  !> above which a quarter of the step is tried, and the smallest step.
  real(wp), parameter :: coarse = 1.0e-6_wp, least_step = 1.0e-7_wp

  type :: variation_t
    type(parameter_t) :: parameter
    !> Difference of the parameter from its value in each problem, in SI units.
    real(wp), allocatable :: offset(:)
    !> The rule dQ/dp = sum(weight*Q), and the same without the outermost points. The difference of
    !> the two is the error estimate.
    real(wp), allocatable, dimension(:) :: weight, coarser
    !> Allocatable because of compiler note 11.
    type(problem_t), allocatable :: problem(:)
  end type variation_t

contains

  !> Varies parameter i with `aside` problems on either side, `to_report` or `to_search`. For
  !> reported derivatives the step is so short that pressures and heights, which may depend steeply
  !> on the parameter, change smoothly. If the range of the parameter ends nearby, all problems are
  !> on one side. It fails if neither side is allowed.
  subroutine vary(family, i, aside, varied, error)
    class(problem_family_t), intent(in) :: family
    integer, intent(in) :: i, aside
    type(variation_t), intent(out) :: varied
    type(failure_t), allocatable, intent(out) :: error
    type(problem_t) :: problem
    real(wp) :: apart

    varied%parameter = family%parameter(i)
    allocate (varied%problem(0))
    apart = step(aside)
    if (aside == to_report) call family%pose(family%parameter%value, problem, error)
    if (allocated(error)) return
    do
      call pose_beside(i)
      if (allocated(error)) return
      call find_rule(varied%offset, varied%weight, varied%coarser)
      if (aside < to_report .or. apart < least_step) return
      if (is_smooth()) return
      apart = 0.25_wp*apart
    end do

  contains

    !> Makes the problems at distances `apart`, relative to the parameter's scale.
    subroutine pose_beside(i)
      integer, intent(in) :: i
      real(wp) :: value(size(family%parameter))
      integer :: shift, k

      do shift = 0, 2
        varied%offset = [(real(k + aside*merge(-1, shift, shift == 2), wp), k=-aside, aside)]
        ! With problems on both sides the present problem has no weight.
        if (shift == 0) varied%offset = pack(varied%offset, abs(varied%offset) > 0)
        varied%offset = apart*varied%parameter%scale*varied%offset
        deallocate (varied%problem)
        allocate (varied%problem(size(varied%offset)))
        do k = 1, size(varied%offset)
          value = family%parameter%value
          value(i) = value(i) + varied%offset(k)
          call family%pose(value, varied%problem(k), error)
          if (allocated(error)) exit
        end do
        if (.not. allocated(error)) return
      end do
    end subroutine pose_beside

    !> Whether the two rules agree for the pressures at many separations, including those within the
    !> step of a law, and for the heights of the shape.
    logical function is_smooth()
      integer, parameter :: tried = 40
      real(wp), parameter :: nearest = 0.1_wp
      real(wp), allocatable :: gap(:), separation(:), r(:), pressure(:, :), height(:, :)
      real(wp) :: from
      integer :: k

      associate (law => problem%law)
        from = max(law%rest_gap, nearest)
        gap = from*(calm_gap(problem)/from)**[(k/(tried - 1.0_wp), k=0, tried - 1)]
        r = [(problem%lateral*problem%shape%position_of(gap(k)), k=1, tried)]
        if (law%step_width > 0) gap = [gap, law%step_at + law%step_width*[(k/4.0_wp, k=-12, 12)]]
        separation = law%separation_of(gap)
      end associate
      allocate (pressure(size(separation), size(varied%offset)), height(tried, size(varied%offset)))
      do k = 1, size(varied%offset)
        associate (other => varied%problem(k))
          pressure(:, k) = other%pressure*other%law%pressure(other%law%gap_of(separation))
          height(:, k) = other%length*other%shape%height(r/other%lateral)
        end associate
      end do
      is_smooth = agree(pressure) .and. agree(height)
    end function is_smooth

    !> Whether the two rules agree for values in the varied problems, except for rounding errors,
    !> and whether the largest value changes little.
    logical function agree(value)
      real(wp), intent(in) :: value(:, :)
      real(wp), parameter :: rounding = 1.0e-14_wp, little = 0.05_wp
      real(wp) :: most(size(value, 2))

      most = maxval(abs(value), 1)
      agree = maxval(most) - minval(most) <= little*maxval(most) .and. maxval(abs(matmul(value, &
        varied%weight - varied%coarser))) <= coarse*maxval(abs(matmul(value, varied%weight))) + &
        rounding*maxval(most)*sum(abs(varied%weight))
    end function agree

  end subroutine vary

  !> The rule for the slope at 0 from values at `offset`: sum(weight*value), and the same without
  !> the outermost two.
  pure subroutine find_rule(offset, weight, coarser)
    real(wp), intent(in) :: offset(:)
    real(wp), allocatable, dimension(:), intent(out) :: weight, coarser
    real(wp) :: one(size(offset))
    integer :: k

    weight = 0*offset
    coarser = 0*offset
    do k = 1, size(one)
      one = 0
      one(k) = 1
      weight(k) = polynomial_slope(offset, one, 0.0_wp)
      if (size(one) > 3 .and. k > 1 .and. k < size(one)) coarser(k) = &
        polynomial_slope(offset(2:size(one) - 1), one(2:size(one) - 1), 0.0_wp)
    end do
  end subroutine find_rule

end module variation
