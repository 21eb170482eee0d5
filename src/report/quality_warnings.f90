!> Warnings about the numbers in a summary: whether the mesh resolves the cohesive zone, and
!> whether the numbers have the accuracy that the deck asks for. `model_warnings` has those about
!> the model.
module quality_warnings
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use text, only: rounded
  use records, only: quality_t
  use summary, only: summary_t
  use scene_groups, only: scene_t
  use mesh_refinement, only: too_much
  use solver_options, only: usual_tolerance
  use model_warnings, only: judge_model
  use experiment_result, only: experiment_result_t
  use numerics_choice, only: edge_locked
  implicit none
  private
  public :: judge_run

  !> Largest spacing of nodes at the contact edge, in widths of the cohesive zone. With a wider
  !> spacing the edge is pinned between the nodes. A mesh that moves with the edge needs only two
  !> nodes in the zone, which determine a polynomial.
  real(wp), parameter :: resolved_spacing = 0.2_wp, resolved_locked = 0.4_wp

  !> Ratio of the estimated error to the accuracy above which there is a warning; the estimate
  !> includes a safety factor.
  real(wp), parameter :: clearly = 3
  !> Largest power of the radius with which a force is said to fall slowly far away. Up to this
  !> power, derivatives by the power differed from those of whole runs by 1e-5 to 4e-3 at an
  !> accuracy of 1e-6.
  real(wp), parameter :: slow = 4

contains

  !> Checks the states of the experiments, and the accuracy of the numbers.
  subroutine judge_run(scene, problem, outcome, quality, summary)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(experiment_result_t), intent(in) :: outcome
    type(quality_t), intent(in) :: quality
    type(summary_t), intent(inout) :: summary

    call judge_model(problem, quality, summary)
    if (.not. outcome%differentiated) &
      call summary%fail_with('sensitivity: not all derivatives were found')
    call judge_derivatives()
    call judge_resolution(outcome%chosen%grid == edge_locked)
    call judge_accuracy()
    if (outcome%chosen%options%stop_on_change) call judge_change()

  contains

    !> If the iteration stopped on small changes, states that do not solve the equations are a
    !> failure.
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

    !> Warns of parameters that change the power with which a force falls slowly far away. The
    !> quadrature beyond the mesh is accurate only for the power of its own problem.
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

    !> The power of the radius with which the pressure falls far away.
    elemental real(wp) function decay(of)
      type(problem_t), intent(in) :: of

      decay = of%shape%growth*of%law%tail_power
    end function decay

    !> Warns of a cohesive zone that is not resolved, with advice. locked: meshes follow the edge.
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
          ' cohesive zones apart at the contact edge'//advice)
      end associate
    end subroutine judge_resolution

    !> Warns if the numbers do not have the accuracy that the deck asks for. Also warns of residuals
    !> that rounding errors keep above the tolerance, if they matter for displacements as small as
    !> L.
    subroutine judge_accuracy()
      associate (tolerance => outcome%chosen%options%tolerance)
        if (summary%is_true('converged') .and. .not. outcome%chosen%options%stop_on_change .and. &
          quality%residual > max(tolerance, scene%numerics%accuracy, usual_tolerance)) &
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

end module quality_warnings
