!> Errors of all that an outcome reports, number by number, and the largest of them.
module result_errors
  use kinds, only: wp
  use numerics_choice, only: fixed_mesh, companion
  use edge_locked, only: new_mesh_family
  use mesh_store, only: mesh_store_t
  use fixed_stepper, only: fixed_stepper_t
  use locked_stepper, only: locked_stepper_t
  use path_stepper, only: path_stepper_t
  use stepper, only: stepper_t
  use known_path, only: lost_energy_t, energy_lost
  use reported, only: reported_t, relative_error
  use error_estimate, only: finer_t, judge_at_h0, rounding
  use path_errors, only: judge_on_path
  use stepped_branch, only: branch_t
  use tension_search, only: load_tolerance
  use path, only: path_t
  use experiment_result, only: experiment_result_t
  implicit none
  private
  public :: judge_t, more_digits, begin_judging, judge_path_points, judge_locked, judge_fixed

  !> Digits that edge-locked finer meshes have more.
  real(wp), parameter :: more_digits = 1.5_wp
  !> Differences are raised by this much for the error of the finer mesh: a tenth or less for
  !> panels, a third for a uniform grid, which is of second order and of lower order in places; and
  !> because other states may be somewhat worse than those compared. Against a grid twice as coarse
  !> the difference itself is two to three times the error.
  real(wp), parameter :: margin = 3, margin_fixed = 2.5_wp, margin_coarser = 1.2_wp, &
    margin_less_gained = 6, margin_kinks = 12

  !> How a reported state is judged: again on the path of `steps`, if it has one, or else at its h0,
  !> on the finer meshes.
  type :: judge_t
    class(stepper_t), pointer :: steps => null()
    type(finer_t) :: fine
    real(wp) :: largest = rounding
    logical :: judged = .false.
  end type judge_t

contains

  !> Prepares to judge what edge-locked steps find on their meshes, which stay what they are, for H0
  !> from high to low. store: of meshes.
  subroutine begin_judging(judge, steps, high, low, store)
    type(judge_t), intent(out) :: judge
    class(locked_stepper_t), intent(inout), target :: steps
    real(wp), intent(in) :: high, low
    type(mesh_store_t), intent(inout), target, optional :: store
    integer :: k

    judge%steps => steps
    call judge%fine%take_over(steps)
    ! Without a contact edge nothing locks the mesh to what is sharp in a fall, and short panels may
    ! hold what is not smooth, a law's or a body's: more nodes gain less.
    judge%fine%margin = margin
    if (.not. steps%problem%law%edge_gap > 0 .or. any([(steps%meshes%has_short_panels(k), &
      k=1, size(steps%meshes%grid))])) judge%fine%margin = margin_less_gained
    if (steps%problem%law%has_kink) judge%fine%margin = margin_kinks
    judge%fine%meshes = new_mesh_family(steps%problem, high, low, &
      steps%meshes%digits + more_digits, shape_only=.true., coarser=steps%meshes)
    if (present(store)) judge%fine%store => store
  end subroutine begin_judging

  !> The largest error of folds and extrema of the path that the steps have traced, relative. The
  !> points keep their errors, and the steps count what that cost. It is no part of what is
  !> reported: not every point need be shown.
  subroutine judge_path_points(judge, largest)
    type(judge_t), intent(inout) :: judge
    real(wp), intent(out) :: largest
    type(reported_t) :: reported
    integer :: i

    largest = 0
    judge%fine%cost = judge%steps%cost
    select type (steps => judge%steps)
    class is (path_stepper_t)
      do i = 1, steps%known%path%held
        associate (point => steps%known%path%point(i))
          if (.not. (point%fold .or. point%load_extremum)) cycle
          reported = reported_t(h0=point%state%h0, load=point%state%load, point=i)
        end associate
        call judge_on_path(steps%equations_t, judge%fine, .false., steps%known, reported)
        largest = max(largest, relative_error(reported))
      end do
    end select
    judge%steps%cost = judge%fine%cost
  end subroutine judge_path_points

  !> Judges what edge-locked steps have found. Nothing is done where nothing is reported.
  subroutine judge_locked(judge, outcome)
    type(judge_t), intent(inout) :: judge
    type(experiment_result_t), intent(inout) :: outcome

    if (.not. reports(outcome)) return
    judge%fine%cost = judge%steps%cost
    if (allocated(outcome%path)) call judge_path(judge, outcome%path)
    if (allocated(outcome%stepped_path)) call judge_branch(judge, outcome%stepped_path)
    call judge_cycle(judge, outcome)
    select type (steps => judge%steps)
    class is (path_stepper_t)
      call judge_energy(judge, steps, outcome)
    end select
    call conclude(judge, outcome)
  end subroutine judge_locked

  !> Judges the cycle that steps on a fixed mesh have found, for H0 down to low: against a mesh that
  !> is finer or, where that would cost too much, coarser.
  subroutine judge_fixed(steps, low, outcome)
    type(fixed_stepper_t), intent(inout), target :: steps
    real(wp), intent(in) :: low
    type(experiment_result_t), intent(inout) :: outcome
    type(judge_t) :: judge

    if (.not. reports(outcome)) return
    judge%steps => steps
    call judge%fine%take_over(steps)
    allocate (judge%fine%meshes%grid(1))
    judge%fine%meshes%grid(1) = fixed_mesh(companion(outcome%chosen), steps%problem, low)
    judge%fine%margin = merge(margin_fixed, margin_coarser, &
      judge%fine%meshes%grid(1)%nodes > steps%meshes%grid(1)%nodes)
    associate (cost => judge%fine%cost)
      cost%kernel_entries = cost%kernel_entries + judge%fine%meshes%grid(1)%kernel_entries()
    end associate
    call judge_cycle(judge, outcome)
    call conclude(judge, outcome)
  end subroutine judge_fixed

  !> Whether there is anything to judge.
  pure logical function reports(outcome)
    type(experiment_result_t), intent(in) :: outcome

    reports = .false.
    if (allocated(outcome%path)) reports = outcome%path%states > 0
    if (allocated(outcome%stepped_path)) reports = reports .or. outcome%stepped_path%states > 0
    if (allocated(outcome%loading)) reports = reports .or. outcome%loading%states > 0
    if (allocated(outcome%unloading)) reports = reports .or. any(outcome%unloading%states > 0)
  end function reports

  subroutine judge_cycle(judge, outcome)
    type(judge_t), intent(inout) :: judge
    type(experiment_result_t), intent(inout) :: outcome
    integer :: k

    if (allocated(outcome%loading)) call judge_branch(judge, outcome%loading)
    if (.not. allocated(outcome%unloading)) return
    do k = 1, size(outcome%unloading)
      call judge_branch(judge, outcome%unloading(k))
    end do
  end subroutine judge_cycle

  !> Hands the cost back to the steps, and the largest error on. Of nothing there is no error; a
  !> path that was judged before counts too.
  subroutine conclude(judge, outcome)
    type(judge_t), intent(inout) :: judge
    type(experiment_result_t), intent(inout) :: outcome

    judge%steps%cost = judge%fine%cost
    if (.not. judge%judged) return
    if (allocated(outcome%error_estimate)) then
      outcome%error_estimate = max(outcome%error_estimate, judge%largest)
    else
      outcome%error_estimate = judge%largest
    end if
  end subroutine conclude

  subroutine judge_path(judge, path)
    type(judge_t), intent(inout) :: judge
    type(path_t), intent(inout) :: path

    call judge_list(judge, path%fold, .false.)
    call judge_list(judge, path%extremum, .false.)
    call judge_list(judge, path%profile, .true.)
    if (allocated(path%lowest)) call judge_one(judge, path%lowest, .false.)
    ! How a fall ends is of no interest and on no mesh.
    if (allocated(path%finish) .and. .not. path%fallen) call judge_one(judge, path%finish, .false.)
  end subroutine judge_path

  subroutine judge_branch(judge, branch)
    type(judge_t), intent(inout) :: judge
    type(branch_t), intent(inout) :: branch

    if (allocated(branch%lowest)) call judge_one(judge, branch%lowest, .false.)
    if (allocated(branch%jump)) call judge_one(judge, branch%jump, .false.)
    if (allocated(branch%finish)) call judge_one(judge, branch%finish, .false.)
    if (allocated(branch%profile)) call judge_list(judge, branch%profile, .true.)
    if (allocated(branch%sample)) call judge_list(judge, branch%sample, .false.)
  end subroutine judge_branch

  subroutine judge_list(judge, list, with_profile)
    type(judge_t), intent(inout) :: judge
    type(reported_t), intent(inout) :: list(:)
    logical, intent(in) :: with_profile
    integer :: i

    do i = 1, size(list)
      call judge_one(judge, list(i), with_profile)
    end do
  end subroutine judge_list

  !> Judges one reported state; one without a state, such as a jump that was bracketed, is left.
  subroutine judge_one(judge, reported, with_profile)
    type(judge_t), intent(inout) :: judge
    type(reported_t), intent(inout) :: reported
    logical, intent(in) :: with_profile

    if (reported%point == 0 .and. .not. allocated(reported%witness)) return
    select type (steps => judge%steps)
    class is (path_stepper_t)
      call judge_on_path(steps%equations_t, judge%fine, with_profile, steps%known, reported)
    class default
      call judge_at_h0(steps%equations_t, judge%fine, reported)
    end select
    if (allocated(reported%error) .and. .not. with_profile) reported%error%profile = 0
    if (allocated(reported%error) .and. reported%searched) &
      reported%error%load = reported%error%load + load_tolerance*abs(reported%load)
    judge%largest = max(judge%largest, relative_error(reported))
    judge%judged = .true.
  end subroutine judge_one

  !> The energy lost in the cycle of a path that goes from afar through all its jumps, or of a
  !> loading and the first unloading that come back to where they began.
  subroutine judge_energy(judge, steps, outcome)
    type(judge_t), intent(inout) :: judge
    class(path_stepper_t), intent(inout) :: steps
    type(experiment_result_t), intent(inout) :: outcome
    type(lost_energy_t) :: lost
    real(wp) :: lowest
    integer :: turned, k
    logical :: whole, known

    turned = 0
    known = .true.
    lowest = -huge(1.0_wp)
    if (allocated(outcome%path)) then
      if (outcome%path%first_piece == 1 .and. allocated(outcome%path%finish)) then
        turned = outcome%path%last_piece
        lowest = outcome%path%finish%h0
      end if
    else if (allocated(outcome%loading) .and. allocated(outcome%unloading)) then
      associate (there => outcome%loading, back => outcome%unloading(1))
        if (there%first_piece == 1 .and. back%last_piece == 1) turned = back%first_piece
      end associate
    end if
    if (turned < 2) return
    do k = 1, turned - 1
      call judge_jump(steps%known%inward(k)%fold)
      call judge_jump(steps%known%outward(k + 1)%fold)
    end do
    call energy_lost(steps%known, 1, turned, lowest, lost, whole)
    if (whole) call energy_lost(steps%known, turned, 1, lowest, lost, whole)
    if (.not. whole) return
    outcome%energy_lost = lost%energy
    outcome%jumps = lost%fold
    outcome%energy_uncertainty = judge%fine%margin*abs(lost%energy - lost%fine_energy) + &
      lost%rounding
    if (.not. known) outcome%energy_uncertainty = abs(lost%energy)

  contains

    subroutine judge_jump(fold)
      integer, intent(in) :: fold
      type(reported_t) :: landed

      if (fold == 0) return
      landed%point = fold
      landed%landing = .true.
      call judge_on_path(steps%equations_t, judge%fine, .false., steps%known, landed)
      known = known .and. landed%error%known .and. steps%known%path%point(fold)%error%known
    end subroutine judge_jump

  end subroutine judge_energy

end module result_errors
