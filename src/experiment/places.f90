!> The table of places at which numbers are reported (`reported_place`). A number of the summary has
!> a name and one or more elements. Each element belongs to one place, or is a sum over several
!> places, such as the energies before and after jumps.
module places
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: wp, nan
  use dimensionless_problem, only: problem_t
  use reported_place, only: place_t, point_of_path, values_of, units_of, rounding, quantities, &
    of_load, of_radius, of_profile
  use reported_numbers, only: number_t, run_numbers_t, judge, name_length
  use result_rows, only: rows
  implicit none
  private
  public :: places_t

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
    !> The numbers with their errors, once these are known.
    type(number_t), allocatable :: number(:)
  contains
    procedure :: keep
    procedure :: enter
    procedure :: add
    procedure :: enter_tension
    procedure :: forget
    procedure :: has
    procedure :: elements
    procedure :: place_of
    procedure :: numbers
    procedure :: judge_by
  end type places_t

  !> Differences of energies: their relative errors are no measure of the accuracy of a run.
  character(len=*), parameter :: of_energies(*) = [character(len=name_length) :: 'energy_lost', &
    'device_energy']
  !> Numbers that report the error of the profile, and those that report the contact radius, in the
  !> summary or, for fixed loads, in a table.
  character(len=*), parameter :: of_profiles(*) = pack(rows%place, rows%quantity == of_profile)
  character(len=*), parameter :: with_radius(*) = [character(len=name_length) :: 'fixed_load', &
    pack(rows%place, rows%quantity == of_radius)]

contains

  !> Finds the index of a place in the table. A place that is not in the table is added, after the
  !> place from which its jump started. A row that is also the result of a search has the
  !> uncertainty of the search.
  recursive subroutine keep(self, place, i)
    class(places_t), intent(inout) :: self
    type(place_t), intent(in) :: place
    integer, intent(out) :: i
    integer :: after

    if (.not. allocated(self%place)) allocate (self%place(0))
    after = place%after
    if (place%landing) call self%keep(point_of_path(place%point), after)
    do i = 1, size(self%place)
      if (is_same(self%place(i), place)) then
        self%place(i)%left = max(self%place(i)%left, place%left)
        return
      end if
    end do
    self%place = [self%place, place]
    self%place(i)%after = after
  end subroutine keep

  !> Whether two places are the same: the same point of the path, or the end of the same jump, or
  !> equal numbers.
  pure logical function is_same(one, other)
    type(place_t), intent(in) :: one, other
    real(wp) :: apart(of_load + size(one%drive) + size(one%turn_of))

    is_same = one%point == other%point .and. (one%landing .eqv. other%landing)
    if (.not. is_same .or. one%point /= 0) return
    apart = [one%at(:of_load), one%drive, one%turn_of] - &
      [other%at(:of_load), other%drive, other%turn_of]
    is_same = one%mesh == other%mesh .and. one%after == other%after .and. &
      .not. any(ieee_is_nan(apart))
    if (is_same) is_same = all(abs(apart) <= 0)
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
      if (any(of_profiles == name)) self%place(entry%place)%with_profile = .true.
    end if
    if (.not. present(place)) entry%factor = nan
    if (present(factor)) entry%factor = factor
    self%entry = [self%entry, entry]
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
    integer :: i

    if (allocated(self%entry)) self%entry = pack(self%entry, self%entry%name /= name)
    if (.not. allocated(self%number)) return
    ! The numbers with errors are those of the removed places, and lose their name.
    do i = 1, size(self%number)
      if (self%number(i)%name == name) self%number(i)%name = ''
    end do
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

  !> All elements of all numbers, with the errors of iteration and rounding; in SI units if
  !> `problem` is present.
  pure function numbers(self, problem) result(all)
    class(places_t), intent(in) :: self
    type(problem_t), intent(in), optional :: problem
    type(number_t), allocatable :: all(:)
    type(number_t) :: new
    integer :: i, k, n

    n = 0
    if (allocated(self%entry)) n = size(self%entry)
    allocate (all(n))
    n = 0
    do i = 1, size(all)
      associate (entry => self%entry(i))
        do k = n, 1, -1
          if (all(k)%name == entry%name .and. all(k)%element == entry%element) exit
        end do
        if (k == 0) then
          n = n + 1
          k = n
          all(k) = new
          all(k)%name = entry%name
          all(k)%element = entry%element
        end if
        call add_term(self, entry, all(k), problem)
      end associate
    end do
    all = all(:n)
  end function numbers

  !> Adds a term to an element of a number.
  pure subroutine add_term(self, entry, number, problem)
    class(places_t), intent(in) :: self
    type(entry_t), intent(in) :: entry
    type(number_t), intent(inout) :: number
    type(problem_t), intent(in), optional :: problem
    real(wp), dimension(quantities) :: values, left

    if (entry%place == 0) then
      number%value = number%value + entry%factor
      return
    end if
    associate (place => self%place(entry%place))
      values = place%measures()
      left = place%leftovers()
      if (present(problem)) then
        values = values_of(problem, place)
        left = left*units_of(problem)
      end if
      number%value = number%value + entry%factor*values
      number%scale = max(number%scale, place%scale)
      number%error = number%error + abs(entry%factor)*left
      if (all(of_energies /= entry%name)) &
        number%compared = place%compared(any(with_radius == entry%name))
      if (all(of_profiles /= entry%name)) then
        number%compared(of_profile) = .false.
        return
      end if
      number%error(of_profile) = rounding
      if (.not. allocated(place%gap)) return
      number%gap = place%gap
      number%pressure = place%pressure
    end associate
  end subroutine add_term

  !> Finds the errors of those numbers that have none yet, by comparison with other runs; part: see
  !> `judge`.
  pure subroutine judge_by(self, others, part)
    class(places_t), intent(inout) :: self
    type(run_numbers_t), intent(in) :: others(:)
    real(wp), intent(in) :: part
    type(number_t), allocatable :: all(:)
    integer :: i, k

    all = self%numbers()
    if (allocated(self%number)) then
      do i = 1, size(all)
        do k = 1, size(self%number)
          if (self%number(k)%name == all(i)%name .and. &
            self%number(k)%element == all(i)%element) all(i) = self%number(k)
        end do
      end do
    end if
    call judge(all, others, part)
    call move_alloc(all, self%number)
  end subroutine judge_by

end module places
