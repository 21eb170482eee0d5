!> What branches and paths have in common, entered into the summary in SI units.
module summary_entries
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use reported, only: reported_t
  use summary, only: summary_t
  implicit none
  private
  public :: take_jump, take_profiles, raise_tension, widen_spacing
  public :: h0_of, load_of, h0_error_of, load_error_of

contains

  !> A jump, under the keys that begin with `name`; uncertainty: how well its h0 is known where it
  !> was bracketed.
  subroutine take_jump(problem, name, jump, uncertainty, summary)
    type(problem_t), intent(in) :: problem
    character(len=*), intent(in) :: name
    type(reported_t), intent(in) :: jump
    real(wp), intent(in) :: uncertainty
    type(summary_t), intent(inout) :: summary

    call summary%set(name//'_h0', h0_of(problem, jump))
    call summary%set(name//'_load', load_of(problem, jump))
    call summary%drop(name//'_uncertainty')
    if (uncertainty > 0) call summary%set(name//'_uncertainty', uncertainty*problem%length)
    if (.not. allocated(jump%error)) return
    call summary%set(name//'_h0_error', h0_error_of(problem, jump))
    call summary%set(name//'_load_error', load_error_of(problem, jump))
  end subroutine take_jump

  !> Errors of profiles, added to those of other branches.
  subroutine take_profiles(profile, summary)
    type(reported_t), intent(in) :: profile(:)
    type(summary_t), intent(inout) :: summary
    real(wp), allocatable :: errors(:)
    integer :: k

    errors = summary%numbers('profiles_error')
    do k = 1, size(profile)
      if (allocated(profile(k)%error)) errors = [errors, profile(k)%error%profile]
    end do
    if (size(errors) > 0) call summary%set('profiles_error', errors)
  end subroutine take_profiles

  !> Keeps the largest tension, positive.
  subroutine raise_tension(problem, lowest, summary)
    type(problem_t), intent(in) :: problem
    type(reported_t), intent(in) :: lowest
    type(summary_t), intent(inout) :: summary

    if (summary%has('max_tension')) then
      if (-load_of(problem, lowest) <= summary%number('max_tension')) return
      call summary%drop('max_tension_error')
      call summary%drop('max_tension_h0_error')
    end if
    call summary%set('max_tension', -load_of(problem, lowest))
    call summary%set('max_tension_h0', h0_of(problem, lowest))
    if (.not. allocated(lowest%error)) return
    call summary%set('max_tension_error', load_error_of(problem, lowest))
    if (.not. lowest%searched) &
      call summary%set('max_tension_h0_error', h0_error_of(problem, lowest))
  end subroutine raise_tension

  !> Keeps the widest spacing of nodes over the neck.
  subroutine widen_spacing(summary, spacing)
    type(summary_t), intent(inout) :: summary
    real(wp), intent(in) :: spacing

    if (.not. spacing > 0) return
    call summary%set('spacing_over_neck', max(summary%number('spacing_over_neck'), spacing))
  end subroutine widen_spacing

  !> The h0 [m] of a state; here and below NaN where there is no such state, or no such error.
  pure real(wp) function h0_of(problem, item)
    type(problem_t), intent(in) :: problem
    type(reported_t), intent(in), optional :: item

    h0_of = ieee_value(h0_of, ieee_quiet_nan)
    if (present(item)) h0_of = problem%law%separation_of(item%h0)
  end function h0_of

  !> Its load [N].
  pure real(wp) function load_of(problem, item)
    type(problem_t), intent(in) :: problem
    type(reported_t), intent(in), optional :: item

    load_of = ieee_value(load_of, ieee_quiet_nan)
    if (present(item)) load_of = item%load*problem%load
  end function load_of

  !> The error of its h0 [m], if that was not found by a search between steps.
  pure real(wp) function h0_error_of(problem, item)
    type(problem_t), intent(in) :: problem
    type(reported_t), intent(in), optional :: item

    h0_error_of = ieee_value(h0_error_of, ieee_quiet_nan)
    if (.not. present(item)) return
    if (allocated(item%error) .and. .not. item%searched) &
      h0_error_of = item%error%h0*problem%length
  end function h0_error_of

  !> The error of its load [N].
  pure real(wp) function load_error_of(problem, item)
    type(problem_t), intent(in) :: problem
    type(reported_t), intent(in), optional :: item

    load_error_of = ieee_value(load_error_of, ieee_quiet_nan)
    if (.not. present(item)) return
    if (allocated(item%error)) load_error_of = item%error%load*problem%load
  end function load_error_of

end module summary_entries
