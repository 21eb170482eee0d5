!> Meshes mapped to the contact edge or the axis: distance = d sinh(z) from it, Gauss-Legendre panels
!> in z, and from some position on an algebraic panel to infinity on which pressures are a power
!> tail. Where 0.3 necks are d, some fifty nodes give six digits at any adhesion strength.
module mapped_mesh
  use kinds, only: wp
  use discretisation, only: discretisation_t, axis_row, centre_row, first_node
  use panel_map, only: panel_map_t, sinh_panel, algebraic_panel
  use graded_rule, only: graded_rule_t, new_graded_rule
  use mapped_kernel, only: add_panel
  implicit none
  private
  public :: rule_table_t, new_mapped_mesh

  !> The rules that meshes have used so far: panels of the same order and length in z share one.
  type :: rule_table_t
    integer :: held = 0
    type(graded_rule_t), allocatable :: rule(:)
  contains
    procedure :: place_of
  end type rule_table_t

contains

  !> The mesh about `centre` (0: the axis, 1: the contact edge) with sinh panels of the given orders
  !> and lengths in z, the first `inner` of them inside the centre; these reach the axis if
  !> inner > 0. tail_order > 0: nodes of the panel beyond, where pressures fall as
  !> position**(-decay). digits: of the kernel matrix.
  subroutine new_mapped_mesh(centre, d, inner, order, z_length, tail_order, decay, digits, elastic, &
    rules, grid)
    real(wp), intent(in) :: centre, d, z_length(:), decay, digits
    integer, intent(in) :: inner, order(:), tail_order
    logical, intent(in) :: elastic
    type(rule_table_t), intent(inout) :: rules
    type(discretisation_t), intent(out) :: grid
    real(wp) :: z, target(first_node - 1 + sum(order) + tail_order)
    real(wp), allocatable :: offset(:)
    integer :: panels, k, first, last

    panels = size(order)
    grid%centre = centre
    grid%nodes = sum(order) + tail_order
    allocate (grid%panel(panels + merge(1, 0, tail_order > 0)))
    z = -sum(z_length(:inner))
    do k = 1, panels
      grid%panel(k) = sinh_panel(d, z, z_length(k))
      z = z + z_length(k)
    end do
    grid%panel(1)%left = -centre
    do k = 2, panels
      ! Where panels meet they must do so to the last digit.
      if (k == inner + 1) grid%panel(k)%left = 0
      if (k == inner + 1) grid%panel(k)%z_left = 0
      grid%panel(k - 1)%right = grid%panel(k)%left
    end do
    associate (outermost => grid%panel(panels)%right)
      grid%end = centre + outermost
      if (tail_order > 0) then
        grid%panel(panels + 1) = algebraic_panel(centre + outermost, outermost, decay)
        grid%end = huge(1.0_wp)
      end if
    end associate

    allocate (grid%first(size(grid%panel)), grid%which(size(grid%panel)))
    allocate (grid%weight(grid%nodes), offset(grid%nodes))
    grid%spacing = huge(1.0_wp)
    first = 1
    do k = 1, size(grid%panel)
      if (k <= panels) then
        grid%which(k) = rules%place_of(order(k), z_length(k), digits)
      else
        grid%which(k) = rules%place_of(tail_order, 0.0_wp, digits)
      end if
      associate (panel => grid%panel(k), rule => rules%rule(grid%which(k)))
        last = first + rule%order - 1
        grid%first(k) = first
        offset(first:last) = panel%offset(rule%node)
        grid%weight(first:last) = rule%weight*panel%speed(rule%node)*(centre + offset(first:last))
        if (k <= panels) grid%spacing = min(grid%spacing, &
          minval(panel%speed([0.0_wp, 0.5_wp, 1.0_wp]))/rule%order)
        first = last + 1
      end associate
    end do
    grid%x = centre + offset
    call take_local_nodes(rules, grid)
    if (.not. elastic) return

    target(axis_row) = -centre
    target(centre_row) = 0
    target(first_node:) = offset
    allocate (grid%kernel(size(target), grid%nodes))
    do k = 1, size(grid%panel)
      associate (rule => rules%rule(grid%which(k)))
        first = grid%first(k)
        last = first + rule%order - 1
        call add_panel(grid%panel(k), rule, centre, target, first_node - 1 + first, &
          grid%kernel(:, first:last))
      end associate
    end do
  end subroutine new_mapped_mesh

  !> What interpolation on the mesh needs of its rules.
  subroutine take_local_nodes(rules, grid)
    type(rule_table_t), intent(in) :: rules
    type(discretisation_t), intent(inout) :: grid
    integer :: k

    allocate (grid%local(rules%held))
    do k = 1, rules%held
      grid%local(k)%node = rules%rule(k)%node
      grid%local(k)%barycentric = rules%rule(k)%barycentric
    end do
  end subroutine take_local_nodes

  !> Place of the rule for panels of `order` nodes and the length in z, added if it is new.
  integer function place_of(self, order, z_length, digits) result(place)
    class(rule_table_t), intent(inout) :: self
    integer, intent(in) :: order
    real(wp), intent(in) :: z_length, digits
    type(graded_rule_t), allocatable :: more(:)

    do place = 1, self%held
      associate (rule => self%rule(place))
        if (rule%order == order .and. abs(rule%z_length - z_length) <= 0) return
      end associate
    end do
    if (.not. allocated(self%rule)) allocate (self%rule(4))
    if (self%held == size(self%rule)) then
      allocate (more(2*self%held))
      more(:self%held) = self%rule
      call move_alloc(more, self%rule)
    end if
    self%held = place
    self%rule(place) = new_graded_rule(order, points_for(order, z_length, digits), z_length)
  end function place_of

  !> Points that integrate a logarithm times polynomials of that many nodes to the digits. The
  !> kernel is singular not only at t = r but at t = -r too, which comes as near to the end of a
  !> panel at the axis as ln(2) in z: that end is where the substitution has the fewest points.
  pure integer function points_for(order, z_length, digits) result(points)
    integer, intent(in) :: order
    real(wp), intent(in) :: z_length, digits
    real(wp) :: ellipse

    ! Of the Bernstein ellipse through that singularity, in the variable of the Gauss points.
    ellipse = 1 + sqrt(log(2.0_wp)/max(z_length, 1.0_wp))
    points = order + ceiling(digits*log(10.0_wp)/(2*log(ellipse)))
  end function points_for

end module mapped_mesh
