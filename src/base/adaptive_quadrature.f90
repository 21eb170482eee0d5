!> The integral of a function of one variable, as exact as rounding allows. It says where it wants
!> values next and is told what was found there; evaluating the function is the caller's.
!>
!> Each piece is integrated by the rule of Gauss and Kronrod with 15 nodes. Where the 7 nodes of
!> Gauss among them say something else, the piece is halved: steps, kinks and poles cost pieces and
!> no digits. The estimate of the error is that of QUADPACK (Piessens and others, 1983).
module adaptive_quadrature
  use kinds, only: wp
  implicit none
  private
  public :: integral_t, new_integral, rule_nodes, in_order

  integer, parameter :: rule_nodes = 15

  type :: integral_t
    !> What is known so far: the integral, and its error.
    real(wp) :: value = 0, error = 0
    !> Integral of the function's magnitude over the pieces that were looked at.
    real(wp), private :: magnitude = 0
    !> Both ends of each piece, and what of the magnitude was counted before it was cut from a
    !> longer one; how many there are, and which is the next.
    real(wp), allocatable, private :: piece(:, :)
    integer, private :: pieces = 0, next = 1
  contains
    procedure :: is_open
    procedure :: places
    procedure :: note
    procedure, private :: cut
  end type integral_t

  !> Nodes above 0 of the rule on [-1, 1], every second one of Gauss; weights of Kronrod and Gauss,
  !> with those of the node 0 last.
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

  !> Errors of pieces that count for nothing, as a part of the whole magnitude; what rounding leaves
  !> of a piece; and pieces after which the error stays what it is.
  real(wp), parameter :: negligible = 1.0e-15_wp, rounding = 50*epsilon(1.0_wp)
  integer, parameter :: most_pieces = 20000

contains

  !> An integral over pieces with these ends. known: another one that it is part of a whole with.
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

  !> Whether more values are wanted.
  elemental logical function is_open(self)
    class(integral_t), intent(in) :: self

    is_open = self%next <= self%pieces
  end function is_open

  !> Where they are wanted, in ascending order.
  pure function places(self) result(x)
    class(integral_t), intent(in) :: self
    real(wp) :: x(rule_nodes)

    associate (left => self%piece(1, self%next), right => self%piece(2, self%next))
      x = left + 0.5_wp*(right - left)*(1 + nodes)
    end associate
  end function places

  !> Takes the values at those places.
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

  !> Puts the halves of the piece in hand behind the others, each with what is counted of its
  !> magnitude; not done where there are no numbers between its ends, or too many pieces.
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
