!> The baseline of a measured curve is the signal without a force. It is a polynomial of the
!> position, with one constant for the approach and one for the retract. It may have a ripple, such
!> as interference of light makes in a detector. A drift in time gives the two segments (approach
!> and retract) different slopes.
module baseline
  use kinds, only: wp, pi
  implicit none
  private
  public :: baseline_t, waves_of, ways_in, scaled

  !> degree: of the polynomial. slope_each_way: the slopes of the two segments are independent.
  !> ripple: a sinusoid of one period on both segments, with its own amplitude and phase on each.
  type :: baseline_t
    integer :: degree = 1
    logical :: slope_each_way = .false., ripple = .false.
    !> The period [m]; 0 while it is not known. wave: the amplitudes of the functions of `waves_of`,
    !> once they are known.
    real(wp) :: period = 0
    real(wp), allocatable :: wave(:)
  contains
    procedure :: columns
  end type baseline_t

contains

  !> The columns whose linear combinations are the baselines, at positions z on approach or retract.
  !> If the amplitudes of the ripple are known, a further column is the derivative of the ripple by
  !> its period, so that the errors of the unknowns include the error of the period.
  pure function columns(self, z, inward) result(column)
    class(baseline_t), intent(in) :: self
    real(wp), intent(in) :: z(:)
    logical, intent(in) :: inward(:)
    real(wp), allocatable :: column(:, :), wave(:, :)
    logical :: mine(size(z), 2), each
    integer :: k, way, ways

    ways = ways_in(inward)
    mine(:, 1) = inward .eqv. inward(1)
    mine(:, 2) = .not. mine(:, 1)
    allocate (column(size(z), 0))
    do way = 1, ways
      call add(column, merge(1.0_wp, 0.0_wp, mine(:, way)))
    end do
    do k = 1, self%degree
      each = k == 1 .and. self%slope_each_way
      do way = 1, merge(ways, 1, each)
        call add(column, scaled(z)**k*merge(1.0_wp, 0.0_wp, mine(:, way) .or. .not. each))
      end do
    end do
    if (.not. self%period > 0) return
    wave = waves_of(z, inward, self%period)
    do k = 1, size(wave, 2)
      call add(column, wave(:, k))
    end do
    if (.not. allocated(self%wave)) return
    associate (a => self%wave)
      call add(column, scaled(z)*matmul(wave, [(a(2*way), -a(2*way - 1), way=1, size(a)/2)]))
    end associate
  end function columns

  !> Adds a column.
  pure subroutine add(column, new)
    real(wp), allocatable, intent(inout) :: column(:, :)
    real(wp), intent(in) :: new(:)

    column = reshape([column, new], [size(new), size(column, 2) + 1])
  end subroutine add

  !> Cosine and sine of a period, each on one of the two segments.
  pure function waves_of(z, inward, period) result(wave)
    real(wp), intent(in) :: z(:), period
    logical, intent(in) :: inward(:)
    real(wp), allocatable :: wave(:, :)
    integer :: way, ways

    ways = ways_in(inward)
    allocate (wave(size(z), 2*ways))
    wave(:, 1) = cos(2*pi*(z - minval(z))/period)
    wave(:, 2) = sin(2*pi*(z - minval(z))/period)
    if (ways == 1) return
    do way = 2, 1, -1
      wave(:, 2*way - 1) = merge(wave(:, 1), 0.0_wp, inward .eqv. (inward(1) .eqv. way == 1))
      wave(:, 2*way) = merge(wave(:, 2), 0.0_wp, inward .eqv. (inward(1) .eqv. way == 1))
    end do
  end function waves_of

  !> The number of segments that have samples, 1 or 2.
  pure integer function ways_in(inward) result(ways)
    logical, intent(in) :: inward(:)

    ways = merge(2, 1, any(inward) .and. .not. all(inward))
  end function ways_in

  !> The positions minus their mean, scaled so that the largest magnitude is 1.
  pure function scaled(z) result(x)
    real(wp), intent(in) :: z(:)
    real(wp) :: x(size(z))

    x = z - sum(z)/size(z)
    x = x/maxval(abs(x))
  end function scaled

end module baseline
