!> Searches for roots and maxima of a function of one variable. The caller evaluates the function:
!> a search gives the abscissa, and takes the value.
module root_finding
  use kinds, only: wp
  implicit none
  private
  public :: bracket_t, root_search_t, new_root_search, resolution

  !> An interval that contains a root or a maximum, its ends in any order. `narrow` finds a root
  !> while the bracket `is_open`, `keep_larger` a maximum.
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

  !> The root of a continuous function between two abscissas at which its signs differ, to rounding:
  !> by inverse quadratic interpolation where the last three values allow it, else by halving
  !> (Chandrupatla). (Of a function that jumps over zero it finds the jump.) While the search
  !> `is_open`, `note` takes the value at `place`.
  type :: root_search_t
    !> The abscissa with the smallest magnitude of the value: at the end the root.
    real(wp) :: root = 0
    !> The newest abscissa, the one on the other side of the root, and the one before; their values.
    real(wp), private :: x(3) = 0, f(3) = 0
    !> The next abscissa, as a fraction of the way from the newest one to the other side.
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
  !> Number of halvings that take an interval of any size to rounding.
  integer, parameter :: most_halvings = 100

contains

  !> The middle of the interval.
  elemental real(wp) function middle(self)
    class(bracket_t), intent(in) :: self

    middle = 0.5_wp*(self%low + self%high)
  end function middle

  !> Whether the interval can be halved again: a number lies between the ends, and the limit of
  !> halvings is not reached.
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

  !> Moves an end to the middle or, if given, to `at`: the low end if the root is beyond this place,
  !> otherwise the high end.
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

  !> The two abscissas that a golden section compares, the one nearer to `low` first.
  pure function golden_points(self) result(points)
    class(bracket_t), intent(in) :: self
    real(wp) :: points(2)

    points = [self%high - golden*(self%high - self%low), self%low + golden*(self%high - self%low)]
  end function golden_points

  !> Drops the end next to the golden point with the smaller value.
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
    ! If the signs are equal, an end is the root except for rounding.
    search%met = (f_a > 0 .eqv. f_b > 0) .or. abs(f_a) <= 0 .or. abs(f_b) <= 0
    if (.not. search%met) search%part = f_a/(f_a - f_b)
  end function new_root_search

  !> Whether another value improves the root.
  elemental logical function root_is_open(self)
    class(root_search_t), intent(in) :: self

    root_is_open = .not. self%met .and. self%noted < most_halvings .and. &
      abs(self%x(2) - self%x(1)) > resolution(self%root)
  end function root_is_open

  !> The abscissa of the next value.
  elemental real(wp) function place(self)
    class(root_search_t), intent(in) :: self

    place = self%x(1) + self%part*(self%x(2) - self%x(1))
  end function place

  !> Takes the value at x, the last `place`.
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

  !> Interpolates if the abscissa is a monotonic function of the value between the three points. The
  !> next abscissa keeps a distance of `resolution` from both ends.
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

  !> The largest difference from x that is only rounding: between one and two units in the last
  !> place. (The intrinsic `spacing` is slower.)
  elemental real(wp) function resolution(x)
    real(wp), intent(in) :: x

    resolution = max(epsilon(x)*abs(x), tiny(x))
  end function resolution

end module root_finding
