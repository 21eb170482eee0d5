!> The sum of several forces. A single law is not converted into a sum, which saves time.
module force_sum
  use kinds, only: wp
  use force_law, only: force_law_t, of_pressure, of_slope, of_energy
  use law_scan, only: find_scales
  implicit none
  private
  public :: add_term, settle

  !> One of the forces. In its own units its gap is stretch*gap + shift; its pressure is multiplied
  !> by `weight`.
  type :: term_t
    class(force_law_t), allocatable :: law
    real(wp) :: stretch = 1, shift = 0, weight = 1
  end type term_t

  type, extends(force_law_t) :: force_sum_t
    type(term_t), allocatable :: term(:)
  contains
    procedure :: evaluate
    procedure :: closure
    procedure :: table_error
  end type force_sum_t

contains

  !> Adds a term to a law. Either may be unallocated. The term is moved, not copied.
  subroutine add_term(law, term)
    class(force_law_t), allocatable, intent(inout) :: law, term
    type(force_sum_t) :: sum_of
    type(term_t), allocatable :: terms(:)
    integer :: n

    if (.not. allocated(term)) return
    if (.not. allocated(law)) then
      call move_alloc(term, law)
      return
    end if
    allocate (terms(terms_in(law) + terms_in(term)))
    n = 0
    call take(law)
    call take(term)
    call move_alloc(terms, sum_of%term)
    allocate (law, source=sum_of)

  contains

    !> Moves the terms of a law, or the law itself, into the list of terms.
    subroutine take(from)
      class(force_law_t), allocatable, intent(inout) :: from
      integer :: i

      select type (from)
      type is (force_sum_t)
        do i = 1, size(from%term)
          call move_alloc(from%term(i)%law, terms(n + i)%law)
        end do
        n = n + size(from%term)
      class default
        n = n + 1
        allocate (terms(n)%law, source=from)
      end select
      deallocate (from)
    end subroutine take

  end subroutine add_term

  !> Number of forces in a law, which may be larger than the number of groups.
  pure integer function terms_in(law)
    class(force_law_t), intent(in) :: law

    terms_in = 1
    select type (law)
    type is (force_sum_t)
      terms_in = size(law%term)
    end select
  end function terms_in

  !> Sets units and scales of a law with all its terms. A sum is first scanned in units of its
  !> shortest length. If it has a minimum with an attraction outside, the scales of this minimum
  !> become its units. The length is the z0 of the first term that has one, otherwise the range
  !> (depth over largest tension); the unit of pressure is the largest tension. The equilibrium is
  !> at gap 1. The same is done for a single law without units of its own.
  subroutine settle(law)
    class(force_law_t), allocatable, intent(inout) :: law
    type(force_sum_t) :: alone
    type(term_t), allocatable :: terms(:)
    real(wp) :: most, length, unit, origin
    logical :: has_z0
    integer :: i

    if (.not. law%has_units) then
      allocate (alone%term(1))
      call move_alloc(law, alone%term(1)%law)
      allocate (law, source=alone)
    end if
    select type (law)
    type is (force_sum_t)
      unit = maxval([(law%term(i)%law%pressure_unit, i=1, size(law%term))])
      length = minval(lengths(law))
      call move_alloc(law%term, terms)
      call take_units(law, terms, length, unit, 0.0_wp)
      call find_scales(law)
      if (law%edge_gap > 0 .and. law%adhesion > 0) then
        most = -law%at(of_pressure, law%edge_gap)
        length = law%length*law%adhesion/most
        has_z0 = .false.
        do i = 1, size(law%term)
          if (.not. law%term(i)%law%has_z0) cycle
          length = law%term(i)%law%length
          has_z0 = .true.
          exit
        end do
        unit = law%pressure_unit*most
        origin = law%separation_of(law%rest_gap) - length
        call move_alloc(law%term, terms)
        call take_units(law, terms, length, unit, origin)
        law%has_z0 = has_z0
        call find_scales(law)
      end if
    class default
      call find_scales(law)
    end select
  end subroutine settle

  !> Makes the sum of these terms, which are moved, in the given units. Its scales are not yet
  !> known.
  subroutine take_units(law, terms, length, unit, origin)
    type(force_sum_t), intent(out) :: law
    type(term_t), allocatable, intent(inout) :: terms(:)
    real(wp), intent(in) :: length, unit, origin
    real(wp), allocatable :: breaks(:), kinks(:)
    integer :: i

    call move_alloc(terms, law%term)
    law%terms = size(law%term)
    law%length = length
    law%pressure_unit = unit
    law%origin = origin
    law%smallest_gap = -huge(1.0_wp)
    law%repulsion_length = huge(1.0_wp)
    allocate (breaks(0), kinks(0))
    do i = 1, size(law%term)
      associate (term => law%term(i), part => law%term(i)%law)
        term%stretch = length/part%length
        term%shift = (origin - part%origin)/part%length
        term%weight = part%pressure_unit/unit
        law%smallest_gap = max(law%smallest_gap, (part%smallest_gap - term%shift)/term%stretch)
        if (part%has_length) &
          law%repulsion_length = min(law%repulsion_length, part%repulsion_length/term%stretch)
        law%tail_power = min(law%tail_power, part%tail_power)
        law%known_from = max(law%known_from, part%known_from)
        if (law%caveat == '') law%caveat = part%caveat
        if (part%period > 0) law%period = part%period/term%stretch
        if (allocated(part%breaks)) breaks = [breaks, (part%breaks - term%shift)/term%stretch]
        if (allocated(part%kinks)) kinks = [kinks, (part%kinks - term%shift)/term%stretch]
        if (.not. part%step_width > 0) cycle
        law%step_at = (part%step_at - term%shift)/term%stretch
        law%step_width = part%step_width/term%stretch
      end associate
    end do
    call move_alloc(breaks, law%breaks)
    if (size(kinks) > 0) call move_alloc(kinks, law%kinks)
    if (.not. law%repulsion_length < huge(1.0_wp)) law%repulsion_length = 1
    ! Messages refer to the first term.
    law%group = law%term(1)%law%group
    law%strength_key = law%term(1)%law%strength_key
    law%length_key = law%term(1)%law%length_key
  end subroutine take_units

  !> The gap of a term in its own units, at a gap of the sum.
  elemental real(wp) function own_gap(term, gap)
    type(term_t), intent(in) :: term
    real(wp), intent(in) :: gap

    own_gap = term%stretch*gap + term%shift
  end function own_gap

  !> Lengths of those terms that have a characteristic length, or of all terms if no term has one.
  pure function lengths(law)
    type(force_sum_t), intent(in) :: law
    real(wp), allocatable :: lengths(:)
    logical :: has(size(law%term))
    integer :: i

    has = [(law%term(i)%law%has_length, i=1, size(has))]
    lengths = pack([(law%term(i)%law%length, i=1, size(has))], has .or. .not. any(has))
  end function lengths

  pure subroutine evaluate(self, quantity, gap, value)
    class(force_sum_t), intent(in) :: self
    integer, intent(in) :: quantity
    real(wp), intent(in) :: gap(:)
    real(wp), intent(out) :: value(size(gap))
    real(wp) :: own(size(gap)), factor
    integer :: i

    value = 0
    do i = 1, size(self%term)
      associate (term => self%term(i))
        call term%law%evaluate(quantity, own_gap(term, gap), own)
        factor = term%weight
        if (quantity == of_slope) factor = term%weight*term%stretch
        if (quantity == of_energy) factor = term%weight/term%stretch
        value = value + factor*own
      end associate
    end do
  end subroutine evaluate

  pure function table_error(self, gap) result(value)
    class(force_sum_t), intent(in) :: self
    real(wp), intent(in) :: gap(:)
    real(wp) :: value(2, size(gap)), own(2, size(gap))
    integer :: i

    value = 0
    do i = 1, size(self%term)
      associate (term => self%term(i))
        own = term%law%table_error(own_gap(term, gap))
        value(1, :) = value(1, :) + term%weight*own(1, :)
        value(2, :) = value(2, :) + term%weight/term%stretch*own(2, :)
      end associate
    end do
  end function table_error

  !> The smallest closure of all forces. Beyond the range of the repulsion, half of the excess over
  !> this range is also allowed, since distant gaps are large, and so are the errors of their
  !> prediction.
  pure function closure(self, gap) result(most)
    class(force_sum_t), intent(in) :: self
    real(wp), intent(in) :: gap(:)
    real(wp) :: most(size(gap))
    integer :: i

    most = huge(1.0_wp)
    do i = 1, size(self%term)
      associate (term => self%term(i))
        most = min(most, term%law%closure(own_gap(term, gap))/term%stretch)
      end associate
    end do
    if (self%range > 0) most = max(most, 0.5_wp*(gap - self%range))
  end function closure

end module force_sum
