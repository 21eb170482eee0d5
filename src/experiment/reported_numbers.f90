!> Named numbers of a run, and their errors from other runs of the same scene. The error of a number
!> is a multiple of its difference from the same number, by name and element, of another run. A
!> number is not known if the other run lacks it, or has another number of its elements.
module reported_numbers
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: wp, nan
  use order_statistics, only: ranked
  use reported_place, only: quantities, of_load, of_profile, least, rounding
  implicit none
  private
  public :: number_t, run_numbers_t, judge, differentiate, safety_factor, chance, chance_on_grids, &
    largest_error, largest_of, of_table, name_length

  integer, parameter :: name_length = 24

  !> All quantities of an element of a number, units of `dimensionless_problem`, with their errors.
  type :: number_t
    character(len=name_length) :: name = ''
    integer :: element = 1
    real(wp), dimension(quantities) :: value = 0, error = 0
    !> The quantities whose relative errors count. Errors are relative to the magnitude of a
    !> quantity or to `scale`, whichever is larger.
    logical :: compared(quantities) = .false.
    real(wp) :: scale(quantities) = least
    !> Whether all other runs have this number.
    logical :: known = .true.
    !> Whether the errors are final, from other runs.
    logical :: judged = .false.
    !> A profile: gaps and pressures at the radii of the first run.
    real(wp), allocatable, dimension(:) :: gap, pressure
    !> Derivatives by the parameters of &sensitivity and their errors, (quantities, parameters), SI
    !> units.
    real(wp), allocatable, dimension(:, :) :: rate, rate_error
  end type number_t

  !> The numbers of another run. part: the expected error of a number over its difference from this
  !> run; 1 if that run is much finer or nothing is known.
  type :: run_numbers_t
    type(number_t), allocatable :: number(:)
    real(wp) :: part = 1
  end type run_numbers_t

  !> Safety factor of the differences, for the error of the other run (a tenth or less on a finer
  !> mesh) and for differences that are small by chance.
  real(wp), parameter :: safety_factor = 3
  !> Kinds of quantities whose relative errors are alike: 1 h0 and displacements, 2 loads and
  !> energies, 3 radii, 4 profiles.
  integer, parameter :: kind_of(quantities) = [1, 2, 1, 2, 3, 3, 2, 1, 2, 2, 4]
  !> The least error, over the median error. It is `chance` on meshes of other digits, which seldom
  !> agree by chance. It is `chance_on_grids` on grids fixed in space, whose errors depend on the
  !> position of the contact edge between nodes. Of 1025 numbers on meshes locked to the edge under
  !> random laws, 1.5 % had errors above such estimates and 3.1 % below a thirtieth of them. With
  !> one median of all kinds these shares are 1.7 % and 7.2 %; without a least error they are 2.0 %
  !> and 0.6 %.
  real(wp), parameter :: chance = 0.1_wp, chance_on_grids = 1
  !> The relative error of an unknown value.
  real(wp), parameter :: most = 1.0e6_wp
  !> The loads of a table, whose errors are relative to the largest of them; and turns of the path,
  !> which count only if other runs do not have them.
  character(len=*), parameter :: of_table = 'table', of_turns = 'turns'
  !> Numbers without derivatives.
  character(len=*), parameter :: not_differentiated(*) = [character(len=8) :: 'profiles', &
    'samples', of_table, of_turns]

contains

  !> Adds the differences from other runs to the errors of numbers that so far have only those of
  !> iteration and rounding. Two meshes may agree by chance, so no relative error is smaller than a
  !> part of the median of the same kind.
  pure subroutine judge(number, others, part)
    type(number_t), intent(inout) :: number(:)
    type(run_numbers_t), intent(in) :: others(:)
    real(wp), intent(in) :: part
    real(wp), dimension(quantities) :: lowest
    logical :: fresh(size(number))
    integer :: i, k

    fresh = .not. number%judged
    do i = 1, size(number)
      if (.not. fresh(i)) cycle
      do k = 1, size(others)
        call compare(number(i), count(number%name == number(i)%name), others(k))
      end do
    end do
    lowest = [(part*median_of(pack(number, fresh), kind_of(k)), k=1, quantities)]
    do i = 1, size(number)
      if (.not. fresh(i)) cycle
      number(i)%judged = .true.
      associate (error => number(i)%error, value => number(i)%value)
        do k = 1, quantities
          if (ieee_is_nan(error(k)) .or. ieee_is_nan(value(k))) cycle
          if (error(k) > 0) error(k) = max(error(k), lowest(k)*max(abs(value(k)), least(k)))
        end do
      end associate
    end do
  end subroutine judge

  !> The median of the relative errors of a kind, of two in the middle the larger one; 0 without any
  !> error.
  pure real(wp) function median_of(number, kind) result(median)
    type(number_t), intent(in) :: number(:)
    integer, intent(in) :: kind
    real(wp), allocatable :: relative(:)
    integer :: i

    allocate (relative(0))
    do i = 1, size(number)
      if (number(i)%known .and. number(i)%name /= of_table) relative = [relative, &
        pack(parts_of(number(i)), number(i)%compared .and. kind_of == kind)]
    end do
    relative = pack(relative, relative > 0)
    median = 0
    if (size(relative) > 0) median = ranked(relative, size(relative)/2 + 1)
  end function median_of

  !> Adds to the errors of a number the difference from another run; held: its number of elements.
  pure subroutine compare(number, held, other)
    type(number_t), intent(inout) :: number
    integer, intent(in) :: held
    type(run_numbers_t), intent(in) :: other
    integer :: k

    if (count(other%number%name == number%name) /= held) number%known = .false.
    k = place_among(other%number, number)
    if (k == 0) then
      number%known = .false.
      return
    end if
    associate (a => number%value, b => other%number(k)%value)
      ! Every place of a number has a load.
      if (ieee_is_nan(a(of_load)) .neqv. ieee_is_nan(b(of_load))) number%known = .false.
      where (.not. (ieee_is_nan(a) .and. ieee_is_nan(b))) number%error = number%error + &
        safety_factor*other%part*abs(a - b)
    end associate
    if (number%compared(of_profile)) number%error(of_profile) = number%error(of_profile) + &
      safety_factor*profile_difference(number, other%number(k))
  end subroutine compare

  !> The index of the same number, by name and element, of another run; 0: it has none.
  pure integer function place_among(theirs, number) result(k)
    type(number_t), intent(in) :: theirs(:), number

    do k = size(theirs), 1, -1
      if (theirs(k)%name == number%name .and. theirs(k)%element == number%element) return
    end do
  end function place_among

  !> Sets derivative j of `parameters` from the numbers, in SI units, of runs with other values of
  !> the parameter. The derivatives are sums over the runs with `weight`; their errors are the
  !> differences from the sums with `coarser`, plus the errors of iteration and rounding. If a run
  !> lacks a number, or has another number of its elements, this number has no derivative, and found
  !> is .false.
  pure subroutine differentiate(number, runs, weight, coarser, j, parameters, found)
    type(number_t), intent(inout) :: number(:)
    type(run_numbers_t), intent(in) :: runs(:)
    real(wp), intent(in) :: weight(:), coarser(:)
    integer, intent(in) :: j, parameters
    logical, intent(out) :: found
    real(wp) :: coarse(quantities)
    integer :: i, k, r

    found = .true.
    do i = 1, size(number)
      if (any(not_differentiated == number(i)%name)) cycle
      if (.not. allocated(number(i)%rate)) then
        allocate (number(i)%rate(quantities, parameters), source=nan)
        allocate (number(i)%rate_error(quantities, parameters), source=nan)
      end if
      if (ieee_is_nan(number(i)%value(of_load))) cycle
      associate (rate => number(i)%rate(:, j), error => number(i)%rate_error(:, j))
        rate = 0
        coarse = 0
        error = 0
        do r = 1, size(runs)
          associate (theirs => runs(r)%number)
            k = place_among(theirs, number(i))
            if (k > 0) then
              rate = rate + weight(r)*theirs(k)%value
              coarse = coarse + coarser(r)*theirs(k)%value
              error = error + abs(weight(r))*theirs(k)%error
            end if
            if (k == 0 .or. count(theirs%name == number(i)%name) /= &
              count(number%name == number(i)%name)) rate = nan
          end associate
        end do
        error = error + abs(rate - coarse)
        found = found .and. .not. ieee_is_nan(rate(of_load))
      end associate
    end do
  end subroutine differentiate

  !> The largest difference of gaps, and of pressures over the largest pressure, between two
  !> profiles. Differences of gaps above the law's length are relative: at large gaps rounding is
  !> proportional to the gap.
  pure real(wp) function profile_difference(a, b) result(largest)
    type(number_t), intent(in) :: a, b
    real(wp) :: strongest
    integer :: j

    largest = 1
    if (.not. (allocated(a%gap) .and. allocated(b%gap))) return
    if (size(a%gap) /= size(b%gap)) return
    strongest = max(maxval(abs(a%pressure), .not. ieee_is_nan(a%pressure)), tiny(1.0_wp))
    largest = 0
    do j = 1, size(a%gap)
      ! A mesh may have no values there.
      if (ieee_is_nan(a%gap(j)) .or. ieee_is_nan(b%gap(j))) cycle
      largest = max(largest, abs(a%gap(j) - b%gap(j))/max(1.0_wp, a%gap(j)), &
        abs(a%pressure(j) - b%pressure(j))/strongest)
    end do
  end function profile_difference

  !> The largest relative error of all reported numbers. A turn of the path that other runs do not
  !> have counts even if it is not reported, since the stability of all later states depends on it.
  pure real(wp) function largest_error(number) result(largest)
    type(number_t), intent(in) :: number(:)
    real(wp) :: load
    integer :: i

    largest = rounding
    load = tiny(1.0_wp)
    do i = 1, size(number)
      if (number(i)%name == of_table) then
        load = max(load, abs(number(i)%value(of_load)))
      else if (number(i)%name /= of_turns .or. .not. number(i)%known) then
        largest = max(largest, relative_error(number(i)))
      end if
    end do
    largest = max(largest, largest_of(number, of_table, of_load)/load)
  end function largest_error

  !> The largest error of a quantity over all elements of a number, units of
  !> `dimensionless_problem`.
  pure real(wp) function largest_of(number, name, quantity) result(largest)
    type(number_t), intent(in) :: number(:)
    character(len=*), intent(in) :: name
    integer, intent(in) :: quantity
    integer :: i

    largest = 0
    do i = 1, size(number)
      if (number(i)%name /= name) cycle
      largest = max(largest, number(i)%error(quantity))
      if (.not. number(i)%known) largest = max(largest, abs(number(i)%value(quantity)))
    end do
  end function largest_of

  !> The largest relative error of the compared quantities of a number.
  pure real(wp) function relative_error(number) result(largest)
    type(number_t), intent(in) :: number

    largest = maxval([0.0_wp, pack(parts_of(number), number%compared)])
    if (.not. number%known) largest = max(1.0_wp, largest)
  end function relative_error

  !> The relative errors of all quantities of a number.
  pure function parts_of(number) result(part)
    type(number_t), intent(in) :: number
    real(wp) :: part(quantities), magnitude
    integer :: k

    part = 0
    do k = 1, quantities
      if (ieee_is_nan(number%error(k))) cycle
      if (number%error(k) <= 0) cycle
      magnitude = max(number%scale(k), tiny(1.0_wp))
      if (.not. ieee_is_nan(number%value(k))) magnitude = max(magnitude, abs(number%value(k)))
      part(k) = most
      if (number%error(k) < most*magnitude) part(k) = number%error(k)/magnitude
    end do
    part(of_profile) = number%error(of_profile)
  end function parts_of

end module reported_numbers
