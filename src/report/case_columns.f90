!> The columns and numbers of a case in sweep.csv. These are the values of the case's keys, and one
!> number from its summary for each row of `result_rows` that is a column for this deck. A row that
!> is a list has a column for each turning point, spring or load of the deck.
module case_columns
  use kinds, only: wp
  use failure, only: failure_t
  use text, only: brief, listing, lower, word_of, word_count
  use deck_numbers, only: find_number, present_name
  use result_rows, only: row_t, rows, turning, spring, given_load, layered_regime, &
    of_carpick => carpick, of_troyon => pietrement_troyon
  use classical, only: carpick, pietrement_troyon
  use scene_groups, only: scene_t
  use summary, only: summary_t
  use fit_columns, only: columns_of_fit, count_of_fit, text_columns
  implicit none
  private
  public :: columns_of, numbers_of, column_count, left_out, column_width
  public :: chosen_number_t, chosen_numbers, key_columns

  !> Number of characters of a column's description.
  integer, parameter :: column_width = 132
  !> The last column.
  character(len=*), parameter :: failure_column = &
    'failure [] why results of the case are missing; blank if none is'
  !> The columns of a sweep that only fits curves.
  character(len=*), parameter :: of_problem(*) = [character(len=15) :: 'converged', 'sigma', &
    'tabor', 'reduced_modulus', 'surface_energy', 'jkr_pull_off', 'dmt_pull_off']
  !> The groups with a list; each element of the list has columns of its own.
  character(len=*), parameter :: with_list(*) = [character(len=10) :: turning, spring, given_load]
  !> Groups that give numbers in sweep.csv and tables of their own, and these tables, which a sweep
  !> does not write.
  character(len=*), parameter :: with_tables(2, 4) = reshape([character(len=27) :: &
    'approximations', 'approximations.csv', 'classical', 'classical.csv', &
    'device', 'device.csv device_jumps.csv', 'fixed_load', 'fixed_load.csv'], [2, 4])

  !> A number of the summary: its row in `result_rows`, and the element if the row is a list.
  type :: chosen_number_t
    integer :: row = 0, element = 1
  contains
    procedure :: name => name_of
  end type chosen_number_t

contains

  !> The columns of this scene's sweep, each described as 'name [unit] meaning': first the keys,
  !> then numbers, the numbers of a fit, and `failure`.
  function columns_of(scene) result(columns)
    type(scene_t), intent(in) :: scene
    character(len=column_width), allocatable :: columns(:)
    type(chosen_number_t), allocatable :: numbers(:)
    integer :: i

    numbers = chosen_numbers(scene)
    associate (keys => size(scene%sweep%words))
      allocate (columns(column_count(scene)))
      columns(:keys) = key_columns(scene)
      ! Filled item by item: compiler note 2.
      do i = 1, size(numbers)
        associate (row => rows(numbers(i)%row))
          columns(keys + i) = numbers(i)%name() // ' [' // trim(row%unit) // '] ' // row%meaning
        end associate
      end do
      if (allocated(scene%fit)) then
        columns(keys + size(numbers) + 1:size(columns) - 1) = columns_of_fit(scene)
      end if
    end associate
    columns(size(columns)) = failure_column
  end function columns_of

  !> The columns of the keys.
  function key_columns(scene) result(columns)
    type(scene_t), intent(in) :: scene
    character(len=column_width), allocatable :: columns(:)
    type(failure_t), allocatable :: error
    integer :: k, place, term

    allocate (columns(size(scene%sweep%words)))
    do k = 1, size(columns)
      call find_number(scene%deck, word_of(scene%sweep%names, k), place, term, error, &
        words=.true.)
      columns(k) = word_of(scene%sweep%names, k) // ' [' // &
        trim(scene%deck%specs(place)%unit) // '] a key of the deck'
    end do
  end function key_columns

  !> The name of a number's column.
  pure function name_of(self) result(name)
    class(chosen_number_t), intent(in) :: self
    character(len=:), allocatable :: name

    name = trim(rows(self%row)%key)
    if (rows(self%row)%list) name = name // '_' // brief(self%element)
  end function name_of

  !> Number of columns of this scene's sweep.
  pure integer function column_count(scene)
    type(scene_t), intent(in) :: scene

    column_count = size(scene%sweep%words) + size(chosen_numbers(scene)) + 1
    if (allocated(scene%fit)) column_count = column_count + count_of_fit(scene) + &
      text_columns
  end function column_count

  !> The tables that a sweep of the scene does not write, as text for a message; empty if only
  !> curves are omitted.
  function left_out(scene) result(text)
    type(scene_t), intent(in) :: scene
    character(len=:), allocatable :: text
    integer :: i

    text = ''
    if (.not. allocated(scene%sweep)) return
    do i = 1, size(with_tables, 2)
      if (scene%deck%has_group(trim(with_tables(1, i)))) &
        text = text // ' ' // trim(with_tables(2, i))
    end do
    if (text /= '') text = 'sweep.csv has the numbers of each case; a sweep writes no ' // &
      listing(text(2:), '', '') // '; run a case alone for these'
  end function left_out

  !> The numbers of a case's summary, one for each of the columns between the keys and those of the
  !> fit or `failure`; NaN for a number that does not exist.
  pure function numbers_of(summary, scene) result(values)
    type(summary_t), intent(in) :: summary
    type(scene_t), intent(in) :: scene
    real(wp), allocatable :: values(:)
    type(chosen_number_t), allocatable :: numbers(:)
    integer :: i

    numbers = chosen_numbers(scene)
    allocate (values(size(numbers)))
    do i = 1, size(numbers)
      values(i) = summary%element(numbers(i)%row, numbers(i)%element)
    end do
  end function numbers_of

  !> The numbers of a sweep of the scene: first those of every sweep, then those that a group adds,
  !> finally those of lists, element by element.
  pure function chosen_numbers(scene) result(numbers)
    type(scene_t), intent(in) :: scene
    type(chosen_number_t), allocatable :: numbers(:)
    integer :: i, k, n
    integer, allocatable :: single(:), of_list(:)

    single = [pack([(i, i=1, size(rows))], [(comes_always(rows(i)), i=1, size(rows))]), &
      pack([(i, i=1, size(rows))], [(comes_with_group(rows(i)), i=1, size(rows))])]
    if (scene%law%terms > 1 .or. scene%law%group /= 'force') &
      single = [single, pack([(i, i=1, size(rows))], rows%sweep == '(forces)')]
    numbers = [(chosen_number_t(single(i)), i=1, size(single))]
    do n = 1, size(with_list)
      ! Row by row: compiler note 14.
      of_list = pack([(i, i=1, size(rows))], [(rows(i)%sweep == with_list(n), i=1, size(rows))])
      do k = 1, elements(scene, with_list(n))
        numbers = [numbers, (chosen_number_t(of_list(i), k), i=1, size(of_list))]
      end do
    end do

  contains

    !> Whether a row is a column in every sweep. A sweep that only fits curves has no solution
    !> points, and no numbers of such points.
    pure logical function comes_always(row)
      type(row_t), intent(in) :: row

      comes_always = row%sweep == 'always'
      if (comes_always .and. allocated(scene%fit) .and. .not. scene%finds_states()) &
        comes_always = any(row%key == of_problem)
    end function comes_always

    !> Whether a group of the deck makes a row a column. The deck is searched only if the row names
    !> a group, since each case calls this function for all rows.
    pure logical function comes_with_group(row)
      type(row_t), intent(in) :: row

      select case (row%sweep)
      case ('', 'always', '(forces)')
        comes_with_group = .false.
      case (of_carpick)
        comes_with_group = shows(carpick)
      case (of_troyon)
        comes_with_group = shows(pietrement_troyon)
      case (layered_regime)
        comes_with_group = scene%regime .and. allocated(scene%bodies%surface)
      case default
        comes_with_group = .not. row%list
        if (comes_with_group) comes_with_group = scene%deck%has_group(trim(row%sweep))
      end select
    end function comes_with_group

    pure logical function shows(theory)
      integer, intent(in) :: theory

      shows = allocated(scene%classical)
      if (shows) shows = scene%classical%shown(theory)
    end function shows

  end function chosen_numbers

  !> Number of elements in the results of a group with a list: that of the deck's list, or one if
  !> the sweep replaces the whole list by one value.
  pure integer function elements(scene, group)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: group

    elements = 0
    select case (group)
    case (turning)
      if (allocated(scene%unloading)) elements = count_of('from', size(scene%unloading%from))
    case (spring)
      ! Without a spring constant h0 is prescribed, which counts as one element.
      if (allocated(scene%device)) &
        elements = count_of('spring_constant', max(1, size(scene%device%stiffness)))
    case (given_load)
      if (allocated(scene%fixed_loads)) elements = count_of('load', size(scene%fixed_loads))
    end select

  contains

    pure integer function count_of(key, values)
      character(len=*), intent(in) :: key
      integer, intent(in) :: values
      integer :: k

      count_of = values
      do k = 1, word_count(scene%sweep%names)
        if (present_name(scene%deck, lower(word_of(scene%sweep%names, k))) == &
          trim(group) // '.' // key) count_of = 1
      end do
    end function count_of

  end function elements

end module case_columns
