!> The equilibrium path as an experiment needs it: traced as far as the experiment goes, with its
!> stable pieces, on which a quasi-static experiment at controlled h0 moves, and where the bodies
!> land when it leaves one over a fold.
module known_path
  use kinds, only: wp
  use listener, only: listener_t
  use contact_state, only: state_t, state_from
  use equilibrium, only: equations_t
  use solver, only: solver_t
  use solver_options, only: solver_options_t
  use edge_locked, only: approach
  use contact_scales, only: largest_radius, lost_in_rounding
  use locked_meshes, only: h0_control
  use continuation, only: continuation_t
  use ending, only: ending_t, beyond_rounding, no_equilibrium, path_lost
  use traced_path, only: traced_path_t, extend, pass_on, collapsed
  use mending, only: mender_t, new_mender, left_on_path
  use reported, only: error_t, measure_t
  use path_span, only: path_span_t, new_path_span
  implicit none
  private
  public :: known_path_t, landing_t, trace, interval_at, lowest_point, landing_over

  !> A piece from point `first` to point `last` of the path, h0 falling from `high` to `low`. Its
  !> ends are folds, or the ends of the path.
  type :: stable_piece_t
    integer :: first = 0, last = 0
    real(wp) :: high = 0, low = 0
    logical :: begins_in_fold = .false., ends_in_fold = .false.
  end type stable_piece_t

  !> Where a jump leads: the fold that it starts from (a point of the path; 0: there is none), the
  !> piece that it ends on (0: there is none) and the state there, at the h0 of the fold.
  type :: landing_t
    integer :: fold = 0, piece = 0
    integer :: mesh = 1
    real(wp) :: coordinate = 0
    type(state_t) :: state
    logical :: converged = .false.
    !> As for a point of the path.
    type(measure_t), allocatable :: fine
    type(error_t), allocatable :: error
  end type landing_t

  type :: known_path_t
    type(traced_path_t) :: path
    !> From afar inward; and the landings from each over the fold at its inner and outer end.
    type(stable_piece_t), allocatable :: piece(:)
    type(landing_t), allocatable :: inward(:), outward(:)
    !> How the path ends; and whether in the fall of bodies that nothing keeps apart.
    type(ending_t) :: ending
    logical :: fallen = .false.
    !> The largest part of the load that nodes leave out of its pressures, but of a fall.
    real(wp) :: left_out = 0
  end type known_path_t

  !> Most points of a path before it is given up as going nowhere.
  integer, parameter :: longest = 5000
  !> Contact radii over the largest expected that no path has.
  real(wp), parameter :: too_large = 5
  !> Steps after which the listener hears of them: to write a message takes a tenth of a step.
  integer, parameter :: steps_a_message = 8
  !> Residual, in the law's lengths, that the points of the path have at most, whatever the deck
  !> allows the experiment's states.
  real(wp), parameter :: path_tolerance = 1.0e-8_wp

contains

  !> Traces the path from a state far from contact, on the mesh for the approach, until it is stable
  !> at h0_low; into_contact: until it is also on the mesh for contact. farthest: where given, points
  !> are enough for a smooth curve, and from there to the start bodies are undeformed. accuracy: where
  !> given, meshes that leave out too much of the load for it are mended.
  subroutine trace(solver, start, h0_low, into_contact, listener, known, farthest, accuracy)
    class(solver_t), intent(inout) :: solver
    type(state_t), intent(in) :: start
    real(wp), intent(in) :: h0_low
    logical, intent(in) :: into_contact
    class(listener_t), intent(inout) :: listener
    type(known_path_t), intent(inout) :: known
    real(wp), intent(in), optional :: farthest, accuracy
    type(continuation_t) :: walker
    type(mender_t) :: mender
    type(solver_options_t) :: own
    character(len=40) :: so_far
    logical :: lost, blind, finished, mended
    type(ending_t) :: going_on
    logical :: guarded
    integer :: steps, k

    ! Where rounding hides the contact the path is of use up to its first fold.
    blind = lost_in_rounding(solver%problem, &
      largest_radius(solver%problem, h0_low, solver%meshes%level))
    own = solver%options
    solver%options%tolerance = min(own%tolerance, path_tolerance)
    finished = .false.
    steps = 0
    if (present(farthest)) call walker%follow_closely()
    call walker%begin_with(solver, start, approach, lost)
    if (lost) known%ending%cause = path_lost
    guarded = present(accuracy) .and. .not. solver%problem%law%of_paper
    if (guarded) mender = new_mender(accuracy, solver%meshes)
    do while (.not. (known%ending%early() .or. finished))
      call extend(known%path, walker, solver, lost)
      steps = steps + 1
      if (mod(steps, steps_a_message) == 0) then
        write (so_far, '(a, i0, a)') 'tracing the path: ', known%path%held, ' states'
        call listener%hear(trim(so_far))
      end if
      mended = .false.
      if (guarded .and. .not. lost) then
        if (walker%has_come_to_next(solver%equations_t)) then
          call mender%mend(solver%equations_t, known%path, walker%mesh, .false., mended)
          if (.not. mended) call mender%note(known%path, walker)
        end if
      end if
      if (.not. (lost .or. mended)) call pass_on(known%path, walker, solver, lost)
      known%fallen = collapsed(solver%problem, known%path)
      lost = lost .or. known%path%held >= longest .or. astray(solver%equations_t, known%path)
      if (lost) then
        known%ending%cause = path_lost
      else if (known%fallen) then
        known%ending%cause = no_equilibrium
      else if (blind .and. any(known%path%point(:known%path%held)%fold)) then
        known%ending%cause = beyond_rounding
      end if
      associate (last => known%path%point(known%path%held))
        finished = last%modes == 0 .and. last%state%h0 <= h0_low .and. &
          last%tangent%h0 < 0 .and. &
          (solver%meshes%in_contact(last%mesh) .or. .not. into_contact)
      end associate
      if (guarded .and. .not. mended .and. (finished .or. known%ending%early())) &
        call mender%mend(solver%equations_t, known%path, walker%mesh, lost, mended)
      if (.not. mended) cycle
      known%ending = going_on
      finished = .false.
      call go_back(mender, solver, start, known%path, walker, lost)
      if (lost) known%ending%cause = path_lost
    end do
    solver%options = own
    if (guarded .and. .not. known%fallen) &
      known%left_out = left_on_path(solver%equations_t, known%path)
    if (present(farthest)) call known%path%begin_undeformed(solver%problem, farthest)
    known%piece = pieces_of(known%path)
    ! What is behind the last stable piece was traced only to find its end.
    known%path%last = known%path%held
    if (size(known%piece) > 0) known%path%last = known%piece(size(known%piece))%last
    allocate (known%inward(size(known%piece)), known%outward(size(known%piece)))
    do k = 1, size(known%piece)
      call land(solver, known, k, .true., known%inward(k))
      call land(solver, known, k, .false., known%outward(k))
    end do
  end subroutine trace

  !> Goes back to where the path came to a mesh that was made anew since, or to its beginning afar.
  subroutine go_back(mender, solver, start, path, walker, lost)
    type(mender_t), intent(in) :: mender
    class(solver_t), intent(inout) :: solver
    type(state_t), intent(in) :: start
    type(traced_path_t), intent(inout) :: path
    type(continuation_t), intent(inout) :: walker
    logical, intent(out) :: lost
    type(state_t) :: state
    logical :: done

    path = mender%path
    if (path%held > 0) then
      walker = mender%walker
      call pass_on(path, walker, solver, lost)
      return
    end if
    call walker%forget()
    call solver%frozen%forget()
    associate (problem => solver%problem, grid => solver%meshes%grid(approach))
      state = state_from(grid%nodes)
      state%h0 = start%h0
      state%axis_gap = start%axis_gap
      state%scale = start%scale
      state%gap = start%h0 + problem%shape%height(start%scale*grid%x)
      ! At its h0, where an experiment may begin.
      call solver%correct(h0_control(problem%shape, solver%meshes, approach, start%h0), state, done)
    end associate
    lost = .not. done
    if (done) call walker%begin_with(solver, state, approach, lost)
  end subroutine go_back

  !> Whether the contact is much larger than any that is expected: on a mesh that is too coarse
  !> folds were lost, and no state is taken for stable any more.
  pure logical function astray(equations, path)
    type(equations_t), intent(in) :: equations
    type(traced_path_t), intent(in) :: path

    associate (last => path%point(path%held), meshes => equations%meshes)
      astray = meshes%in_contact(last%mesh) .and. &
        last%state%scale > too_large*meshes%passage(size(meshes%passage))
    end associate
  end function astray

  !> The stable pieces of a path, from afar inward.
  pure function pieces_of(path) result(pieces)
    type(traced_path_t), intent(in) :: path
    type(stable_piece_t), allocatable :: pieces(:)
    type(stable_piece_t) :: piece
    integer :: i

    allocate (pieces(0))
    i = path%undeformed + 1
    do while (i < path%held)
      if (path%point(i)%modes > 0) then
        i = i + 1
        cycle
      end if
      piece%first = i
      do while (i < path%held)
        if (path%point(i)%modes > 0) exit
        i = i + 1
      end do
      piece%last = i
      piece%high = path%point(piece%first)%state%h0
      piece%low = path%point(piece%last)%state%h0
      piece%begins_in_fold = path%point(piece%first)%fold
      piece%ends_in_fold = path%point(piece%last)%fold
      pieces = [pieces, piece]
    end do
  end function pieces_of

  !> The piece nearest to `from` that a jump at h0 leads to: inward, the later ones, or outward; 0
  !> if there is none.
  pure integer function piece_containing(pieces, from, inward, h0) result(found)
    type(stable_piece_t), intent(in) :: pieces(:)
    integer, intent(in) :: from
    logical, intent(in) :: inward
    real(wp), intent(in) :: h0
    integer :: k, sense

    sense = merge(1, -1, inward)
    found = 0
    k = from + sense
    do while (k >= 1 .and. k <= size(pieces))
      if (h0 >= pieces(k)%low .and. h0 <= pieces(k)%high) then
        found = k
        return
      end if
      k = k + sense
    end do
  end function piece_containing

  !> The point of a piece after which h0 lies. (Where the path changes its mesh, h0 differs by the
  !> meshes' errors, and a value may lie between.)
  pure integer function interval_at(known, piece, h0) result(i)
    type(known_path_t), intent(in) :: known
    integer, intent(in) :: piece
    real(wp), intent(in) :: h0

    do i = known%piece(piece)%first, known%piece(piece)%last - 2
      if (known%path%point(i + 1)%state%h0 <= h0) return
    end do
  end function interval_at

  !> Where the bodies land that leave a piece over the fold at its inner or outer end.
  subroutine land(solver, known, from, inward, landing)
    class(solver_t), intent(inout) :: solver
    type(known_path_t), intent(in) :: known
    integer, intent(in) :: from
    logical, intent(in) :: inward
    type(landing_t), intent(out) :: landing
    type(path_span_t) :: span
    real(wp) :: h0

    associate (left => known%piece(from))
      if (.not. merge(left%ends_in_fold, left%begins_in_fold, inward)) return
      landing%fold = merge(left%last, left%first, inward)
    end associate
    h0 = known%path%point(landing%fold)%state%h0
    landing%piece = piece_containing(known%piece, from, inward, h0)
    if (landing%piece == 0) return
    span = new_path_span(known%path, interval_at(known, landing%piece, h0))
    landing%mesh = span%mesh
    call span%solve_at_h0(solver, h0, landing%coordinate, landing%state, landing%converged)
  end subroutine land

  !> The landing over a fold: inward(k) or outward(k), with inside telling which; k = 0 where the
  !> fold is no end of a stable piece.
  pure subroutine landing_over(known, fold, k, inside)
    type(known_path_t), intent(in) :: known
    integer, intent(in) :: fold
    integer, intent(out) :: k
    logical, intent(out) :: inside

    k = findloc(known%inward%fold, fold, 1)
    inside = k > 0
    if (.not. inside) k = findloc(known%outward%fold, fold, 1)
  end subroutine landing_over

  !> The point of largest tension among the extrema of the load and the folds of a piece, h0 being
  !> between two values; 0 if there is none.
  pure integer function lowest_point(known, piece, from, to) result(lowest)
    type(known_path_t), intent(in) :: known
    integer, intent(in) :: piece
    real(wp), intent(in) :: from, to
    integer :: i

    lowest = 0
    do i = known%piece(piece)%first, known%piece(piece)%last
      associate (point => known%path%point(i))
        if (.not. (point%load_extremum .or. point%fold)) cycle
        if ((point%state%h0 - from)*(point%state%h0 - to) > 0) cycle
        if (lowest > 0) then
          if (point%state%load >= known%path%point(lowest)%state%load) cycle
        end if
        lowest = i
      end associate
    end do
  end function lowest_point

end module known_path
