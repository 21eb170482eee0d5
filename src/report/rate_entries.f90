!> The numbers of a drive in time that are reported in the summary.
module rate_entries
  ! The module with most dependencies is first: compiler note 12.
  use scene_groups, only: scene_t
  use kinds, only: wp, long
  use dimensionless_problem, only: problem_t, adhesion_strength
  use experiment_result, only: experiment_result_t
  use reported_values, only: readings_t, read_numbers
  use reported_place, only: of_h0, of_pressure => of_suction
  use summary, only: summary_t
  use text, only: rounded
  implicit none
  private
  public :: summarise_timed

  !> The fraction of the internal variables that the mesh may fail to resolve without a warning. The
  !> gap changes much more smoothly than these variables: in 100 random cycles below this limit no
  !> number was off by more than its error.
  real(wp), parameter :: unresolved = 0.7_wp
  !> Ratio of the effect of the start on the largest tension, both to the error of this tension and
  !> to the accuracy, above which there is a warning.
  real(wp), parameter :: clearly = 3
  !> Atmospheric pressure [Pa].
  real(wp), parameter :: atmosphere = 101325

contains

  !> Adds the numbers of a drive that belong to no solution point, and warnings.
  subroutine summarise_timed(scene, problem, outcome, summary)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(experiment_result_t), intent(in) :: outcome
    type(summary_t), intent(inout) :: summary
    type(readings_t) :: end, suction
    character(len=:), allocatable :: why

    associate (timed => outcome%timed, places => outcome%places)
      if (allocated(scene%creep) .and. problem%law%adhesion > 0) call summary%set( &
        'sigma_relaxed', adhesion_strength(problem)*scene%creep%relaxed())
      if (.not. timed%begun) then
        call summary%fail_with('drive: at z_start the bodies have already jumped into ' // &
          'contact; start farther apart')
        return
      end if
      call summary%set('time_steps', int(timed%steps, long))
      if (timed%lost) then
        if (timed%too_many) then
          why = 'there were too many steps or jumps; the curve ends there. Ask for less ' // &
            'accuracy or longer steps'
        else if (allocated(scene%creep) .or. allocated(scene%fluid)) then
          why = 'no further state was found; the curve ends there. Ask for another accuracy'
        else
          why = 'no further state was found; the curve ends there. Elastic bodies have the ' // &
            'same states at any velocity: use &device or &equilibrium_path'
        end if
        call summary%fail_with('drive: after ' // rounded(timed%lost_at) // ' s ' // why)
        return
      end if
      if (places%has('max_tension')) then
        call summary%set('max_tension_at_end', timed%still_held)
        if (timed%still_held) call summary%warn('drive: the tension is largest at the end, ' // &
          'so it is not the tension at which the bodies separate; raise z_end')
        if (timed%of_start > clearly*max(scene%numerics%accuracy, outcome%error_estimate)) call &
          summary%warn('drive: at z_start the relaxed bodies are already drawn out; what they ' // &
          'keep of this may change max_tension by a part of ' // rounded(timed%of_start) // &
          ', which its error does not include; raise z_start')
      end if
      ! Without a spring h0 is the prescribed position, which has no error.
      end = read_numbers(places, problem, 'end', of_h0)
      if (allocated(scene%drive%stiffness)) call summary%set('end_h0', end%value, end%error, &
        end%rate, end%rate_error)
      if (places%has('max_suction')) then
        suction = read_numbers(places, problem, 'max_suction', of_pressure)
        if (suction%error(1) > suction%value(1)) then
          call summary%warn('drive: max_suction is not determined: the error, ' // &
            rounded(suction%error(1)) // ' Pa, is larger than the suction')
        else if (suction%value(1) > atmosphere) then
          associate (at => timed%suction_at)
            call summary%warn('the fluid is under a suction of ' // rounded(suction%value(1)) // &
              ' Pa after ' // rounded(at(1)) // ' s, at h0 = ' // &
              rounded(problem%law%separation_of(at(2))) // ' m and ' // &
              rounded(at(3)*problem%lateral) // ' m from the axis: more than an atmosphere; a ' // &
              'real fluid may cavitate, which the model does not include')
          end associate
        end if
      end if
      if (timed%memory_tail > unresolved) call summary%warn('the mesh does not resolve the ' // &
        'bodies'' internal variables: ' // rounded(timed%memory_tail) // ' is lost between ' // &
        'nodes; ask for a higher accuracy')
    end associate
  end subroutine summarise_timed

end module rate_entries
