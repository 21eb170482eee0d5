!> How an equilibrium changes with a parameter of the problem, in SI units, at a fixed place on the
!> path: at a fixed separation on the axis before contact, at a fixed contact radius in contact,
!> where the separation at the edge is kept too.
!>
!> The equations of the varied problems are evaluated at states that move with the parameter along a
!> straight line, positions and separations being those of space. Along the right line the
!> derivative of the equations vanishes; the Jacobian's factors correct the line until it does. So
!> nothing is solved again but linear equations, and what is left is known.
module state_sensitivity
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use equilibrium, only: control_t, state_t, equations_t, residual, at_axis_gap, at_edge_radius, &
    far_gap
  use frozen_jacobian, only: frozen_jacobian_t, freeze
  use linear_algebra, only: solve
  use continuation, only: path_control
  use variation, only: variation_t
  implicit none
  private
  public :: change_t, differentiate

  !> Derivatives by a parameter in SI units: of the separations at the mesh's nodes and of h0 behind
  !> them, and of the load.
  type :: change_t
    real(wp), allocatable :: separation(:)
    real(wp) :: load = 0
    !> What is left of the derivative of the equations, in the law's lengths for a change of the
    !> parameter as large as itself.
    real(wp) :: left = 0
    !> By how much differences of lower order change the load's derivative.
    real(wp) :: uncertainty = 0
  end type change_t

  !> Corrections. They end when they gain less than this factor: rounding rules then.
  integer, parameter :: most_corrections = 5
  real(wp), parameter :: gain = 0.1_wp

contains

  !> The derivatives of an equilibrium with the coordinate s on a mesh (`continuation`) by each
  !> varied parameter. found = .false.: the Jacobian is singular, or a varied problem is not defined
  !> at the state. Renews the factorisation.
  subroutine differentiate(equations, mesh, s, state, frozen, varied, change, found)
    type(equations_t), intent(inout) :: equations
    integer, intent(in) :: mesh
    real(wp), intent(in) :: s
    type(state_t), intent(in) :: state
    type(frozen_jacobian_t), intent(inout) :: frozen
    type(variation_t), intent(in) :: varied(:)
    type(change_t), intent(out) :: change(:)
    logical, intent(out) :: found
    type(control_t) :: control
    integer :: i

    control = path_control(equations%problem, mesh, s)
    call freeze(equations, control, state, frozen)
    found = frozen%factors%valid
    do i = 1, size(varied)
      if (.not. found) return
      call find_line(equations, control, state, frozen, varied(i), change(i), found)
    end do
  end subroutine differentiate

  !> The line of states along which the equations go on to hold.
  subroutine find_line(equations, control, state, frozen, varied, change, found)
    type(equations_t), intent(inout) :: equations
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    type(frozen_jacobian_t), intent(in) :: frozen
    type(variation_t), intent(in) :: varied
    type(change_t), intent(out) :: change
    logical, intent(out) :: found
    type(change_t) :: trial
    real(wp), allocatable :: defect(:)
    integer :: round
    logical :: finished

    allocate (trial%separation(size(state%gap) + 1), defect(size(state%gap) + 1), source=0.0_wp)
    do round = 0, most_corrections
      call follow_line(equations, control, state, varied, trial, defect, found)
      if (.not. found) return
      trial%left = largest(defect, state)*varied%parameter%scale/equations%problem%length
      if (round > 0 .and. .not. trial%left < change%left) exit
      finished = round > 0 .and. .not. trial%left < gain*change%left
      change = trial
      if (finished) exit
      call solve(frozen%factors, defect)
      trial%separation = trial%separation - defect
    end do
  end subroutine find_line

  !> The largest derivative of an equation; where gaps are far, as a part of them, since there is
  !> rounding and no force.
  pure real(wp) function largest(defect, state)
    real(wp), intent(in) :: defect(:)
    type(state_t), intent(in) :: state

    largest = maxval(abs(defect)/max(1.0_wp, [state%gap, state%axis_gap]/far_gap))
  end function largest

  !> Derivatives, along a line of states, of the equations (lengths) and of the load.
  subroutine follow_line(equations, control, state, varied, line, defect, found)
    type(equations_t), intent(inout) :: equations
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    type(variation_t), intent(in) :: varied
    type(change_t), intent(inout) :: line
    real(wp), intent(out) :: defect(:)
    logical, intent(out) :: found
    type(problem_t) :: own
    type(state_t) :: moved
    type(control_t) :: there
    real(wp), dimension(size(defect)) :: at, g
    real(wp) :: coarser
    integer :: k, n

    n = size(state%gap)
    own = equations%problem
    at = own%law%separation_of([state%gap, state%h0])
    defect = 0
    line%load = 0
    coarser = 0
    found = .true.
    do k = 1, size(varied%offset)
      if (.not. abs(varied%weight(k)) > 0) cycle
      equations%problem = varied%problem(k)
      associate (problem => varied%problem(k), law => varied%problem(k)%law)
        there = moved_control(control, own, problem)
        call residual(equations, there, law%gap_of(at + varied%offset(k)*line%separation), g, moved)
        found = found .and. moved%residual < huge(1.0_wp)
        g(:n) = problem%length*g(:n)
        ! The equation of the axis or the edge, as the separation there.
        if (control%kind == at_edge_radius) g(n + 1) = g(n + 1) + law%edge_gap
        g(n + 1) = law%separation_of(g(n + 1))
        defect = defect + varied%weight(k)*g
        line%load = line%load + varied%weight(k)*moved%load*problem%load
        coarser = coarser + varied%coarser(k)*moved%load*problem%load
      end associate
    end do
    line%uncertainty = abs(line%load - coarser)
    equations%problem = own
  end subroutine follow_line

  !> The control that prescribes the same in another problem's units; of the separation on the axis
  !> its own is left.
  pure type(control_t) function moved_control(control, own, other) result(there)
    type(control_t), intent(in) :: control
    type(problem_t), intent(in) :: own, other

    there = control
    select case (control%kind)
    case (at_axis_gap)
      there%value = 0
      there%scale = control%scale*own%lateral/other%lateral
    case (at_edge_radius)
      there%value = control%value*own%lateral/other%lateral
    end select
  end function moved_control

end module state_sensitivity
