!> Derivatives of what is reported by the parameters of &sensitivity, as rows of tables: of the
!> numbers of the summary, and of the curve.
module sensitivity_rows
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use variation, only: variation_t
  use namelist_writer, only: line_t
  use result_rows, only: rows
  use summary, only: summary_t
  use tables, only: cells
  implicit none
  private
  public :: sensitivity_columns, sensitivity_lines

  !> Columns of sensitivity.csv.
  character(len=*), parameter :: sensitivity_columns(*) = [character(len=96) :: &
    'quantity [] entry of &summary; of a list with the number of its value', &
    'parameter [] key of the deck', &
    'value [] of the quantity, in its unit', &
    'derivative [] by the parameter, SI units', &
    'logarithmic [] derivative of the logarithm of the quantity by that of the parameter']

contains

  !> Rows of sensitivity.csv, quantity by quantity in the order of the summary.
  function sensitivity_lines(varied, summary) result(lines)
    type(variation_t), intent(in) :: varied(:)
    type(summary_t), intent(in) :: summary
    type(line_t), allocatable :: lines(:)
    type(line_t) :: line
    real(wp), allocatable :: values(:), rate(:, :)
    character(len=40) :: name
    integer :: i, j, k

    allocate (lines(0))
    do i = 1, size(rows)
      rate = summary%rate(trim(rows(i)%key))
      values = summary%numbers(trim(rows(i)%key))
      do k = 1, size(rate, 2)
        name = rows(i)%key
        if (rows(i)%list) write (name, '(2a, i0, a)') trim(rows(i)%key), '(', k, ')'
        do j = 1, size(rate, 1)
          associate (parameter => varied(j)%parameter)
            line%text = trim(name) // ',' // parameter%name // ',' // &
              cells([values(k), rate(j, k), rate(j, k)*parameter%value/values(k)])
          end associate
          lines = [lines, line]
        end do
      end do
    end do
  end function sensitivity_lines

end module sensitivity_rows
