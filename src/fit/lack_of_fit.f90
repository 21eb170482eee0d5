!> Whether what a fit leaves is noise. Means over neighbours show what single samples hide: what a
!> wrong model leaves goes the same way over many of them.
module lack_of_fit
  use kinds, only: wp
  use noise, only: noise_t
  implicit none
  private
  public :: lack_t, lack_in, hardly_ever

  !> How a fit is wrong. excess: by how many standard deviations blocks of `width` samples leave
  !> more than noise would, where that is most; times: how many times what noise leaves of them.
  type :: lack_t
    integer :: width = 1
    real(wp) :: excess = 0, times = 1
  contains
    procedure :: is_noise
  end type lack_t

  !> Fewer blocks say nothing. What noise hardly ever leaves more than it should, in standard
  !> deviations: by the seven or so widths in one fit of two hundred.
  integer, parameter :: fewest_blocks = 8
  real(wp), parameter :: hardly_ever = 3.2_wp

contains

  !> Whether noise may have left as much.
  pure logical function is_noise(self)
    class(lack_t), intent(in) :: self

    is_noise = self%excess <= hardly_ever
  end function is_noise

  !> Where and how a fit is wrong most. white: what is left in standard deviations; run: samples
  !> of different runs are no neighbours; freedom: how many of them are independent; noise: by
  !> which they were made so.
  pure type(lack_t) function lack_in(white, run, freedom, noise) result(worst)
    real(wp), intent(in) :: white(:)
    type(noise_t), intent(in) :: noise
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
      ! What all samples leave over what their steps do scatters by 1/n, half as much as the former
      ! alone (von Neumann, 1941): as if n were twice as large.
      excess = normal_of(total, blocks, noise%known_by)
      if (width == 1 .and. noise%of_steps) excess = normal_of(2*total, 2*blocks, huge(1.0_wp))
      if (excess > worst%excess) worst = lack_t(width, excess, sqrt(total/blocks))
      width = 2*width
    end do
  end function lack_in

  !> A sum of n squares of normal numbers as a normal number (Wilson and Hilferty, 1931), where
  !> their variance is known by `known_by` others.
  pure real(wp) function normal_of(total, n, known_by)
    real(wp), intent(in) :: total, known_by
    integer, intent(in) :: n

    normal_of = ((total/n)**(1.0_wp/3) - 1 + 2.0_wp/(9*n))/sqrt(2.0_wp/(9*n) + 2/(9*known_by))
  end function normal_of

end module lack_of_fit
