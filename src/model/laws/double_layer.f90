!> Electric double layers of two surfaces in a symmetric electrolyte, in Debye lengths 1/kappa and
!> with reduced potentials y = z e psi/(kT):
!>
!> linear          the linear Poisson-Boltzmann equation with charge regulation (Carnie and Chan,
!>                 J. Colloid Interface Sci. 161, 260, 1993); constant potential and constant charge
!>                 are those of Hogg, Healy and Fuerstenau
!> superposition   p = 64 n kT tanh(y1/4) tanh(y2/4) exp(-kappa h)
!> nonlinear       the Poisson-Boltzmann equation itself (`poisson_boltzmann`)
!>
!> The pressure unit is 64 n kT tanh^2(y1/4), y1 the larger potential.
module double_layer
  use kinds, only: wp
  use physical_constants, only: elementary_charge, boltzmann, vacuum_permittivity, avogadro
  use special_functions, only: largest_exponent
  use deck, only: deck_t
  use deck_keys, only: key_spec, real_value, real_list, integer_value, word_value
  use force_law, only: force_law_t, of_slope, usual_closure
  use group_reading, only: check_decades
  use poisson_boltzmann, only: surface_t
  use layer_table, only: layer_table_t, new_layer_table, nearest_gap
  implicit none
  private
  public :: keys, read_law

  integer, parameter :: linear = 1, superposition = 2, nonlinear = 3
  character(len=*), parameter :: models = 'linear superposition nonlinear'

  type, extends(force_law_t) :: double_layer_t
    integer :: model = linear
    type(surface_t) :: surface(2)
    !> 2 n kT divided by the pressure unit.
    real(wp) :: scale = 1
    type(layer_table_t) :: table
  contains
    procedure :: evaluate
  end type double_layer_t

  !> Reduced potential above which the linear equation is inaccurate: 25.7 mV for univalent ions.
  real(wp), parameter :: small_potential = 1
  !> Largest reduced potential, 0.5 V for univalent ions, above which the finite size of ions
  !> matters.
  real(wp), parameter :: largest_potential = 20

  !> The rows of &double_layer.
  type(key_spec), parameter :: keys(*) = [ &
    key_spec('double_layer', meaning='Electric double layers in an electrolyte with ions of ' // &
      'one valence. Give salt or debye_length.', &
      choices='&double_layer potential = -0.05, salt = 10 /'), &
    key_spec('double_layer', 'potential', real_list, 'Potentials of the two isolated ' // &
      'surfaces, or one for both.', 'V', most=2, required=.true.), &
    key_spec('double_layer', 'regulation', real_list, 'Regulation of the two surfaces, or one ' // &
      'value for both: 0 constant potential, 1 constant charge, or between them.', most=2, &
      low=0.0_wp, high=1.0_wp, otherwise='1'), &
    key_spec('double_layer', 'salt', real_value, 'Concentration of the salt.', 'mol/m^3', &
      above=0.0_wp, otherwise='from debye_length'), &
    key_spec('double_layer', 'valence', integer_value, 'Charge number of the ions.', low=1, &
      high=6, default='1'), &
    key_spec('double_layer', 'debye_length', real_value, 'Debye length 1/kappa.', 'm', &
      above=0.0_wp, otherwise='from salt'), &
    key_spec('double_layer', 'permittivity', real_value, 'Relative permittivity of the liquid.', &
      above=0.0_wp, default='78.4'), &
    key_spec('double_layer', 'temperature', real_value, 'Temperature.', 'K', above=0.0_wp, &
      default='298.15'), &
    key_spec('double_layer', 'model', word_value, 'For small potentials; for large gaps; or ' // &
      'the whole Poisson-Boltzmann equation.', choices=models, default='nonlinear')]

contains

  !> Reads the law from its group.
  subroutine read_law(deck, law)
    type(deck_t), intent(inout) :: deck
    class(force_law_t), allocatable, intent(out) :: law
    type(double_layer_t) :: this
    character(len=:), allocatable :: model
    real(wp) :: osmotic
    logical :: solved

    call deck%get('double_layer', 'model', model)
    this%model = linear
    if (model == 'superposition') this%model = superposition
    if (model == 'nonlinear') this%model = nonlinear
    call take_electrolyte(deck, this, osmotic)
    if (allocated(deck%error)) return
    if (this%model == linear .and. this%surface(1)%potential > small_potential) this%caveat = &
      'double_layer: model = ''linear'' is for potentials below kT/(z e), 25.7 mV for single ' // &
      'charges at room temperature; pressures may be wrong by orders of magnitude: leave model out'
    this%scale = 1/(32*tanh(this%surface(1)%potential/4)**2)
    this%pressure_unit = osmotic/this%scale
    this%group = 'double_layer'
    this%strength_key = 'potential'
    this%length_key = merge('debye_length', 'salt        ', &
      deck%is_set('double_layer', 'debye_length'))
    if (this%model == superposition) then
      this%closure_length = 2
    else
      ! closure_fraction is a third of the gap; at small gaps the repulsion may be as large as
      ! gap^-2.
      this%smallest_gap = nearest_gap
      this%closure_fraction = usual_closure
      this%repulsion_length = 0.5_wp
    end if
    if (this%model == nonlinear) then
      call new_layer_table(this%surface, this%table, solved)
      if (.not. solved) then
        call deck%mistake('double_layer', 'model', 'the Poisson-Boltzmann equation could not be ' &
          // 'solved at every gap for these potentials and this regulation')
        return
      end if
    end if
    allocate (law, source=this)
  end subroutine read_law

  !> Sets the Debye length and the surfaces. osmotic: 2 n kT [Pa].
  subroutine take_electrolyte(deck, this, osmotic)
    type(deck_t), intent(inout) :: deck
    type(double_layer_t), intent(inout) :: this
    real(wp), intent(out) :: osmotic
    real(wp), allocatable :: potential(:), regulation(:)
    real(wp) :: salt, permittivity, temperature, thermal, decades
    integer :: valence

    osmotic = 0
    if (deck%is_set('double_layer', 'salt') .eqv. deck%is_set('double_layer', 'debye_length')) then
      if (deck%is_set('double_layer', 'salt')) then
        call deck%mistake('double_layer', 'debye_length', 'salt gives it already; give ' // &
          'debye_length or salt')
      else
        call deck%mistake('double_layer', 'salt', 'missing; give salt or debye_length')
      end if
      return
    end if
    call deck%assume('double_layer', 'regulation', 1.0_wp)
    call deck%get('double_layer', 'potential', potential)
    call deck%get('double_layer', 'regulation', regulation)
    call deck%get('double_layer', 'permittivity', permittivity)
    call deck%get('double_layer', 'temperature', temperature)
    call deck%get('double_layer', 'valence', valence)
    thermal = boltzmann*temperature/(valence*elementary_charge)
    permittivity = permittivity*vacuum_permittivity
    if (deck%is_set('double_layer', 'salt')) then
      call deck%get('double_layer', 'salt', salt)
      this%length = sqrt(permittivity)*sqrt(thermal/(2*avogadro*salt*valence*elementary_charge))
    else
      call deck%get('double_layer', 'debye_length', this%length)
    end if
    ! The surface with the larger potential is made the first one, and the sign of its potential
    ! positive; neither changes the pressure.
    this%surface%potential = [potential(1), potential(size(potential))]/thermal
    this%surface%regulation = [regulation(1), regulation(size(regulation))]
    if (abs(this%surface(2)%potential) > abs(this%surface(1)%potential)) &
      this%surface = this%surface([2, 1])
    if (this%surface(1)%potential < 0) this%surface%potential = -this%surface%potential
    if (.not. this%surface(1)%potential > 0) then
      call deck%mistake('double_layer', 'potential', 'without a potential there is no double ' // &
        'layer; leave the group out')
    else if (this%surface(1)%potential > largest_potential) then
      call deck%mistake('double_layer', 'potential', 'more than 20 kT for each ion: the size ' // &
        'of ions would matter')
    end if
    if (allocated(deck%error)) return
    decades = log10(permittivity) + 2*(log10(thermal) - log10(this%length)) + &
      2*log10(abs(this%surface(1)%potential))
    call check_decades(deck, 'double_layer', 'potential', decades, 'a pressure', ' Pa')
    osmotic = permittivity*(thermal/this%length)**2
  end subroutine take_electrolyte

  pure subroutine evaluate(self, quantity, gap, value)
    class(double_layer_t), intent(in) :: self
    integer, intent(in) :: quantity
    real(wp), intent(in) :: gap(:)
    real(wp), intent(out) :: value(size(gap))
    real(wp) :: h(size(gap)), all_values(3)
    integer :: i

    h = max(self%smallest_gap, min(gap, largest_exponent))
    select case (self%model)
    case (linear)
      do i = 1, size(h)
        all_values = self%scale*linear_values(self%surface, h(i))
        value(i) = all_values(quantity)
      end do
    case (superposition)
      value = product(tanh(self%surface%potential/4))/tanh(self%surface(1)%potential/4)**2*exp(-h)
      if (quantity == of_slope) value = -value
    case default
      value = self%scale*self%table%value(quantity, h)
    end select
  end subroutine evaluate

  !> Pressure, slope and energy at a positive gap by the linear equation. With x = exp(-h), a = 2 p1
  !> - 1, b = 2 p2 - 1 and pressures in 2 n kT,
  !>
  !>     e = 2 [y1 y2 x + (b y1^2 + a y2^2) x^2/2]/(1 - a b x^2),   p = -de/dh .
  pure function linear_values(surface, gap) result(value)
    type(surface_t), intent(in) :: surface(2)
    real(wp), intent(in) :: gap
    real(wp) :: value(3), y(2), p(2), sense, x, d, ab, g, mixed, top, top_slope, bottom

    ! If the sign of one potential is changed and both p are replaced by 1 - p, only the sign of the
    ! pressure changes. The form below loses no digits at small gaps where both p are small. By this
    ! symmetry their sum is made at most 1.
    y = surface%potential
    p = surface%regulation
    sense = 1
    if (sum(p) > 1) then
      sense = -1
      y(2) = -y(2)
      p = 1 - p
    end if
    x = exp(-gap)
    ! 1 - x
    d = 2*sinh(gap/2)*exp(-gap/2)
    ab = product(2*p - 1)
    g = y(1)*y(2)
    mixed = (y(1) - y(2))*(p(2)*y(1) - p(1)*y(2))
    ! p = 2 x top/bottom^2, top = y1 y2 (1 + a b x^2) + (b y1^2 + a y2^2) x
    top = g*d**2 - (y(1) - y(2))**2*x + 2*x*(mixed + g*(sum(p)*d + 2*product(p)*x))
    top_slope = -2*g*d - (y(1) - y(2))**2 + 2*(mixed + g*(sum(p)*d + 2*product(p)*x)) &
      + 2*x*g*(2*product(p) - sum(p))
    bottom = (1 - ab) + ab*d*(1 + x)
    value(1) = 2*x*top/bottom**2
    value(2) = -2*x*((top + x*top_slope)*bottom + 4*ab*x**2*top)/bottom**3
    value(3) = 2*x*(g*d + (p(2)*y(1)**2 + p(1)*y(2)**2 - (y(1) - y(2))**2/2)*x)/bottom
    value = sense*value
  end function linear_values

end module double_layer
