!> &device: springs or a dead load through which the bodies are driven.
module device_group
  use kinds, only: wp
  use failure, only: failure_t
  use text, only: brief
  use deck_keys, only: key_spec, group, list_key, real_key
  use scene_groups, only: scene_t
  use path_group, only: check_path
  implicit none
  private
  public :: device_keys, take_device

contains

  !> Its rows of the table.
  pure function device_keys() result(specs)
    type(key_spec), allocatable :: specs(:)

    specs = [ &
      group('device', 'Bodies driven through a spring, in and out, from the path; needs ' // &
            '&equilibrium_path.'), &
      list_key('device', 'stiffness', 'N/m', 'Stiffness of each spring; 0: a dead load.', &
               most=100, low=0.0_wp, otherwise='h0 is prescribed'), &
      real_key('device', 'z_start', 'm', 'Position of the drive from which it starts.', &
               otherwise='where the path starts'), &
      real_key('device', 'z_end', 'm', 'Position at which it turns round.', &
               otherwise='where the path ends')]
  end function device_keys

  !> &device.
  subroutine take_device(scene, error)
    type(scene_t), intent(inout) :: scene
    type(failure_t), allocatable, intent(inout) :: error

    if (.not. scene%deck%has_group('device')) return
    call check_path(scene, 'device', error)
    allocate (scene%device)
    associate (deck => scene%deck, device => scene%device)
      call deck%get('device', 'stiffness', device%stiffness)
      call deck%get_optional('device', 'z_start', device%z_start)
      call deck%get_optional('device', 'z_end', device%z_end)
      if (.not. (allocated(device%z_start) .and. allocated(device%z_end))) return
      if (device%z_start <= device%z_end) call deck%mistake('device', 'z_start', &
        brief(device%z_start) // ' is not above z_end = ' // brief(device%z_end) // ' m', error)
    end associate
  end subroutine take_device

end module device_group
