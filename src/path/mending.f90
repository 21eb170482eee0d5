!> The guard over meshes under laws and shapes with lengths of their own. Meshes are laid out for
!> gaps that are foreseen; those that bodies have are known once the path has come to the end of a
!> mesh. Where nodes leave out too much of the pressure there, the mesh is laid out anew for the
!> gaps that were seen, and the path goes on from where it came to that mesh. Gaps are smoother than
!> pressures, so that those on a mesh that is too coarse tell what a finer one needs.
module mending
  use kinds, only: wp
  use force_law, only: force_law_t
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t
  use panel_map, only: algebraic_map
  use mapped_mesh, only: mapped_shape_t, new_mapped_mesh
  use law_panels, only: left_out
  use mesh_rule, only: is_even
  use edge_locked, only: mesh_family_t
  use seen_gaps, only: seen_gaps_t
  use contact_state, only: state_t, gap_at, felt_load
  use equilibrium, only: equations_t
  use continuation, only: continuation_t
  use traced_path, only: traced_path_t
  implicit none
  private
  public :: mender_t, new_mender, left_on_path, too_much

  !> What may be left out, over the accuracy, where no mesh can be mended any more: at a fold the
  !> load feels 7 % of the tail at a kink, and of smooth pressures a thousandth of the square of
  !> that, to some times it.
  real(wp), parameter :: too_much = 30

  type :: mender_t
    !> Part of the load that may be left out.
    real(wp) :: most = 0
    !> The path and its walker before they came to the mesh in use; how often each mesh was mended.
    type(traced_path_t) :: path
    type(continuation_t) :: walker
    integer, allocatable :: rounds(:)
    !> What each left out, the last time.
    real(wp), allocatable :: left(:)
  contains
    procedure :: note
    procedure :: mend
  end type mender_t

  !> What is left out about kinks of the law counts so many times: extrema feel it most.
  real(wp), parameter :: of_kinks = 3
  !> What the panels of a new mesh may leave out, over what is left out at most: the path goes a
  !> little elsewhere on it.
  real(wp), parameter :: most_of_fit = 0.3_wp
  !> How often a mesh is mended, and a panel halved at once.
  integer, parameter :: most_rounds = 6, most_halvings = 3
  !> With so many times the nodes no panel is halved any more until the path has come again: what a
  !> path that is lost leaves may ask for any number.
  real(wp), parameter :: most_growth = 1.5_wp
  !> A mesh on which the path is lost is not mended again where no more than this was gained.
  real(wp), parameter :: helped = 0.9_wp

contains

  !> For a path that is to be traced on such meshes. Kinks and waves count in full, see `left_out`:
  !> what is left out of them is felt but in part.
  pure type(mender_t) function new_mender(accuracy, law, meshes) result(mender)
    real(wp), intent(in) :: accuracy
    class(force_law_t), intent(in) :: law
    type(mesh_family_t), intent(in) :: meshes

    mender%most = accuracy*merge(too_much, 1.0_wp, law%has_kink .or. law%period > 0)
    allocate (mender%rounds(size(meshes%grid)), source=0)
    allocate (mender%left(size(meshes%grid)), source=huge(1.0_wp))
  end function new_mender

  !> Keeps the path before it comes to another mesh.
  subroutine note(self, path, walker)
    class(mender_t), intent(inout) :: self
    type(traced_path_t), intent(in) :: path
    type(continuation_t), intent(in) :: walker

    self%path = path
    self%walker = walker
  end subroutine note

  !> Makes a mesh that the path has come to the end of, or is lost on, anew where it leaves too much
  !> out; mended: the path is to go on from what was noted.
  subroutine mend(self, equations, path, mesh, lost, mended)
    class(mender_t), intent(inout) :: self
    type(equations_t), intent(inout) :: equations
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: mesh
    logical, intent(in) :: lost
    logical, intent(out) :: mended
    type(mapped_shape_t) :: shape
    real(wp) :: left

    left = maxval(left_on_mesh(equations, path, mesh, equations%meshes%grid(mesh)))
    mended = self%rounds(mesh) < most_rounds .and. left > self%most
    if (lost) mended = mended .and. left < helped*self%left(mesh)
    self%left(mesh) = left
    if (.not. mended) return
    if (.not. (self%rounds(mesh) > 0 .or. lost) .and. equations%problem%law%edge_gap > 0) then
      shape = shape_for_seen(equations, path, mesh, self%most)
    else
      shape = with_short_panels(equations, path, mesh, self%most)
    end if
    self%rounds(mesh) = self%rounds(mesh) + 1
    call equations%meshes%renew(mesh, shape)
    call equations%operator%forget()
    equations%cost%kernel_entries = equations%cost%kernel_entries + &
      equations%meshes%grid(mesh)%kernel_entries()
  end subroutine mend

  !> The largest part of the load that nodes leave out anywhere on a path.
  real(wp) function left_on_path(equations, path) result(largest)
    type(equations_t), intent(in) :: equations
    type(traced_path_t), intent(in) :: path
    integer :: mesh

    largest = 0
    do mesh = 1, size(equations%meshes%grid)
      largest = max(largest, maxval(left_on_mesh(equations, path, mesh, &
        equations%meshes%grid(mesh))))
    end do
  end function left_on_path

  !> What a mesh is to be like for the gaps of all states of the path on it; and for those that may
  !> be over the rest of the radii that it serves: another time the path may come to it elsewhere.
  function shape_for_seen(equations, path, mesh, most) result(shape)
    type(equations_t), intent(in), target :: equations
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: mesh
    real(wp), intent(in) :: most
    type(mapped_shape_t) :: shape
    type(seen_gaps_t) :: seen
    integer :: i, k, states

    associate (problem => equations%problem, meshes => equations%meshes, &
      grid => equations%meshes%grid(mesh), reach => equations%meshes%reach(:, mesh))
      states = count(path%point(:path%held)%mesh == mesh)
      call seen%begin_on(grid, states, most_of_fit*most)
      k = 0
      do i = 1, path%held
        if (path%point(i)%mesh /= mesh) cycle
        k = k + 1
        associate (state => path%point(i)%state)
          call seen%add(problem%shape, state%gap, state%scale, felt_load(problem, grid, state))
          call seen%try(grid%centre*state%scale, state%scale)
          if (.not. grid%centre > 0) cycle
          if (k == 1) call seen%try_between(state%scale, reach(1), state%scale)
          if (k == states) call seen%try_between(state%scale, state%scale, reach(2))
        end associate
      end do
      shape = meshes%shape_for(problem, mesh, seen)
    end associate
  end function shape_for_seen

  !> What a mesh is like, with panels halved, and halves of them, that leave out too much.
  function with_short_panels(equations, path, mesh, most) result(shape)
    type(equations_t), intent(in) :: equations
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: mesh
    real(wp), intent(in) :: most
    type(mapped_shape_t) :: shape
    type(discretisation_t) :: grid
    integer :: halving

    shape = equations%meshes%shape(mesh)
    grid = equations%meshes%grid(mesh)
    do halving = 1, most_halvings
      associate (long => left_on_mesh(equations, path, mesh, grid) > most)
        if (.not. any(long) .or. &
          grid%nodes > most_growth*size(equations%meshes%grid(mesh)%x)) exit
        shape = shape%halved(long)
      end associate
      grid = new_mapped_mesh(shape, elastic=.false.)
    end do
  end function with_short_panels

  !> The largest part of the load that is left out over all states of a mesh, on its panels, or on
  !> those of a finer one by the gaps there.
  pure function left_on_mesh(equations, path, mesh, grid) result(left)
    type(equations_t), intent(in) :: equations
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: mesh
    type(discretisation_t), intent(in) :: grid
    real(wp) :: left(size(grid%panel)), gap(grid%nodes)
    integer :: i, j

    left = 0
    associate (own => equations%meshes%grid(mesh), problem => equations%problem)
      do i = 1, path%held
        associate (point => path%point(i))
          if (point%mesh /= mesh) cycle
          if (grid%nodes == own%nodes) then
            gap = point%state%gap
          else
            gap = [(gap_at(problem%shape, own, point%state, grid%x(j)), j=1, grid%nodes)]
          end if
          left = max(left, left_of(problem, grid, gap, point%state%scale, &
            felt_load(problem, own, point%state)))
        end associate
      end do
    end associate
  end function left_on_mesh

  !> The part of the load that nodes leave out of the pressure of gaps on each panel.
  pure function left_of(problem, grid, gap, scale, load) result(left)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: gap(:), scale, load
    real(wp) :: left(size(grid%panel)), pressure(size(gap))
    logical :: smooth
    integer :: k

    smooth = is_even(problem%shape) .and. .not. problem%shape%smooth_from() > 0
    pressure = problem%law%pressure(gap)
    left = 0
    do k = 1, size(grid%panel)
      associate (panel => grid%panel(k), first => grid%first(k), &
        last => grid%first(k) + size(grid%local(k)%node) - 1)
        if (panel%kind == algebraic_map) cycle
        ! What is in a contact of a shape with kinks, `mesh_rule` knows by itself.
        if (panel%right <= 0 .and. .not. smooth) cycle
        left(k) = left_out(problem, grid%local(k), &
          scale*grid%centre, scale*(grid%centre + [panel%left, panel%right]), &
          scale*merge(grid%centre, grid%x(first:last), problem%law%has_kink), &
          pressure(first:last), load)
      end associate
    end do
    if (problem%law%has_kink) left = of_kinks*left
  end function left_of

end module mending
