!> The numbers at the solution points of an experiment in SI units, with their errors and
!> derivatives.
module reported_values
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: wp, nan
  use dimensionless_problem, only: problem_t
  use reported_place, only: values_of, units_of, least, quantities, of_profile
  use places, only: places_t
  implicit none
  private
  public :: readings_t, read_numbers

  !> The values of a number, element by element, in SI units; NaN for an element that does not
  !> exist. rate, rate_error: derivatives by the parameters of &sensitivity and their errors,
  !> (parameters, elements).
  type :: readings_t
    real(wp), allocatable :: value(:), error(:), rate(:, :), rate_error(:, :)
  end type readings_t

contains

  !> The elements of a number, with errors and derivatives; empty if the number does not exist. An
  !> error is NaN if no second run was made to estimate it; it is the magnitude of the number if the
  !> second run did not determine it.
  type(readings_t) function read_numbers(places, problem, name, quantity) result(found)
    type(places_t), intent(in) :: places
    type(problem_t), intent(in) :: problem
    character(len=*), intent(in) :: name
    integer, intent(in) :: quantity
    real(wp), dimension(quantities) :: units, values
    real(wp) :: none
    integer :: i, n

    n = places%elements(name)
    none = nan
    units = units_of(problem)
    allocate (found%value(n), source=0.0_wp)
    allocate (found%error(n), source=none)
    allocate (found%rate(parameters_of(places), n), source=none)
    found%rate_error = found%rate
    if (n == 0) return
    do i = 1, size(places%entry)
      associate (entry => places%entry(i), k => places%entry(i)%element)
        if (entry%name /= name) cycle
        if (entry%place == 0) then
          found%value(k) = found%value(k) + entry%factor
          cycle
        end if
        associate (place => places%place(entry%place))
          values = values_of(problem, place)
          found%value(k) = found%value(k) + entry%factor*values(quantity)
        end associate
      end associate
    end do
    if (.not. allocated(places%number)) return
    do i = 1, size(places%number)
      associate (number => places%number(i), k => places%number(i)%element)
        if (number%name /= name) cycle
        if (.not. ieee_is_nan(found%value(k))) then
          found%error(k) = number%error(quantity)*units(quantity)
          if (.not. number%known) then
            if (ieee_is_nan(found%error(k))) found%error(k) = 0
            found%error(k) = max(found%error(k), abs(found%value(k)), &
              least(quantity)*units(quantity))
          end if
        end if
        if (allocated(number%rate)) then
          found%rate(:, k) = number%rate(quantity, :)
          found%rate_error(:, k) = number%rate_error(quantity, :)
        end if
        if (quantity == of_profile) found%value(k) = found%error(k)
      end associate
    end do
  end function read_numbers

  !> Number of parameters by which the numbers are differentiated.
  pure integer function parameters_of(places) result(parameters)
    type(places_t), intent(in) :: places
    integer :: i

    parameters = 0
    if (.not. allocated(places%number)) return
    do i = 1, size(places%number)
      if (allocated(places%number(i)%rate)) parameters = size(places%number(i)%rate, 2)
    end do
  end function parameters_of

end module reported_values
