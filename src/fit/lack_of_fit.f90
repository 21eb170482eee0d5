!> Whether what a fit leaves is noise. Means over neighbours show what single samples hide: what a
!> wrong model leaves goes the same way over many of them.
module lack_of_fit
  use kinds, only: wp
  implicit none
  private
  public :: lack_t, lack_in

  !> excess: by how many standard deviations blocks of `width` samples leave more than noise would,
  !> where that is most; times: how many times what noise leaves of them.
  type :: lack_t
    integer :: width = 1
    real(wp) :: excess = 0, times = 1
  end type lack_t

  !> Fewer blocks say nothing.
  integer, parameter :: fewest_blocks = 8

contains

  !> white: what is left in standard deviations; run: samples of different runs are no neighbours;
  !> freedom: how many of them are independent; known_by: by how many the standard deviation is known.
  pure type(lack_t) function lack_in(white, run, freedom, known_by) result(worst)
    real(wp), intent(in) :: white(:), known_by
    integer, intent(in) :: run(:), freedom
    real(wp) :: total, part, excess
    integer :: width, i, k, blocks

    worst%excess = -huge(1.0_wp)
    width = 1
    do
      total = 0
      blocks = 0
      k = 0
      part = 0
      do i = 1, size(white)
        if (run(i) /= run(max(1, i - 1))) k = 0
        if (k == 0) part = 0
        part = part + white(i)
        k = k + 1
        if (k < width) cycle
        k = 0
        blocks = blocks + 1
        total = total + part**2/width
      end do
      if (width == 1) blocks = max(1, freedom)
      if (width > 1 .and. blocks < fewest_blocks) return
      excess = normal_of(total, blocks, known_by)
      if (excess > worst%excess) worst = lack_t(width, excess, sqrt(total/blocks))
      width = 2*width
    end do
  end function lack_in

  !> A sum of n squares of normal numbers as a normal number (Wilson and Hilferty, 1931), where their
  !> variance is known by `known_by` others.
  pure real(wp) function normal_of(total, n, known_by)
    real(wp), intent(in) :: total, known_by
    integer, intent(in) :: n

    normal_of = ((total/n)**(1.0_wp/3) - 1 + 2.0_wp/(9*n))/sqrt(2.0_wp/(9*n) + 2/(9*known_by))
  end function normal_of

end module lack_of_fit
