!> What the iterations are told.
module solver_options
  use kinds, only: wp
  implicit none
  private
  public :: solver_options_t, tightened, newton_of

  !> Well above the rounding of equations whose terms are hundreds of the law's lengths.
  real(wp), parameter :: tight_tolerance = 1.0e-12_wp

  type :: solver_options_t
    !> Whether the iteration is the paper's mixing, which has no derivatives, or Anderson
    !> acceleration; of that Newton's method is a kind (`newton_of`).
    logical :: mixing = .false.
    !> Largest acceptable residual, in the law's lengths.
    real(wp) :: tolerance = 1.0e-8_wp
    !> Previous steps that Anderson acceleration combines.
    integer :: depth = 5
    !> Accelerated iterations with one factorisation before it is renewed.
    integer :: patience = 8
    integer :: most_iterations = 60
    !> Errors that are left of the place of an extremum on the path, in its coordinate, and of
    !> slopes, relative.
    real(wp) :: place_error = 1.0e-12_wp, slope_error = 1.0e-13_wp
    !> Of mixing the largest ratio; whether it stops on a small change of the central displacement,
    !> as in the paper, instead of on the residual, and on which change (in the law's lengths).
    real(wp) :: mixing_limit = 0.2_wp
    logical :: stop_on_change = .false.
    real(wp) :: displacement_tolerance = 0
  end type solver_options_t

contains

  !> The same options with a tolerance near rounding: for the few states whose place on the path,
  !> not only whose load, must be exact. Where rounding allows no better its floor counts
  !> (`residual_floor`).
  pure function tightened(options) result(tight)
    type(solver_options_t), intent(in) :: options
    type(solver_options_t) :: tight

    tight = options
    tight%tolerance = min(options%tolerance, tight_tolerance)
  end function tightened

  !> Newton's method: the accelerated iteration with the Jacobian renewed at every step and nothing
  !> to accelerate.
  pure function newton_of(options) result(newton)
    type(solver_options_t), intent(in) :: options
    type(solver_options_t) :: newton

    newton = options
    newton%patience = 1
    newton%depth = 0
  end function newton_of

end module solver_options
