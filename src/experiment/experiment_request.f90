!> What is asked of the experiments, one derived type a group of the deck.
!>
!> A group that is optional is an allocatable component of the request: allocated means asked for.
!> In the same way a value without a default is allocated only where there is one. All SI.
module experiment_request
  use kinds, only: wp
  use variation, only: variation_t
  use creep, only: creep_t
  implicit none
  private
  public :: request_t, loading_t, unloading_t, path_range_t, profiles_t, numerics_t, device_t, &
    fixed_load_t, sensitivity_t, drive_request_t, fluid_request_t

  !> &loading [m]: h0_start > h0_end, h0_step > 0.
  type :: loading_t
    real(wp) :: h0_start = 0, h0_end = 0, h0_step = 0
  end type loading_t

  !> &unloading [m]: h0_end above every turning point `from`.
  type :: unloading_t
    real(wp), allocatable :: from(:)
    real(wp) :: h0_end = 0, h0_step = 0
  end type unloading_t

  !> &equilibrium_path [m]; h0_start unallocated: the program chooses.
  type :: path_range_t
    real(wp), allocatable :: h0_start
    real(wp) :: h0_end = 0
  end type path_range_t

  !> &profiles: the h0 [m] at which they are written.
  type :: profiles_t
    real(wp), allocatable :: h0(:)
  end type profiles_t

  !> &device: stiffness of each spring [N/m], 0 for a dead load; none: h0 is prescribed. Where the
  !> drive starts and turns [m], unallocated: as far as the path is known.
  type :: device_t
    real(wp), allocatable :: stiffness(:), z_start, z_end
  end type device_t

  !> &fixed_load: the loads [N].
  type :: fixed_load_t
    real(wp), allocatable :: load(:)
  end type fixed_load_t

  !> &sensitivity: the parameters, each with the problem varied by it.
  type :: sensitivity_t
    type(variation_t), allocatable :: varied(:)
  end type sensitivity_t

  !> &drive: velocity [m/s], positions [m], dwell [s], and where they are given, the stiffness of a
  !> spring [N/m] and the step [s].
  type :: drive_request_t
    real(wp) :: velocity = 0, z_start = 0, z_turn = 0, z_end = 0, dwell = 0
    real(wp), allocatable :: stiffness, time_step
  end type drive_request_t

  !> &fluid: viscosity [Pa s], and slip lengths [m] on the two walls.
  type :: fluid_request_t
    real(wp) :: viscosity = 0, slip(2) = 0
  end type fluid_request_t

  !> &numerics; what is unallocated follows from the accuracy.
  type :: numerics_t
    character(len=:), allocatable :: method, grid, convergence
    real(wp) :: accuracy = 0, displacement_tolerance = 0, mixing_limit = 0
    integer :: max_iterations = 0, anderson_depth = 0
    integer, allocatable :: nodes, panel_order
    real(wp), allocatable :: r_max, residual_tolerance
  end type numerics_t

  type :: request_t
    type(loading_t), allocatable :: loading
    type(unloading_t), allocatable :: unloading
    type(path_range_t), allocatable :: path
    type(profiles_t), allocatable :: profiles
    type(device_t), allocatable :: device
    type(fixed_load_t), allocatable :: fixed_load
    type(sensitivity_t), allocatable :: sensitivity
    type(drive_request_t), allocatable :: drive
    !> &viscoelastic: how bodies remember; unallocated: they do not.
    type(creep_t), allocatable :: creep
    !> &fluid; unallocated: none drains.
    type(fluid_request_t), allocatable :: fluid
    !> &table has no keys.
    logical :: table = .false.
    type(numerics_t) :: numerics
  contains
    procedure :: finds_states
    procedure :: reads_path
  end type request_t

contains

  !> Whether equilibria are asked for, and not closed forms alone.
  pure logical function finds_states(self)
    class(request_t), intent(in) :: self

    finds_states = allocated(self%loading) .or. allocated(self%path) .or. allocated(self%drive)
  end function finds_states

  !> Whether an experiment is read from the path, beside it.
  pure logical function reads_path(self)
    class(request_t), intent(in) :: self

    reads_path = allocated(self%device) .or. allocated(self%fixed_load) .or. &
      allocated(self%sensitivity) .or. self%table
  end function reads_path

end module experiment_request
