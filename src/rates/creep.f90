!> The response of viscoelastic bodies to a changing pressure. A time t after a step of the
!> pressure, the compliance of the bodies is
!>
!>     theta_0 [1 + Sum_k share_k (1 - exp(-t/time_k))] .
!>
!> This is the compliance of a spring in series with Kelvin-Voigt elements (each a spring and a
!> dashpot in parallel). The delayed deformation of the k-th element is theta_0 share_k W Z_k. The
!> internal variable (memory) Z_k is a field in the material that follows the pressure:
!>
!>     time_k dZ_k/dt = P - Z_k .
!>
!> If P changes linearly over a step, Z_k becomes kept Z_k + past P + present P_new. The step is
!> therefore an elastic problem: the present pressure acts on a half-space that is softer than the
!> instantaneous one and is deformed by earlier pressures.
module creep
  use kinds, only: wp
  implicit none
  private
  public :: creep_t

  !> share: the compliance of each element relative to the instantaneous compliance. time:
  !> retardation times [s].
  type :: creep_t
    real(wp), allocatable :: share(:), time(:)
  contains
    procedure :: relaxed
    procedure :: over_step
    procedure :: shortest
  end type creep_t

  !> Ratio of a step to a retardation time below which exponentials are summed as series.
  real(wp), parameter :: short = 0.02_wp

contains

  !> Ratio of the compliance of relaxed bodies to the instantaneous compliance.
  pure real(wp) function relaxed(self)
    class(creep_t), intent(in) :: self

    relaxed = 1 + sum(self%share)
  end function relaxed

  !> The shortest retardation time; huge if there is none.
  pure real(wp) function shortest(self)
    class(creep_t), intent(in) :: self

    shortest = minval(self%time)
  end function shortest

  !> Coefficients of the memory Z_k at the end of a step of `seconds`: `kept` multiplies the memory
  !> at the beginning, `past` the pressure at the beginning, and `present` the pressure at the end.
  pure subroutine over_step(self, seconds, kept, past, present)
    class(creep_t), intent(in) :: self
    real(wp), intent(in) :: seconds
    real(wp), intent(out) :: kept(:), past(:), present(:)
    real(wp) :: q(size(self%time))

    q = seconds/self%time
    kept = exp(-q)
    where (q > short)
      present = 1 - (1 - kept)/q
    elsewhere
      present = q*(0.5_wp - q*(1.0_wp/6 - q*(1.0_wp/24 - q*(1.0_wp/120 - q/720))))
    end where
    past = 1 - present - kept
    where (q <= short) past = q*(0.5_wp - q*(1.0_wp/3 - q*(0.125_wp - q*(1.0_wp/30 - q/144))))
  end subroutine over_step

end module creep
