!> The summary of a run: a value for each row of `result_rows` that the run has, and their text in
!> summary.nml, which gfortran, f90nml and this program can read.
module summary
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: wp, long, nan
  use equilibrium, only: cost_t
  use namelist_writer, only: line_t, assignment_of
  use reported_values, only: readings_t
  use result_rows, only: rows, row_of, in_summary, in_cost
  implicit none
  private
  public :: summary_t, summary_text

  !> Largest number of warnings.
  integer, parameter :: most_warnings = 20

  !> The value of a row, in SI units. One of the first four components is allocated, with one or
  !> several values.
  type :: summary_value_t
    real(wp), allocatable :: number(:)
    integer(long), allocatable :: count(:)
    logical, allocatable :: truth
    character(len=:), allocatable :: text
    !> Errors of the numbers; derivatives by each parameter of &sensitivity, (parameters, numbers),
    !> and their errors.
    real(wp), allocatable :: error(:), rate(:, :), rate_error(:, :)
  end type summary_value_t

  !> The summary. A row without a value is absent from the file. An element of an array that does
  !> not exist, such as the snap-off of an unloading without one, is NaN.
  type :: summary_t
    !> One element for each row. The array is allocated when the first value is set: several
    !> summaries on the stack would need a larger stack than a limit of memory may permit.
    type(summary_value_t), allocatable, private :: value(:)
    type(line_t), allocatable :: warnings(:), notes(:)
    !> The first reason why the run did not converge; not allocated if there is none.
    character(len=:), allocatable :: failure
  contains
    procedure :: warn
    procedure :: note
    procedure :: fail_with
    generic :: set => set_number, set_numbers, set_count, set_counts, set_truth, set_text
    procedure :: numbers_of_row
    procedure :: has
    procedure :: number
    procedure :: element
    procedure :: error_of
    procedure :: is_true
    procedure :: text
    procedure :: take_cost
    procedure, private :: find
    procedure, private :: set_number, set_numbers, set_count, set_counts, set_truth, set_text
  end type summary_t

contains

  !> The index of a key's value.
  subroutine find(self, key, i)
    class(summary_t), intent(inout) :: self
    character(len=*), intent(in) :: key
    integer, intent(out) :: i

    if (.not. allocated(self%value)) &
      allocate (self%value(size(rows)), self%warnings(0), self%notes(0))
    i = row_of(key)
  end subroutine find

  !> The numbers of row i with their derivatives, if they exist.
  pure type(readings_t) function numbers_of_row(self, i) result(found)
    class(summary_t), intent(in) :: self
    integer, intent(in) :: i

    allocate (found%value(0), found%rate(0, 0), found%rate_error(0, 0))
    if (allocated(self%value(i)%number)) found%value = self%value(i)%number
    if (.not. allocated(self%value(i)%rate)) return
    found%rate = self%value(i)%rate
    found%rate_error = self%value(i)%rate_error
  end function numbers_of_row

  subroutine set_number(self, key, value, error)
    class(summary_t), intent(inout) :: self
    character(len=*), intent(in) :: key
    real(wp), intent(in) :: value
    real(wp), intent(in), optional :: error

    if (present(error)) then
      call self%set_numbers(key, [value], [error])
    else
      call self%set_numbers(key, [value])
    end if
  end subroutine set_number

  !> Sets numbers with their errors and derivatives. If none of the numbers exists, they are left
  !> out; if no error is known, the errors are left out. Without parameters there are no
  !> derivatives.
  subroutine set_numbers(self, key, values, error, rate, rate_error)
    class(summary_t), intent(inout) :: self
    character(len=*), intent(in) :: key
    real(wp), intent(in) :: values(:)
    real(wp), intent(in), optional :: error(:), rate(:, :), rate_error(:, :)
    integer :: i

    call self%find(key, i)
    if (all(ieee_is_nan(values))) return
    self%value(i)%number = values
    if (present(error)) then
      if (.not. all(ieee_is_nan(error))) self%value(i)%error = error
    end if
    if (.not. (present(rate) .and. present(rate_error))) return
    if (size(rate, 1) == 0) return
    self%value(i)%rate = rate
    self%value(i)%rate_error = rate_error
  end subroutine set_numbers

  subroutine set_count(self, key, value)
    class(summary_t), intent(inout) :: self
    character(len=*), intent(in) :: key
    integer(long), intent(in) :: value
    integer :: i

    call self%find(key, i)
    self%value(i)%count = [value]
  end subroutine set_count

  subroutine set_counts(self, key, values)
    class(summary_t), intent(inout) :: self
    character(len=*), intent(in) :: key
    integer, intent(in) :: values(:)
    integer :: i

    call self%find(key, i)
    self%value(i)%count = int(values, long)
  end subroutine set_counts

  subroutine set_truth(self, key, value)
    class(summary_t), intent(inout) :: self
    character(len=*), intent(in) :: key
    logical, intent(in) :: value
    integer :: i

    call self%find(key, i)
    self%value(i)%truth = value
  end subroutine set_truth

  subroutine set_text(self, key, value)
    class(summary_t), intent(inout) :: self
    character(len=*), intent(in) :: key, value
    integer :: i

    call self%find(key, i)
    self%value(i)%text = value
  end subroutine set_text

  !> Whether a key has a value.
  pure logical function has(self, key)
    class(summary_t), intent(in) :: self
    character(len=*), intent(in) :: key

    has = .false.
    associate (value => self%value(row_of(key)))
      has = allocated(value%number) .or. allocated(value%count) .or. allocated(value%truth) .or. &
        allocated(value%text)
    end associate
  end function has

  !> The first number of a key, as `element`.
  pure real(wp) function number(self, key)
    class(summary_t), intent(in) :: self
    character(len=*), intent(in) :: key

    number = self%element(row_of(key), 1)
  end function number

  !> Element k of row i as a number, or 1 or 0 for a logical value; NaN if it does not exist.
  pure real(wp) function element(self, i, k)
    class(summary_t), intent(in) :: self
    integer, intent(in) :: i, k

    element = nan
    associate (value => self%value(i))
      if (allocated(value%number)) then
        if (k <= size(value%number)) element = value%number(k)
      else if (allocated(value%count)) then
        if (k <= size(value%count)) element = real(value%count(k), wp)
      else if (allocated(value%truth)) then
        element = merge(1, 0, value%truth)
      end if
    end associate
  end function element

  !> The estimated error of element k of row i; NaN if it is not known.
  pure real(wp) function error_of(self, i, k)
    class(summary_t), intent(in) :: self
    integer, intent(in) :: i, k

    error_of = nan
    associate (value => self%value(i))
      if (.not. allocated(value%error)) return
      if (k <= size(value%error)) error_of = value%error(k)
    end associate
  end function error_of

  !> Whether a key has a value that is true.
  pure logical function is_true(self, key)
    class(summary_t), intent(in) :: self
    character(len=*), intent(in) :: key

    is_true = .false.
    associate (value => self%value(row_of(key)))
      if (allocated(value%truth)) is_true = value%truth
    end associate
  end function is_true

  !> The text of a key; empty if the key has none.
  pure function text(self, key)
    class(summary_t), intent(in) :: self
    character(len=*), intent(in) :: key
    character(len=:), allocatable :: text

    text = ''
    associate (value => self%value(row_of(key)))
      if (allocated(value%text)) text = value%text
    end associate
  end function text

  !> Adds a warning of one line. Repeated warnings and those after the twentieth are dropped.
  pure subroutine warn(self, text)
    class(summary_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    type(line_t) :: line
    integer :: i

    if (size(self%warnings) == most_warnings) return
    do i = 1, size(self%warnings)
      if (self%warnings(i)%text == text) return
    end do
    ! Not by a structure constructor: compiler note 1.
    line%text = text
    self%warnings = [self%warnings, line]
    if (size(self%warnings) == most_warnings) &
      self%warnings(most_warnings)%text = 'further warnings are not shown'
  end subroutine warn

  !> Adds a note of one line, which is information and not a warning.
  pure subroutine note(self, text)
    class(summary_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    type(line_t) :: line

    line%text = text
    self%notes = [self%notes, line]
  end subroutine note

  !> Marks the run as not converged, and adds the reason as a warning.
  subroutine fail_with(self, text)
    class(summary_t), intent(inout) :: self
    character(len=*), intent(in) :: text

    call self%set('converged', .false.)
    if (.not. allocated(self%failure)) self%failure = text
    call self%warn(text)
  end subroutine fail_with

  !> Adds the cost of the run as rows of &cost.
  subroutine take_cost(self, cost)
    class(summary_t), intent(inout) :: self
    type(cost_t), intent(in) :: cost

    call self%set('kernel_seconds', cost%kernel_seconds)
    call self%set('solve_seconds', cost%solve_seconds)
    call self%set('estimate_seconds', cost%estimate_seconds)
    call self%set('states', cost%states)
    call self%set('iterations', cost%iterations)
    call self%set('kernel_entries', cost%kernel_entries)
    call self%set('pressure_evaluations', cost%pressure_evaluations)
    call self%set('operator_products', cost%operator_products)
    call self%set('operator_columns', cost%operator_columns)
    call self%set('factorisations', cost%factorisations)
    call self%set('rejected_steps', cost%rejected_steps)
  end subroutine take_cost

  !> The groups &summary and &cost.
  pure function summary_text(self) result(text)
    type(summary_t), intent(in) :: self
    character(len=:), allocatable :: text
    character(len=1), parameter :: nl = new_line('a')

    text = '! Results of snapin, SI units. Values that do not exist are NaN or left out.' // nl // &
      '! The groups after the first two are the deck with defaults; run it again.' // nl // &
      '&summary' // nl // group_text(self, in_summary) // '/' // nl // &
      '&cost' // nl // group_text(self, in_cost) // '/' // nl
  end function summary_text

  pure function group_text(self, group) result(text)
    type(summary_t), intent(in) :: self
    integer, intent(in) :: group
    character(len=:), allocatable :: text
    character(len=:), allocatable :: key
    integer :: i

    text = ''
    do i = 1, size(rows)
      if (rows(i)%group /= group) cycle
      ! A variable, not a name of the associate construct: compiler note 5.
      key = trim(rows(i)%key)
      associate (value => self%value(i))
        text = text // assignment_of(key, value%number) // assignment_of(key, value%count) // &
          assignment_of(key, value%truth) // assignment_of(key, value%text) // &
          assignment_of(key // trim(rows(i)%error), value%error)
        if (key == 'warnings') text = text // assignment_of(key, self%warnings)
        if (key == 'notes') text = text // assignment_of(key, self%notes)
      end associate
    end do
  end function group_text

end module summary
