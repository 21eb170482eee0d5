!> The equilibrium path as an experiment needs it: traced as far as the experiment goes, with its
!> stable pieces, on which a quasi-static experiment at controlled h0 moves, and where the bodies
!> land when it leaves one over a fold.
module known_path
  use kinds, only: wp
  use listener, only: listener_t
  use contact_state, only: state_t, state_from
  use equilibrium, only: equations_t
  use solver_options, only: solver_options_t
  use edge_locked, only: approach
  use contact_scales, only: largest_radius, lost_in_rounding
  use locked_meshes, only: h0_control
  use continuation, only: continuation_t
  use ending, only: ending_t, beyond_rounding, no_equilibrium, path_lost
  use traced_path, only: traced_path_t, extend, pass_on, collapsed
  use mending, only: mender_t, new_mender, left_on_path
  use anderson, only: solve_anderson
  use frozen_jacobian, only: frozen_jacobian_t
  use state_search, only: neighbours_t, neighbours_of, solve_at_h0
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
  !> at h0_low; into_contact: until it is also on the mesh for contact; closely: with points enough
  !> for a smooth curve (`path_curve`). accuracy: where given, meshes that leave out too much of the
  !> load for it are mended.
  subroutine trace(equations, options, start, h0_low, into_contact, closely, listener, known, &
    accuracy)
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(state_t), intent(in) :: start
    real(wp), intent(in) :: h0_low
    logical, intent(in) :: into_contact, closely
    class(listener_t), intent(inout) :: listener
    type(known_path_t), intent(inout) :: known
    real(wp), intent(in), optional :: accuracy
    type(continuation_t) :: walker
    type(mender_t) :: mender
    type(solver_options_t) :: for_path
    character(len=40) :: so_far
    logical :: lost, blind, finished, mended
    type(ending_t) :: going_on
    logical :: guarded
    integer :: steps, k

    ! Where rounding hides the contact the path is of use up to its first fold.
    blind = lost_in_rounding(equations%problem, &
      largest_radius(equations%problem, h0_low, equations%meshes%level))
    for_path = options
    for_path%tolerance = min(options%tolerance, path_tolerance)
    finished = .false.
    steps = 0
    if (closely) call walker%follow_closely()
    call walker%begin_with(equations, for_path, start, approach, lost)
    if (lost) known%ending%cause = path_lost
    guarded = present(accuracy) .and. .not. equations%problem%law%of_paper
    if (guarded) mender = new_mender(accuracy, equations%meshes)
    do while (.not. (known%ending%early() .or. finished))
      call extend(known%path, walker, equations, for_path, lost)
      steps = steps + 1
      if (mod(steps, steps_a_message) == 0) then
        write (so_far, '(a, i0, a)') 'tracing the path: ', known%path%held, ' states'
        call listener%hear(trim(so_far))
      end if
      mended = .false.
      if (guarded .and. .not. lost) then
        if (walker%has_come_to_next(equations)) then
          call mender%mend(equations, known%path, walker%mesh, .false., mended)
          if (.not. mended) call mender%note(known%path, walker)
        end if
      end if
      if (.not. (lost .or. mended)) call pass_on(known%path, walker, equations, for_path, lost)
      known%fallen = collapsed(equations%problem, known%path)
      lost = lost .or. known%path%held >= longest .or. astray(equations, known%path)
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
          (equations%meshes%in_contact(last%mesh) .or. .not. into_contact)
      end associate
      if (guarded .and. .not. mended .and. (finished .or. known%ending%early())) &
        call mender%mend(equations, known%path, walker%mesh, lost, mended)
      if (.not. mended) cycle
      known%ending = going_on
      finished = .false.
      call go_back(mender, equations, for_path, start, known%path, walker, lost)
      if (lost) known%ending%cause = path_lost
    end do
    if (guarded .and. .not. known%fallen) known%left_out = left_on_path(equations, known%path)
    known%piece = pieces_of(known%path)
    allocate (known%inward(size(known%piece)), known%outward(size(known%piece)))
    do k = 1, size(known%piece)
      call land(equations, options, known, k, .true., known%inward(k))
      call land(equations, options, known, k, .false., known%outward(k))
    end do
  end subroutine trace

  !> Goes back to where the path came to a mesh that was made anew since, or to its beginning afar.
  subroutine go_back(mender, equations, options, start, path, walker, lost)
    type(mender_t), intent(in) :: mender
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(state_t), intent(in) :: start
    type(traced_path_t), intent(inout) :: path
    type(continuation_t), intent(inout) :: walker
    logical, intent(out) :: lost
    type(frozen_jacobian_t) :: frozen
    type(state_t) :: state
    logical :: done

    path = mender%path
    if (path%held > 0) then
      walker = mender%walker
      call pass_on(path, walker, equations, options, lost)
      return
    end if
    call walker%forget()
    associate (problem => equations%problem, grid => equations%meshes%grid(approach))
      state = state_from(grid%nodes)
      state%h0 = start%h0
      state%axis_gap = start%axis_gap
      state%scale = start%scale
      state%gap = start%h0 + problem%shape%height(start%scale*grid%x)
      ! At its h0, where an experiment may begin.
      call solve_anderson(equations, options, frozen, h0_control(problem%shape, equations%meshes, &
        approach, start%h0), state, done)
    end associate
    lost = .not. done
    if (done) call walker%begin_with(equations, options, state, approach, lost)
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
    i = 1
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
  subroutine land(equations, options, known, from, inward, landing)
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(known_path_t), intent(in) :: known
    integer, intent(in) :: from
    logical, intent(in) :: inward
    type(landing_t), intent(out) :: landing
    type(neighbours_t) :: near
    real(wp) :: h0

    associate (left => known%piece(from))
      if (.not. merge(left%ends_in_fold, left%begins_in_fold, inward)) return
      landing%fold = merge(left%last, left%first, inward)
    end associate
    h0 = known%path%point(landing%fold)%state%h0
    landing%piece = piece_containing(known%piece, from, inward, h0)
    if (landing%piece == 0) return
    near = neighbours_of(known%path, interval_at(known, landing%piece, h0))
    landing%mesh = near%mesh
    call solve_at_h0(equations, options, near, h0, landing%coordinate, landing%state, &
      landing%converged)
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
