!> Exponential repulsion, (30) of the paper: p = p0 exp(-h/decay_length). Other forces with this
!> decay, among them attractions, use this type too.
module exponential
  use kinds, only: wp
  use deck, only: deck_t
  use deck_keys, only: key_spec, real_value
  use force_law, only: force_law_t, of_slope
  use force_sum, only: add_term
  use group_reading, only: is_law, require, refuse_foreign, accept_law
  implicit none
  private
  public :: exponential_t, keys, read_law, read_exponentials, largest_exponent

  type, extends(force_law_t) :: exponential_t
    !> 1 for a repulsion, -1 for an attraction.
    real(wp) :: sense = 1
  contains
    procedure :: evaluate
  end type exponential_t

  !> Largest magnitude of the exponent at which exp neither underflows nor overflows.
  real(wp), parameter :: largest_exponent = 700

  !> The keys of the law in &force.
  type(key_spec), parameter :: keys(*) = [ &
    key_spec('force', 'p0', real_value, 'exponential: pressure at zero separation.', 'Pa', &
      above=0.0_wp, otherwise='none; exponential needs it'), &
    key_spec('force', 'decay_length', real_value, 'exponential: decay length.', 'm', above=0.0_wp, &
      otherwise='none; exponential needs it')]

contains

  !> Reads the law from its group.
  subroutine read_law(deck, law)
    type(deck_t), intent(inout) :: deck
    class(force_law_t), allocatable, intent(out) :: law
    type(exponential_t) :: this
    real(wp) :: p0, decay_length

    call refuse_foreign(deck, 'force', 'law', 'exponential', keys)
    if (.not. is_law(deck, 'exponential')) return
    call require(deck, 'force', 'law', 'exponential', 'p0')
    call require(deck, 'force', 'law', 'exponential', 'decay_length')
    if (allocated(deck%error)) return
    call deck%get('force', 'p0', p0)
    call deck%get('force', 'decay_length', decay_length)
    this = new_exponential(p0, decay_length)
    this%coupling_name = 'big_lambda'
    call accept_law(deck, 'force', 'p0', 'decay_length', this, law)
  end subroutine read_law

  !> Reads the terms of a group with the lists `decay_length` and `energy` or `pressure`. sense: 1
  !> for repulsion, -1 for attraction. If a list has one value, this value holds for all terms.
  subroutine read_exponentials(deck, group, sense, law)
    type(deck_t), intent(inout) :: deck
    character(len=*), intent(in) :: group
    real(wp), intent(in) :: sense
    class(force_law_t), allocatable, intent(out) :: law
    class(force_law_t), allocatable :: term
    type(exponential_t) :: this
    real(wp), allocatable :: lengths(:), strengths(:)
    character(len=:), allocatable :: key
    logical :: of_energy
    integer :: i, n

    of_energy = deck%is_set(group, 'energy')
    if (of_energy .eqv. deck%is_set(group, 'pressure')) then
      call deck%mistake(group, 'energy', 'give either energy or pressure')
      return
    end if
    key = 'pressure'
    if (of_energy) key = 'energy'
    call deck%get(group, 'decay_length', lengths)
    call deck%get(group, key, strengths)
    n = max(size(lengths), size(strengths))
    if (any([size(lengths), size(strengths)] /= n .and. [size(lengths), size(strengths)] /= 1)) then
      call deck%mistake(group, key, 'has another number of values than decay_length')
      return
    end if
    if (size(lengths) < n) lengths = spread(lengths(1), 1, n)
    if (size(strengths) < n) strengths = spread(strengths(1), 1, n)
    do i = 1, n
      this = new_exponential(strengths(i)/merge(lengths(i), 1.0_wp, of_energy), lengths(i))
      this%sense = sense
      ! The scan of a law finds the scales of an attraction.
      if (sense < 0) this%range = 0
      call accept_law(deck, group, key, 'decay_length', this, term)
      if (allocated(deck%error)) return
      call add_term(law, term)
    end do
  end subroutine read_exponentials

  !> Makes the law; p0 [Pa] and decay_length [m] must be positive.
  pure type(exponential_t) function new_exponential(p0, decay_length) result(law)
    real(wp), intent(in) :: p0, decay_length

    law%length = decay_length
    law%pressure_unit = p0
    law%range = 45
    ! In one iteration the pressure may grow by a factor of seven.
    law%closure_length = 2
  end function new_exponential

  !> sense*exp(-gap), which is 0 without underflow at large gaps, and finite at any gap.
  pure subroutine evaluate(self, quantity, gap, value)
    class(exponential_t), intent(in) :: self
    integer, intent(in) :: quantity
    real(wp), intent(in) :: gap(:)
    real(wp), intent(out) :: value(size(gap))

    ! Both branches of a mask may be evaluated for all elements, hence the bounds on both sides.
    where (gap < largest_exponent)
      value = self%sense*exp(-max(min(gap, largest_exponent), -largest_exponent))
    elsewhere
      value = 0
    end where
    if (quantity == of_slope) value = -value
  end subroutine evaluate

end module exponential
