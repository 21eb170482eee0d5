!> &loading and &unloading: the approach and the retreats of a cycle in steps of h0.
module cycle_groups
  use kinds, only: wp
  use text, only: brief
  use deck, only: deck_t
  use deck_keys, only: key_spec, real_value, real_list
  use scene_groups, only: scene_t
  use path_groups, only: check_order
  implicit none
  private
  public :: cycle_keys, take_loading, take_unloading

  !> Largest number of steps. A deck with more probably has a number in a wrong unit.
  integer, parameter :: most_steps = 10000000

  !> The rows of &loading and &unloading.
  type(key_spec), parameter :: cycle_keys(*) = [ &
    key_spec('loading', meaning='Approach in steps of h0, the separation that undeformed ' // &
      'bodies would have at the centre.'), &
    key_spec('loading', 'h0_start', real_value, 'First h0.', 'm', required=.true.), &
    key_spec('loading', 'h0_end', real_value, 'Last h0, below h0_start.', 'm', required=.true.), &
    key_spec('loading', 'h0_step', real_value, 'Step, positive.', 'm', above=0.0_wp, &
      required=.true.), &
    key_spec('unloading', meaning='Retreat in steps of h0, one cycle for each turning point; ' // &
      'needs &loading.'), &
    key_spec('unloading', 'from', real_list, 'Turning points, inside the range of &loading.', 'm', &
      most=100, otherwise='h0_end of &loading'), &
    key_spec('unloading', 'h0_end', real_value, 'Where each retreat ends, above every turning ' // &
      'point.', 'm', otherwise='h0_start of &loading'), &
    key_spec('unloading', 'h0_step', real_value, 'Step, positive.', 'm', above=0.0_wp, &
      otherwise='h0_step of &loading')]

contains

  !> Reads &loading; its range must run downwards.
  subroutine take_loading(scene)
    type(scene_t), intent(inout) :: scene

    if (.not. scene%deck%has_group('loading')) return
    allocate (scene%loading)
    associate (deck => scene%deck, loading => scene%loading)
      call deck%get('loading', 'h0_start', loading%h0_start)
      call deck%get('loading', 'h0_end', loading%h0_end)
      call deck%get('loading', 'h0_step', loading%h0_step)
      call check_order(deck, 'loading', 'h0_end', loading%h0_end, 'below', 'h0_start', &
        loading%h0_start)
      call check_steps(deck, 'loading', loading%h0_start - loading%h0_end, loading%h0_step)
    end associate
  end subroutine take_loading

  !> Refuses a step so small that the run would not end.
  subroutine check_steps(deck, group, range, step)
    type(deck_t), intent(inout) :: deck
    character(len=*), intent(in) :: group
    real(wp), intent(in) :: range, step

    ! A product, since the quotient may overflow.
    if (range > step*most_steps) &
      call deck%mistake(group, 'h0_step', brief(step) // ' makes too many steps over the ' // &
                        'range of ' // brief(range) // ' m; allowed: at most 10 million')
  end subroutine check_steps

  !> Reads &unloading; turning points must be inside the range of &loading, and each retreat must
  !> run upwards.
  subroutine take_unloading(scene)
    type(scene_t), intent(inout) :: scene
    integer :: i

    if (.not. scene%deck%has_group('unloading')) return
    if (.not. allocated(scene%loading)) then
      call scene%deck%mistake('unloading', '', 'needs &loading, from whose states it starts')
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
                            brief(loading%h0_end) // ' to ' // brief(loading%h0_start) // ' m')
          return
        else if (unloading%from(i) >= unloading%h0_end) then
          call deck%mistake('unloading', 'h0_end', brief(unloading%h0_end) // ' is not above ' // &
                            'the turning point from = ' // brief(unloading%from(i)) // ' m')
          return
        end if
      end do
      call check_steps(deck, 'unloading', unloading%h0_end - minval(unloading%from), &
                       unloading%h0_step)
    end associate
  end subroutine take_unloading

end module cycle_groups
