!> The quantities at the places of a table, once a run has found the places, and their errors by
!> iteration and rounding. The states are those of the path at its points and after its jumps, and
!> those that an experiment has stored. A residual acts like an equal error of h0.
module located_places
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: wp, nan
  use contact_state, only: gap_at, contact_radius_of, far_gap
  use equilibrium, only: residual_floor
  use solver, only: solver_t
  use potential_energy, only: energy_of
  use path_point, only: path_point_t, no_mesh, h0_alone, load_alone
  use curve_states, only: solve_at
  use driven_pieces, only: jump_t
  use stepper, only: stepper_t
  use reported_place, only: place_t, of_h0, of_load, of_displacement, of_energy, of_radius, &
    of_edge, nowhere, rounding
  use places, only: places_t
  use represented_pressure, only: pressure_at_nodes
  implicit none
  private
  public :: locate_places

  !> Error of h0 after a search for a state along the path (law's lengths).
  real(wp), parameter :: tight = 3.0e-11_wp
  !> A residual that varies from node to node may move a state this many times as far as a uniform
  !> one, which acts like a change of h0.
  real(wp), parameter :: worst_residual = 3

contains

  !> Sets the values at all places, except those that another stepper, on other meshes, has located.
  !> like: the table of another run of the same scene; gaps are computed at the radii of its
  !> profiles. Without it, they are computed at the nodes.
  subroutine locate_places(steps, places, like)
    class(stepper_t), intent(inout) :: steps
    type(places_t), intent(inout) :: places
    type(places_t), intent(in), optional :: like
    integer :: i, k

    if (.not. allocated(places%place)) return
    do i = 1, size(places%place)
      if (allocated(steps%known) .and. .not. places%place(i)%located) &
        call find_on_path(steps, places%place(i))
    end do
    do i = 1, size(places%place)
      associate (place => places%place(i))
        if (place%located) cycle
        place%located = .true.
        call add_leftovers(steps, place)
        if (.not. (place%with_profile .and. place%mesh > 0)) cycle
        k = 0
        if (present(like)) k = same_profile(places, i, like)
        if (k > 0) then
          place%r = like%place(k)%r
        else
          place%r = place%state%scale*steps%meshes%grid(place%mesh)%x(:size(place%state%gap))
        end if
        call read_profile(steps, place, k == 0)
      end associate
    end do
  end subroutine locate_places

  !> The place of another table that has the profile, by name and element, of place i of a table; 0:
  !> there is none.
  pure integer function same_profile(places, i, like) result(k)
    type(places_t), intent(in) :: places, like
    integer, intent(in) :: i
    integer :: own, other

    k = 0
    do own = 1, size(places%entry)
      if (places%entry(own)%place /= i) cycle
      do other = 1, size(like%entry)
        associate (a => places%entry(own), b => like%entry(other))
          if (a%name /= b%name .or. a%element /= b%element .or. b%place == 0) cycle
          if (.not. allocated(like%place(b%place)%r)) cycle
          k = b%place
        end associate
        return
      end do
    end do
  end function same_profile

  !> Finds the equilibrium of a place on the path.
  subroutine find_on_path(steps, place)
    class(stepper_t), intent(inout) :: steps
    type(place_t), intent(inout) :: place
    type(jump_t) :: jump
    type(path_point_t) :: found

    associate (known => steps%known)
      if (place%landing) then
        jump = known%stable%jump_over(place%point)
        if (jump%landed) then
          call place%take(jump%after)
        else
          place%at = nan
        end if
      else if (place%point > 0) then
        associate (point => known%path%point(place%point))
          call solve_at(steps%solver_t, known%path, place%point, point%coordinate, found)
          call place%take(found)
          place%drive = merge(h0_alone, load_alone, point%fold)
          place%turn_of = place%drive
        end associate
      else if (place%has_state() .and. place%mesh /= nowhere .and. place%mesh /= no_mesh) then
        call energy_of(steps%equations_t, place%mesh, place%state, place%at(of_energy), &
          place%left(of_energy))
      end if
      if (place%mesh == no_mesh) place%scale(of_load) = rounding*steps%problem%law%adhesion
      if (place%mesh <= no_mesh) return
      if (steps%meshes%is_about_axis(place%mesh)) place%at(of_edge) = 0
    end associate
  end subroutine find_on_path

  !> Sets the contact radius, and adds the errors of iteration and rounding. The rounding of large
  !> gaps has no effect.
  subroutine add_leftovers(steps, place)
    class(solver_t), intent(in) :: steps
    type(place_t), intent(inout) :: place
    real(wp) :: moved, found

    found = place%left(of_h0)
    where (.not. ieee_is_nan(place%at)) place%left = place%left + rounding*abs(place%at)
    if (.not. (place%has_state() .and. place%mesh > 0)) return
    associate (state => place%state, at => place%at, left => place%left)
      at(of_radius) = contact_radius_of(steps%problem, steps%meshes%grid(place%mesh), state)
      moved = worst_residual*max(0.0_wp, &
        state%residual - 4*epsilon(1.0_wp)*min(maxval(state%gap), far_gap))
      if (place%turns() .or. place%after > 0) moved = max(moved, tight, &
        residual_floor(steps%problem, state))
      left(of_load) = left(of_load) + moved*abs(at(of_load))
      left(of_displacement) = left(of_displacement) + moved
      left(of_radius) = left(of_radius) + moved*at(of_radius)
      ! A given value is exact. The contact radius is not stationary where Q turns.
      if (place%turns()) left(of_radius) = left(of_radius) + &
        steps%options%place_error*at(of_radius)
      left(of_h0) = found
      if (place%turns() .or. abs(place%drive(2)) > 0 .or. place%after > 0) left(of_h0) = &
        found + moved
    end associate
  end subroutine add_leftovers

  !> Computes gaps and pressures at the radii place%r; own: these radii are the nodes.
  subroutine read_profile(steps, place, own)
    class(solver_t), intent(in) :: steps
    type(place_t), intent(inout) :: place
    logical, intent(in) :: own
    real(wp) :: x
    integer :: j

    associate (problem => steps%problem, grid => steps%meshes%grid(place%mesh), &
      state => place%state)
      place%gap = state%gap
      place%pressure = pressure_at_nodes(problem%law, grid, state%gap, state%pressure)
      if (own) return
      place%gap = spread(nan, 1, size(place%r))
      place%pressure = place%gap
      do j = 1, size(place%r)
        x = place%r(j)/state%scale
        if (x > grid%end) exit
        ! The gap between layered bodies cannot be interpolated from the few nodes of the tail.
        if (grid%in_tail(x) .and. .not. problem%body%is_homogeneous()) exit
        place%gap(j) = gap_at(problem%shape, grid, state, x)
        place%pressure(j:j) = problem%law%pressure(place%gap(j:j))
      end do
    end associate
  end subroutine read_profile

end module located_places
