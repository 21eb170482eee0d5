!> What branches and paths have in common, entered into the summary in SI units.
module summary_entries
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use reported, only: reported_t, measure_t
  use summary, only: summary_t
  implicit none
  private
  public :: take_jump, take_profiles, raise_tension, widen_spacing
  public :: h0_of, load_of, h0_error_of, load_error_of, rates_of, rates_of_one

contains

  !> A jump, under the keys that begin with `name`; uncertainty: how well its h0 is known where it
  !> was bracketed.
  subroutine take_jump(problem, name, jump, uncertainty, summary)
    type(problem_t), intent(in) :: problem
    character(len=*), intent(in) :: name
    type(reported_t), intent(in) :: jump
    real(wp), intent(in) :: uncertainty
    type(summary_t), intent(inout) :: summary
    type(measure_t), allocatable :: rates(:, :)

    call summary%set(name//'_h0', h0_of(problem, jump))
    call summary%set(name//'_load', load_of(problem, jump))
    rates = rates_of_one(jump)
    call summary%set_rate(name//'_h0', rates%h0)
    call summary%set_rate(name//'_load', rates%load)
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
    type(measure_t), allocatable :: rates(:, :)

    if (summary%has('max_tension')) then
      if (-load_of(problem, lowest) <= summary%number('max_tension')) return
      call summary%drop('max_tension_error')
      call summary%drop('max_tension_h0_error')
    end if
    call summary%set('max_tension', -load_of(problem, lowest))
    call summary%set('max_tension_h0', h0_of(problem, lowest))
    rates = rates_of_one(lowest)
    call summary%set_rate('max_tension', -rates%load)
    call summary%set_rate('max_tension_h0', rates%h0)
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

  !> Derivatives of states by each parameter, (parameters, states), SI units: NaN where a state has
  !> none, and no parameters where none has.
  pure function rates_of(list) result(rates)
    type(reported_t), intent(in) :: list(:)
    type(measure_t), allocatable :: rates(:, :)
    real(wp) :: none
    integer :: parameters, k

    parameters = 0
    do k = 1, size(list)
      if (allocated(list(k)%rate)) parameters = size(list(k)%rate)
    end do
    none = ieee_value(none, ieee_quiet_nan)
    allocate (rates(parameters, size(list)), source=measure_t(none, none, none, none))
    do k = 1, size(list)
      if (allocated(list(k)%rate)) rates(:, k) = list(k)%rate
    end do
  end function rates_of

  !> The same of one state.
  pure function rates_of_one(item) result(rates)
    type(reported_t), intent(in) :: item
    type(measure_t), allocatable :: rates(:, :)
    type(reported_t) :: list(1)

    list(1) = item
    rates = rates_of(list)
  end function rates_of_one

end module summary_entries
