!> What the two bodies, seen as one, yield to a pressure: an elastic half-space and, for bodies that
!> are not homogeneous, a remainder. With the half-space's kernel k of (15), of which the coupling
!> says how much it yields, the gap rises at r by
!>
!>     2 coupling Int P(t) [k(r, t) + remainder(r, t)] t dt .
!>
!> A homogeneous body has no remainder. Its kernel scales with all lengths at once, so that one
!> matrix serves every contact radius; that of other bodies is made anew for each
!> (`elastic_operator`). No other module asks which body it has.
module elastic_body
  use kinds, only: wp
  implicit none
  private
  public :: elastic_body_t, half_space_t

  type, abstract :: elastic_body_t
  contains
    procedure(ask), deferred :: is_homogeneous
    procedure(evaluate), deferred :: remainder
  end type elastic_body_t

  abstract interface
    !> Whether there is no remainder.
    pure logical function ask(self)
      import :: elastic_body_t
      class(elastic_body_t), intent(in) :: self
    end function ask

    !> kernel(i, j) = remainder(r(i), t(j)), smooth and symmetric, and growth(i, j), its derivative
    !> by the logarithm of a scale that both arguments have: r d/dr + t d/dt. Lateral units, results
    !> in one over them; (size(r), size(t)).
    pure subroutine evaluate(self, r, t, kernel, growth)
      import :: elastic_body_t, wp
      class(elastic_body_t), intent(in) :: self
      real(wp), intent(in) :: r(:), t(:)
      real(wp), intent(out) :: kernel(:, :), growth(:, :)
    end subroutine evaluate
  end interface

  !> Homogeneous bodies, each an elastic half-space.
  type, extends(elastic_body_t) :: half_space_t
  contains
    procedure :: is_homogeneous
    procedure :: remainder
  end type half_space_t

contains

  pure logical function is_homogeneous(self)
    class(half_space_t), intent(in) :: self

    is_homogeneous = .true.
  end function is_homogeneous

  pure subroutine remainder(self, r, t, kernel, growth)
    class(half_space_t), intent(in) :: self
    real(wp), intent(in) :: r(:), t(:)
    real(wp), intent(out) :: kernel(:, :), growth(:, :)

    kernel = 0
    growth = 0
  end subroutine remainder

end module elastic_body
