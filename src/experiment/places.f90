!> The table of places that numbers are reported of (`reported`). A number of the summary has a
!> name, one or more elements, and for each of them one place, or several whose sum it is, such as
!> the energies before and after jumps.
module places
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use reported, only: reported_t, nowhere, value_of, unit_of, rates_of, what_is_left, least, &
    of_h0, of_energy, of_position
  implicit none
  private
  public :: places_t, readings_t

  integer, parameter :: name_length = 24

  !> An element of a number is the sum of `factor` times what is read at its places; without a place
  !> it is `factor` itself: 0, or NaN for what does not exist.
  type :: entry_t
    character(len=name_length) :: name = ''
    integer :: element = 1, place = 0
    real(wp) :: factor = 1
  end type entry_t

  type :: places_t
    type(reported_t), allocatable :: place(:)
    type(entry_t), allocatable :: entry(:)
  contains
    procedure :: keep
    procedure :: enter
    procedure :: enter_nothing
    procedure :: forget
    procedure :: has
    procedure :: elements
    procedure :: place_of
    procedure :: is_used
    procedure :: largest_error
    procedure :: largest_of
    procedure :: read_numbers
  end type places_t

  !> A number as it is reported, element by element, SI units; what does not exist is NaN. rate:
  !> (parameters, elements).
  type :: readings_t
    real(wp), allocatable :: value(:), error(:), rate(:, :)
  end type readings_t

  !> What a table adds to the error of a run is judged over its largest load; energies have errors of
  !> their own.
  character(len=*), parameter :: of_table = 'table', of_energies = 'energy_lost'

contains

  !> Finds a place in the table, or adds it.
  subroutine keep(self, place, i)
    class(places_t), intent(inout) :: self
    type(reported_t), intent(in) :: place
    integer, intent(out) :: i

    if (.not. allocated(self%place)) allocate (self%place(0), self%entry(0))
    if (place%mesh /= nowhere) then
      do i = 1, size(self%place)
        if (is_same(self%place(i), place)) return
      end do
    end if
    self%place = [self%place, place]
    i = size(self%place)
  end subroutine keep

  pure logical function is_same(one, other)
    type(reported_t), intent(in) :: one, other

    is_same = one%mesh == other%mesh .and. abs(one%s - other%s) <= 0 .and. &
      abs(one%at(of_h0) - other%at(of_h0)) <= 0 .and. all(abs(one%drive - other%drive) <= 0) .and. &
      all(abs(one%turn_of - other%turn_of) <= 0) .and. one%after == other%after .and. &
      (one%with_profile .eqv. other%with_profile) .and. &
      (one%with_radius .eqv. other%with_radius) .and. (one%searched .eqv. other%searched)
  end function is_same

  !> Lets an element of a number be read at a place, or adds `factor` times what is read there.
  subroutine enter(self, name, element, place, factor)
    class(places_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(in) :: element
    type(reported_t), intent(in) :: place
    real(wp), intent(in), optional :: factor
    type(entry_t) :: entry

    entry%name = name
    entry%element = element
    call self%keep(place, entry%place)
    if (present(factor)) entry%factor = factor
    self%entry = [self%entry, entry]
  end subroutine enter

  !> Enters an element that has no place: it is 0 or, without a value, does not exist.
  subroutine enter_nothing(self, name, element, value)
    class(places_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(in) :: element
    real(wp), intent(in), optional :: value
    type(entry_t) :: entry

    if (.not. allocated(self%place)) allocate (self%place(0), self%entry(0))
    entry%name = name
    entry%element = element
    entry%factor = ieee_value(1.0_wp, ieee_quiet_nan)
    if (present(value)) entry%factor = value
    self%entry = [self%entry, entry]
  end subroutine enter_nothing

  !> Takes a number back.
  subroutine forget(self, name)
    class(places_t), intent(inout) :: self
    character(len=*), intent(in) :: name

    if (allocated(self%entry)) self%entry = pack(self%entry, self%entry%name /= name)
  end subroutine forget

  !> Whether there is such a number, or this element of it.
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

  !> How many elements a number has.
  pure integer function elements(self, name)
    class(places_t), intent(in) :: self
    character(len=*), intent(in) :: name

    elements = 0
    if (self%has(name)) elements = maxval(self%entry%element, self%entry%name == name)
  end function elements

  !> The place at which a number is read; one that no mesh has, if the number does not exist.
  pure type(reported_t) function place_of(self, name) result(place)
    class(places_t), intent(in) :: self
    character(len=*), intent(in) :: name

    if (self%has(name)) place = &
      self%place(self%entry(findloc(self%entry%name == name, .true., 1))%place)
  end function place_of

  !> Whether place i is read for any number, or leads to one that is, profiles and samples left out
  !> if only derivatives count.
  pure recursive logical function is_used(self, i, for_rates) result(used)
    class(places_t), intent(in) :: self
    integer, intent(in) :: i
    logical, intent(in) :: for_rates
    integer :: k

    associate (entry => self%entry)
      used = any(entry%place == i .and. .not. (for_rates .and. &
        (entry%name == 'profiles' .or. entry%name == 'samples' .or. entry%name == of_table)))
    end associate
    do k = i + 1, size(self%place)
      if (used) return
      if (self%place(k)%after == i) used = self%is_used(k, for_rates)
    end do
  end function is_used

  !> The largest relative error of all that is reported; 0 if nothing was judged.
  pure real(wp) function largest_error(self) result(largest)
    class(places_t), intent(in) :: self
    integer :: i

    largest = 0
    if (.not. allocated(self%entry)) return
    do i = 1, size(self%entry)
      associate (entry => self%entry(i))
        if (entry%place > 0 .and. entry%name /= of_table .and. entry%name /= of_energies) &
          largest = max(largest, self%place(entry%place)%relative_error())
      end associate
    end do
  end function largest_error

  !> The largest error of a quantity at all places of a number, units of `dimensionless_problem`.
  pure real(wp) function largest_of(self, name, quantity) result(largest)
    class(places_t), intent(in) :: self
    character(len=*), intent(in) :: name
    integer, intent(in) :: quantity
    integer :: i

    largest = 0
    do i = 1, size(self%entry)
      associate (entry => self%entry(i))
        if (entry%name == name) largest = max(largest, self%place(entry%place)%error(quantity))
      end associate
    end do
  end function largest_of

  !> The elements of a number, with errors and derivatives; none where it does not exist.
  function read_numbers(self, problem, name, quantity) result(found)
    class(places_t), intent(in) :: self
    type(problem_t), intent(in) :: problem
    character(len=*), intent(in) :: name
    integer, intent(in) :: quantity
    type(readings_t) :: found
    real(wp), allocatable :: difference(:), left(:)
    logical, allocatable :: known(:)
    real(wp) :: none
    integer :: i, n, parameters

    n = self%elements(name)
    parameters = 0
    if (n > 0) parameters = parameters_of(self)
    allocate (found%value(n), difference(n), left(n), source=0.0_wp)
    allocate (found%rate(parameters, n), source=0.0_wp)
    allocate (known(n), source=.true.)
    none = ieee_value(none, ieee_quiet_nan)
    do i = 1, merge(size(self%entry), 0, n > 0)
      associate (entry => self%entry(i), k => self%entry(i)%element)
        if (entry%name /= name) cycle
        if (entry%place == 0) then
          found%value(k) = entry%factor
          difference(k) = entry%factor
          found%rate(:, k) = entry%factor
          cycle
        end if
        associate (place => self%place(entry%place))
          found%value(k) = found%value(k) + entry%factor*value_of(problem, place, quantity)
          known(k) = known(k) .and. place%known
          difference(k) = difference(k) + entry%factor*place%margin* &
            (place%measure(place%at, quantity) - place%measure(place%fine, quantity))
          left(k) = left(k) + what_is_left(place, quantity)
          if (.not. place%judged .or. (place%searched .and. quantity == of_h0)) left(k) = none
          if (quantity == of_position .and. .not. place%drive(1) > 0) left(k) = none
          if (quantity == of_energy) left(k) = left(k) + epsilon(1.0_wp)* &
            abs(place%measure(place%at, quantity))
          if (allocated(place%rate)) then
            found%rate(:, k) = found%rate(:, k) + entry%factor*rates_of(problem, place, quantity)
          else
            found%rate(:, k) = none
          end if
        end associate
      end associate
    end do
    found%error = (abs(difference) + left)*unit_of(problem, quantity)
    where (.not. known) found%error = &
      max(abs(found%value), least(quantity)*unit_of(problem, quantity))
  end function read_numbers

  !> By how many parameters the places are differentiated.
  pure integer function parameters_of(places) result(parameters)
    type(places_t), intent(in) :: places
    integer :: i

    parameters = 0
    do i = 1, size(places%place)
      if (allocated(places%place(i)%rate)) parameters = size(places%place(i)%rate, 2)
    end do
  end function parameters_of

end module places
