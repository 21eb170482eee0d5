!> The columns of a fit in sweep.csv: each parameter with its errors, the derived numbers, how well
!> the model describes the curve, and a verdict in one word. `case_fit` has the numbers in these
!> columns.
module fit_columns
  use kinds, only: wp
  use scene_groups, only: scene_t
  use result_tables, only: columns_of
  implicit none
  private
  public :: columns_of_fit, values_of_fit, count_of_fit, verdicts, described, warned, &
    not_described, refused, unreadable, text_columns, endings, derived

  !> The numbers of the verdicts, counted from 1.
  integer, parameter :: described = 1, warned = 2, not_described = 3, refused = 4, unreadable = 5
  character(len=13), parameter :: verdicts(*) = [character(len=13) :: 'described', 'warned', &
    'not_described', 'refused', 'unreadable']
  !> The number of columns with text, which follow the numbers.
  integer, parameter :: text_columns = 2

  !> Endings of the names of a parameter's columns, in the order of the columns. The title under
  !> which `result_tables` has the meanings of these columns.
  character(len=*), parameter :: endings(*) = [character(len=16) :: '_estimate', &
    '_standard_error', '_lower_95', '_upper_95']
  character(len=*), parameter :: each_parameter = 'with &fit, for each parameter'
  !> Derived numbers that a fit may have, each with an error; number of the other columns.
  character(len=*), parameter :: derived(*) = [character(len=16) :: 'work_of_adhesion', &
    'reduced_modulus', 'young_of_sample']
  integer, parameter :: others = 9

contains

  !> The columns, each described as 'name [unit] meaning'; those with text come last.
  function columns_of_fit(scene) result(columns)
    type(scene_t), intent(in) :: scene
    character(len=132), allocatable :: columns(:), meanings(:)
    integer :: i, k, n

    allocate (columns(count_of_fit(scene) + text_columns))
    meanings = columns_of('sweep.csv', each_parameter)
    n = 0
    do i = 1, size(scene%fit%unknown)
      associate (unknown => scene%fit%unknown(i))
        do k = 1, size(endings)
          n = n + 1
          columns(n) = unknown%name // trim(endings(k)) // ' [' // unknown%unit // &
            meanings(k)(index(meanings(k), ']'):)
        end do
      end associate
    end do
    columns(n + 1:) = columns_of('sweep.csv', 'with &fit')
  end function columns_of_fit

  !> The number of the columns with numbers.
  pure integer function count_of_fit(scene) result(n)
    type(scene_t), intent(in) :: scene

    n = size(endings)*size(scene%fit%unknown) + 2*size(derived) + others
  end function count_of_fit

  !> The fitted values of the unknowns, among all numbers of a fit with `unknowns` unknowns.
  pure function values_of_fit(numbers, unknowns) result(values)
    real(wp), intent(in) :: numbers(:)
    integer, intent(in) :: unknowns
    real(wp) :: values(unknowns)

    values = numbers(:size(endings)*unknowns:size(endings))
  end function values_of_fit

end module fit_columns
