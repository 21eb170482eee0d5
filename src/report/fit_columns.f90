!> The columns of a fit in sweep.csv: each parameter with its errors, the derived numbers, how well
!> the model describes the curve, and a verdict in a word. `case_fit` has their numbers.
module fit_columns
  use kinds, only: wp
  use scene_groups, only: scene_t
  use result_tables, only: columns_of
  implicit none
  private
  public :: columns_of_fit, values_of_fit, count_of_fit, verdicts, described, warned, &
    not_described, refused, unreadable, text_columns, endings, derived

  !> The verdicts by their numbers, from 1.
  integer, parameter :: described = 1, warned = 2, not_described = 3, refused = 4, unreadable = 5
  character(len=13), parameter :: verdicts(*) = [character(len=13) :: 'described', 'warned', &
    'not_described', 'refused', 'unreadable']
  !> The number of columns with text, which follow the numbers.
  integer, parameter :: text_columns = 2

  !> Endings of the names of a parameter's columns, in their order, and where `result_tables` has
  !> their meanings.
  character(len=*), parameter :: endings(*) = [character(len=16) :: '_estimate', &
    '_standard_error', '_lower_95', '_upper_95']
  character(len=*), parameter :: each_parameter = 'with &fit, for each parameter'
  !> Numbers that a fit may have, with their errors; the number of the others.
  character(len=*), parameter :: derived(*) = [character(len=16) :: 'work_of_adhesion', &
    'reduced_modulus', 'young_of_sample']
  integer, parameter :: others = 9

contains

  !> The columns, those with text as the last ones, each described as 'name [unit] meaning'.
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

  !> The fitted values among the numbers of a fit of `unknowns` numbers.
  pure function values_of_fit(numbers, unknowns) result(values)
    real(wp), intent(in) :: numbers(:)
    integer, intent(in) :: unknowns
    real(wp) :: values(unknowns)

    values = numbers(:size(endings)*unknowns:size(endings))
  end function values_of_fit

end module fit_columns
