!> Deformation that varies slowly: u(r) = u(0) wherever the surfaces interact, (21) of the paper.
!> Displacement (22) and load (23) then follow from the gap on the axis alone: for any law by
!> quadrature, and in the paper's closed forms. And where this approximation lets the bodies jump.
!>
!> Everything is in the units of `problem`. With c the coupling, delta = 2 sqrt(2) c J(h), where J
!> is the integral of p(h')/sqrt(h' - h) over h' from h on.
module slow_deformation
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kinds, only: wp, pi
  use exponential, only: exponential_t
  use lennard_jones, only: lennard_jones_t
  use problem, only: problem_t
  implicit none
  private
  public :: by_quadrature, closed_form, attraction_only, has_form
  public :: slow_displacement, slow_slope, slow_load
  public :: gap_of_h0, criterion_gap, equation_37_gap, fold_gap

  !> Forms of (22) and (23): by quadrature; (31) and (32), or (35a) and (36a), the latter for either
  !> part alone too; (35b) and (36b), the attraction of Lennard-Jones without its repulsion.
  integer, parameter :: by_quadrature = 1, closed_form = 2, attraction_only = 3

  !> What a gap is searched for: an h0, a fold of h0, the stability criterion (29).
  integer, parameter :: at_h0 = 1, at_fold = 2, at_criterion = 3

  !> Steps of a search, as a fraction of the change of gap over which a law may be linearised, and
  !> how many: enough for a gap of the algebraic law to fall by 26 orders of magnitude.
  real(wp), parameter :: search_step = 0.1_wp
  integer, parameter :: most_steps = 2000
  !> Halvings that take an interval of any size to rounding.
  integer, parameter :: most_halvings = 100

contains

  !> Whether the law has this form: a closed one is known, or it has the attraction of (35b).
  pure logical function has_form(this, form)
    type(problem_t), intent(in) :: this
    integer, intent(in) :: form

    has_form = form == by_quadrature
    select type (law => this%law)
    type is (exponential_t)
      has_form = form /= attraction_only
    type is (lennard_jones_t)
      has_form = form /= attraction_only .or. law%attractive > 0
    end select
  end function has_form

  !> delta = h(0) - h0 at a gap on the axis: (22), (31), (35a) or (35b). NaN where there is no such
  !> form.
  elemental real(wp) function slow_displacement(this, form, gap) result(delta)
    type(problem_t), intent(in) :: this
    integer, intent(in) :: form
    real(wp), intent(in) :: gap

    delta = response(this, form, gap, .false.)
  end function slow_displacement

  !> The derivative of the displacement by the gap; h0 = gap - delta folds where it is 1.
  elemental real(wp) function slow_slope(this, form, gap) result(slope)
    type(problem_t), intent(in) :: this
    integer, intent(in) :: form
    real(wp), intent(in) :: gap

    slope = response(this, form, gap, .true.)
  end function slow_slope

  !> Load at a gap on the axis: Derjaguin's 2 pi E_s, (23), with the law's own energy for
  !> `by_quadrature`, else (32), (36a) or (36b). Exact for rigid bodies. NaN where there is no such
  !> form.
  elemental real(wp) function slow_load(this, form, gap) result(load)
    type(problem_t), intent(in) :: this
    integer, intent(in) :: form
    real(wp), intent(in) :: gap
    real(wp) :: energy(1)

    if (form == by_quadrature) then
      energy = this%law%energy([gap])
      load = 2*pi*energy(1)
      return
    end if
    load = nan()
    if (.not. has_form(this, form)) return
    select type (law => this%law)
    type is (exponential_t)
      load = 2*pi*decay(gap)
    type is (lennard_jones_t)
      load = 8*pi/3/gap**2*(repulsion(law, form)/gap**6/4 - law%attractive)
    end select
  end function slow_load

  !> The largest gap on the axis, not below `lowest`, at which the approximation has this h0; NaN
  !> where there is none.
  pure real(wp) function gap_of_h0(this, form, h0, lowest) result(gap)
    type(problem_t), intent(in) :: this
    integer, intent(in) :: form
    real(wp), intent(in) :: h0, lowest

    gap = largest_gap(this, form, at_h0, h0, lowest)
  end function gap_of_h0

  !> The gap on the axis at which approaching bodies come to violate the stability criterion (29),
  !> 2 p' u(0)/p = -1, with the displacement of this form. NaN where they never do: the law does
  !> not attract, or too little for these bodies.
  pure real(wp) function criterion_gap(this, form) result(gap)
    type(problem_t), intent(in) :: this
    integer, intent(in) :: form

    gap = nan()
    if (this%law%adhesion > 0) gap = largest_gap(this, form, at_criterion, 0.0_wp, rest_of(this))
  end function criterion_gap

  !> The same for the attraction of Lennard-Jones alone, where p'/p = -3/h, in closed form, (37).
  !> NaN without attraction. It does not tell whether the full law has a jump.
  pure real(wp) function equation_37_gap(this) result(gap)
    type(problem_t), intent(in) :: this

    gap = nan()
    if (this%coupling > 0 .and. has_form(this, attraction_only)) &
      gap = (6*sqrt(2.0_wp)*pi*this%coupling)**(2.0_wp/7)
  end function equation_37_gap

  !> The gap on the axis at which h0 = gap - delta has its fold: there approaching bodies lose their
  !> equilibrium in the approximation itself. NaN where there is none. With -delta = C h^(-5/2),
  !> (35b), it is at 1 = (5/2) C h^(-7/2); (37) has 3, the pressure's exponent, for 5/2.
  pure real(wp) function fold_gap(this, form) result(gap)
    type(problem_t), intent(in) :: this
    integer, intent(in) :: form

    if (form == attraction_only) then
      gap = equation_37_gap(this)*(5.0_wp/6)**(2.0_wp/7)
      return
    end if
    gap = nan()
    if (this%law%adhesion > 0) gap = largest_gap(this, form, at_fold, 0.0_wp, rest_of(this))
  end function fold_gap

  !> How near jumps are looked for: to where the law stops attracting, if it does.
  pure real(wp) function rest_of(this)
    type(problem_t), intent(in) :: this

    rest_of = -huge(1.0_wp)
    if (this%law%rest_gap > 0) rest_of = this%law%rest_gap
  end function rest_of

  !> 2 sqrt(2) c J(h) in this form, or with `of_slope` its derivative.
  elemental real(wp) function response(this, form, gap, of_slope)
    type(problem_t), intent(in) :: this
    integer, intent(in) :: form
    real(wp), intent(in) :: gap
    logical, intent(in) :: of_slope
    real(wp) :: integral, near, far

    response = nan()
    if (.not. has_form(this, form)) return
    response = 0
    if (.not. this%coupling > 0) return
    integral = 0
    if (form == by_quadrature) then
      integral = axis_integral(this, gap, of_slope)
    else
      select type (law => this%law)
      type is (exponential_t)
        integral = merge(-sqrt(pi), sqrt(pi), of_slope)*decay(gap)
      type is (lennard_jones_t)
        near = 16*repulsion(law, form)/3*cosine_integral(8)/gap**8.5_wp
        far = 16*law%attractive/3*cosine_integral(2)/gap**2.5_wp
        integral = near - far
        if (of_slope) integral = (2.5_wp*far - 8.5_wp*near)/gap
      end select
    end if
    response = 2*sqrt(2.0_wp)*this%coupling*integral
  end function response

  !> J(h) by quadrature, or with `of_slope` the same integral of p', which is its derivative. With
  !> h' = h + s^2 it is the integral of p(h + s^2) over all s. With s = scale sinh(t) the integrand
  !> falls exponentially or faster for algebraic and exponential laws alike, and the trapezoidal
  !> rule in t converges exponentially. The error is a few epsilon times the integral of the
  !> integrand's magnitude.
  pure real(wp) function axis_integral(this, gap, of_slope) result(integral)
    type(problem_t), intent(in) :: this
    real(wp), intent(in) :: gap
    logical, intent(in) :: of_slope
    !> Two rules that agree to this, one of twice as many points, leave nothing to be gained.
    real(wp), parameter :: agreement = 1.0e-13_wp
    !> A block of points below this part of the whole is followed by nothing of weight.
    real(wp), parameter :: negligible = 1.0e-18_wp
    integer, parameter :: block = 16, halvings = 8
    real(wp) :: scale, step, before, points, magnitude, more
    integer :: level

    ! A law may be singular where the gap closes, at s = i sqrt(gap); else nothing about it is much
    ! narrower than its length.
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

  contains

    !> Twice the sum of the integrand at t = first, first + step, ..., of which t = 0 counts once,
    !> and of its magnitude.
    pure subroutine add_points(first, points, magnitude)
      real(wp), intent(in) :: first
      real(wp), intent(out) :: points, magnitude
      real(wp) :: t(block), value(block)
      integer :: k

      points = 0
      magnitude = 0
      t = first + step*[(k, k=0, block - 1)]
      do
        if (of_slope) then
          value = this%law%slope(gap + (scale*sinh(t))**2)
        else
          value = this%law%pressure(gap + (scale*sinh(t))**2)
        end if
        value = 2*scale*cosh(t)*value
        if (.not. t(1) > 0) value(1) = value(1)/2
        points = points + sum(value)
        magnitude = magnitude + sum(abs(value))
        if (.not. sum(abs(value)) > negligible*magnitude) exit
        t = t + block*step
      end do
    end subroutine add_points

  end function axis_integral

  !> The largest gap not below `nearest` at which the excess is zero; far away it is negative. NaN
  !> where there is none.
  pure real(wp) function largest_gap(this, form, condition, h0, nearest) result(found)
    type(problem_t), intent(in) :: this
    integer, intent(in) :: form, condition
    real(wp), intent(in) :: h0, nearest
    !> Beyond several gaps of most tension, once that little is left of what reaches 1 at a jump, it
    !> falls to zero without turning.
    real(wp), parameter :: edges = 4, settled = -0.999_wp
    real(wp) :: lowest, gap, next, stride, value, top, above_top, below_top
    integer :: step

    found = nan()
    lowest = max(nearest, this%law%smallest_gap)
    if (.not. has_form(this, form)) return
    if (condition /= at_h0 .and. .not. this%coupling > 0) return
    gap = edges*max(this%law%edge_gap, 1.0_wp)
    if (condition == at_h0) gap = max(h0, lowest, 1.0_wp)
    stride = linear_range(gap)
    do step = 1, most_steps
      if (excess(gap) < merge(0.0_wp, settled, condition == at_h0)) exit
      gap = gap + stride
      stride = 2*stride
    end do

    ! Inwards, to the first change of sign.
    top = -huge(1.0_wp)
    above_top = gap
    below_top = gap
    do step = 1, most_steps
      if (gap <= lowest) exit
      next = inwards(gap)
      value = excess(next)
      if (value >= 0) then
        found = root(next, gap)
        return
      end if
      if (value > top) then
        top = value
        above_top = gap
        below_top = inwards(next)
      end if
      gap = next
    end do
    ! Between two steps the excess may just reach zero and turn.
    gap = maximum(below_top, above_top)
    if (excess(gap) >= 0) found = root(gap, above_top)

  contains

    !> Negative beyond the gap that is searched for, positive short of it.
    pure real(wp) function excess(gap)
      real(wp), intent(in) :: gap
      real(wp) :: pressure(1), slope(1)

      select case (condition)
      case (at_h0)
        excess = h0 - (gap - slow_displacement(this, form, gap))
      case (at_fold)
        excess = slow_slope(this, form, gap) - 1
      case default
        ! The criterion is for bodies that attract each other.
        excess = -1
        pressure = this%law%pressure([gap])
        slope = this%law%slope([gap])
        if (pressure(1) < 0) &
          excess = slow_displacement(this, form, gap)*slope(1)/pressure(1) - 1
      end select
    end function excess

    !> Change of gap within which the law may be linearised.
    pure real(wp) function linear_range(gap)
      real(wp), intent(in) :: gap

      linear_range = this%law%closure_fraction*gap + this%law%closure_length
    end function linear_range

    !> The next gap of the search.
    pure real(wp) function inwards(gap)
      real(wp), intent(in) :: gap

      inwards = max(gap - search_step*linear_range(gap), lowest)
    end function inwards

    !> Where the excess changes its sign between two gaps, by bisection.
    pure real(wp) function root(near, far)
      real(wp), intent(in) :: near, far
      real(wp) :: low, high
      integer :: halving

      low = near
      high = far
      do halving = 1, most_halvings
        root = low + (high - low)/2
        if (root <= low .or. root >= high) exit
        if (excess(root) >= 0) then
          low = root
        else
          high = root
        end if
      end do
    end function root

    !> Where the excess is largest between two gaps, by golden section, to half the digits: it is
    !> flat there.
    pure real(wp) function maximum(low, high)
      real(wp), intent(in) :: low, high
      real(wp), parameter :: golden = 0.618033988749894848_wp
      real(wp) :: a, b
      integer :: step

      a = low
      b = high
      do step = 1, 40
        if (excess(b - golden*(b - a)) > excess(a + golden*(b - a))) then
          b = a + golden*(b - a)
        else
          a = b - golden*(b - a)
        end if
      end do
      maximum = a + (b - a)/2
    end function maximum

  end function largest_gap

  !> Weight of the repulsion in a closed form.
  elemental real(wp) function repulsion(law, form)
    type(lennard_jones_t), intent(in) :: law
    integer, intent(in) :: form

    repulsion = merge(0.0_wp, law%repulsive, form == attraction_only)
  end function repulsion

  !> I_m = pi (2m)!/(2 (2^m m!)^2) of (35), the integral of cos^2m over a quarter turn.
  elemental real(wp) function cosine_integral(m) result(i)
    integer, intent(in) :: m
    integer :: k

    i = pi/2
    do k = 1, m
      i = i*(2*k - 1)/(2*k)
    end do
  end function cosine_integral

  !> exp(-gap), finite at any gap.
  elemental real(wp) function decay(gap)
    real(wp), intent(in) :: gap
    real(wp), parameter :: largest_exponent = 700

    decay = exp(min(-gap, largest_exponent))
  end function decay

  elemental real(wp) function nan()
    nan = ieee_value(nan, ieee_quiet_nan)
  end function nan

end module slow_deformation
