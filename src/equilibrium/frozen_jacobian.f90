!> A factorised Jacobian that serves many states, and where it was made: the same state and control
!> give the same factors, bit by bit.
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
    !> The control, and of the state what the Jacobian depends on: gaps, H0 and scale.
    type(control_t) :: control
    type(state_t) :: state
    !> Iterations that states solved with it took beyond those that they take anyway.
    integer :: excess = 0
    !> Jacobians that were frozen here, this one included.
    integer :: renewals = 0
  contains
    procedure :: serves
    procedure :: forget
  end type frozen_jacobian_t

contains

  !> Whether there are factors for so many unknowns of a control of this kind on the same mesh.
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

  !> Takes the Jacobian at a state for the present one. frozen%factors%valid: whether it is regular.
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
