!> Errors of the reported numbers. Each place is found again on a finer mesh, along the path or, if
!> there is one state for every h0, at its h0, and the same quantities are read there. The
!> difference contains the residual error of the state itself. The residual error on the finer mesh
!> is added: a residual acts like an equal error of h0.
module place_errors
  use kinds, only: wp
  use undeformed, only: load_slope_undeformed
  use regridding, only: regrid
  use contact_state, only: state_t, gap_at, contact_radius_of
  use controls, only: control_t
  use equilibrium, only: residual_floor
  use solver, only: solver_t
  use path_coordinate, only: path_control, coordinate_of
  use path_tangent, only: h0_alone => of_h0, load_alone => of_load
  use potential_energy, only: energy_of
  use curve_states, only: path_state_t, path_place_t, state_of
  use known_path, only: landing_t, landing_over
  use locked_meshes, only: h0_control
  use traced_path, only: traced_path_t, no_mesh
  use path_stepper, only: path_stepper_t
  use tension_search, only: load_tolerance
  use reported_place, only: place_t, place_of_state, of_h0, of_load, of_displacement, &
    of_energy, of_radius, of_edge, nowhere, read_of_states
  use places, only: places_t
  use arc, only: arc_t
  use finer_solver, only: expansion_t, finer_t, rounding, worst_residual, what_residual_leaves
  use represented_pressure, only: pressure_at_nodes
  implicit none
  private
  public :: judge_places, conclude

  !> Error of h0 after a search for a state along the path; and a change of h0 for a difference
  !> quotient, small and yet large against rounding (law's lengths).
  real(wp), parameter :: tight = 3.0e-11_wp, shift = 1.0e-5_wp
  !> Quantities that the residual moves.
  integer, parameter :: moving(*) = [of_h0, of_load, of_displacement, of_radius]

contains

  !> Judges all places that are read, or all places, unless they are judged already; the steps count
  !> the cost. A place comes after the place from which its jump started.
  subroutine judge_places(fine, steps, places, all)
    type(finer_t), intent(inout) :: fine
    class(solver_t), intent(inout) :: steps
    type(places_t), intent(inout) :: places
    logical, intent(in) :: all
    real(wp) :: wanted
    integer :: i

    if (.not. allocated(places%place)) return
    select type (steps)
    class is (path_stepper_t)
      call locate(steps)
    end select
    fine%cost = steps%cost
    do i = 1, size(places%place)
      associate (place => places%place(i))
        if (place%judged .or. place%mesh == nowhere .or. .not. (all .or. place%read)) cycle
        wanted = dot_product(place%drive, place%at(:2))
        if (place%after > 0) wanted = dot_product(place%drive, places%place(place%after)%fine(:2))
        place%judged = .true.
        place%margin = fine%margin
        if (place%has_state()) place%at(of_radius) = &
          contact_radius_of(steps%problem, steps%meshes%grid(place%mesh), place%state)
        place%fine = place%at
        if (place%mesh == no_mesh) then
          place%left = rounding*abs(place%at)
          if (place%after > 0) then
            call move_undeformed(place)
            place%known = places%place(place%after)%known
          end if
          cycle
        end if
        select type (steps)
        class is (path_stepper_t)
          call judge_on_path(steps%known%path, place)
          if (place%after > 0) place%known = place%known .and. places%place(place%after)%known
        class default
          call judge_at_h0(place)
        end select
        if (place%searched) place%left(of_load) = place%left(of_load) + &
          load_tolerance*abs(place%at(of_load))
      end associate
    end do
    steps%cost = fine%cost

  contains

    !> Finds the equilibria of the places on the path.
    subroutine locate(steps)
      class(path_stepper_t), intent(inout) :: steps
      type(landing_t) :: landing
      type(path_state_t) :: state
      integer :: i

      do i = 1, size(places%place)
        associate (place => places%place(i), known => steps%known)
          if (place%judged .or. place%mesh == no_mesh) cycle
          if (place%landing) then
            landing = landing_over(known, place%point)
            if (landing%landed) call place%take(landing%after)
            place%judged = .not. landing%landed
            place%known = landing%landed
          else if (place%point > 0) then
            associate (point => known%path%point(place%point))
              call state_of(steps%solver_t, known%path, path_place_t(place%point, &
                point%coordinate), state)
              call place%take(state)
              place%drive = merge(h0_alone, load_alone, point%fold)
              place%turn_of = place%drive
            end associate
          else if (place%has_state() .and. place%mesh /= nowhere) then
            place%s = coordinate_of(steps%problem, steps%meshes, place%mesh, place%state)
            call energy_of(steps%equations_t, place%mesh, place%state, place%at(of_energy), &
              place%left(of_energy))
          end if
        end associate
      end do
    end subroutine locate

    !> Bodies that land undeformed land at another place if their jump starts at another; wanted: D
    !> where the jump starts on the finer mesh.
    pure subroutine move_undeformed(place)
      type(place_t), intent(inout) :: place
      real(wp) :: slope, change

      place%negligible = rounding*steps%problem%law%adhesion
      slope = load_slope_undeformed(steps%problem, place%at(of_h0))
      change = (wanted - dot_product(place%drive, place%at(:2)))/ &
        dot_product(place%drive, [1.0_wp, slope])
      place%fine(of_h0) = place%at(of_h0) + change
      place%fine(of_load) = place%at(of_load) + slope*change
      place%fine(of_energy) = place%at(of_energy) - place%at(of_load)*change
    end subroutine move_undeformed

    !> Judges a place of a path; wanted: the value of D on the finer mesh, unless D turns.
    subroutine judge_on_path(path, place)
      type(traced_path_t), intent(in) :: path
      type(place_t), intent(inout) :: place
      type(expansion_t) :: near
      type(arc_t) :: about
      type(state_t) :: right
      real(wp) :: distance, left, moved(read_of_states)
      logical :: found

      call fine%prepare(place%mesh)
      about = path%arc_about(place%mesh, place%s)
      near%s = place%s
      near%state = guess_of(place)
      near%curvature(:2) = [about%curvature(h0_alone, near%s), about%curvature(load_alone, near%s)]
      call near%move_to(fine, place%mesh, merge(place%turn_of, place%drive, place%turns()), &
        place%turns(), wanted, distance, place%known)
      if (.not. place%known) return
      associate (at => place%at, there => place%fine)
        there = near%read_at(distance)
        if (fine%meshes%is_about_axis(place%mesh)) then
          at(of_edge) = 0
          there(of_edge) = 0
        end if
        left = 0
        if (place%turns() .or. place%after > 0) left = tight
        ! Where bodies deform much, rounding of h0 exceeds the error of the search.
        if (place%turns()) left = max(left, residual_floor(fine%problem, place%state))
        place%left(of_load) = (rounding + worst_residual*tight)*abs(at(of_load))
        place%left(of_displacement) = left + rounding*abs(at(of_displacement))
        place%left(of_radius) = rounding*at(of_radius)
        if (place%turns()) then
          place%left(of_h0) = left
          ! The contact radius is not stationary where D turns.
          moved = near%read_at(distance + fine%options%place_error)
          place%left(of_radius) = place%left(of_radius) + abs(moved(of_radius) - there(of_radius))
        else
          ! The residual moves a state at a given D like an equal error of h0 in D.
          left = max(left, what_residual_leaves(near%state))
          moved = near%read_at(near%distance_to(place%drive, .false., wanted + place%drive(1)*left))
          place%left(moving) = place%left(moving) + abs(moved(moving) - there(moving))
          if (abs(place%drive(1)) <= 0) place%left(of_h0) = place%left(of_h0) + left
          ! A given value is exact; that of a landing has the error of the turn.
          if (abs(place%drive(2)) <= 0) then
            place%left(of_h0) = 0
            there(of_h0) = wanted
          end if
          if (abs(place%drive(1)) <= 0 .and. place%after == 0) there(of_load) = at(of_load)
        end if
      end associate
      if (.not. place%with_profile) return
      right = near%state
      call fine%find(path_control(fine%problem, fine%meshes, place%mesh, near%s + distance), &
        right, found)
      place%profile = 1
      if (found) place%profile = profile_error(place, right)
    end subroutine judge_on_path

    !> Judges a place without a path, where h0 determines the state.
    subroutine judge_at_h0(place)
      type(place_t), intent(inout) :: place
      type(place_t) :: there, beside
      type(state_t) :: state
      type(control_t) :: control
      real(wp) :: left

      ! A state that did not converge cannot be compared.
      place%known = place%state%residual < 1
      if (.not. place%known) return
      call fine%prepare(place%mesh)
      state = guess_of(place)
      call fine%frozen%forget()
      control = h0_control(steps%problem%shape, steps%meshes, place%mesh, place%at(of_h0))
      call fine%find(control, state, place%known)
      if (.not. place%known) return
      there = place_of_state(place%mesh, state)
      there%at(of_radius) = contact_radius_of(steps%problem, fine%meshes%grid(place%mesh), state)
      place%fine = there%at
      place%left = rounding*abs(place%at)
      if (place%with_profile) place%profile = profile_error(place, state)
      left = what_residual_leaves(state)/shift
      control%value = control%value + shift
      call fine%find(control, state, place%known)
      if (.not. place%known) return
      beside = place_of_state(place%mesh, state)
      beside%at(of_radius) = contact_radius_of(steps%problem, fine%meshes%grid(place%mesh), state)
      place%left = place%left + left*abs(beside%at - there%at)
      place%left(of_h0) = 0
    end subroutine judge_at_h0

    pure type(state_t) function guess_of(place) result(state)
      type(place_t), intent(in) :: place

      state = regrid(steps%problem%shape, place%state, steps%meshes%grid(place%mesh), &
        fine%meshes%grid(place%mesh), place%state%scale)
    end function guess_of

    !> The largest difference of gaps, and of pressures over the largest pressure, between a place
    !> and the same place on a finer mesh, on the axis and at its nodes, times the margin.
    !> Differences of gaps above the law's length are relative: at large gaps rounding is
    !> proportional to the gap.
    pure real(wp) function profile_error(place, right) result(largest)
      type(place_t), intent(in) :: place
      type(state_t), intent(in) :: right
      real(wp) :: x, gap, strongest, pressure(size(place%state%gap))
      integer :: j

      associate (law => steps%problem%law, finer => fine%meshes%grid(place%mesh), state => &
        place%state)
        strongest = max(maxval(abs(right%pressure)), tiny(1.0_wp))
        largest = max(abs(right%axis_gap - state%axis_gap), &
          maxval(abs(law%pressure([right%axis_gap]) - law%pressure([state%axis_gap])))/strongest)
        pressure = pressure_at_nodes(law, steps%meshes%grid(place%mesh), state%gap, state%pressure)
        do j = 1, size(state%gap)
          x = state%scale*steps%meshes%grid(place%mesh)%x(j)/right%scale
          if (x > finer%end) exit
          ! Under layers the gap in the tail is no polynomial of few nodes.
          if (finer%in_tail(x) .and. .not. steps%problem%body%is_homogeneous()) exit
          gap = gap_at(steps%problem%shape, finer, right, x)
          largest = max(largest, abs(gap - state%gap(j))/max(1.0_wp, gap), &
            maxval(abs(law%pressure([gap]) - pressure(j)))/strongest)
        end do
      end associate
      largest = fine%margin*largest
    end function profile_error

  end subroutine judge_places

  !> The largest relative error of all reported numbers, if any place was judged.
  pure subroutine conclude(places, estimate)
    type(places_t), intent(in) :: places
    real(wp), allocatable, intent(inout) :: estimate

    if (.not. allocated(places%place)) return
    if (any(places%place%judged)) estimate = max(rounding, places%largest_error())
  end subroutine conclude

end module place_errors
