!> The integral of a function of one variable, to rounding. The caller evaluates the function:
!> while the integral `is_open`, `places` gives the abscissas, and `note` takes the values.
!>
!> Each piece is integrated by the Gauss-Kronrod rule with 15 nodes. A piece is halved if the Gauss
!> rule with 7 of these nodes gives a different result. Steps, kinks and poles of the function
!> therefore need more pieces, but the result does not lose digits. The error estimate is that of
!> QUADPACK (Piessens and others, 1983).
module adaptive_quadrature
  use kinds, only: wp
  implicit none
  private
  public :: integral_t, new_integral, rule_nodes, in_order

  integer, parameter :: rule_nodes = 15

  type :: integral_t
    !> The integral over the finished pieces, and its estimated error.
    real(wp) :: value = 0, error = 0
    !> Integral of the function's magnitude over the pieces evaluated so far.
    real(wp), private :: magnitude = 0
    !> Columns: both ends of a piece, and its share of the magnitude of the longer piece that it was
    !> cut from; number of pieces, and index of the next one.
    real(wp), allocatable, private :: piece(:, :)
    integer, private :: pieces = 0, next = 1
  contains
    procedure :: is_open
    procedure :: places
    procedure :: note
    procedure, private :: cut
  end type integral_t

  !> Positive nodes of the rule on [-1, 1], of which every second one is a Gauss node; weights of
  !> Kronrod and of Gauss, those of the node 0 last.
  real(wp), parameter :: node(7) = [ &
    0.991455371120812639206854697526329_wp, 0.949107912342758524526189684047851_wp, &
    0.864864423359769072789712788640926_wp, 0.741531185599394439863864773280788_wp, &
    0.586087235467691130294144691838259_wp, 0.405845151377397166906606412076961_wp, &
    0.207784955007898467600689403773245_wp]
  real(wp), parameter :: kronrod(8) = [ &
    0.022935322010529224963732008058970_wp, 0.063092092629978553290700663189204_wp, &
    0.104790010322250183839876322541518_wp, 0.140653259715525918745189590510238_wp, &
    0.169004726639267902826583426598550_wp, 0.190350578064785409913256402421014_wp, &
    0.204432940075298892414161999234649_wp, 0.209482141084727828012999174891714_wp]
  real(wp), parameter :: gauss(4) = [ &
    0.129484966168869693270611432679082_wp, 0.279705391489276667901467771423780_wp, &
    0.381830050505118944950369775488975_wp, 0.417959183673469387755102040816327_wp]
  !> The whole rule in ascending order, and the weights of its Gauss nodes.
  real(wp), parameter :: nodes(rule_nodes) = [-node, 0.0_wp, node(7:1:-1)], &
    weights(rule_nodes) = [kronrod, kronrod(7:1:-1)], gauss_weights(7) = [gauss, gauss(3:1:-1)]

  !> Error of a negligible piece as a part of the whole magnitude; rounding error of a piece as a
  !> part of its magnitude; and the number of pieces at which halving ends.
  real(wp), parameter :: negligible = 1.0e-15_wp, rounding = 50*epsilon(1.0_wp)
  integer, parameter :: most_pieces = 20000

contains

  !> An integral over pieces with these ends. known: another part of the same integral. Whether an
  !> error is negligible is judged relative to the magnitude of both parts.
  pure type(integral_t) function new_integral(left, right, known) result(integral)
    real(wp), intent(in) :: left(:), right(:)
    type(integral_t), intent(in), optional :: known

    if (present(known)) integral%magnitude = known%magnitude
    integral%pieces = size(left)
    allocate (integral%piece(3, 2*size(left)), source=0.0_wp)
    integral%piece(1, :size(left)) = left
    integral%piece(2, :size(left)) = right
  end function new_integral

  !> Numbers in ascending order (Shell's sort).
  pure function in_order(x) result(ordered)
    real(wp), intent(in) :: x(:)
    real(wp) :: ordered(size(x)), moved
    integer :: apart, i, j

    ordered = x
    apart = size(x)/2
    do while (apart > 0)
      do i = apart + 1, size(x)
        moved = ordered(i)
        do j = i - apart, 1, -apart
          if (.not. ordered(j) > moved) exit
          ordered(j + apart) = ordered(j)
        end do
        ordered(j + apart) = moved
      end do
      apart = apart/2
    end do
  end function in_order

  !> Whether the integral needs more values.
  elemental logical function is_open(self)
    class(integral_t), intent(in) :: self

    is_open = self%next <= self%pieces
  end function is_open

  !> The abscissas at which the integral needs values, in ascending order.
  pure function places(self) result(x)
    class(integral_t), intent(in) :: self
    real(wp) :: x(rule_nodes)

    associate (left => self%piece(1, self%next), right => self%piece(2, self%next))
      x = left + 0.5_wp*(right - left)*(1 + nodes)
    end associate
  end function places

  !> Takes the values at `places`.
  pure subroutine note(self, values)
    class(integral_t), intent(inout) :: self
    real(wp), intent(in) :: values(rule_nodes)
    real(wp) :: half, whole, magnitude, variation, error
    logical :: done

    half = 0.5_wp*(self%piece(2, self%next) - self%piece(1, self%next))
    whole = half*sum(weights*values)
    magnitude = half*sum(weights*abs(values))
    variation = half*sum(weights*abs(values - 0.5_wp*whole/half))
    error = abs(whole - half*sum(gauss_weights*values(2::2)))
    if (error > 0 .and. variation > 0) error = variation*min(1.0_wp, (200*error/variation)**1.5_wp)
    self%magnitude = self%magnitude + magnitude - self%piece(3, self%next)
    if (error > max(negligible*self%magnitude, rounding*magnitude)) then
      call self%cut(0.5_wp*magnitude, done)
      if (done) return
    end if
    self%value = self%value + whole
    self%error = self%error + max(error, rounding*magnitude)
    self%next = self%next + 1
  end subroutine note

  !> Appends the halves of the current piece, each with its share of the magnitude. done = .false.
  !> if there are no numbers between its ends, or too many pieces.
  pure subroutine cut(self, counted, done)
    class(integral_t), intent(inout) :: self
    real(wp), intent(in) :: counted
    logical, intent(out) :: done
    real(wp), allocatable :: longer(:, :)
    real(wp) :: left, middle, right

    left = self%piece(1, self%next)
    right = self%piece(2, self%next)
    middle = left + 0.5_wp*(right - left)
    done = self%pieces < most_pieces .and. &
      right - left > rule_nodes*epsilon(1.0_wp)*max(abs(left), abs(right))
    if (.not. done) return
    if (self%pieces + 2 > size(self%piece, 2)) then
      allocate (longer(3, 2*(self%pieces + 2)), source=0.0_wp)
      longer(:, :self%pieces) = self%piece(:, :self%pieces)
      call move_alloc(longer, self%piece)
    end if
    self%piece(:, self%pieces + 1) = [left, middle, counted]
    self%piece(:, self%pieces + 2) = [middle, right, counted]
    self%pieces = self%pieces + 2
    self%next = self%next + 1
  end subroutine cut

end module adaptive_quadrature
