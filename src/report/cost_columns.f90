!> The columns and numbers of a case in costs.csv: the values of its keys, the time and the work of
!> the case, and the estimated errors of those numbers in sweep.csv that have an error.
module cost_columns
  use kinds, only: wp
  use result_rows, only: rows
  use result_tables, only: columns_of
  use case_columns, only: chosen_number_t, chosen_numbers, key_columns, column_width
  use scene_groups, only: scene_t
  use summary, only: summary_t
  implicit none
  private
  public :: cost_columns_of, costs_of

  character(len=*), parameter :: table = 'costs.csv'

contains

  !> The columns of this scene's costs.csv, each described as 'name [unit] meaning'.
  function cost_columns_of(scene) result(columns)
    type(scene_t), intent(in) :: scene
    character(len=column_width), allocatable :: columns(:)
    type(chosen_number_t), allocatable :: numbers(:)
    integer :: keys, of_all, i

    numbers = numbers_with_error(scene)
    keys = size(scene%sweep%words)
    of_all = size(columns_of(table))
    allocate (columns(keys + of_all + size(numbers)))
    columns(:keys) = key_columns(scene)
    columns(keys + 1:keys + of_all) = columns_of(table)
    ! Filled item by item: compiler note 2.
    do i = 1, size(numbers)
      associate (row => rows(numbers(i)%row))
        columns(keys + of_all + i) = numbers(i)%name() // trim(row%error) // ' [' // &
          trim(row%unit) // '] estimated error of ' // numbers(i)%name()
      end associate
    end do
  end function cost_columns_of

  !> The numbers of a case's row after its keys: the time [s], then the other columns of `table` and
  !> the errors, both from the summary; NaN for a number that does not exist.
  pure function costs_of(summary, scene, seconds) result(values)
    type(summary_t), intent(in) :: summary
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: seconds
    real(wp), allocatable :: values(:)
    type(chosen_number_t), allocatable :: numbers(:)
    character(len=column_width), allocatable :: of_all(:)
    integer :: i

    numbers = numbers_with_error(scene)
    allocate (of_all(size(columns_of(table))))
    of_all = columns_of(table)
    values = [seconds, &
      [(summary%number(of_all(i)(:index(of_all(i), ' ') - 1)), i=2, size(of_all))], &
      [(summary%error_of(numbers(i)%row, numbers(i)%element), i=1, size(numbers))]]
  end function costs_of

  !> The numbers of the scene's sweep.csv that have an estimated error.
  pure function numbers_with_error(scene) result(numbers)
    type(scene_t), intent(in) :: scene
    type(chosen_number_t), allocatable :: numbers(:)
    integer :: i

    numbers = chosen_numbers(scene)
    ! Row by row: compiler note 14.
    numbers = pack(numbers, [(rows(numbers(i)%row)%error /= '', i=1, size(numbers))])
  end function numbers_with_error

end module cost_columns
