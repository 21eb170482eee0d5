!> Derivatives of what is reported by the parameters of &sensitivity, as rows of tables: of numbers,
!> and of the curve.
module sensitivity_rows
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan, ieee_positive_inf
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use variation, only: variation_t
  use place_sensitivity, only: of_h0, of_displacement, of_radius
  use path_sensitivity, only: rate_t, held
  use driven_pieces, only: through_spring
  use path_readings, only: path_readings_t, loaded_state_t
  use results, only: results_t
  use result_rows, only: rows
  use summary, only: summary_t
  implicit none
  private
  public :: write_sensitivity, write_curve_sensitivity


  !> Where z changes along the path by less than this part of its terms, or of the law's units, it
  !> turns round.
  real(wp), parameter :: turning = 1.0e-8_wp

contains

  !> Writes the rows of sensitivity.csv; a drive in time has no readings.
  subroutine write_sensitivity(problem, varied, summary, readings, results)
    type(problem_t), intent(in) :: problem
    type(variation_t), intent(in) :: varied(:)
    type(summary_t), intent(in) :: summary
    type(path_readings_t), intent(in), optional :: readings
    type(results_t), intent(inout) :: results

    call write_of_summary(varied, summary, results)
    if (.not. present(readings)) return
    if (allocated(readings%loaded)) call write_of_loaded(problem, varied, readings%loaded, results)
  end subroutine write_sensitivity

  !> Writes rows of sensitivity.csv, quantity by quantity in the order of the summary.
  subroutine write_of_summary(varied, summary, results)
    type(variation_t), intent(in) :: varied(:)
    type(summary_t), intent(in) :: summary
    type(results_t), intent(inout) :: results
    real(wp), allocatable :: values(:), rate(:, :)
    character(len=40) :: name
    integer :: i, j, k

    do i = 1, size(rows)
      rate = summary%rate(trim(rows(i)%key))
      values = summary%numbers(trim(rows(i)%key))
      do k = 1, size(rate, 2)
        name = rows(i)%key
        if (rows(i)%list) write (name, '(2a, i0, a)') trim(rows(i)%key), '(', k, ')'
        do j = 1, size(rate, 1)
          call write_line(results, trim(name), varied(j), values(k), rate(j, k))
        end do
      end do
    end do
  end subroutine write_of_summary

  !> Writes one row.
  subroutine write_line(results, quantity, varied, value, rate)
    type(results_t), intent(inout) :: results
    character(len=*), intent(in) :: quantity
    type(variation_t), intent(in) :: varied
    real(wp), intent(in) :: value, rate

    call results%row(quantity // ',' // varied%parameter%name, &
      [value, rate, rate*varied%parameter%value/value])
  end subroutine write_line

  !> Writes rows of sensitivity.csv for the rows of fixed_load.csv.
  subroutine write_of_loaded(problem, varied, loaded, results)
    type(problem_t), intent(in) :: problem
    type(variation_t), intent(in) :: varied(:)
    type(loaded_state_t), intent(in) :: loaded(:)
    type(results_t), intent(inout) :: results
    character(len=12) :: row
    integer :: i

    do i = 1, size(loaded)
      write (row, '(a, i0, a)') '(', i, ')'
      associate (state => loaded(i)%state)
        if (.not. allocated(state%rate)) cycle
        call add('h0', problem%law%separation_of(state%h0), state%rate(of_h0, :))
        call add('displacement', (state%axis_gap - state%h0)*problem%length, &
          state%rate(of_displacement, :))
        if (state%radius > 0) call add('contact_radius', state%radius*problem%lateral, &
          state%rate(of_radius, :))
      end associate
    end do

  contains

    subroutine add(column, value, rate)
      character(len=*), intent(in) :: column
      real(wp), intent(in) :: value, rate(:)
      integer :: j

      do j = 1, size(rate)
        call write_line(results, 'fixed_load.' // column // trim(row), varied(j), value, rate(j))
      end do
    end subroutine add

  end subroutine write_of_loaded

  !> Writes the rows of curve_sensitivity.csv: the curve at prescribed h0 and then behind each
  !> spring, for each parameter.
  subroutine write_curve_sensitivity(problem, varied, readings, results)
    type(problem_t), intent(in) :: problem
    type(variation_t), intent(in) :: varied(:)
    type(path_readings_t), intent(in) :: readings
    type(results_t), intent(inout) :: results
    real(wp), allocatable :: stiffness(:)
    integer :: i, j, k

    stiffness = [ieee_value(1.0_wp, ieee_positive_inf)]
    if (allocated(readings%device)) stiffness = [stiffness, &
      pack(readings%device%stiffness, readings%device%stiffness <= huge(1.0_wp))]
    do j = 1, size(varied)
      do k = 1, size(stiffness)
        do i = 1, size(readings%node)
          call add(i, j, stiffness(k))
        end do
      end do
    end do

  contains

    subroutine add(i, j, stiffness)
      integer, intent(in) :: i, j
      real(wp), intent(in) :: stiffness
      type(rate_t) :: rate
      real(wp) :: weights(2), terms(2), z

      associate (node => readings%node(i), drive => through_spring(stiffness))
        weights = drive%weights
        terms = weights*node%slopes*[problem%length, problem%load]
        rate = held(problem, node, readings%rate(j, i), weights)
        if (.not. abs(sum(terms)) > turning*sum(abs(terms) + &
          abs(weights)*[problem%length, problem%load])) then
          rate%h0 = ieee_value(1.0_wp, ieee_quiet_nan)
          rate%load = rate%h0
        end if
        z = ieee_value(1.0_wp, ieee_quiet_nan)
        if (weights(1) > 0) z = problem%law%separation_of(node%h0) + weights(2)*node%load* &
          problem%load
        call results%row(varied(j)%parameter%name, [stiffness, z, &
          problem%law%separation_of(node%h0), node%load*problem%load, rate%h0, rate%load])
      end associate
    end subroutine add

  end subroutine write_curve_sensitivity

end module sensitivity_rows
