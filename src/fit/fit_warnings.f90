!> Warnings about a fit: a model that does not describe the data, unknowns that are correlated or
!> not determined, bounds that decide a value.
module fit_warnings
  use kinds, only: wp
  use text, only: brief, rounded, rounded_to
  use namelist_writer, only: line_t, append
  use fit_request, only: unknown_t, of_spring, fitted_of, is_at_end, farthest_off
  use significance, only: differs, hardly_ever, rarely
  use residual_analysis, only: lack_t
  use fit_errors, only: fitted_t
  use measured_curve, only: measured_curve_t
  use fixed_parameter_test, only: held_t
  use fit_run, only: fit_outcome_t
  use fit_alternatives, only: contact_slope
  use measured_checks, only: open_end, find_saturated
  implicit none
  private
  public :: doubts_of

  !> Limits: the correlation of two unknowns; the smallest singular value; the standard deviation of
  !> a logarithm.
  real(wp), parameter :: alike = 0.98_wp, lost = 1.0e-3_wp, vague = 0.7_wp
  !> A missing part of the baseline is reported if an unknown differs with it and if noise explains
  !> it with a smaller probability than this, counted over all parts. At most one good fit in a
  !> hundred then has a false alarm.
  real(wp), parameter :: unlikely = 0.01_wp
  character(len=*), parameter :: not_described = ': the model does not describe these data, ' // &
    'and the true errors are larger than the standard errors'

contains

  !> The warnings of a fit, one line each.
  function doubts_of(outcome) result(lines)
    type(fit_outcome_t), intent(in) :: outcome
    type(line_t), allocatable :: lines(:)
    logical :: stopped, explained
    integer :: i, k

    allocate (lines(0))
    associate (fitted => outcome%fitted, unknown => outcome%curve%unknown)
      do i = 1, size(fitted%value)
        if (.not. is_at_end(unknown(i), fitted%value(i))) cycle
        ! If the data hardly depend on the unknown, a nearer start does not help.
        if (fitted%lack%is_noise() .and. fitted%fitted_deviation(i) > vague) cycle
        call add(unknown(i)%name // ' ends at ' // rounded(fitted%value(i)) // ', the ' // &
          trim(merge('largest ', 'smallest', fitted_of(unknown(i), fitted%value(i)) > 0)) // &
          ' value that is tried, a factor of ' // &
          rounded(exp(abs(fitted_of(unknown(i), fitted%value(i))))) // &
          ' from the value in the deck: other values may fit better, and standard errors mean ' // &
          'nothing; start nearer')
      end do
      ! The search has stopped at its limits; beyond them the model may describe the data.
      stopped = size(lines) > 0
      if (allocated(outcome%of_all)) call add(outcome%of_all)
      explained = .false.
      if (.not. fitted%found) call add('the search ended before it found the best values')
      if (.not. outcome%resolved) call add('the meshes do not resolve the force law, ' // &
        'and the model is not exact; smoother forces are resolved')
      if (.not. fitted%lack%is_noise()) call add(what_is_left(fitted%lack) // &
        ' times what noise leaves (' // rounded(fitted%lack%excess) // ' standard ' // &
        'deviations more)' // not_described(:merge(0, len(not_described), stopped)))
      ! Noise at its lower bound, which rounding sets, may exceed the residuals without a warning.
      if (fitted%lack%excess < -hardly_ever .and. (outcome%curve%data%noise_is_given .or. &
        outcome%curve%data%noise%deviation > outcome%curve%data%least_noise)) &
        call add(what_is_left(fitted%lack) // ' times what the noise ' // &
        trim(merge('of the deck     ', 'far from contact', outcome%curve%data%noise_is_given)) // &
        ' leaves: the noise is smaller, and the standard errors are larger than the true errors')
      call doubt_spring()
      call doubt_alternative()
      call doubt_baseline()
      if (.not. (stopped .or. explained)) call doubt_held(outcome%held)
      do i = 1, size(fitted%value)
        call doubt_unknown(fitted, unknown(i), i)
        do k = 1, i - 1
          if (abs(fitted%correlation(i, k)) > alike) call add(unknown(k)%name // ' and ' // &
            unknown(i)%name // ' cannot be told apart: their correlation is ' // &
            rounded(fitted%correlation(i, k)) // '; fix one of them, or give a prior')
        end do
      end do
      if (fitted%identifiable < lost) call add('these data do not determine some ' // &
        'combination of the parameters: identifiable = ' // rounded(fitted%identifiable))
    end associate
    if (.not. stopped) call doubt_jumps()
    call doubt_end()
    call doubt_signal()

  contains

    !> Warns about a spring constant that is fitted to forces. If an instrument computed the forces
    !> from deflections, they would change with the spring constant.
    subroutine doubt_spring()
      if (.not. outcome%curve%is_force) return
      if (.not. any(outcome%curve%unknown%role == of_spring)) return
      call add('the signal counts as the force for any spring constant: if it was computed ' // &
        'with spring_constant, give sensitivity = ' // rounded(1/outcome%curve%spring) // &
        ', so that it counts as a deflection')
    end subroutine doubt_spring

    !> Reports another fit that describes the data.
    subroutine doubt_alternative()
      character(len=:), allocatable :: words

      if (.not. allocated(outcome%alternative)) return
      explained = .true.
      associate (other => outcome%alternative)
        words = ' (chi squared ' // rounded_to(other%chi_squared, 1.0_wp) // ' with ' // &
          brief(other%freedom) // ' degrees of freedom)'
        if (other%name == 'spring_constant') then
          call add('with spring_constant = ' // rounded_to(other%value, other%error) // ' +- ' // &
            rounded(other%error) // ' N/m the model describes these data' // words // ': in ' // &
            'contact the load changes by ' // rounded(contact_slope(outcome%curve)) // &
            ' N per metre of the travel, where spring_constant is ' // &
            rounded(outcome%curve%spring) // ' N/m; check it')
        else
          call add('approach and retract disagree, and the model describes the ' // other%name // &
            ' alone' // words // ': fit segment = ''' // other%name // '''')
        end if
      end associate
    end subroutine doubt_alternative

    !> Warns about a part that the baseline lacks. If the model does not describe the data, only a
    !> part that explains most of the excess of chi squared is reported.
    subroutine doubt_baseline()
      character(len=:), allocatable :: words
      integer :: i, k

      if (.not. allocated(outcome%lacking)) return
      if (size(outcome%lacking) == 0) return
      i = minloc(outcome%lacking%chance, 1)
      k = maxloc(abs(outcome%lacking(i)%shift)/outcome%fitted%deviation, 1)
      if (.not. rarely(outcome%lacking(i)%chance) .and. .not. &
        (outcome%lacking(i)%chance < log(unlikely/size(outcome%lacking)) .and. &
        abs(outcome%lacking(i)%shift(k)) > differs*outcome%fitted%deviation(k))) return
      associate (fitted => outcome%fitted, unknown => outcome%curve%unknown, &
        lacking => outcome%lacking(i))
        if (.not. fitted%lack%is_noise() .and. lacking%gain < 0.5_wp*(fitted%chi_squared - &
          fitted%freedom)) return
        explained = .true.
        select case (lacking%name)
        case ('baseline = ''linear''')
          words = 'the baseline has a slope'
        case ('baseline = ''quadratic''')
          words = 'the baseline is bent'
        case ('ripple = .true.')
          words = 'the baseline has a ripple with a period of ' // rounded(lacking%period) // ' m'
        case default
          words = 'the slope of the approach differs from that of the retract on the baseline'
        end select
        if (.not. rarely(lacking%chance)) words = words // ', though this may be chance'
        call add(words // ': ' // lacking%name // ' would lower chi squared by ' // &
          rounded(lacking%gain) // ' and move ' // unknown(k)%name // ' by ' // &
          rounded(lacking%shift(k)) // ' (' // rounded(abs(lacking%shift(k))/ &
          fitted%deviation(k)) // ' standard errors)')
      end associate
    end subroutine doubt_baseline

    !> Warns about the number held fixed by the deck that the data contradict most.
    subroutine doubt_held(held)
      type(held_t), intent(in) :: held(:)
      integer :: i

      if (size(held) == 0) return
      i = maxloc(abs(held%asked), 1)
      if (abs(held(i)%asked) <= hardly_ever) return
      call add('the data ask for a ' // trim(merge('larger ', 'smaller', held(i)%asked > 0)) // &
        ' ' // held(i)%name // ' than the deck has (' // rounded(abs(held(i)%asked)) // &
        ' standard deviations)' // not_described)
    end subroutine doubt_held

    !> Describes the quantity that was compared with the noise: samples, or means over neighbours.
    function what_is_left(lack) result(words)
      type(lack_t), intent(in) :: lack
      character(len=:), allocatable :: words

      words = 'the residual is '
      if (lack%width > 1) words = 'the residual, on average over ' // &
        rounded(real(lack%width, wp)) // ' neighbours, is '
      words = words // rounded(lack%times)
    end function what_is_left

    !> Warns about unknown i alone: a large error, or a bound within the error.
    subroutine doubt_unknown(fitted, unknown, i)
      type(fitted_t), intent(in) :: fitted
      type(unknown_t), intent(in) :: unknown
      integer, intent(in) :: i
      character(len=:), allocatable :: way

      associate (deviation => fitted%fitted_deviation(i))
        if (unknown%in_log .and. deviation > farthest_off) then
          call add('the data do not determine ' // unknown%name // '; fix it, or give a prior')
        else if (unknown%in_log .and. deviation > vague) then
          way = 'larger or smaller'
          if (fitted%side(1, i) <= vague) way = 'larger'
          if (fitted%side(2, i) <= vague) way = 'smaller'
          call add('the data hardly determine ' // unknown%name // ': it may be ' // way // &
            ' by a factor of ' // rounded(exp(deviation)))
        end if
      end associate
      associate (low => fitted%end_of(i, unknown, -1.0_wp), high => fitted%end_of(i, unknown, &
        1.0_wp))
        if (allocated(unknown%lower)) then
          if (low <= unknown%lower) call add(unknown%name // ': its 68 % interval ' // &
            'touches lower = ' // rounded(unknown%lower) // ', so that this bound decides')
        end if
        if (allocated(unknown%upper)) then
          if (high >= unknown%upper) call add(unknown%name // ': its 68 % interval ' // &
            'touches upper = ' // rounded(unknown%upper) // ', so that this bound decides')
        end if
      end associate
    end subroutine doubt_unknown

    !> Warns about a retract that ends before the bodies separate: the model treats the end of this
    !> retract as baseline.
    subroutine doubt_end()
      real(wp) :: below

      associate (data => outcome%curve%data)
        if (.not. (any(data%way == 1) .and. any(data%way == 2))) return
        below = open_end(data%measured%of_signal(), data%noise)
        if (below > 0) call add('the retract ends below the approach by ' // &
          rounded(below/data%noise%deviation) // ' times the noise: if the bodies have not ' // &
          'parted there, measure farther, or fit segment = ''approach''; if the baseline ' // &
          'drifts, correct it')
      end associate
    end subroutine doubt_end

    !> Warns about a signal that stays at its largest or smallest value, as a detector at the end of
    !> its range does.
    subroutine doubt_signal()
      type(measured_curve_t) :: measured
      integer :: first, last
      real(wp) :: step

      measured = outcome%curve%data%measured%of_signal()
      associate (data => outcome%curve%data)
        call find_saturated(measured, data%noise, first, last)
        if (last == 0) return
        associate (z => measured%z(first:last))
          step = (maxval(z) - minval(z))/(size(z) - 1)
          call add('the signal is ' // rounded(measured%signal(last)) // ' in ' // &
            brief(size(z)) // ' samples in a row, and nowhere beyond: if the detector was at ' // &
            'the end of its range, leave them out, skip = ' // rounded_to(minval(z) - step/2, &
            step/10) // ', ' // rounded_to(maxval(z) + step/2, step/10))
        end associate
      end associate
    end subroutine doubt_signal

    !> Warns about jumps of the data that the model has elsewhere or not at all.
    subroutine doubt_jumps()
      character(len=8), parameter :: ways(2) = ['approach', 'retract ']
      real(wp) :: off
      integer :: i

      do i = 1, 2
        associate (jump => outcome%curve%data%jump(i))
          if (jump%before == 0) cycle
          off = abs(outcome%fitted%jump_z(i) - jump%z)
          if (.not. off < huge(1.0_wp)) then
            call add('on the ' // trim(ways(i)) // ' the data jump and the model does not' &
              // not_described)
          else if (off > differs*jump%uncertainty) then
            call add('on the ' // trim(ways(i)) // ' the data jump at z = ' // rounded(jump%z) // &
              ' m and the model ' // rounded(off) // ' m from there (' // &
              rounded(off/jump%uncertainty) // ' standard deviations)' // not_described)
          end if
        end associate
      end do
    end subroutine doubt_jumps

    subroutine add(text)
      character(len=*), intent(in) :: text

      call append(lines, text)
    end subroutine add

  end function doubts_of

end module fit_warnings
