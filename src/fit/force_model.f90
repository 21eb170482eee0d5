!> The prediction of a model for bodies that a spring moves towards each other and back: the
!> branches (`force_branch`) on which approach and retract run, and the jumps between them. All
!> quantities are in SI units.
module force_model
  use kinds, only: wp
  use force_branch, only: force_branch_t, load_at_t
  implicit none
  private
  public :: force_model_t, response_t, way_t, inward, outward

  !> The two segments: approach and retract.
  integer, parameter :: inward = 1, outward = 2

  !> The branches of a segment in order, and the position of the base at the end of each. The main
  !> jump, the one with the largest change of load, starts from the end of branch number `main` of
  !> these; 0 without a jump. predicted = .false.: the theory does not predict the jump.
  type :: way_t
    integer, allocatable :: branch(:)
    real(wp), allocatable :: leaves_at(:)
    integer :: main = 0
    logical :: predicted = .true.
  end type way_t

  type :: response_t
    type(force_branch_t), allocatable :: branch(:)
    type(way_t) :: way(2)
  contains
    procedure :: load_on
    procedure :: value_on
    procedure, private :: branch_on
    procedure :: largest_tension
    procedure :: jump_from
  end type response_t

  !> A model of the force between the bodies, with unknowns.
  type, abstract :: force_model_t
    !> Whether the contact radius is wanted.
    logical :: with_radius = .false.
  contains
    !> The response for values of the unknowns. A spring of `stiffness` moves the bodies from the
    !> position `farthest` [m] to a contact under a load of at least `largest` [N]. stiffness = 0
    !> means bodies in contact under dead loads, with -load as position. with_rates: derivatives by
    !> the unknowns are wanted. found = .false.: there is no response.
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

  !> The load at a position on a segment. side = 1: on the branch before the main jump, at any
  !> position; side = 2: on the branch after it; side = 0: with the jumps of the model.
  pure type(load_at_t) function load_on(self, way, side, position) result(found)
    class(response_t), intent(in) :: self
    integer, intent(in) :: way, side
    real(wp), intent(in) :: position

    found = self%branch(self%branch_on(way, side, position))%at(position)
  end function load_on

  !> The same load without derivatives, which trials of many contact points need.
  pure real(wp) function value_on(self, way, side, position) result(load)
    class(response_t), intent(in) :: self
    integer, intent(in) :: way, side
    real(wp), intent(in) :: position

    load = self%branch(self%branch_on(way, side, position))%value_at(position)
  end function value_on

  !> The branch on which a position of a segment lies; side as in `load_on`.
  pure integer function branch_on(self, way, side, position) result(branch)
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
      branch = legs%branch(i)
    end associate
  end function branch_on

  !> The start of the main jump of a segment: the position of the base, its derivatives by the
  !> unknowns, and the load there.
  pure subroutine jump_from(self, way, position, rate, load)
    class(response_t), intent(in) :: self
    integer, intent(in) :: way
    real(wp), intent(out) :: position, load
    real(wp), allocatable, intent(out) :: rate(:)

    associate (branch => self%branch(self%way(way)%branch(self%way(way)%main)))
      call branch%leave(way == inward, position, rate, load)
    end associate
  end subroutine jump_from

  !> The largest tension at the ends of the panels.
  pure real(wp) function largest_tension(self) result(tension)
    class(response_t), intent(in) :: self
    integer :: i

    tension = maxval([(self%branch(i)%largest_tension(), i=1, size(self%branch))])
  end function largest_tension

end module force_model
