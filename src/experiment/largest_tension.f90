!> The largest tension of an experiment, as the place of the lowest load. On a part of the path the
!> load is lowest at an end or at an extremum, and all extrema are points of the path.
module largest_tension
  use kinds, only: wp
  use traced_path, only: traced_path_t
  use driven_pieces, only: driven_pieces_t, jump_t, walk_t
  use reported_place, only: place_t, point_of_path, of_load
  implicit none
  private
  public :: lower, lower_along, lower_on_way

contains

  !> Replaces `lowest`, the place of the largest tension, by `place` if the tension there is larger.
  !> Without attraction `lowest` is not allocated. lowered: whether it was replaced.
  pure subroutine lower(lowest, place, lowered)
    type(place_t), allocatable, intent(inout) :: lowest
    type(place_t), intent(in) :: place
    logical, intent(out), optional :: lowered

    if (present(lowered)) lowered = .false.
    if (.not. place%at(of_load) < 0) return
    if (allocated(lowest)) then
      if (place%at(of_load) >= lowest%at(of_load)) return
    end if
    lowest = place
    if (present(lowered)) lowered = .true.
  end subroutine lower

  !> The same for the extrema and folds among the points `first` to `last` of a path; if `h0` is
  !> present, only those with h0 between its two values.
  pure subroutine lower_along(path, first, last, lowest, h0)
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: first, last
    type(place_t), allocatable, intent(inout) :: lowest
    real(wp), intent(in), optional :: h0(2)
    type(place_t) :: place
    integer :: i

    do i = first, last
      associate (point => path%point(i))
        if (.not. (point%load_extremum .or. point%fold)) cycle
        if (present(h0)) then
          if (product(point%state%h0 - h0) > 0) cycle
        end if
        place = point_of_path(i)
        place%at(of_load) = point%state%load
        call lower(lowest, place)
      end associate
    end do
  end subroutine lower_along

  !> The same for a motion at prescribed h0, from h0 = `from` on a stable piece of the path to h0 =
  !> `to`. The load is lowest at an extremum, at a fold or after a jump. The states at both ends are
  !> not considered.
  subroutine lower_on_way(path, pieces, piece, from, to, lowest)
    type(traced_path_t), intent(in) :: path
    type(driven_pieces_t), intent(in) :: pieces
    integer, intent(in) :: piece
    real(wp), intent(in) :: from, to
    type(place_t), allocatable, intent(inout) :: lowest
    type(walk_t) :: way
    type(jump_t) :: jump
    type(place_t) :: landing
    real(wp) :: begins, ends
    integer :: i

    way = pieces%way_to(piece, to)
    begins = from
    do i = 1, size(way%leg)
      associate (leg => way%leg(i), stable => pieces%piece(way%leg(i)%piece))
        ends = to
        if (leg%jumps) then
          jump = pieces%jump_from(leg%piece, leg%inward)
          ends = path%point(jump%fold())%state%h0
        end if
        call lower_along(path, stable%first%interval, stable%last%interval + 1, lowest, &
          [begins, ends])
        if (.not. leg%jumps) return
        landing = point_of_path(jump%fold(), landing=.true.)
        landing%at(of_load) = jump%after%state%load
        if (jump%landed) call lower(lowest, landing)
        begins = ends
      end associate
    end do
  end subroutine lower_on_way

end module largest_tension
