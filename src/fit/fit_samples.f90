!> The samples of a measured curve that count in a fit, and the side of the jump on which each one
!> is. Procedures whiten residuals and remove the baseline.
!>
!> The baseline is a sum of given columns (`baseline`). It does not depend on the unknowns of a
!> model, so one projection removes it from residuals and from their derivatives.
module fit_samples
  use kinds, only: wp
  use measured_curve, only: measured_curve_t
  use measured_jumps, only: measured_jump_t
  use fit_request, only: of_radius
  use noise, only: noise_t, whiten
  use force_model, only: inward, outward
  implicit none
  private
  public :: fit_samples_t, orthonormalise, is_rounding, solve_triangle

  type :: fit_samples_t
    type(measured_curve_t) :: measured
    type(noise_t) :: noise
    !> The smallest standard deviation of the noise, set by rounding in a signal of few digits.
    real(wp) :: least_noise = 0
    !> Whether the deck gives the noise.
    logical :: noise_is_given = .false.
    !> Standard deviation of contact radii beside a signal [m], and whether the deck gives it.
    real(wp) :: noise_radius = 0
    logical :: noise_radius_is_given = .false.
    type(measured_jump_t) :: jump(2)
    !> The samples that count. For all samples: the segment, the side of the jump of this segment
    !> (`load_on`), and the number of the run.
    integer, allocatable :: sample(:), way(:), side(:), run(:)
    !> The columns of the baseline at all samples. The whitened columns at the samples that count
    !> are the product of an orthonormal basis and a triangular matrix.
    real(wp), allocatable, private :: column(:, :), basis(:, :), triangle(:, :)
    !> For each sample that counts: the factor by which the residual is multiplied so that its noise
    !> is that of the signal.
    real(wp), allocatable, private :: weight(:)
  contains
    procedure :: take
    procedure :: keep_way
    procedure :: is_beside
    procedure :: baseline_numbers
    procedure, private :: whiten_columns
    procedure :: clean
    procedure :: baseline_under
    procedure :: amplitudes_under
  end type fit_samples_t

contains

  !> Selects the samples that count, every `every`-th of them, and makes the columns of the
  !> baseline.
  subroutine take(self, every)
    class(fit_samples_t), intent(inout) :: self
    integer, intent(in) :: every
    logical :: counts(size(self%measured%z))
    integer :: i, n

    associate (data => self%measured)
      n = size(data%z)
      self%way = merge(inward, outward, data%inward)
      self%side = [(0, i=1, n)]
      do i = 1, n
        associate (jump => self%jump(self%way(i)))
          if (jump%before == 0) cycle
          if (self%is_beside(i)) then
            ! A contact radius is measured in contact: after the snap-in, before the snap-off.
            self%side(i) = merge(2, 1, data%inward(i))
            cycle
          end if
          ! The last sample before the jump, number `before`, does not count: the slope there may be
          ! arbitrarily large.
          if (i < jump%before) self%side(i) = 1
          if (i >= jump%before .and. i < jump%after) self%side(i) = -1
          if (i >= jump%after) self%side(i) = 2
        end associate
      end do
      counts = self%side >= 0 .and. data%usable
      ! A run is a sequence of neighbours of one segment and one side of the jump. Contact radii
      ! beside a signal have white noise; therefore each of them is a run of its own.
      self%run = [(1, i=1, n)]
      do i = 2, n
        self%run(i) = self%run(i - 1)
        if (self%is_beside(i) .or. self%way(i) /= self%way(i - 1) .or. &
          self%side(i) /= self%side(i - 1) .or. &
          (counts(i) .neqv. counts(i - 1))) self%run(i) = self%run(i - 1) + 1
      end do
      self%sample = pack([(i, i=1, n)], counts .and. [(mod(i, every) == 0, i=1, n)])
      call set_baseline(self)
    end associate
  end subroutine take

  !> Whether a sample is a contact radius that was measured beside a signal.
  pure logical function is_beside(self, i)
    class(fit_samples_t), intent(in) :: self
    integer, intent(in) :: i

    is_beside = self%measured%observed(i) /= self%measured%observed(1)
  end function is_beside

  !> Drops the samples of the other segment.
  subroutine keep_way(self, inward)
    class(fit_samples_t), intent(inout) :: self
    logical, intent(in) :: inward
    logical :: keep(size(self%measured%z))
    integer :: way, first

    way = merge(1, 2, inward)
    keep = self%measured%inward .eqv. inward
    first = findloc(keep, .true., 1) - 1
    call self%measured%retain(keep)
    self%jump(3 - way) = measured_jump_t()
    if (self%jump(way)%before > 0) then
      self%jump(way)%before = self%jump(way)%before - first
      self%jump(way)%after = self%jump(way)%after - first
    end if
    call self%take(1)
  end subroutine keep_way

  !> Makes the columns of the baseline, and their whitened basis.
  pure subroutine set_baseline(self)
    type(fit_samples_t), intent(inout) :: self
    real(wp), allocatable :: column(:, :)
    integer :: i

    associate (data => self%measured)
      column = data%baseline%columns(data%z, data%inward)
      ! Contact radii have no baseline.
      if (data%observed(1) == of_radius) column = column(:, :0)
      do i = 1, size(column, 2)
        column(:, i) = merge(column(:, i), 0.0_wp, data%observed /= of_radius)
      end do
    end associate
    self%weight = [(1.0_wp, i=1, size(self%sample))]
    if (self%noise_radius > 0) self%weight = [(merge(self%noise%left(0)/self%noise_radius, 1.0_wp, &
      self%is_beside(self%sample(i))), i=1, size(self%sample))]
    self%basis = column(self%sample, :)
    call move_alloc(column, self%column)
    call self%whiten_columns(self%basis)
    call orthonormalise(self%basis, self%triangle)
  end subroutine set_baseline

  !> Factorises a = q r by the Gram-Schmidt procedure, which is applied twice to reduce rounding
  !> errors.
  pure subroutine orthonormalise(q, r)
    real(wp), intent(inout) :: q(:, :)
    real(wp), allocatable, intent(out) :: r(:, :)
    real(wp) :: part
    integer :: i, j, pass

    allocate (r(size(q, 2), size(q, 2)), source=0.0_wp)
    do j = 1, size(q, 2)
      do pass = 1, 2
        do i = 1, j - 1
          part = dot_product(q(:, i), q(:, j))
          q(:, j) = q(:, j) - part*q(:, i)
          r(i, j) = r(i, j) + part
        end do
      end do
      r(j, j) = norm2(q(:, j))
      q(:, j) = q(:, j)/max(r(j, j), tiny(1.0_wp))
    end do
  end subroutine orthonormalise

  !> Whether the rest of a vector after a projection is a rounding error of derivatives. whole: the
  !> length of the vector before.
  pure logical function is_rounding(rest, whole)
    real(wp), intent(in) :: rest(:), whole
    real(wp), parameter :: rounding = 1.0e-4_wp

    is_rounding = .not. norm2(rest) > rounding*whole
  end function is_rounding

  !> The number of columns of the baseline.
  pure integer function baseline_numbers(self)
    class(fit_samples_t), intent(in) :: self

    baseline_numbers = size(self%column, 2)
  end function baseline_numbers

  !> Whitens columns of numbers, one number for each sample that counts, and removes the baseline
  !> from them.
  pure subroutine clean(self, column)
    class(fit_samples_t), intent(in) :: self
    real(wp), intent(inout) :: column(:, :)

    integer :: k

    call self%whiten_columns(column)
    do k = 1, size(column, 2)
      column(:, k) = column(:, k) - matmul(self%basis, matmul(column(:, k), self%basis))
    end do
  end subroutine clean

  !> Whitens columns of numbers, one number for each sample that counts.
  pure subroutine whiten_columns(self, column)
    class(fit_samples_t), intent(in) :: self
    real(wp), intent(inout) :: column(:, :)
    integer :: k

    do k = 1, size(column, 2)
      column(:, k) = self%weight*column(:, k)
    end do
    call whiten(self%noise, self%run(self%sample), column)
  end subroutine whiten_columns

  !> The best baseline, at all samples, for a signal from which the force has been subtracted.
  pure function baseline_under(self, signal) result(line)
    class(fit_samples_t), intent(in) :: self
    real(wp), intent(in) :: signal(:)
    real(wp) :: line(size(signal))

    line = matmul(self%column, self%amplitudes_under(signal))
  end function baseline_under

  !> The amplitudes of the columns in the best baseline.
  pure function amplitudes_under(self, signal) result(part)
    class(fit_samples_t), intent(in) :: self
    real(wp), intent(in) :: signal(:)
    real(wp) :: left(size(self%sample), 1), part(size(self%column, 2))

    left(:, 1) = signal(self%sample)
    call self%whiten_columns(left)
    part = matmul(left(:, 1), self%basis)
    call solve_triangle(self%triangle, part)
  end function amplitudes_under

  !> Replaces x by the solution of r x = x.
  pure subroutine solve_triangle(r, x)
    real(wp), intent(in) :: r(:, :)
    real(wp), intent(inout) :: x(:)
    integer :: i

    do i = size(x), 1, -1
      x(i) = (x(i) - dot_product(r(i, i + 1:), x(i + 1:)))/max(r(i, i), tiny(1.0_wp))
    end do
  end subroutine solve_triangle

end module fit_samples
