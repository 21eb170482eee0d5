!> The problem of a deck, for the flat modules. It is a module of its own, since f2py does not
!> understand the type.
module deck_problem
  use dimensionless_problem, only: problem_t
  use failure, only: failure_t
  use scene, only: read_scene, scene_t
  use scene_problem, only: problem_of
  implicit none
  private
  public :: pose

contains

  !> The problem of a deck's text; stat and message report a wrong deck.
  subroutine pose(deck, problem, stat, message)
    character(len=*), intent(in) :: deck
    type(problem_t), intent(out) :: problem
    integer, intent(out) :: stat
    character(len=*), intent(out) :: message
    type(scene_t) :: scene
    type(failure_t), allocatable :: error

    stat = 0
    message = ''
    call read_scene('deck', scene, error, deck)
    if (allocated(error)) then
      stat = error%kind
      message = error%message
    else
      problem = problem_of(scene)
    end if
  end subroutine pose

end module deck_problem
