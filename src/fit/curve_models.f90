!> The model of a deck's bodies for measured curves: the equilibrium path if the bodies attract each
!> other, otherwise a curve stepped in h0.
module curve_models
  use variation, only: problem_family_t
  use experiment_request, only: numerics_t
  use force_model, only: force_model_t
  use path_model, only: path_model_t
  use stepped_model, only: stepped_model_t
  implicit none
  private
  public :: curve_models_t

  !> The two kinds of model, of which one is used.
  type :: curve_models_t
    type(path_model_t) :: path
    type(stepped_model_t) :: stepped
  contains
    procedure :: set
    procedure :: set_wider
  end type curve_models_t

contains

  !> Sets the model of a family of problems. attracts: whether the bodies attract each other. `self`
  !> must exist as long as the model is used. with_radius: whether the contact radius is wanted.
  subroutine set(self, family, numerics, attracts, with_radius, model)
    class(curve_models_t), intent(inout), target :: self
    class(problem_family_t), intent(in) :: family
    type(numerics_t), intent(in) :: numerics
    logical, intent(in) :: attracts, with_radius
    class(force_model_t), pointer, intent(out) :: model

    if (attracts) then
      allocate (self%path%family, source=family)
      self%path%numerics = numerics
      model => self%path
    else
      allocate (self%stepped%family, source=family)
      self%stepped%numerics = numerics
      model => self%stepped
    end if
    model%with_radius = with_radius
  end subroutine set

  !> Sets the model of a wider family, whose first parameters are those of `like`, another model of
  !> the same bodies, and takes over the solutions of `like`.
  subroutine set_wider(self, family, like, model)
    class(curve_models_t), intent(inout), target :: self
    class(problem_family_t), intent(in) :: family
    class(force_model_t), intent(in) :: like
    class(force_model_t), pointer, intent(out) :: model

    select type (like)
    type is (path_model_t)
      self%path = like
      call self%path%widen_to(family)
      model => self%path
    type is (stepped_model_t)
      call self%set(family, like%numerics, .false., like%with_radius, model)
    end select
  end subroutine set_wider

end module curve_models
