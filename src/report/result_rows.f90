!> The one table of what a run reports: summary.nml, the columns of sweep.csv and what Python reads
!> follow it. A new number is one row here and one `set` where it is known (`summarise`).
module result_rows
  implicit none
  private
  public :: row_t, rows, row_of, in_summary, in_cost

  !> The group of summary.nml that a row belongs to.
  integer, parameter :: in_summary = 1, in_cost = 2
  !> When a row is a column of sweep.csv: never, always, with a group of the deck, or once for each
  !> turning point.
  character(len=*), parameter :: never = '', always = 'always', classical = 'classical', &
    approximations = 'approximations', turning = 'unloading'

  !> Key, unit and meaning; a list has one value a turning point, fold, profile or the like.
  type :: row_t
    character(len=28) :: key = ''
    character(len=5) :: unit = ''
    character(len=72) :: meaning = ''
    character(len=14) :: sweep = never
    integer :: group = in_summary
    logical :: list = .false.
  end type row_t

  !> In the order in which they are written.
  type(row_t), parameter :: rows(*) = [ &
    row_t('title', '', 'title of the scene'), &
    row_t('version', '', 'of the program'), &
    row_t('converged', '', 'whether every equilibrium was found, 1 or 0', always), &
    row_t('sigma', '', 'parameter (40) of the paper', always), &
    row_t('tabor', '', 'Tabor parameter', always), &
    row_t('big_lambda', '', 'parameter (39) of the paper', always), &
    row_t('surface_energy', 'J/m^2', 'depth of the energy minimum', always), &
    row_t('jkr_pull_off', 'N', 'pull-off of JKR theory, positive', always), &
    row_t('dmt_pull_off', 'N', 'pull-off of DMT theory, positive', always), &
    row_t('maugis_lambda', '', 'parameter of Maugis-Dugdale theory', classical), &
    row_t('maugis_pull_off', 'N', 'pull-off of Maugis-Dugdale theory', classical), &
    row_t('max_tension', 'N', 'largest tension, positive', always), &
    row_t('max_tension_h0', 'm', 'where', always), &
    row_t('max_tension_error', 'N', 'estimated error'), &
    row_t('max_tension_h0_error', 'm', 'estimated error'), &
    row_t('jump_in_h0', 'm', 'where the bodies jump into contact', always), &
    row_t('jump_in_load', 'N', 'just before', always), &
    row_t('jump_in_h0_error', 'm', 'estimated error'), &
    row_t('jump_in_load_error', 'N', 'estimated error'), &
    row_t('jump_in_uncertainty', 'm', 'how closely it was bracketed on a fixed grid'), &
    row_t('jump_out_h0', 'm', 'where they jump apart', always), &
    row_t('jump_out_load', 'N', 'just before', always), &
    row_t('jump_out_h0_error', 'm', 'estimated error'), &
    row_t('jump_out_load_error', 'N', 'estimated error'), &
    row_t('jump_out_uncertainty', 'm', 'how closely it was bracketed on a fixed grid'), &
    row_t('unload_from', 'm', 'turning points', list=.true.), &
    row_t('unload_max_tension', 'N', 'largest tension of each unloading', turning, list=.true.), &
    row_t('unload_max_tension_h0', 'm', 'where', list=.true.), &
    row_t('unload_jump_out_h0', 'm', 'where each unloading jumps apart', turning, list=.true.), &
    row_t('unload_max_tension_error', 'N', 'estimated error', list=.true.), &
    row_t('unload_max_tension_h0_error', 'm', 'estimated error', list=.true.), &
    row_t('unload_jump_out_h0_error', 'm', 'estimated error', list=.true.), &
    row_t('folds_h0', 'm', 'all folds of the path, in order', list=.true.), &
    row_t('folds_load', 'N', 'the load there', list=.true.), &
    row_t('folds_stable', '', 'whether what follows is stable, 1 or 0', list=.true.), &
    row_t('folds_h0_error', 'm', 'estimated error', list=.true.), &
    row_t('folds_load_error', 'N', 'estimated error', list=.true.), &
    row_t('load_folds_h0', 'm', 'all extrema of the load along the path', list=.true.), &
    row_t('load_folds_load', 'N', 'the load there', list=.true.), &
    row_t('load_folds_h0_error', 'm', 'estimated error', list=.true.), &
    row_t('load_folds_load_error', 'N', 'estimated error', list=.true.), &
    row_t('energy_lost', 'J', 'in the jumps of a cycle', always), &
    row_t('energy_lost_uncertainty', 'J', 'how well it is known'), &
    row_t('end_h0', 'm', 'of the last equilibrium of the loading, or else of the path', always), &
    row_t('end_displacement', 'm', 'there', always), &
    row_t('end_load', 'N', 'there', always), &
    row_t('end_displacement_error', 'm', 'estimated error'), &
    row_t('end_load_error', 'N', 'estimated error'), &
    row_t('profiles_error', '', 'of gaps (law''s lengths) or pressures (over the largest)', &
          list=.true.), &
    row_t('jump_criterion_29_h0', 'm', 'where approaching bodies violate (29)', approximations), &
    row_t('jump_criterion_29_load', 'N', 'there', approximations), &
    row_t('jump_equation_37_h0', 'm', 'by (37), for the attraction alone', approximations), &
    row_t('jump_equation_37_load', 'N', 'there', approximations), &
    row_t('jump_equation_37_gap', 'm', 'separation (37) on the axis', approximations), &
    row_t('fold_closed_form_h0', 'm', 'least h0 of (35a)', approximations), &
    row_t('fold_closed_form_load', 'N', 'there', approximations), &
    row_t('fold_attractive_only_h0', 'm', 'least h0 of (35b)', approximations), &
    row_t('fold_attractive_only_load', 'N', 'there', approximations), &
    row_t('worst_residual', '', 'in units of the length of the force law', always), &
    row_t('spacing_over_neck', '', 'distance of nodes at the contact edge over the neck', always), &
    row_t('resolved', '', 'whether the mesh is fine enough, 1 or 0', always), &
    row_t('error_estimate', '', 'largest estimated error of a number, relative', always), &
    row_t('grid', '', 'the grid in use'), &
    row_t('method', '', 'the iteration in use'), &
    row_t('chosen_because', '', 'why'), &
    row_t('compiler', '', 'that made the program'), &
    row_t('blas', '', 'its linear algebra'), &
    row_t('build_options', '', 'of the compiler'), &
    row_t('warnings', '', 'all that is not as it should be', list=.true.), &
    row_t('wall_seconds', 's', 'from the beginning to the end', group=in_cost), &
    row_t('kernel_seconds', 's', 'for kernels', group=in_cost), &
    row_t('solve_seconds', 's', 'for equilibria', group=in_cost), &
    row_t('estimate_seconds', 's', 'for the error estimate', group=in_cost), &
    row_t('threads', '', 'in use', group=in_cost), &
    row_t('nodes', '', 'of all meshes', group=in_cost), &
    row_t('states', '', 'equilibria', group=in_cost), &
    row_t('iterations', '', 'of all of them', group=in_cost), &
    row_t('kernel_entries', '', 'computed', group=in_cost), &
    row_t('pressure_evaluations', '', 'of the force law, or of its slope', group=in_cost), &
    row_t('operator_products', '', 'with the matrix of the kernel', group=in_cost), &
    row_t('operator_columns', '', 'that these took part in', group=in_cost), &
    row_t('factorisations', '', 'of Jacobians', group=in_cost), &
    row_t('rejected_steps', '', 'of iterations and of the path', group=in_cost)]

contains

  !> The row with a key; 0 if there is none.
  pure integer function row_of(key)
    character(len=*), intent(in) :: key

    do row_of = size(rows), 1, -1
      if (rows(row_of)%key == key) return
    end do
  end function row_of

end module result_rows
