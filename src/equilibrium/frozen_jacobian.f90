!> A factorised Jacobian that is used for many states, and the state at which it was made. Equal
!> states and controls give factors that are equal bit by bit, if both have the same precision.
module frozen_jacobian
  use contact_state, only: state_t
  use controls, only: control_t
  use equilibrium, only: equations_t
  use jacobian, only: factorise_jacobian
  use linear_algebra, only: factorisation_t
  implicit none
  private
  public :: frozen_jacobian_t, freeze

  type :: frozen_jacobian_t
    type(factorisation_t) :: factors
    !> The control, and the variables of the state on which the Jacobian depends: gaps, H0 and
    !> scale.
    type(control_t) :: control
    type(state_t) :: state
    !> Iterations in excess of those that every state needs, over all states solved with these
    !> factors.
    integer :: excess = 0
    !> Number of Jacobians that were factorised here, including this one.
    integer :: renewals = 0
  contains
    procedure :: serves
    procedure :: forget
  end type frozen_jacobian_t

contains

  !> Whether the factors have the same number of unknowns, kind of control and mesh.
  pure logical function serves(self, control, unknowns)
    class(frozen_jacobian_t), intent(in) :: self
    type(control_t), intent(in) :: control
    integer, intent(in) :: unknowns

    serves = self%factors%valid .and. self%control%kind == control%kind .and. &
      self%control%mesh == control%mesh
    if (serves) serves = size(self%factors%lu, 1) == unknowns
  end function serves

  !> Invalidates the factors, so that the next state makes new ones: the old ones are too far from
  !> it.
  pure subroutine forget(self)
    class(frozen_jacobian_t), intent(inout) :: self

    self%factors%valid = .false.
  end subroutine forget

  !> Factorises the Jacobian at a state. frozen%factors%valid: the Jacobian is regular. The factors
  !> are in double precision if `exact` is .true., or if the mesh is fixed in space, where their
  !> determinants are used. They are so with a fluid too, whose pressures depend too strongly on the
  !> gaps in short time steps. Otherwise they are in single precision.
  subroutine freeze(equations, control, state, frozen, exact)
    type(equations_t), intent(inout) :: equations
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    type(frozen_jacobian_t), intent(inout) :: frozen
    logical, intent(in), optional :: exact
    logical :: rough

    rough = .not. (equations%meshes%is_fixed() .or. allocated(equations%drainage))
    if (present(exact)) rough = rough .and. .not. exact
    call factorise_jacobian(equations, control, state, frozen%factors, rough=rough)
    frozen%control = control
    frozen%state%gap = state%gap
    frozen%state%h0 = state%h0
    frozen%state%scale = state%scale
    frozen%renewals = frozen%renewals + 1
  end subroutine freeze

end module frozen_jacobian
