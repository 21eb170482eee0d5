!> The edges of the contact along a path, for contact radii as functions of the position of a drive.
module contact_edges
  use kinds, only: wp
  use dimensionless_problem, only: problem_t, contact_level_of
  use contact_state, only: radius_of_gap
  use discretisation, only: discretisation_t
  use mesh_family, only: mesh_family_t
  use variation, only: variation_t
  use path_point, only: no_mesh
  use traced_path, only: traced_path_t
  use path_sensitivity, only: rate_t
  use fit_request, only: change
  implicit none
  private
  public :: edge_t, find_edges, set_rates

  !> The edge of the contact at a point of the path, where the gap is that of `contact_level_of`.
  !> square: the squared contact radius and its derivative by the path's coordinate. by_level: its
  !> derivative by that gap [m] at a fixed state. rate: its derivatives by the unknowns at a fixed
  !> coordinate. place: the contact radius over the scale of the mesh.
  type :: edge_t
    real(wp) :: square(2) = 0, by_level = 0, place = 0
    real(wp), allocatable :: rate(:)
  end type edge_t

contains

  !> The edges of the contact at the points of a path.
  subroutine find_edges(problem, meshes, path, edge)
    type(problem_t), intent(in) :: problem
    type(mesh_family_t), intent(in) :: meshes
    type(traced_path_t), intent(in) :: path
    type(edge_t), allocatable, intent(out) :: edge(:)
    integer :: i

    allocate (edge(path%last))
    do i = 1, size(edge)
      associate (point => path%point(i))
        if (point%mesh /= no_mesh) call set_edge(meshes%grid(point%mesh), edge(i))
      end associate
    end do

  contains

    subroutine set_edge(grid, edge)
      type(discretisation_t), intent(in) :: grid
      type(edge_t), intent(inout) :: edge
      real(wp) :: level, radius, by_level

      associate (point => path%point(i))
        level = contact_level_of(problem)
        radius = radius_of_gap(problem%shape, level, grid, point%state)
        if (.not. radius > 0) return
        by_level = (radius_of_gap(problem%shape, level*(1 + change), grid, point%state)**2 - &
          radius_of_gap(problem%shape, level*(1 - change), grid, point%state)**2)/(2*change*level)
        edge%place = radius/point%state%scale
        edge%by_level = problem%lateral**2*by_level/problem%length
        edge%square = problem%lateral**2*[radius**2, 2*radius**2*point%tangent%scale/ &
          point%state%scale - by_level*grid%interpolate(point%tangent%gap, edge%place)]
      end associate
    end subroutine set_edge

  end subroutine find_edges

  !> Sets the derivatives of the edges. varied: the problems with other values of each unknown.
  !> rate(unknown, point): the derivatives of the states.
  subroutine set_rates(edge, varied, rate)
    type(edge_t), intent(inout) :: edge(:)
    type(variation_t), intent(in) :: varied(:)
    type(rate_t), intent(in) :: rate(:, :)
    real(wp) :: level(size(varied))
    integer :: i, k

    do i = 1, size(varied)
      level(i) = 0
      do k = 1, size(varied(i)%weight)
        associate (problem => varied(i)%problem(k))
          level(i) = level(i) + varied(i)%weight(k)* &
            problem%law%separation_of(contact_level_of(problem))
        end associate
      end do
    end do
    do k = 1, size(edge)
      edge(k)%rate = edge(k)%by_level*(level - rate(:, k)%separation)
    end do
  end subroutine set_rates

end module contact_edges
