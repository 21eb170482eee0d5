!> What speaks against a fit: a model that does not describe the data, unknowns that these cannot
!> tell apart, bounds that decide.
module fit_doubts
  use kinds, only: wp
  use text, only: rounded
  use namelist_writer, only: line_t
  use fit_request, only: unknown_t
  use fit_run, only: fit_outcome_t
  implicit none
  private
  public :: doubts_of

  !> Correlation of unknowns that the data hardly tell apart; least singular value where some
  !> combination of several is not told; error of a logarithm that is no knowledge; residual over
  !> noise that noise cannot make; standard deviations by which jumps may differ.
  real(wp), parameter :: alike = 0.98_wp, lost = 1.0e-3_wp, vague = 0.7_wp, poor = 1.5_wp, &
    far = 4

contains

  !> One line for each doubt.
  function doubts_of(outcome) result(lines)
    type(fit_outcome_t), intent(in) :: outcome
    type(line_t), allocatable :: lines(:)
    character(len=8), parameter :: ways(2) = ['approach', 'retreat ']
    integer :: i, k

    allocate (lines(0))
    associate (fitted => outcome%fitted, curve => outcome%curve)
      if (.not. fitted%found) call add('the search for the best values ended before it had them')
      if (fitted%chi_squared > poor**2*fitted%freedom) call add('what the model leaves is ' // &
        rounded(sqrt(fitted%chi_squared/fitted%freedom)) // ' times the noise: it does not ' // &
        'describe these data, and the true errors are larger than the standard errors')
      do i = 1, size(fitted%value)
        call add_one(curve%unknown(i), i)
        do k = 1, i - 1
          if (abs(fitted%correlation(i, k)) > alike) call add(curve%unknown(k)%name // ' and ' // &
            curve%unknown(i)%name // ' cannot be told apart: their correlation is ' // &
            rounded(fitted%correlation(i, k)) // '; fix one of them, or give a prior')
        end do
      end do
      if (fitted%identifiable < lost) call add('some combination of the parameters cannot be ' // &
        'told from these data: identifiable = ' // rounded(fitted%identifiable))
      do i = 1, 2
        if (curve%data%jump(i)%before == 0) cycle
        if (.not. abs(fitted%jump_z(i)) < huge(1.0_wp)) then
          call add('on the ' // trim(ways(i)) // ' the data jump and the model does not')
        else if (abs(fitted%jump_z(i) - curve%data%jump(i)%z) > &
          far*curve%data%jump(i)%uncertainty) then
          call add('on the ' // trim(ways(i)) // ' the data jump at z = ' // &
            rounded(curve%data%jump(i)%z) // ' m and the model ' // &
            rounded(abs(fitted%jump_z(i) - curve%data%jump(i)%z)) // ' m from there')
        end if
      end do
    end associate

  contains

    !> Of unknown i alone.
    subroutine add_one(unknown, i)
      type(unknown_t), intent(in) :: unknown
      integer, intent(in) :: i

      associate (fitted => outcome%fitted)
        if (unknown%in_log .and. fitted%fitted_deviation(i) > vague) call add('the data say ' // &
          'little of ' // unknown%name // ': it may be larger or smaller by a factor of ' // &
          rounded(exp(min(fitted%fitted_deviation(i), 100.0_wp))))
        associate (low => fitted%end_of(i, unknown, -1.0_wp), &
          high => fitted%end_of(i, unknown, 1.0_wp))
          if (allocated(unknown%lower)) then
            if (low <= unknown%lower) call add(unknown%name // ': its 68 % interval ' // &
              'touches lower = ' // rounded(unknown%lower) // ', which decides and not the data')
          end if
          if (allocated(unknown%upper)) then
            if (high >= unknown%upper) call add(unknown%name // ': its 68 % interval ' // &
              'touches upper = ' // rounded(unknown%upper) // ', which decides and not the data')
          end if
        end associate
      end associate
    end subroutine add_one

    subroutine add(text)
      character(len=*), intent(in) :: text
      type(line_t) :: line

      line%text = text
      lines = [lines, line]
    end subroutine add

  end function doubts_of

end module fit_doubts
