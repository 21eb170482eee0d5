!> &stability: whether every equilibrium is judged by eigenvalue and criteria. It has no keys.
module stability_group
  use failure, only: failure_t
  use deck_keys, only: key_spec, group
  use scene_groups, only: scene_t
  implicit none
  private
  public :: stability_keys, take_stability

contains

  !> Its rows of the table.
  pure function stability_keys() result(specs)
    type(key_spec), allocatable :: specs(:)

    specs = [ &
      group('stability', 'Stability of every equilibrium, by criterion and by smallest ' // &
            'eigenvalue; needs &loading or &equilibrium_path.')]
  end function stability_keys

  !> &stability.
  subroutine take_stability(scene, error)
    type(scene_t), intent(inout) :: scene
    type(failure_t), allocatable, intent(inout) :: error

    if (.not. scene%deck%has_group('stability')) return
    if (scene%finds_states()) then
      allocate (scene%stability)
    else
      call scene%deck%mistake('stability', '', 'needs &loading or &equilibrium_path', error)
    end if
  end subroutine take_stability

end module stability_group
