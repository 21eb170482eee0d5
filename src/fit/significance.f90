!> What counts as significant in a fit: limits in standard deviations, and the probability that
!> noise alone makes a fit better.
module significance
  use kinds, only: wp
  implicit none
  private
  public :: stands_out, surely, differs, negligible, hardly_ever, chance_of, rarely

  !> Limits. stands_out: a single signal beyond it is no noise. surely: a statement beyond it is
  !> certain, among all that are made about a curve. differs: two values farther apart are not the
  !> same. negligible: a smaller change does not count.
  real(wp), parameter :: stands_out = 8, surely = 5, differs = 4, negligible = 0.1_wp
  !> The excess of residuals that noise alone reaches in one fit of two hundred, if about seven
  !> widths of blocks are tested (`residual_analysis`).
  real(wp), parameter :: hardly_ever = 3.2_wp

contains

  !> The logarithm of the probability that noise alone lowers chi squared by `gain` if further
  !> columns (one or an even number) are fitted, where these columns are the best of `trials`
  !> choices. left: chi squared per degree of freedom with these columns; if it exceeds 1, it scales
  !> the noise.
  pure real(wp) function chance_of(gain, left, columns, trials) result(chance)
    real(wp), intent(in) :: gain, left
    integer, intent(in) :: columns, trials
    real(wp) :: half, term, total
    integer :: k

    half = 0.5_wp*max(0.0_wp, gain)/max(1.0_wp, left)
    if (columns == 1) then
      chance = log(erfc_scaled(sqrt(half)))
    else
      ! The distribution of chi squared with an even number of degrees of freedom.
      term = 1
      total = 1
      do k = 1, columns/2 - 1
        term = term*half/k
        total = total + term
      end do
      chance = log(total)
    end if
    chance = chance - half + log(real(trials, wp))
  end function chance_of

  !> Whether the logarithm of a probability is below the level at which an excess of the residuals
  !> is reported.
  elemental logical function rarely(chance)
    real(wp), intent(in) :: chance

    rarely = chance < log(erfc(hardly_ever/sqrt(2.0_wp)))
  end function rarely

end module significance
