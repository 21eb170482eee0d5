!> The values that a sweep takes, from a range or a list.
module scene_sweep
  use kinds, only: wp
  use failure, only: failure_t
  use text, only: brief
  use scene_groups, only: scene_t
  implicit none
  private
  public :: take_sweep

contains

  !> &sweep: either values, or from, to and count.
  subroutine take_sweep(scene, error)
    type(scene_t), intent(inout) :: scene
    type(failure_t), allocatable, intent(inout) :: error
    character(len=*), parameter :: range_keys(3) = ['from ', 'to   ', 'count']
    character(len=:), allocatable :: scale
    real(wp) :: from, to
    integer :: n, i

    from = 0
    to = 0
    n = 0
    if (.not. scene%deck%has_group('sweep')) return
    allocate (scene%sweep)
    associate (deck => scene%deck, sweep => scene%sweep)
      call deck%get('sweep', 'key', sweep%key)
      call deck%get('sweep', 'values', sweep%values)
      if (size(sweep%values) > 0) then
        do i = 1, size(range_keys)
          if (deck%is_set('sweep', trim(range_keys(i)))) call needless(trim(range_keys(i)))
        end do
        if (deck%is_set('sweep', 'scale')) call needless('scale')
        return
      end if
      do i = 1, size(range_keys)
        if (deck%is_set('sweep', trim(range_keys(i)))) cycle
        call deck%mistake('sweep', trim(range_keys(i)), &
                          'missing; give from, to and count, or values', error)
        return
      end do
      call deck%assume('sweep', 'scale', 'linear')
      call deck%get('sweep', 'from', from)
      call deck%get('sweep', 'to', to)
      call deck%get('sweep', 'count', n)
      call deck%get('sweep', 'scale', scale)
      if (scale == 'log' .and. from <= 0) then
        call deck%mistake('sweep', 'from', brief(from) // ' is not > 0, as scale = ''log'' needs', &
                          error)
      else if (scale == 'log' .and. to <= 0) then
        call deck%mistake('sweep', 'to', brief(to) // ' is not > 0, as scale = ''log'' needs', &
                          error)
      else if (abs(to - from) <= 0) then
        call deck%mistake('sweep', 'to', 'the same as from; a sweep needs two ends', error)
      else if (scale == 'log') then
        sweep%values = exp([(log(from) + (log(to) - log(from))*(i - 1)/(n - 1), i=1, n)])
      else
        sweep%values = [(from + (to - from)*(i - 1)/(n - 1), i=1, n)]
      end if
      if (size(sweep%values) == 0) return
      ! The ends as the user wrote them, without rounding.
      sweep%values(1) = from
      sweep%values(n) = to
    end associate

  contains

    subroutine needless(key)
      character(len=*), intent(in) :: key

      call scene%deck%mistake('sweep', key, 'not together with values; give from, to and ' // &
                              'count, or values', error)
    end subroutine needless

  end subroutine take_sweep

end module scene_sweep
