!> Born repulsion between half-spaces, p = A/(6 pi z0^3) (z0/h)^n: with n = 9 and a van der Waals
!> attraction of the same Hamaker constant it is the Lennard-Jones law (33) of the paper.
module born
  use kinds, only: wp, pi
  use deck, only: deck_t
  use deck_keys, only: key_spec, real_value
  use force_law, only: force_law_t
  use group_reading, only: accept_law
  use power_pair, only: power_pair_t
  implicit none
  private
  public :: keys, read_law

  !> The rows of &born.
  type(key_spec), parameter :: keys(*) = [ &
    key_spec('born', meaning='Born repulsion, A/(6 pi z0^3) (z0/h)^n.', &
      choices='&born z0 = 0.25e-9 /'), &
    key_spec('born', 'hamaker', real_value, 'Hamaker constant A for the strength.', 'J', &
      above=0.0_wp, otherwise='as in &van_der_waals'), &
    key_spec('born', 'z0', real_value, 'Separation at which the repulsion balances the ' // &
      'attraction.', 'm', above=0.0_wp, required=.true.), &
    key_spec('born', 'exponent', real_value, 'Exponent n.', above=1.0_wp, high=30.0_wp, &
      default='9')]

contains

  !> Reads the law from its group.
  subroutine read_law(deck, law)
    type(deck_t), intent(inout) :: deck
    class(force_law_t), allocatable, intent(out) :: law
    type(power_pair_t) :: this
    real(wp) :: hamaker

    if (.not. (deck%is_set('born', 'hamaker') .or. deck%has_group('van_der_waals'))) then
      call deck%mistake('born', 'hamaker', 'missing; give it, or &van_der_waals with this '// &
        'constant')
      return
    end if
    hamaker = 0
    call deck%get('van_der_waals', 'hamaker', hamaker)
    if (hamaker > 0) call deck%assume('born', 'hamaker', hamaker)
    call deck%get('born', 'hamaker', hamaker)
    call deck%get('born', 'z0', this%length)
    call deck%get('born', 'exponent', this%n)
    this%pressure_unit = hamaker/(6*pi*this%length**3)
    this%repulsive = 1
    this%tail_power = this%n
    call this%set_scales()
    call accept_law(deck, 'born', 'hamaker', 'z0', this, law)
  end subroutine read_law

end module born
