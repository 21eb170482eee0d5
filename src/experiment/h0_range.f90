!> The range of h0 of an experiment, and the start of its path.
module h0_range
  use kinds, only: wp
  use contact_scales, only: beyond_contact
  use dimensionless_problem, only: problem_t
  use experiment_request, only: request_t
  use path_demand, only: widen_path
  implicit none
  private
  public :: path_start, range_of

contains

  !> The h0 [m] at which the shown path starts: beyond any contact, or the deck's value.
  real(wp) function path_start(request, problem) result(start)
    class(request_t), intent(in) :: request
    type(problem_t), intent(in) :: problem

    start = problem%law%separation_of(beyond_contact(problem))
    if (.not. allocated(request%path)) return
    if (allocated(request%path%h0_start)) then
      start = request%path%h0_start
    else if (allocated(request%profiles)) then
      start = max(start, maxval(request%profiles%h0))
    end if
  end function path_start

  !> The range of H0 of a scene, in the law's lengths.
  subroutine range_of(request, problem, low, high)
    class(request_t), intent(in) :: request
    type(problem_t), intent(in) :: problem
    real(wp), intent(out) :: low, high

    low = huge(1.0_wp)
    high = -huge(1.0_wp)
    if (allocated(request%loading)) then
      low = request%loading%h0_end
      high = request%loading%h0_start
    end if
    if (allocated(request%unloading)) high = max(high, request%unloading%h0_end)
    if (allocated(request%drive)) then
      low = min(low, request%drive%z_turn)
      high = max(high, request%drive%z_start, request%drive%z_end)
    end if
    if (allocated(request%path)) then
      low = min(low, request%path%h0_end)
      high = max(high, request%path%h0_end)
      ! The state after the last jump out of contact also belongs to the path.
      high = max(high, path_start(request, problem), &
        problem%law%separation_of(beyond_contact(problem)))
    end if
    low = problem%law%gap_of(low)
    high = problem%law%gap_of(high)
    if (request%reads_path()) call widen_path(request, problem, low, high)
  end subroutine range_of

end module h0_range
