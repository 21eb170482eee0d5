!> Derivatives of what is read from the path by the parameters of &sensitivity: of the curve, of the
!> jumps of driven bodies, of states under given loads.
module reading_sensitivities
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use frozen_jacobian, only: frozen_jacobian_t
  use traced_path, only: no_mesh
  use curve_states, only: curve_state_t, equilibrium_at
  use path_tangent, only: tangent_t
  use driven_pieces, only: drive_t, jump_t
  use state_sensitivity, only: place_on_path_t
  use place_sensitivity, only: local_t, find_local, local_undeformed, at_fixed, at_extremum, &
    of_h0, of_load, of_energy
  use path_sensitivity, only: rates_along
  use sensitivity_finder, only: finder_t, apart_at, h0_alone, load_alone
  use path_readings, only: path_readings_t
  implicit none
  private
  public :: rate_readings, weights_of

  !> Part of the terms of the slope of a drive's position that cancellation leaves at an extremum.
  real(wp), parameter :: turning = 1.0e-6_wp

contains

  !> Differentiates what was read from the path.
  subroutine rate_readings(finder, readings)
    type(finder_t), intent(inout) :: finder
    type(path_readings_t), intent(inout) :: readings
    logical :: found
    integer :: i, k

    if (.not. readings%solved) return
    call rates_along(finder%steps%equations_t, finder%steps%known%path, finder%varied(2:), &
      readings%rate, found)
    finder%whole = finder%whole .and. found
    if (allocated(readings%device)) then
      do i = 1, size(readings%device)
        do k = 1, size(readings%device(i)%jump)
          call rate_jump(finder, readings%device(i)%drive, readings%device(i)%jump(k))
        end do
      end do
    end if
    if (.not. allocated(readings%loaded)) return
    do i = 1, size(readings%loaded)
      call rate_state(finder, load_alone, [(0.0_wp, k=2, size(finder%varied))], &
        readings%loaded(i)%state)
    end do
  end subroutine rate_readings

  !> The weights of h0 and load in the position of a drive, SI units.
  pure function weights_of(problem, drive) result(weights)
    type(problem_t), intent(in) :: problem
    type(drive_t), intent(in) :: drive
    real(wp) :: weights(2)

    weights = drive%weights
    if (drive%weights(1) > 0) weights(2) = weights(2)*problem%length/problem%load
  end function weights_of

  !> Of a jump: where it starts, where it lands at the same position of the drive, what it loses.
  subroutine rate_jump(finder, drive, jump)
    type(finder_t), intent(inout) :: finder
    type(drive_t), intent(in) :: drive
    type(jump_t), intent(inout) :: jump
    real(wp) :: weights(2)

    weights = weights_of(finder%steps%problem, drive)
    call rate_start(finder, drive, weights, jump%before)
    if (.not. (allocated(jump%before%rate) .and. jump%landed)) return
    call rate_state(finder, weights, matmul(weights, jump%before%rate(:2, :)), jump%after)
    if (.not. allocated(jump%after%rate)) return
    jump%energy_rate = energy_rates(finder%steps%problem, weights, jump%before) - &
      energy_rates(finder%steps%problem, weights, jump%after)
  end subroutine rate_jump

  !> Of where a jump starts: where the drive's position turns round or, before it does, h0.
  subroutine rate_start(finder, drive, weights, state)
    type(finder_t), intent(inout) :: finder
    type(drive_t), intent(in) :: drive
    real(wp), intent(in) :: weights(2)
    type(curve_state_t), intent(inout) :: state
    type(place_on_path_t) :: place
    logical :: found, of_drive

    of_drive = abs(dot_product(drive%weights, state%slopes)) <= &
      turning*sum(abs(drive%weights*state%slopes))
    call place_of(finder, state, place, found)
    if (found) call at_extremum(finder%steps%equations_t, finder%steps%options, place, &
      merge(weights, h0_alone, of_drive), &
      apart_at(finder%steps%known%path, place%mesh, place%s), finder%varied, state%rate, found)
    finder%whole = finder%whole .and. found
  end subroutine rate_start

  !> Of a state at which weights(1) h0 + weights(2) load changes as `wanted` says.
  subroutine rate_state(finder, weights, wanted, state)
    type(finder_t), intent(inout) :: finder
    real(wp), intent(in) :: weights(2), wanted(:)
    type(curve_state_t), intent(inout) :: state
    type(frozen_jacobian_t) :: frozen
    type(place_on_path_t) :: place
    type(local_t) :: local
    logical :: found

    found = finder%steps%known%path%point(state%interval)%mesh == no_mesh
    if (found) then
      local = local_undeformed(finder%steps%problem, state%h0, finder%varied)
    else
      call place_of(finder, state, place, found)
      if (found) &
        call find_local(finder%steps%equations_t, place, frozen, finder%varied, local, found)
    end if
    finder%whole = finder%whole .and. found
    if (found) state%rate = at_fixed(local, weights, wanted)
  end subroutine rate_state

  !> A state of the curve with its gaps, which it does not keep.
  subroutine place_of(finder, state, place, found)
    type(finder_t), intent(inout) :: finder
    type(curve_state_t), intent(in) :: state
    type(place_on_path_t), intent(out) :: place
    logical, intent(out) :: found
    type(tangent_t) :: along

    associate (path => finder%steps%known%path)
      place%mesh = path%point(state%interval)%mesh
      found = place%mesh /= no_mesh
      if (.not. found) return
      place%s = state%x
      call equilibrium_at(finder%steps%solver_t, path, state, place%state, along, found)
    end associate
  end subroutine place_of

  !> Derivatives of the energy of bodies and spring, or dead load (`driven_pieces`).
  pure function energy_rates(problem, weights, state) result(rate)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: weights(2)
    type(curve_state_t), intent(in) :: state
    real(wp) :: rate(size(state%rate, 2))

    associate (load => state%load*problem%load, h0 => problem%law%separation_of(state%h0))
      if (weights(1) > 0) then
        rate = state%rate(of_energy, :) - weights(2)*load*state%rate(of_load, :)
      else
        rate = state%rate(of_energy, :) + load*state%rate(of_h0, :) + h0*state%rate(of_load, :)
      end if
    end associate
  end function energy_rates

end module reading_sensitivities
