!> Bodies that do not deform, because they are rigid or far apart. Derjaguin's load (23) is the
!> integral of the pressure over the gap H0 + f; the energy is computed likewise. All numbers are in
!> the units of `dimensionless_problem`. The load of parabolas is 2 pi times the law's energy.
!> Everything else is integrated to rounding accuracy, in pieces between the positions at which law
!> or shape are not smooth.
module undeformed
  use kinds, only: wp, pi
  use adaptive_quadrature, only: integral_t, new_integral, rule_nodes, in_order
  use dimensionless_problem, only: problem_t
  use force_law, only: of_pressure, of_slope, of_energy
  use far_field, only: energy_density, falls_slowly, farthest
  implicit none
  private
  public :: measured_t, measured_load, measured_slope
  public :: load_undeformed, load_slope_undeformed, energy_undeformed

  !> A number and its estimated error.
  type :: measured_t
    real(wp) :: value = 0, error = 0
  end type measured_t

  !> The H0 at which the energy is subtracted, if the energy falls slowly.
  real(wp), parameter :: at_reference = 1
  !> Relative error of numbers that need no quadrature.
  real(wp), parameter :: rounding = 8*epsilon(1.0_wp)
  !> The first piece ends where the height of the shape is `first`. The end of each further piece is
  !> at twice the position, until the height is `last` times the larger of h0 and 1. The last piece
  !> extends to infinity.
  real(wp), parameter :: first = 0.25_wp, last = 4
  !> Ratio of the gap to the larger of h0 and 1 above which a difference of energies is computed to
  !> first order. The relative error of this, the inverse square of the ratio, is smaller than
  !> rounding errors.
  real(wp), parameter :: far = 1.0e6_wp
  !> Power of r with which a pressure falls so fast that the integral beyond `farthest` is
  !> negligible.
  real(wp), parameter :: fast = 4
  !> Largest ratio of the length of a piece to its position for which the slope within the piece is
  !> treated as that of a step, since rounding would make the nodes of the piece coincide.
  real(wp), parameter :: narrow = 1.0e-5_wp

contains

  !> The load at h0.
  pure type(measured_t) function measured_load(problem, h0) result(load)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0

    if (problem%shape%parabolic) then
      load%value = 2*pi*problem%law%at(of_energy, h0)
      load%error = rounding*abs(load%value)
    else
      load = integral_of(problem, h0, of_pressure)
    end if
  end function measured_load

  !> The derivative of the load by h0.
  pure type(measured_t) function measured_slope(problem, h0) result(slope)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0

    if (problem%shape%parabolic) then
      slope%value = -2*pi*problem%law%at(of_pressure, h0)
      slope%error = rounding*abs(slope%value)
    else
      slope = integral_of(problem, h0, of_slope)
    end if
  end function measured_slope

  !> The load without its error.
  pure real(wp) function load_undeformed(problem, h0) result(load)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0
    type(measured_t) :: found

    found = measured_load(problem, h0)
    load = found%value
  end function load_undeformed

  !> The derivative of the load without its error.
  pure real(wp) function load_slope_undeformed(problem, h0) result(slope)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0
    type(measured_t) :: found

    found = measured_slope(problem, h0)
    slope = found%value
  end function load_slope_undeformed

  !> The energy at h0, above that at `at_reference` if it falls slowly; its derivative by h0 is
  !> minus the load.
  pure real(wp) function energy_undeformed(problem, h0) result(energy)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0
    type(measured_t) :: found

    found = integral_of(problem, h0, of_energy)
    energy = found%value
  end function energy_undeformed

  !> 2 pi Int g(h0 + f(r)) r dr, where g is the quantity `what`.
  pure type(measured_t) function integral_of(problem, h0, what) result(found)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0
    integer, intent(in) :: what
    type(integral_t) :: near, tail
    real(wp), dimension(rule_nodes) :: r, x
    real(wp), allocatable :: ends(:)
    logical, allocatable :: too_narrow(:)
    real(wp) :: reach, jumps

    ends = in_order(ends_of_pieces(problem, h0))
    associate (n => size(ends) - 1)
      reach = ends(n + 1)
      too_narrow = ends(2:) - ends(:n) <= merge(narrow, 0.0_wp, what == of_slope)*ends(:n)
      near = new_integral(pack(ends(:n), .not. too_narrow), pack(ends(2:), .not. too_narrow))
    end associate
    do while (near%is_open())
      r = near%places()
      call near%note(r*integrand(r))
    end do
    jumps = 0
    if (what == of_slope) jumps = sum(jump_over(ends(:size(ends) - 1), ends(2:)), too_narrow)
    found = measured_t(2*pi*(near%value + jumps), 2*pi*near%error)
    ! A body that ends has no tail: a force that falls slowly would act on the shape beyond this
    ! end.
    if (problem%law%tail_power <= 2/problem%shape%growth) return
    ! The integral of the tail over x = reach/r, up to the gap `farthest`.
    associate (least => (problem%shape%height(reach)/farthest)**(1/problem%shape%growth))
      tail = new_integral([least], [1.0_wp], near)
      do while (tail%is_open())
        x = tail%places()
        call tail%note((reach/x)**2/x*integrand(reach/x))
      end do
      found = measured_t(found%value + 2*pi*tail%value, found%error + 2*pi*tail%error)
      ! At larger gaps the integrand is a power of r, whose integral is negligible unless it falls
      ! slowly.
      if (problem%law%tail_power >= fast/problem%shape%growth .or. what == of_slope) return
      x = least
      x = (reach/x)**2*integrand(reach/x)
      found%value = found%value + 2*pi*x(1)/(problem%shape%growth*problem%law%tail_power - 2)
    end associate

  contains

    pure function integrand(r) result(g)
      real(wp), intent(in) :: r(rule_nodes)
      real(wp), dimension(rule_nodes) :: g, gap

      gap = min(h0 + problem%shape%height(r), farthest)
      if (what == of_energy) then
        g = energy_density(problem, gap, r, at_reference)
        ! Far away, where rounding hides the difference of two energies, the difference is computed
        ! to first order.
        if (falls_slowly(problem)) where (gap > far*max(1.0_wp, abs(h0))) &
          g = (at_reference - h0)*problem%law%pressure(gap + 0.5_wp*(at_reference - h0))
      else
        call problem%law%evaluate(what, gap, g)
      end if
    end function integrand

    !> The integral of the slope over a piece so narrow that only the pressure varies within it.
    elemental real(wp) function jump_over(left, right) result(jump)
      real(wp), intent(in) :: left, right
      real(wp) :: pressure(2)

      jump = 0
      if (.not. problem%shape%slope(right) > 0) return
      pressure = problem%law%pressure(h0 + problem%shape%height([left, right]))
      jump = (pressure(2) - pressure(1))*0.5_wp*(left + right)/ &
        problem%shape%slope(0.5_wp*(left + right))
    end function jump_over

  end function integral_of

  !> The ends of the pieces into which an integral from the axis is split, in any order.
  pure function ends_of_pieces(problem, h0) result(r)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0
    real(wp), allocatable :: r(:)
    real(wp) :: nearest, reach
    integer :: k

    allocate (r(0))
    if (allocated(problem%shape%breaks)) r = problem%shape%breaks
    if (allocated(problem%law%breaks)) r = [r, problem%shape%position_of( &
      pack(problem%law%breaks, problem%law%breaks > h0) - h0)]
    nearest = problem%shape%position_of(first)
    reach = max(problem%shape%position_of(last*max(1.0_wp, abs(h0))), 2*maxval([0.0_wp, r]))
    r = [0.0_wp, r, (nearest*2.0_wp**k, k=0, ceiling(log(reach/nearest)/log(2.0_wp)))]
  end function ends_of_pieces

end module undeformed
