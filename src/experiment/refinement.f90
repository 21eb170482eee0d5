!> The guard over meshes under laws with lengths of their own: where the pressure of a state of the
!> path is not the polynomial of its panel, the path is traced again. Meshes are laid out for gaps
!> that were foreseen; by then those that bodies have are known, and only what is sharp in them gets
!> short panels. Gaps are smoother than pressures, so that those on a mesh that is too coarse tell
!> what a finer one needs.
module refinement
  use kinds, only: wp
  use listener, only: listener_t
  use force_law, only: force_law_t
  use shape, only: shape_t
  use known_path, only: known_path_t
  use contact_state, only: gap_at
  use mapped_mesh, only: mapped_shape_t, new_mapped_mesh
  use discretisation, only: discretisation_t
  use path_stepper, only: path_stepper_t
  use seen_gaps, only: seen_gaps_t
  implicit none
  private
  public :: trace_resolved, unresolved_from

  !> How often the path is traced again, and a panel halved for that.
  integer, parameter :: most_rounds = 6, most_halvings = 3
  !> With so many times the nodes no panel is halved any more, until the path says again which are
  !> too long: what a path that is lost leaves may ask for any number.
  real(wp), parameter :: most_growth = 1.5_wp
  !> The tail from which on a panel is too long, over the accuracy, where there are kinks: at a fold
  !> the load feels 7 % of it; and over the root of the accuracy where there are none:
  !> of smooth laws load and h0 feel a thousandth of its square to some times that. A tail that the
  !> iteration may leave of a stiff pressure; and one from which on coefficients do not fall yet.
  real(wp), parameter :: times_of_kinks = 30, times_of_root = 3, least = 1.0e-8_wp, &
    largest = 3.0e-2_wp

contains

  !> The tail of a pressure, over the largest, from which on a panel is too long. Errors of load and
  !> h0 go with its square, because the nodes integrate polynomials of twice the degree; about a
  !> kink, where coefficients fall slowly, with the tail itself.
  pure real(wp) function unresolved_from(law, shape, accuracy) result(tail)
    class(force_law_t), intent(in) :: law
    class(shape_t), intent(in) :: shape
    real(wp), intent(in) :: accuracy

    tail = min(times_of_root*sqrt(accuracy), largest)
    if (law%has_kink .or. shape%smooth_from() > 0) tail = times_of_kinks*accuracy
    tail = max(tail, least)
  end function unresolved_from

  !> Traces the path (`know_path`), again where panels were too long; panel_tail: the largest tail
  !> that is left, but of a fall onto each other, which ends on no mesh. The paper's laws need none
  !> of it: their meshes were fitted to their errors.
  subroutine trace_resolved(steps, h0_high, h0_low, into_contact, closely, accuracy, listener, &
    panel_tail)
    class(path_stepper_t), intent(inout) :: steps
    real(wp), intent(in) :: h0_high, h0_low, accuracy
    logical, intent(in) :: into_contact, closely
    class(listener_t), intent(inout) :: listener
    real(wp), intent(out) :: panel_tail
    logical :: fitted(size(steps%meshes%grid))
    type(known_path_t) :: nothing
    real(wp) :: most
    integer :: round

    panel_tail = 0
    call steps%know_path(h0_high, h0_low, into_contact, closely, listener)
    if (steps%problem%law%of_paper) return
    fitted = .false.
    most = unresolved_from(steps%problem%law, steps%problem%shape, accuracy)
    do round = 0, most_rounds
      panel_tail = largest_tail(steps)
      if (.not. panel_tail > most .or. round == most_rounds) exit
      call refine(steps, most, fitted)
      steps%known = nothing
      call steps%know_path(h0_high, h0_low, into_contact, closely, listener)
    end do
    if (steps%known%fallen) panel_tail = 0
  end subroutine trace_resolved

  !> Lays meshes out anew for the gaps that were seen on them; where that was done already, or the
  !> path was lost before it had seen all, panels with tails above `most` are halved. fitted: the
  !> meshes that have been laid out for what was seen.
  subroutine refine(steps, most, fitted)
    class(path_stepper_t), intent(inout), target :: steps
    real(wp), intent(in) :: most
    logical, intent(inout) :: fitted(:)
    type(mapped_shape_t) :: shape
    integer :: mesh
    logical :: seen

    do mesh = 1, size(fitted)
      associate (path => steps%known%path, meshes => steps%meshes, cost => steps%cost)
        seen = path%point(path%held)%mesh > mesh .or. .not. steps%known%ending%early()
        if (seen) seen = any(path%point(:path%held)%mesh == mesh)
        if (seen .and. .not. fitted(mesh)) then
          fitted(mesh) = .true.
          shape = meshes%shape_for(steps%problem, mesh, gaps_seen(steps, mesh))
        else if (any(tails_on(steps, mesh, meshes%grid(mesh)) > most)) then
          shape = with_short_panels(steps, mesh, most)
        else
          cycle
        end if
        call meshes%renew(mesh, shape)
        cost%kernel_entries = cost%kernel_entries + meshes%grid(mesh)%kernel_entries()
      end associate
    end do
  end subroutine refine

  !> The gaps of all states of the path on a mesh; and as they may be over the rest of the radii
  !> that it serves: another time the path may come to it elsewhere.
  function gaps_seen(steps, mesh) result(seen)
    class(path_stepper_t), intent(in), target :: steps
    integer, intent(in) :: mesh
    type(seen_gaps_t) :: seen
    integer :: i, k, states

    associate (grid => steps%meshes%grid(mesh), path => steps%known%path, &
      reach => steps%meshes%reach(:, mesh))
      states = count(path%point(:path%held)%mesh == mesh)
      call seen%begin_on(grid, states)
      k = 0
      do i = 1, path%held
        if (path%point(i)%mesh /= mesh) cycle
        k = k + 1
        associate (state => path%point(i)%state)
          call seen%add(steps%problem%shape, state%gap, state%scale)
          call seen%try(grid%centre*state%scale, state%scale)
          if (.not. grid%centre > 0) cycle
          if (k == 1) call seen%try_between(state%scale, reach(1), state%scale)
          if (k == states) call seen%try_between(state%scale, state%scale, reach(2))
        end associate
      end do
    end associate
  end function gaps_seen

  !> What a mesh is like, with panels halved, and halves of them, on which tails are above `most`.
  function with_short_panels(steps, mesh, most) result(shape)
    class(path_stepper_t), intent(in) :: steps
    integer, intent(in) :: mesh
    real(wp), intent(in) :: most
    type(mapped_shape_t) :: shape
    type(discretisation_t) :: grid
    integer :: halving

    shape = steps%meshes%shape(mesh)
    grid = steps%meshes%grid(mesh)
    do halving = 1, most_halvings
      associate (long => tails_on(steps, mesh, grid) > most)
        if (.not. any(long) .or. grid%nodes > most_growth*size(steps%meshes%grid(mesh)%x)) exit
        shape = shape%halved(long)
      end associate
      grid = new_mapped_mesh(shape, elastic=.false.)
    end do
  end function with_short_panels

  !> The largest tail of the pressure on the path.
  pure real(wp) function largest_tail(steps) result(largest)
    class(path_stepper_t), intent(in) :: steps
    integer :: mesh

    largest = 0
    do mesh = 1, size(steps%meshes%grid)
      largest = max(largest, maxval(tails_on(steps, mesh, steps%meshes%grid(mesh))))
    end do
  end function largest_tail

  !> The largest tails of the pressure over all states of a mesh, on its panels, or on those of a
  !> finer one by the gaps there.
  pure function tails_on(steps, mesh, grid) result(tails)
    class(path_stepper_t), intent(in) :: steps
    integer, intent(in) :: mesh
    type(discretisation_t), intent(in) :: grid
    real(wp) :: tails(size(grid%panel))
    integer :: i, j

    tails = 0
    associate (own => steps%meshes%grid(mesh), problem => steps%problem)
      do i = 1, steps%known%path%held
        associate (point => steps%known%path%point(i))
          if (point%mesh /= mesh) cycle
          if (grid%nodes == own%nodes) then
            tails = max(tails, grid%panel_tails(point%state%pressure))
          else
            tails = max(tails, grid%panel_tails(problem%law%pressure( &
              [(gap_at(problem%shape, own, point%state, grid%x(j)), j=1, grid%nodes)])))
          end if
        end associate
      end do
    end associate
  end function tails_on

end module refinement
