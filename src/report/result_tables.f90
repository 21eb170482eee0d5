!> The files of results: when they are written, their contents, and the columns of the tables. The
!> program's option --results lists these, and all entries of summary.nml.
module result_tables
  use result_rows, only: row_t, rows, in_summary, in_cost, turning, spring, given_load, carpick, &
    pietrement_troyon, layered_regime
  implicit none
  private
  public :: columns_of, result_listing

  character(len=1), parameter :: nl = new_line('a')

  !> The definition of the contact radius. For Lennard-Jones the separation there is 1.1 z0.
  character(len=*), parameter :: in_contact = &
    'where the separation is that of zero force plus a tenth of the law''s length; 0: no contact'

  !> For each file a line beginning with '= ': its name, the groups that ask for it, and its
  !> content. The lines of its columns follow, each with 'name [unit] meaning'. After a line
  !> beginning with '+ ' stand columns that exist only in some cases.
  character(len=*), parameter :: tables(*) = [character(len=200) :: &
    '= curve.csv | with &loading, &equilibrium_path or &drive | One row for each equilibrium.', &
    'branch [] loading, unloading_1, unloading_2, ..., path; of a drive approach, dwell, retreat', &
    'h0 [m] separation that undeformed bodies would have on the axis', &
    'h_centre [m] separation on the axis', &
    'displacement [m] h_centre - h0', &
    'load [N] negative: tension', &
    'contact_radius [m] ' // in_contact, &
    'stable [] 1: stable; 0: unstable, or a fold; -1: not examined', &
    'residual [] largest error of the equations, in units of the length of the force law', &
    'iterations [] products with the elastic operator', &
    'converged [] 1; 0 if the residual exceeds the tolerance: the row is not an equilibrium', &
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
    'deformation [m] of each surface, outward positive; the mean if the bodies differ', &
    'pressure [Pa] negative: attraction', &
    'energy [J/m^2] of the surface force', &
    'state [] number of the row of curve.csv with this state, from 1', &
    'stable [] as in curve.csv', &
    '+ of bodies that are not alike', &
    'deformation_1 [m] of the first body''s surface, outward positive', &
    'deformation_2 [m] of the second body''s surface, outward positive', &
    '= approximations.csv | with &approximations | One row for each theory and each h0 at ' // &
      'which it has a state.', &
    'theory [] theory of the row', &
    'h0 [m] separation that undeformed bodies would have on the axis', &
    'displacement [m] separation on the axis less h0', &
    'load [N] negative: tension', &
    'contact_radius [m] NaN if the theory does not give one', &
    '= classical.csv | with &classical | One row for each theory and each h0 at which it ' // &
      'has a state.', &
    'theory [] theory of the row', &
    'h0 [m] separation that undeformed bodies would have on the axis', &
    'displacement [m] separation on the axis less h0', &
    'load [N] negative: tension', &
    'contact_radius [m] NaN if the theory does not give one', &
    '= device.csv | with &device | One row for each equilibrium, for each stiffness.', &
    'stiffness [N/m] of the spring; 0: dead load; Infinity: h0 is prescribed', &
    'direction [] path: all equilibria; approach and retreat: states of the driven bodies', &
    'z [m] position of the drive, h0 - load/stiffness; NaN for a dead load', &
    'h0 [m] separation that undeformed bodies would have on the axis', &
    'load [N] negative: tension', &
    'contact_radius [m] ' // in_contact, &
    'stable [] 1: stable at this z; 0: unstable, or the start of a jump', &
    '= device_jumps.csv | with &device | One row for each jump, for each stiffness.', &
    'stiffness [N/m] of the spring; 0: dead load; Infinity: h0 is prescribed', &
    'direction [] approach or retreat', &
    'z [m] position of the drive; NaN for a dead load', &
    'h0 [m] before the jump', &
    'load [N] before the jump', &
    'contact_radius [m] before the jump', &
    'h0_after [m] after the jump; this and the next two are NaN if no stable state is known', &
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
    'contact_radius [m] ' // in_contact, &
    'stable [] 1: stable at this load; 0: unstable', &
    'h0_error [m] estimated error of h0', &
    'displacement_error [m] estimated error of displacement', &
    'contact_radius_error [m] estimated error of contact_radius', &
    '= table.csv | with &table | One row for each stable state, in and out.', &
    'branch [] approach or retreat; two rows with one h0 and different loads are a jump', &
    'indentation [m] of undeformed bodies, minus h0', &
    'load [N] negative: tension', &
    'contact_radius [m] ' // in_contact, &
    'stiffness [N/m] derivative of load by indentation; NaN at the start of a jump', &
    'indentation_jkr [] over (pi^2 w^2 R/K^2)^(1/3), w work of adhesion, K = 4/3 E*', &
    'load_jkr [] over pi w R', &
    'contact_radius_jkr [] over (pi w R^2/K)^(1/3)', &
    'stiffness_jkr [] derivative of load_jkr by indentation_jkr', &
    '= sensitivity.csv | with &sensitivity | One row for each number that is differentiated ' // &
      'and each parameter.', &
    'quantity [] entry of &summary, or column of a table; in parentheses the value or row', &
    'parameter [] key of the deck', &
    'value [] of the quantity, in its unit', &
    'derivative [] by the parameter, SI units', &
    'logarithmic [] derivative of the logarithm of the quantity by that of the parameter', &
    'derivative_error [] of the derivative: its change with a formula of lower order', &
    '= curve_sensitivity.csv | with &sensitivity | One row for each equilibrium, parameter ' // &
      'and stiffness.', &
    'parameter [] key of the deck', &
    'stiffness [N/m] of the spring; 0: dead load; Infinity: h0 is prescribed', &
    'z [m] position of the drive, h0 - load/stiffness; NaN for a dead load', &
    'h0 [m] separation that undeformed bodies would have on the axis', &
    'load [N] negative: tension', &
    'h0_derivative [] by the parameter at this z, for a dead load at this load; SI units', &
    'load_derivative [] the same for the load; both are NaN where z turns', &
    '= fit.csv | with &fit | One row for each sample of the measured curve.', &
    'direction [] approach or retreat', &
    'z [m] position of the base, as measured; without positions the load, as measured', &
    'measured [] the signal: N, or N/m, V or m as in the file; or a contact radius, m', &
    'model [] the signal of the model, with its baseline', &
    'baseline [] the signal without force', &
    'residual [] measured less model', &
    'used [] 1: in the fit; 0: an outlier, skipped, last before a jump, or within it', &
    'outlier [] 1: it differs from its neighbours by more than noise', &
    'radius [] 1: measured is a contact radius; 0: the signal', &
    '= fit.nml | with &fit | A namelist: &fit, the values found, and a group for each ' // &
      'classical theory, fitted to the same samples.', &
    '= sweep.csv | with &sweep | One row for each case: the values of the keys, then the ' // &
      'entries of &summary marked "in sweep.csv", and failure: why some are missing.', &
    '+ with &fit, for each parameter', &
    'KEY_estimate [] fitted value, in the unit of the key', &
    'KEY_standard_error [] its standard error', &
    'KEY_lower_95 [] lower end of the 95 % interval', &
    'KEY_upper_95 [] upper end of the 95 % interval', &
    '+ with &fit', &
    'fitted_work_of_adhesion [J/m^2] from the fitted values', &
    'fitted_work_of_adhesion_error [J/m^2] its standard error', &
    'fitted_reduced_modulus [Pa] from the fitted values', &
    'fitted_reduced_modulus_error [Pa] its standard error', &
    'fitted_young_of_sample [Pa] from the fitted values', &
    'fitted_young_of_sample_error [Pa] its standard error', &
    'contact_height [m] contact point: position of the base where undeformed bodies touch', &
    'chi_squared [] sum of the squared residuals over the noise', &
    'degrees_of_freedom []', &
    'excess [] standard deviations by which the residuals exceed the noise', &
    'identifiable [] 1: the data tell all parameters apart; 0: they do not', &
    'noise [] standard deviation of the signal', &
    'samples [] in the fit', &
    'outliers [] left out', &
    'warnings [] number of warnings about the fit', &
    'verdict [] of the fit: described, warned, not_described, refused or unreadable', &
    'warning [] the first warning about the fit; blank if there is none', &
    '= costs.csv | with costs in &sweep, or over &numerics | One row for each case: the ' // &
      'values of the keys, time and work, and the estimated errors of numbers in sweep.csv.', &
    'seconds [s] processor time without files; of a short case the least of several runs', &
    'kernel_seconds [s] as in &cost, like the next seven', &
    'solve_seconds [s]', 'estimate_seconds [s]', 'nodes []', 'states []', 'iterations []', &
    'operator_products []', 'factorisations []', &
    'error_estimate [] as in &summary', &
    '= summary.nml | | A namelist: &summary, &cost, and the deck with all defaults.']

contains

  !> The columns that a file always has. With `set`, the columns that it has in addition in this
  !> case.
  pure function columns_of(file, set) result(columns)
    character(len=*), intent(in) :: file
    character(len=*), intent(in), optional :: set
    character(len=96), allocatable :: columns(:)
    logical :: of_file, wanted, listed(size(tables))
    integer :: i

    listed = .false.
    of_file = .false.
    wanted = .false.
    do i = 1, size(tables)
      if (tables(i)(:2) == '= ') then
        of_file = index(tables(i), '= ' // file // ' |') == 1
        wanted = of_file .and. .not. present(set)
      else if (tables(i)(:2) == '+ ') then
        wanted = .false.
        if (present(set)) wanted = of_file .and. tables(i)(3:) == set
      else
        listed(i) = wanted
      end if
    end do
    columns = pack(tables(:)(:len(columns)), listed)
  end function columns_of

  !> For each file a line with its name and the group that asks for it, a line with its content, and
  !> two lines for each column or entry: name and unit, then the meaning.
  pure function result_listing() result(text)
    character(len=:), allocatable :: text
    character(len=len(tables)) :: note
    integer :: i, first, last

    text = ''
    do i = 1, size(tables)
      associate (line => tables(i))
        first = scan(line, '|')
        last = scan(line, '|', back=.true.)
        select case (line(:2))
        case ('= ')
          if (i > 1) text = text // nl
          text = text // trim(line(3:first - 1))
          note = line(first + 2:last - 1)
          if (note /= '') text = text // ' (' // trim(note) // ')'
          text = text // nl // '    ' // trim(line(last + 2:)) // nl
          note = ''
        case ('+ ')
          note = line(3:)
        case default
          first = index(line, ' [')
          last = first + index(line(first:), ']') - 1
          text = text // listed(line(:first - 1), line(first + 2:last - 1), trim(note), &
            line(last + 2:))
        end select
      end associate
    end do
    text = text // nl // '&summary' // nl // '    Results of the run.' // nl // &
      listed_rows(in_summary) // nl // '&cost' // nl // '    Time and work of the run; the ' // &
      'work of a fit is not counted, only its time.' // nl // listed_rows(in_cost)
  end function result_listing

  !> The entries of a group of summary.nml.
  pure function listed_rows(group) result(text)
    integer, intent(in) :: group
    character(len=:), allocatable :: text
    integer :: i

    text = ''
    do i = 1, size(rows)
      if (rows(i)%group /= group) cycle
      text = text // listed(trim(rows(i)%key), trim(rows(i)%unit), sweep_note(rows(i)), &
        rows(i)%meaning)
      if (rows(i)%error /= '') text = text // listed(trim(rows(i)%key) // trim(rows(i)%error), &
        trim(rows(i)%unit), '', 'estimated error of ' // trim(rows(i)%key))
    end do
  end function listed_rows

  !> A note that says when a row is a column of sweep.csv; empty if it never is.
  pure function sweep_note(row) result(note)
    type(row_t), intent(in) :: row
    character(len=:), allocatable :: note

    select case (row%sweep)
    case ('')
      note = ''
    case ('always')
      note = 'in sweep.csv'
    case ('(forces)')
      note = 'in sweep.csv with forces other than a plain &force'
    case (turning)
      note = 'in sweep.csv for each turning point'
    case (spring)
      note = 'in sweep.csv for each stiffness'
    case (given_load)
      note = 'in sweep.csv for each load'
    case (carpick, pietrement_troyon)
      note = 'in sweep.csv with this theory'
    case (layered_regime)
      note = 'in sweep.csv with &regime and &layer'
    case default
      note = 'in sweep.csv with &' // trim(row%sweep)
    end select
  end function sweep_note

  !> The lines of one column or entry.
  pure function listed(name, physical_unit, note, meaning) result(text)
    character(len=*), intent(in) :: name, physical_unit, note, meaning
    character(len=:), allocatable :: text

    text = '  ' // name
    if (physical_unit /= '') text = text // ' [' // physical_unit // ']'
    if (note /= '') text = text // '; ' // note
    text = text // nl
    if (meaning /= '') text = text // repeat(' ', 26) // trim(meaning) // nl
  end function listed

end module result_tables
