!> Reads &drive, &viscoelastic and &fluid: a drive in time, viscoelastic bodies, and a fluid that
!> drains from the gap between the bodies.
module rate_groups
  use kinds, only: wp
  use text, only: brief, counted
  use deck_keys, only: key_spec, real_value, real_list
  use creep, only: creep_t
  use scene_groups, only: scene_t
  use curve_groups, only: check_order
  implicit none
  private
  public :: rate_keys, take_drive, take_creep, take_fluid

  !> Largest number of Kelvin-Voigt elements.
  integer, parameter :: most_terms = 20
  !> Default accuracy of a drive; each further digit needs three times as many steps.
  real(wp), parameter :: usual_accuracy = 1.0e-4_wp
  !> Largest number of steps if their length is given.
  real(wp), parameter :: most_steps = 4.0e4_wp
  !> Groups that need relaxed bodies in equilibrium.
  character(len=*), parameter :: at_rest(*) = [character(len=16) :: 'loading', 'unloading', &
    'equilibrium_path', 'profiles', 'stability', 'fit', 'regime']

  !> The rows of &drive, &viscoelastic and &fluid.
  type(key_spec), parameter :: rate_keys(*) = [ &
    key_spec('drive', meaning='Bodies driven together and apart in time, at constant velocity.', &
      choices='&drive velocity = 1e-6, z_start = 50e-9, z_turn = -5e-9, ' // &
        'spring_constant = 40 /'), &
    key_spec('drive', 'velocity', real_value, 'Velocity of h0 or, behind a spring, of its base.', &
      'm/s', above=0.0_wp, required=.true.), &
    key_spec('drive', 'z_start', real_value, 'Position at which the bodies are at rest and ' // &
      'the drive begins.', 'm', required=.true.), &
    key_spec('drive', 'z_turn', real_value, 'Position at which the drive turns, below z_start.', &
      'm', required=.true.), &
    key_spec('drive', 'z_end', real_value, 'Position at which the drive ends, above z_turn.', 'm', &
      otherwise='z_start'), &
    key_spec('drive', 'dwell', real_value, 'Waiting time at z_turn.', 's', default='0', &
      low=0.0_wp), &
    key_spec('drive', 'spring_constant', real_value, 'Spring constant of a spring between ' // &
      'drive and bodies.', 'N/m', above=0.0_wp, otherwise='none: h0 itself is driven', &
      former='stiffness'), &
    key_spec('drive', 'time_step', real_value, 'Length of the steps.', 's', above=0.0_wp, &
      otherwise='from accuracy, 1e-4 unless it is given'), &
    key_spec('viscoelastic', meaning='Viscoelastic bodies; &bodies has the instantaneous ' // &
      'stiffness. Give stiffness_relaxed or compliance. Needs &drive.', &
      choices='&viscoelastic stiffness_relaxed = 1e9, retardation_time = 1e-3 /'), &
    key_spec('viscoelastic', 'stiffness_relaxed', real_value, 'E/(1-nu^2) of relaxed ' // &
      'bodies, a standard linear solid; at most the instantaneous one.', 'Pa', above=0.0_wp), &
    key_spec('viscoelastic', 'compliance', real_list, 'Final contribution of each term to the ' // &
      'compliance (1-nu^2)/E.', '1/Pa', most=most_terms, above=0.0_wp), &
    key_spec('viscoelastic', 'retardation_time', real_list, 'Retardation time of each term, ' // &
      'of creep at constant load.', 's', most=most_terms, above=0.0_wp, required=.true.), &
    key_spec('fluid', meaning='A squeeze film of viscous fluid between the bodies. Needs ' // &
      '&drive.', &
      choices='&fluid viscosity = 1e-3, slip_length = 5e-9 /'), &
    key_spec('fluid', 'viscosity', real_value, 'Viscosity of the fluid.', 'Pa s', above=0.0_wp, &
      required=.true.), &
    key_spec('fluid', 'slip_length', real_list, 'Slip length of the fluid on the walls: one ' // &
      'value for both, or two.', 'm', most=2, low=0.0_wp, otherwise='none')]

contains

  !> Reads &drive.
  subroutine take_drive(scene)
    type(scene_t), intent(inout) :: scene
    real(wp) :: time
    character(len=:), allocatable :: word
    integer :: i

    allocate (scene%drive)
    associate (deck => scene%deck, drive => scene%drive)
      call deck%get('drive', 'velocity', drive%velocity)
      call deck%get('drive', 'z_start', drive%z_start)
      call deck%get('drive', 'z_turn', drive%z_turn)
      call deck%get('drive', 'dwell', drive%dwell)
      call deck%get_optional('drive', 'spring_constant', drive%stiffness)
      call deck%get_optional('drive', 'time_step', drive%time_step)
      call deck%assume('drive', 'z_end', drive%z_start)
      call deck%get('drive', 'z_end', drive%z_end)
      call deck%assume('numerics', 'accuracy', usual_accuracy)
      call check_order(deck, 'drive', 'z_start', drive%z_start, 'above', 'z_turn', drive%z_turn)
      if (deck%is_set('drive', 'z_end')) call check_order(deck, 'drive', 'z_end', drive%z_end, &
        'above', 'z_turn', drive%z_turn)
      if (allocated(drive%time_step)) then
        time = (drive%z_start - 2*drive%z_turn + drive%z_end)/drive%velocity + drive%dwell
        if (time > most_steps*drive%time_step) call deck%mistake('drive', 'time_step', &
          'the drive takes ' // brief(time) // ' s, more than 4e4 steps of this length')
      end if
      do i = 1, size(at_rest)
        if (deck%has_group(trim(at_rest(i)))) call deck%mistake(trim(at_rest(i)), '', &
          'shows bodies at rest, which &drive does not have; use a deck of its own')
      end do
      if (scene%bodies%rigid .and. .not. deck%has_group('fluid')) call deck%mistake('drive', '', &
        'needs bodies that deform, or &fluid; rigid ones have the same load at any velocity')
      call deck%get('numerics', 'grid', word)
      if (word /= 'auto') call deck%mistake('numerics', 'grid', &
        '&drive has meshes that move with the contact; leave grid out')
      call deck%get('numerics', 'method', word)
      if (word == 'mixing') call deck%mistake('numerics', 'method', &
        '&drive does not mix; leave method out')
    end associate
  end subroutine take_drive

  !> Reads &viscoelastic.
  subroutine take_creep(scene)
    type(scene_t), intent(inout) :: scene
    real(wp), allocatable :: relaxed, compliance(:), time(:)

    associate (deck => scene%deck, bodies => scene%bodies)
      if (.not. allocated(scene%drive)) call deck%mistake('viscoelastic', '', 'needs &drive; ' // &
        'relaxed bodies are elastic ones with the relaxed stiffness')
      if (bodies%rigid) call deck%mistake('viscoelastic', '', &
        'needs bodies that deform, and these are rigid')
      if (deck%has_group('classical')) call deck%mistake('classical', '', &
        'is for elastic bodies; leave out this group or &viscoelastic')
      if (allocated(bodies%surface)) call deck%mistake('layer', '', &
        'bodies with layers cannot be viscoelastic')
      call deck%get_optional('viscoelastic', 'stiffness_relaxed', relaxed)
      call deck%get('viscoelastic', 'compliance', compliance)
      call deck%get('viscoelastic', 'retardation_time', time)
      if (allocated(relaxed) .eqv. size(compliance) > 0) then
        call deck%mistake('viscoelastic', 'stiffness_relaxed', &
          'give one of: stiffness_relaxed; compliance')
      else if (allocated(relaxed) .and. .not. bodies%rigid) then
        if (relaxed > bodies%stiffness) call deck%mistake( &
          'viscoelastic', 'stiffness_relaxed', brief(relaxed) // &
          ' is above the instantaneous stiffness, ' // brief(bodies%stiffness) // ' Pa')
        compliance = [1/relaxed - 1/bodies%stiffness]
      end if
      if (.not. allocated(scene%deck%error) .and. size(compliance) /= size(time)) &
        call deck%mistake('viscoelastic', 'retardation_time', 'has ' // &
        counted(size(time), 'value') // ' for ' // counted(size(compliance), 'term'))
      if (allocated(scene%deck%error)) return
      scene%creep = creep_t(compliance*bodies%stiffness, time)
    end associate
  end subroutine take_creep

  !> Reads &fluid.
  subroutine take_fluid(scene)
    type(scene_t), intent(inout) :: scene
    real(wp), allocatable :: slip(:)

    allocate (scene%fluid)
    associate (deck => scene%deck, fluid => scene%fluid)
      if (.not. allocated(scene%drive)) call deck%mistake('fluid', '', &
        'needs &drive; the fluid has no effect on bodies at rest')
      if (allocated(scene%shape)) then
        if (.not. scene%shape%parabolic) call deck%mistake('fluid', '', &
          'is for parabolas; leave out this group or &shape')
      end if
      if (allocated(scene%law)) then
        if (.not. scene%law%adhesion > 0) call deck%mistake('fluid', '', &
          'needs a force that attracts, however weak')
      end if
      call deck%get('fluid', 'viscosity', fluid%viscosity)
      call deck%get('fluid', 'slip_length', slip)
      if (allocated(scene%deck%error)) return
      if (size(slip) == 1) fluid%slip = slip(1)
      if (size(slip) == 2) fluid%slip = slip
    end associate
  end subroutine take_fluid

end module rate_groups
