!> Contact of bodies of any convex shape: the theory of Hertz, and that of Johnson, Kendall and
!> Roberts with adhesion. Both follow from the two integrals of a `shape`. In the units of
!> `dimensionless_problem`, with sigma = coupling*adhesion and gamma the work of adhesion,
!>
!>     delta = q(a) - sqrt(4 pi sigma a) ,
!>     F = (1/coupling) Int_0^a [q(a) - q(x)] dx - sqrt(4 pi adhesion a^3/coupling) .
!>
!> For the parabola these are (10) and (11). Unless a procedure says otherwise, the bodies are
!> elastic and attract each other.
module convex_contact
  use kinds, only: wp, pi, nan
  use root_finding, only: bracket_t, root_search_t, new_root_search
  use shape, only: shape_t
  use dimensionless_problem, only: problem_t
  implicit none
  private
  public :: hertz_like_load, jkr_like_load, jkr_like_radius
  public :: jkr_like_pull_off, jkr_like_detachment, detachment_radius

  !> Ratio of the contact radius at which adhesion balances the repulsion to the smallest one that
  !> may be an extremum. Number of golden sections that determine half of the digits of the radius,
  !> and therefore all digits of the extremum.
  real(wp), parameter :: widest_range = 1.0e4_wp
  integer, parameter :: sections = 45

contains

  !> Load at a contact radius, without adhesion.
  elemental real(wp) function hertz_like_load(problem, a) result(load)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: a

    load = problem%shape%indentation_load(a)/problem%coupling
  end function hertz_like_load

  !> Load at a contact radius, with the law's `work` as adhesion.
  elemental real(wp) function jkr_like_load(problem, a) result(load)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: a

    load = hertz_like_load(problem, a) - sqrt(4*pi*problem%law%work/problem%coupling*a)*a
  end function jkr_like_load

  !> Displacement at a contact radius for a given sigma.
  elemental real(wp) function jkr_like_displacement(shape, sigma, a) result(displacement)
    class(shape_t), intent(in) :: shape
    real(wp), intent(in) :: sigma, a

    displacement = shape%indentation(a) - sqrt(4*pi*sigma*a)
  end function jkr_like_displacement

  !> Contact radius of the stable state at a displacement; NaN if there is no such state. narrowest:
  !> the `detachment_radius`.
  pure real(wp) function jkr_like_radius(shape, sigma, narrowest, displacement) result(a)
    class(shape_t), intent(in) :: shape
    real(wp), intent(in) :: sigma, narrowest, displacement
    type(root_search_t) :: search
    real(wp) :: ends(2), excess(2)

    a = nan
    ends(2) = narrowest
    excess(2) = jkr_like_displacement(shape, sigma, narrowest) - displacement
    if (excess(2) > 0) return
    do
      ends = [ends(2), 2*ends(2)]
      excess = [excess(2), jkr_like_displacement(shape, sigma, ends(2)) - displacement]
      if (.not. excess(2) < 0) exit
    end do
    search = new_root_search(ends(1), excess(1), ends(2), excess(2))
    do while (search%is_open())
      a = search%place()
      call search%note(a, jkr_like_displacement(shape, sigma, a) - displacement)
    end do
    a = search%root
  end function jkr_like_radius

  !> The H0 at which bodies separate under fixed displacement, which is the largest -delta; 0
  !> without adhesion.
  pure real(wp) function jkr_like_detachment(shape, sigma) result(h0)
    class(shape_t), intent(in) :: shape
    real(wp), intent(in) :: sigma

    if (shape%parabolic) then
      h0 = 3*(pi*sigma/4)**(2.0_wp/3)
    else if (.not. sigma > 0) then
      h0 = 0
    else
      h0 = -jkr_like_displacement(shape, sigma, detachment_radius(shape, sigma))
    end if
  end function jkr_like_detachment

  !> Contact radius at this separation, by golden section in its logarithm; sigma must be positive.
  pure real(wp) function detachment_radius(shape, sigma) result(a)
    class(shape_t), intent(in) :: shape
    real(wp), intent(in) :: sigma
    type(bracket_t) :: bracket
    real(wp) :: widest
    integer :: i

    widest = widest_at(shape, sigma)
    bracket = bracket_t(log(widest/widest_range), log(widest))
    do i = 1, sections
      call bracket%keep_larger(-jkr_like_displacement(shape, sigma, exp(bracket%golden_points())))
    end do
    a = exp(bracket%middle())
  end function detachment_radius

  !> The smallest load, which is negative: the pull-off at fixed load.
  pure real(wp) function jkr_like_pull_off(problem) result(load)
    type(problem_t), intent(in) :: problem
    type(bracket_t) :: bracket
    real(wp) :: widest
    integer :: i

    ! Where delta is positive, the load is positive, or increases with a.
    widest = 4*widest_at(problem%shape, problem%coupling*problem%law%work)
    bracket = bracket_t(log(widest/widest_range), log(widest))
    do i = 1, sections
      call bracket%keep_larger(-jkr_like_load(problem, exp(bracket%golden_points())))
    end do
    load = jkr_like_load(problem, exp(bracket%middle()))
  end function jkr_like_pull_off

  !> A contact radius at which the displacement is positive; it is at most twice the smallest such
  !> radius.
  pure real(wp) function widest_at(shape, sigma) result(a)
    class(shape_t), intent(in) :: shape
    real(wp), intent(in) :: sigma

    a = 1
    do while (jkr_like_displacement(shape, sigma, a) < 0)
      a = 2*a
    end do
    do while (jkr_like_displacement(shape, sigma, 0.5_wp*a) > 0)
      a = 0.5_wp*a
    end do
  end function widest_at

end module convex_contact
