!> Barriers: repulsion outside the contact, which the bodies must overcome before contact.
module barriers
  use kinds, only: wp, pi
  use dimensionless_problem, only: problem_t, coupling_over
  use undeformed, only: load_undeformed
  implicit none
  private
  public :: pass_barrier, trial_ratio

  !> A drive stops before a barrier if the bodies have a larger slope than this at the edge of the
  !> contact that overcomes the barrier. The slope is then no longer small, and paths through such
  !> wide contacts take minutes.
  real(wp), parameter :: too_steep = 0.1_wp
  !> Number of gaps at which the pressure of a barrier is evaluated, and the ratio of successive
  !> gaps. Numbers of contact radii (lateral units) and of gaps between undeformed bodies at which
  !> loads are evaluated, the ratio of successive values, and the smallest radius.
  integer, parameter :: gaps = 600, radii = 400, distances = 200
  real(wp), parameter :: gap_ratio = 1.02_wp, trial_ratio = 1.1_wp, &
    smallest_radius = 1/trial_ratio**60

contains

  !> Estimates of the h0 and the load at which the highest barrier outside contact is overcome: by
  !> undeformed bodies, or by a Hertz contact whose pressure on the axis is that of the barrier.
  !> passed: the contact that overcomes the barrier is within the model.
  pure subroutine pass_barrier(problem, h0, load, passed)
    type(problem_t), intent(in) :: problem
    real(wp), intent(out) :: h0, load
    logical, intent(out) :: passed
    real(wp) :: pressure, hertz, from, c
    integer :: k

    h0 = 1
    load = largest_repulsion(problem)
    passed = .true.
    if (problem%rigid) return
    from = max(problem%law%edge_gap, problem%law%rest_gap)
    if (.not. from > 0) return
    pressure = maxval(problem%law%pressure(from*gap_ratio**[(k, k=1, gaps)]))
    if (.not. pressure > 0) return
    c = smallest_radius
    do k = 1, radii
      passed = problem%shape%slope(c)*problem%length/problem%lateral < too_steep
      if (.not. passed) return
      hertz = problem%shape%indentation_load(c)/coupling_over(problem, c)
      if (1.5_wp*hertz > pi*c**2*pressure) then
        h0 = min(h0, 1 - problem%shape%indentation(c))
        load = max(load, hertz)
        return
      end if
      c = trial_ratio*c
    end do
    ! The pressure under a cone does not grow with the contact.
  end subroutine pass_barrier

  !> The largest repulsion between undeformed bodies outside the contact; 0 if there is none.
  pure real(wp) function largest_repulsion(problem) result(load)
    type(problem_t), intent(in) :: problem
    integer :: step
    real(wp) :: gap

    load = 0
    gap = max(problem%law%edge_gap, problem%law%rest_gap)
    ! Bodies that only attract each other have no barrier.
    if (.not. gap > 0) return
    do step = 1, distances
      load = max(load, load_undeformed(problem, gap))
      gap = trial_ratio*gap
    end do
  end function largest_repulsion

end module barriers
