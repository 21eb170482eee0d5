!> &equilibrium_path: which part of the path of all equilibria is shown.
module path_group
  use failure, only: failure_t
  use text, only: brief
  use deck_keys, only: key_spec, group, real_key
  use scene_groups, only: scene_t
  implicit none
  private
  public :: path_keys, take_path, check_path

contains

  !> Its rows of the table.
  pure function path_keys() result(specs)
    type(key_spec), allocatable :: specs(:)

    specs = [ &
      group('equilibrium_path', 'The whole path of equilibria, stable and unstable, with ' // &
            'exact folds.'), &
      real_key('equilibrium_path', 'h0_start', 'm', 'Where the path starts, above h0_end.', &
               otherwise='chosen by the program'), &
      real_key('equilibrium_path', 'h0_end', 'm', 'Where it ends; needed without &loading.', &
               otherwise='h0_end of &loading')]
  end function path_keys

  !> &equilibrium_path.
  subroutine take_path(scene, error)
    type(scene_t), intent(inout) :: scene
    type(failure_t), allocatable, intent(inout) :: error

    if (.not. scene%deck%has_group('equilibrium_path')) return
    allocate (scene%path)
    associate (deck => scene%deck, path => scene%path)
      if (allocated(scene%loading)) then
        call deck%assume('equilibrium_path', 'h0_end', scene%loading%h0_end)
      else if (.not. deck%is_set('equilibrium_path', 'h0_end')) then
        call deck%mistake('equilibrium_path', 'h0_end', &
                          'missing; give it, or a &loading to take it from', error)
      end if
      call deck%get('equilibrium_path', 'h0_end', path%h0_end)
      call deck%get_optional('equilibrium_path', 'h0_start', path%h0_start)
      if (.not. allocated(path%h0_start)) return
      if (path%h0_start <= path%h0_end) &
        call deck%mistake('equilibrium_path', 'h0_start', brief(path%h0_start) // &
                          ' is not above h0_end = ' // brief(path%h0_end) // ' m', error)
    end associate
  end subroutine take_path

  !> Complains where a group that is read from the path has none, or one without jumps.
  subroutine check_path(scene, group, error)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: group
    type(failure_t), allocatable, intent(inout) :: error

    if (.not. allocated(scene%path)) then
      call scene%deck%mistake(group, '', 'needs &equilibrium_path', error)
    else if (scene%bodies%rigid .or. .not. scene%law%adhesion > 0) then
      call scene%deck%mistake(group, '', 'needs elastic bodies and a force that attracts', error)
    end if
  end subroutine check_path

end module path_group
