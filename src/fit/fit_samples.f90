!> The samples of a measured curve that a fit counts: which side of a jump each is on, and how what
!> is left of them is made white and freed of its baseline.
module fit_samples
  use kinds, only: wp
  use measured_curve, only: measured_t
  use measured_jumps, only: measured_jump_t
  use noise, only: noise_t, whiten
  use baseline, only: baseline_t, new_baseline
  use force_model, only: inward, outward
  implicit none
  private
  public :: fit_samples_t

  type :: fit_samples_t
    type(measured_t) :: measured
    type(noise_t) :: noise
    type(measured_jump_t) :: jump(2)
    !> The samples that count. Of all: the way, the side of its jump (`load_on`), and the run.
    integer, allocatable :: sample(:), way(:), side(:), run(:)
    type(baseline_t) :: baseline
  contains
    procedure :: take
    procedure :: clean
    procedure :: baseline_under
  end type fit_samples_t

contains

  !> Which samples count, every `every`-th, and the columns that are linear in them.
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
          ! The last before it may be as near to it as one likes, where the slope grows beyond
          ! bounds: it is number `before`.
          if (i < jump%before) self%side(i) = 1
          if (i >= jump%before .and. i < jump%after) self%side(i) = -1
          if (i >= jump%after) self%side(i) = 2
        end associate
      end do
      counts = self%side >= 0 .and. data%usable
      ! Neighbours of one way and one side of its jump.
      self%run = [(1, i=1, n)]
      do i = 2, n
        self%run(i) = self%run(i - 1)
        if (self%way(i) /= self%way(i - 1) .or. self%side(i) /= self%side(i - 1) .or. &
          (counts(i) .neqv. counts(i - 1))) self%run(i) = self%run(i - 1) + 1
      end do
      self%sample = pack([(i, i=1, n)], counts .and. [(mod(i, every) == 0, i=1, n)])
      self%baseline = new_baseline(data%z, data%inward, self%sample, self%run(self%sample), &
        self%noise)
    end associate
  end subroutine take

  !> Makes columns of numbers, one a sample that counts, white, and takes their baseline off.
  pure subroutine clean(self, column)
    class(fit_samples_t), intent(in) :: self
    real(wp), intent(inout) :: column(:, :)

    call whiten(self%noise, self%run(self%sample), column)
    call self%baseline%take_off(column)
  end subroutine clean

  !> The baseline, at all samples, that leaves least of a signal without force.
  pure function baseline_under(self, signal) result(line)
    class(fit_samples_t), intent(in) :: self
    real(wp), intent(in) :: signal(:)
    real(wp) :: line(size(signal))
    real(wp) :: left(size(self%sample), 1)

    left(:, 1) = signal(self%sample)
    call whiten(self%noise, self%run(self%sample), left)
    line = self%baseline%of(left(:, 1))
  end function baseline_under

end module fit_samples
