!> Steric repulsion of polymer brushes of thickness L, which touch at h = 2 L (one brush: at L).
!> With u the gap over this separation, the pressure after Alexander and de Gennes is p = kT
!> Gamma^(3/2) (u^(-9/4) - u^(3/4)). After Milner, Witten and Cates it is p = kT Gamma^(3/2) (1/(2
!> u^2) - u + u^4/2). It is zero for u > 1.
module steric
  use kinds, only: wp
  use physical_constants, only: boltzmann
  use deck, only: deck_t
  use deck_keys, only: key_spec, real_value, integer_value, word_value
  use force_law, only: force_law_t, of_pressure, of_slope, usual_closure, nearest_power
  use group_reading, only: accept_law
  implicit none
  private
  public :: keys, read_law

  type, extends(force_law_t) :: steric_t
    !> Whether the model is that of Milner, Witten and Cates.
    logical :: parabolic = .false.
  contains
    procedure :: evaluate
  end type steric_t

  !> Exponents in the model of Alexander and de Gennes: those of the osmotic pressure and of the
  !> elasticity of the chains.
  real(wp), parameter :: osmotic = 9/4.0_wp, elastic = 3/4.0_wp

  !> The rows of &steric.
  type(key_spec), parameter :: keys(*) = [ &
    key_spec('steric', meaning='Repulsion of polymer brushes.', &
      choices='&steric brush_thickness = 5e-9, grafting_density = 3e17 /'), &
    key_spec('steric', 'model', word_value, 'Profile of the brush: a step, whose force begins ' // &
      'with a kink, or a parabola.', choices='alexander_de_gennes milner_witten_cates', &
      default='alexander_de_gennes'), &
    key_spec('steric', 'brush_thickness', real_value, 'Thickness L of a brush.', 'm', &
      above=0.0_wp, required=.true.), &
    key_spec('steric', 'grafting_density', real_value, 'Number of chains on unit area.', '1/m^2', &
      above=0.0_wp, required=.true.), &
    key_spec('steric', 'sides', integer_value, 'Number of surfaces with a brush.', low=1, high=2, &
      default='2'), &
    key_spec('steric', 'temperature', real_value, 'Temperature.', 'K', above=0.0_wp, &
      default='298.15')]

contains

  !> Reads the law from its group.
  subroutine read_law(deck, law)
    type(deck_t), intent(inout) :: deck
    class(force_law_t), allocatable, intent(out) :: law
    type(steric_t) :: this
    character(len=:), allocatable :: model
    real(wp) :: thickness, density, temperature
    integer :: sides

    call deck%get('steric', 'model', model)
    call deck%get('steric', 'brush_thickness', thickness)
    call deck%get('steric', 'grafting_density', density)
    call deck%get('steric', 'sides', sides)
    call deck%get('steric', 'temperature', temperature)
    this%parabolic = model == 'milner_witten_cates'
    this%length = sides*thickness
    this%pressure_unit = boltzmann*temperature*density**1.5_wp
    this%breaks = [1.0_wp]
    this%kinks = this%breaks
    this%smallest_gap = nearest_power
    this%closure_fraction = usual_closure
    call accept_law(deck, 'steric', 'grafting_density', 'brush_thickness', this, law)
  end subroutine read_law

  pure subroutine evaluate(self, quantity, gap, value)
    class(steric_t), intent(in) :: self
    integer, intent(in) :: quantity
    real(wp), intent(in) :: gap(:)
    real(wp), intent(out) :: value(size(gap))
    real(wp) :: u(size(gap))

    u = min(gap, 1.0_wp)
    if (self%parabolic) then
      select case (quantity)
      case (of_pressure)
        value = 0.5_wp/u**2 - u + 0.5_wp*u**4
      case (of_slope)
        value = -1/u**3 - 1 + 2*u**3
      case default
        value = (5/u + 5*u**2 - u**5 - 9)/10
      end select
    else
      select case (quantity)
      case (of_pressure)
        value = u**(-osmotic) - u**elastic
      case (of_slope)
        value = -osmotic*u**(-osmotic - 1) - elastic*u**(elastic - 1)
      case default
        value = (u**(1 - osmotic) - 1)/(osmotic - 1) + (u**(elastic + 1) - 1)/(elastic + 1)
      end select
    end if
    where (gap >= 1) value = 0
  end subroutine evaluate

end module steric
