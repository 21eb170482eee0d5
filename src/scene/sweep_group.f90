!> &sweep: the values that one key takes, from a range or a list.
module sweep_group
  use kinds, only: wp
  use failure, only: failure_t
  use text, only: brief
  use deck, only: deck_t
  use deck_keys, only: key_spec, group, real_key, list_key, integer_key, word_key, text_key
  use scene_groups, only: scene_t
  implicit none
  private
  public :: sweep_keys, take_sweep

contains

  !> Its rows of the table.
  pure function sweep_keys() result(specs)
    type(key_spec), allocatable :: specs(:)

    specs = [ &
      group('sweep', 'The same deck for several values of one key. Either values, or from, to ' // &
            'and count.'), &
      text_key('sweep', 'key', 49, 'The key to vary, as ''group.key''.', required=.true.), &
      real_key('sweep', 'from', '', 'First value, in the unit of the key.'), &
      real_key('sweep', 'to', '', 'Last value.'), &
      integer_key('sweep', 'count', 'Number of values.', 2, 10000), &
      word_key('sweep', 'scale', 'linear log', 'Spacing of the values.', otherwise='linear'), &
      list_key('sweep', 'values', '', 'The values one by one.', most=10000)]
  end function sweep_keys

  !> &sweep: either values, or from, to and count.
  subroutine take_sweep(scene, error)
    type(scene_t), intent(inout) :: scene
    type(failure_t), allocatable, intent(inout) :: error
    character(len=*), parameter :: of_range(4) = ['from ', 'to   ', 'count', 'scale']
    character(len=:), allocatable :: key
    integer :: i

    if (.not. scene%deck%has_group('sweep')) return
    allocate (scene%sweep)
    call scene%deck%get('sweep', 'key', scene%sweep%key)
    call scene%deck%get('sweep', 'values', scene%sweep%values)
    do i = 1, size(of_range)
      key = trim(of_range(i))
      if (size(scene%sweep%values) > 0) then
        if (scene%deck%is_set('sweep', key)) call scene%deck%mistake('sweep', key, &
          'not together with values; give from, to and count, or values', error)
      else if (.not. scene%deck%is_set('sweep', key) .and. key /= 'scale') then
        call scene%deck%mistake('sweep', key, 'missing; give from, to and count, or values', error)
        return
      end if
    end do
    if (size(scene%sweep%values) == 0) call spread_values(scene%deck, scene%sweep%values, error)
  end subroutine take_sweep

  !> The values from `from` to `to`; none where these are wrong.
  subroutine spread_values(deck, values, error)
    type(deck_t), intent(inout) :: deck
    real(wp), allocatable, intent(inout) :: values(:)
    type(failure_t), allocatable, intent(inout) :: error
    character(len=*), parameter :: not_positive = ' is not > 0, as scale = ''log'' needs'
    character(len=:), allocatable :: scale
    real(wp) :: from, to
    integer :: n, i

    from = 0
    to = 0
    n = 0
    call deck%assume('sweep', 'scale', 'linear')
    call deck%get('sweep', 'from', from)
    call deck%get('sweep', 'to', to)
    call deck%get('sweep', 'count', n)
    call deck%get('sweep', 'scale', scale)
    if (scale == 'log' .and. from <= 0) then
      call deck%mistake('sweep', 'from', brief(from) // not_positive, error)
    else if (scale == 'log' .and. to <= 0) then
      call deck%mistake('sweep', 'to', brief(to) // not_positive, error)
    else if (abs(to - from) <= 0) then
      call deck%mistake('sweep', 'to', 'the same as from; a sweep needs two ends', error)
    else
      if (scale == 'log') then
        values = exp([(log(from) + (log(to) - log(from))*(i - 1)/(n - 1), i=1, n)])
      else
        values = [(from + (to - from)*(i - 1)/(n - 1), i=1, n)]
      end if
      ! The ends as the user wrote them, without rounding.
      values(1) = from
      values(n) = to
    end if
  end subroutine spread_values

end module sweep_group
