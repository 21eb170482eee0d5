!> A capillary bridge in equilibrium with the vapour. The Laplace pressure surface_tension/r_K acts
!> at separations smaller than r_K (cos theta_1 + cos theta_2). The Kelvin radius r_K is given or
!> follows from the humidity: molar_volume surface_tension/(R T ln(1/humidity)). The step is
!> smoothed (`step_attraction`).
module capillary
  use kinds, only: wp
  use physical_constants, only: boltzmann, avogadro
  use deck, only: deck_t
  use deck_keys, only: key_spec, real_value, real_list
  use force_law, only: force_law_t
  use step_attraction, only: new_step
  implicit none
  private
  public :: keys, read_law

  !> The rows of &capillary.
  type(key_spec), parameter :: keys(*) = [ &
    key_spec('capillary', meaning='Capillary bridge at equilibrium. Give kelvin_radius or ' // &
      'humidity.', &
      choices='&capillary humidity = 0.6, contact_angle = 0.5 /'), &
    key_spec('capillary', 'surface_tension', real_value, 'Surface tension of the liquid.', 'N/m', &
      above=0.0_wp, default='0.0728'), &
    key_spec('capillary', 'contact_angle', real_list, 'Contact angles of the two surfaces, or ' // &
      'one for both.', 'rad', most=2, low=0.0_wp, below=1.5707963_wp, otherwise='0'), &
    key_spec('capillary', 'kelvin_radius', real_value, 'Radius of curvature of the bridge.', 'm', &
      above=0.0_wp), &
    key_spec('capillary', 'humidity', real_value, 'Vapour pressure over that of saturation.', &
      above=0.0_wp, below=1.0_wp), &
    key_spec('capillary', 'molar_volume', real_value, 'Molar volume of the liquid.', 'm^3/mol', &
      above=0.0_wp, default='1.807e-5'), &
    key_spec('capillary', 'temperature', real_value, 'Temperature.', 'K', above=0.0_wp, &
      default='293.15'), &
    key_spec('capillary', 'smoothing', real_value, 'Width of the smoothed step.', 'm', &
      above=0.0_wp, otherwise='0.02 of its range')]

contains

  !> Reads the law from its group.
  subroutine read_law(deck, law)
    type(deck_t), intent(inout) :: deck
    class(force_law_t), allocatable, intent(out) :: law
    real(wp), allocatable :: angles(:)
    real(wp) :: tension, radius, humidity, volume, temperature
    character(len=:), allocatable :: key

    call deck%get('capillary', 'surface_tension', tension)
    call deck%get('capillary', 'contact_angle', angles)
    if (size(angles) == 0) angles = [0.0_wp]
    if (deck%is_set('capillary', 'kelvin_radius') .eqv. deck%is_set('capillary', 'humidity')) then
      call deck%mistake('capillary', 'kelvin_radius', 'give either kelvin_radius or humidity')
      return
    end if
    if (deck%is_set('capillary', 'humidity')) then
      key = 'humidity'
      call deck%get('capillary', 'humidity', humidity)
      call deck%get('capillary', 'molar_volume', volume)
      call deck%get('capillary', 'temperature', temperature)
      radius = volume*tension/(boltzmann*avogadro*temperature*log(1/humidity))
    else
      key = 'kelvin_radius'
      call deck%get('capillary', 'kelvin_radius', radius)
    end if
    call new_step(deck, 'capillary', 'surface_tension', key, tension/radius, &
      radius*(cos(angles(1)) + cos(angles(size(angles)))), law)
  end subroutine read_law

end module capillary
