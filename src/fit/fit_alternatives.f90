!> Other fits to data that the model does not describe: with another spring constant, to the retract
!> alone, to the approach alone. If one of them describes its data, it shows which assumption is
!> wrong.
module fit_alternatives
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use variation, only: problem_family_t
  use fit_request, only: unknown_t, of_spring, of_position
  use baseline, only: ways_in
  use measured_curve, only: measured_curve_t
  use measured_jumps, only: find_jump
  use part_slopes, only: slopes_of_parts
  use fit_starts, only: starts_like
  use theory_fits, only: suggested_characters
  use force_model, only: force_model_t
  use modelled_curve, only: modelled_curve_t
  use curve_fit, only: fit_curve
  use fit_errors, only: fitted_t
  implicit none
  private
  public :: alternative_t, find_alternative, contact_slope

  !> An alternative that describes the data. name: 'retract', 'approach', or 'spring_constant'; for
  !> the latter, value and error of the spring constant [N/m].
  type :: alternative_t
    character(len=:), allocatable :: name
    real(wp) :: value = 0, error = 0, chi_squared = 0
    integer :: freedom = 0
  end type alternative_t

  !> A spring constant that differs by less than this factor is no mistake.
  real(wp), parameter :: other_spring = 1.1_wp
  !> The softest spring that is tried, relative to the deck's.
  real(wp), parameter :: softest = 1.0e-4_wp

contains

  !> Looks for an alternative; `alternative` is not allocated if there is none. family, problem: as
  !> in `run_fit`. curve: the curve of the fit. spring_first: whether the data suggest another
  !> spring constant.
  subroutine find_alternative(family, problem, curve, model, spring_first, fitted, alternative)
    class(problem_family_t), intent(in) :: family
    type(problem_t), intent(in) :: problem
    type(modelled_curve_t), intent(in) :: curve
    class(force_model_t), intent(inout), target :: model
    logical, intent(in) :: spring_first
    type(fitted_t), intent(in) :: fitted
    type(alternative_t), allocatable, intent(out) :: alternative

    if (spring_first) call try_spring()
    if (.not. allocated(alternative)) call try_way(.false., 'retract')
    if (.not. allocated(alternative)) call try_way(.true., 'approach')
    if (.not. (allocated(alternative) .or. spring_first)) call try_spring()

  contains

    !> Fits one segment alone, starting from the values of the fit to both.
    subroutine try_way(inward, name)
      logical, intent(in) :: inward
      character(len=*), intent(in) :: name
      type(modelled_curve_t) :: trial
      type(fitted_t) :: other

      if (ways_in(curve%data%measured%inward) < 2) return
      trial = curve
      call trial%data%keep_way(inward)
      call fit_curve(trial, model, reshape(fitted%value, [size(fitted%value), 1]), .true., other)
      call accept(name, other)
    end subroutine try_way

    !> Fits the spring constant too, if the signal is the force (a deflection does not depend on the
    !> spring constant). In contact with a much stiffer body the signal changes by the spring
    !> constant times the travel.
    subroutine try_spring()
      type(modelled_curve_t) :: trial
      type(fitted_t) :: other
      type(unknown_t) :: unknown
      type(measured_curve_t) :: signal
      real(wp), allocatable :: start(:, :), starts(:, :)
      integer :: n

      n = size(curve%unknown)
      if (.not. curve%is_force .or. any(curve%unknown%role == of_spring)) return
      ! Data of separations and loads do not depend on the spring.
      if (.not. curve%data%measured%has(of_position)) return
      ! Jumps and starting values are determined as if the spring were as stiff as the steepest part
      ! of the contact.
      trial = curve
      trial%spring = max(contact_slope(curve), softest*curve%spring)
      trial%sensitivity = curve%data%measured%load_of_unit()/trial%spring
      trial%largest_slope = 1/trial%sensitivity
      associate (data => trial%data, slope => trial%largest_slope)
        signal = data%measured%of_signal()
        data%jump = [find_jump(signal, data%noise%deviation, slope, .true.), &
          find_jump(signal, data%noise%deviation, slope, .false.)]
        call data%take(1)
      end associate
      call starts_like(suggested_characters(trial, problem), family, trial%unknown, start)
      unknown%name = 'measurement.spring_constant'
      unknown%unit = 'N/m'
      unknown%role = of_spring
      unknown%in_log = .true.
      unknown%value = trial%spring
      unknown%scale = unknown%value
      trial%unknown = [trial%unknown, unknown]
      allocate (starts(n + 1, size(start, 2)))
      starts(:n, :) = start
      starts(n + 1, :) = unknown%value
      call fit_curve(trial, model, starts, .true., other)
      if (.not. allocated(other%effect)) return
      if (abs(log(other%value(n + 1)/curve%spring)) < log(other_spring)) return
      call accept('spring_constant', other)
      if (.not. allocated(alternative)) return
      alternative%value = other%value(n + 1)
      alternative%error = other%deviation(n + 1)
    end subroutine try_spring

    subroutine accept(name, other)
      character(len=*), intent(in) :: name
      type(fitted_t), intent(in) :: other

      if (.not. allocated(other%effect)) return
      if (.not. (other%found .and. other%lack%is_noise())) return
      allocate (alternative)
      alternative%name = name
      alternative%chi_squared = other%chi_squared
      alternative%freedom = other%freedom
    end subroutine accept

  end subroutine find_alternative

  !> The steepest slope in contact of the load against the travel of the base [N/m].
  pure real(wp) function contact_slope(curve) result(slope)
    type(modelled_curve_t), intent(in) :: curve

    slope = max(0.0_wp, maxval(slopes_of_parts(curve%data%measured)))*curve%spring* &
      curve%sensitivity
  end function contact_slope

end module fit_alternatives
