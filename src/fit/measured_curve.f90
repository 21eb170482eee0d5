!> A measured force curve (`measurement_t`): the deflection of a spring, or the force, while its
!> base moves to the other body and back.
module measured_curve
  use kinds, only: wp
  use fit_request, only: measurement_t, of_radius
  implicit none
  private
  public :: measured_curve_t

  !> Samples in the order of the file, the approach first. The contact point is the z at which
  !> undeformed bodies under a relaxed spring would touch. The position of the base (`drive_t`) is
  !> facing*(z - contact point); facing is 1 if z falls towards the other body, otherwise -1.
  type, extends(measurement_t) :: measured_curve_t
    real(wp), allocatable :: z(:), signal(:)
    logical, allocatable :: inward(:)
    !> The quantity that each sample observes: the signal, or the contact radius. In data without
    !> positions, z is the load divided by the load of one unit of the signal.
    integer, allocatable :: observed(:)
    !> The contact radii [m] of the same rows, 0 in rows without one, until `add_radii` is called.
    real(wp), allocatable :: contact_radius(:)
    real(wp) :: facing = 1
    !> Samples far from contact, which show the baseline, once they are known.
    logical, allocatable :: far(:)
    !> usable: samples in use. skipped: samples left out by the deck, or because the base rested
    !> there (rested). The samples that are neither usable nor skipped are outliers.
    logical, allocatable :: usable(:), skipped(:), rested(:)
    !> A description of how the file was understood, for the user: columns, units, rows of each
    !> segment, and rows left out.
    character(len=:), allocatable :: understood
  contains
    procedure :: outlier
    procedure :: add_radii
    procedure :: of_signal
    procedure :: retain
  end type measured_curve_t

contains

  !> Marks the outliers.
  pure function outlier(self)
    class(measured_curve_t), intent(in) :: self
    logical :: outlier(size(self%z))

    outlier = .not. (self%usable .or. self%skipped)
  end function outlier

  !> Turns the contact radii that were read beside the signal into separate samples. Each row of the
  !> file then has as many samples as observed quantities.
  pure subroutine add_radii(self)
    class(measured_curve_t), intent(inout) :: self
    logical, allocatable :: seen(:)

    if (.not. allocated(self%contact_radius)) return
    seen = self%contact_radius > 0
    self%z = [self%z, pack(self%z, seen)]
    self%signal = [self%signal, pack(self%contact_radius, seen)]
    self%inward = [self%inward, pack(self%inward, seen)]
    self%usable = [self%usable, .not. pack(self%skipped, seen)]
    self%skipped = [self%skipped, pack(self%skipped, seen)]
    self%rested = [self%rested, pack(self%rested, seen)]
    self%far = [self%far, spread(.false., 1, count(seen))]
    self%observed = [self%observed, spread(of_radius, 1, count(seen))]
    deallocate (self%contact_radius)
  end subroutine add_radii

  !> The samples of the signal alone, or of the contact radii if there is no signal.
  pure type(measured_curve_t) function of_signal(self) result(other)
    class(measured_curve_t), intent(in) :: self
    logical :: keep(size(self%z))

    other = self
    keep = self%observed == self%observed(1)
    if (.not. all(keep)) call other%retain(keep)
  end function of_signal

  !> Keeps the samples marked by `keep` and drops the others.
  pure subroutine retain(self, keep)
    class(measured_curve_t), intent(inout) :: self
    logical, intent(in) :: keep(:)

    self%z = pack(self%z, keep)
    self%signal = pack(self%signal, keep)
    self%inward = pack(self%inward, keep)
    self%skipped = pack(self%skipped, keep)
    self%rested = pack(self%rested, keep)
    self%far = pack(self%far, keep)
    self%usable = pack(self%usable, keep)
    self%observed = pack(self%observed, keep)
  end subroutine retain

end module measured_curve
