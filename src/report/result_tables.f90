!> The files of results: when there is which, what it holds, and the columns of the tables.
module result_tables
  implicit none
  private
  public :: tables, columns_of

  !> A file, after '= ', with when there is one and what it holds; then its columns, each described
  !> as 'name [unit] meaning'. After '+ ' come those that it has in some cases alone.
  character(len=*), parameter :: tables(*) = [character(len=200) :: &
    '= curve.csv | with &loading, &equilibrium_path or &drive | One row for each equilibrium.', &
    'branch [] loading, unloading_1, unloading_2, ..., or path', &
    'h0 [m] separation that undeformed bodies would have on the axis', &
    'h_centre [m] separation on the axis', &
    'displacement [m] h_centre - h0', &
    'load [N] negative: tension', &
    'contact_radius [m] where the separation is 1.1 times that of zero force; 0 without contact', &
    'stable [] 1: stable; 0: unstable, or a fold; -1: not examined', &
    'residual [] largest error of the equations, in units of the length of the force law', &
    'iterations [] products with the elastic operator', &
    'converged [] 1; 0 where the residual is larger than asked for: the row is no equilibrium', &
    '+ with &stability', &
    'smallest_eigenvalue [] of the operator at fixed h0; negative: unstable', &
    'criterion_28 [] largest |2 u p''/p| where surfaces attract; above 1: unstable by (28)', &
    'criterion_29 [] 2 p'' u/p on an axis that attracts; below -1: unstable by (29)', &
    '+ with &drive', &
    'time [s] since the drive began to move', &
    'z [m] position of the base of the spring', &
    '= profiles.csv | with &profiles | One row for each node of each profile, from r = 0 ' // &
      'outward.', &
    'branch [] as in curve.csv', &
    'h0 [m] separation that undeformed bodies would have on the axis', &
    'r [m] distance from the axis', &
    'separation [m] between the surfaces at r', &
    'deformation [m] of each surface, outward positive; of unlike bodies the mean', &
    'pressure [Pa] negative: attraction', &
    'energy [J/m^2] of the surface force', &
    '+ of bodies that are not alike', &
    'deformation_1 [m] of the first body''s surface, outward positive', &
    'deformation_2 [m] of the second body''s surface, outward positive', &
    '= approximations.csv | with &approximations | One row for each theory and each h0 at ' // &
      'which it has a state.', &
    'theory [] where the row comes from', &
    'h0 [m] separation that undeformed bodies would have on the axis', &
    'displacement [m] separation on the axis less h0', &
    'load [N] negative: tension', &
    'contact_radius [m] NaN where the theory does not give one', &
    '= classical.csv | with &classical | One row for each theory and each h0 at which it ' // &
      'has a state.', &
    'theory [] where the row comes from', &
    'h0 [m] separation that undeformed bodies would have on the axis', &
    'displacement [m] separation on the axis less h0', &
    'load [N] negative: tension', &
    'contact_radius [m] NaN where the theory does not give one', &
    '= device.csv | with &device | One row for each equilibrium, for each stiffness.', &
    'stiffness [N/m] of the spring; 0: dead load; Infinity: h0 is prescribed', &
    'direction [] path: all equilibria; approach and retreat: what the drive goes through', &
    'z [m] position of the drive, h0 - load/stiffness; NaN under a dead load', &
    'h0 [m] separation that undeformed bodies would have on the axis', &
    'load [N] negative: tension', &
    'contact_radius [m] where the separation is 1.1 times that of zero force; 0 without contact', &
    'stable [] 1: stable at this z; 0: unstable, or where a jump starts', &
    '= device_jumps.csv | with &device | One row for each jump, for each stiffness.', &
    'stiffness [N/m] of the spring; 0: dead load; Infinity: h0 is prescribed', &
    'direction [] approach or retreat', &
    'z [m] position of the drive; NaN under a dead load', &
    'h0 [m] before the jump', &
    'load [N] before the jump', &
    'contact_radius [m] before the jump', &
    'h0_after [m] NaN where no stable state is known, here and below', &
    'load_after [N] after the jump', &
    'contact_radius_after [m] after the jump', &
    'energy [J] lost in the jump', &
    'z_error [m] estimated error of z', &
    'load_error [N] estimated error of load', &
    'load_after_error [N] estimated error of load_after', &
    '= fixed_load.csv | with &fixed_load | One row for each equilibrium, for each load.', &
    'load [N] negative: tension', &
    'h0 [m] separation that undeformed bodies would have on the axis', &
    'displacement [m] separation on the axis less h0', &
    'contact_radius [m] where the separation is 1.1 times that of zero force; 0 without contact', &
    'stable [] 1: stable under this load; 0: unstable', &
    'h0_error [m] estimated error of h0', &
    'displacement_error [m] estimated error of displacement', &
    'contact_radius_error [m] estimated error of contact_radius', &
    '= table.csv | with &table | One row for each stable state, in and out.', &
    'branch [] approach or retreat; where h0 stays and the load changes the bodies jump', &
    'indentation [m] of undeformed bodies, minus h0', &
    'load [N] negative: tension', &
    'contact_radius [m] where the separation is 1.1 times that of zero force; 0 without contact', &
    'stiffness [N/m] derivative of load by indentation; NaN where a jump starts', &
    'indentation_jkr [] over (pi^2 w^2 R/K^2)^(1/3), w surface energy, K = 4/3 E*', &
    'load_jkr [] over pi w R', &
    'contact_radius_jkr [] over (pi w R^2/K)^(1/3)', &
    'stiffness_jkr [] derivative of load_jkr by indentation_jkr', &
    '= sensitivity.csv | with &sensitivity | One row for each number that is differentiated ' // &
      'and each parameter.', &
    'quantity [] entry of &summary, or column of a table; with a number, of which value or row', &
    'parameter [] key of the deck', &
    'value [] of the quantity, in its unit', &
    'derivative [] by the parameter, SI units', &
    'logarithmic [] derivative of the logarithm of the quantity by that of the parameter', &
    '= curve_sensitivity.csv | with &sensitivity | One row for each equilibrium, parameter ' // &
      'and stiffness.', &
    'parameter [] key of the deck', &
    'stiffness [N/m] of the spring; 0: dead load; Infinity: h0 is prescribed', &
    'z [m] position of the drive, h0 - load/stiffness; NaN under a dead load', &
    'h0 [m] separation that undeformed bodies would have on the axis', &
    'load [N] negative: tension', &
    'h0_derivative [] by the parameter at this z, under a dead load at this load; SI units', &
    'load_derivative [] the same of the load; NaN, as h0_derivative, where z turns round', &
    '= fit.csv | with &fit | One row for each sample of the measured curve.', &
    'direction [] approach or retreat', &
    'z [m] position of the base, as measured', &
    'measured [] the signal: N, or V where the deck has a sensitivity', &
    'model [] the same by the model, with its baseline', &
    'baseline [] the signal without force', &
    'residual [] measured less model', &
    'used [] 1: the sample counts; 0: an outlier, skipped, last before a jump, or within it', &
    'outlier [] 1: it stands apart from its neighbours by more than noise', &
    '= fit.nml | with &fit | A namelist: &fit, the values found, and a group for each ' // &
      'classical theory, fitted to the same samples.', &
    '= sweep.csv | with &sweep | One row for each case: the values of the keys, then the ' // &
      'entries of &summary marked "in sweep.csv", and failure: why a case has not all of them.', &
    '= summary.nml | | A namelist: &summary, &cost, and the deck with every default.']

contains

  !> The columns of a file; with `set` those of that case.
  pure function columns_of(file, set) result(columns)
    character(len=*), intent(in) :: file
    character(len=*), intent(in), optional :: set
    character(len=96), allocatable :: columns(:)
    logical :: of_file, wanted
    integer :: i

    allocate (columns(0))
    of_file = .false.
    wanted = .false.
    do i = 1, size(tables)
      if (tables(i)(:2) == '= ') then
        of_file = index(tables(i), '= ' // file // ' |') == 1
        wanted = of_file .and. .not. present(set)
      else if (tables(i)(:2) == '+ ') then
        wanted = .false.
        if (present(set)) wanted = of_file .and. tables(i)(3:) == set
      else if (wanted) then
        columns = [columns, tables(i)(:96)]
      end if
    end do
  end function columns_of

end module result_tables
