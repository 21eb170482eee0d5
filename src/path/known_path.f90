!> The equilibrium path for an experiment: traced through the experiment's range, with its stable
!> pieces, along which a quasi-static experiment at controlled h0 moves, and the states in which the
!> bodies land after a jump from a fold.
module known_path
  use kinds, only: wp
  use solver, only: solver_t
  use path_tangent, only: of_h0
  use driven_pieces, only: drive_t, driven_piece_t, jump_t, find_pieces, find_jump, interval_with
  use tracing, only: tracing_t
  implicit none
  private
  public :: known_path_t, landing_t, know_pieces, interval_at, landing_over, folds_of_cycle

  !> A jump at prescribed h0; fold: the point of the path from which the jump starts (0: there is no
  !> jump).
  type, extends(jump_t) :: landing_t
    integer :: fold = 0
  end type landing_t

  !> The pieces that are stable at prescribed h0, and the landings after jumps from the fold at the
  !> inner and at the outer end of each piece.
  type, extends(tracing_t) :: known_path_t
    type(driven_piece_t), allocatable :: piece(:)
    type(landing_t), allocatable :: inward(:), outward(:)
  end type known_path_t

contains

  !> Finds the pieces of a traced path and the landings of jumps from them.
  subroutine know_pieces(solver, known)
    class(solver_t), intent(inout) :: solver
    type(known_path_t), intent(inout) :: known
    logical :: whole
    integer :: k

    call find_pieces(solver, known%path, drive_t(of_h0), known%piece, whole)
    ! The part beyond the last stable piece was traced only to find the end of this piece.
    if (size(known%piece) > 0) &
      known%path%last = known%piece(size(known%piece))%last%interval + 1
    if (allocated(known%inward)) deallocate (known%inward, known%outward)
    allocate (known%inward(size(known%piece)), known%outward(size(known%piece)))
    do k = 1, size(known%piece)
      call land(solver, known, k, .true., known%inward(k))
      call land(solver, known, k, .false., known%outward(k))
    end do
  end subroutine know_pieces

  !> The point of a piece, on a mesh, after which the path reaches h0.
  pure integer function interval_at(known, piece, h0) result(i)
    type(known_path_t), intent(in) :: known
    integer, intent(in) :: piece
    real(wp), intent(in) :: h0

    i = max(interval_with(known%path, known%piece(piece), of_h0, h0), known%path%undeformed + 1)
  end function interval_at

  !> The landing of bodies that leave a piece over the fold at its inner or outer end.
  subroutine land(solver, known, from, inward, landing)
    class(solver_t), intent(inout) :: solver
    type(known_path_t), intent(in) :: known
    integer, intent(in) :: from
    logical, intent(in) :: inward
    type(landing_t), intent(out) :: landing

    associate (left => known%piece(from))
      if (.not. merge(left%last_turns, left%first_turns, inward)) return
      landing%fold = merge(left%last%interval + 1, left%first%interval, inward)
    end associate
    call find_jump(solver, known%path, drive_t(of_h0), known%piece, from, inward, landing%jump_t)
  end subroutine land

  !> The folds from which jumps start in a cycle at controlled h0, from the outermost stable piece
  !> to the piece `turned` and back, with h0 >= `lowest`; empty if jumps do not lead there. The
  !> energy dissipated in these jumps is the area of a closed cycle.
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

      ! A jump that ends beyond the piece `to` belongs to another cycle.
      whole = landing%landed .and. (landing%piece - to)*(k - to) >= 0
      if (whole) whole = known%path%point(landing%fold)%state%h0 >= lowest
      if (.not. whole) return
      fold = [fold, landing%fold]
      k = landing%piece
    end subroutine add

  end function folds_of_cycle

  !> The landing after the jump from a fold at which a stable piece ends.
  pure type(landing_t) function landing_over(known, fold) result(landing)
    type(known_path_t), intent(in) :: known
    integer, intent(in) :: fold
    integer :: k

    k = findloc(known%inward%fold, fold, 1)
    if (k > 0) landing = known%inward(k)
    if (k == 0) landing = known%outward(findloc(known%outward%fold, fold, 1))
  end function landing_over

end module known_path
