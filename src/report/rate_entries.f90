!> The numbers of a drive in time in the summary.
module rate_entries
  ! The module with most dependencies is first: compiler note 12.
  use scene_groups, only: scene_t
  use kinds, only: wp, long
  use dimensionless_problem, only: problem_t, adhesion_strength
  use timed_record, only: timed_result_t, numbers, of_tension, of_tension_h0, of_end_h0, &
    of_end_load, of_end_displacement, of_dissipation, of_suction, of_work
  use summary, only: summary_t
  use text, only: rounded
  implicit none
  private
  public :: summarise_timed, si_numbers

  !> The part of the memory that the mesh may fail to resolve without a warning. Its effect on the
  !> gap is much smoother: in 100 random cycles with less no number was off by more than its error.
  real(wp), parameter :: unresolved = 0.7_wp
  !> Effect of the start on the largest tension, over its error and over the accuracy, above which
  !> there is a warning.
  real(wp), parameter :: clearly = 3
  !> Atmospheric pressure [Pa].
  real(wp), parameter :: atmosphere = 101325

contains

  !> Adds numbers, errors and warnings of a drive.
  subroutine summarise_timed(scene, problem, timed, summary)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(timed_result_t), intent(in) :: timed
    type(summary_t), intent(inout) :: summary
    character(len=:), allocatable :: why

    if (allocated(scene%creep) .and. problem%law%adhesion > 0) call summary%set('sigma_relaxed', &
      adhesion_strength(problem)*scene%creep%relaxed())
    if (.not. timed%begun) then
      call summary%fail_with('drive: at z_start the bodies have already jumped into contact; ' // &
        'start farther apart')
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
        why = 'no further state was found; the curve ends there. Elastic bodies have the same ' // &
          'states at any velocity: use &device or &equilibrium_path'
      end if
      call summary%fail_with('drive: after ' // rounded(timed%lost_at) // ' s ' // why)
      return
    end if
    if (allocated(timed%not_rated)) call summary%fail_with('sensitivity: a run with another ' // &
      timed%not_rated // ' did not come to its end; not all derivatives were found')
    if (timed%number(of_tension) > 0) then
      call take('max_tension', of_tension)
      call take('max_tension_h0', of_tension_h0)
      if (problem%shape%parabolic) call take('effective_work_of_adhesion', of_work)
      call summary%set('max_tension_at_end', timed%still_held)
      if (timed%still_held) call summary%warn('drive: the tension is largest at the end, so ' // &
        'it is not the tension at which the bodies separate; raise z_end')
      if (timed%of_start > clearly*max(scene%numerics%accuracy, timed%estimate)) call &
        summary%warn('drive: at z_start the relaxed bodies are already drawn out; what they keep ' &
        // 'of this may change max_tension by a part of ' // rounded(timed%of_start) // &
        ', which its error does not include; raise z_start')
    end if
    call take('energy_dissipated', of_dissipation)
    ! Without a spring h0 is that of the drive, without an error.
    if (allocated(scene%drive%stiffness)) then
      call take('end_h0', of_end_h0)
    else
      call summary%set('end_h0', problem%law%separation_of(timed%number(of_end_h0)))
    end if
    call take('end_displacement', of_end_displacement)
    call take('end_load', of_end_load)
    if (allocated(scene%fluid)) then
      call take('max_suction', of_suction)
      if (timed%error(of_suction) > timed%number(of_suction)) then
        call summary%warn('drive: max_suction is not determined: the error, ' // &
          rounded(timed%error(of_suction)*problem%pressure) // ' Pa, is larger than the suction')
      else if (timed%number(of_suction)*problem%pressure > atmosphere) then
        associate (at => timed%suction_at)
          call summary%warn('the fluid is under a suction of ' // &
            rounded(timed%number(of_suction)*problem%pressure) // ' Pa after ' // &
            rounded(at(1)) // ' s, at h0 = ' // rounded(problem%law%separation_of(at(2))) // &
            ' m and ' // rounded(at(3)*problem%lateral) // ' m from the axis: more than an ' // &
            'atmosphere; a real fluid may cavitate, which the model does not include')
        end associate
      end if
    end if
    if (timed%memory_tail > unresolved) call summary%warn('the mesh does not resolve the ' // &
      'memory of the bodies: ' // rounded(timed%memory_tail) // ' of it is lost between ' // &
      'nodes; ask for a higher accuracy')

  contains

    !> Adds a number with its error and derivatives.
    subroutine take(key, which)
      character(len=*), intent(in) :: key
      integer, intent(in) :: which
      real(wp) :: number(1), error(1)
      real(wp), allocatable :: rate(:, :)

      associate (si => si_numbers(problem, timed), units => units_of(problem))
        number = si(which)
        error = timed%error(which)*units(which)
      end associate
      allocate (rate(0, 1))
      if (allocated(timed%rate)) rate = timed%rate(:, which:which)
      call summary%set(key, number, error, rate, 0*rate)
    end subroutine take

  end subroutine summarise_timed

  !> The numbers of a drive in SI units.
  pure function si_numbers(problem, timed) result(si)
    type(problem_t), intent(in) :: problem
    type(timed_result_t), intent(in) :: timed
    real(wp) :: si(numbers)

    si = timed%number*units_of(problem)
    si([of_tension_h0, of_end_h0]) = &
      problem%law%separation_of(timed%number([of_tension_h0, of_end_h0]))
  end function si_numbers

  pure function units_of(problem) result(units)
    type(problem_t), intent(in) :: problem
    real(wp) :: units(numbers)

    units([of_tension, of_end_load]) = problem%load
    units([of_tension_h0, of_end_h0, of_end_displacement]) = problem%length
    units(of_dissipation) = problem%load*problem%length
    units(of_suction) = problem%pressure
    units(of_work) = problem%load/problem%radius
  end function units_of

end module rate_entries
