!> The table of all reported values: summary.nml, the columns of sweep.csv and the Python package
!> follow it. A number at a place of the path needs one row here, with the name of the place, the
!> quantity and `error`, and is then in the summary with its error and derivatives. The module that
!> finds a place enters it. Any other number has a row here, and a `set` where it is computed.
module result_rows
  use reported_place, only: of_h0, of_load, of_displacement, of_energy, of_suction, of_position, &
    of_tension, of_work, of_profile
  implicit none
  private
  public :: row_t, rows, row_of, in_summary, in_cost
  public :: turning, spring, given_load, carpick, pietrement_troyon, layered_regime

  !> The group of summary.nml that has a row.
  integer, parameter :: in_summary = 1, in_cost = 2
  !> When a row is a column of sweep.csv: never or always; if the deck has a certain group, or
  !> forces other than the paper's, or a theory in &classical, or &regime with layers. Some rows
  !> have one column for each turning point, spring or load.
  character(len=*), parameter :: never = '', always = 'always', classical = 'classical', &
    approximations = 'approximations', regime = 'regime', forces = '(forces)', &
    turning = 'unloading', spring = 'device', given_load = 'fixed_load', &
    layer = 'layer', drive = 'drive', fluid = 'fluid', viscoelastic = 'viscoelastic', &
    tabulated = 'tabulated', carpick = '(carpick)', pietrement_troyon = '(troyon)', &
    layered_regime = '(layers)'

  !> Key, unit and meaning; a list has one value for each turning point, fold, profile or the like.
  type :: row_t
    character(len=32) :: key = ''
    character(len=5) :: unit = ''
    character(len=104) :: meaning = ''
    character(len=14) :: sweep = never
    integer :: group = in_summary
    logical :: list = .false.
    !> The place and the quantity (`reported_place`), for a number that is read at a place.
    character(len=20) :: place = ''
    integer :: quantity = 0
    !> Ending of the key of its error; empty if it has none.
    character(len=12) :: error = ''
  end type row_t

  character(len=*), parameter :: judged = '_error'

  !> The rows in the order of the summary.
  type(row_t), parameter :: rows(*) = [ &
    row_t('title', '', 'title of the scene'), &
    row_t('version', '', 'version of the program'), &
    row_t('converged', '', &
      'whether every equilibrium was solved to the tolerance (sweep.csv: 1 or 0)', always), &
    row_t('tabor', '', 'Tabor''s parameter; of a step beside a z0 with the range of the step', &
      always), &
    row_t('sigma', '', 'strength of adhesion, (40) of the paper: tabor^(3/2)/2', always), &
    row_t('big_lambda', '', &
      'strength of exponential repulsion, (39) of the paper at h0 = 0', always), &
    row_t('reduced_modulus', 'Pa', 'E* of the bodies without layers: 1/E* is the sum of ' // &
      '(1-nu^2)/E', always), &
    row_t('plane_strain_modulus', 'Pa', 'E/(1-nu^2) of two identical bodies with this ' // &
      'reduced_modulus, twice as large', always), &
    row_t('top_modulus', 'Pa', 'with &layer: E* of half-spaces of the top layers', layer), &
    row_t('bottom_modulus', 'Pa', 'with &layer: E* of the half-spaces below the layers', layer), &
    row_t('effective_modulus', 'Pa', 'with &layer and &classical: E* of half-spaces with the ' // &
      'load of hertz_layered by Hertz', layer), &
    row_t('surface_energy', 'J/m^2', 'former name of work_of_adhesion: the depth of the ' // &
      'law''s minimum, or its energy at contact', always), &
    row_t('work_of_adhesion', 'J/m^2', 'energy needed to separate unit area from contact; ' // &
      'negative: contact is metastable', forces), &
    row_t('table_error', '', 'estimated relative error of work_of_adhesion and pull-off from ' // &
      'the points of a table', tabulated), &
    row_t('rest_gap', 'm', 'equilibrium separation, the smallest without force', forces), &
    row_t('edge_gap', 'm', 'separation of largest tension', forces), &
    row_t('cohesive_stress', 'Pa', 'largest tension', forces), &
    row_t('cohesive_range', 'm', 'depth of the well of contact over cohesive_stress', forces), &
    row_t('barrier_pressure', 'Pa', 'largest repulsion outside the well of contact', forces), &
    row_t('barrier_energy', 'J/m^2', 'energy of the highest barrier', forces), &
    row_t('secondary_minimum_gap', 'm', 'separation of the deepest outer well', forces), &
    row_t('secondary_minimum_energy', 'J/m^2', 'energy of this well', forces), &
    row_t('jkr_pull_off', 'N', 'pull-off of JKR theory, positive', always), &
    row_t('dmt_pull_off', 'N', 'pull-off of DMT theory, positive', always), &
    row_t('maugis_lambda', '', 'Maugis'' parameter, 1.157 times Tabor''s', classical), &
    row_t('maugis_pull_off', 'N', 'pull-off of Maugis-Dugdale theory, positive', classical), &
    row_t('transition_alpha', '', &
      'with carpick or pietrement_troyon: their alpha, 0 for DMT theory, 0.98 for JKR theory'), &
    row_t('carpick_pull_off', 'N', 'with theories = ''carpick'': pull-off, positive', carpick), &
    row_t('carpick_radius', 'm', 'contact radius at zero load by carpick', carpick), &
    row_t('pietrement_troyon_pull_off', 'N', &
      'with theories = ''pietrement_troyon'': pull-off, positive', pietrement_troyon), &
    row_t('pietrement_troyon_radius', 'm', 'contact radius at zero load by pietrement_troyon', &
      pietrement_troyon), &
    row_t('max_tension', 'N', 'largest tension of all branches, positive', always, &
      place='max_tension', quantity=of_tension, error=judged), &
    row_t('max_tension_h0', 'm', 'h0 at the largest tension', always, &
      place='max_tension', quantity=of_h0, error=judged), &
    row_t('max_tension_at_end', '', 'whether max_tension is at an end of a branch or of its ' // &
      'solved rows, and no pull-off (sweep.csv: 1 or 0)', always), &
    row_t('jump_in_h0', 'm', 'h0 of snap-in, the turning point at which approaching ' // &
      'bodies jump into contact', always, place='jump_in', quantity=of_h0, error=judged), &
    row_t('jump_in_load', 'N', 'load just before snap-in', always, &
      place='jump_in', quantity=of_load, error=judged), &
    row_t('jump_in_uncertainty', 'm', &
      'on a fixed grid: uncertainty of jump_in_h0, plus or minus'), &
    row_t('jump_out_h0', 'm', 'h0 of snap-off, at which retracting bodies separate, in the ' // &
      'first unloading with a jump', always, place='jump_out', quantity=of_h0, error=judged), &
    row_t('jump_out_load', 'N', 'load just before snap-off', always, &
      place='jump_out', quantity=of_load, error=judged), &
    row_t('jump_out_uncertainty', 'm', &
      'on a fixed grid: uncertainty of jump_out_h0, plus or minus'), &
    row_t('unload_from', 'm', 'turning point of each unloading', list=.true.), &
    row_t('unload_max_tension', 'N', 'largest tension of each unloading, positive', turning, &
      list=.true., place='unload_max_tension', quantity=of_tension, error=judged), &
    row_t('unload_max_tension_h0', 'm', 'h0 at the largest tension of each unloading', &
      list=.true., place='unload_max_tension', quantity=of_h0, error=judged), &
    row_t('unload_max_tension_at_end', '', 'the same for each unloading, 1 or 0', turning, &
      list=.true.), &
    row_t('unload_jump_out_h0', 'm', 'h0 of snap-off in each unloading', &
      turning, list=.true., place='unload_jump_out', quantity=of_h0, error=judged), &
    row_t('folds_h0', 'm', 'h0 of all folds of the path, in order', list=.true., &
      place='folds', quantity=of_h0, error=judged), &
    row_t('folds_load', 'N', 'load at every fold of the path', list=.true., &
      place='folds', quantity=of_load, error=judged), &
    row_t('criterion_28_error', '', 'with &stability: largest estimated error of the column ' // &
      'criterion_28'), &
    row_t('folds_stable', '', 'whether the path is stable after each fold, 1 or 0', list=.true.), &
    row_t('load_folds_h0', 'm', 'h0 of all extrema of the load along the path', list=.true., &
      place='load_folds', quantity=of_h0, error=judged), &
    row_t('load_folds_load', 'N', 'load at each extremum', list=.true., &
      place='load_folds', quantity=of_load, error=judged), &
    row_t('energy_lost', 'J', 'energy lost in the jumps of a cycle', always, &
      place='energy_lost', quantity=of_energy, error='_uncertainty'), &
    row_t('energy_dissipated', 'J', 'work of a drive in time less the final energy of the bodies', &
      drive, place='energy_dissipated', quantity=of_energy, error=judged), &
    row_t('effective_work_of_adhesion', 'J/m^2', 'largest tension of a drive in time over ' // &
      '1.5 pi R', drive, place='effective_work', quantity=of_work, error=judged), &
    row_t('max_suction', 'Pa', 'largest suction of the draining fluid', fluid, &
      place='max_suction', quantity=of_suction, error=judged), &
    row_t('sigma_relaxed', '', 'strength of adhesion of relaxed viscoelastic bodies', &
      viscoelastic), &
    row_t('time_steps', '', 'number of steps of a drive in time', drive), &
    row_t('path_traced_h0', 'm', &
      'h0 from which the path was traced, if numbers are read from the path'), &
    row_t('path_undeformed_h0', 'm', &
      'h0 from which the bodies were taken as undeformed, down to path_traced_h0'), &
    row_t('device_stiffness', 'N/m', &
      'stiffness of each spring; 0: dead load; Infinity: h0 is prescribed', list=.true.), &
    row_t('device_jump_in_z', 'm', 'position of the base at the first snap-in of each approach', &
      spring, list=.true., place='device_jump_in', quantity=of_position, error=judged), &
    row_t('device_jump_in_load', 'N', 'load just before this jump', spring, list=.true., &
      place='device_jump_in', quantity=of_load, error=judged), &
    row_t('device_jump_in_load_after', 'N', 'load just after this jump', spring, list=.true., &
      place='device_landing_in', quantity=of_load, error=judged), &
    row_t('device_jump_out_z', 'm', 'position of the base at the first snap-off of each retract', &
      spring, list=.true., place='device_jump_out', quantity=of_position, error=judged), &
    row_t('device_jump_out_load', 'N', 'load just before this jump', spring, list=.true., &
      place='device_jump_out', quantity=of_load, error=judged), &
    row_t('device_jump_out_load_after', 'N', 'load just after this jump', spring, list=.true., &
      place='device_landing_out', quantity=of_load, error=judged), &
    row_t('device_energy_lost', 'J', 'energy lost in all jumps of each cycle, bodies and spring', &
      spring, list=.true., place='device_energy', quantity=of_energy, error=judged), &
    row_t('device_cycle_energy', 'J', &
      'the energy lost as the area between approach and retract', list=.true., error=judged), &
    row_t('device_energy_uncertainty', 'J', 'difference of these two, or the error of either', &
      list=.true.), &
    row_t('fixed_load', 'N', 'loads whose equilibria were searched for', list=.true.), &
    row_t('fixed_load_equilibria', '', 'number of equilibria at each load', given_load, &
      list=.true.), &
    row_t('fixed_load_stable', '', 'number of stable equilibria at each load', given_load, &
      list=.true.), &
    row_t('fixed_load_h0', 'm', 'h0 of the stable equilibrium with the smallest h0 at each load', &
      given_load, list=.true., error=judged), &
    row_t('fixed_load_displacement', 'm', 'its displacement', given_load, list=.true., &
      error=judged), &
    row_t('fixed_load_contact_radius', 'm', 'its contact radius', given_load, list=.true., &
      error=judged), &
    row_t('table_load_error', 'N', 'largest estimated error of a load in table.csv'), &
    row_t('table_interpolation_error', 'N', 'largest error of a load between the rows, by ' // &
      'cubic polynomials with their slopes'), &
    row_t('regime_tabor', '', 'the same as tabor', regime), &
    row_t('regime_tabor_range', '', &
      'Tabor''s parameter with the range, work of adhesion over largest tension', regime), &
    row_t('regime_maugis_lambda', '', 'Maugis'' parameter', regime), &
    row_t('regime_load_number', '', &
      'load of the last state over pi times work of adhesion times radius', regime, error=judged), &
    row_t('regime_error_hertz', '', 'errors of Hertz theory: pull-off, contact radius, ' // &
      'indentation over a^2/R', list=.true., error=judged), &
    row_t('regime_error_jkr', '', 'the same for JKR theory', list=.true., error=judged), &
    row_t('regime_error_dmt', '', 'the same for DMT theory', list=.true., error=judged), &
    row_t('regime_error_maugis', '', 'the same for Maugis-Dugdale theory', list=.true., &
      error=judged), &
    row_t('regime_error_hertz_layered', '', 'the same for Hertz theory of layers', list=.true., &
      error=judged), &
    row_t('regime_error_jkr_layered', '', 'the same for JKR theory of layers', list=.true., &
      error=judged), &
    row_t('regime_error_carpick', '', 'the same for Carpick''s formula, which has no indentation', &
      list=.true., error=judged), &
    row_t('regime_error_pietrement', '', 'the same for Pietrement and Troyon''s formula', &
      list=.true., error=judged), &
    row_t('regime_worst_hertz', '', 'the largest of the three errors of Hertz theory', regime), &
    row_t('regime_worst_jkr', '', 'the same for JKR theory', regime), &
    row_t('regime_worst_dmt', '', 'the same for DMT theory', regime), &
    row_t('regime_worst_maugis', '', 'the same for Maugis-Dugdale theory', regime), &
    row_t('regime_worst_hertz_layered', '', 'the same for Hertz theory of layers', &
      layered_regime), &
    row_t('regime_worst_jkr_layered', '', 'the same for JKR theory of layers', layered_regime), &
    row_t('regime_worst_pietrement', '', 'the same for Pietrement and Troyon''s formula', regime), &
    row_t('regime_theory', '', 'recommended theory: 1 Hertz, 2 JKR, 3 DMT, 4 Maugis, 5 and 6 ' // &
      'Hertz and JKR of layers, 0 none', regime), &
    row_t('regime_recommended', '', 'theory with the smallest of the largest errors, or none'), &
    row_t('regime_reason', '', 'reason of the recommendation'), &
    row_t('regime_formula', '', 'of jkr, dmt, carpick and pietrement the nearest in pull-off ' // &
      'and contact radius'), &
    row_t('regime_formula_error', '', 'the larger of its errors in these two', regime), &
    row_t('end_h0', 'm', 'h0 of the last equilibrium of the loading; without a loading, of ' // &
      'the path or drive', always, error=judged), &
    row_t('end_displacement', 'm', 'displacement of the last equilibrium', always, &
      place='end', quantity=of_displacement, error=judged), &
    row_t('end_load', 'N', 'load of the last equilibrium', always, &
      place='end', quantity=of_load, error=judged), &
    row_t('profiles_error', '', 'error of each profile: of gaps over the larger of gap and ' // &
      'law''s length; of pressures over the largest', list=.true., place='profiles', &
      quantity=of_profile), &
    row_t('jump_criterion_29_h0', 'm', &
      'h0 at which approaching bodies first violate (29)', approximations), &
    row_t('jump_criterion_29_load', 'N', 'load at this h0', approximations), &
    row_t('jump_equation_37_h0', 'm', &
      'h0 of the jump by (37), for the attraction alone', approximations), &
    row_t('jump_equation_37_load', 'N', 'load at this h0', approximations), &
    row_t('jump_equation_37_gap', 'm', 'separation on the axis by (37)', approximations), &
    row_t('fold_closed_form_h0', 'm', 'h0 of the fold of (35a)', approximations), &
    row_t('fold_closed_form_load', 'N', 'load at this h0', approximations), &
    row_t('fold_attractive_only_h0', 'm', 'h0 of the fold of (35b)', approximations), &
    row_t('fold_attractive_only_load', 'N', 'load at this h0', approximations), &
    row_t('range_over_radius', '', &
      'range of the force over the radius of the bodies, small in the model', always), &
    row_t('contact_over_radius', '', &
      'largest contact radius over the radius; for other shapes the slope there', always), &
    row_t('classical_over_radius', '', &
      'the same for the largest contact radius in classical.csv'), &
    row_t('pressure_over_stiffness', '', 'largest pressure over the stiffness, about the strain', &
      always), &
    row_t('worst_residual', '', &
      'largest residual of all equilibria, over the law''s length', always), &
    row_t('spacing_over_neck', '', &
      'largest distance of nodes at the contact edge over width of the cohesive zone', always), &
    row_t('resolved', '', 'whether spacing_over_neck is at most 0.2, or 0.4 on a mesh that ' // &
      'moves with the edge (sweep.csv: 1 or 0)', always), &
    row_t('error_estimate', '', 'largest estimated error of all numbers, relative', always), &
    row_t('grid', '', 'grid; none for rigid bodies'), &
    row_t('method', '', 'iteration; integral for rigid bodies'), &
    row_t('chosen_because', '', 'reason of this choice of grid and iteration'), &
    row_t('compiler', '', 'compiler that made the program'), &
    row_t('blas', '', 'library of linear algebra'), &
    row_t('build_options', '', 'options of the compiler'), &
    row_t('warnings', '', 'all warnings of the run', list=.true.), &
    row_t('notes', '', 'further information', list=.true.), &
    row_t('wall_seconds', 's', 'elapsed time, interrupted runs included', group=in_cost), &
    row_t('kernel_seconds', 's', 'time for matrices of the elastic kernel', group=in_cost), &
    row_t('solve_seconds', 's', 'time for equilibria', group=in_cost), &
    row_t('estimate_seconds', 's', 'time for the error estimate', group=in_cost), &
    row_t('threads', '', 'number of threads', group=in_cost), &
    row_t('nodes', '', 'number of nodes of all meshes', group=in_cost), &
    row_t('states', '', 'number of equilibria', group=in_cost), &
    row_t('iterations', '', 'number of iterations over all equilibria', group=in_cost), &
    row_t('kernel_entries', '', 'number of entries of kernel matrices computed', group=in_cost), &
    row_t('pressure_evaluations', '', &
      'number of evaluations of a force or of its slope', group=in_cost), &
    row_t('operator_products', '', 'number of products with a kernel matrix', group=in_cost), &
    row_t('operator_columns', '', 'number of columns in these products', group=in_cost), &
    row_t('factorisations', '', 'number of Jacobians factorised', group=in_cost), &
    row_t('rejected_steps', '', &
      'number of steps rejected by iterations and by the path', group=in_cost)]

contains

  !> The row with a key; 0 if there is none.
  pure integer function row_of(key)
    character(len=*), intent(in) :: key

    do row_of = size(rows), 1, -1
      ! Most keys differ in the first letter, whose comparison needs no call.
      if (rows(row_of)%key(1:1) /= key(1:1)) cycle
      if (rows(row_of)%key == key) return
    end do
  end function row_of

end module result_rows
