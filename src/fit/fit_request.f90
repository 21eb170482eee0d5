!> What is asked of a fit: the measured curve, and the unknowns.
module fit_request
  use kinds, only: wp
  implicit none
  private
  public :: measurement_t, fit_t, unknown_t, of_model, of_contact_point, of_sensitivity, &
    of_spring

  !> &measurement [SI]. sensitivity: of a signal in volts; unallocated: the signal is the force.
  type :: measurement_t
    character(len=:), allocatable :: file, segment
    character(len=48), allocatable :: columns(:)
    real(wp) :: spring_constant = 0
    real(wp), allocatable :: sensitivity, contact_point
    !> Pairs of positions between which samples do not count.
    real(wp), allocatable :: skip(:)
    !> Of position and signal in the file.
    real(wp) :: unit(2) = 1
  end type measurement_t

  !> What an unknown belongs to: a number of the problem, where the bodies touch, the detector, the
  !> spring.
  integer, parameter :: of_model = 0, of_contact_point = 1, of_sensitivity = 2, of_spring = 3

  !> An unknown, in the unit of its key. in_log: it is positive, and its logarithm is fitted; of
  !> others the difference from `origin` over `scale`. prior: standard deviation of what is known
  !> before of the value in the deck; 0: nothing.
  type :: unknown_t
    character(len=:), allocatable :: name
    integer :: role = of_model
    logical :: in_log = .false.
    real(wp) :: value = 0, origin = 0, scale = 1, prior = 0
    real(wp), allocatable :: lower, upper
  end type unknown_t

  !> &fit. noise: standard deviation of the signal; unallocated: that of the baseline.
  type :: fit_t
    type(unknown_t), allocatable :: unknown(:)
    real(wp), allocatable :: noise
  end type fit_t

end module fit_request
