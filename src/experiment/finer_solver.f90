!> The solver on finer meshes, with errors well below the accuracy, for error estimates by
!> comparison. The error of the finer mesh itself is neglected; it is smaller by a factor that the
!> margin covers.
module finer_solver
  use kinds, only: wp
  use mesh_store, only: mesh_store_t
  use edge_locked, only: mesh_family_t, new_mesh_family
  use contact_state, only: state_t, far_gap
  use equilibrium, only: control_t
  use solver, only: solver_t
  use numerics_choice, only: choice_t, fixed_mesh, companion
  implicit none
  private
  public :: finer_t, more_digits, rounding, worst_residual, what_residual_leaves

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

contains

  !> Lays out meshes finer than the edge-locked ones of `steps`, for H0 from high to low. The meshes
  !> of `steps` are unchanged.
  subroutine lay_out(self, steps, high, low, store)
    class(finer_t), intent(inout) :: self
    class(solver_t), intent(in) :: steps
    real(wp), intent(in) :: high, low
    type(mesh_store_t), intent(inout), target, optional :: store
    integer :: k

    call self%take_over(steps)
    ! Without a contact edge, the mesh is not locked to the sharp features of a collapse, and short
    ! panels may contain a law or a body that is not smooth: there more nodes reduce the error less.
    self%margin = usual
    if (.not. steps%problem%law%edge_gap > 0 .or. any([(steps%meshes%has_short_panels(k), &
      k=1, size(steps%meshes%grid))])) self%margin = of_less_gained
    self%meshes = new_mesh_family(steps%problem, high, low, &
      steps%meshes%digits + more_digits, shape_only=.true., coarser=steps%meshes)
    if (present(store)) self%store => store
  end subroutine lay_out

  !> Lays out a mesh for one fixed in space, for H0 down to low: a finer one or, if this would be
  !> too expensive, a coarser one.
  subroutine lay_out_fixed(self, steps, chosen, low)
    class(finer_t), intent(inout) :: self
    class(solver_t), intent(in) :: steps
    type(choice_t), intent(in) :: chosen
    real(wp), intent(in) :: low

    call self%take_over(steps)
    allocate (self%meshes%grid(1))
    self%meshes%grid(1) = fixed_mesh(companion(chosen), steps%problem, low)
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
    self%cost%kernel_entries = self%cost%kernel_entries + &
      self%meshes%grid(mesh)%kernel_entries()
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

end module finer_solver
