!> Searches for roots and maxima of a function of one variable. A search says where it wants a value
!> next and is told what was found there; evaluating the function, what that costs and how it may
!> fail are the caller's.
module root_finding
  use kinds, only: wp
  implicit none
  private
  public :: bracket_t, root_search_t, new_root_search, secant_root, golden, resolution

  !> An interval that what is searched for lies in, its ends in any order. A root is found by
  !> `narrow` while the bracket `is_open`, a maximum by `keep_larger`.
  type :: bracket_t
    real(wp) :: low = 0, high = 0
    integer, private :: narrowed = 0
  contains
    procedure :: middle
    procedure :: is_open
    procedure :: within
    procedure :: narrow
    procedure :: golden_points
    procedure :: keep_larger
  end type bracket_t

  !> The root of a continuous function between two places at which it differs in sign, to rounding:
  !> by inverse quadratic interpolation where the last three values allow it, else by halving
  !> (Chandrupatla). (A function that jumps over zero is searched for the jump.) `note` is told the
  !> value at `place` while the search `is_open`.
  type :: root_search_t
    !> The place with the smallest value: in the end the root.
    real(wp) :: root = 0
    !> The newest place, the one beyond the root, and the one before, with the values there.
    real(wp), private :: x(3) = 0, f(3) = 0
    !> The part of the way from the newest to the one beyond the root that the next place is at.
    real(wp), private :: part = 0.5_wp
    integer, private :: noted = 0
    logical, private :: met = .false.
  contains
    procedure :: place
    procedure :: is_open => root_is_open
    procedure :: note
    procedure, private :: choose_part
  end type root_search_t

  !> The part of an interval that a golden section keeps.
  real(wp), parameter :: golden = 0.618033988749894848_wp
  !> Halvings that take an interval of any size to rounding.
  integer, parameter :: most_halvings = 100

contains

  elemental real(wp) function middle(self)
    class(bracket_t), intent(in) :: self

    middle = 0.5_wp*(self%low + self%high)
  end function middle

  !> Whether there is a number between the ends, and so few halvings were made that the next tells
  !> anything.
  elemental logical function is_open(self)
    class(bracket_t), intent(in) :: self

    is_open = self%narrowed < most_halvings .and. abs(self%middle() - self%low) > 0 .and. &
      abs(self%middle() - self%high) > 0
  end function is_open

  !> x if it lies in the interval (low < high), else the middle.
  elemental real(wp) function within(self, x)
    class(bracket_t), intent(in) :: self
    real(wp), intent(in) :: x

    within = x
    if (.not. (x >= self%low .and. x <= self%high)) within = self%middle()
  end function within

  !> Moves an end to the middle or, where it is given, to `at`: the low one where the root is beyond
  !> it, else the high one.
  elemental subroutine narrow(self, root_beyond, at)
    class(bracket_t), intent(inout) :: self
    logical, intent(in) :: root_beyond
    real(wp), intent(in), optional :: at
    real(wp) :: place

    place = self%middle()
    if (present(at)) place = at
    if (root_beyond) then
      self%low = place
    else
      self%high = place
    end if
    self%narrowed = self%narrowed + 1
  end subroutine narrow

  !> The two places that a golden section compares, the one nearer to `low` first.
  pure function golden_points(self) result(points)
    class(bracket_t), intent(in) :: self
    real(wp) :: points(2)

    points = [self%high - golden*(self%high - self%low), self%low + golden*(self%high - self%low)]
  end function golden_points

  !> Drops the end beyond the golden point with the smaller one of these values.
  pure subroutine keep_larger(self, values)
    class(bracket_t), intent(inout) :: self
    real(wp), intent(in) :: values(2)
    real(wp) :: points(2)

    points = self%golden_points()
    if (values(1) > values(2)) then
      self%high = points(2)
    else
      self%low = points(1)
    end if
  end subroutine keep_larger

  !> A search between a and b, at which the function has the values f_a and f_b.
  elemental type(root_search_t) function new_root_search(a, f_a, b, f_b) result(search)
    real(wp), intent(in) :: a, f_a, b, f_b

    search%x(:2) = [a, b]
    search%f(:2) = [f_a, f_b]
    search%root = merge(a, b, abs(f_a) < abs(f_b))
    ! Of one sign: rounding at an end that is the root.
    search%met = (f_a > 0 .eqv. f_b > 0) .or. abs(f_a) <= 0 .or. abs(f_b) <= 0
    if (.not. search%met) search%part = f_a/(f_a - f_b)
  end function new_root_search

  !> Whether another value tells anything.
  elemental logical function root_is_open(self)
    class(root_search_t), intent(in) :: self

    root_is_open = .not. self%met .and. self%noted < most_halvings .and. &
      abs(self%x(2) - self%x(1)) > resolution(self%root)
  end function root_is_open

  !> Where the function is to be evaluated next.
  elemental real(wp) function place(self)
    class(root_search_t), intent(in) :: self

    place = self%x(1) + self%part*(self%x(2) - self%x(1))
  end function place

  !> Takes the value at x, the place that was asked for.
  elemental subroutine note(self, x, value)
    class(root_search_t), intent(inout) :: self
    real(wp), intent(in) :: x, value

    self%noted = self%noted + 1
    self%met = abs(value) <= 0
    if ((value > 0) .eqv. (self%f(1) > 0)) then
      self%x(3) = self%x(1)
      self%f(3) = self%f(1)
    else
      self%x(2:) = [self%x(1), self%x(2)]
      self%f(2:) = [self%f(1), self%f(2)]
    end if
    self%x(1) = x
    self%f(1) = value
    self%root = merge(self%x(1), self%x(2), abs(self%f(1)) < abs(self%f(2)))
    if (self%is_open()) call self%choose_part()
  end subroutine note

  !> Interpolates where the place is a monotonic function of the value between the three. No place
  !> is nearer to another than can be told.
  elemental subroutine choose_part(self)
    class(root_search_t), intent(inout) :: self
    real(wp) :: of_way, of_rise, least

    self%part = 0.5_wp
    associate (x => self%x, f => self%f)
      if (abs(f(3) - f(1)) <= 0 .or. abs(f(3) - f(2)) <= 0) return
      of_way = (x(1) - x(2))/(x(3) - x(2))
      of_rise = (f(1) - f(2))/(f(3) - f(2))
      if (of_rise**2 < of_way .and. (1 - of_rise)**2 < 1 - of_way) self%part = &
        f(1)/(f(2) - f(1))*(f(3)/(f(2) - f(3))) + &
        (x(3) - x(1))/(x(2) - x(1))*(f(1)/(f(3) - f(1)))*(f(2)/(f(3) - f(2)))
      least = min(0.5_wp, resolution(self%root)/abs(x(2) - x(1)))
      self%part = max(least, min(1 - least, self%part))
    end associate
  end subroutine choose_part

  !> Differences from x that are no more than rounding: between one and two units of its last
  !> place. (The intrinsic `spacing` takes x to pieces by calls, which shows in the rows' cost.)
  elemental real(wp) function resolution(x)
    real(wp), intent(in) :: x

    resolution = max(epsilon(x)*abs(x), tiny(x))
  end function resolution

  !> Where the line through (x, value) and (x_before, value_before) is zero; the values differ.
  elemental real(wp) function secant_root(x, value, x_before, value_before)
    real(wp), intent(in) :: x, value, x_before, value_before

    secant_root = x - value*(x - x_before)/(value - value_before)
  end function secant_root

end module root_finding
