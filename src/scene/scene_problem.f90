!> The dimensionless problem of a scene: bodies, forces and shape of its deck.
module scene_problem
  ! The module with most dependencies is first: compiler note 12.
  use scene_groups, only: scene_t
  use dimensionless_problem, only: problem_t, new_problem
  use deck_keys, only: key_spec
  use laws, only: keys_of_laws, read_laws
  use shapes, only: keys_of_shapes, read_shapes
  use bodies_group, only: bodies_keys, take_bodies, layer_keys, take_layer, check_thinness
  use layered_surface, only: layered_surface_t
  use layered_body, only: new_layered_body
  implicit none
  private
  public :: keys_of_model, take_model, problem_of

contains

  !> The rows of bodies, layers, shapes and forces in the table of keys.
  pure function keys_of_model() result(specs)
    type(key_spec), allocatable :: specs(:)

    specs = [bodies_keys, layer_keys, keys_of_shapes(), keys_of_laws()]
  end function keys_of_model

  !> Reads bodies, layers, forces and shape of the scene's deck.
  subroutine take_model(scene)
    type(scene_t), intent(inout) :: scene

    call take_bodies(scene)
    call take_layer(scene)
    call read_laws(scene%deck, scene%law)
    if (allocated(scene%law)) call read_shapes(scene%deck, scene%law%length, scene%shape)
    if (.not. allocated(scene%deck%error)) call check_thinness(scene)
  end subroutine take_model

  !> The problem of a scene.
  type(problem_t) function problem_of(scene) result(problem)
    type(scene_t), intent(in) :: scene
    type(layered_surface_t) :: surface(2)
    integer :: i

    problem = new_problem(scene%law, scene%shape, scene%bodies%stiffness, scene%bodies%rigid)
    problem%share = scene%bodies%share
    if (.not. allocated(scene%bodies%surface)) return
    surface = scene%bodies%surface
    do i = 1, 2
      surface(i)%thickness = surface(i)%thickness/problem%lateral
    end do
    deallocate (problem%body)
    allocate (problem%body, source=new_layered_body(surface, problem%share/2))
  end function problem_of

end module scene_problem
