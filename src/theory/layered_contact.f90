!> Contact of layered bodies of any convex shape: the theory of Hertz, and that of Johnson, Kendall
!> and Roberts with adhesion. In the units of `dimensionless_problem`, with q of the shape (`shape`)
!> and L of the bodies (`layered_body`), a function phi on the contact area obeys
!>
!>     phi(y) + Int_0^a M(x, y) phi(x) dx = delta - q(y),  F = (1/coupling) Int_0^a phi dx ,
!>     M(x, y) = (2/pi) Int_0^inf (L(k) - 1) cos(k x) cos(k y) dk ,
!>
!> with phi(a) = 0 for Hertz and -sqrt(4 pi sigma a) for JKR, sigma = coupling*work. Both follow
!> from two solutions of one linear system. Displacement and load become Chebyshev series in ln a.
module layered_contact
  use kinds, only: wp, pi, nan
  use chebyshev, only: chebyshev_points, chebyshev_series, series_value
  use quadrature, only: gauss_legendre
  use linear_algebra, only: factorisation_t, factorise, solve
  use root_finding, only: bracket_t
  use dimensionless_problem, only: problem_t
  use layered_body, only: layered_body_t
  use classical, only: hertz, jkr
  implicit none
  private
  public :: layered_contact_t, new_layered_contact, has_layers, of_load, of_displacement

  !> The quantities that are series at a contact radius a: displacement over a^2, and load over a^3.
  integer, parameter :: of_displacement = 1, of_load = 2
  !> Degree of the series; ratio of the radius without displacement to the smallest radius.
  integer, parameter :: degree = 80
  real(wp), parameter :: span = 100
  !> A minimum does not count if its radius exceeds this fraction of the largest radius.
  real(wp), parameter :: inside = 0.97_wp
  !> Smallest number of nodes of the system; number of nodes per thickness of the thinnest top layer
  !> over the contact radius; largest contact radius in units of this thickness.
  integer, parameter :: fewest = 32, a_thickness = 4, widest = 40
  !> Number of radii at which the smallest value is searched for; number of golden sections that
  !> refine it.
  integer, parameter :: looks = 400, sections = 50

  !> The series in ln a between the radii `first` and `last`, (degree, theory, quantity).
  type :: layered_contact_t
    real(wp) :: first = 1, last = 1
    real(wp) :: series(0:degree, 2, 2) = 0
  contains
    procedure :: value_of
    procedure :: radius_at
    procedure :: pull_off
  end type layered_contact_t

contains

  !> Whether the bodies have layers.
  pure logical function has_layers(problem)
    type(problem_t), intent(in) :: problem

    select type (body => problem%body)
    type is (layered_body_t)
      has_layers = .true.
    class default
      has_layers = .false.
    end select
  end function has_layers

  !> The contacts of layered bodies up to the displacement `largest` [m], or up to the radius
  !> `widest`. If the `work` of the law is negative, it counts as zero.
  type(layered_contact_t) function new_layered_contact(problem, largest) result(contact)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: largest
    real(wp) :: delta(2), force(2), a(0:degree), values(0:degree, 4)
    integer :: i

    select type (body => problem%body)
    type is (layered_body_t)
      contact%last = min(1.0_wp, widest*body%thinnest)
      do
        call contact_at(problem, body, contact%last, delta, force)
        if (delta(jkr) > max(0.0_wp, largest/problem%length) .and. force(jkr) > 0) exit
        if (.not. contact%last < widest*body%thinnest) exit
        contact%last = min(2*contact%last, widest*body%thinnest)
      end do
      contact%first = contact%last
      do
        call contact_at(problem, body, contact%first/2, delta, force)
        if (.not. delta(jkr) > 0 .or. contact%first < contact%last/span) exit
        contact%first = contact%first/2
      end do
      contact%first = contact%first/span
      a = contact%first*(contact%last/contact%first)**((1 + chebyshev_points(degree))/2)
      do i = 0, degree
        call contact_at(problem, body, a(i), delta, force)
        values(i, :) = [delta/a(i)**2, force/a(i)**3]
      end do
      do i = 1, 2
        contact%series(:, i, of_displacement) = chebyshev_series(values(:, i))
        contact%series(:, i, of_load) = chebyshev_series(values(:, 2 + i))
      end do
    end select
  end function new_layered_contact

  !> Displacements and loads in both theories at a contact radius.
  subroutine contact_at(problem, body, a, delta, force)
    type(problem_t), intent(in) :: problem
    type(layered_body_t), intent(in) :: body
    real(wp), intent(in) :: a
    real(wp), intent(out) :: delta(2), force(2)
    real(wp), allocatable :: x(:), w(:), sums(:, :), of_one(:), of_shape(:)
    type(factorisation_t) :: factors
    real(wp) :: at_edge(2)
    integer :: n, j

    n = fewest + ceiling(a_thickness*a/body%thinnest)
    allocate (x(n), w(n), sums(n + 1, n))
    call gauss_legendre(x, w)
    x = a*x
    w = a*w
    ! The last row belongs to the contact edge.
    call body%cosine_sums([x, a], x, sums)
    sums = sums/pi
    do j = 1, n
      sums(:, j) = sums(:, j)*w(j)
    end do
    factors%lu = sums(:n, :)
    do j = 1, n
      factors%lu(j, j) = factors%lu(j, j) + 1
    end do
    call factorise(factors)
    of_one = spread(1.0_wp, 1, n)
    of_shape = problem%shape%indentation(x)
    call solve(factors, of_one)
    call solve(factors, of_shape)
    at_edge = [1 - dot_product(sums(n + 1, :), of_one), &
      problem%shape%indentation(a) - dot_product(sums(n + 1, :), of_shape)]
    delta(hertz) = at_edge(2)/at_edge(1)
    delta(jkr) = (at_edge(2) - sqrt(4*pi*problem%coupling*max(0.0_wp, problem%law%work)*a))/ &
      at_edge(1)
    force = (delta*dot_product(w, of_one) - dot_product(w, of_shape))/problem%coupling
  end subroutine contact_at

  !> Displacement or load at a contact radius in the range of the series.
  elemental real(wp) function value_of(self, quantity, theory, a)
    class(layered_contact_t), intent(in) :: self
    integer, intent(in) :: quantity, theory
    real(wp), intent(in) :: a

    ! The position of ln a in the range of the series, from -1 to 1.
    value_of = a**(1 + quantity)*series_value(self%series(:, theory, quantity), &
      2*log(a/self%first)/log(self%last/self%first) - 1)
  end function value_of

  !> Contact radius of the stable state at a displacement or at a load, of which one is given; NaN
  !> if the range of the series has no such state.
  pure real(wp) function radius_at(self, theory, displacement, load) result(a)
    class(layered_contact_t), intent(in) :: self
    integer, intent(in) :: theory
    real(wp), intent(in), optional :: displacement, load
    type(bracket_t) :: bracket
    real(wp) :: wanted
    integer :: quantity

    quantity = merge(of_load, of_displacement, present(load))
    if (present(load)) wanted = load
    if (present(displacement)) wanted = displacement
    a = nan
    bracket = bracket_t(self%first, self%last)
    if (theory == jkr) bracket%low = least(self, quantity)
    if (self%value_of(quantity, theory, bracket%low) > wanted .or. &
      self%value_of(quantity, theory, bracket%high) < wanted) return
    do while (bracket%is_open())
      call bracket%narrow(self%value_of(quantity, theory, bracket%middle()) < wanted)
    end do
    a = bracket%middle()
  end function radius_at

  !> The smallest load of JKR theory, which is negative; NaN if it is outside the range of the
  !> series.
  pure real(wp) function pull_off(self)
    class(layered_contact_t), intent(in) :: self
    real(wp) :: a

    a = least(self, of_load)
    pull_off = nan
    if (a < inside*self%last) pull_off = self%value_of(of_load, jkr, a)
  end function pull_off

  !> Contact radius of the smallest displacement or load of JKR theory. With layers there may be
  !> several minima; therefore the search begins with radii over the whole range.
  pure real(wp) function least(self, quantity) result(a)
    type(layered_contact_t), intent(in) :: self
    integer, intent(in) :: quantity
    type(bracket_t) :: bracket
    real(wp) :: places(0:looks)
    integer :: i, lowest

    places = [(log(self%first) + log(self%last/self%first)*i/looks, i=0, looks)]
    lowest = minloc(self%value_of(quantity, jkr, exp(places)), 1) - 1
    bracket = bracket_t(places(max(0, lowest - 1)), places(min(looks, lowest + 1)))
    do i = 1, sections
      call bracket%keep_larger(-self%value_of(quantity, jkr, exp(bracket%golden_points())))
    end do
    a = exp(bracket%middle())
  end function least

end module layered_contact
