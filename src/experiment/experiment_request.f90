!> The requested experiments, one derived type for each group of the deck.
!>
!> An optional group is an allocatable component of the request, allocated if the deck has the
!> group. A key without a default is allocated if the deck has the key. All values are SI.
module experiment_request
  use kinds, only: wp
  use variation, only: variation_t
  use creep, only: creep_t
  implicit none
  private
  public :: request_t, numerics_t

  !> &loading [m]: h0_start > h0_end, h0_step > 0.
  type :: loading_t
    real(wp) :: h0_start = 0, h0_end = 0, h0_step = 0
  end type loading_t

  !> &unloading [m]: h0_end above every turning point `from`.
  type :: unloading_t
    real(wp), allocatable :: from(:)
    real(wp) :: h0_end = 0, h0_step = 0
  end type unloading_t

  !> &equilibrium_path [m]; h0_start not allocated: the program chooses it.
  type :: path_range_t
    real(wp), allocatable :: h0_start
    real(wp) :: h0_end = 0
  end type path_range_t

  !> &device: stiffness of each spring [N/m], 0 for a dead load; an empty list: h0 is prescribed.
  !> Start and turning position of the drive [m]; not allocated: the ends of the known path.
  type :: device_t
    real(wp), allocatable :: stiffness(:), z_start, z_end
  end type device_t

  !> &drive: velocity [m/s], positions [m], dwell [s]; if given, the stiffness of a spring [N/m] and
  !> the time step [s].
  type :: drive_request_t
    real(wp) :: velocity = 0, z_start = 0, z_turn = 0, z_end = 0, dwell = 0
    real(wp), allocatable :: stiffness, time_step
  end type drive_request_t

  !> &fluid: viscosity [Pa s], and slip lengths [m] on the two walls.
  type :: fluid_request_t
    real(wp) :: viscosity = 0, slip(2) = 0
  end type fluid_request_t

  !> &numerics; values that are not allocated follow from the accuracy.
  type :: numerics_t
    character(len=:), allocatable :: method, grid, convergence
    real(wp) :: accuracy = 0, displacement_tolerance = 0, mixing_limit = 0
    integer :: max_iterations = 0
    integer, allocatable :: anderson_depth, nodes, panel_order
    real(wp), allocatable :: r_max, residual_tolerance
  end type numerics_t

  type :: request_t
    type(loading_t), allocatable :: loading
    type(unloading_t), allocatable :: unloading
    type(path_range_t), allocatable :: path
    !> &profiles: the h0 [m] of the profiles. &fixed_load: the loads [N].
    real(wp), allocatable :: profile_h0(:), fixed_loads(:)
    type(device_t), allocatable :: device
    !> &sensitivity: the parameters, each with its varied problems.
    type(variation_t), allocatable :: varied(:)
    type(drive_request_t), allocatable :: drive
    !> &viscoelastic: the creep of the bodies; not allocated: they are elastic.
    type(creep_t), allocatable :: creep
    !> &fluid; not allocated: there is no fluid.
    type(fluid_request_t), allocatable :: fluid
    !> &table has no keys.
    logical :: table = .false.
    type(numerics_t) :: numerics
  contains
    procedure :: finds_states
    procedure :: reads_path
  end type request_t

contains

  !> Whether equilibria are requested, and not only closed forms.
  pure logical function finds_states(self)
    class(request_t), intent(in) :: self

    finds_states = allocated(self%loading) .or. allocated(self%path) .or. allocated(self%drive)
  end function finds_states

  !> Whether a requested experiment is read from the path.
  pure logical function reads_path(self)
    class(request_t), intent(in) :: self

    reads_path = allocated(self%device) .or. allocated(self%fixed_loads) .or. &
      allocated(self%varied) .or. self%table
  end function reads_path

end module experiment_request
