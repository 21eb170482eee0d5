!> The deformation of the two bodies under a pressure, treated as one body. It is that of an elastic
!> half-space and, for bodies that are not homogeneous, a remainder. Under a pressure p J0(k r) the
!> surfaces of half-spaces approach each other by a constant times p J0(k r)/k, and those of the
!> bodies by L(k) times this. The gap at r rises by
!>
!>     2 coupling Int P(t) [k(r, t) + D(r, t)] t dt ,
!>     D = 2 Int_0^inf (L(k) - 1) J0(k r) J0(k t) dk ,
!>
!> with the kernel of a half-space (15), whose compliance is in the coupling.
!>
!> A homogeneous body has no remainder. Its kernel scales with all lengths, so that one matrix is
!> valid for all contact radii. For other bodies a matrix is made for each radius
!> (`elastic_operator`). No other module of the equations depends on the kind of body.
module elastic_body
  use kinds, only: wp
  implicit none
  private
  public :: elastic_body_t

  !> Homogeneous bodies, each of which is an elastic half-space. Extended types have a remainder.
  type :: elastic_body_t
  contains
    procedure :: is_homogeneous
    procedure :: beside_half_space => nothing
    procedure :: growth => nothing
    procedure :: mean_beside
    procedure :: wave_range
    procedure :: is_alike
    procedure :: take_one
  end type elastic_body_t

contains

  !> Whether the deformations of the two bodies differ only by a constant factor.
  pure logical function is_alike(self)
    class(elastic_body_t), intent(in) :: self

    is_alike = .true.
  end function is_alike

  !> The remainder of one of the two bodies, 1 or 2, in addition to its own half-space.
  subroutine take_one(self, which, one)
    class(elastic_body_t), intent(in) :: self
    integer, intent(in) :: which
    class(elastic_body_t), allocatable, intent(out) :: one

    allocate (one, source=self)
  end subroutine take_one

  !> Whether the bodies have no remainder.
  pure logical function is_homogeneous(self)
    class(elastic_body_t), intent(in) :: self

    is_homogeneous = .true.
  end function is_homogeneous

  !> L - 1, or k dL/dk, at wave numbers k in inverse lateral units.
  pure function nothing(self, k) result(value)
    class(elastic_body_t), intent(in) :: self
    real(wp), intent(in) :: k(:)
    real(wp) :: value(size(k))

    value = 0
  end function nothing

  !> The mean of L - 1 over wave numbers from 0 to k.
  elemental real(wp) function mean_beside(self, k)
    class(elastic_body_t), intent(in) :: self
    real(wp), intent(in) :: k

    mean_beside = 0
  end function mean_beside

  !> Two wave numbers. Up to the first one, and above it between any k and 3 k, L is a polynomial of
  !> low degree. Above the second one, L - 1 has a negligible effect on loads with the given number
  !> of digits.
  pure function wave_range(self, digits) result(k)
    class(elastic_body_t), intent(in) :: self
    real(wp), intent(in) :: digits
    real(wp) :: k(2)

    k = 0
  end function wave_range

end module elastic_body
