!> The jumps of a cycle at controlled h0. What they lose is the difference of potential energy
!> between the fold that a jump starts from and the state that it ends in: over a closed cycle the
!> area between the ways out and back.
module hysteresis
  use kinds, only: wp
  use known_path, only: known_path_t, landing_t
  implicit none
  private
  public :: folds_of_cycle

contains

  !> The folds that jumps start from, from the outermost stable piece to the piece `turned` and
  !> back, h0 going no lower than `lowest`; none where no jumps lead there.
  function folds_of_cycle(known, turned, lowest) result(fold)
    type(known_path_t), intent(in) :: known
    integer, intent(in) :: turned
    real(wp), intent(in) :: lowest
    integer, allocatable :: fold(:)
    integer :: k
    logical :: whole

    allocate (fold(0))
    whole = .true.
    k = 1
    do while (k /= turned .and. whole)
      call add(known%inward(k), turned)
    end do
    do while (k /= 1 .and. whole)
      call add(known%outward(k), 1)
    end do
    if (.not. whole) fold = fold(:0)

  contains

    subroutine add(landing, to)
      type(landing_t), intent(in) :: landing
      integer, intent(in) :: to

      whole = landing%piece > 0 .and. landing%converged
      ! Beyond where it was to lead: another way.
      if (whole) whole = (landing%piece - to)*(k - to) >= 0
      if (whole) whole = known%path%point(landing%fold)%state%h0 >= lowest
      if (.not. whole) return
      fold = [fold, landing%fold]
      k = landing%piece
    end subroutine add

  end function folds_of_cycle

end module hysteresis
