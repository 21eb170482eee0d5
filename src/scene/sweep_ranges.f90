!> The values of the keys of a sweep from `from`, `to`, `count` and `scale` of &sweep.
module sweep_ranges
  use kinds, only: wp
  use text, only: brief, counted, quoted, word_count, word_of
  use deck, only: deck_t
  use scene_groups, only: axis_t
  implicit none
  private
  public :: take_ranges

contains

  !> The values of keys from their ranges; none after a mistake.
  subroutine take_ranges(deck, axis, keys)
    type(deck_t), intent(inout) :: deck
    type(axis_t), intent(inout) :: axis(:)
    integer, intent(in) :: keys(:)
    real(wp), allocatable :: from(:), to(:), number(:)
    character(len=:), allocatable :: scales
    integer :: i

    call deck%assume('sweep', 'scale', 'linear')
    call deck%get('sweep', 'from', from)
    call deck%get('sweep', 'to', to)
    call deck%get('sweep', 'count', number)
    call deck%get('sweep', 'scale', scales)
    call check_size('from', size(from))
    call check_size('to', size(to))
    call check_size('count', size(number))
    if (word_count(scales) /= 1) call check_size('scale', word_count(scales))
    if (allocated(deck%error)) return
    do i = 1, size(keys)
      call spread_values(deck, from(i), to(i), number(i), &
        word_of(scales, min(i, word_count(scales))), axis(keys(i))%values)
    end do

  contains

    !> Refuses a list without exactly one item for each key.
    subroutine check_size(key, items)
      character(len=*), intent(in) :: key
      integer, intent(in) :: items

      if (items == size(keys)) return
      if (items == 0) then
        call deck%mistake('sweep', key, 'missing; give from, to and count, or values')
      else
        call deck%mistake('sweep', key, brief(items) // ' for ' // counted(size(keys), 'key') // &
          '; give one for each')
      end if
    end subroutine check_size

  end subroutine take_ranges

  !> The values from `from` to `to`; none after a mistake.
  subroutine spread_values(deck, from, to, number, scale, values)
    type(deck_t), intent(inout) :: deck
    real(wp), intent(in) :: from, to, number
    character(len=*), intent(in) :: scale
    real(wp), allocatable, intent(inout) :: values(:)
    character(len=*), parameter :: not_positive = ' is not > 0, as scale = ''log'' needs'
    integer :: n, i

    allocate (values(0))
    n = nint(number)
    if (abs(number - n) > 0) then
      call deck%mistake('sweep', 'count', brief(number) // ' is not a whole number')
    else if (scale /= 'log' .and. scale /= 'linear') then
      call deck%mistake('sweep', 'scale', quoted(scale) // ' is neither linear nor log')
    else if (scale == 'log' .and. from <= 0) then
      call deck%mistake('sweep', 'from', brief(from) // not_positive)
    else if (scale == 'log' .and. to <= 0) then
      call deck%mistake('sweep', 'to', brief(to) // not_positive)
    else if (abs(to - from) <= 0) then
      call deck%mistake('sweep', 'to', 'the same as from; a sweep needs two ends')
    else
      if (scale == 'log') then
        values = exp([(log(from) + (log(to) - log(from))*(i - 1)/(n - 1), i=1, n)])
      else
        values = [(from + (to - from)*(i - 1)/(n - 1), i=1, n)]
      end if
      ! The ends without rounding.
      values(1) = from
      values(n) = to
    end if
  end subroutine spread_values

end module sweep_ranges
