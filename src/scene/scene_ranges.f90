!> The groups that say over which h0 to compute, checked against each other.
module scene_ranges
  use kinds, only: wp
  use failure, only: failure_t
  use text, only: brief
  use deck, only: deck_t
  use scene_keys, only: most_steps
  use scene_groups, only: scene_t, range_t
  implicit none
  private
  public :: take_loading, take_unloading, take_path, take_profiles, take_range, take_stability

  character(len=*), parameter :: no_range = 'missing; give h0_start and h0_end here, or a ' // &
    '&loading or &equilibrium_path to take the range from'

contains

  !> &loading; where it is given, its range must run downwards.
  subroutine take_loading(scene, error)
    type(scene_t), intent(inout) :: scene
    type(failure_t), allocatable, intent(inout) :: error

    if (.not. scene%deck%has_group('loading')) return
    allocate (scene%loading)
    associate (deck => scene%deck, loading => scene%loading)
      call deck%get('loading', 'h0_start', loading%h0_start)
      call deck%get('loading', 'h0_end', loading%h0_end)
      call deck%get('loading', 'h0_step', loading%h0_step)
      if (loading%h0_end >= loading%h0_start) then
        call deck%mistake('loading', 'h0_end', brief(loading%h0_end) // ' is not below ' // &
                          'h0_start = ' // brief(loading%h0_start) // ' m', error)
      else
        call check_steps(deck, 'loading', loading%h0_start - loading%h0_end, loading%h0_step, &
                         error)
      end if
    end associate
  end subroutine take_loading

  !> Refuses a step so small that the run would not end.
  subroutine check_steps(deck, group, range, step, error)
    type(deck_t), intent(in) :: deck
    character(len=*), intent(in) :: group
    real(wp), intent(in) :: range, step
    type(failure_t), allocatable, intent(inout) :: error

    ! Written as a product: the quotient may overflow.
    if (range > step*most_steps) &
      call deck%mistake(group, 'h0_step', brief(step) // ' makes too many steps; the range of ' // &
                        brief(range) // ' m allowed: at most 10 million steps', error)
  end subroutine check_steps

  !> &unloading: turning points inside the range of &loading, each retreat upwards.
  subroutine take_unloading(scene, error)
    type(scene_t), intent(inout) :: scene
    type(failure_t), allocatable, intent(inout) :: error
    integer :: i

    if (.not. scene%deck%has_group('unloading')) return
    if (.not. allocated(scene%loading)) then
      call scene%deck%mistake('unloading', '', 'needs &loading, from whose states it starts', &
                              error)
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
                            brief(loading%h0_end) // ' to ' // brief(loading%h0_start) // ' m', &
                            error)
          return
        else if (unloading%from(i) >= unloading%h0_end) then
          call deck%mistake('unloading', 'h0_end', brief(unloading%h0_end) // ' is not above ' // &
                            'the turning point from = ' // brief(unloading%from(i)) // ' m', error)
          return
        end if
      end do
      call check_steps(deck, 'unloading', unloading%h0_end - minval(unloading%from), &
                       unloading%h0_step, error)
    end associate
  end subroutine take_unloading

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

  !> &profiles: every h0 must be passed on the way.
  subroutine take_profiles(scene, error)
    type(scene_t), intent(inout) :: scene
    type(failure_t), allocatable, intent(inout) :: error
    integer :: i

    if (.not. scene%deck%has_group('profiles')) return
    if (.not. (allocated(scene%loading) .or. allocated(scene%path))) then
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

  !> &approximations or &classical, which take their range from what is computed anyway.
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

  !> &stability.
  subroutine take_stability(scene, error)
    type(scene_t), intent(inout) :: scene
    type(failure_t), allocatable, intent(inout) :: error

    if (.not. scene%deck%has_group('stability')) return
    if (allocated(scene%loading) .or. allocated(scene%path)) then
      allocate (scene%stability)
    else
      call scene%deck%mistake('stability', '', 'needs &loading or &equilibrium_path', error)
    end if
  end subroutine take_stability

end module scene_ranges
