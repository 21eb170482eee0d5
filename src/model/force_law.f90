!> The interface of all surface-force laws. A law is a type that extends this one. It stands in a
!> file of its own under laws/, with its keys, the reader of its group, its parameters and formulas.
!>
!> Formulas are in the law's own units: gaps are measured from `origin` in units of `length`,
!> pressures are in `pressure_unit`, and energies per area in the product of these units. A
!> repulsive pressure is positive, (16) of the paper.
module force_law
  use kinds, only: wp
  implicit none
  private
  public :: force_law_t, whole_step, of_pressure, of_slope, of_energy
  public :: usual_closure, closure_of_power, length_of_power, nearest_power

  !> The quantities of a law: the pressure, its derivative by the gap, and its integral from the gap
  !> to infinity.
  integer, parameter :: of_pressure = 1, of_slope = 2, of_energy = 3

  !> Distance from a step of the pressure, in widths of the step, beyond which the step has no
  !> effect: there erfc is smaller than rounding errors.
  real(wp), parameter :: whole_step = 6
  !> For a repulsion with the power -n of the gap, closure_fraction and repulsion_length are these
  !> two numbers divided by n. The repulsion may then grow by a factor of 25 in an iteration, and a
  !> gap never reaches zero. For n = 9 the length is a tenth of a gap, which is below 1 in contact.
  real(wp), parameter :: closure_of_power = 2.7_wp, length_of_power = 0.9_wp
  !> closure_fraction of laws that do not grow so fast, equal to that for n = 9; and the
  !> smallest_gap of these laws.
  real(wp), parameter :: usual_closure = closure_of_power/9, nearest_power = 1.0e-12_wp
  !> Bodies count as collapsed at this fraction of the gap from which the collapse started.
  real(wp), parameter :: fallen = 0.3_wp

  type, abstract :: force_law_t
    !> These components are set by the law. length, pressure_unit: units of gap [m] and of pressure
    !> [Pa]. origin: the separation [m] at gap 0. It is 0 unless the minimum of the law may be at
    !> any separation; then gap 0 is one length before the minimum.
    real(wp) :: length = 1, pressure_unit = 1, origin = 0
    !> Change of gap over which a strong repulsion changes by a factor of e = 2.718.
    real(wp) :: repulsion_length = 1
    !> In one iteration a gap may decrease by at most closure_fraction*gap + closure_length, since
    !> the linearised law is valid over this distance, for exponentials one or two
    !> repulsion lengths. This also keeps gaps in the range where the formulas are defined.
    real(wp) :: closure_fraction = 0, closure_length = 0
    !> Smallest gap at which the formulas are evaluated. No equilibrium has a smaller gap; at
    !> smaller gaps pressures, or their products with the coupling, would overflow.
    real(wp) :: smallest_gap = -300
    !> Separation [m] of the first point of a table, below which the law is extrapolated; 0 for
    !> other laws.
    real(wp) :: known_from = 0
    !> For large gaps the pressure falls as gap^-tail_power; `huge` if it falls faster than any
    !> power.
    real(wp) :: tail_power = huge(1.0_wp)
    !> Whether `length` and `pressure_unit` are characteristic scales of the force. If not, the
    !> scales of its minimum become the units (`force_sum`).
    logical :: has_units = .true.
    !> Whether the force has a characteristic length. A single power has none; its `length` is then
    !> arbitrary.
    logical :: has_length = .true.
    !> Whether `length` is the z0 of a law of powers, which defines sigma and Tabor's parameter. If
    !> not, the range, work of adhesion over largest tension, defines them.
    logical :: has_z0 = .false.
    !> Data for meshes: the period of the gap with which the pressure oscillates; the gap of a step
    !> and the width of this step. Each is 0 if the law has none.
    real(wp) :: period = 0, step_at = 0, step_width = 0
    !> Gaps at which the pressure or a derivative is discontinuous or nearly so; integrals over the
    !> gap are split there. Not allocated if there are none.
    real(wp), allocatable :: breaks(:)
    !> Those of the breaks that meshes cannot resolve with more nodes: gaps at which a force begins
    !> or ends, and points of a coarse table. Not allocated if there are none.
    real(wp), allocatable :: kinks(:)
    !> Name that the coupling of law and bodies has in the summary, for a law that does not attract
    !> (otherwise it is sigma (40)). Blank if it is not reported.
    character(len=12) :: coupling_name = ''
    !> A warning if the law's own assumptions do not hold for the numbers of the deck.
    character(len=200) :: caveat = ''

    !> These are set by `accept_law` (`group_reading`), for messages: the group of the deck that
    !> gives the law, and the keys of this group for the magnitudes of pressure and gap.
    character(len=24) :: group = '', strength_key = '', length_key = ''
    !> Number of forces in the law, set by `force_sum`.
    integer :: terms = 1

    !> These components are set by the scan of the law (`law_scan`), or by the law if closed forms
    !> are known. adhesion: the tension, integrated from the equilibrium separation to the next zero
    !> of the pressure, in units of length*pressure_unit. It sets the scale of the contact edge, and
    !> is 0 for a law that does not attract. work: the work of adhesion, from the equilibrium
    !> separation to infinity. It is smaller than adhesion if there is a barrier farther out, and
    !> negative if contact is only metastable.
    real(wp) :: adhesion = 0, work = 0
    !> Gap of largest tension, which defines the contact edge; 0 if there is none.
    real(wp) :: edge_gap = 0
    !> Larger gaps at which the tension has a maximum, ascending. Such a gap is the edge of a
    !> contact in the secondary minimum of the energy.
    real(wp), allocatable :: outer_edges(:)
    !> The equilibrium gap, at which the pressure is zero; 0 if there is none.
    real(wp) :: rest_gap = 0
    !> Gap below which the pressure decreases as far as an attraction in contact, so that the bodies
    !> collapse; 0 for a law that is repulsive in contact.
    real(wp) :: falls_below = 0
    !> Gap beyond which the repulsion is smaller than rounding errors; 0 until it is known.
    real(wp) :: range = 0
    !> Gap beyond which the pressure is gap^-tail_power times a power series in the inverse of the
    !> gap.
    real(wp) :: power_from = 0
  contains
    !> One of the three quantities at gaps.
    procedure(evaluate_law), deferred :: evaluate
    procedure :: pressure
    procedure :: slope
    procedure :: energy
    procedure :: at
    procedure :: closure
    procedure :: table_error
    procedure :: gap_of
    procedure :: separation_of
    procedure :: fallen_below
  end type force_law_t

  abstract interface
    pure subroutine evaluate_law(self, quantity, gap, value)
      import :: force_law_t, wp
      class(force_law_t), intent(in) :: self
      integer, intent(in) :: quantity
      real(wp), intent(in) :: gap(:)
      real(wp), intent(out) :: value(size(gap))
    end subroutine evaluate_law
  end interface

contains

  !> The pressure at gaps.
  pure function pressure(self, gap) result(value)
    class(force_law_t), intent(in) :: self
    real(wp), intent(in) :: gap(:)
    real(wp) :: value(size(gap))

    call self%evaluate(of_pressure, gap, value)
  end function pressure

  !> The derivative of the pressure by the gap.
  pure function slope(self, gap) result(value)
    class(force_law_t), intent(in) :: self
    real(wp), intent(in) :: gap(:)
    real(wp) :: value(size(gap))

    call self%evaluate(of_slope, gap, value)
  end function slope

  !> The integral of the pressure from the gaps to infinity.
  pure function energy(self, gap) result(value)
    class(force_law_t), intent(in) :: self
    real(wp), intent(in) :: gap(:)
    real(wp) :: value(size(gap))

    call self%evaluate(of_energy, gap, value)
  end function energy

  !> One of the three quantities at a single gap.
  pure real(wp) function at(self, quantity, gap)
    class(force_law_t), intent(in) :: self
    integer, intent(in) :: quantity
    real(wp), intent(in) :: gap
    real(wp) :: value(1)

    call self%evaluate(quantity, [gap], value)
    at = value(1)
  end function at

  !> Largest decrease of each gap in one iteration.
  pure function closure(self, gap) result(most)
    class(force_law_t), intent(in) :: self
    real(wp), intent(in) :: gap(:)
    real(wp) :: most(size(gap))

    most = self%closure_fraction*gap + self%closure_length
  end function closure

  !> Estimated errors of pressure and energy, one row each, for a law that is interpolated; 0 for a
  !> law with a formula.
  pure function table_error(self, gap) result(value)
    class(force_law_t), intent(in) :: self
    real(wp), intent(in) :: gap(:)
    real(wp) :: value(2, size(gap))

    value = 0
  end function table_error

  !> A separation or an h0 [m] in the law's units.
  elemental real(wp) function gap_of(self, separation) result(gap)
    class(force_law_t), intent(in) :: self
    real(wp), intent(in) :: separation

    gap = (separation - self%origin)/self%length
  end function gap_of

  !> A gap or an H0 in the law's units as a separation [m].
  elemental real(wp) function separation_of(self, gap) result(separation)
    class(force_law_t), intent(in) :: self
    real(wp), intent(in) :: gap

    separation = self%origin + gap*self%length
  end function separation_of

  !> The gap below which bodies count as collapsed if they came from the gap `apart`. They touch
  !> there or, under a singular attraction, no deformation balances the pressure, which has grown by
  !> more than a factor of ten.
  elemental real(wp) function fallen_below(self, apart) result(gap)
    class(force_law_t), intent(in) :: self
    real(wp), intent(in) :: apart

    gap = -huge(1.0_wp)
    if (.not. self%falls_below > 0) return
    gap = fallen*min(apart, self%falls_below)
    if (self%smallest_gap <= self%gap_of(0.0_wp)) gap = self%gap_of(0.0_wp)
  end function fallen_below

end module force_law
