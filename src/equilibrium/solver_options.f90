!> Options of the iterations.
module solver_options
  use kinds, only: wp
  implicit none
  private
  public :: solver_options_t, tightened, newton_of, rescue_of, usual_tolerance

  !> Largest residual, in the law's lengths, of states that others are computed from.
  real(wp), parameter :: usual_tolerance = 1.0e-8_wp
  !> A tolerance well above the rounding of equations with terms of hundreds of the law's lengths.
  real(wp), parameter :: tight_tolerance = 1.0e-12_wp
  !> Newton's method needs few iterations if it converges.
  integer, parameter :: newton_iterations = 12

  type :: solver_options_t
    !> Whether the iteration is the paper's mixing, without derivatives: plain if `mixing_depth` is
    !> 0, otherwise with Anderson acceleration. If not, it is the iteration with a factorised
    !> Jacobian, of which Newton's method is a special case (`newton_of`).
    logical :: mixing = .false.
    !> Largest acceptable residual, in the law's lengths.
    real(wp) :: tolerance = usual_tolerance
    !> Number of previous steps in the combination of Anderson acceleration: with a factorised
    !> Jacobian, and of the mixing.
    integer :: depth = 5, mixing_depth = 0
    !> Number of accelerated iterations after which the factorisation is renewed.
    integer :: patience = 8
    integer :: most_iterations = 60
    !> Error of the place of an extremum on the path, in the path's coordinate, and relative error
    !> of slopes.
    real(wp) :: place_error = 1.0e-12_wp, slope_error = 1.0e-13_wp
    !> For mixing: the largest ratio; whether the iteration stops at a small change of the central
    !> displacement, as in the paper, instead of a small residual; and this change, in the law's
    !> lengths.
    real(wp) :: mixing_limit = 0.2_wp
    logical :: stop_on_change = .false.
    real(wp) :: displacement_tolerance = 0
  contains
    procedure :: is_plain_mixing
  end type solver_options_t

contains

  !> Whether the iteration is the paper's own.
  pure logical function is_plain_mixing(self)
    class(solver_options_t), intent(in) :: self

    is_plain_mixing = self%mixing .and. self%mixing_depth == 0
  end function is_plain_mixing

  !> The options with a tolerance near rounding, for states whose place on the path must be exact;
  !> `residual_floor` replaces it if larger.
  pure type(solver_options_t) function tightened(options) result(tight)
    type(solver_options_t), intent(in) :: options

    tight = options
    tight%tolerance = min(options%tolerance, tight_tolerance)
  end function tightened

  !> Newton's method: the accelerated iteration with a new Jacobian at every step and no history.
  pure type(solver_options_t) function newton_of(options) result(newton)
    type(solver_options_t), intent(in) :: options

    newton = options
    newton%patience = 1
    newton%depth = 0
  end function newton_of

  !> Newton's method for a state at which the accelerated iteration has failed.
  pure type(solver_options_t) function rescue_of(options) result(rescue)
    type(solver_options_t), intent(in) :: options

    rescue = newton_of(options)
    rescue%most_iterations = newton_iterations
  end function rescue_of

end module solver_options
