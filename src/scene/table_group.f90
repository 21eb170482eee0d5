!> &table: stable states on the ways in and out, for users of other programs. It has no keys.
module table_group
  use failure, only: failure_t
  use deck_keys, only: key_spec, group
  use scene_groups, only: scene_t
  use path_group, only: check_path
  implicit none
  private
  public :: table_keys, take_table

contains

  !> Its rows of the table.
  pure function table_keys() result(specs)
    type(key_spec), allocatable :: specs(:)

    specs = [ &
      group('table', 'Load, contact radius and stiffness against indentation, for discrete or ' // &
            'finite elements; needs &equilibrium_path.')]
  end function table_keys

  !> &table.
  subroutine take_table(scene, error)
    type(scene_t), intent(inout) :: scene
    type(failure_t), allocatable, intent(inout) :: error

    scene%table = scene%deck%has_group('table')
    if (scene%table) call check_path(scene, 'table', error)
  end subroutine take_table

end module table_group
