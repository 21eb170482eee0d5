!> Reads &loading and &unloading, the cycle in steps of h0; &equilibrium_path; and the groups that
!> use states of these: &device, &fixed_load, &table, &regime, &profiles, &stability.
module curve_groups
  use kinds, only: wp
  use text, only: brief
  use deck, only: deck_t
  use deck_keys, only: key_spec, real_value, real_list
  use scene_groups, only: scene_t
  implicit none
  private
  public :: cycle_keys, take_loading, take_unloading, path_keys, profiles_keys, take_path, &
    take_readings, take_regime, take_profiles, has_states, check_order

  !> Largest number of steps. A deck with more steps probably has a number in a wrong unit.
  integer, parameter :: most_steps = 10000000

  !> The rows of &loading and &unloading.
  type(key_spec), parameter :: cycle_keys(*) = [ &
    key_spec('loading', meaning='Approach in steps of h0, the separation that undeformed ' // &
      'bodies would have at the centre.', &
      choices='&loading h0_start = 10e-9, h0_end = -5e-9, h0_step = 0.1e-9 /'), &
    key_spec('loading', 'h0_start', real_value, 'First h0.', 'm', required=.true.), &
    key_spec('loading', 'h0_end', real_value, 'Last h0, below h0_start.', 'm', required=.true.), &
    key_spec('loading', 'h0_step', real_value, 'Step, positive.', 'm', above=0.0_wp, &
      required=.true.), &
    key_spec('unloading', meaning='Retract in steps of h0, one cycle for each turning point; ' // &
      'needs &loading.', &
      choices='&unloading from = -5e-9 /'), &
    key_spec('unloading', 'from', real_list, 'Turning points, inside the range of &loading.', 'm', &
      most=100, otherwise='h0_end of &loading'), &
    key_spec('unloading', 'h0_end', real_value, 'Where each retract ends, above every turning ' // &
      'point.', 'm', otherwise='h0_start of &loading'), &
    key_spec('unloading', 'h0_step', real_value, 'Step, positive.', 'm', above=0.0_wp, &
      otherwise='h0_step of &loading')]

  !> The rows of &equilibrium_path, &device, &fixed_load and &table.
  type(key_spec), parameter :: path_keys(*) = [ &
    key_spec('equilibrium_path', meaning='The whole path of equilibria, stable and unstable, ' // &
      'with exact turning points.', &
      choices='&equilibrium_path h0_end = -5e-9 /'), &
    key_spec('equilibrium_path', 'h0_start', real_value, 'First h0, above h0_end.', 'm', &
      otherwise='chosen by the program'), &
    key_spec('equilibrium_path', 'h0_end', real_value, 'Last h0; needed without &loading.', 'm', &
      otherwise='h0_end of &loading'), &
    key_spec('device', meaning='Approach and retract with a spring (cantilever), from the ' // &
      'path; needs &equilibrium_path.', &
      choices='&device spring_constant = 40 /'), &
    key_spec('device', 'spring_constant', real_list, 'Spring constant of each spring; 0: a ' // &
      'dead load.', 'N/m', most=100, low=0.0_wp, otherwise='h0 is prescribed', &
      former='stiffness'), &
    key_spec('device', 'z_start', real_value, 'First position of the drive.', 'm', &
      otherwise='where the path starts'), &
    key_spec('device', 'z_end', real_value, 'Position at which the drive turns. ' // &
      'Without it, it goes on beyond h0_end until bodies are in contact within all barriers.', &
      'm', otherwise='in contact, at h0_end or beyond'), &
    key_spec('fixed_load', meaning='All equilibria under given loads, stable or not; needs ' // &
      '&equilibrium_path.', &
      choices='&fixed_load load = 0, -2e-7 /'), &
    key_spec('fixed_load', 'load', real_list, 'The loads; negative: tension.', 'N', most=1000, &
      required=.true.), &
    key_spec('table', meaning='Load, contact radius and stiffness against indentation, for ' // &
      'discrete or finite elements; needs &equilibrium_path.', &
      choices='&table /')]

  !> The rows of &profiles.
  type(key_spec), parameter :: profiles_keys(*) = [ &
    key_spec('profiles', meaning='Separation, deformation, pressure and energy against r; ' // &
      'needs &loading or &equilibrium_path.', &
      choices='&profiles h0 = 1e-9, -5e-9 /'), &
    key_spec('profiles', 'h0', real_list, 'The h0 of the profiles.', 'm', most=1000, &
      required=.true.)]

contains

  !> Reads &loading, whose h0 must decrease.
  subroutine take_loading(scene)
    type(scene_t), intent(inout) :: scene

    allocate (scene%loading)
    associate (deck => scene%deck, loading => scene%loading)
      call deck%get('loading', 'h0_start', loading%h0_start)
      call deck%get('loading', 'h0_end', loading%h0_end)
      call deck%get('loading', 'h0_step', loading%h0_step)
      call check_order(deck, 'loading', 'h0_end', loading%h0_end, 'below', 'h0_start', &
        loading%h0_start)
      call check_steps(deck, 'loading', loading%h0_start - loading%h0_end, loading%h0_step)
    end associate
  end subroutine take_loading

  !> Refuses a step so small that the run would take too long.
  subroutine check_steps(deck, group, range, step)
    type(deck_t), intent(inout) :: deck
    character(len=*), intent(in) :: group
    real(wp), intent(in) :: range, step

    ! A product, since the quotient may overflow.
    if (range > step*most_steps) &
      call deck%mistake(group, 'h0_step', brief(step) // ' makes too many steps over the ' // &
                        'range of ' // brief(range) // ' m; allowed: at most 10 million')
  end subroutine check_steps

  !> Reads &unloading. Turning points must be inside the range of &loading, and h0 must increase on
  !> each retract.
  subroutine take_unloading(scene)
    type(scene_t), intent(inout) :: scene
    integer :: i

    if (.not. allocated(scene%loading)) then
      call scene%deck%mistake('unloading', '', 'needs &loading, from whose states it starts')
      return
    end if
    allocate (scene%unloading)
    associate (deck => scene%deck, loading => scene%loading, unloading => scene%unloading)
      call deck%assume('unloading', 'from', [loading%h0_end])
      call deck%assume('unloading', 'h0_end', loading%h0_start)
      call deck%assume('unloading', 'h0_step', loading%h0_step)
      call deck%get('unloading', 'from', unloading%from)
      call deck%get('unloading', 'h0_end', unloading%h0_end)
      call deck%get('unloading', 'h0_step', unloading%h0_step)
      do i = 1, size(unloading%from)
        if (unloading%from(i) < loading%h0_end .or. unloading%from(i) > loading%h0_start) then
          call deck%mistake('unloading', 'from', brief(unloading%from(i)) // &
                            ' is outside the range of &loading; allowed: from ' // &
                            brief(loading%h0_end) // ' to ' // brief(loading%h0_start) // ' m')
          return
        else if (unloading%from(i) >= unloading%h0_end) then
          call deck%mistake('unloading', 'h0_end', brief(unloading%h0_end) // ' is not above ' // &
                            'the turning point from = ' // brief(unloading%from(i)) // ' m')
          return
        end if
      end do
      call check_steps(deck, 'unloading', unloading%h0_end - minval(unloading%from), &
                       unloading%h0_step)
    end associate
  end subroutine take_unloading

  !> Reads &equilibrium_path.
  subroutine take_path(scene)
    type(scene_t), intent(inout) :: scene

    allocate (scene%path)
    associate (deck => scene%deck, path => scene%path)
      if (allocated(scene%loading)) then
        call deck%assume('equilibrium_path', 'h0_end', scene%loading%h0_end)
      else if (.not. deck%is_set('equilibrium_path', 'h0_end')) then
        call deck%mistake('equilibrium_path', 'h0_end', &
          'missing; give it, or a &loading to take it from')
        return
      end if
      call deck%get('equilibrium_path', 'h0_end', path%h0_end)
      call deck%get_optional('equilibrium_path', 'h0_start', path%h0_start)
      if (allocated(path%h0_start)) call check_order(deck, 'equilibrium_path', 'h0_start', &
        path%h0_start, 'above', 'h0_end', path%h0_end)
    end associate
  end subroutine take_path

  !> Reads &device, &fixed_load and &table.
  subroutine take_readings(scene)
    type(scene_t), intent(inout) :: scene

    associate (deck => scene%deck)
      if (deck%has_group('device')) then
        call check_path(scene, 'device')
        allocate (scene%device)
        associate (device => scene%device)
          call deck%get('device', 'spring_constant', device%stiffness)
          call deck%get_optional('device', 'z_start', device%z_start)
          call deck%get_optional('device', 'z_end', device%z_end)
          if (allocated(device%z_start) .and. allocated(device%z_end)) call check_order(deck, &
            'device', 'z_start', device%z_start, 'above', 'z_end', device%z_end)
        end associate
      end if
      if (deck%has_group('fixed_load')) then
        call check_path(scene, 'fixed_load')
        call deck%get('fixed_load', 'load', scene%fixed_loads)
      end if
      scene%table = deck%has_group('table')
      if (scene%table) call check_path(scene, 'table')
    end associate
  end subroutine take_readings

  !> Reads &regime.
  subroutine take_regime(scene)
    type(scene_t), intent(inout) :: scene

    scene%regime = .true.
    if (.not. scene%shape%parabolic) call scene%deck%mistake('regime', '', &
      'the theories are those of the parabola; leave out this group or &shape')
    call check_path(scene, 'regime')
  end subroutine take_regime

  !> Reads &profiles. Each h0 must be within the range of the loading or of the path.
  subroutine take_profiles(scene)
    type(scene_t), intent(inout) :: scene
    integer :: i

    if (.not. has_states(scene, 'profiles')) return
    call scene%deck%get('profiles', 'h0', scene%profile_h0)
    do i = 1, size(scene%profile_h0)
      if (allocated(scene%drive)) exit
      if (reached(scene%profile_h0(i))) cycle
      call scene%deck%mistake('profiles', 'h0', brief(scene%profile_h0(i)) // &
                              ' m is outside the range of &loading and &equilibrium_path')
      return
    end do

  contains

    !> Whether the loading or the path passes this h0. A path without a given start passes any h0
    !> above its end.
    pure logical function reached(h0)
      real(wp), intent(in) :: h0

      reached = .false.
      if (allocated(scene%loading)) &
        reached = h0 >= scene%loading%h0_end .and. h0 <= scene%loading%h0_start
      if (reached .or. .not. allocated(scene%path)) return
      reached = h0 >= scene%path%h0_end
      if (allocated(scene%path%h0_start)) reached = reached .and. h0 <= scene%path%h0_start
    end function reached

  end subroutine take_profiles

  !> Whether the deck has a group that uses states. The group is refused if the deck computes no
  !> states.
  logical function has_states(scene, group)
    type(scene_t), intent(inout) :: scene
    character(len=*), intent(in) :: group

    has_states = scene%deck%has_group(group) .and. scene%finds_states()
    if (scene%deck%has_group(group) .and. .not. has_states) &
      call scene%deck%mistake(group, '', 'needs &loading or &equilibrium_path')
  end function has_states

  !> Refuses a group that needs the path if the deck has no path, or if the path can have no jumps.
  subroutine check_path(scene, group)
    type(scene_t), intent(inout) :: scene
    character(len=*), intent(in) :: group

    if (.not. allocated(scene%path)) then
      call scene%deck%mistake(group, '', 'needs &equilibrium_path')
    else if (scene%bodies%rigid .or. .not. scene%law%adhesion > 0) then
      call scene%deck%mistake(group, '', 'needs elastic bodies and a force that attracts')
    end if
  end subroutine check_path

  !> Refuses a position [m] that is not above (`word`: 'above') or not below ('below') the position
  !> of another key.
  subroutine check_order(deck, group, key, position, word, other, limit)
    type(deck_t), intent(inout) :: deck
    character(len=*), intent(in) :: group, key, word, other
    real(wp), intent(in) :: position, limit

    if (merge(position > limit, position < limit, word == 'above')) return
    call deck%mistake(group, key, brief(position) // ' is not ' // word // ' ' // other // ' = ' &
      // brief(limit) // ' m')
  end subroutine check_order

end module curve_groups
