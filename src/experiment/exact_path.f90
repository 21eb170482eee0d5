!> The path as exactly as a deck asks for. Where two extrema have just appeared, a small error of
!> the mesh moves them far. No rule for meshes can know this beforehand: the path is traced again.
module exact_path
  use kinds, only: wp
  use clock, only: seconds
  use listener, only: listener_t
  use mesh_digits, only: most_digits
  use mesh_store, only: mesh_store_t
  use edge_locked, only: mesh_family_t, new_mesh_family
  use known_path, only: known_path_t
  use mending, only: too_much
  use path_stepper, only: path_stepper_t
  use experiment_request, only: request_t
  use path_demand, only: farthest_wanted
  use places, only: places_t
  use reported_place, only: point_of_path
  use finer_solver, only: finer_t
  use place_errors, only: judge_places
  implicit none
  private
  public :: trace_exactly

  !> How often a path is traced, and the digits more of each time: those of the meshes, and of the
  !> accuracy down to which panels are halved.
  integer, parameter :: most_rounds = 3
  real(wp), parameter :: further_digits = 1
  !> A digit more makes errors of a mesh some ten times smaller. Where no more than this is gained
  !> they come from something else, such as rounding, and a further one is in vain.
  real(wp), parameter :: helped = 0.3_wp

  !> A path that was traced, its meshes, what judges it, its extrema and the largest error of them.
  type :: tracing_t
    type(mesh_family_t) :: meshes
    type(known_path_t) :: known
    type(finer_t) :: fine
    type(places_t) :: places
    real(wp) :: worst = 0
  end type tracing_t

contains

  !> Traces the path on steps%meshes; where it is shown and its folds and extrema
  !> are not as exact as asked for, again on meshes of more digits, if these can help. The better
  !> path stays, and what is found along it can be judged. h0: law's lengths; store: of meshes.
  subroutine trace_exactly(request, steps, h0_high, h0_low, listener, fine, places, store)
    class(request_t), intent(in) :: request
    class(path_stepper_t), intent(inout), target :: steps
    real(wp), intent(in) :: h0_high, h0_low
    class(listener_t), intent(inout) :: listener
    type(finer_t), intent(out) :: fine
    type(places_t), intent(out) :: places
    type(mesh_store_t), intent(inout), target, optional :: store
    type(tracing_t) :: before
    type(known_path_t) :: nothing
    type(finer_t) :: blank
    real(wp), allocatable :: farthest
    real(wp) :: worst, began
    integer :: round, i, kept

    if (request%reads_path()) farthest = farthest_wanted(request, steps%problem)
    associate (accuracy => request%numerics%accuracy, cost => steps%cost)
      do round = 1, most_rounds
        call steps%know_path(h0_high, h0_low, allocated(request%path), listener, farthest, &
          accuracy*10.0_wp**(-further_digits*(round - 1)))
        began = seconds()
        fine = blank
        places = places_t()
        call fine%lay_out(steps, h0_high, h0_low, store)
        worst = 0
        if (allocated(request%path)) then
          do i = 1, steps%known%path%held
            associate (point => steps%known%path%point(i))
              if (point%fold .or. point%load_extremum) &
                call places%keep(point_of_path(i), kept)
            end associate
          end do
          call judge_places(fine, steps, places, .true.)
          if (allocated(places%place)) worst = maxval([0.0_wp, (places%place(i)%relative_error(), &
            i=1, size(places%place))])
        end if
        cost%estimate_seconds = cost%estimate_seconds + seconds() - began
        if (round > 1 .and. (is_lost(steps%known) .or. .not. worst < before%worst)) then
          call go_back(before, steps, fine, places)
          return
        end if
        if (.not. worst > accuracy .or. round == most_rounds) return
        if (round > 1 .and. worst > helped*before%worst) return
        if (steps%known%left_out > too_much*accuracy .or. .not. digits_help(steps)) return
        before%meshes = steps%meshes
        before%known = steps%known
        before%fine = fine
        before%places = places
        before%worst = worst
        steps%meshes = new_mesh_family(steps%problem, h0_high, h0_low, &
          before%meshes%digits + further_digits, store=store)
        cost%kernel_entries = cost%kernel_entries + sum(steps%meshes%grid%kernel_entries())
        steps%known = nothing
      end do
    end associate
  end subroutine trace_exactly

  !> Whether a path may become more exact by more digits. One that was lost need not come as far
  !> again; about a kink of the law errors go up and down with the nodes; and rounding has its
  !> digits, too.
  pure logical function digits_help(steps)
    class(path_stepper_t), intent(in) :: steps

    digits_help = .not. (is_lost(steps%known) .or. steps%problem%law%has_kink .or. &
      steps%meshes%digits + further_digits > most_digits)
  end function digits_help

  !> Whether a path does not come to its end; of bodies that nothing keeps apart that is their fall.
  pure logical function is_lost(known)
    type(known_path_t), intent(in) :: known

    is_lost = known%ending%early() .and. .not. known%fallen
  end function is_lost

  !> Makes the path traced before that of the steps again.
  subroutine go_back(before, steps, fine, places)
    type(tracing_t), intent(in) :: before
    class(path_stepper_t), intent(inout) :: steps
    type(finer_t), intent(inout) :: fine
    type(places_t), intent(inout) :: places

    steps%meshes = before%meshes
    steps%known = before%known
    fine = before%fine
    places = before%places
  end subroutine go_back

end module exact_path
