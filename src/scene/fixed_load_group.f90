!> &fixed_load: loads whose equilibria are looked for.
module fixed_load_group
  use failure, only: failure_t
  use deck_keys, only: key_spec, group, list_key
  use scene_groups, only: scene_t
  use path_group, only: check_path
  implicit none
  private
  public :: fixed_load_keys, take_fixed_load

contains

  !> Its rows of the table.
  pure function fixed_load_keys() result(specs)
    type(key_spec), allocatable :: specs(:)

    specs = [ &
      group('fixed_load', 'All equilibria under given loads, stable or not; needs ' // &
            '&equilibrium_path.'), &
      list_key('fixed_load', 'load', 'N', 'The loads; negative: tension.', most=1000, &
               required=.true.)]
  end function fixed_load_keys

  !> &fixed_load.
  subroutine take_fixed_load(scene, error)
    type(scene_t), intent(inout) :: scene
    type(failure_t), allocatable, intent(inout) :: error

    if (.not. scene%deck%has_group('fixed_load')) return
    call check_path(scene, 'fixed_load', error)
    allocate (scene%fixed_load)
    call scene%deck%get('fixed_load', 'load', scene%fixed_load%load)
  end subroutine take_fixed_load

end module fixed_load_group
