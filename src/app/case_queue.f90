!> The cases of a sweep: those still to be computed, in order, and the rows of completed cases. Each
!> case has one row with the values of its keys and its numbers.
module case_queue
  use kinds, only: wp
  use failure, only: failure_t, fail, bad_input, file_trouble
  use scene_groups, only: scene_t
  use sweep_case, only: case_t, sweep_tally_t, pass_case, pass_task
  use fit_columns, only: values_of_fit, count_of_fit, verdicts, described
  use case_rows, only: case_rows_t
  use case_columns, only: column_width
  use byte_record, only: byte_record_t
  use results, only: results_t
  use dispatch, only: foreman_t
  implicit none
  private
  public :: case_queue_t

  !> In a sweep of fits, the first fit among this number of cases that succeeds gives the starting
  !> values of the later ones.
  integer, parameter :: most_first = 5

  !> The cases of a sweep. handed_out: number of cases handed out. waiting: completed cases whose
  !> rows cannot be written before those of earlier cases; a case stands at its number modulo the
  !> size of the array. written: number of rows written. tally: the tally of these.
  type, extends(foreman_t) :: case_queue_t
    type(scene_t), pointer :: scene => null()
    type(results_t), pointer :: results => null()
    character(len=column_width), allocatable :: columns(:), cost_columns(:)
    !> The file with the cases, if the sweep has one.
    type(case_rows_t) :: rows
    type(case_t), allocatable :: waiting(:)
    integer :: handed_out = 0, written = 0
    type(sweep_tally_t) :: tally
    !> The fitted values of the first curve that the model describes; later fits start from them.
    real(wp), allocatable :: like(:)
  contains
    procedure :: next
    procedure :: put_next
    procedure :: take_answer
    procedure :: enter
    procedure :: begin
    procedure, private :: next_row
    procedure, private :: waits
    procedure, private :: learn
    procedure, private :: has
    procedure, private :: add
  end type case_queue_t

contains

  !> The next case that is not complete. found = .false. if there is no such case, if results cannot
  !> be written, or if the file has changed since the deck was read.
  subroutine next(self, case, found)
    class(case_queue_t), intent(inout) :: self
    type(case_t), intent(inout) :: case
    logical, intent(out) :: found
    type(failure_t), allocatable :: error
    real(wp), allocatable :: rest(:)

    found = .false.
    if (allocated(self%results%trouble) .or. allocated(self%results%folder%journal%trouble)) return
    if (self%waits()) return
    associate (sweep => self%scene%sweep)
      do while (.not. found .and. self%handed_out < sweep%cases())
        self%handed_out = self%handed_out + 1
        case%number = self%handed_out
        if (allocated(sweep%file)) then
          call self%next_row(case%values, .false., error)
          case%text = self%rows%text
        else
          case%values = sweep%values(case%number)
          case%text = sweep%text_of(case%values)
        end if
        if (allocated(error)) then
          found = .false.
          call move_alloc(error, self%results%trouble)
          return
        end if
        found = .not. self%has(case%number)
      end do
      case%like = [real(wp) ::]
      if (allocated(self%like)) case%like = self%like
      if (.not. found .and. allocated(sweep%file)) &
        call self%next_row(rest, .true., self%results%trouble)
    end associate
  end subroutine next

  !> Whether the next case has to wait. The first fits are made one by one until the model describes
  !> a curve; then no result depends on the number of fits made at the same time. Fits that are made
  !> together are made one by one anyway.
  pure logical function waits(self)
    class(case_queue_t), intent(in) :: self

    waits = allocated(self%scene%fit) .and. .not. allocated(self%like) .and. &
      self%handed_out <= most_first .and. self%written < self%handed_out
    if (waits) waits = .not. self%scene%fit%is_joint()
  end function waits

  !> Reads the row of the next case from the file. If all cases are `given`, it checks that no row
  !> follows. The file was read before without a mistake. All of its lines are compared with that
  !> reading, since a changed row may also be a valid case. If the file has changed, it is not known
  !> which completed cases belong to the deck, so that no run may continue from them.
  subroutine next_row(self, values, given, error)
    class(case_queue_t), intent(inout) :: self
    real(wp), allocatable, intent(inout) :: values(:)
    logical, intent(in) :: given
    type(failure_t), allocatable, intent(out) :: error
    logical :: found

    call self%rows%next(values, found, error)
    associate (file => self%scene%sweep%file)
      if (allocated(error)) then
        if (error%kind == file_trouble) return
      else if (given) then
        if (.not. found .and. self%rows%digest == file%digest) return
      else if (found) then
        return
      end if
      call self%results%folder%journal%discard()
      call fail(error, bad_input, file%path // ' has changed since it was first read; start again')
    end associate
  end subroutine next_row

  !> Appends the next case to a batch for another process. found = .false.: there is none.
  subroutine put_next(self, batch, found)
    class(case_queue_t), intent(inout) :: self
    type(byte_record_t), intent(inout) :: batch
    logical, intent(out) :: found
    type(case_t) :: case

    call self%next(case, found)
    if (.not. found) return
    call pass_task(batch, case)
  end subroutine put_next

  !> Enters the next case of the answers of another process.
  subroutine take_answer(self, answers)
    class(case_queue_t), intent(inout) :: self
    type(byte_record_t), intent(inout) :: answers
    type(case_t) :: case

    call pass_case(answers, case)
    call self%enter(case)
  end subroutine take_answer

  !> Takes a computed case and appends it to the journal.
  subroutine enter(self, case)
    class(case_queue_t), intent(inout) :: self
    type(case_t), intent(inout) :: case
    type(byte_record_t) :: record

    call pass_case(record, case)
    call self%results%folder%journal%append(record)
    call self%add(case)
    call self%results%progress%step('case', failed=.not. case%converged)
  end subroutine enter

  !> Begins the queue with the completed cases of an interrupted run.
  subroutine begin(self)
    class(case_queue_t), intent(inout) :: self
    type(byte_record_t) :: record
    type(case_t) :: case
    logical :: found

    allocate (self%waiting(0:15))
    do
      call self%results%folder%journal%next(record, found)
      if (.not. found) exit
      call pass_case(record, case)
      call self%add(case)
      call self%results%progress%step('case', failed=.not. case%converged, given=.true.)
    end do
  end subroutine begin

  !> Whether a case is complete, from this run or from the interrupted one.
  pure logical function has(self, number)
    class(case_queue_t), intent(in) :: self
    integer, intent(in) :: number

    has = number <= self%written
    if (.not. has) has = self%waiting(mod(number, size(self%waiting)))%number == number
  end function has

  !> Adds a completed case, and writes all rows that are next in order.
  subroutine add(self, case)
    class(case_queue_t), intent(inout) :: self
    type(case_t), intent(in) :: case

    call make_room(self%waiting, case%number - self%written)
    self%waiting(mod(case%number, size(self%waiting))) = case
    do
      associate (first => self%waiting(mod(self%written + 1, size(self%waiting))))
        if (first%number /= self%written + 1) exit
        call write_case(self, first)
        if (allocated(self%scene%fit)) call self%learn(first)
        call self%tally%add(first)
        first%number = 0
        deallocate (first%numbers, first%values, first%costs, first%text)
      end associate
      self%written = self%written + 1
    end do
  end subroutine add

  !> Keeps the fitted values of a case if it is the first one that the model describes, among the
  !> first cases.
  pure subroutine learn(self, case)
    class(case_queue_t), intent(inout) :: self
    type(case_t), intent(in) :: case

    if (allocated(self%like) .or. case%number > most_first .or. case%verdict /= described) return
    self%like = values_of_fit(case%numbers(size(case%numbers) - count_of_fit(self%scene) + 1:), &
      size(self%scene%fit%unknown))
  end subroutine learn

  !> Writes the row of a case.
  subroutine write_case(self, case)
    class(case_queue_t), intent(inout) :: self
    type(case_t), intent(in) :: case
    character(len=len(case%failure)) :: texts(3)

    texts = ''
    if (case%verdict > 0) texts(1) = verdicts(case%verdict)
    texts(2) = case%warning
    texts(3) = case%failure
    associate (sweep => self%scene%sweep)
      call self%results%take_case(self%columns, sweep, case%values, case%text, case%numbers, &
        texts(merge(1, 3, allocated(self%scene%fit)):))
      if (sweep%costs) call self%results%take_costs(self%cost_columns, sweep, case%values, &
        case%text, case%costs)
    end associate
  end subroutine write_case

  !> Enlarges the array for a case that comes `ahead` cases after the last one written.
  subroutine make_room(waiting, ahead)
    type(case_t), allocatable, intent(inout) :: waiting(:)
    integer, intent(in) :: ahead
    type(case_t), allocatable :: larger(:)
    integer :: size_needed, i

    if (ahead <= size(waiting)) return
    size_needed = size(waiting)
    do while (size_needed < ahead)
      size_needed = 2*size_needed
    end do
    allocate (larger(0:size_needed - 1))
    do i = 0, size(waiting) - 1
      if (waiting(i)%number > 0) larger(mod(waiting(i)%number, size_needed)) = waiting(i)
    end do
    call move_alloc(larger, waiting)
  end subroutine make_room

end module case_queue
