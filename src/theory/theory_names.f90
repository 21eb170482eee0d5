!> The theories that `&classical` shows, with their names in decks and tables.
module theory_names
  implicit none
  private
  public :: theories, hertz, jkr, dmt, maugis_dugdale, carpick, pietrement_troyon, usual, convex

  integer, parameter :: hertz = 1, jkr = 2, dmt = 3, maugis_dugdale = 4, carpick = 5, &
    pietrement_troyon = 6
  character(len=*), parameter :: theories(*) = [character(len=17) :: 'hertz', 'jkr', 'dmt', &
    'maugis_dugdale', 'carpick', 'pietrement_troyon']
  !> Theories shown by default; theories that hold for any convex shape and for layers.
  logical, parameter :: usual(*) = [.true., .true., .true., .true., .false., .false.]
  logical, parameter :: convex(*) = [.true., .true., .false., .false., .false., .false.]

end module theory_names
