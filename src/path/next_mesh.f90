!> Construction of the next mesh of a path from its latest states: the radius of a state on it, and
!> its layout for the gaps of these states.
module next_mesh
  use kinds, only: wp
  use contact_scales, only: smallest_feature
  use contact_state, only: state_t, radius_of_gap, radius_of_step, felt_load
  use equilibrium, only: equations_t
  use edge_locked, only: shape_for
  use mapped_shape, only: mapped_shape_t
  use computed_gaps, only: computed_gaps_t
  use arc, only: arc_t
  implicit none
  private
  public :: radius_for, locked_alike, lay_out_next, beyond_passage

  !> The largest radius that the path may reach on a mesh, over the largest of its band.
  real(wp), parameter :: beyond_passage = 1.1_wp
  !> Before contact, a mesh about the axis is laid out for states that are extrapolated by these
  !> multiples of the last step.
  integer, parameter :: ahead(*) = [0, 1, 2, 3, 4, 6, 8]
  !> Largest distance by which the edge may move in contact on a mesh about the axis, over the
  !> smallest feature of the pressure.
  real(wp), parameter :: widths_ahead = 2
  !> Largest number of digits of a layout for computed gaps: these gaps have kinks where the
  !> polynomials of neighbouring panels meet, and no panel of another mesh resolves a kink.
  real(wp), parameter :: most_digits_seen = 10
  !> A band is divided if half of it needs less than the fraction `fewer` of its nodes, or if it
  !> needs more than `many_more` times the nodes of the previous mesh. It is not divided if the
  !> ratio of the radii of a half would be below `narrowest`.
  real(wp), parameter :: fewer = 0.8_wp, many_more = 1.5_wp, narrowest = 1.02_wp

contains

  !> Lays out the mesh that follows the mesh of an arc, for the gaps of the arc's newest state. An
  !> inserted mesh is laid out for the state before the newest one, since the old nodes may miss too
  !> much of the newest one. If an inserted mesh is about the axis, it is also for states
  !> extrapolated from this state. A band of edge radii is halved as long as it needs many more
  !> nodes than the previous mesh, for example around a small contact far inside a sharp rim. Under
  !> a law that does not oscillate it is also halved if half of it needs clearly fewer nodes. (Under
  !> an oscillating law new rings appear as the contact grows, and many narrow bands predict them
  !> less well.)
  subroutine lay_out_next(equations, arc)
    type(equations_t), intent(inout), target :: equations
    type(arc_t), intent(in) :: arc
    type(mapped_shape_t) :: shape, narrower
    real(wp) :: low, high
    logical :: crowded
    integer :: to, i

    to = arc%mesh + 1
    i = arc%held
    if (equations%meshes%inserted(to) .and. i > 2) i = i - 1
    associate (meshes => equations%meshes)
      ! The last two states of the arc pass to the mesh; they may lie beyond its band.
      if (.not. meshes%is_about_axis(to)) then
        low = radius_for(equations, arc%mesh, to, arc%point(arc%held - 1)%state)
        high = radius_for(equations, arc%mesh, to, arc%point(arc%held)%state)
        if (low > 0) meshes%reach(1, to) = min(meshes%reach(1, to), low)
        meshes%reach(2, to) = max(meshes%reach(2, to), high)
      end if
      shape = shape_for_next(equations, arc, i)
      do while (meshes%grows .and. .not. meshes%is_about_axis(to))
        low = max(meshes%reach(1, to), radius_for(equations, arc%mesh, to, arc%point(i)%state))
        high = meshes%reach(2, to)
        if (high < narrowest**2*low) exit
        crowded = shape%node_count() > many_more*meshes%grid(arc%mesh)%nodes
        if (equations%problem%law%period > 0 .and. .not. crowded) exit
        meshes%reach(2, to) = sqrt(low*high)
        narrower = shape_for_next(equations, arc, i)
        meshes%reach(2, to) = high
        if (narrower%node_count() > fewer*shape%node_count() .and. .not. crowded) exit
        call meshes%divide(to, sqrt(low*high))
        shape = narrower
      end do
      call meshes%renew(to, shape)
      equations%cost%kernel_entries = equations%cost%kernel_entries + &
        meshes%grid(to)%kernel_entries()
    end associate
  end subroutine lay_out_next

  !> The shape of the mesh that follows the mesh of an arc. It is for state number i of the arc and,
  !> about the axis, for later states too.
  type(mapped_shape_t) function shape_for_next(equations, arc, i) result(shape)
    type(equations_t), intent(in), target :: equations
    type(arc_t), intent(in) :: arc
    integer, intent(in) :: i
    type(computed_gaps_t) :: seen
    real(wp), allocatable :: gap(:), change(:)
    real(wp) :: load, radius, high
    integer :: to, k

    to = arc%mesh + 1
    associate (problem => equations%problem, meshes => equations%meshes, &
      grid => equations%meshes%grid(arc%mesh), state => arc%point(i)%state, &
      before => arc%point(i - 1)%state)
      call seen%begin_on(grid, size(ahead), 10.0_wp**(-min(meshes%digits, most_digits_seen)))
      load = felt_load(problem, grid, state)
      radius = radius_of_gap(problem%shape, problem%law%edge_gap, grid, state)
      if (meshes%is_about_axis(to) .and. radius > 0) then
        call seen%add(problem%shape, state%gap, state%scale, state%h0, load)
        high = min(radius + widths_ahead*smallest_feature(problem, radius), &
          beyond_passage*meshes%next_passage(to))
        call seen%try_about_axis(radius, max(radius, high))
      else if (meshes%is_about_axis(to)) then
        change = equations%raised(arc%mesh, state) - equations%raised(arc%mesh, before)
        do k = 1, size(ahead)
          gap = state%gap + ahead(k)*change
          if (minval(gap) < problem%law%rest_gap .and. k > 1) exit
          call seen%add(problem%shape, gap, state%scale, state%h0, load)
          call seen%try_about_axis(0.0_wp, 0.0_wp)
        end do
      else
        call seen%add(problem%shape, state%gap, state%scale, state%h0, load)
        call seen%try(radius_for(equations, arc%mesh, to, state), meshes%reach(1, to), &
          beyond_passage*meshes%reach(2, to), radius_of_step(problem, grid, state))
        if (i == arc%held) then
          call seen%add(problem%shape, before%gap, before%scale, before%h0, &
            felt_load(problem, grid, before))
          radius = radius_for(equations, arc%mesh, to, before)
          call seen%try(radius, radius, radius, 0.0_wp)
        end if
      end if
      shape = shape_for(meshes, problem, to, seen)
    end associate
  end function shape_for_next

  !> Radius, in lateral units, to which mesh `to` would be locked for a state on mesh `from`; 0 if
  !> the state has no such radius.
  pure real(wp) function radius_for(equations, from, to, state) result(c)
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: from, to
    type(state_t), intent(in) :: state

    c = 1
    if (equations%meshes%is_about_axis(to)) return
    c = state%scale
    if (locked_alike(equations, from, to)) return
    associate (problem => equations%problem, meshes => equations%meshes)
      c = radius_of_gap(problem%shape, meshes%locked_gap(to), meshes%grid(from), state)
    end associate
  end function radius_for

  !> Whether two meshes are locked to the same radius.
  pure logical function locked_alike(equations, from, to)
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: from, to

    locked_alike = .not. equations%meshes%is_about_axis(from)
    if (locked_alike) locked_alike = abs(equations%meshes%locked_gap(from) - &
      equations%meshes%locked_gap(to)) <= 0
  end function locked_alike

end module next_mesh
