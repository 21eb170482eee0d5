!> The main results of a run in words: pull-off force, snap-in and snap-off with errors and units,
!> and the nearest theory.
module findings
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: wp
  use text, only: rounded
  use units, only: with_unit
  use namelist_writer, only: line_t
  use result_rows, only: row_of
  use summary, only: summary_t
  implicit none
  private
  public :: findings_of

  !> Theories of the pull-off force: their keys of the summary and their names.
  character(len=*), parameter :: keys(*) = [character(len=16) :: 'jkr_pull_off', 'dmt_pull_off', &
    'maugis_pull_off'], names(*) = [character(len=15) :: 'JKR', 'DMT', 'Maugis-Dugdale']

contains

  !> One line for each finding; none if the summary has neither a tension nor a jump.
  function findings_of(summary) result(lines)
    type(summary_t), intent(in) :: summary
    type(line_t), allocatable :: lines(:)
    character(len=:), allocatable :: snaps

    allocate (lines(0))
    if (summary%has('max_tension')) then
      if (summary%number('max_tension_at_end') > 0) then
        call add('largest tension ' // of('max_tension', 'N') // ', in the first or last row: ' // &
          'no pull-off force')
      else
        call add('pull-off force ' // of('max_tension', 'N') // ' at h0 = ' // &
          of('max_tension_h0', 'm'))
        call compare()
      end if
    end if
    snaps = ''
    if (summary%has('jump_in_h0')) snaps = 'snap-in at h0 = ' // of('jump_in_h0', 'm')
    if (summary%has('jump_out_h0')) then
      if (snaps /= '') snaps = snaps // ', '
      snaps = snaps // 'snap-off at h0 = ' // of('jump_out_h0', 'm')
    end if
    if (snaps /= '') call add(snaps)

  contains

    subroutine add(text)
      character(len=*), intent(in) :: text
      type(line_t) :: line

      ! Not by a structure constructor: compiler note 1.
      line%text = text
      lines = [lines, line]
    end subroutine add

    !> The first value of a key as text, with its error if the error is known. Interpolation of a
    !> tabulated force adds an error to the tension.
    function of(key, unit) result(words)
      character(len=*), intent(in) :: key, unit
      character(len=:), allocatable :: words
      real(wp) :: error

      error = summary%error_of(row_of(key), 1)
      if (key == 'max_tension' .and. summary%has('table_error')) &
        error = error + summary%number('table_error')*abs(summary%number(key))
      words = with_unit(summary%number(key), error, unit)
    end function of

    !> Compares the pull-off force with the nearest theory, or with each known one if some are not
    !> known.
    subroutine compare()
      real(wp) :: off(size(keys))
      character(len=:), allocatable :: each
      integer :: i

      off = [(summary%number(trim(keys(i)))/summary%number('max_tension') - 1, i=1, size(keys))]
      ! The theories hold for elastic bodies without a fluid, and for equilibria.
      if (summary%has('time_steps') .or. .not. summary%is_true('converged')) return
      if (.not. any(ieee_is_nan(off))) then
        i = minloc(abs(off), 1)
        call add('the nearest theory, ' // trim(names(i)) // ', has a pull-off force ' // &
          difference(off(i)))
        return
      end if
      each = ''
      do i = 1, size(keys)
        if (ieee_is_nan(off(i))) cycle
        if (each /= '') each = each // ', '
        each = each // 'by ' // trim(names(i)) // ' theory ' // difference(off(i))
      end do
      if (each /= '') call add('pull-off force ' // each)
    end subroutine compare

    !> A relative difference as text.
    function difference(off) result(words)
      real(wp), intent(in) :: off
      character(len=:), allocatable :: words

      words = rounded(100*abs(off)) // ' % ' // trim(merge('larger ', 'smaller', off > 0))
    end function difference

  end function findings_of

end module findings
