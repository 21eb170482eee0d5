!> The cases of a sweep one after the other, wherever they come from.
module sweep_cases
  use kinds, only: wp
  use failure, only: failure_t, fail, file_trouble
  use scene_groups, only: scene_t
  use case_rows, only: case_rows_t
  implicit none
  private
  public :: sweep_cases_t

  !> Not to be copied between `begin` and the last case.
  type :: sweep_cases_t
    !> Number of the case that was handed out last.
    integer :: number = 0
    type(case_rows_t), private :: rows
  contains
    procedure :: begin
    procedure :: next
  end type sweep_cases_t

contains

  !> Before the first case.
  subroutine begin(self, scene, error)
    class(sweep_cases_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    type(failure_t), allocatable, intent(out) :: error

    self%number = 0
    if (allocated(scene%sweep%file)) &
      call self%rows%open(scene%sweep%file%path, scene%deck, error)
  end subroutine begin

  !> The values of the keys in the next case. Not found: there are no more. Fails where a file is
  !> no longer what it was when the deck was read.
  subroutine next(self, scene, values, found, error)
    class(sweep_cases_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(wp), allocatable, intent(inout) :: values(:)
    logical, intent(out) :: found
    type(failure_t), allocatable, intent(out) :: error
    logical :: there

    found = self%number < scene%sweep%cases()
    if (.not. found) return
    self%number = self%number + 1
    if (allocated(scene%sweep%file)) then
      call self%rows%next(values, there, error)
      found = there .and. .not. allocated(error)
      if (.not. found .and. .not. allocated(error)) call fail(error, file_trouble, &
        scene%sweep%file%path // ' has become shorter since it was read first')
    else
      values = scene%sweep%values(self%number)
    end if
  end subroutine next

end module sweep_cases
