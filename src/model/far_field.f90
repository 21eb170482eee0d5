!> Forces beyond the end of a mesh, where the deformation hardly varies: from the position r0 on,
!> the gap is H(r) = H(r0) + f(r) - f(r0). For the parabola r dr = dH, so that the integrals are the
!> law's own, Derjaguin's (23). For other shapes they are computed as integrals over r0/r.
module far_field
  use kinds, only: wp
  use force_law, only: of_pressure, of_energy
  use dimensionless_problem, only: problem_t
  use quadrature, only: gauss_legendre
  implicit none
  private
  public :: load_beyond, load_slope_beyond, energy_density, falls_slowly, farthest

  !> Number of points of the quadrature.
  integer, parameter :: points = 24
  !> Largest gap at which a force is computed; powers of this gap do not overflow.
  real(wp), parameter :: farthest = 1.0e30_wp

  !> The points of the quadrature: the gaps, and the weights of g in Int g(H) r dr.
  type :: rule_t
    real(wp), allocatable :: gap(:), weight(:)
  end type rule_t

contains

  !> Int P(H) r dr from the position `from`, where the gap is `gap`: the load divided by 2 pi.
  pure real(wp) function load_beyond(problem, gap, from) result(load)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: gap, from
    type(rule_t) :: rule

    if (problem%shape%parabolic) then
      load = problem%law%at(of_energy, gap)
    else
      rule = rule_beyond(problem, gap, from)
      load = sum(rule%weight*problem%law%pressure(rule%gap))
    end if
  end function load_beyond

  !> The derivatives of this load by the gap and by the position.
  pure function load_slope_beyond(problem, gap, from) result(slope)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: gap, from
    real(wp) :: slope(2)
    type(rule_t) :: rule

    slope(1) = -problem%law%at(of_pressure, gap)
    slope(2) = 0
    if (problem%shape%parabolic) return
    slope(2) = slope(1)*from
    rule = rule_beyond(problem, gap, from)
    slope(1) = sum(rule%weight*problem%law%slope(rule%gap))
    slope(2) = slope(2) - problem%shape%slope(from)*slope(1)
  end function load_slope_beyond

  !> The energy of the surface force per area, at gaps and positions. If it falls slowly, the energy
  !> per area of undeformed bodies at the H0 `reference` is subtracted, since only differences of
  !> energies matter.
  pure function energy_density(problem, gap, r, reference) result(energy)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: gap(:), r(:), reference
    real(wp) :: energy(size(gap))

    energy = problem%law%energy(gap)
    if (falls_slowly(problem)) &
      energy = energy - problem%law%energy(min(reference + problem%shape%height(r), farthest))
  end function energy_density

  !> Whether the energy per area falls so slowly that its integral hardly converges, or diverges. An
  !> example is a fall as r^-2, which gap^-3 gives between cones and gap^-2 between parabolas.
  pure logical function falls_slowly(problem)
    type(problem_t), intent(in) :: problem
    real(wp), parameter :: falls_well = 4

    ! The condition has no product with the power, which may be `huge` for a law without a tail.
    falls_slowly = problem%law%tail_power < 1 + falls_well/problem%shape%growth
  end function falls_slowly

  !> The quadrature with r = from/x.
  pure type(rule_t) function rule_beyond(problem, gap, from) result(rule)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: gap, from
    real(wp) :: x(points), weight(points)

    call gauss_legendre(x, weight)
    rule%gap = min(gap + (problem%shape%height(from/x) - problem%shape%height(from)), farthest)
    rule%weight = weight*(from/x)**2/x
  end function rule_beyond

end module far_field
