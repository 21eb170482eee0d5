!> This program's groups, one derived type each.
!>
!> A group that is optional is an allocatable component of the scene: allocated means asked for.
!> In the same way a value without a default is allocated only where there is one. All SI.
module scene_groups
  use kinds, only: wp
  use deck, only: deck_t
  implicit none
  private
  public :: scene_t, bodies_t, force_t, loading_t, unloading_t, path_t, profiles_t, range_t, &
            stability_t, sweep_t, numerics_t

  !> &bodies
  type :: bodies_t
    !> R of the gap h0 + r^2/(2R) [m].
    real(wp) :: radius = 0
    !> E/(1-nu^2) of two identical bodies equivalent to these [Pa]; without meaning if `rigid`.
    real(wp) :: stiffness = 0
    !> Compliance of each body over their mean.
    real(wp) :: share(2) = 1
    logical :: rigid = .false.
  end type bodies_t

  !> &force; only the parameters of its law are set.
  type :: force_t
    character(len=:), allocatable :: law
    character(len=:), allocatable :: part
    real(wp) :: hamaker = 0, z0 = 0, p0 = 0, decay_length = 0
  end type force_t

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
  type :: path_t
    real(wp), allocatable :: h0_start
    real(wp) :: h0_end = 0
  end type path_t

  !> &profiles: the h0 [m] at which they are written.
  type :: profiles_t
    real(wp), allocatable :: h0(:)
  end type profiles_t

  !> &approximations and &classical: `count` points over a range of h0 [m]; h0_start unallocated:
  !> from where the equilibrium path starts.
  type :: range_t
    real(wp), allocatable :: h0_start
    real(wp) :: h0_end = 0
    integer :: count = 0
  end type range_t

  !> &stability has no keys.
  type :: stability_t
  end type stability_t

  !> &sweep: the key as 'group.key' and every value it takes, however they were given.
  type :: sweep_t
    character(len=:), allocatable :: key
    real(wp), allocatable :: values(:)
  end type sweep_t

  !> &numerics; what is unallocated follows from the accuracy.
  type :: numerics_t
    character(len=:), allocatable :: method, grid, convergence
    real(wp) :: accuracy = 0, displacement_tolerance = 0, mixing_limit = 0
    integer :: max_iterations = 0, anderson_depth = 0
    integer, allocatable :: nodes, panel_order
    real(wp), allocatable :: r_max, residual_tolerance
  end type numerics_t

  !> All that a deck asks for.
  type :: scene_t
    !> The deck itself, with every default filled in.
    type(deck_t) :: deck
    character(len=:), allocatable :: title
    type(bodies_t) :: bodies
    type(force_t) :: force
    type(loading_t), allocatable :: loading
    type(unloading_t), allocatable :: unloading
    type(path_t), allocatable :: path
    type(profiles_t), allocatable :: profiles
    type(range_t), allocatable :: approximations, classical
    type(stability_t), allocatable :: stability
    type(sweep_t), allocatable :: sweep
    type(numerics_t) :: numerics
  end type scene_t

end module scene_groups
