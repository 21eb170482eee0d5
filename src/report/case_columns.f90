!> The columns and numbers of a case in sweep.csv: the values of its keys, and those rows of
!> `result_rows` that are columns for this deck, with one number each from the case's summary.
module case_columns
  use kinds, only: wp, nan
  use failure, only: failure_t
  use text, only: brief, word_of
  use deck_numbers, only: find_number
  use places, only: readings_t
  use result_rows, only: row_t, rows
  use scene_groups, only: scene_t
  use summary, only: summary_t
  implicit none
  private
  public :: columns_of, numbers_of, column_width

  !> Number of characters of a column's description.
  integer, parameter :: column_width = 132
  !> The last column.
  character(len=*), parameter :: failure_column = &
    'failure [] why results of the case are missing; blank if none is'

contains

  !> The columns of this scene's sweep, each described as 'name [unit] meaning': the keys, numbers,
  !> and `failure`.
  function columns_of(scene) result(columns)
    type(scene_t), intent(in) :: scene
    character(len=column_width), allocatable :: columns(:)
    type(failure_t), allocatable :: error
    character(len=:), allocatable :: number
    integer, allocatable :: single(:)
    integer :: i, k, n, row, term

    single = single_columns(scene)
    associate (keys => size(scene%sweep%words))
      allocate (columns(keys + size(single) + turning_points(scene)*count(each_turn(rows)) + 1))
      ! Filled item by item: compiler note 2.
      do k = 1, keys
        call find_number(scene%deck, word_of(scene%sweep%names, k), row, term, error, words=.true.)
        columns(k) = word_of(scene%sweep%names, k) // ' [' // &
          trim(scene%deck%specs(row)%unit) // '] a key of the deck'
      end do
      do i = 1, size(single)
        columns(keys + i) = described(rows(single(i)), '')
      end do
      n = keys + size(single)
    end associate
    do k = 1, turning_points(scene)
      number = brief(k)
      do i = 1, size(rows)
        if (.not. each_turn(rows(i))) cycle
        n = n + 1
        columns(n) = described(rows(i), '_' // number)
      end do
    end do
    columns(n + 1) = failure_column
  end function columns_of

  !> The numbers of a case's summary, one for each of `columns_of(scene)` between keys and failure;
  !> NaN for a number that does not exist.
  pure function numbers_of(summary, scene) result(values)
    type(summary_t), intent(in) :: summary
    type(scene_t), intent(in) :: scene
    real(wp), allocatable :: values(:)
    type(readings_t) :: found
    integer, allocatable :: single(:)
    integer :: i, k

    single = single_columns(scene)
    allocate (values(size(single)), source=nan)
    do i = 1, size(single)
      associate (key => rows(single(i))%key)
        if (summary%has(key)) values(i) = summary%number(key)
      end associate
    end do
    do k = 1, turning_points(scene)
      do i = 1, size(rows)
        if (.not. each_turn(rows(i))) cycle
        found = summary%numbers_of_row(i)
        values = [values, item(found%value, k)]
      end do
    end do
  end function numbers_of

  !> The rows that have one column in a sweep of the scene: first those of every sweep, then those
  !> that a group adds.
  pure function single_columns(scene) result(single)
    type(scene_t), intent(in) :: scene
    integer, allocatable :: single(:)
    integer :: i

    single = [pack([(i, i=1, size(rows))], rows%sweep == 'always'), &
      pack([(i, i=1, size(rows))], [(comes_with_group(rows(i)), i=1, size(rows))])]
    if (scene%law%terms > 1 .or. scene%law%group /= 'force') &
      single = [single, pack([(i, i=1, size(rows))], rows%sweep == '(forces)')]

  contains

    !> Looks into the deck only if the row names a group, since each case calls this for all rows.
    pure logical function comes_with_group(row)
      type(row_t), intent(in) :: row

      select case (row%sweep)
      case ('', 'always', '(forces)', 'unloading')
        comes_with_group = .false.
      case default
        comes_with_group = scene%deck%has_group(trim(row%sweep))
      end select
    end function comes_with_group

  end function single_columns

  !> Whether a row has one column for each turning point.
  elemental logical function each_turn(row)
    type(row_t), intent(in) :: row

    each_turn = row%sweep == 'unloading'
  end function each_turn

  pure integer function turning_points(scene)
    type(scene_t), intent(in) :: scene

    turning_points = 0
    if (allocated(scene%unloading)) turning_points = size(scene%unloading%from)
  end function turning_points

  pure function described(row, suffix) result(text)
    type(row_t), intent(in) :: row
    character(len=*), intent(in) :: suffix
    character(len=column_width) :: text

    text = trim(row%key) // suffix // ' [' // trim(row%unit) // '] ' // row%meaning
  end function described

  !> Element k of an array; NaN if there is none, as in a case that failed, or that has fewer
  !> turning points than the deck.
  pure real(wp) function item(values, k)
    real(wp), intent(in) :: values(:)
    integer, intent(in) :: k

    item = nan
    if (k <= size(values)) item = values(k)
  end function item

end module case_columns
