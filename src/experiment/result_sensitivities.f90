!> Derivatives of all that an outcome reports by the parameters of &sensitivity.
module result_sensitivities
  use kinds, only: wp
  use listener, only: listener_t
  use contact_state, only: state_t
  use frozen_jacobian, only: frozen_jacobian_t
  use path_coordinate, only: coordinate_of
  use known_path, only: landing_t, landing_over
  use reported, only: reported_t, measure_t
  use variation, only: along_path
  use state_sensitivity, only: place_on_path_t
  use place_sensitivity, only: local_t, find_local, at_fixed, at_extremum, of_h0, of_load, &
    of_displacement, of_energy
  use path_stepper, only: path_stepper_t
  use sensitivity_finder, only: finder_t, apart_at, h0_alone, load_alone
  use reading_sensitivities, only: rate_readings
  use stepped_branch, only: branch_t
  use experiment_request, only: sensitivity_t
  use experiment_result, only: experiment_result_t
  implicit none
  private
  public :: find_sensitivities

contains

  !> Differentiates what `steps` have found.
  subroutine find_sensitivities(sensitivity, steps, listener, outcome)
    type(sensitivity_t), intent(in) :: sensitivity
    class(path_stepper_t), intent(inout), target :: steps
    class(listener_t), intent(inout) :: listener
    type(experiment_result_t), intent(inout) :: outcome
    type(finder_t) :: finder
    integer :: k

    call listener%hear('differentiating')
    allocate (finder%varied(size(sensitivity%varied) + 1))
    finder%varied(1) = along_path(steps%problem)
    finder%varied(2:) = sensitivity%varied
    finder%steps => steps
    if (allocated(outcome%path)) then
      associate (path => outcome%path)
        call rate_list(finder, path%fold)
        call rate_list(finder, path%extremum)
        if (allocated(path%lowest)) call rate_reported(finder, path%lowest)
        if (allocated(path%finish) .and. .not. path%fallen) call rate_reported(finder, path%finish)
      end associate
    end if
    if (allocated(outcome%loading)) call rate_branch(finder, outcome%loading)
    if (allocated(outcome%unloading)) then
      do k = 1, size(outcome%unloading)
        call rate_branch(finder, outcome%unloading(k))
      end do
    end if
    if (allocated(outcome%readings)) call rate_readings(finder, outcome%readings)
    if (allocated(outcome%jumps)) call rate_energy(finder, outcome%jumps, outcome%energy_rate)
    outcome%differentiated = finder%whole
  end subroutine find_sensitivities

  subroutine rate_branch(finder, branch)
    type(finder_t), intent(inout) :: finder
    type(branch_t), intent(inout) :: branch

    if (allocated(branch%lowest)) call rate_reported(finder, branch%lowest)
    if (allocated(branch%jump)) call rate_reported(finder, branch%jump)
    if (allocated(branch%finish)) call rate_reported(finder, branch%finish)
  end subroutine rate_branch

  subroutine rate_list(finder, list)
    type(finder_t), intent(inout) :: finder
    type(reported_t), intent(inout) :: list(:)
    integer :: i

    do i = 1, size(list)
      call rate_reported(finder, list(i))
    end do
  end subroutine rate_list

  !> Differentiates a reported state; one that is not known to be on the path is left.
  subroutine rate_reported(finder, reported)
    type(finder_t), intent(inout) :: finder
    type(reported_t), intent(inout) :: reported
    real(wp), allocatable :: rate(:, :), before(:, :)
    logical :: found
    integer :: i

    if (reported%landing) then
      call rate_jump(finder, reported%point, before, rate, found)
    else if (reported%point > 0) then
      call rate_point(finder, reported%point, rate, found)
    else if (allocated(reported%witness)) then
      call rate_at_h0(finder, reported%witness%mesh, reported%witness%state, &
        [(0.0_wp, i=2, size(finder%varied))], rate, found)
    else
      return
    end if
    finder%whole = finder%whole .and. found
    if (.not. found) return
    allocate (reported%rate(size(rate, 2)))
    do i = 1, size(rate, 2)
      reported%rate(i) = measure_t(rate(of_h0, i), rate(of_displacement, i), rate(of_load, i), &
        rate(of_energy, i))
    end do
  end subroutine rate_reported

  !> Of a fold or an extremum of the load.
  subroutine rate_point(finder, i, rate, found)
    type(finder_t), intent(inout) :: finder
    integer, intent(in) :: i
    real(wp), allocatable, intent(out) :: rate(:, :)
    logical, intent(out) :: found

    associate (point => finder%steps%known%path%point(i))
      call at_extremum(finder%steps%equations_t, finder%steps%options, &
        place_on_path_t(point%mesh, point%coordinate, point%state), &
        merge(h0_alone, load_alone, point%fold), &
        apart_at(finder%steps%known%path, point%mesh, point%coordinate), finder%varied, rate, found)
    end associate
  end subroutine rate_point

  !> Of the state at its h0, which changes as `wanted` says.
  subroutine rate_at_h0(finder, mesh, state, wanted, rate, found)
    type(finder_t), intent(inout) :: finder
    integer, intent(in) :: mesh
    type(state_t), intent(in) :: state
    real(wp), intent(in) :: wanted(:)
    real(wp), allocatable, intent(out) :: rate(:, :)
    logical, intent(out) :: found
    type(frozen_jacobian_t) :: frozen
    type(local_t) :: local

    call find_local(finder%steps%equations_t, place_on_path_t(mesh, &
      coordinate_of(finder%steps%problem, mesh, state), state), frozen, finder%varied, local, found)
    if (found) rate = at_fixed(local, h0_alone, wanted)
  end subroutine rate_at_h0

  !> Of the jump over a fold: of the fold, and of the landing at its h0.
  subroutine rate_jump(finder, fold, before, after, found)
    type(finder_t), intent(inout) :: finder
    integer, intent(in) :: fold
    real(wp), allocatable, intent(out) :: before(:, :), after(:, :)
    logical, intent(out) :: found
    type(landing_t) :: landing
    integer :: k
    logical :: inside

    call landing_over(finder%steps%known, fold, k, inside)
    if (inside) then
      landing = finder%steps%known%inward(k)
    else
      landing = finder%steps%known%outward(k)
    end if
    call rate_point(finder, fold, before, found)
    found = found .and. landing%landed
    if (found) call rate_at_h0(finder, landing%mesh, landing%state, before(of_h0, :), after, found)
  end subroutine rate_jump

  !> Of the energy lost in the jumps over some folds.
  subroutine rate_energy(finder, folds, energy_rate)
    type(finder_t), intent(inout) :: finder
    integer, intent(in) :: folds(:)
    real(wp), allocatable, intent(out) :: energy_rate(:)
    real(wp), allocatable :: before(:, :), after(:, :)
    real(wp) :: total(size(finder%varied) - 1)
    logical :: found
    integer :: i

    total = 0
    do i = 1, size(folds)
      call rate_jump(finder, folds(i), before, after, found)
      finder%whole = finder%whole .and. found
      if (.not. found) return
      total = total + before(of_energy, :) - after(of_energy, :)
    end do
    energy_rate = total
  end subroutine rate_energy

end module result_sensitivities
