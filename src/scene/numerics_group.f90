!> Reads &numerics: how the equations are solved.
module numerics_group
  use kinds, only: wp
  use deck_keys, only: key_spec, real_value, integer_value, word_value
  use scene_groups, only: scene_t
  implicit none
  private
  public :: numerics_keys, take_numerics, coarsest

  !> The coarsest accuracy. A coarser one would make a path or a cycle hardly cheaper: with half the
  !> nodes, a sixth of the computing time would be saved at best, and folds might be missed. A drive
  !> in time would take longer steps.
  real(wp), parameter :: coarsest = 1e-3_wp

  !> The rows of &numerics.
  type(key_spec), parameter :: numerics_keys(*) = [ &
    key_spec('numerics', meaning='How the equations are solved. Most decks need only accuracy.', &
      always=.true., &
      choices='&numerics accuracy = 1e-3 /'), &
    key_spec('numerics', 'method', word_value, 'Iteration to equilibrium.', &
      choices='auto mixing anderson_mixing anderson newton', default='auto'), &
    key_spec('numerics', 'accuracy', real_value, 'Relative accuracy of load and displacement. ' // &
      'Above 1e-3 only a drive in time costs less.', &
      default='1e-6', low=1e-10_wp, high=1e-1_wp), &
    key_spec('numerics', 'grid', word_value, 'Discretisation.', choices='auto uniform panels', &
      default='auto'), &
    key_spec('numerics', 'nodes', integer_value, 'Number of nodes of a fixed grid, which grid ' // &
      '= ''uniform'' and method = ''mixing'' have.', low=2, high=20000, &
      otherwise='from accuracy'), &
    key_spec('numerics', 'r_max', real_value, 'Radius at which a fixed grid ends.', 'm', &
      above=0.0_wp, otherwise='from accuracy'), &
    key_spec('numerics', 'convergence', word_value, 'Quantity that must be small at ' // &
      'convergence: the residual, or the change from one iteration to the next.', &
      choices='residual displacement_change', default='residual'), &
    key_spec('numerics', 'displacement_tolerance', real_value, &
      'Largest change at convergence, for convergence = ''displacement_change''.', 'm', &
      default='1e-13', above=0.0_wp), &
    key_spec('numerics', 'residual_tolerance', real_value, 'Largest residual at convergence, ' // &
      'relative to the force law''s length.', low=1e-13_wp, high=1e-2_wp, &
      otherwise='from accuracy'), &
    key_spec('numerics', 'max_iterations', integer_value, 'Largest number of iterations for ' // &
      'one state.', low=1, high=1000000000, default='20000'), &
    key_spec('numerics', 'mixing_limit', real_value, 'Largest mixing ratio.', default='0.2', &
      above=0.0_wp, high=1.0_wp), &
    key_spec('numerics', 'anderson_depth', integer_value, 'Number of earlier iterations that ' // &
      'Anderson acceleration uses; with 0 there is none.', low=0, high=60, &
      otherwise='5; 10 for anderson_mixing'), &
    key_spec('numerics', 'panel_order', integer_value, 'Nodes of one panel of a fixed grid.', &
      low=4, high=24, otherwise='from accuracy')]

contains

  !> Reads &numerics.
  subroutine take_numerics(scene)
    type(scene_t), intent(inout) :: scene

    associate (deck => scene%deck, numerics => scene%numerics)
      call deck%get('numerics', 'method', numerics%method)
      call deck%get('numerics', 'accuracy', numerics%accuracy)
      call deck%get('numerics', 'grid', numerics%grid)
      call deck%get('numerics', 'convergence', numerics%convergence)
      call deck%get('numerics', 'displacement_tolerance', numerics%displacement_tolerance)
      call deck%get('numerics', 'max_iterations', numerics%max_iterations)
      call deck%get('numerics', 'mixing_limit', numerics%mixing_limit)
      call deck%get_optional('numerics', 'anderson_depth', numerics%anderson_depth)
      call deck%get_optional('numerics', 'r_max', numerics%r_max)
      call deck%get_optional('numerics', 'residual_tolerance', numerics%residual_tolerance)
      call deck%get_optional('numerics', 'nodes', numerics%nodes)
      call deck%get_optional('numerics', 'panel_order', numerics%panel_order)
    end associate
  end subroutine take_numerics

end module numerics_group
