!> The problem without units that a scene poses.
module scene_problem
  use force_law, only: force_law_t
  use laws, only: law_parameters_t, new_law
  use dimensionless_problem, only: problem_t, new_problem
  use scene_groups, only: scene_t
  implicit none
  private
  public :: problem_of

contains

  !> The problem that a scene poses.
  function problem_of(scene) result(problem)
    type(scene_t), intent(in) :: scene
    type(problem_t) :: problem
    class(force_law_t), allocatable :: law
    type(law_parameters_t) :: parameters

    associate (f => scene%force)
      parameters%law = f%law
      parameters%part = f%part
      parameters%hamaker = f%hamaker
      parameters%z0 = f%z0
      parameters%p0 = f%p0
      parameters%decay_length = f%decay_length
    end associate
    call new_law(parameters, law)
    problem = new_problem(law, scene%bodies%radius, scene%bodies%stiffness, scene%bodies%rigid)
    problem%share = scene%bodies%share
  end function problem_of

end module scene_problem
