!> A test whether the residuals of a fit are noise. A wrong model leaves residuals of one sign over
!> many neighbours, so that means over blocks of samples reveal it.
module lack_of_fit
  use kinds, only: wp
  use noise, only: noise_t
  implicit none
  private
  public :: lack_t, lack_in, hardly_ever

  !> The largest lack of fit. excess: by how many standard deviations the means of blocks of `width`
  !> samples exceed those of noise. times: their ratio to those of noise.
  type :: lack_t
    integer :: width = 1
    real(wp) :: excess = 0, times = 1
  contains
    procedure :: is_noise
  end type lack_t

  !> Smallest number of blocks that is tested. The excess that noise reaches in one fit of two
  !> hundred with about seven widths.
  integer, parameter :: fewest_blocks = 8
  real(wp), parameter :: hardly_ever = 3.2_wp

contains

  !> Whether noise explains the residuals.
  pure logical function is_noise(self)
    class(lack_t), intent(in) :: self

    is_noise = self%excess <= hardly_ever
  end function is_noise

  !> The largest lack of fit over all widths. white: whitened residuals. run: number of the run of
  !> each sample; samples of different runs are not neighbours. freedom: number of independent
  !> residuals. noise: the noise that they were whitened with.
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
      ! The ratio of the variance of all samples to that of their steps has the variance 1/n (von
      ! Neumann, 1941), half that of the variance of all samples, as if n were twice as large.
      excess = normal_of(total, blocks, noise%known_by)
      if (width == 1 .and. noise%of_steps) excess = normal_of(2*total, 2*blocks, huge(1.0_wp))
      if (excess > worst%excess) worst = lack_t(width, excess, sqrt(total/blocks))
      width = 2*width
    end do
  end function lack_in

  !> A sum of n squares of normal numbers as a normal number (Wilson and Hilferty, 1931), if their
  !> variance is known from `known_by` others.
  pure real(wp) function normal_of(total, n, known_by)
    real(wp), intent(in) :: total, known_by
    integer, intent(in) :: n

    normal_of = ((total/n)**(1.0_wp/3) - 1 + 2.0_wp/(9*n))/sqrt(2.0_wp/(9*n) + 2/9.0_wp/known_by)
  end function normal_of

end module lack_of_fit
