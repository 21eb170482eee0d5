!> Van der Waals attraction between half-spaces: p = -A/(6 pi h^3), or retarded
!> (Gregory, J. Colloid Interface Sci. 83, 138, 1981): the energy -A/(12 pi h^2) is divided by
!> 1 + c h, c = 5.32/retardation_length, so that p falls as h^-4 at large h.
module van_der_waals
  use kinds, only: wp, pi
  use deck, only: deck_t
  use deck_keys, only: key_spec, real_value
  use force_law, only: force_law_t, of_pressure, of_slope, usual_closure, nearest_power
  use group_reading, only: accept_law
  implicit none
  private
  public :: keys, read_law

  type, extends(force_law_t) :: van_der_waals_t
    !> c in units of 1/length; 0 without retardation.
    real(wp) :: retardation = 0
  contains
    procedure :: evaluate
  end type van_der_waals_t

  !> Gregory's constant, and the unit of gap [m].
  real(wp), parameter :: gregory = 5.32_wp, nanometre = 1.0e-9_wp

  !> The rows of &van_der_waals.
  type(key_spec), parameter :: keys(*) = [ &
    key_spec('van_der_waals', meaning='Van der Waals attraction, retarded or not; needs a ' // &
      'repulsion such as &born beside it.', &
      choices='&van_der_waals hamaker = 5e-20 /'), &
    key_spec('van_der_waals', 'hamaker', real_value, 'Hamaker constant.', 'J', above=0.0_wp, &
      required=.true.), &
    key_spec('van_der_waals', 'retardation_length', real_value, 'Wavelength beyond which the ' // &
      'attraction is retarded, about 100 nm.', 'm', above=0.0_wp, otherwise='no retardation')]

contains

  !> Reads the law from its group. The law has no characteristic length.
  subroutine read_law(deck, law)
    type(deck_t), intent(inout) :: deck
    class(force_law_t), allocatable, intent(out) :: law
    type(van_der_waals_t) :: this
    real(wp) :: hamaker, wavelength

    call deck%get('van_der_waals', 'hamaker', hamaker)
    this%length = nanometre
    this%has_length = .false.
    this%pressure_unit = hamaker/(6*pi*this%length**3)
    this%tail_power = 3
    if (deck%is_set('van_der_waals', 'retardation_length')) then
      call deck%get('van_der_waals', 'retardation_length', wavelength)
      this%retardation = gregory*this%length/wavelength
      this%tail_power = 4
    end if
    this%smallest_gap = nearest_power
    this%closure_fraction = usual_closure
    call accept_law(deck, 'van_der_waals', 'hamaker', 'hamaker', this, law)
  end subroutine read_law

  pure subroutine evaluate(self, quantity, gap, value)
    class(van_der_waals_t), intent(in) :: self
    integer, intent(in) :: quantity
    real(wp), intent(in) :: gap(:)
    real(wp), intent(out) :: value(size(gap))

    associate (c => self%retardation)
      select case (quantity)
      case (of_pressure)
        value = -(1 + 1.5_wp*c*gap)/((1 + c*gap)**2*gap**3)
      case (of_slope)
        value = (3*(1 + 1.5_wp*c*gap)/gap + c*(0.5_wp + 1.5_wp*c*gap)/(1 + c*gap)) &
          /((1 + c*gap)**2*gap**3)
      case default
        value = -0.5_wp/((1 + c*gap)*gap**2)
      end select
    end associate
  end subroutine evaluate

end module van_der_waals
