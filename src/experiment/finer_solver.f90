!> The solver on finer meshes, with errors well below the accuracy, for error estimates by
!> comparison. The error of the finer mesh itself is neglected; it is smaller by a factor that the
!> margin covers.
!>
!> On a finer mesh the path near a state is a parabola in the path's coordinate with exact slopes
!> (`path_tangent`) and the second derivatives of the traced path. The parabola gives the place at
!> which D = weights(1) h0 + weights(2) load turns or has a value. It is accurate also near folds,
!> where a small error of h0 changes the load much.
module finer_solver
  use kinds, only: wp
  use mesh_store, only: mesh_store_t
  use edge_locked, only: mesh_family_t, new_mesh_family
  use contact_state, only: state_t, far_gap, contact_radius_of
  use controls, only: control_t
  use solver, only: solver_t
  use numerics_choice, only: choice_t, fixed_mesh, companion
  use path_coordinate, only: path_control
  use path_tangent, only: tangent_t, tangent_along
  use potential_energy, only: energy_of
  use reported_place, only: read_of_states, of_h0, of_load, of_displacement, of_energy, of_radius, &
    of_edge
  implicit none
  private
  public :: finer_t, more_digits, rounding, worst_residual, what_residual_leaves, expansion_t

  !> Solves on finer meshes, whose kernels are made when they are needed. Differences are multiplied
  !> by `margin`. store: of meshes, if there is one.
  type, extends(solver_t) :: finer_t
    real(wp) :: margin = 1
    type(mesh_store_t), pointer :: store => null()
  contains
    procedure :: lay_out
    procedure :: lay_out_fixed
    procedure :: refine
    procedure :: prepare
    procedure :: find
    procedure, private :: take_over
  end type finer_t

  !> Additional digits of finer edge-locked meshes.
  real(wp), parameter :: more_digits = 1.5_wp
  !> Factors of the differences. They account for the error of the finer mesh, which is a tenth or
  !> less for panels and a third for a uniform grid, of second order and locally of lower order; and
  !> for other states, which may have larger errors than those compared. For a grid twice as coarse
  !> the difference itself is two to three times the error.
  real(wp), parameter :: usual = 3, of_fixed = 2.5_wp, of_coarser = 1.2_wp, of_less_gained = 6
  !> Rounding error of a whole calculation; no smaller error is reported.
  real(wp), parameter :: rounding = 1.0e-13_wp
  !> Largest residual of the iteration over the error of an extremum's place; and number of
  !> iterations before factors are renewed, small because they were made nearby.
  real(wp), parameter :: residual_over_place = 1.0e-3_wp
  integer, parameter :: patience = 4
  !> A residual that identifies the state with certainty (law's lengths).
  real(wp), parameter :: nearly_solved = 1.0e-6_wp
  !> A residual that differs from node to node may move a state this many times as far as a uniform
  !> one, which acts like a change of h0.
  real(wp), parameter :: worst_residual = 3

  !> The path near the coordinate s on a finer mesh, and the state there.
  type :: expansion_t
    real(wp) :: s = 0
    type(state_t) :: state
    !> h0, load and gap on the axis: values, slopes and second derivatives by the path's coordinate.
    real(wp), dimension(3) :: value = 0, slope = 0, curvature = 0
    !> Energy; contact radius and its slope.
    real(wp) :: energy = 0, radius = 0, widening = 0
  contains
    procedure :: move_to
    procedure :: distance_to
    procedure :: read_at
    procedure, private :: expand
  end type expansion_t

  !> Largest distance at which the expansion is accurate; largest move, and number of moves.
  real(wp), parameter :: believed = 1.0e-3_wp, farthest = 0.1_wp
  integer, parameter :: most_moves = 8
  !> Distance for the difference quotient of the contact radius.
  real(wp), parameter :: beside = 1.0e-5_wp

contains

  !> Lays out meshes finer than the edge-locked ones of `steps`, whose meshes are unchanged.
  subroutine lay_out(self, steps, chosen, store)
    class(finer_t), intent(inout) :: self
    class(solver_t), intent(in) :: steps
    type(choice_t), intent(in) :: chosen
    type(mesh_store_t), intent(inout), target, optional :: store
    integer :: k

    call self%take_over(steps)
    ! Without a contact edge, the mesh is not locked to the sharp features of a collapse, and short
    ! panels may contain a law or a body that is not smooth: there more nodes reduce the error less.
    self%margin = usual
    if (.not. steps%problem%law%edge_gap > 0 .or. any([(steps%meshes%has_short_panels(k), &
      k=1, size(steps%meshes%grid))])) self%margin = of_less_gained
    self%meshes = new_mesh_family(steps%problem, chosen%high, chosen%low, &
      steps%meshes%digits + more_digits, shape_only=.true., coarser=steps%meshes)
    if (present(store)) self%store => store
  end subroutine lay_out

  !> Lays out a mesh for one fixed in space: a finer one or, if this would be too expensive, a
  !> coarser one.
  subroutine lay_out_fixed(self, steps, chosen)
    class(finer_t), intent(inout) :: self
    class(solver_t), intent(in) :: steps
    type(choice_t), intent(in) :: chosen

    call self%take_over(steps)
    allocate (self%meshes%grid(1))
    self%meshes%grid(1) = fixed_mesh(companion(chosen), steps%problem)
    self%margin = merge(of_fixed, of_coarser, &
      self%meshes%grid(1)%nodes > steps%meshes%grid(1)%nodes)
    self%cost%kernel_entries = self%cost%kernel_entries + self%meshes%grid(1)%kernel_entries()
  end subroutine lay_out_fixed

  !> Replaces one mesh by a mesh finer than a renewed one of another family.
  subroutine refine(self, mesh, coarser)
    class(finer_t), intent(inout) :: self
    integer, intent(in) :: mesh
    type(mesh_family_t), intent(in) :: coarser

    call self%meshes%refine(self%problem, mesh, coarser)
    call self%operator%forget()
    call self%frozen%forget()
  end subroutine refine

  !> Copies the problem, the cost and the tolerances of `steps`.
  subroutine take_over(self, steps)
    class(finer_t), intent(inout) :: self
    class(solver_t), intent(in) :: steps

    self%problem = steps%problem
    self%cost = steps%cost
    associate (own => self%options, given => steps%options)
      own%slope_error = given%slope_error
      own%place_error = given%place_error
      own%tolerance = min(given%tolerance, residual_over_place*given%place_error)
      own%patience = patience
    end associate
  end subroutine take_over

  !> Makes the kernel of a mesh if it has none.
  subroutine prepare(self, mesh)
    class(finer_t), intent(inout) :: self
    integer, intent(in) :: mesh

    if (allocated(self%meshes%grid(mesh)%kernel)) return
    ! A pointer that is not associated counts as absent.
    call self%meshes%complete(mesh, self%store)
    self%cost%kernel_entries = self%cost%kernel_entries + self%meshes%grid(mesh)%kernel_entries()
  end subroutine prepare

  !> Solves with the accuracy that an error estimate needs. found: the state is identified.
  subroutine find(self, control, state, found)
    class(finer_t), intent(inout) :: self
    type(control_t), intent(in) :: control
    type(state_t), intent(inout) :: state
    logical, intent(out) :: found

    call self%solve(control, state, found)
    found = found .or. state%residual < nearly_solved
  end subroutine find

  !> The largest change of h0 to which the residual of a state is equivalent. The rounding of large
  !> gaps is not included, since it has no other effect.
  pure real(wp) function what_residual_leaves(state) result(left)
    type(state_t), intent(in) :: state

    left = rounding + worst_residual* &
      max(state%residual - 4*epsilon(1.0_wp)*min(maxval(state%gap), far_gap), 0.0_wp)
  end function what_residual_leaves

  !> Moves an expansion along the path until the place at which D turns, or is `wanted`, is near,
  !> and returns the distance to this place. At first the expansion has a coordinate, a guess of the
  !> state and the second derivatives. found = .false.: the finer mesh has no such place.
  subroutine move_to(near, fine, mesh, weights, turns, wanted, distance, found)
    class(expansion_t), intent(inout) :: near
    type(finer_t), intent(inout) :: fine
    integer, intent(in) :: mesh
    real(wp), intent(in) :: weights(2), wanted
    logical, intent(in) :: turns
    real(wp), intent(out) :: distance
    logical, intent(out) :: found
    integer :: move

    call fine%frozen%forget()
    do move = 1, most_moves
      call near%expand(fine, mesh, found)
      if (.not. found) return
      distance = near%distance_to(weights, turns, wanted)
      found = abs(distance) <= believed
      if (found) return
      near%s = near%s + sign(min(abs(distance), farthest), distance)
    end do
  end subroutine move_to

  !> Expands the path at near%s from the guess near%state; found = .false.: the finer mesh has no
  !> such state.
  subroutine expand(near, fine, mesh, found)
    class(expansion_t), intent(inout) :: near
    type(finer_t), intent(inout) :: fine
    integer, intent(in) :: mesh
    logical, intent(out) :: found
    type(tangent_t) :: tangent
    type(state_t) :: next
    real(wp) :: uncertainty

    call fine%find(path_control(fine%problem, fine%meshes, mesh, near%s), near%state, found)
    if (found) call tangent_along(fine%solver_t, mesh, near%s, near%state, tangent, found)
    if (.not. found) return
    near%value = [near%state%h0, near%state%load, near%state%axis_gap]
    near%slope = [tangent%h0, tangent%load, tangent%axis_gap]
    call energy_of(fine%equations_t, mesh, near%state, near%energy, uncertainty)
    associate (grid => fine%meshes%grid(mesh))
      near%radius = contact_radius_of(fine%problem, grid, near%state)
      near%widening = 0
      if (.not. near%radius > 0) return
      next = near%state
      next%gap = next%gap + beside*tangent%gap
      next%axis_gap = next%axis_gap + beside*tangent%axis_gap
      next%scale = next%scale + beside*tangent%scale
      near%widening = (contact_radius_of(fine%problem, grid, next) - near%radius)/beside
    end associate
  end subroutine expand

  !> Distance from the centre of an expansion to the place at which D turns or is `wanted`. If D has
  !> no such value, the distance to the turn.
  pure real(wp) function distance_to(near, weights, turns, wanted) result(distance)
    class(expansion_t), intent(in) :: near
    real(wp), intent(in) :: weights(2), wanted
    logical, intent(in) :: turns
    real(wp) :: missing, slope, curvature, root

    slope = dot_product(weights, near%slope(:2))
    curvature = dot_product(weights, near%curvature(:2))
    missing = dot_product(weights, near%value(:2)) - wanted
    root = slope**2 - 2*curvature*missing
    if (root > 0 .and. .not. turns) then
      distance = -2*missing/(slope + sign(sqrt(root), slope))
    else
      distance = huge(1.0_wp)
      if (abs(curvature) > tiny(1.0_wp)) distance = -slope/curvature
    end if
  end function distance_to

  !> The quantities at a distance from the centre. The energy's derivative by h0 is minus the load.
  pure function read_at(near, distance) result(read)
    class(expansion_t), intent(in) :: near
    real(wp), intent(in) :: distance
    real(wp) :: read(read_of_states)

    read = 0
    associate (value => near%value, slope => near%slope, curvature => near%curvature)
      read(:3) = value + distance*(slope + 0.5_wp*distance*curvature)
      read(of_displacement) = read(3) - read(of_h0)
      read(of_energy) = near%energy - distance*value(of_load)*slope(of_h0) - 0.5_wp*distance**2* &
        (slope(of_load)*slope(of_h0) + value(of_load)*curvature(of_h0))
      read(of_radius) = max(0.0_wp, near%radius + distance*near%widening)
      read(of_edge) = exp(near%s + distance)
    end associate
  end function read_at

end module finer_solver
