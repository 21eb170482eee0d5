!> Places that numbers are reported of, and what is read there. A place is an equilibrium and what
!> defines it: D = drive(1) h0 + drive(2) load turns there along the path, or has a value. Its
!> value, its error and its derivatives are questions asked of the same place: by whoever finds it,
!> by `place_errors` and by `place_rates`.
module reported
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use contact_state, only: state_t
  implicit none
  private
  public :: reported_t, reported_state, add_reported, drive_weights, value_of, unit_of, rates_of
  public :: of_h0, of_load, of_displacement, of_energy, of_radius, of_edge, of_position, &
    of_tension, of_profile
  public :: read_of_states, nowhere
  public :: what_is_left, least

  !> What is read of a state: h0, load, displacement, energy of the bodies, contact radius, radius
  !> that the mesh is locked to; and what follows from these: position of the drive, tension, error
  !> of the profile. Of a place `of_energy` is the energy of bodies and drive.
  integer, parameter :: read_of_states = 6, of_h0 = 1, of_load = 2, of_displacement = 3, &
    of_energy = 4, of_radius = 5, of_edge = 6, of_position = 7, of_tension = 8, &
    of_profile = 9
  !> The mesh of a place that no mesh has.
  integer, parameter :: nowhere = -1

  !> A place, in the units of `dimensionless_problem`.
  type :: reported_t
    !> The point of the traced path that it is (0: none), or over which the jump leads that lands
    !> here.
    integer :: point = 0
    logical :: landing = .false.
    !> The equilibrium, its mesh and its coordinate there; mesh 0 has undeformed bodies.
    integer :: mesh = nowhere
    real(wp) :: s = 0
    type(state_t) :: state
    !> The weights of h0 and load in D; of what turns here along the path, if anything does: D or,
    !> before it, h0; and the place in the table where the jump began that ended here, at the same
    !> D.
    real(wp) :: drive(2) = [1.0_wp, 0.0_wp], turn_of(2) = 0
    integer :: after = 0
    !> Whether profile and contact radius are asked for; whether h0 was found by a search between
    !> steps, and no error of that is known.
    logical :: with_profile = .false., with_radius = .false., searched = .false.
    !> What is read: here; at the same place of a finer mesh; what solving has left of it.
    real(wp), dimension(read_of_states) :: at = 0, fine = 0, left = 0
    !> Error of gaps, and of pressures over the largest of them.
    real(wp) :: profile = 0
    !> Whether the finer mesh was asked, and had the place; differences count `margin` times.
    logical :: judged = .false., known = .true.
    real(wp) :: margin = 1
    !> Derivatives of what is read by each parameter of &sensitivity, SI units.
    real(wp), allocatable :: rate(:, :)
  contains
    procedure :: has_state
    procedure :: turns
    procedure :: measure
    procedure :: error
    procedure :: relative_error
  end type reported_t


  !> An error that says that nothing is known; rounding of a whole calculation.
  real(wp), parameter :: most = 1.0e6_wp

contains

  !> A state as a place at its h0.
  pure function reported_state(mesh, state) result(place)
    integer, intent(in) :: mesh
    type(state_t), intent(in) :: state
    type(reported_t) :: place

    place%mesh = mesh
    place%state = state
    place%at(of_h0) = state%h0
    place%at(of_load) = state%load
    place%at(of_displacement) = state%axis_gap - state%h0
    place%at(of_edge) = state%scale
  end function reported_state

  !> Adds to a list. An argument may be a function's result: compiler note 1.
  subroutine add_reported(list, place)
    type(reported_t), allocatable, intent(inout) :: list(:)
    type(reported_t), intent(in) :: place

    if (.not. allocated(list)) allocate (list(0))
    list = [list, place]
  end subroutine add_reported

  !> Whether the place has an equilibrium on a mesh.
  pure logical function has_state(self)
    class(reported_t), intent(in) :: self

    has_state = allocated(self%state%gap)
  end function has_state

  !> Whether something turns here.
  pure logical function turns(self)
    class(reported_t), intent(in) :: self

    turns = any(abs(self%turn_of) > 0)
  end function turns

  !> A quantity, of values read at the place.
  pure real(wp) function measure(self, value, quantity)
    class(reported_t), intent(in) :: self
    real(wp), intent(in) :: value(:)
    integer, intent(in) :: quantity

    select case (quantity)
    case (of_position)
      measure = dot_product(self%drive, value(:2))
    case (of_tension)
      measure = -value(of_load)
    case (of_energy)
      ! At fixed D equilibria are where the energy of bodies and spring, or dead load, is
      ! stationary.
      if (self%drive(1) > 0) then
        measure = value(of_energy) - 0.5_wp*self%drive(2)*value(of_load)**2
      else
        measure = value(of_energy) + value(of_load)*value(of_h0)
      end if
    case (of_profile)
      measure = self%profile
    case default
      measure = value(quantity)
    end select
  end function measure

  !> What solving has left of a quantity.
  pure real(wp) function what_is_left(place, quantity) result(left)
    type(reported_t), intent(in) :: place
    integer, intent(in) :: quantity

    select case (quantity)
    case (of_position)
      left = dot_product(abs(place%drive), place%left(:2))
    case (of_tension)
      left = place%left(of_load)
    case (of_profile)
      left = 0
    case default
      left = place%left(quantity)
    end select
  end function what_is_left

  !> The error of a quantity; as large as itself where the finer mesh has no such place.
  pure real(wp) function error(self, quantity)
    class(reported_t), intent(in) :: self
    integer, intent(in) :: quantity

    associate (own => self%measure(self%at, quantity))
      if (self%known) then
        error = self%margin*abs(own - self%measure(self%fine, quantity)) + &
          what_is_left(self, quantity)
      else
        error = max(abs(own), least(quantity))
      end if
    end associate
  end function error

  !> Errors count against the quantity itself or, if this is larger, against so much.
  pure real(wp) function least(quantity)
    integer, intent(in) :: quantity

    select case (quantity)
    case (of_h0, of_displacement, of_position)
      least = 1
    case default
      least = tiny(1.0_wp)
    end select
  end function least

  !> The largest error of what is reported of a place, relative; h0 and displacement relative to the
  !> law's length where they are smaller; 0 if it was not judged.
  pure real(wp) function relative_error(self) result(largest)
    class(reported_t), intent(in) :: self

    largest = 0
    if (.not. self%judged) return
    largest = max(min(of(of_load), most), self%profile)
    if (self%after > 0) return
    if (product(self%drive) < 0) then
      largest = max(largest, of(of_position))
    else
      largest = max(largest, of(of_h0))
    end if
    ! At an extremum h0 or the load stands still while the displacement runs on: where on the flat
    ! top it is found does not move the curve, and no displacement is reported of it.
    if (.not. self%turns()) largest = max(largest, of(of_displacement))
    if (self%with_radius .and. self%at(of_radius) > 0) largest = max(largest, of(of_radius))

  contains

    pure real(wp) function of(quantity)
      integer, intent(in) :: quantity

      of = 0
      if (quantity == of_h0 .and. self%searched) return
      of = self%error(quantity)
      if (of > 0) of = of/max(abs(self%measure(self%at, quantity)), least(quantity))
    end function of

  end function relative_error

  !> A quantity of a place [SI]; under a dead load a drive has no position.
  pure real(wp) function value_of(problem, place, quantity) result(value)
    type(problem_t), intent(in) :: problem
    type(reported_t), intent(in) :: place
    integer, intent(in) :: quantity

    value = place%measure(place%at, quantity)
    if (quantity == of_position .and. .not. place%drive(1) > 0) then
      value = ieee_value(value, ieee_quiet_nan)
    else if (quantity == of_h0 .or. quantity == of_position) then
      value = problem%law%separation_of(value)
    else
      value = value*unit_of(problem, quantity)
    end if
  end function value_of

  pure real(wp) function unit_of(problem, quantity) result(unit)
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: quantity

    select case (quantity)
    case (of_load, of_tension)
      unit = problem%load
    case (of_energy)
      unit = problem%load*problem%length
    case (of_radius, of_edge)
      unit = problem%lateral
    case (of_profile)
      unit = 1
    case default
      unit = problem%length
    end select
  end function unit_of

  !> The weights of h0 and load in D, SI units.
  pure function drive_weights(problem, drive) result(weights)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: drive(2)
    real(wp) :: weights(2)

    weights = drive
    if (drive(1) > 0) weights(2) = drive(2)*problem%length/problem%load
  end function drive_weights

  !> Derivatives of a quantity of a place by each parameter [SI].
  pure function rates_of(problem, place, quantity) result(rate)
    type(problem_t), intent(in) :: problem
    type(reported_t), intent(in) :: place
    integer, intent(in) :: quantity
    real(wp) :: rate(size(place%rate, 2))

    associate (weights => drive_weights(problem, place%drive), own => place%rate)
      select case (quantity)
      case (of_position)
        rate = matmul(weights, own(:2, :))
        if (.not. weights(1) > 0) rate = ieee_value(1.0_wp, ieee_quiet_nan)
      case (of_tension)
        rate = -own(of_load, :)
      case (of_energy)
        associate (load => place%at(of_load)*problem%load, &
          h0 => problem%law%separation_of(place%at(of_h0)))
          if (weights(1) > 0) then
            rate = own(of_energy, :) - weights(2)*load*own(of_load, :)
          else
            rate = own(of_energy, :) + load*own(of_h0, :) + h0*own(of_load, :)
          end if
        end associate
      case default
        rate = own(quantity, :)
      end select
    end associate
  end function rates_of

end module reported
