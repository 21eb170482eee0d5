!> Places on the path, and what is reported of the equilibrium at a place.
module path_state
  use kinds, only: wp
  use contact_state, only: state_t
  implicit none
  private
  public :: path_place_t, path_state_t, part_of, no_mesh

  !> The mesh number of undeformed bodies; their coordinate on the path is -log(h0).
  integer, parameter :: no_mesh = 0

  !> A place between point `interval` of a path and the next, at the path's coordinate x.
  type :: path_place_t
    integer :: interval = 0
    real(wp) :: x = 0
  end type path_place_t

  !> A solved equilibrium at a place: h0, load, gap on the axis, energy in the units of
  !> `dimensionless_problem`, derivatives of h0 and load by x, modes unstable at fixed h0. radius:
  !> of the contact, lateral units; uncertainty: error of the energy due to rounding and the
  !> residual.
  type, extends(path_place_t) :: path_state_t
    real(wp) :: h0 = 0, load = 0, axis_gap = 0, radius = 0, energy = 0, uncertainty = 0
    real(wp) :: slopes(2) = 0, residual = 0
    integer :: modes = 0
    logical :: converged = .false.
    !> Whether this state is a point of the path that is also on the next mesh.
    logical :: again = .false.
    !> The equilibrium and its mesh; with `no_mesh` there is no state.
    type(state_t) :: state
    integer :: mesh = no_mesh
  end type path_state_t

contains

  !> The ends of the part of interval i, from ends(1) to ends(2), that is between two places.
  pure function part_of(ends, i, from, to) result(part)
    real(wp), intent(in) :: ends(2)
    integer, intent(in) :: i
    class(path_place_t), intent(in) :: from, to
    real(wp) :: part(2)

    part = ends
    if (i == from%interval) part(1) = from%x
    if (i == to%interval) part(2) = to%x
  end function part_of

end module path_state
