!> Places at which numbers are reported, and the quantities there. A place is an equilibrium and its
!> definition: D = drive(1) h0 + drive(2) load turns there along the path, or has a given value. The
!> module that finds the place sets its definition, `located_places` the values, and `place_rates`
!> the derivatives.
module reported_place
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: wp, nan
  use dimensionless_problem, only: problem_t
  use contact_state, only: state_t
  use curve_states, only: path_state_t
  implicit none
  private
  public :: place_t, place_of_state, place_without_state, point_of_path, place_on_curve
  public :: drive_weights, values_of, units_of, rates_of
  public :: of_h0, of_load, of_displacement, of_energy, of_radius, of_edge, of_position, &
    of_tension, of_profile
  public :: read_of_states, quantities, nowhere, least, rounding

  !> Quantities that are read at a state: h0, load, displacement, energy of the bodies, contact
  !> radius, radius to which the mesh is locked (0: about the axis); and quantities that follow from
  !> these: position of the drive, tension, error of the profile. At a place, `of_energy` is the
  !> energy of bodies and drive.
  integer, parameter :: read_of_states = 6, of_h0 = 1, of_load = 2, of_displacement = 3, &
    of_energy = 4, of_radius = 5, of_edge = 6, of_position = 7, of_tension = 8, of_profile = 9, &
    quantities = 9
  !> The value of `mesh` at a place without a mesh.
  integer, parameter :: nowhere = -1

  !> A place, in the units of `dimensionless_problem`.
  type :: place_t
    !> The point of the traced path at the place, or from which the jump starts that lands here; 0:
    !> there is none.
    integer :: point = 0
    logical :: landing = .false.
    !> The equilibrium, its mesh and its coordinate on this mesh; mesh 0: undeformed bodies.
    integer :: mesh = nowhere
    real(wp) :: s = 0
    type(state_t) :: state
    !> The weights of h0 and load in D; turn_of: the weights in the combination that turns here
    !> along the path, which is D or h0, or zeros; after: the place in the table at which the jump
    !> started that ended here at the same D.
    real(wp) :: drive(2) = [1.0_wp, 0.0_wp], turn_of(2) = 0
    integer :: after = 0
    !> Values at the place, and what the iteration and rounding leave of them as an error; both are
    !> set by `located_places`, except h0 and load; located: they are set.
    logical :: located = .false.
    real(wp), dimension(read_of_states) :: at = 0, left = 0
    !> Magnitude below which the relative error of a load does not matter.
    real(wp) :: negligible = 0
    !> Whether derivatives are read at the place, and whether a profile.
    logical :: differentiated = .false., with_profile = .false.
    !> The profile: radii, gaps and pressures; NaN where the mesh has none.
    real(wp), allocatable, dimension(:) :: r, gap, pressure
    !> Derivatives of the quantities by each parameter of &sensitivity, SI units.
    real(wp), allocatable :: rate(:, :)
  contains
    procedure :: take
    procedure :: has_state
    procedure :: turns
    procedure :: measures
    procedure :: leftovers
    procedure :: compared
  end type place_t

  !> Rounding error of a whole calculation; no smaller error is reported.
  real(wp), parameter :: rounding = 1.0e-13_wp
  !> Errors are relative to the larger of a quantity's magnitude and this value.
  real(wp), parameter :: least(quantities) = [1.0_wp, 0.0_wp, 1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, &
    1.0_wp, 0.0_wp, 0.0_wp]

contains

  !> A state as a place at its h0.
  pure type(place_t) function place_of_state(mesh, state) result(place)
    integer, intent(in) :: mesh
    type(state_t), intent(in) :: state

    place%mesh = mesh
    place%state = state
    place%at(of_h0) = state%h0
    place%at(of_load) = state%load
    place%at(of_displacement) = state%axis_gap - state%h0
    place%at(of_edge) = state%scale
  end function place_of_state

  !> A place of which only h0 and load are known; its other quantities do not exist.
  pure type(place_t) function place_without_state(h0, load) result(place)
    real(wp), intent(in) :: h0, load

    place%at = nan
    place%at(of_h0) = h0
    place%at(of_load) = load
  end function place_without_state

  !> The place of a point of the traced path; landing: the place is the state in which the jump from
  !> this point lands.
  pure type(place_t) function point_of_path(point, landing) result(place)
    integer, intent(in) :: point
    logical, intent(in), optional :: landing

    place%point = point
    if (present(landing)) place%landing = landing
  end function point_of_path

  !> A state of the path as a place whose D has the given weights.
  pure type(place_t) function place_on_curve(state, weights) result(place)
    type(path_state_t), intent(in) :: state
    real(wp), intent(in) :: weights(2)

    call place%take(state)
    place%drive = weights
  end function place_on_curve

  !> Makes a state of the path the equilibrium of the place.
  pure subroutine take(self, state)
    class(place_t), intent(inout) :: self
    type(path_state_t), intent(in) :: state

    self%mesh = state%mesh
    self%s = state%x
    self%state = state%state
    self%at = [state%h0, state%load, state%axis_gap - state%h0, state%energy, state%radius, &
      state%state%scale]
    self%left(of_energy) = state%uncertainty
  end subroutine take

  !> Whether the place has an equilibrium on a mesh.
  pure logical function has_state(self)
    class(place_t), intent(in) :: self

    has_state = allocated(self%state%gap)
  end function has_state

  !> Whether something turns here.
  pure logical function turns(self)
    class(place_t), intent(in) :: self

    turns = any(abs(self%turn_of) > 0)
  end function turns

  !> All quantities of a place.
  pure function measures(self) result(all)
    class(place_t), intent(in) :: self
    real(wp) :: all(quantities)

    associate (value => self%at)
      all(:read_of_states) = value
      ! At fixed D equilibria are stationary points of the energy of bodies and spring, or of that
      ! of bodies and dead load.
      if (self%drive(1) > 0) then
        all(of_energy) = value(of_energy) - 0.5_wp*self%drive(2)*value(of_load)**2
      else
        all(of_energy) = value(of_energy) + value(of_load)*value(of_h0)
      end if
      all(of_position) = dot_product(self%drive, value(:2))
      all(of_tension) = -value(of_load)
      all(of_profile) = 0
    end associate
  end function measures

  !> The error of all quantities due to the iteration and rounding.
  pure function leftovers(self) result(all)
    class(place_t), intent(in) :: self
    real(wp) :: all(quantities)

    all(:read_of_states) = self%left
    all(of_position) = dot_product(abs(self%drive), self%left(:2))
    all(of_tension) = self%left(of_load)
    all(of_profile) = 0
  end function leftovers

  !> The quantities whose relative errors tell how accurate the place is. with_radius: whether the
  !> contact radius is reported.
  pure function compared(self, with_radius)
    class(place_t), intent(in) :: self
    logical, intent(in) :: with_radius
    logical :: compared(quantities)

    compared = .false.
    compared(of_profile) = self%with_profile
    ! A given load is exact, and may be 0.
    compared(of_load) = self%drive(1) > 0 .or. self%turns() .or. self%after > 0
    if (.not. ieee_is_nan(self%at(of_load))) compared(of_load) = compared(of_load) .and. &
      .not. abs(self%at(of_load)) < self%negligible
    if (.not. ieee_is_nan(self%at(of_radius))) &
      compared(of_radius) = with_radius .and. self%at(of_radius) > 0
    if (self%after > 0) return
    compared(merge(of_position, of_h0, product(self%drive) < 0)) = .true.
    ! At an extremum h0 or the load is stationary and the displacement is not: the position on the
    ! flat top does not change the curve, and no displacement is reported there.
    if (.not. self%turns()) compared(of_displacement) = self%has_state()
  end function compared

  !> All quantities of a place [SI]; under a dead load a drive has no position.
  pure function values_of(problem, place) result(values)
    type(problem_t), intent(in) :: problem
    type(place_t), intent(in) :: place
    real(wp) :: values(quantities)

    values = place%measures()
    values([of_h0, of_position]) = problem%law%separation_of(values([of_h0, of_position]))
    associate (others => [of_load, of_displacement, of_energy, of_radius, of_edge, of_tension, &
      of_profile], units => units_of(problem))
      values(others) = values(others)*units(others)
    end associate
    if (.not. place%drive(1) > 0) values(of_position) = nan
  end function values_of

  !> The units of all quantities [SI].
  pure function units_of(problem) result(units)
    type(problem_t), intent(in) :: problem
    real(wp) :: units(quantities)

    units = problem%length
    units([of_load, of_tension]) = problem%load
    units(of_energy) = problem%load*problem%length
    units([of_radius, of_edge]) = problem%lateral
    units(of_profile) = 1
  end function units_of

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
    type(place_t), intent(in) :: place
    integer, intent(in) :: quantity
    real(wp) :: rate(size(place%rate, 2))

    associate (weights => drive_weights(problem, place%drive), own => place%rate, &
      values => values_of(problem, place))
      select case (quantity)
      case (of_position)
        rate = matmul(weights, own(:2, :))
        if (.not. weights(1) > 0) rate = nan
      case (of_tension)
        rate = -own(of_load, :)
      case (of_energy)
        rate = own(of_energy, :) - weights(2)*values(of_load)*own(of_load, :)
        if (.not. weights(1) > 0) rate = own(of_energy, :) + &
          values(of_load)*own(of_h0, :) + values(of_h0)*own(of_load, :)
      case default
        rate = own(quantity, :)
      end select
    end associate
  end function rates_of

end module reported_place
