!> The approximation of slowly varying deformation over the range of a scene, as rows of a table,
!> and where it says that approaching bodies jump. SI units.
module approximation_tables
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan, ieee_is_nan
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use slow_deformation, only: by_quadrature, closed_form, attraction_only, has_form, &
    slow_displacement, slow_load
  use slow_jumps, only: gap_of_h0, criterion_gap, equation_37_gap, fold_gap
  use scene_groups, only: range_t
  use results, only: results_t
  use summary, only: summary_t
  implicit none
  private
  public :: write_approximations, summarise_approximations, jump_t

  !> A state at which approaching bodies jump, by some criterion [m], [m], [m], [N]; `theory` is the
  !> name of its row in the table.
  type :: jump_t
    character(len=:), allocatable :: theory
    real(wp) :: gap = 0, h0 = 0, displacement = 0, load = 0
  end type jump_t

  !> The jumps that the approximation knows; what does not exist is not allocated. By the stability
  !> criterion (29); by (37), which is (29) for the attraction of Lennard-Jones alone; where h0
  !> turns round along (35b); and where it does so along (35a), or along (22) for a law without
  !> closed form.
  type :: jumps_t
    type(jump_t), allocatable :: criterion, equation_37, fold_attraction, fold
  end type jumps_t

  !> Names of the curves, in the order of the forms.
  character(len=*), parameter :: names(3) = [character(len=16) :: 'slow_deformation', &
    'closed_form', 'attractive_only']

  !> Points of the curve along which its rows are spaced.
  integer, parameter :: samples = 2000

contains

  !> Writes the curve of each form that the law has, in range%count rows from the start of the range
  !> inwards, and one row for each jump, whether or not it is within the range. The parameter of a
  !> curve is the gap on the axis, whose steps have equal |change of gap| + |change of
  !> displacement|. Curves of a law that attracts end where the bodies jump, by (29) or (37), if
  !> that is before the end of the range; there is none if it is before the start. `from` [m] stands
  !> in for a range without a start. For rigid bodies the displacement is zero and the load exact.
  subroutine write_approximations(problem, range, from, results)
    type(problem_t), intent(in) :: problem
    type(range_t), intent(in) :: range
    real(wp), intent(in) :: from
    type(results_t), intent(inout) :: results
    type(jumps_t) :: jumps
    real(wp) :: start, nearest

    start = from
    if (allocated(range%h0_start)) start = range%h0_start
    jumps = jumps_of(problem)
    nearest = -huge(1.0_wp)
    if (allocated(jumps%criterion)) nearest = problem%law%gap_of(jumps%criterion%gap)
    call add_curve(by_quadrature)
    call add_curve(closed_form)
    if (allocated(jumps%equation_37)) nearest = problem%law%gap_of(jumps%equation_37%gap)
    call add_curve(attraction_only)
    call add_jump(jumps%criterion)
    call add_jump(jumps%equation_37)
    call add_jump(jumps%fold_attraction)
    call add_jump(jumps%fold)

  contains

    !> The rows of a form, for gaps not below `nearest`.
    subroutine add_curve(form)
      integer, intent(in) :: form
      real(wp), allocatable :: gap(:)
      integer :: i

      if (.not. has_form(problem, form)) return
      gap = gaps_between(problem, form, problem%law%gap_of(start), &
        problem%law%gap_of(range%h0_end), nearest, range%count)
      do i = 1, size(gap)
        call write_row(results, state_at(problem, form, gap(i), trim(names(form))))
      end do
    end subroutine add_curve

    subroutine add_jump(jump)
      type(jump_t), allocatable, intent(in) :: jump

      if (allocated(jump)) call write_row(results, jump)
    end subroutine add_jump

  end subroutine write_approximations

  !> The jumps of approaching bodies; none for rigid ones or without attraction.
  pure function jumps_of(problem) result(jumps)
    type(problem_t), intent(in) :: problem
    type(jumps_t) :: jumps
    integer :: form

    form = by_quadrature
    if (has_form(problem, closed_form)) form = closed_form
    call set(jumps%criterion, form, criterion_gap(problem, form), 'jump_criterion_29')
    call set(jumps%equation_37, attraction_only, equation_37_gap(problem), 'jump_equation_37')
    call set(jumps%fold_attraction, attraction_only, fold_gap(problem, attraction_only), &
      'fold_attractive_only')
    call set(jumps%fold, form, fold_gap(problem, form), 'fold_'//trim(names(form)))

  contains

    pure subroutine set(jump, form, gap, theory)
      type(jump_t), allocatable, intent(out) :: jump
      integer, intent(in) :: form
      real(wp), intent(in) :: gap
      character(len=*), intent(in) :: theory

      if (.not. ieee_is_nan(gap)) jump = state_at(problem, form, gap, theory)
    end subroutine set

  end function jumps_of

  !> Where approaching bodies jump in the approximation of slow deformation.
  subroutine summarise_approximations(problem, summary)
    type(problem_t), intent(in) :: problem
    type(summary_t), intent(inout) :: summary
    type(jumps_t) :: jumps

    jumps = jumps_of(problem)
    call take(jumps%criterion, 'jump_criterion_29')
    call take(jumps%equation_37, 'jump_equation_37')
    if (allocated(jumps%equation_37)) &
      call summary%set('jump_equation_37_gap', jumps%equation_37%gap)
    call take(jumps%fold_attraction, 'fold_attractive_only')
    if (allocated(jumps%fold)) then
      ! That of a law without a closed form has another name, in approximations.csv alone.
      if (jumps%fold%theory == 'fold_closed_form') &
        call take(jumps%fold, 'fold_closed_form')
    end if

  contains

    subroutine take(jump, key)
      type(jump_t), allocatable, intent(in) :: jump
      character(len=*), intent(in) :: key

      if (.not. allocated(jump)) return
      call summary%set(key//'_h0', jump%h0)
      call summary%set(key//'_load', jump%load)
    end subroutine take

  end subroutine summarise_approximations

  !> The state of a form at a gap on the axis (law's lengths).
  pure function state_at(problem, form, gap, theory) result(jump)
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: form
    real(wp), intent(in) :: gap
    character(len=*), intent(in) :: theory
    type(jump_t) :: jump
    real(wp) :: delta

    delta = slow_displacement(problem, form, gap)
    jump%theory = theory
    jump%gap = problem%law%separation_of(gap)
    jump%h0 = problem%law%separation_of(gap - delta)
    jump%displacement = delta*problem%length
    jump%load = slow_load(problem, form, gap)*problem%load
  end function state_at

  !> Writes the row of a state; these theories give no contact radius.
  subroutine write_row(results, state)
    type(results_t), intent(inout) :: results
    type(jump_t), intent(in) :: state

    call results%row(state%theory, [state%h0, state%displacement, state%load, &
      ieee_value(1.0_wp, ieee_quiet_nan)])
  end subroutine write_row

  !> Gaps on the axis, descending, from the one at h0 = start to the one at h0 = finish or to
  !> `nearest`, whichever is larger (law's lengths). None if h0 = start is not reached beyond it.
  pure function gaps_between(problem, form, start, finish, nearest, count) result(gap)
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: form, count
    real(wp), intent(in) :: start, finish, nearest
    real(wp), allocatable :: gap(:)
    real(wp) :: high, low
    integer :: i

    allocate (gap(0))
    if (.not. start > finish) return
    if (.not. problem%coupling > 0) then
      gap = [(start + (finish - start)*(i - 1)/(count - 1), i=1, count)]
      ! Nearer than that rigid bodies would touch.
      gap = pack(gap, gap >= problem%law%smallest_gap)
      return
    end if
    high = gap_of_h0(problem, form, start, nearest)
    if (ieee_is_nan(high)) return
    low = gap_of_h0(problem, form, finish, nearest)
    if (ieee_is_nan(low)) low = max(nearest, problem%law%smallest_gap)
    if (high > low) gap = spaced(problem, form, high, low, count)
  end function gaps_between

  !> `count` gaps from high to low, equally far apart along the curve of gap and displacement. For a
  !> displacement that grows as the gap falls these are equal steps of h0.
  pure function spaced(problem, form, high, low, count) result(gap)
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: form, count
    real(wp), intent(in) :: high, low
    real(wp) :: gap(count)
    real(wp) :: at(0:samples), delta(0:samples), length(0:samples), wanted
    integer :: i, j

    ! The displacement varies most at the near end, over the law's own length.
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

end module approximation_tables
