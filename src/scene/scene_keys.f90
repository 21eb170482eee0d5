!> Every group and key of a snapin deck: what it means, what it may be, what it is if left out.
!> The reader, `--keys` and the resolved deck all follow this one table.
module scene_keys
  use kinds, only: wp
  use deck_keys, only: key_spec, group, real_key, list_key, integer_key, logical_key, word_key, &
                       text_key
  use laws, only: keys_of_laws
  implicit none
  private
  public :: keys_of_scene, most_steps

  !> A run of more steps than this would not end; such a deck has a wrong unit in it.
  integer, parameter :: most_steps = 10000000

contains

  !> The table, one row a group or key, the keys of a group right after it.
  pure function keys_of_scene() result(specs)
    type(key_spec), allocatable :: specs(:)
    real(wp), parameter :: zero = 0

    specs = [ &
      group('scene', 'What the calculation is called.'), &
      text_key('scene', 'title', 200, 'Title, repeated in every file of results.', &
               otherwise='none'), &
      !
      group('bodies', 'The two bodies. Exactly one of: stiffness; young and poisson; ' // &
            'rigid = .true.', required=.true.), &
      real_key('bodies', 'radius', 'm', 'Radius R of the gap h0 + r^2/(2R); a sphere on a ' // &
               'plane has its own radius.', above=zero, required=.true.), &
      real_key('bodies', 'stiffness', 'Pa', 'E/(1-nu^2) of two identical bodies: the compliance ' &
               // '(1-nu^2)/E is the mean over the two.', above=zero), &
      list_key('bodies', 'young', 'Pa', 'Young''s moduli of the two bodies; one value: the same.', &
               most=2, above=zero), &
      list_key('bodies', 'poisson', '', 'Poisson''s ratios of the two bodies; one value: the ' // &
               'same.', most=2, above=-1.0_wp, high=0.5_wp), &
      logical_key('bodies', 'rigid', 'Whether the bodies do not deform at all.', &
                  default='.false.'), &
      keys_of_laws(), &
      !
      group('loading', 'Approach in steps of h0, the separation that undeformed bodies would ' // &
            'have at the centre.'), &
      real_key('loading', 'h0_start', 'm', 'Where the approach starts.', required=.true.), &
      real_key('loading', 'h0_end', 'm', 'Where it ends, below h0_start.', required=.true.), &
      real_key('loading', 'h0_step', 'm', 'Step, positive.', above=zero, required=.true.), &
      !
      group('unloading', 'Retreat in steps of h0, one cycle for each turning point; needs ' // &
            '&loading.'), &
      list_key('unloading', 'from', 'm', 'Turning points, inside the range of &loading.', &
               most=100, otherwise='h0_end of &loading'), &
      real_key('unloading', 'h0_end', 'm', 'Where each retreat ends, above every turning point.', &
               otherwise='h0_start of &loading'), &
      real_key('unloading', 'h0_step', 'm', 'Step, positive.', above=zero, &
               otherwise='h0_step of &loading'), &
      !
      group('equilibrium_path', 'The whole path of equilibria, stable and unstable, with ' // &
            'exact folds.'), &
      real_key('equilibrium_path', 'h0_start', 'm', 'Where the path starts, above h0_end.', &
               otherwise='chosen by the program'), &
      real_key('equilibrium_path', 'h0_end', 'm', 'Where it ends; needed without &loading.', &
               otherwise='h0_end of &loading'), &
      !
      group('profiles', 'Separation, deformation, pressure and energy against r; needs &loading ' &
            // 'or &equilibrium_path.'), &
      list_key('profiles', 'h0', 'm', 'The h0 at which they are written.', most=1000, &
               required=.true.), &
      !
      group('approximations', 'Closed-form approximations for slow deformation.'), &
      real_key('approximations', 'h0_start', 'm', 'Upper end of the range of h0.', &
               otherwise='as in &loading or &equilibrium_path'), &
      real_key('approximations', 'h0_end', 'm', 'Lower end of the range of h0.', &
               otherwise='as in &loading or &equilibrium_path'), &
      integer_key('approximations', 'count', 'Number of points.', 2, 1000000, default='200'), &
      !
      group('classical', 'Hertz, JKR, DMT and Maugis-Dugdale beside the curve.'), &
      real_key('classical', 'h0_start', 'm', 'Upper end of the range of h0.', &
               otherwise='as in &loading or &equilibrium_path'), &
      real_key('classical', 'h0_end', 'm', 'Lower end of the range of h0.', &
               otherwise='as in &loading or &equilibrium_path'), &
      integer_key('classical', 'count', 'Number of points.', 2, 1000000, default='200'), &
      !
      group('stability', 'Stability of every equilibrium, by criterion and by smallest ' // &
            'eigenvalue; needs &loading or &equilibrium_path.'), &
      !
      group('sweep', 'The same deck for several values of one key. Either values, or from, to ' // &
            'and count.'), &
      text_key('sweep', 'key', 49, 'The key to vary, as ''group.key''.', required=.true.), &
      real_key('sweep', 'from', '', 'First value, in the unit of the key.'), &
      real_key('sweep', 'to', '', 'Last value.'), &
      integer_key('sweep', 'count', 'Number of values.', 2, 10000), &
      word_key('sweep', 'scale', 'linear log', 'Spacing of the values.', otherwise='linear'), &
      list_key('sweep', 'values', '', 'The values one by one.', most=10000), &
      !
      group('numerics', 'How the equations are solved; accuracy is the one knob, the rest is ' // &
            'for experts.', always=.true.), &
      word_key('numerics', 'method', 'auto mixing anderson newton', 'Iteration to equilibrium.', &
               default='auto'), &
      real_key('numerics', 'accuracy', '', 'Relative accuracy of load and displacement.', &
               default='1e-6', low=1e-10_wp, high=1e-1_wp), &
      word_key('numerics', 'grid', 'auto uniform panels', 'Discretisation.', default='auto'), &
      integer_key('numerics', 'nodes', 'Number of nodes.', 2, 20000, &
                  otherwise='from accuracy'), &
      real_key('numerics', 'r_max', 'm', 'Radius at which the grid ends.', above=zero, &
               otherwise='from accuracy'), &
      word_key('numerics', 'convergence', 'residual displacement_change', 'What must become ' // &
               'small: the equations'' residual, or the change from one iteration to the next.', &
               default='residual'), &
      real_key('numerics', 'displacement_tolerance', 'm', 'Largest change that passes for ' // &
               'converged; used by convergence = ''displacement_change''.', default='1e-13', &
               above=zero), &
      real_key('numerics', 'residual_tolerance', '', 'Largest residual that passes for ' // &
               'converged, relative to the force law''s length.', low=1e-13_wp, high=1e-2_wp, &
               otherwise='from accuracy'), &
      integer_key('numerics', 'max_iterations', 'Most iterations for one equilibrium.', 1, &
                  1000000000, default='20000'), &
      real_key('numerics', 'mixing_limit', '', 'Largest mixing ratio.', default='0.2', &
               above=zero, high=1.0_wp), &
      integer_key('numerics', 'anderson_depth', 'Number of earlier iterations that Anderson ' // &
                  'acceleration uses.', 1, 60, default='5'), &
      integer_key('numerics', 'panel_order', 'Nodes of one panel of grid = ''panels''.', 4, 24, &
                  otherwise='from accuracy'), &
      !
      group('summary', 'Results in a summary file, so that such a file can be run again.', &
            ignored=.true.), &
      group('cost', 'As &summary.', ignored=.true.)]
  end function keys_of_scene

end module scene_keys
