!> Bounds and prior standard deviations of the unknowns of &fit.
module unknown_bounds
  use kinds, only: wp
  use deck, only: deck_t
  use deck_keys, only: key_spec
  use fit_request, only: unknown_t, of_contact_point, inside
  implicit none
  private
  public :: take_range, take_bounds

contains

  !> Makes the limits of a key's range bounds of the unknown. Without these bounds the search would
  !> stop at a value that the key does not allow, before it has found the others.
  pure subroutine take_range(spec, unknown)
    type(key_spec), intent(in) :: spec
    type(unknown_t), intent(inout) :: unknown

    associate (value => unknown%value)
      if (.not. unknown%in_log) then
        if (spec%low > -huge(1.0_wp)) unknown%lower = spec%low
        if (spec%above > -huge(1.0_wp)) unknown%lower = spec%above + inside*abs(value - spec%above)
      end if
      if (spec%high < huge(1.0_wp)) unknown%upper = spec%high
      if (spec%below < huge(1.0_wp)) unknown%upper = spec%below - inside*abs(spec%below - value)
    end associate
  end subroutine take_range

  !> Reads the bounds and prior standard deviations, one for each unknown.
  subroutine take_bounds(deck, unknown)
    type(deck_t), intent(inout) :: deck
    type(unknown_t), intent(inout) :: unknown(:)
    character(len=*), parameter :: keys(*) = [character(len=5) :: 'lower', 'upper', 'prior']
    real(wp), allocatable :: value(:)
    integer :: i, k

    do k = 1, size(keys)
      call deck%get('fit', trim(keys(k)), value)
      if (size(value) == 0) cycle
      if (size(value) /= size(unknown)) then
        call deck%mistake('fit', trim(keys(k)), 'give one value for each of ' // &
          trim(merge('shared and own', 'parameters    ', any(unknown%shared))))
        return
      end if
      do i = 1, size(unknown)
        select case (keys(k))
        case ('lower')
          if (unknown(i)%in_log .and. value(i) <= 0) cycle
          if (allocated(unknown(i)%lower)) value(i) = max(value(i), unknown(i)%lower)
          unknown(i)%lower = value(i)
        case ('upper')
          if (allocated(unknown(i)%upper)) value(i) = min(value(i), unknown(i)%upper)
          unknown(i)%upper = value(i)
        case default
          unknown(i)%prior = value(i)
        end select
      end do
    end do
    do i = 1, size(unknown)
      if (unknown(i)%role == of_contact_point .and. .not. deck%is_set('measurement', &
        'contact_point')) then
        if (unknown(i)%prior > 0) call deck%mistake('fit', 'prior', &
          'measurement.contact_point is not given, so that it has no prior')
        cycle
      end if
      if (allocated(unknown(i)%lower)) then
        if (unknown(i)%value < unknown(i)%lower) call deck%mistake('fit', 'lower', &
          unknown(i)%name // ' is below this bound in the deck')
      end if
      if (allocated(unknown(i)%upper)) then
        if (unknown(i)%value > unknown(i)%upper) call deck%mistake('fit', 'upper', &
          unknown(i)%name // ' is above this bound in the deck')
      end if
    end do
  end subroutine take_bounds

end module unknown_bounds
