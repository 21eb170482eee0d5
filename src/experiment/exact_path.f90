!> The path with the accuracy of the deck. Where two extrema have just appeared, a small error of
!> the mesh moves them far, and no rule for meshes can predict this. Therefore the extrema and the
!> end are judged on finer meshes; if one is not accurate enough, the path is traced on the finer
!> mesh.
module exact_path
  use kinds, only: wp
  use clock, only: seconds
  use listener, only: listener_t
  use mesh_digits, only: most_digits
  use edge_locked, only: new_mesh_family
  use ending, only: path_lost
  use mesh_store, only: mesh_store_t
  use traced_path, only: traced_path_t
  use mending, only: too_much
  use path_stepper, only: path_stepper_t
  use path_end, only: demand_t
  use tracing, only: longest
  use experiment_request, only: request_t
  use numerics_choice, only: choice_t
  use path_demand, only: demand_of
  use path, only: find_finish
  use places, only: places_t
  use reported_place, only: place_t, point_of_path
  use finer_solver, only: finer_t, more_digits
  use place_errors, only: judge_places
  implicit none
  private
  public :: trace_exactly

  !> Largest number of further attempts to trace a path that was lost or has folds that a finer mesh
  !> does not have: without meshes that are locked to a front, which may recede, or on finer meshes,
  !> since on coarse ones strong adhesion makes folds that bodies do not have.
  integer, parameter :: most_attempts = 2
  !> Largest number of rounds of judging.
  integer, parameter :: most_rounds = 4
  !> A finer mesh reduces errors about ten times, and beside a step at least by half. If errors
  !> remain above this fraction, they have another cause, such as rounding, and a further mesh is
  !> useless.
  real(wp), parameter :: helped = 0.5_wp

contains

  !> Traces the path on steps%meshes, or on others if it is lost or has folds that finer meshes do
  !> not have. fine: judges places of the path; places: the judged places; store: of meshes.
  subroutine trace_exactly(request, steps, chosen, listener, fine, places, store)
    class(request_t), intent(in) :: request
    class(path_stepper_t), intent(inout), target :: steps
    type(choice_t), intent(in) :: chosen
    class(listener_t), intent(inout) :: listener
    type(finer_t), intent(out) :: fine
    type(places_t), intent(out) :: places
    type(mesh_store_t), intent(inout), target, optional :: store
    type(demand_t), allocatable :: demand
    real(wp) :: more, accuracy
    integer :: attempt
    logical :: lost, last

    if (request%reads_path()) allocate (demand, source=demand_of(request, steps%problem))
    accuracy = request%numerics%accuracy
    do attempt = 0, most_attempts
      associate (meshes => steps%meshes, known => steps%known)
        if (attempt > 0) then
          more = merge(0.0_wp, more_digits, lost .and. meshes%fronts)
          accuracy = accuracy*10**(-more)
          meshes = new_mesh_family(steps%problem, chosen%high, chosen%low, meshes%digits + more, &
            store=store, fronts=meshes%fronts .and. .not. lost)
          steps%cost%kernel_entries = steps%cost%kernel_entries + sum(meshes%grid%kernel_entries())
        end if
        call steps%know_path(chosen, allocated(request%path), accuracy, listener, demand)
        lost = known%ending%cause == path_lost
        ! A path of too many states would have as many again.
        last = attempt == most_attempts .or. known%path%held >= longest .or. &
          meshes%digits + more_digits > most_digits
      end associate
      if (lost .and. .not. last) cycle
      call fine%lay_out(steps, chosen, store)
      call make_exact(request, steps, fine, places)
      if (last .or. .not. allocated(places%place)) exit
      if (all(places%place%known)) exit
    end do
  end subroutine trace_exactly

  !> Judges the extrema of a path. If the path is an output, and its extrema or end are not as
  !> accurate as requested, traces it again on finer meshes where these can help.
  subroutine make_exact(request, steps, fine, places)
    class(request_t), intent(in) :: request
    class(path_stepper_t), intent(inout), target :: steps
    type(finer_t), intent(inout) :: fine
    type(places_t), intent(out) :: places
    real(wp), allocatable :: errors(:)
    logical, allocatable :: poor(:), renewed(:)
    type(place_t) :: finish
    real(wp) :: before, began
    integer :: round, mesh, i, kept
    logical :: found

    associate (accuracy => request%numerics%accuracy, cost => steps%cost)
      renewed = spread(.false., 1, size(steps%meshes%grid))
      before = huge(before)
      do round = 1, most_rounds
        began = seconds()
        call keep_extrema(steps%known%path, renewed, places)
        found = .false.
        if (allocated(request%path)) call find_finish(steps, &
          steps%problem%law%gap_of(request%path%h0_end), finish, found)
        if (found) call places%keep(finish, kept)
        call judge_places(fine, steps, places, .true.)
        cost%estimate_seconds = cost%estimate_seconds + seconds() - began
        if (.not. allocated(places%place)) return
        call doubt_close_turns(places%place)
        errors = [(places%place(i)%relative_error(.false.), i=1, size(places%place))]
        if (.not. maxval(errors) > accuracy .or. maxval(errors) > helped*before) return
        if (round == most_rounds) return
        ! Finer meshes do not help if the path was lost, since the finer path may end earlier; or
        ! if nodes miss too much of the load, since this needs other panels. A collapse of bodies
        ! without repulsion is not an early end.
        if (steps%known%ending%early() .and. .not. steps%known%fallen .or. steps%known%left_out > &
          too_much*accuracy) return
        before = maxval(errors)
        poor = [(any(places%place%mesh == mesh .and. errors > accuracy), mesh=1, size(renewed))]
        call steps%know_path_on(fine%meshes, poor, renewed)
        do mesh = 1, size(renewed)
          if (renewed(mesh)) call fine%refine(mesh, steps%meshes)
        end do
      end do
    end associate
  end subroutine make_exact

  !> Two successive turns of a quantity are not known if their values differ by less than the error
  !> of this difference: coarse meshes have pairs of turns that bodies do not have.
  !> place: in the order of the path.
  pure subroutine doubt_close_turns(place)
    type(place_t), intent(inout) :: place(:)
    real(wp) :: change, finer_change
    integer :: i, j

    do i = 1, size(place)
      if (.not. place(i)%turns()) cycle
      do j = i + 1, size(place)
        if (all(abs(place(j)%turn_of - place(i)%turn_of) <= 0)) exit
      end do
      if (j > size(place)) cycle
      associate (a => place(i), b => place(j))
        change = dot_product(a%turn_of, b%at(:2) - a%at(:2))
        finer_change = dot_product(a%turn_of, b%fine(:2) - a%fine(:2))
        if (abs(change) <= a%margin*abs(finer_change - change)) place([i, j])%known = .false.
      end associate
    end do
  end subroutine doubt_close_turns

  !> Makes the extrema of a path the places of a table. Known extrema keep their errors, except
  !> those on renewed meshes.
  subroutine keep_extrema(path, renewed, places)
    type(traced_path_t), intent(in) :: path
    logical, intent(in) :: renewed(:)
    type(places_t), intent(inout) :: places
    type(places_t) :: extrema
    integer :: i, j, kept

    do i = 1, path%held
      associate (point => path%point(i))
        if (.not. (point%fold .or. point%load_extremum)) cycle
        call extrema%keep(point_of_path(i), kept)
        if (renewed(point%mesh) .or. .not. allocated(places%place)) cycle
        do j = 1, size(places%place)
          associate (known => places%place(j))
            if (known%mesh /= point%mesh .or. abs(known%s - point%coordinate) > 0) cycle
            extrema%place(kept) = known
            extrema%place(kept)%point = i
          end associate
        end do
      end associate
    end do
    places = extrema
  end subroutine keep_extrema

end module exact_path
