!> Other fits of data that the model does not describe: with another spring constant, of the retreat
!> alone, of the approach alone. One that describes its data tells what is wrong.
module fit_alternatives
  use kinds, only: wp
  use fit_request, only: unknown_t, of_spring
  use force_model, only: force_model_t
  use modelled_curve, only: modelled_curve_t
  use curve_fit, only: fit_curve
  use fit_errors, only: fitted_t
  implicit none
  private
  public :: alternative_t, find_alternative, contact_slope

  !> An alternative that describes the data. name: retreat, approach, or spring_constant, whose
  !> value and error it then has [N/m].
  type :: alternative_t
    character(len=:), allocatable :: name
    real(wp) :: value = 0, error = 0, chi_squared = 0
    integer :: freedom = 0
  end type alternative_t

  !> The part of the largest signal above which a sample is in contact.
  real(wp), parameter :: in_contact = 0.5_wp
  !> A spring constant that differs by less than this factor is no mistake.
  real(wp), parameter :: other_spring = 1.1_wp

contains

  !> Looks for an alternative; not allocated if there is none. curve, start: the fit and its
  !> starting values.
  subroutine find_alternative(curve, model, start, fitted, alternative)
    type(modelled_curve_t), intent(in) :: curve
    class(force_model_t), intent(inout), target :: model
    real(wp), intent(in) :: start(:, :)
    type(fitted_t), intent(in) :: fitted
    type(alternative_t), allocatable, intent(out) :: alternative

    call try_way(.false., 'retreat')
    if (.not. allocated(alternative)) call try_way(.true., 'approach')
    if (.not. allocated(alternative)) call try_spring()

  contains

    !> Fits one way alone, from the values of the fit of both.
    subroutine try_way(inward, name)
      logical, intent(in) :: inward
      character(len=*), intent(in) :: name
      type(modelled_curve_t) :: trial
      type(fitted_t) :: other

      associate (ways => curve%data%measured%inward)
        if (all(ways) .or. .not. any(ways)) return
      end associate
      trial = curve
      call trial%data%keep_way(inward)
      call fit_curve(trial, model, reshape(fitted%value, [size(fitted%value), 1]), .true., other)
      call accept(name, other)
    end subroutine try_way

    !> Fits the spring constant too, if the signal is the force; of a deflection the data cannot
    !> show it. In contact with a much stiffer body the signal changes by the spring constant times
    !> the travel.
    subroutine try_spring()
      type(modelled_curve_t) :: trial
      type(fitted_t) :: other
      type(unknown_t) :: unknown
      real(wp), allocatable :: starts(:, :)
      integer :: n

      n = size(curve%unknown)
      if (.not. curve%is_force .or. any(curve%unknown%role == of_spring)) return
      trial = curve
      unknown%name = 'measurement.spring_constant'
      unknown%unit = 'N/m'
      unknown%role = of_spring
      unknown%in_log = .true.
      unknown%value = max(contact_slope(curve), 1.0e-4_wp*curve%spring)
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

  !> The mean slope of the load [N/m] against the travel of the base in contact, where the signal
  !> exceeds half of the largest one.
  pure real(wp) function contact_slope(curve) result(slope)
    type(modelled_curve_t), intent(in) :: curve
    real(wp) :: middle(2)
    logical, allocatable :: pressed(:)

    slope = 0
    associate (data => curve%data%measured)
      associate (z => data%z, s => data%signal)
        pressed = data%usable .and. s - minval(s, data%usable) > &
          in_contact*(maxval(s, data%usable) - minval(s, data%usable))
        if (count(pressed) < 3) return
        middle = [sum(z, pressed), sum(s, pressed)]/count(pressed)
        slope = -data%facing*sum((z - middle(1))*(s - middle(2)), pressed)/ &
          max(sum((z - middle(1))**2, pressed), tiny(1.0_wp))*curve%spring*curve%sensitivity
      end associate
    end associate
  end function contact_slope

end module fit_alternatives
