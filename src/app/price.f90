!> The relation of accuracy and cost for a deck: the deck is computed with five accuracies, and a
!> table on standard output shows time, work and estimated errors. The rows are cases of a sweep
!> whose costs are measured. On a uniform grid, whose errors do not follow from the accuracy, the
!> rows have five numbers of nodes instead.
module price
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: wp, nan
  use failure, only: failure_t, fail, bad_input
  use text, only: brief
  use dimensionless_problem, only: problem_t
  use scene_problem, only: problem_of
  use scene_groups, only: scene_t, sweep_t
  use numerics_choice, only: choice_t, choose, uniform
  use case_columns, only: columns_of, column_width
  use cost_columns, only: cost_columns_of
  use sweep_case, only: run_case
  use price_table, only: price_row_t, keys, head_of, text_of_row, conclusion_of
  use mesh_store, only: mesh_store_t
  use preflight, only: check_room
  use files, only: write_stdout
  use result_folder, only: to_stream
  use linear_algebra, only: claim_buffers
  use progress, only: progress_t
  implicit none
  private
  public :: price_scene

  integer, parameter :: rows = 5
  !> The accuracies of a path or cycle. The cost of a drive in time is a power of its accuracy, and
  !> that of a uniform grid a power of its number of nodes. Their last rows have the values of the
  !> deck, so that no row costs more. drive_range: ratio of the accuracy in the first row of a drive
  !> to that in the last; least_accurate: its upper limit. grid_range: ratio of the number of nodes
  !> in the last row to that in the first.
  real(wp), parameter :: accuracies(rows) = [1e-3_wp, 1e-4_wp, 1e-6_wp, 1e-8_wp, 1e-10_wp], &
    drive_range = 100, least_accurate = 0.1_wp, grid_range = 4

contains

  !> Prints the table of a scene. name: the name of the deck. quiet: no progress is shown.
  !> converged: whether all rows were computed. error: the deck can have no such table, or the table
  !> cannot be written.
  subroutine price_scene(scene, name, quiet, converged, error)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: name
    logical, intent(in) :: quiet
    logical, intent(out) :: converged
    type(failure_t), allocatable, intent(out) :: error
    type(scene_t) :: varied
    type(problem_t) :: problem
    type(price_row_t) :: row(rows)
    type(mesh_store_t) :: unused
    type(progress_t) :: progress
    logical :: shown(size(keys))
    integer :: i

    converged = .false.
    problem = problem_of(scene)
    call refuse(scene, problem, error)
    if (allocated(error)) return
    varied = scene
    varied%sweep = ladder(scene, problem)
    call check_room(varied, to_stream, error)
    if (allocated(error)) return
    call claim_buffers()
    do i = 1, rows
      row(i)%case%number = i
      row(i)%case%values = varied%sweep%values(i)
      call progress%start(0, name//', '//varied%sweep%names//' = '// &
        brief(row(i)%case%values(1))//' ('//brief(i)//' of '//brief(rows)//')', quiet)
      call run_case(varied, progress, unused, row(i)%case)
      call progress%finish()
      call read_case(varied, problem, row(i))
      if (i == 1) then
        shown = .not. ieee_is_nan(row(1)%error) .or. .not. row(1)%case%converged
        call write_stdout(head_of(name, varied%sweep%names, shown), error)
        if (allocated(error)) return
      end if
      call write_stdout(text_of_row(row(i), shown, &
        any(row(:i - 1)%case%warning == row(i)%case%warning)), error)
      if (allocated(error)) return
    end do
    converged = all([(row(i)%case%converged, i=1, rows)])
    call write_stdout(conclusion_of(varied%sweep%names, row), error)
  end subroutine price_scene

  !> Fails for a deck that means more than one run, or that computes no states.
  subroutine refuse(scene, problem, error)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(failure_t), allocatable, intent(out) :: error

    if (allocated(scene%sweep)) then
      call fail(error, bad_input, '--price is for one run, and this deck has &sweep; ' // &
        'costs = .true. in &sweep measures each case, into costs.csv')
    else if (allocated(scene%fit)) then
      call fail(error, bad_input, '--price is for one run, and this deck has &fit; leave out ' // &
        '&fit to see what accuracy costs for one curve')
    else if (.not. scene%finds_states()) then
      call fail(error, bad_input, '--price: nothing in this deck depends on the accuracy; it ' // &
        'needs &loading, &equilibrium_path or &drive')
    else if (problem%rigid .and. .not. allocated(scene%drive)) then
      call fail(error, bad_input, '--price: the bodies are rigid, and their loads do not ' // &
        'depend on the accuracy')
    end if
  end subroutine refuse

  !> The sweep whose cases are the rows of the table.
  type(sweep_t) function ladder(scene, problem) result(sweep)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(choice_t) :: chosen
    real(wp) :: last
    integer :: i

    chosen = choose(scene, problem)
    sweep%costs = .true.
    allocate (sweep%words(1), sweep%axis(1))
    sweep%words = ''
    sweep%names = 'numerics.accuracy'
    if (allocated(scene%drive)) then
      last = min(scene%numerics%accuracy, least_accurate/grid_range)
      sweep%axis(1)%values = [(one_digit(last* &
        min(drive_range, least_accurate/last)**(real(rows - i, wp)/(rows - 1))), i=1, rows)]
      sweep%axis(1)%values(rows) = last
    else if (chosen%grid == uniform) then
      sweep%names = 'numerics.nodes'
      sweep%axis(1)%values = [(max(2.0_wp, anint(chosen%nodes* &
        grid_range**(-real(rows - i, wp)/(rows - 1)))), i=1, rows)]
    else
      sweep%axis(1)%values = accuracies
    end if
  end function ladder

  pure real(wp) function one_digit(x)
    real(wp), intent(in) :: x
    real(wp) :: order

    order = 10.0_wp**floor(log10(x))
    one_digit = anint(x/order)*order
  end function one_digit

  !> Fills a row with the numbers of its case.
  subroutine read_case(scene, problem, row)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(price_row_t), intent(inout) :: row
    character(len=column_width), allocatable :: of_numbers(:), of_costs(:)
    real(wp) :: scale
    integer :: i

    of_numbers = columns_of(scene)
    of_costs = cost_columns_of(scene)
    row%seconds = cost('seconds')
    row%nodes = cost('nodes')
    row%states = cost('states')
    row%products = cost('operator_products')
    row%estimate = cost('error_estimate')
    do i = 1, size(keys)
      row%value(i) = numbered(of_numbers(2:), row%case%numbers, trim(keys(i)))
      if (ieee_is_nan(row%value(i))) cycle
      scale = abs(row%value(i))
      ! As in error_estimate, the error of h0 is relative to at least L, since h0 may be zero at a
      ! jump.
      if (index(keys(i), '_h0') > 0) scale = max(scale, problem%length)
      row%error(i) = cost(trim(keys(i))//'_error')
      if (keys(i) == 'energy_lost') row%error(i) = cost('energy_lost_uncertainty')
      if (scale > 0) row%error(i) = row%error(i)/scale
    end do

  contains

    pure real(wp) function cost(key)
      character(len=*), intent(in) :: key

      cost = numbered(of_costs(2:), row%case%costs, key)
    end function cost

  end subroutine read_case

  !> The number in the column `key`; NaN if there is no such column.
  pure real(wp) function numbered(columns, numbers, key)
    character(len=*), intent(in) :: columns(:), key
    real(wp), intent(in) :: numbers(:)
    integer :: i

    numbered = nan
    do i = 1, size(numbers)
      if (index(columns(i), key//' ') == 1) numbered = numbers(i)
    end do
  end function numbered

end module price
