!> A description of a fit in words, for the terminal.
module fit_words
  use kinds, only: wp, nan
  use units, only: with_unit
  use text, only: brief, rounded, rounded_to, counted
  use namelist_writer, only: line_t
  use fit_errors, only: fitted_t
  use derived_numbers, only: derived_t
  use fit_run, only: fit_outcome_t
  implicit none
  private
  public :: words_of_fit

  !> Two fits are equally good if their values of chi squared differ by no more than `as_well`. A
  !> part of the baseline that noise can hide is reported if it would move an unknown by more than
  !> `far` standard errors.
  real(wp), parameter :: as_well = 4, far = 4
  !> Largest relative difference between a fitted value and a derived number that count as the same.
  real(wp), parameter :: same = 1.0e-9_wp

contains

  !> The description of a fit. doubts: the warnings about it.
  function words_of_fit(outcome, doubts) result(lines)
    type(fit_outcome_t), intent(in) :: outcome
    type(line_t), intent(in) :: doubts(:)
    type(line_t), allocatable :: lines(:)
    type(line_t) :: line
    character(len=:), allocatable :: unit
    integer :: i

    allocate (lines(0))
    associate (curve => outcome%curve)
      unit = curve%data%measured%signal_unit()
      if (curve%data%measured%under_loads()) unit = 'm'
      line%text = counted(size(curve%data%sample), 'sample') // ', noise ' // &
        with_unit(curve%data%noise%deviation, nan, unit) // &
        ', correlation of neighbours ' // &
        rounded(curve%data%noise%correlation(1)) // ', ' // counted(count( &
        curve%data%measured%outlier()), 'outlier') // ' left out'
      lines = [lines, line]
      do i = 1, size(curve%unknown)
        if (is_derived(curve%unknown(i)%unit, outcome%fitted%value(i))) cycle
        line%text = curve%unknown(i)%name // ' = ' // with_unit(outcome%fitted%value(i), &
          outcome%fitted%deviation(i), curve%unknown(i)%unit)
        lines = [lines, line]
      end do
      if (any(curve%data%measured%rested)) then
        line%text = counted(count(curve%data%measured%rested), 'sample') // ' at the turn left ' &
          // 'out: the load changes there while the base rests'
        lines = [lines, line]
      end if
    end associate
    do i = 1, size(outcome%derived)
      line%text = words_of(outcome%derived(i))
      lines = [lines, line]
    end do
    if (allocated(outcome%lacking) .and. outcome%fitted%lack%is_noise()) call tell_hidden()
    line%text = 'the residuals are ' // rounded(left_of(outcome%fitted)) // ' times the noise'
    do i = 1, size(outcome%theory)
      associate (theory => outcome%theory(i))
        if (.not. allocated(theory%fitted%effect)) cycle
        line%text = line%text // '; by ' // trim(theory%theory) // ' ' // &
          rounded(left_of(theory%fitted))
      end associate
    end do
    lines = [lines, line]
    do i = 1, size(outcome%theory)
      associate (theory => outcome%theory(i))
        if (.not. allocated(theory%fitted%effect) .or. .not. theory%fitted%lack%is_noise()) cycle
        if (theory%fitted%chi_squared > outcome%fitted%chi_squared + as_well) cycle
        line%text = trim(theory%theory) // ', which has no force before contact, describes ' // &
          'these data ' // trim(merge('better ', 'as well', theory%fitted%chi_squared < &
          outcome%fitted%chi_squared - as_well)) // ': chi squared ' // &
          rounded_to(theory%fitted%chi_squared, 1.0_wp) // ' against ' // &
          rounded_to(outcome%fitted%chi_squared, 1.0_wp)
        lines = [lines, line]
      end associate
    end do

  contains

    !> Whether a fitted value is one of the derived numbers, each of which has a line of its own.
    logical function is_derived(unit, value)
      character(len=*), intent(in) :: unit
      real(wp), intent(in) :: value
      integer :: k

      is_derived = .false.
      do k = 1, size(outcome%derived)
        if (outcome%derived(k)%unit == unit .and. abs(outcome%derived(k)%value - value) <= &
          same*abs(value)) is_derived = .true.
      end do
    end function is_derived

    !> Reports the part of the baseline, hidden in the noise, that would move an unknown farthest.
    !> Nothing is reported if a warning names a part that the data show.
    subroutine tell_hidden()
      real(wp) :: moves, most
      integer :: i, k, part, unknown

      do i = 1, size(outcome%lacking)
        do k = 1, size(doubts)
          if (index(doubts(k)%text, outcome%lacking(i)%name // ' would lower') > 0) return
        end do
      end do
      most = far
      part = 0
      do i = 1, size(outcome%lacking)
        do k = 1, size(outcome%lacking(i)%hidden)
          moves = abs(outcome%lacking(i)%hidden(k))/outcome%fitted%deviation(k)
          if (.not. moves > most) cycle
          most = moves
          part = i
          unknown = k
        end do
      end do
      if (part == 0) return
      line%text = 'a baseline that needs ' // outcome%lacking(part)%name // &
        ' by as little as noise hides would move ' // outcome%curve%unknown(unknown)%name // &
        ' by ' // rounded(most) // ' standard errors: if it may be so, give this key, and the ' // &
        'errors include it'
      lines = [lines, line]
    end subroutine tell_hidden

  end function words_of_fit

  !> A derived number as text, with the assumption about Poisson's ratio.
  function words_of(derived) result(words)
    type(derived_t), intent(in) :: derived
    character(len=:), allocatable :: words

    words = with_unit(derived%value, derived%error, derived%unit)
    select case (derived%name)
    case ('work_of_adhesion')
      words = 'work of adhesion ' // words
    case ('reduced_modulus')
      words = 'reduced modulus ' // words
    case default
      words = 'Young''s modulus of the sample ' // words // ' (nu = ' // brief(derived%poisson)
      if (derived%of_deck) then
        words = words // ', from &bodies)'
      else
        words = words // ', rigid tip; for others give young and poisson in &bodies)'
      end if
    end select
  end function words_of

  !> Ratio of the standard deviation of the residuals of a fit to that of the noise.
  pure real(wp) function left_of(fitted)
    type(fitted_t), intent(in) :: fitted

    left_of = sqrt(fitted%chi_squared/max(1, fitted%freedom))
  end function left_of

end module fit_words
