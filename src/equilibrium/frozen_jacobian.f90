!> A factorised Jacobian that serves many states, and the state at which it was made. The same state
!> and control give the same factors, bit by bit.
module frozen_jacobian
  use contact_state, only: state_t
  use equilibrium, only: control_t, equations_t
  use jacobian, only: factorise_jacobian
  use linear_algebra, only: factorisation_t
  implicit none
  private
  public :: frozen_jacobian_t, freeze

  type :: frozen_jacobian_t
    type(factorisation_t) :: factors
    !> The control, and the part of the state that the Jacobian depends on: gaps, H0 and scale.
    type(control_t) :: control
    type(state_t) :: state
    !> Iterations beyond those that every state takes, over all states solved with these factors.
    integer :: excess = 0
    !> Number of Jacobians frozen here, this one included.
    integer :: renewals = 0
  contains
    procedure :: serves
    procedure :: forget
  end type frozen_jacobian_t

contains

  !> Whether the factors are for as many unknowns, of the same kind of control on the same mesh.
  pure logical function serves(self, control, unknowns)
    class(frozen_jacobian_t), intent(in) :: self
    type(control_t), intent(in) :: control
    integer, intent(in) :: unknowns

    serves = self%factors%valid .and. self%control%kind == control%kind .and. &
      self%control%mesh == control%mesh
    if (serves) serves = size(self%factors%lu, 1) == unknowns
  end function serves

  !> Has the next state make factors of its own: those in hand are too far from it.
  pure subroutine forget(self)
    class(frozen_jacobian_t), intent(inout) :: self

    self%factors%valid = .false.
  end subroutine forget

  !> Factorises the Jacobian at a state. frozen%factors%valid: whether it is regular.
  subroutine freeze(equations, control, state, frozen)
    type(equations_t), intent(inout) :: equations
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    type(frozen_jacobian_t), intent(inout) :: frozen

    call factorise_jacobian(equations, control, state, frozen%factors)
    frozen%control = control
    frozen%state%gap = state%gap
    frozen%state%h0 = state%h0
    frozen%state%scale = state%scale
    frozen%renewals = frozen%renewals + 1
  end subroutine freeze

end module frozen_jacobian
