!> The approximation of slowly varying deformation over the range of a scene, as rows of a table,
!> and the jumps of approaching bodies in this approximation. SI units.
module approximation_tables
  ! The module with most dependencies is first: compiler note 12.
  use results, only: results_t
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: wp, nan
  use dimensionless_problem, only: problem_t
  use slow_deformation, only: by_quadrature, closed_form, attraction_only, has_form, &
    slow_displacement, slow_load
  use slow_jumps, only: slow_gap, at_h0, at_criterion, at_fold
  use scene_groups, only: range_t
  use result_rows, only: row_of
  use summary, only: summary_t
  implicit none
  private
  public :: write_approximations, summarise_approximations

  !> A state: gap, h0 and displacement [m], load [N]. theory: the name of its row in the table, ''
  !> if there is no state.
  type :: slow_state_t
    character(len=24) :: theory = ''
    real(wp) :: gap = 0, h0 = 0, displacement = 0, load = 0
  end type slow_state_t

  !> The jumps of approaching bodies, in the order of the rows. The first is that of the stability
  !> criterion (29). The second is that of (37), which is (29) for the attraction of Lennard-Jones
  !> alone. The third is the fold of h0 by (35b). The fourth is the fold of h0 by (35a), or by (22)
  !> for a law without closed form.
  integer, parameter :: of_criterion = 1, of_equation_37 = 2, of_attraction = 3, of_fold = 4

  !> Names of the curves, in the order of the forms.
  character(len=*), parameter :: names(3) = [character(len=16) :: 'slow_deformation', &
    'closed_form', 'attractive_only']

  !> Number of points along the curve from which the spacing of its rows is computed.
  integer, parameter :: samples = 2000

contains

  !> Writes the curve of each form that the law has, in range%count rows from the start of the range
  !> to smaller gaps. One row for each jump follows, whether the jump is within the range or not.
  !> Along a curve the steps have equal |change of gap on the axis| + |change of displacement|. The
  !> curve of an attractive law ends at the jump by (29) or (37) if this jump is within the range;
  !> there is no curve if the jump comes before the start. from [m]: the start of the curve if the
  !> range has no start. For rigid bodies the displacement is zero and the load exact.
  subroutine write_approximations(problem, range, from, results)
    type(problem_t), intent(in) :: problem
    type(range_t), intent(in) :: range
    real(wp), intent(in) :: from
    type(results_t), intent(inout) :: results
    type(slow_state_t) :: jumps(of_fold)
    real(wp) :: start, nearest
    integer :: k

    call results%begin_table('approximations.csv')
    start = from
    if (allocated(range%h0_start)) start = range%h0_start
    jumps = jumps_of(problem)
    nearest = -huge(1.0_wp)
    if (jumps(of_criterion)%theory /= '') nearest = problem%law%gap_of(jumps(of_criterion)%gap)
    call add_curve(by_quadrature)
    call add_curve(closed_form)
    if (jumps(of_equation_37)%theory /= '') nearest = problem%law%gap_of(jumps(of_equation_37)%gap)
    call add_curve(attraction_only)
    do k = 1, size(jumps)
      if (jumps(k)%theory /= '') call write_row(jumps(k))
    end do

  contains

    !> Writes the rows of a form, for gaps not smaller than `nearest`.
    subroutine add_curve(form)
      integer, intent(in) :: form
      real(wp), allocatable :: gap(:)
      integer :: i

      if (.not. has_form(problem, form)) return
      gap = gaps_between(form, problem%law%gap_of(start), problem%law%gap_of(range%h0_end), &
        range%count)
      do i = 1, size(gap)
        call write_row(state_at(problem, form, gap(i), trim(names(form))))
      end do
    end subroutine add_curve

    !> Writes the row of a state. These theories give no contact radius.
    subroutine write_row(state)
      type(slow_state_t), intent(in) :: state

      call results%row(trim(state%theory), [state%h0, state%displacement, state%load, nan])
    end subroutine write_row

    !> Gaps on the axis (in lengths L of the law), descending. The first one is the gap at h0 =
    !> start; the last one is the gap at h0 = finish or `nearest`, whichever is larger. There are
    !> none if the gap at h0 = start is smaller than `nearest`.
    pure function gaps_between(form, start, finish, count) result(gap)
      integer, intent(in) :: form, count
      real(wp), intent(in) :: start, finish
      real(wp), allocatable :: gap(:)
      real(wp) :: high, low
      integer :: i

      allocate (gap(0))
      if (.not. start > finish) return
      if (.not. problem%coupling > 0) then
        gap = [(start + (finish - start)*(i - 1)/(count - 1), i=1, count)]
        ! At gaps smaller than this one rigid bodies would touch.
        gap = pack(gap, gap >= problem%law%smallest_gap)
        return
      end if
      high = slow_gap(problem, form, at_h0, start, nearest)
      if (ieee_is_nan(high)) return
      low = slow_gap(problem, form, at_h0, finish, nearest)
      if (ieee_is_nan(low)) low = max(nearest, problem%law%smallest_gap)
      if (high > low) gap = spaced(form, high, low, count)
    end function gaps_between

    !> `count` gaps from high to low, equally spaced along the curve of displacement against gap. If
    !> the displacement grows as the gap falls, these steps are equal steps of h0.
    pure function spaced(form, high, low, count) result(gap)
      integer, intent(in) :: form, count
      real(wp), intent(in) :: high, low
      real(wp) :: gap(count), at(0:samples), delta(0:samples), length(0:samples), wanted
      integer :: i, j

      ! The displacement varies most at small gaps, over the length of the repulsion.
      associate (scale => problem%law%repulsion_length)
        at = [(low + scale*((1 + (high - low)/scale)**(real(samples - j, wp)/samples) - 1), &
          j=0, samples)]
      end associate
      at(0) = high
      at(samples) = low
      delta = slow_displacement(problem, form, at)
      length(0) = 0
      do j = 1, samples
        length(j) = length(j - 1) + abs(at(j) - at(j - 1)) + abs(delta(j) - delta(j - 1))
      end do
      j = 1
      do i = 1, count
        wanted = length(samples)*(i - 1)/(count - 1)
        do while (j < samples .and. length(j) < wanted)
          j = j + 1
        end do
        gap(i) = at(j) + (at(j - 1) - at(j))*(length(j) - wanted) &
          /max(length(j) - length(j - 1), tiny(wanted))
      end do
      gap(count) = low
    end function spaced

  end subroutine write_approximations

  !> The jumps of approaching bodies; none for rigid bodies or without attraction.
  pure function jumps_of(problem) result(jumps)
    type(problem_t), intent(in) :: problem
    type(slow_state_t) :: jumps(of_fold)
    integer :: form

    form = by_quadrature
    if (has_form(problem, closed_form)) form = closed_form
    jumps(of_criterion) = jump_of(form, at_criterion, 'jump_criterion_29')
    jumps(of_equation_37) = jump_of(attraction_only, at_criterion, 'jump_equation_37')
    jumps(of_attraction) = jump_of(attraction_only, at_fold, 'fold_attractive_only')
    jumps(of_fold) = jump_of(form, at_fold, 'fold_'//trim(names(form)))

  contains

    pure type(slow_state_t) function jump_of(form, condition, theory) result(jump)
      integer, intent(in) :: form, condition
      character(len=*), intent(in) :: theory
      real(wp) :: gap

      gap = slow_gap(problem, form, condition)
      if (.not. ieee_is_nan(gap)) jump = state_at(problem, form, gap, theory)
    end function jump_of

  end function jumps_of

  !> Adds the jumps of approaching bodies to the summary. For a law without a closed form, the fold
  !> of h0 stands in approximations.csv only.
  subroutine summarise_approximations(problem, summary)
    type(problem_t), intent(in) :: problem
    type(summary_t), intent(inout) :: summary
    type(slow_state_t) :: jumps(of_fold)
    character(len=:), allocatable :: key
    integer :: k

    jumps = jumps_of(problem)
    do k = 1, size(jumps)
      key = trim(jumps(k)%theory)
      if (row_of(key//'_h0') == 0) cycle
      call summary%set(key//'_h0', jumps(k)%h0)
      call summary%set(key//'_load', jumps(k)%load)
    end do
    if (jumps(of_equation_37)%theory /= '') &
      call summary%set('jump_equation_37_gap', jumps(of_equation_37)%gap)
  end subroutine summarise_approximations

  !> The state of a form at a gap on the axis (in lengths L of the law). theory: the name of its
  !> row.
  pure type(slow_state_t) function state_at(problem, form, gap, theory) result(state)
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: form
    real(wp), intent(in) :: gap
    character(len=*), intent(in) :: theory
    real(wp) :: delta

    delta = slow_displacement(problem, form, gap)
    state%theory = theory
    state%gap = problem%law%separation_of(gap)
    state%h0 = problem%law%separation_of(gap - delta)
    state%displacement = delta*problem%length
    state%load = slow_load(problem, form, gap)*problem%load
  end function state_at

end module approximation_tables
