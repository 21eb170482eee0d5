!> States that numbers are reported of, with the errors of these numbers.
module reported
  use kinds, only: wp
  use contact_state, only: state_t
  use equilibrium, only: control_t
  implicit none
  private
  public :: error_probe_t, error_t, measure_t, reported_t, reported_state, &
    add_reported, relative_error

  !> A state at a given h0, and what was prescribed there; solved again on a finer mesh, it tells
  !> the error of the numbers that are reported of it.
  type :: error_probe_t
    integer :: mesh = 1
    type(control_t) :: control
    type(state_t) :: state
  end type error_probe_t

  !> What a state is reported by, in the units of `dimensionless_problem`.
  type :: measure_t
    real(wp) :: h0 = 0, displacement = 0, load = 0, energy = 0
  end type measure_t

  !> Errors of the same; and of its profile: the gaps, and the pressures over the largest of them.
  !> Where they are not known, they are as large as what they are of.
  type :: error_t
    real(wp) :: h0 = 0, displacement = 0, load = 0, profile = 0
    logical :: known = .true.
    !> Of the radius of what a mesh in contact is locked to, lateral units. Theories are compared
    !> with it; it is not part of `relative_error`, since locks far from the edge of contact are
    !> found less well than what is reported.
    real(wp) :: radius = 0
  end type error_t

  !> A state that numbers are reported of, in the units of `dimensionless_problem`, and where it
  !> comes from: a point of the traced path, or the landing after a jump over a point, or else a
  !> state at a given h0, which is on the path or not.
  type :: reported_t
    real(wp) :: h0 = 0, displacement = 0, load = 0
    integer :: point = 0
    logical :: landing = .false.
    !> Its h0 was found by a search between steps, and no error of that is known.
    logical :: searched = .false.
    type(error_probe_t), allocatable :: witness
    type(error_t), allocatable :: error
    !> Derivatives by each parameter of &sensitivity, SI units.
    type(measure_t), allocatable :: rate(:)
  end type reported_t

  !> An error that says that nothing is known.
  real(wp), parameter :: most = 1.0e6_wp

contains

  !> A witness's state as one that is reported.
  pure function reported_state(witness) result(reported)
    type(error_probe_t), intent(in) :: witness
    type(reported_t) :: reported

    associate (state => witness%state)
      reported%h0 = state%h0
      reported%displacement = state%axis_gap - state%h0
      reported%load = state%load
    end associate
    reported%witness = witness
  end function reported_state

  !> Adds to a list. An argument may be a function's result: compiler note 1.
  subroutine add_reported(list, reported)
    type(reported_t), allocatable, intent(inout) :: list(:)
    type(reported_t), intent(in) :: reported

    if (.not. allocated(list)) allocate (list(0))
    list = [list, reported]
  end subroutine add_reported

  !> The largest error of a reported state: of the load relative to itself, of h0 and displacement
  !> relative to themselves or, where they are smaller, to the law's length; 0 if it is not known.
  pure real(wp) function relative_error(reported) result(largest)
    type(reported_t), intent(in) :: reported

    largest = 0
    if (.not. allocated(reported%error)) return
    associate (error => reported%error)
      if (error%load > 0) largest = min(error%load/max(abs(reported%load), tiny(1.0_wp)), most)
      largest = max(largest, error%h0/max(abs(reported%h0), 1.0_wp), error%profile)
      ! At an extremum h0 or the load stands still while the displacement runs on: where on the flat
      ! top it is found does not move the curve, and no displacement is reported of it.
      if (reported%point == 0) largest = max(largest, &
        error%displacement/max(abs(reported%displacement), 1.0_wp))
    end associate
  end function relative_error

end module reported
