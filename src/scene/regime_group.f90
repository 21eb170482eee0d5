!> &regime: which theory of adhesion describes the scene. It has no keys.
module regime_group
  use failure, only: failure_t
  use deck_keys, only: key_spec, group
  use scene_groups, only: scene_t
  use path_group, only: check_path
  implicit none
  private
  public :: regime_keys, take_regime

contains

  !> Its rows of the table.
  pure function regime_keys() result(specs)
    type(key_spec), allocatable :: specs(:)

    specs = [ &
      group('regime', 'Which theory of contact describes the scene: parameters, and errors ' // &
            'against the path; needs &equilibrium_path.')]
  end function regime_keys

  !> &regime.
  subroutine take_regime(scene, error)
    type(scene_t), intent(inout) :: scene
    type(failure_t), allocatable, intent(inout) :: error

    if (.not. scene%deck%has_group('regime')) return
    if (.not. scene%shape%parabolic) call scene%deck%mistake('regime', '', &
      'the theories are those of the parabola; leave out this group or &shape', error)
    call check_path(scene, 'regime', error)
    allocate (scene%regime)
  end subroutine take_regime

end module regime_group
