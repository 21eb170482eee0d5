!> The effect of the start on a drive of viscoelastic bodies. A drive begins with relaxed bodies. If
!> they are near each other, the attraction has already deformed them. In a fast drive they keep
!> this deformation, so that their tips are sharper, or blunter, than those of undeformed bodies.
module frozen_start
  use kinds, only: wp
  use contact_state, only: state_t
  use creep, only: creep_t
  use records, only: record_t
  use time_instant, only: instant_t
  use time_stepper, only: time_stepper_t
  use relaxed_start, only: begin_at_rest
  implicit none
  private
  public :: effect_of_start

contains

  !> Estimate of the relative change of the largest tension by the initial deformation, as far as
  !> this remains when the tension is largest. The tension of a contact of radius a is about
  !> proportional to the radius of curvature of the bodies, so it changes by the same ratio as their
  !> height at a. row: the rows of the drive in SI units, with times since its start; position:
  !> where the drive starts.
  real(wp) function effect_of_start(steps, position, row) result(effect)
    type(time_stepper_t), intent(inout) :: steps
    real(wp), intent(in) :: position
    type(record_t), intent(in) :: row(:)
    type(instant_t) :: start
    real(wp) :: radius
    integer :: k
    logical :: found

    effect = 0
    if (size(steps%creep%time) == 0 .or. size(row) == 0) return
    k = minloc(row%load, 1)
    if (.not. row(k)%load < 0) return
    call begin_at_rest(steps, position, start, found)
    if (.not. found) return
    ! Before contact tension acts over about one lateral unit.
    radius = max(1.0_wp, row(k)%contact_radius/steps%problem%lateral)
    effect = kept_part(steps%creep, row(k)%time)*change_of_height(steps, start%mesh, start%state, &
      radius)
  end function effect_of_start

  !> The part of the deformation of relaxed bodies that remains after a time, if no more is added.
  pure real(wp) function kept_part(creep, time) result(part)
    type(creep_t), intent(in) :: creep
    real(wp), intent(in) :: time

    part = sum(creep%share*exp(-time/creep%time))/creep%relaxed()
  end function kept_part

  !> The change of the bodies' height at a radius by their deformation, divided by this height.
  pure real(wp) function change_of_height(steps, mesh, state, radius) result(change)
    type(time_stepper_t), intent(in) :: steps
    integer, intent(in) :: mesh
    type(state_t), intent(in) :: state
    real(wp), intent(in) :: radius
    real(wp), allocatable :: height(:)
    integer :: j

    associate (r => steps%meshes%grid(mesh)%x*state%scale)
      j = min(count(r < radius) + 1, size(r))
      height = steps%problem%shape%height(r)
      ! Heights are measured from the axis, so the deformation of the axis is subtracted.
      change = abs((state%gap(j) - height(j)) - state%axis_gap)/height(j)
    end associate
  end function change_of_height

end module frozen_start
