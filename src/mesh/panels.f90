!> Composite Gauss-Legendre panels, graded about the contact edge or the axis: spectral convergence
!> with a few hundred nodes.
module panels
  use kinds, only: wp
  use discretisation, only: discretisation_t
  use linear_mesh, only: new_linear_mesh
  use quadrature, only: gauss_legendre
  implicit none
  private
  public :: new_panel_grid, graded_ends

contains

  !> Panels of `order` nodes with the given ends (offsets from the centre, ascending).
  function new_panel_grid(centre, panel_end, order, elastic) result(grid)
    real(wp), intent(in) :: centre, panel_end(:)
    integer, intent(in) :: order
    logical, intent(in) :: elastic
    type(discretisation_t) :: grid
    real(wp) :: node(order), weight(order)

    call gauss_legendre(node, weight)
    grid = new_linear_mesh(centre, panel_end, node, elastic)
  end function new_panel_grid

  !> Offsets of panel ends about a centre: the panel size is `finest` next to the centre and grows
  !> in proportion to the distance (`growth` times it) up to `coarsest`, inward to the axis and
  !> outward to the position `extent`.
  pure function graded_ends(centre, extent, finest, growth, coarsest) result(ends)
    real(wp), intent(in) :: centre, extent, finest, growth, coarsest
    real(wp), allocatable :: ends(:)
    real(wp), allocatable :: outward(:)

    outward = one_side(extent - centre)
    if (centre > 0) then
      ends = one_side(centre)
      ends = [-ends(size(ends):1:-1), outward(2:)]
    else
      ends = outward
    end if

  contains

    pure function one_side(length) result(distance)
      real(wp), intent(in) :: length
      real(wp), allocatable :: distance(:)
      real(wp) :: size_here, d

      distance = [0.0_wp]
      d = 0
      do while (d < length)
        size_here = min(max(finest, growth*d), coarsest)
        ! A remainder of less than half a panel is added to the last panel.
        if (d + 1.5_wp*size_here >= length) size_here = length - d
        d = d + size_here
        if (d >= length*(1 - 4*epsilon(d))) d = length
        distance = [distance, d]
      end do
    end function one_side

  end function graded_ends

end module panels
