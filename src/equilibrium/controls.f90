!> What is prescribed in an equilibrium, and what is unknown besides the gaps.
module controls
  use kinds, only: wp
  use contact_state, only: state_t
  implicit none
  private
  public :: control_t, h0_is_prescribed, unknowns_of, node_count, unpack
  public :: at_h0, at_axis_gap, at_edge_radius, at_h0_with_edge

  !> H0 is prescribed at a fixed scale; there is no further unknown.
  integer, parameter :: at_h0 = 1
  !> The gap on the axis is prescribed, H0 is unknown.
  integer, parameter :: at_axis_gap = 2
  !> The contact radius c is prescribed, H0 is unknown; the gap at the edge is that of maximum
  !> tension.
  integer, parameter :: at_edge_radius = 3
  !> H0 is prescribed, the contact radius c is unknown.
  integer, parameter :: at_h0_with_edge = 4

  !> What is prescribed.
  type :: control_t
    integer :: kind = at_h0
    !> The prescribed value: H0, the gap on the axis, or the contact radius.
    real(wp) :: value = 0
    !> Behind a spring, `value` is H0 - compliance*load.
    real(wp) :: compliance = 0
    !> The scale c of the mesh, if c is not an unknown.
    real(wp) :: scale = 1
    !> The mesh of the control.
    integer :: mesh = 1
  end type control_t

contains

  !> Whether a control prescribes H0, directly or behind a spring.
  pure logical function h0_is_prescribed(control)
    type(control_t), intent(in) :: control

    h0_is_prescribed = control%kind == at_h0 .or. control%kind == at_h0_with_edge
  end function h0_is_prescribed

  !> The unknowns of a state under a control: its gaps and, if it is an unknown, H0 or c.
  pure function unknowns_of(control, state) result(z)
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    real(wp), allocatable :: z(:)

    allocate (z(size(state%gap) + merge(0, 1, control%kind == at_h0)))
    z(:size(state%gap)) = state%gap
    if (control%kind == at_h0_with_edge) then
      z(size(z)) = state%scale
    else if (control%kind /= at_h0) then
      z(size(z)) = state%h0
    end if
  end function unknowns_of

  !> Number of gaps among `size` unknowns.
  pure integer function node_count(control, size)
    type(control_t), intent(in) :: control
    integer, intent(in) :: size

    node_count = size
    if (control%kind /= at_h0) node_count = size - 1
  end function node_count

  !> H0 and c of a control and its unknowns.
  pure subroutine unpack(control, z, h0, scale)
    type(control_t), intent(in) :: control
    real(wp), intent(in) :: z(:)
    real(wp), intent(out) :: h0, scale

    h0 = z(size(z))
    scale = control%scale
    select case (control%kind)
    case (at_h0)
      h0 = control%value
    case (at_edge_radius)
      scale = control%value
    case (at_h0_with_edge)
      scale = h0
      h0 = control%value
    end select
  end subroutine unpack

end module controls
