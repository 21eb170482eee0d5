!> The fit of a model to a measured curve: the best values of the unknowns, their errors, and which
!> of them are correlated.
module curve_fit
  use kinds, only: wp
  use fit_request, only: of_contact_point
  use force_model, only: force_model_t
  use modelled_curve, only: modelled_curve_t
  use curve_residuals, only: curve_residuals_t
  use root_finding, only: bracket_t
  use noise, only: white_noise
  use residual_analysis, only: look_again
  use baseline_test, only: settle_ripple
  use fit_errors, only: fitted_t, judge
  use wider_errors, only: widen
  implicit none
  private
  public :: fit_curve

  !> Number of contact points for which the model is compared with the data: `tried` with the
  !> nearest sample in contact, `tried_apart` with it out of contact. Number of samples used for
  !> each comparison. Number of sections that locate a minimum to a hundredth of the distance
  !> between two contact points; the search continues from there.
  integer, parameter :: tried = 160, tried_apart = 40, samples = 250, sections = 11
  !> Largest numbers. most_points: of contact points kept for each candidate. most_fits: of searches
  !> from the best candidates. most_looks: of restarts from smaller residuals that were found with
  !> the errors. most_rounds: of rounds in which noise, outliers and jumps are determined again.
  integer, parameter :: most_points = 2, most_fits = 8, most_looks = 3, most_rounds = 8
  !> The search ends when this number of searches has led to the same minimum. Relative differences
  !> between sums of squares: below `same` they are equal, above `apart` they belong to different
  !> minima.
  integer, parameter :: enough = 3
  real(wp), parameter :: same = 1.0e-4_wp, apart = 0.02_wp

contains

  !> Fits the model, starting from several candidates, start(unknown, candidate), and from several
  !> contact points if the contact point is unknown. The search ends when a fit describes the data;
  !> the best fit is kept. renew: noise (unless the deck gives it), outliers and jumps are
  !> determined again from the residuals of the model.
  subroutine fit_curve(curve, model, start, renew, fitted)
    type(modelled_curve_t), intent(inout) :: curve
    class(force_model_t), intent(inout), target :: model
    real(wp), intent(in) :: start(:, :)
    logical, intent(in) :: renew
    type(fitted_t), intent(out) :: fitted
    type(curve_residuals_t) :: residuals, trial
    type(fitted_t) :: other
    real(wp), allocatable :: value(:, :), cost(:), left(:)
    logical, allocatable :: found(:)
    integer :: i, k

    residuals%curve = curve
    call residuals%curve%use_model(model)
    call find_candidates(residuals, start, value, cost, fitted%has_path)
    fitted%has_curve = size(cost) > 0
    if (.not. fitted%has_curve) return
    call search_from()
    do i = 1, merge(most_looks, 1, renew)
      k = minloc(left, 1)
      if (.not. left(k) < huge(left)) exit
      trial = residuals
      other = fitted_t(has_path=.true., has_curve=.true., found=found(k))
      other%value = value(:, k)
      if (renew) call settle(trial, other)
      call judge(trial, other)
      if (i == 1 .or. other%is_better_than(fitted)) then
        fitted = other
        curve = trial%curve
      end if
      ! The correlation that residuals show may be caused by a misfit.
      if (fitted%lack%is_noise() .and. .not. curve%data%noise%of_residuals) exit
      ! Skip the other searches that led to the same minimum.
      where (left < (1 + apart)*left(k)) left = huge(left)
    end do
    ! If the model does not describe the data, residuals give neither errors nor better values.
    if (renew .and. allocated(fitted%effect) .and. fitted%lack%is_noise()) call examine()

  contains

    !> Examines the residuals some standard errors away from the best values. If smaller residuals
    !> are found there, the search continues from them.
    subroutine examine()
      type(fitted_t) :: other
      real(wp), allocatable :: better(:)
      real(wp) :: left
      integer :: look

      do look = 1, most_looks
        residuals%curve = curve
        call widen(residuals, fitted, better)
        if (.not. allocated(better)) return
        other = fitted_t(has_path=.true., has_curve=.true., value=better)
        residuals%curve = curve
        call search(residuals, other%value, left, other%found)
        call settle(residuals, other)
        call judge(residuals, other)
        if (.not. other%is_better_than(fitted)) exit
        fitted = other
        curve = residuals%curve
      end do
      residuals%curve = curve
      call widen(residuals, fitted)
    end subroutine examine

    !> Searches from the candidates with the smallest sums of squares, `cost`, and replaces these
    !> candidates by the minima found. left: the sums of squares at the minima; huge for candidates
    !> without a search.
    subroutine search_from()
      integer :: i, k, freedom

      freedom = residuals%rows() - size(value, 1) - residuals%curve%data%baseline_numbers()
      allocate (left(size(cost)), source=huge(1.0_wp))
      allocate (found(size(cost)), source=.false.)
      do i = 1, min(most_fits, size(cost))
        k = minloc(cost, 1)
        cost(k) = huge(cost)
        call search(residuals, value(:, k), left(k), found(k))
        ! Residuals far below the noise show only that the noise is overestimated.
        if (found(k) .and. abs(left(k) - freedom) < 3*sqrt(2.0_wp*freedom)) return
        if (count(left < (1 + same)*minval(left)) == enough) return
      end do
    end subroutine search_from

    !> Determines noise, outliers and jumps from the residuals of the model and fits again, until
    !> nothing changes.
    subroutine settle(residuals, fitted)
      type(curve_residuals_t), intent(inout) :: residuals
      type(fitted_t), intent(inout) :: fitted
      real(wp) :: left
      logical :: done
      integer :: round

      do round = 1, most_rounds
        call residuals%curve%ask(fitted%value, .false., done)
        if (.not. done) return
        call look_again(residuals%curve, fitted%value, done)
        call settle_ripple(residuals, fitted%value, done)
        if (done) return
        call search(residuals, fitted%value, left, fitted%found)
      end do
    end subroutine settle

  end subroutine fit_curve

  !> Candidates with their sums of squares: each column of `start`, at its best contact points.
  !> has_path: the model has a path for some of them.
  subroutine find_candidates(residuals, start, value, cost, has_path)
    type(curve_residuals_t), intent(inout) :: residuals
    real(wp), intent(in) :: start(:, :)
    real(wp), allocatable, intent(out) :: value(:, :), cost(:)
    logical, intent(out) :: has_path
    type(curve_residuals_t) :: few
    real(wp), allocatable :: points(:), costs(:)
    real(wp) :: trial(size(start, 1)), ends(3)
    logical :: found
    integer :: i, k, role

    allocate (value(size(start, 1), 0), cost(0))
    has_path = .false.
    role = findloc(residuals%curve%unknown%role, of_contact_point, 1)
    few = residuals
    few%curve%data%noise = white_noise(residuals%curve%data%noise%deviation)
    call few%curve%data%take(max(1, size(few%curve%data%measured%z)/samples))
    do i = 1, size(start, 2)
      trial = start(:, i)
      if (role == 0) then
        call add(cost_of(residuals, trial))
        cycle
      end if
      call few%curve%reach(trial, ends, found)
      if (.not. found) cycle
      has_path = .true.
      call lowest_points(few, trial, role, ends, points, costs)
      do k = 1, min(most_points, size(points))
        trial(role) = points(minloc(costs, 1))
        call add(minval(costs))
        costs(minloc(costs, 1)) = huge(costs)
      end do
    end do

  contains

    !> Adds the trial to the candidates, if the model has a curve for it.
    subroutine add(left)
      real(wp), intent(in) :: left

      if (.not. left < huge(left)) return
      value = reshape([value, trial], [size(trial), size(value, 2) + 1])
      cost = [cost, left]
    end subroutine add

  end subroutine find_candidates

  !> The contact points with the lowest sums of squares, and these sums. ends: the three contact
  !> points of `reach`. Trial points are evenly spaced between the first two, and at growing
  !> distances from the second to the third. role: the index of the contact point among the
  !> unknowns. Many points can be tried, since a new contact point alone needs no new solution of
  !> the model.
  subroutine lowest_points(residuals, value, role, ends, points, costs)
    type(curve_residuals_t), intent(inout) :: residuals
    real(wp), intent(in) :: value(:), ends(3)
    integer, intent(in) :: role
    real(wp), allocatable, intent(out) :: points(:), costs(:)
    type(bracket_t) :: bracket
    real(wp), dimension(0:tried + tried_apart + 1) :: at, cost
    real(wp) :: golden(2), step, growth
    integer :: i, k

    allocate (points(0), costs(0))
    step = (ends(2) - ends(1))/(tried - 1)
    at(:tried) = [(ends(1) + step*(i - 1), i=0, tried)]
    growth = max(2.0_wp, (ends(3) - ends(2))/step)**(1.0_wp/tried_apart)
    at(tried + 1:) = [(ends(2) + step*growth**i, i=1, tried_apart + 1)]
    cost = [(cost_at(at(i)), i=0, ubound(at, 1))]
    do i = 1, ubound(at, 1) - 1
      if (.not. (cost(i) <= cost(i - 1) .and. cost(i) < cost(i + 1))) cycle
      bracket = bracket_t(at(i - 1), at(i + 1))
      do k = 1, sections
        golden = bracket%golden_points()
        call bracket%keep_larger([-cost_at(golden(1)), -cost_at(golden(2))])
      end do
      points = [points, bracket%middle()]
      costs = [costs, cost_at(bracket%middle())]
    end do

  contains

    real(wp) function cost_at(contact_point)
      real(wp), intent(in) :: contact_point
      real(wp) :: trial(size(value))

      trial = value
      trial(role) = contact_point
      cost_at = cost_of(residuals, trial)
    end function cost_at

  end subroutine lowest_points

  !> The sum of squares; huge if the model has no curve.
  real(wp) function cost_of(residuals, value) result(cost)
    type(curve_residuals_t), intent(inout) :: residuals
    real(wp), intent(in) :: value(:)
    real(wp) :: residual(residuals%rows())
    logical :: found

    call residuals%residuals_of(value, residual, found)
    cost = huge(cost)
    if (found) cost = sum(residual**2)
  end function cost_of

  !> Moves the values to the nearest minimum of the sum of squares. left: the sum of squares there.
  subroutine search(residuals, value, left, found)
    type(curve_residuals_t), intent(inout) :: residuals
    real(wp), intent(inout) :: value(:)
    real(wp), intent(out) :: left
    logical, intent(out) :: found

    where (residuals%curve%unknown%role == of_contact_point) residuals%curve%unknown%origin = value
    call residuals%descend(value, left, found)
  end subroutine search

end module curve_fit
