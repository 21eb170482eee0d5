!> Whether an equilibrium is stable at fixed h0, by products with the elastic operator alone: for
!> the accelerated mixing, which converges to unstable states too and has no factors.
!>
!> A state is unstable if A D, with the operator A and the slopes D = diag(P'), has an eigenvalue
!> above 1, as (24) and (25) demand of the response to a perturbation. D A has the same eigenvalues
!> and is self-adjoint under the product q . A q' of pressures (with the weights of the mesh), so
!> the method of Lanczos makes it tridiagonal with one product for each step. The pivots of 1 minus
!> the tridiagonal matrix are positive as long as all eigenvalues of the tridiagonal matrix are
!> below 1. These are never above the largest eigenvalue of D A.
module stability_by_products
  use kinds, only: wp
  use contact_state, only: state_t
  use controls, only: control_t
  use discretisation, only: first_node
  use equilibrium, only: equations_t
  use represented_pressure, only: pressure_slope_t, slope_on
  implicit none
  private
  public :: is_stable

  !> Number of steps over the square root of the spectrum's width. Eigenvalues that exceed 1 by more
  !> than about a tenth are found.
  real(wp), parameter :: steps_over_root = 5
  integer, parameter :: most_steps = 1000

contains

  !> Whether no eigenvalue above 1 is found at a state.
  logical function is_stable(equations, control, state) result(stable)
    type(equations_t), intent(inout) :: equations
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    type(pressure_slope_t) :: slope
    real(wp), dimension(size(state%gap)) :: q, q_before, raised, r
    real(wp) :: alpha, beta, pivot, width
    integer :: step

    stable = .true.
    associate (grid => equations%meshes%grid(control%mesh))
      slope = slope_on(equations%problem%law, grid, state%gap)
      ! Only an attraction that decreases with the gap makes a state unstable.
      q = max(slope%at_node, 0.0_wp)
      call normalise(beta)
      if (.not. beta > 0) return
      q_before = 0
      beta = 0
      pivot = 1
      width = 1
      do step = 1, most_steps
        r = slope%times(raised)
        alpha = sum(grid%weight*r*raised)
        pivot = 1 - alpha - beta**2/pivot
        stable = pivot > 0
        width = max(width, abs(alpha) + 2*beta)
        if (.not. stable .or. step > steps_over_root*sqrt(width)) return
        r = r - alpha*q - beta*q_before
        q_before = q
        q = r
        call normalise(beta)
        if (.not. beta > 0) return
      end do
    end associate

  contains

    !> Sets `raised` to A q, and divides q and `raised` by the length of q.
    subroutine normalise(length)
      real(wp), intent(out) :: length
      real(wp) :: rise(first_node - 1 + size(q))

      associate (grid => equations%meshes%grid(control%mesh))
        call equations%operator%deform(equations%problem, grid, state%scale, size(q), q, rise)
        equations%cost%operator_products = equations%cost%operator_products + 1
        equations%cost%operator_columns = equations%cost%operator_columns + size(q)
        length = sum(grid%weight*q*rise(first_node:))
      end associate
      if (.not. length > 0) return
      length = sqrt(length)
      q = q/length
      raised = rise(first_node:)/length
    end subroutine normalise

  end function is_stable

end module stability_by_products
