!> Van der Waals attraction between half-spaces: p = -A/(6 pi h^3), or retarded
!> (Gregory, J. Colloid Interface Sci. 83, 138, 1981): the energy -A/(12 pi h^2) is divided by
!> 1 + c h, c = 5.32/retardation_length, so that p falls as h^-4 at large h.
module van_der_waals
  use kinds, only: wp, pi
  use failure, only: failure_t
  use deck, only: deck_t
  use deck_keys, only: key_spec, group, real_key
  use force_law, only: force_law_t
  use law_reading, only: check_decades
  implicit none
  private
  public :: keys, read_law

  type, extends(force_law_t) :: van_der_waals_t
    !> c in units of 1/length; 0: not retarded.
    real(wp) :: retardation = 0
  contains
    procedure :: pressure
    procedure :: slope
    procedure :: energy
  end type van_der_waals_t

  !> Gregory's constant, and the unit of gap [m].
  real(wp), parameter :: gregory = 5.32_wp, nanometre = 1.0e-9_wp

contains

  !> The rows of &van_der_waals.
  pure function keys() result(rows)
    type(key_spec), allocatable :: rows(:)

    rows = [ &
      group('van_der_waals', 'Van der Waals attraction, retarded or not; needs a repulsion ' // &
            'such as &born beside it.'), &
      real_key('van_der_waals', 'hamaker', 'J', 'Hamaker constant.', above=0.0_wp, &
               required=.true.), &
      real_key('van_der_waals', 'retardation_length', 'm', 'Wavelength beyond which the ' // &
               'attraction is retarded, about 100 nm.', above=0.0_wp, otherwise='no retardation')]
  end function keys

  !> The law, if the deck has its group. It has no characteristic length.
  subroutine read_law(deck, law, error)
    type(deck_t), intent(inout) :: deck
    class(force_law_t), allocatable, intent(out) :: law
    type(failure_t), allocatable, intent(inout) :: error
    type(van_der_waals_t) :: this
    real(wp) :: hamaker, wavelength

    if (.not. deck%has_group('van_der_waals')) return
    call deck%get('van_der_waals', 'hamaker', hamaker)
    this%length = nanometre
    this%has_length = .false.
    call check_decades(deck, 'van_der_waals', 'hamaker', &
      log10(hamaker) - log10(6*pi) - 3*log10(this%length), 'a pressure', ' Pa', error)
    if (allocated(error)) return
    this%pressure_unit = hamaker/(6*pi*this%length**3)
    this%tail_power = 3
    if (deck%is_set('van_der_waals', 'retardation_length')) then
      call deck%get('van_der_waals', 'retardation_length', wavelength)
      this%retardation = gregory*this%length/wavelength
      this%tail_power = 4
    end if
    this%smallest_gap = 1.0e-12_wp
    this%closure_fraction = 0.3_wp
    this%group = 'van_der_waals'
    this%strength_key = 'hamaker'
    this%length_key = 'hamaker'
    allocate (law, source=this)
  end subroutine read_law

  pure function pressure(self, gap) result(value)
    class(van_der_waals_t), intent(in) :: self
    real(wp), intent(in) :: gap(:)
    real(wp) :: value(size(gap))

    associate (c => self%retardation)
      value = -(1 + 1.5_wp*c*gap)/((1 + c*gap)**2*gap**3)
    end associate
  end function pressure

  pure function slope(self, gap) result(value)
    class(van_der_waals_t), intent(in) :: self
    real(wp), intent(in) :: gap(:)
    real(wp) :: value(size(gap))

    associate (c => self%retardation)
      value = (3*(1 + 1.5_wp*c*gap)/gap + c*(0.5_wp + 1.5_wp*c*gap)/(1 + c*gap)) &
        /((1 + c*gap)**2*gap**3)
    end associate
  end function slope

  pure function energy(self, gap) result(value)
    class(van_der_waals_t), intent(in) :: self
    real(wp), intent(in) :: gap(:)
    real(wp) :: value(size(gap))

    value = -0.5_wp/((1 + self%retardation*gap)*gap**2)
  end function energy

end module van_der_waals
