!> The guard over meshes under laws with lengths of their own: where the pressure of a state of the
!> path is not the polynomial of its panel, the panel is halved and the path traced again.
module refinement
  use kinds, only: wp
  use listener, only: listener_t
  use known_path, only: known_path_t
  use path_stepper, only: path_stepper_t
  implicit none
  private
  public :: trace_resolved, unresolved_from

  !> How often panels are halved, and the tail over the accuracy from which on they are. Tails are
  !> of pressures, on the worst panel of the worst state that the path happens to have; load and h0
  !> are far better, but at a fold the load feels 7 % of a tail (Dugdale's with a hard repulsion),
  !> and the states between may have tails three times as large. Never below what the iteration
  !> leaves of a stiff pressure.
  integer, parameter :: most_rounds = 6
  real(wp), parameter :: times = 30, least = 1.0e-8_wp

  !> The largest tails of the pressure on the panels of a mesh.
  type :: tails_t
    real(wp), allocatable :: of_panel(:)
  end type tails_t

contains

  !> The tail of a pressure, over the largest, from which on a panel is too long.
  pure real(wp) function unresolved_from(accuracy) result(tail)
    real(wp), intent(in) :: accuracy

    tail = max(times*accuracy, least)
  end function unresolved_from

  !> Traces the path (`know_path`), again where panels had to be halved; panel_tail: the largest
  !> tail that is left, but of a fall onto each other, which ends on no mesh. The paper's laws need
  !> none of it: their meshes were fitted to their errors.
  subroutine trace_resolved(steps, h0_high, h0_low, into_contact, closely, accuracy, listener, &
    panel_tail)
    class(path_stepper_t), intent(inout) :: steps
    real(wp), intent(in) :: h0_high, h0_low, accuracy
    logical, intent(in) :: into_contact, closely
    class(listener_t), intent(inout) :: listener
    real(wp), intent(out) :: panel_tail
    type(tails_t), allocatable :: tails(:)
    type(known_path_t) :: nothing
    integer :: round, mesh

    panel_tail = 0
    call steps%know_path(h0_high, h0_low, into_contact, closely, listener)
    if (steps%problem%law%of_paper) return
    do round = 0, most_rounds
      tails = tails_on_path(steps)
      panel_tail = 0
      do mesh = 1, size(tails)
        panel_tail = max(panel_tail, maxval(tails(mesh)%of_panel))
      end do
      if (.not. panel_tail > unresolved_from(accuracy) .or. round == most_rounds) exit
      do mesh = 1, size(tails)
        associate (long => tails(mesh)%of_panel > unresolved_from(accuracy), &
          cost => steps%cost, meshes => steps%meshes)
          if (.not. any(long)) cycle
          call meshes%halve_panels(mesh, long)
          cost%kernel_entries = cost%kernel_entries + meshes%grid(mesh)%kernel_entries()
        end associate
      end do
      steps%known = nothing
      call steps%know_path(h0_high, h0_low, into_contact, closely, listener)
    end do
    if (steps%known%fallen) panel_tail = 0
  end subroutine trace_resolved

  !> The largest tails over all states of the path.
  pure function tails_on_path(steps) result(tails)
    class(path_stepper_t), intent(in) :: steps
    type(tails_t) :: tails(size(steps%meshes%grid))
    integer :: i, mesh

    do mesh = 1, size(tails)
      allocate (tails(mesh)%of_panel(size(steps%meshes%grid(mesh)%panel)), source=0.0_wp)
    end do
    do i = 1, steps%known%path%held
      associate (point => steps%known%path%point(i))
        associate (largest => tails(point%mesh)%of_panel)
          largest = max(largest, steps%meshes%grid(point%mesh)%panel_tails(point%state%pressure))
        end associate
      end associate
    end do
  end function tails_on_path

end module refinement
