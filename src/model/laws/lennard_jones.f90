!> Lennard-Jones pressure between half-spaces, (33) of the paper,
!> p = A/(6 pi h^3) [(z0/h)^6 - 1], whole or either of its parts alone.
!> In units of z0 and gamma/z0, with gamma = A/(16 pi z0^2) (34), it is (8/3) (H^-9 - H^-3).
module lennard_jones
  use kinds, only: wp, pi
  use deck, only: deck_t
  use deck_keys, only: key_spec, real_value, real_list, word_value
  use force_law, only: force_law_t, of_pressure, of_slope
  use power_pair, only: power_pair_t, new_power_pair, pair_factor
  use group_reading, only: is_law, require, refuse_foreign, check_decades
  implicit none
  private
  public :: lennard_jones_t, keys, read_law

  !> The pair of the powers 9 and 3; products compute them faster than general powers.
  type, extends(power_pair_t) :: lennard_jones_t
  contains
    procedure :: evaluate
  end type lennard_jones_t

  !> The keys of the law in &force.
  type(key_spec), parameter :: keys(*) = [ &
    key_spec('force', 'hamaker', real_value, 'lennard_jones: Hamaker constant.', 'J', &
      above=0.0_wp, otherwise='none; lennard_jones needs it'), &
    key_spec('force', 'z0', real_value, 'lennard_jones: separation of zero force.', 'm', &
      above=0.0_wp, otherwise='none; lennard_jones needs it'), &
    key_spec('force', 'work_of_adhesion', real_value, 'lennard_jones: work of adhesion, the ' // &
      'energy needed to separate unit area, instead of hamaker.', 'J/m^2', above=0.0_wp, &
      former='surface_energy'), &
    key_spec('force', 'exponents', real_list, 'lennard_jones: exponents n, m of the pressure: ' // &
      '9, 3 half-spaces; 10, 4 half-space and sheet; 11, 5 sheets.', most=2, above=1.0_wp, &
      high=30.0_wp, otherwise='9, 3'), &
    key_spec('force', 'part', word_value, 'lennard_jones: the part of the law that acts.', &
      choices='full repulsive attractive', otherwise='full')]

contains

  !> Reads the law from its group.
  subroutine read_law(deck, law)
    type(deck_t), intent(inout) :: deck
    class(force_law_t), allocatable, intent(out) :: law
    character(len=:), allocatable :: part
    real(wp), allocatable :: exponents(:)
    real(wp) :: hamaker, z0, surface_energy

    call refuse_foreign(deck, 'force', 'law', 'lennard_jones', keys)
    if (.not. is_law(deck, 'lennard_jones')) return
    if (.not. deck%is_set('force', 'work_of_adhesion')) &
      call require(deck, 'force', 'law', 'lennard_jones', 'hamaker')
    call require(deck, 'force', 'law', 'lennard_jones', 'z0')
    if (allocated(deck%error)) return
    call deck%assume('force', 'part', 'full')
    if (deck%is_set('force', 'work_of_adhesion') .and. deck%is_set('force', 'hamaker')) &
      call deck%mistake('force', 'work_of_adhesion', 'follows from hamaker; give one of the two')
    call deck%get('force', 'z0', z0)
    call deck%get('force', 'part', part)
    call deck%get('force', 'exponents', exponents)
    if (size(exponents) > 0) then
      call check_exponents()
      if (allocated(deck%error)) return
    end if
    ! gamma = A/(16 pi z0^2), (34).
    if (deck%is_set('force', 'work_of_adhesion')) then
      call deck%get('force', 'work_of_adhesion', surface_energy)
      hamaker = 16*pi*surface_energy*z0**2
    else
      call deck%get('force', 'hamaker', hamaker)
    end if
    call check_decades(deck, 'force', 'hamaker', log10(hamaker) - log10(16*pi) - 3*log10(z0), &
      'a pressure', ' Pa')
    if (allocated(deck%error)) return
    allocate (law, source=new_lennard_jones(hamaker, z0, part))
    if (size(exponents) == 0) return
    ! The attraction is A/(6 pi h^3) if the deck gives the Hamaker constant A.
    if (.not. deck%is_set('force', 'work_of_adhesion')) &
      surface_energy = hamaker/(6*pi*z0**2*pair_factor(exponents))
    deallocate (law)
    allocate (law, source=new_power_pair(surface_energy, z0, exponents, part))

  contains

    subroutine check_exponents()
      if (size(exponents) /= 2) then
        call deck%mistake('force', 'exponents', 'give two')
      else if (exponents(1) <= exponents(2)) then
        call deck%mistake('force', 'exponents', 'the first, of the repulsion, must be the '// &
          'larger')
      else if (abs(exponents(2) - 3) > 0 .and. .not. deck%is_set('force', 'work_of_adhesion')) then
        call deck%mistake('force', 'work_of_adhesion', 'missing; a Hamaker constant needs an '// &
          'attraction of h^-3')
      end if
    end subroutine check_exponents

  end subroutine read_law

  !> Makes the law; hamaker [J] and z0 [m] must be positive, and part is 'full', 'repulsive' or
  !> 'attractive'.
  pure type(lennard_jones_t) function new_lennard_jones(hamaker, z0, part) result(law)
    real(wp), intent(in) :: hamaker, z0
    character(len=*), intent(in) :: part

    law%power_pair_t = new_power_pair(hamaker/(16*pi*z0**2), z0, [9.0_wp, 3.0_wp], part)
    law%tail_power = 3
    law%strength_key = 'hamaker'
  end function new_lennard_jones

  pure subroutine evaluate(self, quantity, gap, value)
    class(lennard_jones_t), intent(in) :: self
    integer, intent(in) :: quantity
    real(wp), intent(in) :: gap(:)
    real(wp), intent(out) :: value(size(gap))

    select case (quantity)
    case (of_pressure)
      ! `value` first holds the inverse cube, which saves an array.
      value = 1/gap**3
      value = value*(self%repulsive*value*value - self%attractive)
    case (of_slope)
      value = 1/gap**3
      value = 3*value/gap*(self%attractive - 3*self%repulsive*value*value)
    case default
      value = 1/gap**2
      value = value/8*(self%repulsive*value**3 - 4*self%attractive)
    end select
  end subroutine evaluate

end module lennard_jones
