!> Where a measured curve jumps from one branch to another. Both branches are given; each place
!> between two samples has a likelihood, that of the samples before it lying on the one branch and
!> those after it on the other. Samples that were taken during the jump lie on neither.
module jump_places
  use kinds, only: wp
  use measured_jumps, only: measured_jump_t
  implicit none
  private
  public :: likely_jump

  !> Most samples within a jump that an instrument smooths. A sample that is farther from both
  !> branches than this part of the jump, and than these standard deviations, is one, or an outlier:
  !> a single one is as likely either, of several together each further one is rather within the
  !> jump, by as many squares of standard deviations.
  integer, parameter :: most_within = 6
  real(wp), parameter :: off_part = 0.2_wp, off = 4, together = 4
  !> Which side a sample is on is known if the other has less than this chance; the jump, if it is
  !> not among more than this part of the samples of a way.
  real(wp), parameter :: doubtful = 1.0e-3_wp, known_part = 0.2_wp

contains

  !> before(i), after(i): the squares of what either branch leaves of sample i in standard
  !> deviations, 0 for samples that do not count; change: of the signal in the jump, `noise` its
  !> standard deviation. The number of a sample is counted from `first`. No jump where its
  !> place is not seen.
  pure type(measured_jump_t) function likely_jump(z, before, after, change, noise, first) &
    result(jump)
    real(wp), intent(in) :: z(:), before(:), after(:), change, noise
    integer, intent(in) :: first
    real(wp) :: leaves(size(z)), arrives(size(z)), cost(size(z), 0:most_within)
    real(wp) :: ahead(size(z)), behind(size(z)), middle(size(z)), typical, neither
    integer :: i, m, n

    n = size(z)
    if (n < 2) return
    neither = max(off, off_part*abs(change)/noise)**2
    ahead(1) = min(before(1), neither)
    behind(n) = min(after(n), neither)
    do i = 2, n
      ahead(i) = ahead(i - 1) + min(before(i), neither)
      behind(n + 1 - i) = behind(n + 2 - i) + min(after(n + 1 - i), neither)
    end do
    typical = abs(z(n) - z(1))/(n - 1)
    cost = huge(cost)
    do m = 0, most_within
      do i = 1, n - 1 - m
        cost(i, m) = ahead(i) + behind(i + 1 + m) + m*neither - max(0, m - 1)*together
      end do
    end do
    cost = cost - minval(cost)
    leaves = 0
    arrives = 0
    do m = 0, most_within
      do i = 1, n - 1 - m
        if (cost(i, m) > 200) cycle
        associate (chance => exp(-0.5_wp*cost(i, m))*max(abs(z(i + 1) - z(i)), 0.1_wp*typical))
          leaves(i) = leaves(i) + chance
          arrives(i + 1 + m) = arrives(i + 1 + m) + chance
        end associate
      end do
    end do
    leaves = leaves/sum(leaves)
    arrives = arrives/sum(arrives)
    middle(:n - 1) = 0.5_wp*(z(2:) + z(:n - 1))
    middle(n) = z(n)
    jump%z = sum(leaves*middle)
    jump%uncertainty = sqrt(sum(leaves*((middle - jump%z)**2 + typical**2/12)))
    jump%before = first_beyond(leaves)
    jump%after = n + 1 - first_beyond(arrives(n:1:-1))
    if (jump%after - jump%before > max(most_within + 2.0_wp, known_part*n)) then
      jump = measured_jump_t()
      return
    end if
    jump%before = jump%before + first - 1
    jump%after = jump%after + first - 1
    jump%change = change
  end function likely_jump

  !> The first of some chances up to which the sum is no longer small.
  pure integer function first_beyond(chance) result(i)
    real(wp), intent(in) :: chance(:)
    real(wp) :: total

    total = 0
    do i = 1, size(chance) - 1
      total = total + chance(i)
      if (total > doubtful) return
    end do
  end function first_beyond

end module jump_places
