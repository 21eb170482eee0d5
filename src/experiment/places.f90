!> The table of places at which numbers are reported (`reported_place`). A number of the summary has
!> a name, one or more elements, and for each element one place, or several places of which it is
!> the sum, such as the energies before and after jumps.
module places
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: wp, nan
  use dimensionless_problem, only: problem_t
  use reported_place, only: place_t, point_of_path, values_of, units_of, rates_of, least, &
    quantities, of_h0, of_load, of_radius, of_profile
  use result_rows, only: rows
  implicit none
  private
  public :: places_t, readings_t

  integer, parameter :: name_length = 24

  !> A term of an element: `factor` times the quantity at the place; without a place the term is
  !> `factor` itself: 0, or NaN for a number that does not exist.
  type :: entry_t
    character(len=name_length) :: name = ''
    integer :: element = 1, place = 0
    real(wp) :: factor = 1
  end type entry_t

  type :: places_t
    type(place_t), allocatable :: place(:)
    type(entry_t), allocatable :: entry(:)
  contains
    procedure :: keep
    procedure :: enter
    procedure :: add
    procedure :: enter_tension
    procedure :: forget
    procedure :: has
    procedure :: elements
    procedure :: place_of
    procedure :: largest_error
    procedure :: largest_of
    procedure :: read_numbers
  end type places_t

  !> The values of a number, element by element, SI units; NaN if it does not exist. rate:
  !> (parameters, elements).
  type :: readings_t
    real(wp), allocatable :: value(:), error(:), rate(:, :)
  end type readings_t

  !> Numbers that are not judged place by place.
  character(len=*), parameter :: of_table = 'table', of_energies = 'energy_lost'
  !> Numbers of which the error of the profile is read, and those of which the contact radius is
  !> reported, in the summary or, for fixed loads, in a table.
  character(len=*), parameter :: of_profiles(*) = pack(rows%place, rows%quantity == of_profile)
  character(len=*), parameter :: with_radius(*) = [character(len=name_length) :: 'fixed_load', &
    pack(rows%place, rows%quantity == of_radius)]
  !> Numbers without derivatives.
  character(len=*), parameter :: not_differentiated(*) = [character(len=8) :: 'profiles', &
    'samples', of_table]

contains

  !> Finds a place in the table, or adds it, after the place from which its jump started.
  recursive subroutine keep(self, place, i)
    class(places_t), intent(inout) :: self
    type(place_t), intent(in) :: place
    integer, intent(out) :: i
    integer :: after

    if (.not. allocated(self%place)) allocate (self%place(0))
    after = place%after
    if (place%landing) call self%keep(point_of_path(place%point), after)
    do i = 1, size(self%place)
      if (is_same(self%place(i), place)) return
    end do
    self%place = [self%place, place]
    self%place(i)%after = after
  end subroutine keep

  !> Whether two places are the same: the same point of the path, or the same landing, or equal
  !> numbers.
  pure logical function is_same(one, other)
    type(place_t), intent(in) :: one, other

    is_same = one%point == other%point .and. (one%landing .eqv. other%landing)
    if (is_same .and. one%point == 0) is_same = one%mesh == other%mesh .and. one%after == &
      other%after .and. (one%searched .eqv. other%searched) .and. all(abs([one%at(:of_load), &
      one%drive, one%turn_of] - [other%at(:of_load), other%drive, other%turn_of]) <= 0)
  end function is_same

  !> Adds a term to an element of a number: `factor` times the quantity at a place. Without a place
  !> the term is `factor`, or NaN if factor is absent too.
  subroutine enter(self, name, element, place, factor)
    class(places_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(in) :: element
    type(place_t), intent(in), optional :: place
    real(wp), intent(in), optional :: factor
    type(entry_t) :: entry

    if (.not. allocated(self%entry)) allocate (self%entry(0))
    entry%name = name
    entry%element = element
    if (present(place)) then
      call self%keep(place, entry%place)
      call mark(entry%place)
      call mark(self%place(entry%place)%after)
    end if
    if (.not. present(place)) entry%factor = nan
    if (present(factor)) entry%factor = factor
    self%entry = [self%entry, entry]

  contains

    subroutine mark(i)
      integer, intent(in) :: i

      if (i == 0) return
      self%place(i)%read = .true.
      if (any(of_profiles == name) .and. .not. self%place(i)%with_profile) then
        self%place(i)%with_profile = .true.
        ! A point of the path may have been judged without its profile.
        if (self%place(i)%point > 0) self%place(i)%judged = .false.
      end if
      self%place(i)%differentiated = self%place(i)%differentiated .or. &
        all(not_differentiated /= name)
    end subroutine mark

  end subroutine enter

  !> Adds an element at a place to a number.
  subroutine add(self, name, place)
    class(places_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    type(place_t), intent(in), optional :: place

    call self%enter(name, self%elements(name) + 1, place)
  end subroutine add

  !> Enters a place of largest tension if its tension exceeds that of the entered one.
  subroutine enter_tension(self, lowest)
    class(places_t), intent(inout) :: self
    type(place_t), intent(in) :: lowest
    type(place_t) :: before

    before = self%place_of('max_tension')
    if (.not. lowest%at(of_load) < before%at(of_load)) return
    call self%forget('max_tension')
    call self%enter('max_tension', 1, lowest)
  end subroutine enter_tension

  !> Removes a number.
  subroutine forget(self, name)
    class(places_t), intent(inout) :: self
    character(len=*), intent(in) :: name

    if (allocated(self%entry)) self%entry = pack(self%entry, self%entry%name /= name)
  end subroutine forget

  !> Whether the table has a number, or an element of it.
  pure logical function has(self, name, element)
    class(places_t), intent(in) :: self
    character(len=*), intent(in) :: name
    integer, intent(in), optional :: element

    has = .false.
    if (.not. allocated(self%entry)) return
    if (present(element)) then
      has = any(self%entry%name == name .and. self%entry%element == element)
    else
      has = any(self%entry%name == name)
    end if
  end function has

  !> Number of elements of a number.
  pure integer function elements(self, name)
    class(places_t), intent(in) :: self
    character(len=*), intent(in) :: name

    elements = 0
    if (self%has(name)) elements = maxval(self%entry%element, self%entry%name == name)
  end function elements

  !> The place of a number; a place without a mesh if the number does not exist.
  pure type(place_t) function place_of(self, name) result(place)
    class(places_t), intent(in) :: self
    character(len=*), intent(in) :: name

    if (self%has(name)) place = &
      self%place(self%entry(findloc(self%entry%name == name, .true., 1))%place)
  end function place_of

  !> The largest relative error of all reported numbers; 0 if no place was judged. Errors of a
  !> table's loads are relative to the largest load. A fold of the path that a finer mesh does not
  !> have counts even if it is not reported, since the stability of all later states depends on it.
  pure real(wp) function largest_error(self) result(largest)
    class(places_t), intent(in) :: self
    real(wp) :: load
    integer :: i

    largest = 0
    load = tiny(1.0_wp)
    if (.not. allocated(self%entry)) return
    do i = 1, size(self%entry)
      associate (entry => self%entry(i))
        if (entry%place == 0 .or. entry%name == of_energies) cycle
        associate (place => self%place(entry%place))
          if (entry%name == of_table) load = max(load, abs(place%at(of_load)))
          if (entry%name /= of_table) largest = &
            max(largest, place%relative_error(any(with_radius == entry%name)))
        end associate
      end associate
    end do
    do i = 1, size(self%place)
      associate (place => self%place(i))
        if (place%is_fold() .and. .not. place%known) &
          largest = max(largest, place%relative_error(.false.))
      end associate
    end do
    largest = max(largest, self%largest_of(of_table, of_load)/load)
  end function largest_error

  !> The largest error of a quantity over all places of a number, units of `dimensionless_problem`.
  pure real(wp) function largest_of(self, name, quantity) result(largest)
    class(places_t), intent(in) :: self
    character(len=*), intent(in) :: name
    integer, intent(in) :: quantity
    integer :: i

    largest = 0
    do i = 1, size(self%entry)
      if (self%entry(i)%name /= name) cycle
      associate (errors => self%place(self%entry(i)%place)%errors())
        largest = max(largest, errors(quantity))
      end associate
    end do
  end function largest_of

  !> The elements of a number, with errors and derivatives; empty if the number does not exist.
  type(readings_t) function read_numbers(self, problem, name, quantity) result(found)
    class(places_t), intent(in) :: self
    type(problem_t), intent(in) :: problem
    character(len=*), intent(in) :: name
    integer, intent(in) :: quantity
    real(wp), allocatable :: difference(:)
    real(wp), dimension(quantities) :: units, values, misses, leftovers
    real(wp) :: none
    logical, allocatable :: known(:)
    integer :: i, n, parameters

    n = self%elements(name)
    allocate (found%value(n), found%error(n), difference(n), source=0.0_wp)
    parameters = 0
    if (allocated(self%place)) then
      do i = 1, size(self%place)
        if (allocated(self%place(i)%rate)) parameters = size(self%place(i)%rate, 2)
      end do
    end if
    allocate (found%rate(parameters, n), source=0.0_wp)
    allocate (known(n), source=.true.)
    units = units_of(problem)
    none = nan
    do i = 1, merge(size(self%entry), 0, n > 0)
      associate (entry => self%entry(i), k => self%entry(i)%element)
        if (entry%name /= name) cycle
        if (entry%place == 0) then
          found%value(k) = entry%factor
          found%error(k) = entry%factor
          found%rate(:, k) = entry%factor
          cycle
        end if
        associate (place => self%place(entry%place))
          values = values_of(problem, place)
          misses = place%margin*(place%measures(place%at) - place%measures(place%fine))
          leftovers = place%leftovers()
          found%value(k) = found%value(k) + entry%factor*values(quantity)
          known(k) = known(k) .and. place%known
          difference(k) = difference(k) + entry%factor*misses(quantity)
          found%error(k) = found%error(k) + leftovers(quantity)
          if (.not. place%judged .or. (place%searched .and. quantity == of_h0) .or. &
            ieee_is_nan(values(quantity))) found%error(k) = none
          if (allocated(place%rate)) found%rate(:, k) = found%rate(:, k) + &
            entry%factor*rates_of(problem, place, quantity)
          if (.not. allocated(place%rate)) found%rate(:, k) = none
        end associate
      end associate
    end do
    found%error = (abs(difference) + found%error)*units(quantity)
    where (.not. known) found%error = max(abs(found%value), least(quantity)*units(quantity))
  end function read_numbers

end module places
