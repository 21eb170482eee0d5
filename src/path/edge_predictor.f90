!> Predictor in coordinates attached to the contact edge: at a constant distance from the edge, gaps
!> are smooth functions of the path's coordinate while the edge passes many nodes.
module edge_predictor
  use kinds, only: wp
  use shape, only: shape_t
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t
  use contact_scales, only: cohesive_width
  use contact_state, only: radius_of_gap
  use path_point, only: path_point_t
  implicit none
  private
  public :: moved_outside, move_with_edge

  !> Step of a difference quotient, as a fraction of the distance from the edge or of its radius.
  real(wp), parameter :: part = 1.0e-5_wp

contains

  !> The gaps at a given scale outside the edge to which a mesh is locked. At constant distance from
  !> the edge they are polynomials of the coordinate through the points `nodes`; of_value and
  !> of_slope are the weights of the values and slopes at these points. Rings of an oscillating
  !> pressure, and the step of a pressure, keep their distance from the edge approximately, while
  !> they pass many nodes.
  pure function moved_outside(shape, grid, points, nodes, of_value, of_slope, scale) result(gap)
    class(shape_t), intent(in) :: shape
    type(discretisation_t), intent(in) :: grid
    type(path_point_t), intent(in) :: points(:)
    integer, intent(in) :: nodes(:)
    real(wp), intent(in) :: of_value(:), of_slope(:), scale
    integer :: j, from
    real(wp), allocatable :: away(:), raised(:), value(:), change(:), gap(:)

    from = count(grid%x <= grid%centre) + 1
    gap = shape%height(scale*grid%x(from:))
    do j = 1, size(nodes)
      associate (state => points(nodes(j))%state, tangent => points(nodes(j))%tangent)
        raised = state%gap - shape%height(state%scale*grid%x)
        value = of_value(j)*raised + of_slope(j)*(tangent%gap - &
          tangent%scale*grid%x*shape%slope(state%scale*grid%x))
        away = (grid%x(from:) - grid%centre)*scale/state%scale
        if (grid%is_bounded()) away = min(away, grid%x(grid%nodes) - grid%centre)
        ! With the distance constant, a position on the mesh moves as the scale grows.
        change = -of_slope(j)*tangent%scale/(state%scale*part)*raised
        gap = gap + mean_beside(grid, value, change, grid%centre + away, part*away)
      end associate
    end do
  end function moved_outside

  !> Replaces the gaps near the edge on a mesh about the axis. At constant distance from the edge
  !> the new gaps are polynomials of the coordinate through the points `nodes`; of_value and
  !> of_slope are the weights of the values and slopes at these points. Inside the edge the gaps
  !> move with it; outside, the gaps less the heights of the shape do. Far from the edge gaps change
  !> at a fixed radius.
  pure subroutine move_with_edge(problem, grid, points, nodes, of_value, of_slope, gap)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(path_point_t), intent(in) :: points(:)
    integer, intent(in) :: nodes(:)
    real(wp), intent(in) :: of_value(:), of_slope(:)
    real(wp), intent(inout) :: gap(:)
    !> Largest distance of gaps that move, in widths of the cohesive zone.
    real(wp), parameter :: widths = 1.5_wp
    real(wp) :: radius(size(nodes)), rate(size(nodes)), c, beside
    real(wp), allocatable :: height(:)
    integer :: j, first, edge, last

    c = 0
    do j = 1, size(nodes)
      associate (state => points(nodes(j))%state, tangent => points(nodes(j))%tangent)
        radius(j) = radius_of_gap(problem%shape, problem%law%edge_gap, grid, state)
        if (.not. radius(j) > 0) return
        rate(j) = -tangent_at_edge(grid, state%gap, tangent%gap, radius(j))
        c = c + of_value(j)*radius(j) + of_slope(j)*rate(j)
      end associate
    end do
    beside = widths*cohesive_width(problem)
    first = count(grid%x < c - beside) + 1
    edge = count(grid%x < c)
    last = count(grid%x < c + beside)
    height = problem%shape%height(grid%x)
    gap(first:edge) = 0
    gap(edge + 1:last) = height(edge + 1:last)
    do j = 1, size(nodes)
      associate (state => points(nodes(j))%state, tangent => points(nodes(j))%tangent)
        call move(state%gap, tangent%gap, gap(first:edge), grid%x(first:edge))
        call move(state%gap - height, tangent%gap, gap(edge + 1:last), grid%x(edge + 1:last))
      end associate
    end do

  contains

    !> Adds the term of state j to an interpolated quantity at some positions. In this state the
    !> quantity has the given values and derivatives by the coordinate at the nodes.
    pure subroutine move(value, slope, sum, x)
      real(wp), intent(in) :: value(:), slope(:), x(:)
      real(wp), intent(inout) :: sum(:)
      real(wp) :: at(size(x)), step(size(x))

      step = part*radius(j)
      at = abs(x - c + radius(j))
      if (grid%is_bounded()) at = min(at, grid%x(grid%nodes))
      sum = sum + mean_beside(grid, of_value(j)*value + of_slope(j)*slope, &
        of_slope(j)*rate(j)/(part*radius(j))*value, at, step)
    end subroutine move

  end subroutine move_with_edge

  !> The derivative of the gap at the edge by the coordinate, over its derivative by the radius.
  pure real(wp) function tangent_at_edge(grid, gap, tangent, radius) result(ratio)
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: gap(:), tangent(:), radius

    associate (step => part*radius)
      ratio = 2*step*grid%interpolate(tangent, radius)/(grid%interpolate(gap, radius + step) - &
        grid%interpolate(gap, radius - step))
    end associate
  end function tangent_at_edge

  !> The interpolated `value` at the positions `at`, plus `step` times the derivative of `change` by
  !> the position. Both follow from interpolated values at the positions at - step and at + step.
  pure function mean_beside(grid, value, change, at, step) result(mean)
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: value(:), change(:), at(:), step(:)
    real(wp) :: mean(size(at))

    mean = 0.5_wp*(grid%interpolate_all(value - change, abs(at - step)) + &
      grid%interpolate_all(value + change, at + step))
  end function mean_beside

end module edge_predictor
