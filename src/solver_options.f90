!> What the three iterations (mixing, Anderson, Newton) are told.
module solver_options
  use kinds, only: wp
  implicit none
  private
  public :: solver_options_t

  type :: solver_options_t
    !> 'mixing', 'anderson' or 'newton'.
    character(len=8) :: method = 'anderson'
    !> Largest acceptable residual, in the law's lengths.
    real(wp) :: tolerance = 1.0e-8_wp
    !> Previous steps that Anderson acceleration combines.
    integer :: depth = 5
    !> Accelerated iterations with one factorisation before it is renewed.
    integer :: patience = 8
    integer :: most_iterations = 60
    !> Mixing: largest ratio; whether it stops on a small change of the central displacement, as in
    !> the paper, instead of on the residual, and on which change (in the law's lengths).
    real(wp) :: mixing_limit = 0.2_wp
    logical :: stop_on_change = .false.
    real(wp) :: displacement_tolerance = 0
  end type solver_options_t

end module solver_options
