!> Derivatives of an equilibrium by a parameter of the problem, in SI units, at a fixed place on the
!> path. Before contact the separation on the axis is fixed. In contact the contact radius is fixed,
!> and so is the separation at the edge.
!>
!> The equations of the varied problems are evaluated at states that change linearly with the
!> parameter; positions and separations are in SI units. Along the correct line the derivative of
!> the equations is zero; the line is corrected with the Jacobian's factors until this holds to
!> rounding. Only linear equations are solved, and the remaining derivative is known.
module state_sensitivity
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use contact_state, only: state_t, far_gap
  use mesh_family, only: mesh_family_t
  use controls, only: control_t, at_edge_radius
  use equilibrium, only: equations_t, residual
  use frozen_jacobian, only: frozen_jacobian_t, freeze
  use linear_algebra, only: solve
  use path_point, only: path_point_t
  use path_coordinate, only: path_control
  use variation, only: variation_t
  implicit none
  private
  public :: change_t, differentiate

  !> Derivatives by a parameter in SI units: of the separations at the mesh's nodes, followed by h0,
  !> and of the load.
  type :: change_t
    real(wp), allocatable :: separation(:)
    real(wp) :: load = 0
    !> The remaining derivative of the equations, in the law's lengths for a change of the parameter
    !> by its own scale.
    real(wp) :: left = 0
    !> The change of the load's derivative with a difference rule of lower order.
    real(wp) :: uncertainty = 0
  end type change_t

  !> Largest number of corrections. They end when the remaining derivative falls by less than this
  !> factor, since rounding dominates then.
  integer, parameter :: most_corrections = 5
  real(wp), parameter :: gain = 0.1_wp

contains

  !> The derivatives of an equilibrium of the path by each varied parameter. found = .false.: the
  !> Jacobian is singular, or a varied problem is not defined at the state. The factors are renewed.
  !> enough: the fraction of the derivative of the equations that may remain; factors in single
  !> precision suffice for it. If it is 0, only rounding remains.
  subroutine differentiate(equations, point, frozen, varied, change, found, enough)
    type(equations_t), intent(inout) :: equations
    type(path_point_t), intent(in) :: point
    type(frozen_jacobian_t), intent(inout) :: frozen
    type(variation_t), intent(in) :: varied(:)
    type(change_t), intent(out) :: change(:)
    logical, intent(out) :: found
    real(wp), intent(in) :: enough
    integer :: i

    call freeze(equations, path_control(equations%problem, equations%meshes, point%mesh, &
      point%coordinate), point%state, frozen, exact=.not. enough > 0)
    found = frozen%factors%valid
    do i = 1, size(varied)
      if (.not. found) return
      call find_line(equations, point, frozen, varied(i), enough, change(i), found)
    end do
  end subroutine differentiate

  !> The line of states along which the equations remain satisfied.
  subroutine find_line(equations, point, frozen, varied, enough, change, found)
    type(equations_t), intent(inout) :: equations
    type(path_point_t), intent(in) :: point
    type(frozen_jacobian_t), intent(in) :: frozen
    type(variation_t), intent(in) :: varied
    real(wp), intent(in) :: enough
    type(change_t), intent(out) :: change
    logical, intent(out) :: found
    type(change_t) :: trial
    real(wp), allocatable :: defect(:)
    real(wp) :: at_first
    integer :: round
    logical :: finished

    allocate (defect(size(point%state%gap) + 1))
    allocate (trial%separation(size(defect)), source=0.0_wp)
    do round = 0, most_corrections
      call follow_line(equations, point, varied, trial, defect, found)
      if (.not. found) return
      trial%left = largest(defect, point%state)*varied%parameter%scale/equations%problem%length
      if (round == 0) at_first = trial%left
      if (round > 0 .and. .not. trial%left < change%left) exit
      finished = trial%left <= enough*at_first
      if (round > 0) finished = finished .or. .not. trial%left < gain*change%left
      change = trial
      if (finished) exit
      call solve(frozen%factors, defect)
      trial%separation = trial%separation - defect
    end do
  end subroutine find_line

  !> The largest derivative of an equation; for large gaps, relative to the gap, since rounding is
  !> proportional to the gap.
  pure real(wp) function largest(defect, state)
    real(wp), intent(in) :: defect(:)
    type(state_t), intent(in) :: state

    largest = maxval(abs(defect)/max(1.0_wp, [state%gap, state%axis_gap]/far_gap))
  end function largest

  !> Derivatives of the equations (lengths) and of the load along a line of states.
  subroutine follow_line(equations, point, varied, line, defect, found)
    type(equations_t), intent(inout) :: equations
    type(path_point_t), intent(in) :: point
    type(variation_t), intent(in) :: varied
    type(change_t), intent(inout) :: line
    real(wp), intent(out) :: defect(:)
    logical, intent(out) :: found
    type(problem_t) :: own
    type(state_t) :: moved
    real(wp), dimension(size(defect)) :: left
    real(wp) :: coarser
    integer :: k

    own = equations%problem
    defect = 0
    line%load = 0
    coarser = 0
    found = .true.
    do k = 1, size(varied%offset)
      if (.not. abs(varied%weight(k)) > 0) cycle
      call move(equations, own, point, varied, k, line, moved, left)
      found = found .and. moved%residual < huge(1.0_wp)
      defect = defect + varied%weight(k)*left
      associate (load => moved%load*varied%problem(k)%load)
        line%load = line%load + varied%weight(k)*load
        coarser = coarser + varied%coarser(k)*load
      end associate
    end do
    line%uncertainty = abs(line%load - coarser)
    call equations%become_those_of(own)
  end subroutine follow_line

  !> The state on a line for the k-th varied problem, and the residuals of its equations [m]. The
  !> equations take over the varied problem. own: the problem of the point.
  subroutine move(equations, own, point, varied, k, line, moved, left)
    type(equations_t), intent(inout) :: equations
    type(problem_t), intent(in) :: own
    type(path_point_t), intent(in) :: point
    type(variation_t), intent(in) :: varied
    integer, intent(in) :: k
    type(change_t), intent(in) :: line
    type(state_t), intent(inout) :: moved
    real(wp), intent(out) :: left(:)
    type(control_t) :: control
    integer :: n

    n = size(point%state%gap)
    call equations%become_those_of(varied%problem(k))
    associate (problem => varied%problem(k), law => varied%problem(k)%law)
      control = control_of(own, problem, equations%meshes, point%mesh, point%coordinate)
      call residual(equations, control, law%gap_of(own%law%separation_of([point%state%gap, &
        point%state%h0]) + varied%offset(k)*line%separation), left, moved)
      if (control%kind == at_edge_radius) then
        ! The equation of the edge keeps the separation, not the gap in the law's lengths.
        associate (gap => equations%meshes%locked_gap(point%mesh))
          left(n + 1) = left(n + 1) + gap - law%gap_of(own%law%separation_of(gap))
        end associate
      end if
      left = problem%length*left
    end associate
  end subroutine move

  !> The control that prescribes a coordinate of the path of problem `own`, in the units of problem
  !> `other`.
  pure type(control_t) function control_of(own, other, meshes, mesh, s) result(control)
    type(problem_t), intent(in) :: own, other
    type(mesh_family_t), intent(in) :: meshes
    integer, intent(in) :: mesh
    real(wp), intent(in) :: s

    control = path_control(own, meshes, mesh, s)
    if (control%kind == at_edge_radius) then
      control%value = control%value*own%lateral/other%lateral
    else
      control%value = other%law%gap_of(own%law%separation_of(control%value))
      control%scale = control%scale*own%lateral/other%lateral
    end if
  end function control_of

end module state_sensitivity
