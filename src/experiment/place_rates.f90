!> Derivatives of the reported numbers by the parameters of &sensitivity: at each place that is
!> read, and along the curve of the path.
module place_rates
  use kinds, only: wp
  use listener, only: listener_t
  use frozen_jacobian, only: frozen_jacobian_t
  use path_sensitivity, only: rates_along
  use traced_path, only: traced_path_t, no_mesh
  use variation, only: variation_t, along_path
  use state_sensitivity, only: place_on_path_t
  use place_sensitivity, only: local_t, find_local, local_undeformed, at_fixed, at_extremum
  use reported_place, only: place_t, drive_weights, of_h0, nowhere
  use path_stepper, only: path_stepper_t
  use experiment_result, only: experiment_result_t
  implicit none
  private
  public :: rate_places

  !> Distance for second derivatives over the distance between two points of the path, and the
  !> latter distance if it is not known.
  real(wp), parameter :: part = 0.015_wp, usual = 0.1_wp

contains

  !> Differentiates all places at which numbers are read, and the curve. A place comes after the
  !> place from which its jump started.
  subroutine rate_places(parameters, steps, listener, outcome)
    type(variation_t), intent(in) :: parameters(:)
    class(path_stepper_t), intent(inout) :: steps
    class(listener_t), intent(inout) :: listener
    type(experiment_result_t), intent(inout) :: outcome
    ! The first is the path's coordinate.
    type(variation_t) :: varied(size(parameters) + 1)
    real(wp) :: wanted(size(parameters))
    logical :: found
    integer :: i

    call listener%hear('differentiating')
    varied(2:) = parameters
    if (allocated(outcome%readings)) then
      if (outcome%readings%solved) then
        call rates_along(steps%equations_t, steps%known%path, varied(2:), &
          outcome%readings%rate, found)
        outcome%differentiated = found
      end if
    end if
    if (.not. allocated(outcome%places%place)) return
    associate (places => outcome%places)
      do i = 1, size(places%place)
        associate (place => places%place(i))
          if (place%mesh == nowhere .or. .not. place%differentiated) cycle
          wanted = 0
          found = .true.
          if (place%after > 0) then
            found = allocated(places%place(place%after)%rate)
            if (found) wanted = matmul(drive_weights(steps%problem, place%drive), &
              places%place(place%after)%rate(:2, :))
          end if
          if (found) call rate_place(steps, varied, wanted, place, found)
        end associate
        outcome%differentiated = outcome%differentiated .and. found
      end do
    end associate
  end subroutine rate_places

  !> Differentiates a place; wanted: the derivatives of D, if nothing turns there. The first element
  !> of `varied` becomes the coordinate.
  subroutine rate_place(steps, varied, wanted, place, found)
    class(path_stepper_t), intent(inout) :: steps
    type(variation_t), intent(inout) :: varied(:)
    real(wp), intent(in) :: wanted(:)
    type(place_t), intent(inout) :: place
    logical, intent(out) :: found
    type(frozen_jacobian_t) :: frozen
    type(place_on_path_t) :: at
    type(local_t) :: local
    real(wp) :: apart

    at = place_on_path_t(place%mesh, place%s, place%state)
    apart = apart_at(steps%known%path, place%mesh, place%s)
    varied(1) = along_path(steps%problem, apart)
    if (place%turns()) then
      found = place%mesh /= no_mesh
      if (found) call at_extremum(steps%equations_t, steps%options, at, &
        drive_weights(steps%problem, place%turn_of), apart, varied, place%rate, found)
      return
    end if
    found = .true.
    if (place%mesh == no_mesh) then
      local = local_undeformed(steps%problem, place%at(of_h0), varied)
    else
      call find_local(steps%equations_t, at, frozen, varied, local, found)
    end if
    if (found) place%rate = at_fixed(local, drive_weights(steps%problem, place%drive), wanted)
  end subroutine rate_place

  !> The distance of the coordinate for second derivatives at s: a fraction of that between the
  !> neighbouring points of the path. Folds and extrema do not count, since they may be arbitrarily
  !> near.
  pure real(wp) function apart_at(path, mesh, s) result(apart)
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: mesh
    real(wp), intent(in) :: s
    real(wp) :: below, above
    integer :: i

    below = s - usual
    above = s + usual
    do i = 1, path%held
      if (path%point(i)%fold .or. path%point(i)%load_extremum) cycle
      if (path%point(i)%mesh /= mesh) cycle
      associate (at => path%point(i)%coordinate)
        if (at < s) below = max(below, at)
        if (at > s) above = min(above, at)
      end associate
    end do
    apart = part*(above - below)
  end function apart_at

end module place_rates
