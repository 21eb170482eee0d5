!> &numerics: how the equations are solved.
module numerics_group
  use kinds, only: wp
  use deck_keys, only: key_spec, group, real_key, integer_key, word_key
  use scene_groups, only: scene_t
  implicit none
  private
  public :: numerics_keys, take_numerics

contains

  !> The rows of &numerics.
  pure function numerics_keys() result(specs)
    type(key_spec), allocatable :: specs(:)

    specs = [ &
      group('numerics', 'How the equations are solved. Most decks need only accuracy.', &
            always=.true.), &
      word_key('numerics', 'method', 'auto mixing anderson newton', 'Iteration to equilibrium.', &
               default='auto'), &
      real_key('numerics', 'accuracy', '', 'Relative accuracy of load and displacement.', &
               default='1e-6', low=1e-10_wp, high=1e-1_wp), &
      word_key('numerics', 'grid', 'auto uniform panels', 'Discretisation.', default='auto'), &
      integer_key('numerics', 'nodes', 'Number of nodes of a fixed grid, which grid = ' // &
                  '''uniform'' and method = ''mixing'' have.', 2, 20000, &
                  otherwise='from accuracy'), &
      real_key('numerics', 'r_max', 'm', 'Radius at which a fixed grid ends.', above=0.0_wp, &
               otherwise='from accuracy'), &
      word_key('numerics', 'convergence', 'residual displacement_change', 'Quantity that must ' // &
               'be small at convergence: the residual, or the change from one iteration to ' // &
               'the next.', &
               default='residual'), &
      real_key('numerics', 'displacement_tolerance', 'm', 'Largest change at convergence, ' // &
               'for convergence = ''displacement_change''.', default='1e-13', &
               above=0.0_wp), &
      real_key('numerics', 'residual_tolerance', '', 'Largest residual at convergence, ' // &
               'relative to the force law''s length.', low=1e-13_wp, high=1e-2_wp, &
               otherwise='from accuracy'), &
      integer_key('numerics', 'max_iterations', 'Largest number of iterations for one state.', 1, &
                  1000000000, default='20000'), &
      real_key('numerics', 'mixing_limit', '', 'Largest mixing ratio.', default='0.2', &
               above=0.0_wp, high=1.0_wp), &
      integer_key('numerics', 'anderson_depth', 'Number of earlier iterations that Anderson ' // &
                  'acceleration uses.', 1, 60, default='5'), &
      integer_key('numerics', 'panel_order', 'Nodes of one panel of a fixed grid.', 4, 24, &
                  otherwise='from accuracy')]
  end function numerics_keys

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
      call deck%get('numerics', 'anderson_depth', numerics%anderson_depth)
      call deck%get_optional('numerics', 'r_max', numerics%r_max)
      call deck%get_optional('numerics', 'residual_tolerance', numerics%residual_tolerance)
      call deck%get_optional('numerics', 'nodes', numerics%nodes)
      call deck%get_optional('numerics', 'panel_order', numerics%panel_order)
    end associate
  end subroutine take_numerics

end module numerics_group
