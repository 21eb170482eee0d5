!> Whether the largest tension is a pull-off force. If it is in the first or last row of a branch,
!> the tension may grow beyond this row, and the number depends on where the branch ends. If it is
!> next to states that did not converge, the tension of these states may be larger.
module tension_at_end
  use kinds, only: wp, nan
  use text, only: brief, rounded
  use dimensionless_problem, only: problem_t
  use reported_place, only: place_t, of_h0
  use records, only: branch_t
  use experiment_result, only: experiment_result_t
  use summary, only: summary_t
  implicit none
  private
  public :: judge_tension

contains

  !> Sets the entries about the ends, and warns if the largest tension of all branches is at an end.
  subroutine judge_tension(problem, outcome, summary)
    type(problem_t), intent(in) :: problem
    type(experiment_result_t), intent(in) :: outcome
    type(summary_t), intent(inout) :: summary
    type(place_t) :: largest
    logical :: at_end
    integer :: k

    at_end = .false.
    if (.not. outcome%places%has('max_tension')) return
    largest = outcome%places%place_of('max_tension')
    ! A path that ends in a collapse of the bodies has a warning of its own.
    if (allocated(outcome%path)) call judge_branch('path', outcome%path%branch_t, &
      'raise h0_start', 'lower h0_end', outcome%path%fallen)
    if (allocated(outcome%stepped_path)) call judge_branch('path', outcome%stepped_path, &
      'raise h0_start', 'lower h0_end', .false.)
    if (allocated(outcome%loading)) call judge_branch('loading', outcome%loading, &
      'raise h0_start', 'lower h0_end', .false.)
    if (allocated(outcome%unloading)) then
      do k = 1, size(outcome%unloading)
        call judge_branch('unloading_' // brief(k), outcome%unloading(k), &
          'turn at a smaller h0', 'raise h0_end', .false.)
      end do
      call summary%set('unload_max_tension_at_end', [(of_unloading(outcome%unloading(k)), k=1, &
        size(outcome%unloading))])
    end if
    call summary%set('max_tension_at_end', at_end)

  contains

    !> at_first, at_last: what to change if the tension is largest there. told: whether another
    !> message gives the reason, so that no further warning is needed.
    subroutine judge_branch(name, branch, at_first, at_last, told)
      character(len=*), intent(in) :: name, at_first, at_last
      type(branch_t), intent(in) :: branch
      logical, intent(in) :: told

      if (.not. at_one(branch)) return
      ! The same state is solved twice at a turn.
      if (abs(branch%lowest%at(of_h0) - largest%at(of_h0)) > 0) return
      if (branch%lowest_beside_lost) then
        if (.not. at_end) call summary%warn(name // ': the tension is largest beside states ' // &
          'that did not converge, at h0 = ' // rounded(problem%law%separation_of( &
          largest%at(of_h0))) // ' m, and grows towards them: max_tension may be no pull-off; ' // &
          'raise max_iterations, or use method = ''auto''')
        at_end = .true.
      else if (branch%lowest_first) then
        call tell(name, .true., at_first, told .or. branch%ending%early())
      else
        call tell(name, .false., at_last, told .or. branch%ending%early())
      end if
    end subroutine judge_branch

    subroutine tell(name, first, advice, told)
      character(len=*), intent(in) :: name, advice
      logical, intent(in) :: first, told

      if (.not. (at_end .or. told)) call summary%warn(name // ': the tension is largest in its ' &
        // trim(merge('first', 'last ', first)) // ' row, at h0 = ' // &
        rounded(problem%law%separation_of(largest%at(of_h0))) // &
        ' m, and may grow beyond: max_tension is no pull-off; ' // trim(advice))
      at_end = .true.
    end subroutine tell

  end subroutine judge_tension

  !> Whether the largest tension of a branch is at one of its ends, or next to states that did not
  !> converge.
  pure logical function at_one(branch)
    type(branch_t), intent(in) :: branch

    at_one = branch%lowest_first .or. branch%lowest_last .or. branch%lowest_beside_lost
  end function at_one

  !> 1 if the largest tension of an unloading is at an end, otherwise 0; NaN for an unloading
  !> without tension.
  pure real(wp) function of_unloading(branch) result(at_end)
    type(branch_t), intent(in) :: branch

    at_end = nan
    if (allocated(branch%lowest)) at_end = merge(1, 0, at_one(branch))
  end function of_unloading

end module tension_at_end
