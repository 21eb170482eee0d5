!> Makes the summary of the results of experiments: numbers in SI units, and warnings.
module summarise
  use kinds, only: long
  use dimensionless_problem, only: problem_t
  use numerics_choice, only: grid_names, unchosen, edge_locked
  use scene_groups, only: scene_t
  use numerics_group, only: coarsest
  use text, only: brief, counted, rounded
  use experiment_result, only: experiment_result_t
  use records, only: quality_t, branch_t
  use path, only: path_t
  use path_readings, only: path_readings_t
  use reported_place, only: place_t, of_h0, of_load
  use tension_at_end, only: judge_tension
  use places, only: places_t
  use reported_values, only: readings_t, read_numbers
  use reported_numbers, only: largest_of, of_table
  use problem_numbers, only: describe_problem
  use result_rows, only: rows
  use summary, only: summary_t
  use classical_rows, only: summarise_classical
  use approximation_tables, only: summarise_approximations
  use reading_rows, only: summarise_device, summarise_fixed_loads
  use regime_rows, only: summarise_regime
  use rate_entries, only: summarise_timed
  use model_warnings, only: judge_law
  use quality_warnings, only: judge_run
  implicit none
  private
  public :: summary_of

contains

  !> The summary of a run. It is made in one statement for each experiment and table.
  type(summary_t) function summary_of(scene, problem, outcome) result(summary)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(experiment_result_t), intent(in) :: outcome
    type(quality_t) :: quality

    call summary%set('title', scene%title)
    call summary%set('converged', .true.)
    if (allocated(scene%varied) .and. .not. allocated(scene%drive)) then
      call describe_problem(problem, summary, scene%varied)
    else
      call describe_problem(problem, summary)
    end if
    call judge_law(problem, summary)
    if (allocated(scene%classical)) call summarise_classical(problem, scene%classical, summary)
    if (allocated(scene%approximations)) call summarise_approximations(problem, summary)
    if (outcome%chosen%grid == unchosen) return
    quality = outcome%quality()
    call describe_numerics()
    call take_places(outcome%places)
    call tell_branches()
    call judge_tension(problem, outcome, summary)
    if (allocated(outcome%timed)) call summarise_timed(scene, problem, outcome, summary)
    if (allocated(outcome%path)) call tell_path(outcome%path)
    if (allocated(outcome%readings)) call take_readings(outcome%readings, outcome%places)
    if (scene%regime) call summarise_regime(problem, outcome%places, summary)
    call judge_run(scene, problem, outcome, quality, summary)

  contains

    !> Adds the numerical methods that were chosen, and the largest residual and error.
    subroutine describe_numerics()
      call summary%set('grid', trim(grid_names(outcome%chosen%grid)))
      call summary%set('method', outcome%chosen%method)
      call summary%set('chosen_because', outcome%chosen%because)
      call summary%set('nodes', int(outcome%nodes, long))
      call summary%set('worst_residual', quality%residual)
      if (quality%spacing > 0) call summary%set('spacing_over_neck', quality%spacing)
      if (allocated(outcome%error_estimate)) &
        call summary%set('error_estimate', outcome%error_estimate)
      associate (numerics => scene%numerics)
        if (outcome%chosen%grid == edge_locked .and. (allocated(numerics%nodes) .or. &
          allocated(numerics%r_max) .or. allocated(numerics%panel_order))) call summary%note( &
          'numerics: nodes, r_max and panel_order have no effect on meshes that follow from ' // &
          'accuracy; grid = ''uniform'' and method = ''mixing'' have fixed ones')
        if (numerics%accuracy > coarsest .and. .not. (problem%rigid .or. &
          allocated(scene%drive))) call summary%note( &
          'numerics: accuracy = ' // brief(numerics%accuracy) // ' costs no less than 1e-3, ' // &
          'whose meshes are the coarsest that have every fold; only drives in time cost less')
      end associate
    end subroutine describe_numerics

    !> Adds all numbers that belong to solution points, with their errors and derivatives. The h0 of
    !> the end is prescribed and has no error.
    subroutine take_places(places)
      type(places_t), intent(in) :: places
      type(readings_t) :: found
      integer :: i

      do i = 1, size(rows)
        if (.not. places%has(rows(i)%place)) cycle
        found = read_numbers(places, problem, rows(i)%place, rows(i)%quantity)
        if (rows(i)%error == '') then
          call summary%set(trim(rows(i)%key), found%value)
        else
          call summary%set(trim(rows(i)%key), found%value, found%error, found%rate, &
            found%rate_error)
        end if
      end do
      if (.not. places%has('end')) return
      found = read_numbers(places, problem, 'end', of_h0)
      call summary%set('end_h0', found%value)
    end subroutine take_places

    subroutine tell_branches()
      integer :: k

      if (allocated(outcome%stepped_path)) call tell_trouble('path', outcome%stepped_path)
      if (allocated(outcome%loading)) then
        call tell_trouble('loading', outcome%loading)
        call tell_uncertainty('jump_in', outcome%loading)
      end if
      if (.not. allocated(outcome%unloading)) return
      call summary%set('unload_from', scene%unloading%from)
      do k = 1, size(outcome%unloading)
        call tell_trouble('unloading_'//brief(k), outcome%unloading(k))
      end do
      do k = 1, size(outcome%unloading)
        if (.not. allocated(outcome%unloading(k)%jump)) cycle
        call tell_uncertainty('jump_out', outcome%unloading(k))
        exit
      end do
    end subroutine tell_branches

    !> Adds the uncertainty of a jump that does not start from a computed fold. The error of its h0
    !> has two parts: the bracket between two states, and the error of the grid.
    subroutine tell_uncertainty(name, branch)
      character(len=*), intent(in) :: name
      type(branch_t), intent(in) :: branch
      type(place_t) :: place
      type(readings_t) :: found

      if (.not. allocated(branch%jump)) return
      if (.not. branch%jump%left(of_h0) > 0) return
      place = outcome%places%place_of(name)
      if (place%turns()) return
      found = read_numbers(outcome%places, problem, name, of_h0)
      call summary%set(name // '_uncertainty', found%error(1))
    end subroutine tell_uncertainty

    subroutine tell_trouble(name, branch)
      character(len=*), intent(in) :: name
      type(branch_t), intent(in) :: branch

      if (branch%unconverged > 0) &
        call summary%fail_with(name//': '//brief(branch%unconverged)//' of '// &
          counted(branch%states, 'state')//' did not converge, the first at h0 = '// &
          rounded(problem%law%separation_of(branch%first_unconverged))// &
          ' m; the largest residual is '//rounded(branch%quality%residual)// &
          ' lengths of the force law; largest tensions, last rows and errors are those of the '// &
          'states that did')
      if (branch%unsure .and. .not. branch%ending%early()) &
        call summary%warn(name//': whether the bodies jump between h0 = '// &
        rounded(problem%law%separation_of(branch%unsure_between(1)))//' m and '// &
        rounded(problem%law%separation_of(branch%unsure_between(2)))// &
        ' m is not known: states there did not converge')
      if (branch%ending%early()) &
        call summary%fail_with(name//' ended early: '//trim(branch%ending%message()))
    end subroutine tell_trouble

    subroutine tell_path(path)
      type(path_t), intent(in) :: path

      if (path%ending%early()) call summary%fail_with('path: '//trim(path%ending%message()))
      if (path%fallen) call summary%warn('path: the bodies fall onto each other ' // &
        'under this law; the path ends there and has no state in contact')
      if (allocated(path%finish) .and. path%deepest_outside < &
        problem%law%gap_of(scene%path%h0_end)) call summary%warn('path: a barrier keeps the ' // &
        'bodies apart down to h0 = ' // rounded(problem%law%separation_of(path%deepest_outside)) &
        // ' m, below h0_end; the path goes there, and ends in the contact within')
      call summary%set('folds_stable', merge(1, 0, path%unstable_after == 0))
    end subroutine tell_path

    subroutine take_readings(readings, places)
      type(path_readings_t), intent(in) :: readings
      type(places_t), intent(in) :: places

      if (readings%traced_from > -huge(readings%traced_from)) call summary%set( &
        'path_traced_h0', problem%law%separation_of(readings%traced_from))
      if (readings%undeformed_from > readings%traced_from) call summary%set( &
        'path_undeformed_h0', problem%law%separation_of(readings%undeformed_from))
      if (.not. readings%solved) &
        call summary%fail_with('some numbers that are read from the path were not solved')
      if (allocated(readings%device)) call summarise_device(problem, readings, places, summary)
      if (places%has('table')) then
        call summary%set('table_load_error', &
          largest_of(places%number, of_table, of_load)*problem%load)
        call summary%set('table_interpolation_error', &
          readings%table_interpolation_error*problem%load)
      end if
      if (allocated(readings%loaded)) call summarise_fixed_loads(problem, scene%fixed_loads, &
        readings, places, summary)
    end subroutine take_readings

  end function summary_of

end module summarise
