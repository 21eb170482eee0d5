!> The approximation of slowly varying deformation as f2py can see it. Conventions as in
!> `snapin_flat`, force laws as in `flat_numerics`; rigid: 0 or 1. Numbers that do not exist are
!> NaN.
module flat_approximations
  use iso_c_binding, only: c_double, c_int
  implicit none
  private
  public :: slow_states, slow_jumps, approximation_table

contains

  !> Displacement [m], its derivative by the gap, and load [N] at gaps on the axis [m]. form:
  !> 'quadrature', 'closed_form' or 'attraction_only'.
  subroutine slow_states(law, part, hamaker, z0, p0, decay_length, radius, stiffness, rigid, &
    form, gap, displacement, slope, load, stat, message, n)
    use failure, only: bad_input
    use dimensionless_problem, only: problem_t
    use slow_deformation, only: attraction_only, by_quadrature, closed_form, has_form, &
      slow_displacement, slow_load, slow_slope
    character(len=*), intent(in) :: law, part, form
    integer(c_int), intent(in) :: rigid, n
    real(c_double), intent(in) :: hamaker, z0, p0, decay_length, radius, stiffness, gap(n)
    real(c_double), intent(out) :: displacement(n), slope(n), load(n)
    integer(c_int), intent(out) :: stat
    character(len=200), intent(out) :: message
    type(problem_t) :: problem
    integer :: which

    displacement = 0
    slope = 0
    load = 0
    call pose(law, part, hamaker, z0, p0, decay_length, radius, stiffness, rigid, problem, stat, &
      message)
    if (stat /= 0) return
    which = 0
    if (form == 'quadrature') which = by_quadrature
    if (form == 'closed_form') which = closed_form
    if (form == 'attraction_only') which = attraction_only
    if (which == 0 .or. .not. has_form(problem, which)) then
      stat = bad_input
      message = 'form: this law has none "'//trim(form)//'"'
      return
    end if
    displacement = slow_displacement(problem, which, gap/problem%length)*problem%length
    slope = slow_slope(problem, which, gap/problem%length)
    load = slow_load(problem, which, gap/problem%length)*problem%load
  end subroutine slow_states

  !> Gap on the axis [m], h0 [m], displacement [m] and load [N] of the jumps, in the order of
  !> `jumps_t`, by columns.
  subroutine slow_jumps(law, part, hamaker, z0, p0, decay_length, radius, stiffness, rigid, &
    jumps, stat, message)
    use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
    use approximation_tables, only: jumps_of, jumps_t
    use dimensionless_problem, only: problem_t
    character(len=*), intent(in) :: law, part
    integer(c_int), intent(in) :: rigid
    real(c_double), intent(in) :: hamaker, z0, p0, decay_length, radius, stiffness
    real(c_double), intent(out) :: jumps(4, 4)
    integer(c_int), intent(out) :: stat
    character(len=200), intent(out) :: message
    type(problem_t) :: problem
    type(jumps_t) :: found

    jumps = ieee_value(jumps, ieee_quiet_nan)
    call pose(law, part, hamaker, z0, p0, decay_length, radius, stiffness, rigid, problem, stat, &
      message)
    if (stat /= 0) return
    found = jumps_of(problem)
    if (allocated(found%criterion)) jumps(:, 1) = [found%criterion%gap, found%criterion%h0, &
      found%criterion%displacement, found%criterion%load]
    if (allocated(found%equation_37)) jumps(:, 2) = [found%equation_37%gap, &
      found%equation_37%h0, found%equation_37%displacement, found%equation_37%load]
    if (allocated(found%fold_attraction)) jumps(:, 3) = [found%fold_attraction%gap, &
      found%fold_attraction%h0, found%fold_attraction%displacement, found%fold_attraction%load]
    if (allocated(found%fold)) jumps(:, 4) = [found%fold%gap, found%fold%h0, &
      found%fold%displacement, found%fold%load]
  end subroutine slow_jumps

  !> The rows of approximations.csv for a range from h0_start to h0_end [m]: `rows` of n are filled,
  !> their names, and h0 [m], displacement [m], load [N] and contact radius [m] by columns.
  subroutine approximation_table(law, part, hamaker, z0, p0, decay_length, radius, stiffness, &
    rigid, h0_start, h0_end, count, theory, values, rows, stat, message, n)
    use approximation_tables, only: approximation_rows
    use failure, only: no_convergence
    use dimensionless_problem, only: problem_t
    use records, only: theory_row_t
    use scene_groups, only: range_t
    character(len=*), intent(in) :: law, part
    integer(c_int), intent(in) :: rigid, count, n
    real(c_double), intent(in) :: hamaker, z0, p0, decay_length, radius, stiffness
    real(c_double), intent(in) :: h0_start, h0_end
    character(len=32), intent(out) :: theory(n)
    real(c_double), intent(out) :: values(4, n)
    integer(c_int), intent(out) :: rows, stat
    character(len=200), intent(out) :: message
    type(problem_t) :: problem
    type(theory_row_t), allocatable :: found(:)
    integer :: i

    theory = ''
    values = 0
    rows = 0
    call pose(law, part, hamaker, z0, p0, decay_length, radius, stiffness, rigid, problem, stat, &
      message)
    if (stat /= 0) return
    found = approximation_rows(problem, range_t(h0_end=h0_end, count=int(count)), h0_start)
    if (size(found) > n) then
      stat = no_convergence
      message = 'there are more rows than there is room for'
      return
    end if
    rows = int(size(found), c_int)
    do i = 1, size(found)
      theory(i) = found(i)%theory
      values(:, i) = [found(i)%h0, found(i)%displacement, found(i)%load, found(i)%contact_radius]
    end do
  end subroutine approximation_table

  !> The problem of these bodies under this law; stat and message where there is no such law.
  subroutine pose(law, part, hamaker, z0, p0, decay_length, radius, stiffness, rigid, problem, &
    stat, message)
    use force_law, only: force_law_t
    use law_by_name, only: make_law
    use dimensionless_problem, only: new_problem, problem_t
    character(len=*), intent(in) :: law, part
    integer(c_int), intent(in) :: rigid
    real(c_double), intent(in) :: hamaker, z0, p0, decay_length, radius, stiffness
    type(problem_t), intent(out) :: problem
    integer(c_int), intent(out) :: stat
    character(len=200), intent(out) :: message
    class(force_law_t), allocatable :: this

    call make_law(law, part, hamaker, z0, p0, decay_length, this, stat, message)
    if (stat == 0) problem = new_problem(this, radius, stiffness, rigid /= 0)
  end subroutine pose

end module flat_approximations
