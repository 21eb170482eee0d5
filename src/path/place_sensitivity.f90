!> Derivatives of the reported values of an equilibrium by the parameters: at a fixed place on the
!> path, at a fixed h0, position of a drive or load, or at an extremum of one of these. SI units
!> throughout.
!>
!> With s the path's coordinate and p a parameter, dQ/dp = Q_p + Q_s s_p. At a given value of D = a
!> h0 + b F, s_p = (dD/dp - D_p)/D_s; at an extremum of D, s_p = -D_sp/D_ss, and the derivative of D
!> itself is D_p.
module place_sensitivity
  use kinds, only: wp
  use dimensionless_problem, only: problem_t, contact_level_of
  use contact_state, only: state_t, gap_at, contact_radius_of
  use equilibrium, only: equations_t
  use solver_options, only: solver_options_t, tightened
  use anderson, only: solve_anderson
  use frozen_jacobian, only: frozen_jacobian_t
  use path_coordinate, only: path_control
  use potential_energy, only: energy_of
  use undeformed, only: load_undeformed, load_slope_undeformed, energy_undeformed
  use variation, only: variation_t
  use reported_place, only: of_h0, of_load, of_displacement, of_energy, of_radius
  use state_sensitivity, only: change_t, place_on_path_t, differentiate, move
  implicit none
  private
  public :: local_t, find_local, local_undeformed, at_fixed, at_extremum

  !> The quantities of a state: h0 [m], load [N], displacement [m], potential energy [J], contact
  !> radius [m].
  integer, parameter :: quantities = of_radius

  !> The column rate(:, i) has the derivatives of the quantities by parameter i at a fixed place;
  !> slope: their derivatives by s; along: the derivatives by s of the separations at the nodes and
  !> of h0.
  type :: local_t
    real(wp) :: slope(quantities) = 0
    real(wp), allocatable :: along(:), rate(:, :)
  end type local_t

  !> Relative difference of positions for the difference quotient of the gap.
  real(wp), parameter :: close = 1.0e-6_wp

contains

  !> The derivatives at a place. The first element of `varied` is the path's coordinate.
  subroutine find_local(equations, place, frozen, varied, local, found)
    type(equations_t), intent(inout) :: equations
    type(place_on_path_t), intent(in) :: place
    type(frozen_jacobian_t), intent(inout) :: frozen
    type(variation_t), intent(in) :: varied(:)
    type(local_t), intent(out) :: local
    logical, intent(out) :: found
    type(change_t) :: change(size(varied))
    real(wp) :: radius
    integer :: i

    allocate (local%rate(quantities, size(varied) - 1))
    call differentiate(equations, place, frozen, varied, change, found)
    if (.not. found) return
    local%along = change(1)%separation
    radius = contact_radius_of(equations%problem, equations%meshes%grid(place%mesh), place%state)
    call measure(equations, place, varied(1), change(1), radius, local%slope)
    do i = 2, size(varied)
      call measure(equations, place, varied(i), change(i), radius, local%rate(:, i - 1))
    end do
  end subroutine find_local

  !> The derivatives for undeformed bodies at the gap h0; their coordinate is -log(h0)
  !> (`traced_path`).
  type(local_t) function local_undeformed(problem, h0, varied) result(local)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0
    type(variation_t), intent(in) :: varied(:)
    real(wp) :: gap
    integer :: i, k

    allocate (local%rate(quantities, size(varied) - 1), source=0.0_wp)
    local%slope(of_h0) = -h0*problem%length
    local%slope(of_load) = -h0*load_slope_undeformed(problem, h0)*problem%load
    local%slope(of_energy) = h0*load_undeformed(problem, h0)*problem%load*problem%length
    do i = 2, size(varied)
      do k = 1, size(varied(i)%offset)
        associate (other => varied(i)%problem(k), rate => local%rate(:, i - 1))
          gap = other%law%gap_of(problem%law%separation_of(h0))
          rate(of_load) = rate(of_load) + &
            varied(i)%weight(k)*load_undeformed(other, gap)*other%load
          rate(of_energy) = rate(of_energy) + &
            varied(i)%weight(k)*energy_undeformed(other, gap)*other%load*other%length
        end associate
      end do
    end do
  end function local_undeformed

  !> Derivatives of the quantities along a line of equilibria; radius: of the contact.
  subroutine measure(equations, place, varied, line, radius, rate)
    type(equations_t), intent(inout) :: equations
    type(place_on_path_t), intent(in) :: place
    type(variation_t), intent(in) :: varied
    type(change_t), intent(in) :: line
    real(wp), intent(in) :: radius
    real(wp), intent(out) :: rate(quantities)
    type(problem_t) :: own
    type(state_t) :: moved
    real(wp) :: left(size(line%separation)), value(quantities), energy, uncertainty, x
    integer :: k

    own = equations%problem
    x = radius/place%state%scale
    rate = 0
    do k = 1, size(varied%offset)
      if (.not. abs(varied%weight(k)) > 0) cycle
      call move(equations, own, place, varied, k, line, moved, left)
      call energy_of(equations, place%mesh, moved, energy, uncertainty)
      associate (problem => varied%problem(k), grid => equations%meshes%grid(place%mesh))
        value = 0
        value(of_load) = moved%load*problem%load
        value(of_displacement) = (moved%axis_gap - moved%h0)*problem%length
        value(of_energy) = energy*problem%load*problem%length
        ! The separation at the edge of the contact, less the level that defines the edge.
        if (radius > 0) value(of_radius) = (gap_at(problem%shape, grid, moved, x) - &
          contact_level_of(problem))*problem%length
      end associate
      rate = rate + varied%weight(k)*value
    end do
    call equations%become_those_of(own)
    rate(of_h0) = line%separation(size(left))
    if (.not. radius > 0) return
    rate(of_radius) = -rate(of_radius)/steepness(equations, place, x)
    ! The mesh scales with the path's coordinate.
    if (.not. equations%meshes%is_about_axis(place%mesh)) rate(of_radius) = rate(of_radius) + &
      radius*own%lateral*sum(varied%weight*varied%shift)
  end subroutine measure

  !> Derivative of the separation by the position, at x on the mesh of a place.
  pure real(wp) function steepness(equations, place, x)
    type(equations_t), intent(in) :: equations
    type(place_on_path_t), intent(in) :: place
    real(wp), intent(in) :: x

    associate (problem => equations%problem, grid => equations%meshes%grid(place%mesh))
      steepness = (gap_at(problem%shape, grid, place%state, x*(1 + close)) - &
        gap_at(problem%shape, grid, place%state, x*(1 - close)))*problem%length/ &
        (2*close*x*place%state%scale*problem%lateral)
    end associate
  end function steepness

  !> Derivatives of the quantities for given derivatives `wanted` of weights(1) h0 + weights(2)
  !> load.
  pure function at_fixed(local, weights, wanted) result(rate)
    type(local_t), intent(in) :: local
    real(wp), intent(in) :: weights(2), wanted(:)
    real(wp) :: rate(quantities, size(wanted))
    integer :: i

    do i = 1, size(wanted)
      rate(:, i) = local%rate(:, i) + local%slope* &
        (wanted(i) - dot_product(weights, local%rate(:2, i)))/dot_product(weights, local%slope(:2))
    end do
  end function at_fixed

  !> Derivatives of the quantities at an extremum of weights(1) h0 + weights(2) load. The second
  !> derivatives are differences over places at distances of `apart` in s. found = .false.: a state
  !> at one of these places was not solved.
  subroutine at_extremum(equations, options, place, weights, apart, varied, rate, found)
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(place_on_path_t), intent(in) :: place
    real(wp), intent(in) :: weights(2), apart
    type(variation_t), intent(in) :: varied(:)
    real(wp), allocatable, intent(out) :: rate(:, :)
    logical, intent(out) :: found
    integer, parameter :: steps(4) = [-2, -1, 1, 2]
    real(wp), parameter :: rule(4) = [1, -8, 8, -1]/12.0_wp
    type(frozen_jacobian_t) :: frozen
    type(place_on_path_t) :: near
    type(local_t) :: local, there
    ! Second derivatives of D: by s twice, and by s and each parameter.
    real(wp) :: bend, cross(size(varied) - 1)
    integer :: k, i, n

    n = size(place%state%gap)
    call find_local(equations, place, frozen, varied, local, found)
    bend = 0
    cross = 0
    do k = 1, size(steps)
      if (.not. found) return
      near = place
      near%s = place%s + steps(k)*apart
      associate (moved => steps(k)*apart*local%along/equations%problem%length)
        near%state%gap = near%state%gap + moved(:n)
        near%state%h0 = near%state%h0 + moved(n + 1)
      end associate
      call solve_anderson(equations, tightened(options), frozen, &
        path_control(equations%problem, equations%meshes, near%mesh, near%s), near%state, found)
      found = found .or. near%state%residual <= options%tolerance
      if (found) call find_local(equations, near, frozen, varied, there, found)
      if (.not. found) return
      bend = bend + rule(k)/apart*dot_product(weights, there%slope(:2))
      cross = cross + rule(k)/apart*matmul(weights, there%rate(:2, :))
    end do
    allocate (rate, source=local%rate)
    do i = 1, size(cross)
      rate(:, i) = rate(:, i) - local%slope*cross(i)/bend
    end do
  end subroutine at_extremum

end module place_sensitivity
