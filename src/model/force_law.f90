!> What every surface-force law offers. A law is a type that extends this one, in a file of its own
!> under laws/, with only its parameters and formulas; `laws` makes one from its name.
!>
!> Formulas are in the law's own units: gaps in `length`, pressures in `pressure_unit`, energies per
!> area in their product. Pressures are inward positive: repulsion is positive, (16) of the paper.
module force_law
  use kinds, only: wp
  implicit none
  private
  public :: force_law_t

  type, abstract :: force_law_t
    !> Unit of gap [m] and of pressure [Pa].
    real(wp) :: length = 1, pressure_unit = 1
    !> Surface energy in units of length*pressure_unit: the depth of the energy minimum; 0 for a
    !> law that does not attract.
    real(wp) :: adhesion = 0
    !> Gap of maximum tension, which defines the contact edge; 0 where there is no such gap.
    real(wp) :: edge_gap = 0
    !> Gap of zero pressure; 0 where there is none.
    real(wp) :: rest_gap = 0
    !> Gap beyond which the repulsion is below rounding.
    real(wp) :: range = 0
    !> Change of gap over which a strong repulsion changes by a factor of e.
    real(wp) :: repulsion_length = 1
    !> A gap may close in one iteration by at most closure_fraction*gap + closure_length: beyond it
    !> the linearised law means nothing. Keeps gaps where the formulas are defined.
    real(wp) :: closure_fraction = 0, closure_length = 0
    !> Smallest gap at which the formulas are asked for. No equilibrium has a smaller one; below it
    !> pressures, and their products with the coupling, would leave the range of numbers.
    real(wp) :: smallest_gap = -300
  contains
    !> Pressure, its derivative by the gap, and its integral from the gap to infinity.
    procedure(gap_function), deferred :: pressure
    procedure(gap_function), deferred :: slope
    procedure(gap_function), deferred :: energy
  end type force_law_t

  abstract interface
    pure function gap_function(self, gap) result(value)
      import :: force_law_t, wp
      class(force_law_t), intent(in) :: self
      real(wp), intent(in) :: gap(:)
      real(wp) :: value(size(gap))
    end function gap_function
  end interface

end module force_law
