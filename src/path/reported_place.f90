!> Places at which numbers are reported, and the quantities there. A place is an equilibrium and its
!> definition: Q = drive(1) h0 + drive(2) load turns there along the path, or has a given value. The
!> module that finds the place sets its definition, and `located_places` the values.
module reported_place
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: wp, pi, nan
  use dimensionless_problem, only: problem_t
  use contact_state, only: state_t
  use path_point, only: path_point_t
  implicit none
  private
  public :: place_t, place_of_state, place_without_state, point_of_path, place_on_curve
  public :: values_of, units_of
  public :: of_h0, of_load, of_displacement, of_energy, of_radius, of_edge, of_suction, &
    of_position, of_tension, of_work, of_profile
  public :: read_of_states, quantities, nowhere, least, rounding

  !> Quantities of a state: h0, load, displacement, energy of the bodies, contact radius, radius to
  !> which the mesh is locked (0: about the axis), suction of a fluid. Quantities that follow from
  !> these: position of the drive, tension, effective work of adhesion (tension over 1.5 pi R),
  !> error of the profile. At a place, `of_energy` is the energy of bodies and drive.
  integer, parameter :: read_of_states = 7, of_h0 = 1, of_load = 2, of_displacement = 3, &
    of_energy = 4, of_radius = 5, of_edge = 6, of_suction = 7, of_position = 8, of_tension = 9, &
    of_work = 10, of_profile = 11, quantities = 11
  !> The value of `mesh` at a place without a mesh.
  integer, parameter :: nowhere = -1

  !> A place, in the units of `dimensionless_problem`.
  type :: place_t
    !> The number of the point of the traced path at the place or, if `landing`, of the point whose
    !> jump lands at the place; 0: there is none.
    integer :: point = 0
    logical :: landing = .false.
    !> The equilibrium and its mesh; mesh 0: undeformed bodies.
    integer :: mesh = nowhere
    type(state_t) :: state
    !> The weights of h0 and load in Q. turn_of: the weights of the combination (Q or h0) that turns
    !> here along the path, or zeros. after: the place in the table from which a jump at the same Q
    !> led here.
    real(wp) :: drive(2) = [1.0_wp, 0.0_wp], turn_of(2) = 0
    integer :: after = 0
    !> Values at the place, and their errors due to the iteration and rounding. `located_places`
    !> sets both, except the values of h0 and load, which exist before; located: they are set.
    logical :: located = .false.
    real(wp), dimension(read_of_states) :: at = 0, left = 0
    !> Errors are relative to this value if the magnitude of the quantity is smaller.
    real(wp) :: scale(quantities) = 0
    !> Whether the place belongs to a drive in time. Only its loads, energies and suctions count for
    !> the accuracy, since positions are given functions of time.
    logical :: in_time = .false.
    !> Whether a profile is read at the place.
    logical :: with_profile = .false.
    !> The profile: radii, gaps and pressures; NaN where the mesh has none.
    real(wp), allocatable, dimension(:) :: r, gap, pressure
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
  real(wp), parameter :: least(quantities) = [1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0]

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

  !> A state of the path as a place whose Q has the given weights.
  pure type(place_t) function place_on_curve(point, weights) result(place)
    type(path_point_t), intent(in) :: point
    real(wp), intent(in) :: weights(2)

    call place%take(point)
    place%drive = weights
  end function place_on_curve

  !> Makes a state of the path the equilibrium of the place.
  pure subroutine take(self, point)
    class(place_t), intent(inout) :: self
    type(path_point_t), intent(in) :: point

    self%mesh = point%mesh
    self%state = point%state
    associate (state => point%state)
      self%at = [state%h0, state%load, state%axis_gap - state%h0, point%energy, point%radius, &
        state%scale, 0.0_wp]
    end associate
    self%left(of_energy) = point%uncertainty
  end subroutine take

  !> Whether the place has an equilibrium on a mesh.
  pure logical function has_state(self)
    class(place_t), intent(in) :: self

    has_state = allocated(self%state%gap)
  end function has_state

  !> Whether Q or h0 turns at the place.
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
      ! At fixed Q equilibria are stationary points of the energy of bodies and spring, or of that
      ! of bodies and dead load.
      if (self%drive(1) > 0) then
        all(of_energy) = value(of_energy) - 0.5_wp*self%drive(2)*value(of_load)**2
      else
        all(of_energy) = value(of_energy) + value(of_load)*value(of_h0)
      end if
      all(of_position) = dot_product(self%drive, value(:2))
      all(of_tension) = -value(of_load)
      all(of_work) = -value(of_load)/(1.5_wp*pi)
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
    all(of_work) = self%left(of_load)/(1.5_wp*pi)
    all(of_profile) = 0
  end function leftovers

  !> The quantities whose relative errors are the accuracy of the place. with_radius: whether the
  !> contact radius is reported.
  pure function compared(self, with_radius)
    class(place_t), intent(in) :: self
    logical, intent(in) :: with_radius
    logical :: compared(quantities)

    compared = .false.
    if (self%in_time) then
      compared([of_load, of_energy, of_suction]) = .true.
      return
    end if
    compared(of_profile) = self%with_profile
    ! A given load is exact, and may be 0.
    compared(of_load) = self%drive(1) > 0 .or. self%turns() .or. self%after > 0
    if (.not. ieee_is_nan(self%at(of_radius))) &
      compared(of_radius) = with_radius .and. self%at(of_radius) > 0
    if (self%after > 0) return
    compared(merge(of_position, of_h0, product(self%drive) < 0)) = .true.
    ! At an extremum h0 or the load is stationary, but the displacement is not, so no displacement
    ! is reported there.
    if (.not. self%turns()) compared(of_displacement) = self%has_state()
  end function compared

  !> All quantities of a place [SI]; under a dead load a drive has no position.
  pure function values_of(problem, place) result(values)
    type(problem_t), intent(in) :: problem
    type(place_t), intent(in) :: place
    real(wp) :: values(quantities)

    associate (measures => place%measures())
      values = measures*units_of(problem)
      values([of_h0, of_position]) = problem%law%separation_of(measures([of_h0, of_position]))
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
    units(of_suction) = problem%pressure
    units(of_work) = problem%load/problem%radius
    units(of_profile) = 1
  end function units_of

end module reported_place
