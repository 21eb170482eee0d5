!> The prediction of a model for bodies that a spring drives towards each other and back.
module force_model
  use kinds, only: wp
  use force_branch, only: branch_t, load_at_t
  implicit none
  private
  public :: force_model_t, response_t, way_t, inward, outward

  !> The two ways.
  integer, parameter :: inward = 1, outward = 2

  !> The branches of a way in order, and the position of the drive at the end of each. The main
  !> jump, that with the largest change of load, starts from the end of branch number `main` of
  !> these; 0: there is none. foretold = .false.: the theory does not predict the jump.
  type :: way_t
    integer, allocatable :: branch(:)
    real(wp), allocatable :: leaves_at(:)
    integer :: main = 0
    logical :: foretold = .true.
  end type way_t

  type :: response_t
    type(branch_t), allocatable :: branch(:)
    type(way_t) :: way(2)
  contains
    procedure :: load_on
    procedure :: jump_from
  end type response_t

  !> A model of the force between the bodies, with unknowns.
  type, abstract :: force_model_t
  contains
    !> The response for values of the unknowns, behind a spring of `stiffness`, from the position
    !> `farthest` [m] to a contact under the load `largest` [N] at least. with_rates: with
    !> derivatives by the unknowns. found = .false.: there is no response.
    procedure(respond_to), deferred :: respond
  end type force_model_t

  abstract interface
    subroutine respond_to(self, value, stiffness, farthest, largest, with_rates, response, found)
      import :: force_model_t, response_t, wp
      class(force_model_t), intent(inout) :: self
      real(wp), intent(in) :: value(:), stiffness, farthest, largest
      logical, intent(in) :: with_rates
      type(response_t), intent(out) :: response
      logical, intent(out) :: found
    end subroutine respond_to
  end interface

contains

  !> The load at a position on a way. side: 1 before the main jump, 2 after it, at any position; 0:
  !> with the jumps of the model.
  pure type(load_at_t) function load_on(self, way, side, position) result(found)
    class(response_t), intent(in) :: self
    integer, intent(in) :: way, side
    real(wp), intent(in) :: position
    integer :: i, first, last

    associate (legs => self%way(way))
      first = 1
      last = size(legs%branch)
      if (legs%main > 0 .and. side == 1) last = legs%main
      if (legs%main > 0 .and. side == 2) first = legs%main + 1
      do i = first, last - 1
        if (way == inward .and. position >= legs%leaves_at(i)) exit
        if (way == outward .and. position <= legs%leaves_at(i)) exit
      end do
      found = self%branch(legs%branch(i))%at(position)
    end associate
  end function load_on

  !> The start of the main jump of a way: position of the drive, its derivatives by the unknowns,
  !> and the load there.
  pure subroutine jump_from(self, way, position, rate, load)
    class(response_t), intent(in) :: self
    integer, intent(in) :: way
    real(wp), intent(out) :: position, load
    real(wp), allocatable, intent(out) :: rate(:)
    integer :: i, side

    associate (branch => self%branch(self%way(way)%branch(self%way(way)%main)))
      i = merge(size(branch%h0, 2), 1, way == inward)
      side = merge(2, 1, way == inward)
      position = branch%position(merge(size(branch%position), 1, way == inward))
      load = branch%load(side, i)
      ! At a turn of the position, moving along the branch does not change the position.
      rate = branch%h0_rate(:, side, i) - branch%compliance*branch%load_rate(:, side, i)
    end associate
  end subroutine jump_from

end module force_model
