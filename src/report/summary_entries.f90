!> What branches and paths have in common, entered into the summary in SI units.
module summary_entries
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use reported, only: reported_t
  use summary, only: summary_t
  implicit none
  private
  public :: take_jump, take_profiles, raise_tension, widen_spacing

contains

  !> A jump, under the keys that begin with `name`; uncertainty: how well its h0 is known where it
  !> was bracketed.
  subroutine take_jump(problem, name, jump, uncertainty, summary)
    type(problem_t), intent(in) :: problem
    character(len=*), intent(in) :: name
    type(reported_t), intent(in) :: jump
    real(wp), intent(in) :: uncertainty
    type(summary_t), intent(inout) :: summary

    call summary%set(name//'_h0', problem%law%separation_of(jump%h0))
    call summary%set(name//'_load', jump%load*problem%load)
    call summary%drop(name//'_uncertainty')
    if (uncertainty > 0) call summary%set(name//'_uncertainty', uncertainty*problem%length)
    if (.not. allocated(jump%error)) return
    call summary%set(name//'_h0_error', jump%error%h0*problem%length)
    call summary%set(name//'_load_error', jump%error%load*problem%load)
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
      if (-lowest%load*problem%load <= summary%number('max_tension')) return
      call summary%drop('max_tension_error')
      call summary%drop('max_tension_h0_error')
    end if
    call summary%set('max_tension', -lowest%load*problem%load)
    call summary%set('max_tension_h0', problem%law%separation_of(lowest%h0))
    if (.not. allocated(lowest%error)) return
    call summary%set('max_tension_error', lowest%error%load*problem%load)
    if (.not. lowest%searched) &
      call summary%set('max_tension_h0_error', lowest%error%h0*problem%length)
  end subroutine raise_tension

  !> Keeps the widest spacing of nodes over the neck.
  subroutine widen_spacing(summary, spacing)
    type(summary_t), intent(inout) :: summary
    real(wp), intent(in) :: spacing

    if (.not. spacing > 0) return
    call summary%set('spacing_over_neck', max(summary%number('spacing_over_neck'), spacing))
  end subroutine widen_spacing

end module summary_entries
