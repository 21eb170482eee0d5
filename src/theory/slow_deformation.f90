!> The approximation of slowly varying deformation: u(r) = u(0) wherever the surfaces interact, (21)
!> of the paper. Displacement (22) and load (23) then follow from the gap on the axis, for any law
!> by quadrature, and for some laws in the paper's closed forms.
!>
!> All quantities are in the units of `dimensionless_problem`. With c the coupling, delta = 2
!> sqrt(2) c J(h), where J is the integral of p(h')/sqrt(h' - h) over h' from h to infinity.
module slow_deformation
  use kinds, only: wp, pi, nan
  use adaptive_quadrature, only: integral_t, new_integral, in_order
  use exponential, only: exponential_t, largest_exponent
  use lennard_jones, only: lennard_jones_t
  use dimensionless_problem, only: problem_t
  implicit none
  private
  public :: by_quadrature, closed_form, attraction_only, has_form
  public :: slow_displacement, slow_slope, slow_load

  !> Forms of (22) and (23): by quadrature; the closed forms (31) and (32), or (35a) and (36a), the
  !> latter also for either part of the law; (35b) and (36b), the attraction of Lennard-Jones alone.
  integer, parameter :: by_quadrature = 1, closed_form = 2, attraction_only = 3

contains

  !> Whether the law has this form.
  pure logical function has_form(problem, form)
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: form

    has_form = form == by_quadrature
    select type (law => problem%law)
    type is (exponential_t)
      has_form = form /= attraction_only
    type is (lennard_jones_t)
      has_form = form /= attraction_only .or. law%attractive > 0
    end select
  end function has_form

  !> delta = h(0) - h0 at a gap on the axis: (22), (31), (35a) or (35b). NaN if the law has no such
  !> form.
  elemental real(wp) function slow_displacement(problem, form, gap) result(delta)
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: form
    real(wp), intent(in) :: gap

    delta = response(problem, form, gap, .false.)
  end function slow_displacement

  !> The derivative of the displacement by the gap. h0 = gap - delta has a fold where this
  !> derivative is 1.
  elemental real(wp) function slow_slope(problem, form, gap) result(slope)
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: form
    real(wp), intent(in) :: gap

    slope = response(problem, form, gap, .true.)
  end function slow_slope

  !> Load at a gap on the axis: Derjaguin's 2 pi E_s, (23), with the law's own energy for
  !> `by_quadrature`, otherwise (32), (36a) or (36b). It is exact for rigid bodies. NaN if the law
  !> has no such form.
  elemental real(wp) function slow_load(problem, form, gap) result(load)
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: form
    real(wp), intent(in) :: gap
    real(wp) :: energy(1)

    if (form == by_quadrature) then
      energy = problem%law%energy([gap])
      load = 2*pi*energy(1)
      return
    end if
    load = nan
    if (.not. has_form(problem, form)) return
    select type (law => problem%law)
    type is (exponential_t)
      load = 2*pi*decay(gap)
    type is (lennard_jones_t)
      load = pi/gap**2*(repulsion(law, form)/gap**6/4 - law%attractive)
    end select
  end function slow_load

  !> 2 sqrt(2) c J(h) in this form, or its derivative if `of_slope` is given.
  elemental real(wp) function response(problem, form, gap, of_slope)
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: form
    real(wp), intent(in) :: gap
    logical, intent(in) :: of_slope
    real(wp) :: integral, near, far

    response = nan
    if (.not. has_form(problem, form)) return
    response = 0
    if (.not. problem%coupling > 0) return
    integral = 0
    if (form == by_quadrature) then
      integral = axis_integral(problem, gap, of_slope)
    else
      select type (law => problem%law)
      type is (exponential_t)
        integral = merge(-sqrt(pi), sqrt(pi), of_slope)*decay(gap)
      type is (lennard_jones_t)
        near = 2*repulsion(law, form)*cosine_integral(8)/gap**8.5_wp
        far = 2*law%attractive*cosine_integral(2)/gap**2.5_wp
        integral = near - far
        if (of_slope) integral = (2.5_wp*far - 8.5_wp*near)/gap
      end select
    end if
    response = 2*sqrt(2.0_wp)*problem%coupling*integral
  end function response

  !> J(h) by quadrature. With `of_slope` it is the same integral of p', which is the derivative.
  !> With h' = h + s^2, J is the integral of p(h + s^2) over all s. With s = scale sinh(t) the
  !> integrand falls exponentially or faster, both for algebraic and for exponential laws, so that
  !> the trapezoidal rule in t converges exponentially. If it does not converge, the law has a step,
  !> a kink or a short period, and the integral is computed in pieces. The error is a few epsilon
  !> times the integral of the integrand's magnitude.
  pure real(wp) function axis_integral(problem, gap, of_slope) result(integral)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: gap
    logical, intent(in) :: of_slope
    !> The rule counts as converged if halving the step changes the result by less than this
    !> fraction.
    real(wp), parameter :: agreement = 1.0e-13_wp
    !> If a block of points contributes less than this fraction of the whole, further points are
    !> negligible.
    real(wp), parameter :: negligible = 1.0e-18_wp
    integer, parameter :: block = 16, halvings = 5
    real(wp) :: scale, step, before, points, magnitude, more
    integer :: level

    ! The law may be singular at a gap of 0, which is at s = i sqrt(gap); otherwise it varies over
    ! lengths of order 1.
    scale = 1
    if (gap > 0) scale = sqrt(min(gap, 1.0_wp))
    step = 0.5_wp
    call add_points(0.0_wp, points, magnitude)
    integral = step*points
    do level = 1, halvings
      before = integral
      call add_points(step/2, points, more)
      magnitude = max(magnitude, more)
      integral = (before + step*points)/2
      if (abs(integral - before) <= agreement*step*magnitude) return
      step = step/2
    end do
    integral = in_pieces()

  contains

    !> Twice the sum of the integrand at t = first, first + step, ... (the value at t = 0 counts
    !> once), and twice the sum of its magnitude.
    pure subroutine add_points(first, points, magnitude)
      real(wp), intent(in) :: first
      real(wp), intent(out) :: points, magnitude
      real(wp) :: t(block), value(block)
      integer :: k

      points = 0
      magnitude = 0
      t = first + step*[(k, k=0, block - 1)]
      do
        value = 2*integrand(t)
        if (.not. t(1) > 0) value(1) = value(1)/2
        points = points + sum(value)
        magnitude = magnitude + sum(abs(value))
        if (.not. sum(abs(value)) > negligible*magnitude) exit
        t = t + block*step
      end do
    end subroutine add_points

    !> The integral, computed in pieces that end at the breaks of the law.
    pure real(wp) function in_pieces()
      !> Further ends of pieces. Beyond the last one the integrand is negligible, since it falls as
      !> exp(-t) or faster.
      real(wp), parameter :: usual(*) = &
        [0.0_wp, 0.5_wp, 1.0_wp, 2.0_wp, 3.0_wp, 5.0_wp, 8.0_wp, 12.0_wp, 20.0_wp, 40.0_wp]
      type(integral_t) :: pieces
      real(wp), allocatable :: ends(:)

      ends = usual
      if (allocated(problem%law%breaks)) ends = [usual, &
        asinh(sqrt(pack(problem%law%breaks, problem%law%breaks > gap) - gap)/scale)]
      ends = in_order(ends)
      pieces = new_integral(ends(:size(ends) - 1), ends(2:))
      do while (pieces%is_open())
        call pieces%note(integrand(pieces%places()))
      end do
      in_pieces = 2*pieces%value
    end function in_pieces

    pure function integrand(t) result(value)
      real(wp), intent(in) :: t(:)
      real(wp) :: value(size(t))

      if (of_slope) then
        value = problem%law%slope(gap + (scale*sinh(t))**2)
      else
        value = problem%law%pressure(gap + (scale*sinh(t))**2)
      end if
      value = scale*cosh(t)*value
    end function integrand

  end function axis_integral

  !> The factor that multiplies the repulsion in a closed form.
  elemental real(wp) function repulsion(law, form)
    type(lennard_jones_t), intent(in) :: law
    integer, intent(in) :: form

    repulsion = merge(0.0_wp, law%repulsive, form == attraction_only)
  end function repulsion

  !> I_m = pi (2m)!/(2 (2^m m!)^2) of (35), the integral of cos^2m from 0 to pi/2.
  elemental real(wp) function cosine_integral(m) result(i)
    integer, intent(in) :: m
    integer :: k

    i = pi/2
    do k = 1, m
      i = i*(2*k - 1)/(2*k)
    end do
  end function cosine_integral

  !> exp(-gap), limited to a finite value.
  elemental real(wp) function decay(gap)
    real(wp), intent(in) :: gap

    decay = exp(min(-gap, largest_exponent))
  end function decay
end module slow_deformation
