!> Messages that say why a search led to no fit, with the numbers that decide.
module fit_refusals
  use kinds, only: wp
  use text, only: rounded
  use fit_request, only: is_at_end
  use force_model, only: force_model_t
  use modelled_curve, only: modelled_curve_t
  use measured_loads, only: other_order
  use fit_errors, only: fitted_t
  use significance, only: negligible, chance_of, rarely
  use fit_alternatives, only: contact_slope
  implicit none
  private
  public :: check_fit

  !> Largest chi squared per degree of freedom with which the baseline alone describes data without
  !> contact.
  real(wp), parameter :: bare = 2

contains

  !> Sets `trouble` if the search did not end in a fit. suggestion: a text about what the data
  !> suggest, which is appended; it may be empty.
  subroutine check_fit(curve, model, fitted, suggestion, trouble)
    type(modelled_curve_t), intent(in) :: curve
    class(force_model_t), pointer, intent(in) :: model
    type(fitted_t), intent(in) :: fitted
    character(len=*), intent(in) :: suggestion
    character(len=:), allocatable, intent(out) :: trouble
    integer :: i

    if (.not. fitted%has_path) then
      trouble = 'with the values of the deck the path could not be solved over the range ' // &
        'of the data; start from other values, or fit a part of the data' // suggestion
      return
    else if (.not. fitted%has_curve) then
      trouble = no_contact(curve, bare_squares(curve), suggestion)
      return
    end if
    if (.not. allocated(fitted%effect)) then
      trouble = 'the search ended where the path has no derivatives; start from other values' &
        // suggestion
      return
    end if
    call check_gain(curve, fitted, suggestion, trouble)
    if (allocated(trouble)) return
    if (.not. fitted%lack%is_noise() .and. any(fitted%effect <= negligible .or. &
      is_at_end(curve%unknown, fitted%value))) then
      trouble = other_order(curve, model)
      if (len(trouble) > 0) then
        trouble = trouble // suggestion
        return
      end if
      deallocate (trouble)
    end if
    do i = 1, size(fitted%effect)
      ! A shared unknown may have an effect on another curve.
      if (fitted%effect(i) > negligible .or. curve%unknown(i)%shared) cycle
      trouble = curve%unknown(i)%name // &
        ' has no effect on this curve near the best value found, ' // &
        rounded(fitted%value(i)) // '; remove it from parameters, or give a prior' // suggestion
      return
    end do
  end subroutine check_fit

  !> Chi squared of the baseline alone.
  real(wp) function bare_squares(curve) result(squares)
    type(modelled_curve_t), intent(in) :: curve
    real(wp) :: left(size(curve%data%sample), 1)

    left(:, 1) = curve%data%measured%signal(curve%data%sample)
    call curve%data%clean(left)
    squares = sum(left**2)
  end function bare_squares

  !> The message if the baseline alone, with this chi squared, describes the data as well as the
  !> model.
  function no_contact(curve, squares, suggestion) result(words)
    type(modelled_curve_t), intent(in) :: curve
    real(wp), intent(in) :: squares
    character(len=*), intent(in) :: suggestion
    character(len=:), allocatable :: words, spring
    real(wp) :: slope
    integer :: freedom

    freedom = max(1, size(curve%data%sample) - curve%data%baseline_numbers())
    slope = contact_slope(curve)
    words = 'no contact like that of the model in the data: wherever it is assumed, the model ' &
      // 'describes them no better than the baseline alone, whose residuals are ' // &
      rounded(sqrt(squares/freedom)) // ' times the noise; towards the other body the ' // &
      'load rises by ' // rounded(slope) // ' N per metre of the travel at most'
    spring = ''
    if (curve%data%measured%spring_constant > 0) then
      words = words // ', ' // rounded(100*slope/curve%spring) // ' % of spring_constant'
      spring = 'spring_constant, '
    end if
    words = words // suggestion
    if (len(suggestion) == 0) words = words // ', and no closed form of a contact describes ' // &
      'them either; check ' // spring // 'the radius, and whether the bodies came near enough'
  end function no_contact

  !> Sets `trouble` if the baseline alone describes the data as well as the model. (The search over
  !> many contact points also fits noise.)
  subroutine check_gain(curve, fitted, suggestion, trouble)
    type(modelled_curve_t), intent(in) :: curve
    type(fitted_t), intent(in) :: fitted
    character(len=*), intent(in) :: suggestion
    character(len=:), allocatable, intent(inout) :: trouble
    real(wp) :: squares
    integer :: columns

    squares = bare_squares(curve)
    columns = 2*((size(curve%unknown) + 1)/2)
    if (rarely(chance_of(squares - fitted%chi_squared, fitted%chi_squared/max(1, fitted%freedom), &
      columns, size(curve%data%sample)))) return
    if (squares < bare*fitted%freedom) then
      trouble = 'no contact in the data: the baseline alone leaves a chi squared of ' // &
        rounded(squares) // ', and the model ' // rounded(fitted%chi_squared) // ', with ' // &
        rounded(real(fitted%freedom, wp)) // ' degrees of freedom'
    else
      trouble = no_contact(curve, squares, suggestion)
    end if
  end subroutine check_gain

end module fit_refusals
