!> The problem without units that a scene poses.
module scene_problem
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

    problem = new_problem(scene%law, scene%shape, scene%bodies%stiffness, scene%bodies%rigid)
    problem%share = scene%bodies%share
  end function problem_of

end module scene_problem
