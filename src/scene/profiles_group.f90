!> &profiles: the h0 whose states are written out along r.
module profiles_group
  use kinds, only: wp
  use failure, only: failure_t
  use text, only: brief
  use deck_keys, only: key_spec, group, list_key
  use scene_groups, only: scene_t
  implicit none
  private
  public :: profiles_keys, take_profiles

contains

  !> Its rows of the table.
  pure function profiles_keys() result(specs)
    type(key_spec), allocatable :: specs(:)

    specs = [ &
      group('profiles', 'Separation, deformation, pressure and energy against r; needs &loading ' &
            // 'or &equilibrium_path.'), &
      list_key('profiles', 'h0', 'm', 'The h0 at which they are written.', most=1000, &
               required=.true.)]
  end function profiles_keys

  !> &profiles: every h0 must be passed on the way.
  subroutine take_profiles(scene, error)
    type(scene_t), intent(inout) :: scene
    type(failure_t), allocatable, intent(inout) :: error
    integer :: i

    if (.not. scene%deck%has_group('profiles')) return
    if (.not. scene%finds_states()) then
      call scene%deck%mistake('profiles', '', 'needs &loading or &equilibrium_path', error)
      return
    end if
    allocate (scene%profiles)
    call scene%deck%get('profiles', 'h0', scene%profiles%h0)
    do i = 1, size(scene%profiles%h0)
      if (reached(scene%profiles%h0(i))) cycle
      call scene%deck%mistake('profiles', 'h0', brief(scene%profiles%h0(i)) // &
                              ' m is outside the range of &loading and &equilibrium_path', error)
      return
    end do

  contains

    !> Whether the loading or the path passes this h0. A path that chooses its own start may start
    !> as high as need be.
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

end module profiles_group
