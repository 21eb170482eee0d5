!> The error of what is reported: the state that it comes from is solved again on a finer mesh, well
!> below the accuracy, and compared. What is left out is the error of the finer mesh, smaller by a
!> factor that the margin covers. What the iteration has left of the state itself is in the
!> difference; what it has left on the finer mesh is added: a residual acts like an h0 that is off
!> by as much.
!>
!> Here for states at a given h0, of which there is one; `path_errors` for those of a path with
!> folds.
module error_estimate
  use kinds, only: wp
  use mesh_store, only: mesh_store_t
  use regridding, only: regrid
  use contact_state, only: state_t, gap_at, far_gap
  use equilibrium, only: control_t, equations_t
  use solver, only: solver_t
  use reported, only: reported_t, error_t
  implicit none
  private
  public :: finer_t, judge_at_h0, unknown_error, profile_error, rounding, worst_residual, &
    what_is_left

  !> Solves on finer meshes, which get their kernels when they are needed. Differences count
  !> `margin` times. store: of meshes, if there is one.
  type, extends(solver_t) :: finer_t
    real(wp) :: margin = 1
    type(mesh_store_t), pointer :: store => null()
  contains
    procedure :: take_over
    procedure :: prepare
    procedure :: find
  end type finer_t

  !> Rounding of a whole calculation, below which no error is claimed.
  real(wp), parameter :: rounding = 1.0e-13_wp
  !> What an iteration may leave over what is left of an extremum's place; and how often it goes on
  !> with factors: they were made nearby.
  real(wp), parameter :: residual_over_place = 1.0e-3_wp
  integer, parameter :: patience = 4
  !> A residual that leaves no doubt which state it is of; a change of h0 small enough for a
  !> derivative and large against rounding (law's lengths).
  real(wp), parameter :: nearly_solved = 1.0e-6_wp, shift = 1.0e-5_wp
  !> A residual that differs from node to node may move a state by this many times as much as one
  !> that is the same everywhere, which acts like a change of h0.
  real(wp), parameter :: worst_residual = 3

contains

  !> Solves the same problem as `steps` on the meshes that self%meshes is to be, and goes on
  !> counting what they have cost.
  subroutine take_over(self, steps)
    class(finer_t), intent(inout) :: self
    class(solver_t), intent(in) :: steps

    self%problem = steps%problem
    self%cost = steps%cost
    associate (own => self%options, given => steps%options)
      own%slope_error = given%slope_error
      own%tolerance = min(given%tolerance, residual_over_place*given%place_error)
      own%patience = patience
    end associate
  end subroutine take_over

  !> Sees that a mesh has its kernel.
  subroutine prepare(self, mesh)
    class(finer_t), intent(inout) :: self
    integer, intent(in) :: mesh

    if (allocated(self%meshes%grid(mesh)%kernel)) return
    if (associated(self%store)) then
      call self%meshes%complete(mesh, self%store)
    else
      call self%meshes%complete(mesh)
    end if
    self%cost%kernel_entries = self%cost%kernel_entries + &
      self%meshes%grid(mesh)%kernel_entries()
  end subroutine prepare

  !> Solves as well as an error has to be known. found: it leaves no doubt which state it is.
  subroutine find(self, control, state, found)
    class(finer_t), intent(inout) :: self
    type(control_t), intent(in) :: control
    type(state_t), intent(inout) :: state
    logical, intent(out) :: found

    call self%solve(control, state, found)
    found = found .or. state%residual < nearly_solved
  end subroutine find

  !> The error of a reported state that has no counterpart on the finer mesh: as large as itself.
  pure type(error_t) function unknown_error(reported) result(error)
    type(reported_t), intent(in) :: reported

    error = error_t(h0=max(abs(reported%h0), 1.0_wp), load=abs(reported%load), &
      displacement=max(abs(reported%displacement), 1.0_wp), profile=1.0_wp, known=.false.)
  end function unknown_error

  !> Errors of a reported state by its witness: on the finer mesh, at the same h0.
  subroutine judge_at_h0(own, fine, reported)
    type(equations_t), intent(in) :: own
    type(finer_t), intent(inout) :: fine
    type(reported_t), intent(inout) :: reported
    type(state_t) :: state, shifted
    type(control_t) :: control
    real(wp) :: left
    logical :: found

    reported%error = unknown_error(reported)
    associate (witness => reported%witness, error => reported%error)
      ! What did not converge has no counterpart.
      if (.not. witness%state%residual < 1) return
      call fine%prepare(witness%mesh)
      state = regrid(own%problem%shape, witness%state, own%meshes%grid(witness%mesh), &
        fine%meshes%grid(witness%mesh), witness%state%scale)
      fine%frozen%factors%valid = .false.
      call fine%find(witness%control, state, found)
      if (.not. found) return
      error = error_t(load=fine%margin*abs(state%load - reported%load) + &
        rounding*abs(reported%load), displacement=fine%margin* &
        abs(state%axis_gap - state%h0 - reported%displacement), &
        profile=fine%margin*profile_error(own, fine, witness%mesh, witness%state, state))
      control = witness%control
      control%value = control%value + shift
      shifted = state
      call fine%find(control, shifted, found)
      if (.not. found) return
      left = what_is_left(state)/shift
      error%load = error%load + left*abs(shifted%load - state%load)
      error%displacement = error%displacement + &
        left*abs((shifted%axis_gap - shifted%h0) - (state%axis_gap - state%h0))
    end associate
  end subroutine judge_at_h0

  !> What the residual of a state amounts to as a change of its h0, at most. The rounding of the
  !> gaps far out, which are large, changes nothing else.
  pure real(wp) function what_is_left(state)
    type(state_t), intent(in) :: state

    what_is_left = rounding + worst_residual* &
      max(state%residual - 4*epsilon(1.0_wp)*min(maxval(state%gap), far_gap), 0.0_wp)
  end function what_is_left

  !> The largest difference of gaps, and of pressures over the largest of them, between a state and
  !> one on a finer mesh, on the axis and at its nodes.
  pure real(wp) function profile_error(own, fine, mesh, state, right) result(largest)
    type(equations_t), intent(in) :: own
    type(finer_t), intent(in) :: fine
    integer, intent(in) :: mesh
    type(state_t), intent(in) :: state, right
    real(wp) :: x, gap, strongest
    integer :: j

    associate (law => own%problem%law, finer => fine%meshes%grid(mesh))
      strongest = max(maxval(abs(right%pressure)), tiny(1.0_wp))
      largest = max(abs(right%axis_gap - state%axis_gap), &
        maxval(abs(law%pressure([right%axis_gap]) - law%pressure([state%axis_gap])))/strongest)
      do j = 1, size(state%gap)
        x = state%scale*own%meshes%grid(mesh)%x(j)/right%scale
        if (x > finer%end) exit
        gap = gap_at(own%problem%shape, finer, right, x)
        largest = max(largest, abs(gap - state%gap(j)), &
          maxval(abs(law%pressure([gap]) - state%pressure(j)))/strongest)
      end do
    end associate
  end function profile_error

end module error_estimate
