!> Warnings about the numbers in a summary: whether the scene is within the range of its model, with
!> small slopes and strains, whether the mesh resolves the neck, and whether the numbers have the
!> accuracy that the deck asks for.
module quality_warnings
  use kinds, only: wp, pi
  use force_law, only: of_pressure, of_energy
  use dimensionless_problem, only: problem_t, surface_energy, largest_tension
  use text, only: rounded
  use layered_body, only: layered_body_t
  use layered_surface, only: layered_surface_t
  use records, only: quality_t
  use summary, only: summary_t
  use scene_groups, only: scene_t
  use mending, only: too_much
  use experiment_result, only: experiment_result_t
  use numerics_choice, only: edge_locked
  implicit none
  private
  public :: judge_law, judge_run, judge_theories

  !> Parts of the radius that give a note and a warning (a parabola differs from a circle by a
  !> quarter of the square); pressure over stiffness, which is about the strain, that gives a
  !> warning.
  real(wp), parameter :: noted = 0.1_wp, warned = 1.0_wp/3, strained = 0.1_wp

  !> Largest spacing of nodes at the contact edge, in neck widths: with a wider spacing the edge is
  !> pinned between the nodes. On a mesh that moves with the edge it is not pinned; there two nodes
  !> in a neck make a polynomial of it.
  real(wp), parameter :: resolved_spacing = 0.2_wp, resolved_locked = 0.4_wp

  !> Ratio of estimated error and accuracy above which there is a warning: an estimate has a margin
  !> of a factor of two or more.
  real(wp), parameter :: clearly = 3
  !> Residual below which there is no warning.
  real(wp), parameter :: usual_residual = 1.0e-8_wp
  !> Largest power of the position with which a force falls slowly far away: up to here, derivatives
  !> by the power differed from those of whole runs by 1e-5 to 4e-3 at an accuracy of 1e-6.
  real(wp), parameter :: slow = 4

contains

  !> Checks law and shape.
  subroutine judge_law(problem, summary)
    type(problem_t), intent(in) :: problem
    type(summary_t), intent(inout) :: summary

    if (problem%law%caveat /= '') call summary%warn(trim(problem%law%caveat))
    if (problem%law%rest_gap > 0) then
      call take_table_error(problem, summary)
      if (.not. surface_energy(problem) > 0) call summary%warn('contact is only metastable: ' // &
        'the bodies have less energy apart, and no classical theory applies')
    end if
    ! Other shapes than parabolas, circles and ellipses have no radius on the axis.
    if (abs(problem%shape%exponent - 2) > 0) return
    call judge(summary, 'range_over_radius', range_of(problem)/problem%radius, &
      'the range of the force over the radius of the bodies', &
      'Derjaguin''s approximation needs forces of short range')
  end subroutine judge_law

  !> Sets and checks the error that the points of a table leave in the depth of the well and the
  !> largest tension. For hard and for soft bodies the pull-off is proportional to the depth,
  !> between them it depends on both.
  subroutine take_table_error(problem, summary)
    type(problem_t), intent(in) :: problem
    type(summary_t), intent(inout) :: summary
    real(wp) :: of_well(2, 1), of_edge(2, 1), error
    !> Error above which the table, not the mesh, decides the accuracy.
    real(wp), parameter :: coarse = 1.0e-3_wp

    associate (law => problem%law)
      of_well = law%table_error([law%rest_gap])
      if (.not. of_well(2, 1) > 0) return
      error = of_well(2, 1)/max(abs(law%at(of_energy, law%rest_gap)), tiny(1.0_wp))
      if (law%edge_gap > 0) then
        of_edge = law%table_error([law%edge_gap])
        error = max(error, of_edge(1, 1)/max(abs(law%at(of_pressure, law%edge_gap)), tiny(1.0_wp)))
      end if
    end associate
    call summary%set('table_error', error)
    if (error > coarse) call summary%warn('the points of the table are far apart or noisy, or ' // &
      'do not lead into its tail: work of adhesion and pull-off have relative errors of about ' // &
      rounded(error))
  end subroutine take_table_error

  !> Checks the states of the experiments, and the accuracy of the numbers.
  subroutine judge_run(scene, problem, outcome, quality, summary)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(experiment_result_t), intent(in) :: outcome
    type(quality_t), intent(in) :: quality
    type(summary_t), intent(inout) :: summary

    call judge_files()
    call judge_extent()
    call judge_layers()
    if (.not. outcome%differentiated) &
      call summary%fail_with('sensitivity: not all derivatives were found')
    call judge_derivatives()
    call judge_resolution(outcome%chosen%grid == edge_locked)
    call judge_accuracy()
    if (outcome%chosen%options%stop_on_change) call judge_change()

  contains

    !> States where the displacement has stopped changing are a failure if they are not solved.
    subroutine judge_change()
      character(len=:), allocatable :: text

      text = 'the iteration was stopped on a small change of the displacement, which is not ' // &
        'convergence: the largest residual left is ' // rounded(quality%residual) // &
        ' lengths of the force law'
      if (quality%residual <= outcome%chosen%options%tolerance) then
        call summary%warn(text)
      else
        call summary%fail_with(text)
      end if
    end subroutine judge_change

    subroutine judge_extent()
      real(wp) :: strain

      if (quality%contact_radius > 0) call judge(summary, 'contact_over_radius', &
        problem%shape%slope(quality%contact_radius/problem%lateral)*problem%length/ &
        problem%lateral, &
        'the slope at the contact''s edge', 'the model is for half-spaces with small slopes')
      if (problem%rigid .or. .not. quality%pressure > 0) return
      strain = quality%pressure*problem%pressure/problem%stiffness
      call summary%set('pressure_over_stiffness', strain)
      if (strain > strained) call summary%warn('beyond the model: the largest pressure is ' // &
        rounded(strain) // ' of the stiffness; strains are no longer small')
    end subroutine judge_extent

    !> Warns of states beyond the points of a profile or before those of a table.
    subroutine judge_files()
      associate (law => problem%law, last => problem%shape%known_to)
        if (quality%contact_radius/problem%lateral > last) call summary%warn('beyond the file ' // &
          'of &shape: the contact reaches ' // rounded(quality%contact_radius) // ' m from the ' &
          // 'axis, the points ' // rounded(last*problem%lateral) // ' m; there the body goes on ' &
          // 'as a parabola')
        if (.not. law%known_from > 0) return
        if (quality%gap < law%gap_of(law%known_from)) call summary%warn('beyond the file of ' // &
          '&tabulated: gaps are down to ' // rounded(law%separation_of(quality%gap)) // &
          ' m, the points to ' // rounded(law%known_from) // ' m; below, the pressure is a power')
      end associate
    end subroutine judge_files

    !> Warns of parameters that change the power with which a force falls slowly far away: the
    !> mesh's tail integrates only the power of its own problem accurately.
    subroutine judge_derivatives()
      integer :: i

      if (.not. (allocated(scene%varied) .and. allocated(outcome%path))) return
      if (.not. problem%law%tail_power <= slow/problem%shape%growth) return
      do i = 1, size(scene%varied)
        associate (varied => scene%varied(i))
          if (any(abs(decay(varied%problem) - decay(problem)) > 0)) call summary%warn( &
            'sensitivity: ' // varied%parameter%name // ' changes the power of a force that ' // &
            'falls slowly far away; derivatives by it have two to five digits')
        end associate
      end do
    end subroutine judge_derivatives

    !> The power of the position with which the pressure falls far away.
    elemental real(wp) function decay(of)
      type(problem_t), intent(in) :: of

      decay = of%shape%growth*of%law%tail_power
    end function decay

    !> Warns of layers thinner than the range of the force, of soft layers compressed by a part of
    !> their thickness that is not small, and of strains below the top layer that are not small.
    subroutine judge_layers()
      real(wp) :: reach, thinnest, total, strain
      integer :: i

      select type (body => problem%body)
      type is (layered_body_t)
        reach = range_of(problem)
        thinnest = huge(thinnest)
        total = 0
        strain = 0
        do i = 1, 2
          if (size(body%surface(i)%thickness) == 0) cycle
          associate (thickness => body%surface(i)%thickness*problem%lateral)
            thinnest = min(thinnest, minval(thickness))
            total = total + sum(thickness)
            strain = max(strain, strain_below(body%surface(i), thickness, quality%load, &
              quality%contact_radius))
          end associate
        end do
        if (thinnest < reach) call summary%warn('beyond the model: a layer of ' // &
          rounded(thinnest) // ' m is thinner than the range of the force, ' // &
          rounded(reach) // ' m; bulk elasticity does not hold for it')
        if (body%bottom < 1 .and. quality%depth > strained*total) call summary%warn( &
          'beyond the model: the bodies are pressed together by ' // &
          rounded(quality%depth/total) // ' of the thickness of the layers; ' // &
          'strains are no longer small')
        if (strain > strained) call summary%warn('beyond the model: the strain below the ' // &
          'top layer is about ' // rounded(strain) // ', which is not small')
      end select
    end subroutine judge_layers

    !> Estimate of the largest strain below the top layer at a load [N] on a contact radius [m]:
    !> stress over Young's modulus, if the load spreads at 45 degrees.
    pure real(wp) function strain_below(surface, thickness, load, radius) result(strain)
      type(layered_surface_t), intent(in) :: surface
      real(wp), intent(in) :: thickness(:), load, radius
      real(wp), allocatable :: young(:)
      integer :: i

      young = 2*surface%shear*(1 + surface%poisson)
      if (.not. surface%on_rigid) young = [young, 2*surface%base_shear*(1 + surface%base_poisson)]
      strain = 0
      if (.not. radius > 0) return
      do i = 2, size(young)
        strain = max(strain, load/(pi*(radius + sum(thickness(:i - 1)))**2*young(i)))
      end do
    end function strain_below

    !> Warns of a neck that is not resolved, with advice. locked: the mesh is locked to the edge.
    subroutine judge_resolution(locked)
      logical, intent(in) :: locked
      character(len=:), allocatable :: advice
      logical :: resolved

      associate (spacing => quality%spacing)
        if (.not. spacing > 0) return
        resolved = spacing <= merge(resolved_locked, resolved_spacing, locked)
        call summary%set('resolved', resolved)
        if (resolved) return
        if (locked) then
          advice = '; ask for a higher accuracy'
        else
          advice = ', which is then pinned between them; use '// &
            rounded(spacing/resolved_spacing)//' times as many nodes or grid = ''auto'''
        end if
        call summary%warn('under-resolved: nodes are '//rounded(spacing)// &
          ' neck widths apart at the contact edge'//advice)
      end associate
    end subroutine judge_resolution

    !> Warns if the numbers do not have the accuracy that the deck asks for. Warns also of residuals
    !> that rounding keeps above the tolerance, if they matter for displacements of the law's
    !> length.
    subroutine judge_accuracy()
      associate (tolerance => outcome%chosen%options%tolerance)
        if (summary%is_true('converged') .and. .not. outcome%chosen%options%stop_on_change .and. &
          quality%residual > max(tolerance, scene%numerics%accuracy, usual_residual)) &
          call summary%warn('rounding leaves residuals of up to '//rounded(quality%residual)// &
          ' lengths of the force law, above the tolerance of '//rounded(tolerance))
      end associate
      if (outcome%left_out > too_much*scene%numerics%accuracy) &
        call summary%warn('the mesh does not resolve the force law: '//rounded(outcome%left_out)// &
        ' of the load is left out between nodes; smoother forces are resolved')
      if (.not. allocated(outcome%error_estimate)) return
      if (outcome%error_estimate >= 1) then
        call summary%warn('the error could not be estimated: another mesh has no such states, ' // &
          'or these did not converge; the numbers may mean nothing')
      else if (outcome%error_estimate > clearly*scene%numerics%accuracy) then
        call summary%warn('the error is estimated as '//rounded(outcome%error_estimate)// &
          ', above the accuracy of '//rounded(scene%numerics%accuracy)//' asked for')
      end if
    end subroutine judge_accuracy

  end subroutine judge_run

  !> Checks the rows of theories, whose widest contact has this radius [m].
  subroutine judge_theories(problem, contact_radius, summary)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: contact_radius
    type(summary_t), intent(inout) :: summary

    associate (a => contact_radius/problem%lateral, shape => problem%shape)
      call judge(summary, 'classical_over_radius', shape%slope(a)*problem%length/problem%lateral, &
        'the slope at the edge of the widest contact in classical.csv', &
        'the theories are for small slopes')
      if (a > shape%known_to) call summary%warn('beyond the file of &shape: contacts in ' // &
        'classical.csv reach ' // rounded(contact_radius) // ' m from the axis, the points ' // &
        rounded(shape%known_to*problem%lateral) // ' m; there the body goes on as a parabola')
    end associate
  end subroutine judge_theories

  !> Sets a length over the radius, or a slope, and warns if it is not small.
  subroutine judge(summary, key, part, what, why)
    type(summary_t), intent(inout) :: summary
    character(len=*), intent(in) :: key, what, why
    real(wp), intent(in) :: part

    call summary%set(key, part)
    if (part > warned) then
      call summary%warn('beyond the model: ' // what // ' is ' // rounded(part) // '; ' // why)
    else if (part > noted) then
      call summary%note(what // ' is ' // rounded(part) // ', which is not small; ' // why)
    end if
  end subroutine judge

  !> Range of the force [m]: the depth of its well over its largest tension, or the law's length
  !> without attraction.
  pure real(wp) function range_of(problem)
    type(problem_t), intent(in) :: problem

    range_of = problem%length
    if (problem%law%edge_gap > 0 .and. problem%law%adhesion > 0) range_of = &
      problem%law%adhesion*problem%pressure*problem%length/largest_tension(problem)
  end function range_of

end module quality_warnings
