!> &approximations and &classical: closed forms beside the curve, over a range of h0.
module theory_groups
  use failure, only: failure_t
  use text, only: brief
  use deck_keys, only: key_spec, group, real_key, integer_key
  use scene_groups, only: scene_t, range_t
  implicit none
  private
  public :: theory_keys, take_theories

  character(len=*), parameter :: no_range = 'missing; give h0_start and h0_end here, or a ' // &
    '&loading or &equilibrium_path to take the range from'

contains

  !> Their rows of the table.
  pure function theory_keys() result(specs)
    type(key_spec), allocatable :: specs(:)

    specs = [range_keys('approximations', 'Closed-form approximations for slow deformation.'), &
      range_keys('classical', 'Hertz, JKR, DMT and Maugis-Dugdale beside the curve; ' // &
      'Hertz and JKR for the shape that &shape gives.')]
  end function theory_keys

  !> The rows of one of them.
  pure function range_keys(name, meaning) result(specs)
    character(len=*), intent(in) :: name, meaning
    type(key_spec) :: specs(4)

    specs = [ &
      group(name, meaning), &
      real_key(name, 'h0_start', 'm', 'Upper end of the range of h0.', &
               otherwise='as in &loading or &equilibrium_path'), &
      real_key(name, 'h0_end', 'm', 'Lower end of the range of h0.', &
               otherwise='as in &loading or &equilibrium_path'), &
      integer_key(name, 'count', 'Number of points.', 2, 1000000, default='200')]
  end function range_keys

  !> &approximations and &classical.
  subroutine take_theories(scene, error)
    type(scene_t), intent(inout) :: scene
    type(failure_t), allocatable, intent(inout) :: error

    if (scene%deck%has_group('approximations') .and. .not. scene%shape%parabolic) &
      call scene%deck%mistake('approximations', '', 'the approximations are those of the ' // &
                              'parabola; leave out this group or &shape', error)
    if (scene%deck%has_group('approximations') .and. scene%deck%has_group('layer')) &
      call scene%deck%mistake('approximations', '', 'the approximations are those of ' // &
                              'half-spaces; leave out this group or &layer', error)
    call take_range(scene, 'approximations', scene%approximations, error)
    call take_range(scene, 'classical', scene%classical, error)
  end subroutine take_theories

  !> One of them, which takes its range from what is computed anyway.
  subroutine take_range(scene, group, range, error)
    type(scene_t), intent(inout) :: scene
    character(len=*), intent(in) :: group
    type(range_t), allocatable, intent(inout) :: range
    type(failure_t), allocatable, intent(inout) :: error

    if (.not. scene%deck%has_group(group)) return
    allocate (range)
    associate (deck => scene%deck)
      if (allocated(scene%loading)) then
        call deck%assume(group, 'h0_start', scene%loading%h0_start)
        call deck%assume(group, 'h0_end', scene%loading%h0_end)
      else if (allocated(scene%path)) then
        if (allocated(scene%path%h0_start)) &
          call deck%assume(group, 'h0_start', scene%path%h0_start)
        call deck%assume(group, 'h0_end', scene%path%h0_end)
      else if (.not. deck%is_set(group, 'h0_start')) then
        call deck%mistake(group, 'h0_start', no_range, error)
        return
      else if (.not. deck%is_set(group, 'h0_end')) then
        call deck%mistake(group, 'h0_end', no_range, error)
        return
      end if
      call deck%get_optional(group, 'h0_start', range%h0_start)
      call deck%get(group, 'h0_end', range%h0_end)
      call deck%get(group, 'count', range%count)
      if (.not. allocated(range%h0_start)) return
      if (range%h0_start <= range%h0_end) &
        call deck%mistake(group, 'h0_end', brief(range%h0_end) // ' is not below h0_start = ' // &
                          brief(range%h0_start) // ' m', error)
    end associate
  end subroutine take_range

end module theory_groups
