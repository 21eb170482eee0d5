!> Stopping criteria of the continuation: the requested range is reached, the contact radius exceeds
!> its limit, or the bodies collapse.
!>
!> A path that is requested for the contact at a given h0 ends at this h0 in the innermost stable
!> state, within all barriers. Soft bodies may already be in contact outside a barrier: they repel
!> each other at gaps beyond the well of contact, and deform instead of coming nearer. The path ends
!> in such an outer contact if it is stable at this h0. Only the law and the path decide this, not
!> the meshes of the path.
module path_end
  use kinds, only: wp
  use interpolation, only: hermite_t
  use dimensionless_problem, only: problem_t
  use force_law, only: force_law_t, of_slope
  use equilibrium, only: equations_t
  use solver, only: solver_t
  use path_coordinate, only: coordinate_of
  use path_span, only: path_span_t, new_path_span
  use path_point, only: path_point_t
  use traced_path, only: traced_path_t
  implicit none
  private
  public :: demand_t, touches, outer_end, astray, collapsed

  !> What a path must contain. It begins with undeformed bodies at h0 = `farthest`. At its end Q =
  !> weights(1, k) h0 + weights(2, k) load is at most until(k) for each k. If `closes(k)`, the
  !> bodies are also in contact within all barriers at the end, and Q is below all its earlier
  !> values, so that every jump ends on the path. looser: factor by which the errors of the curve
  !> through the points may be larger than with the closest points (`continuation`).
  type :: demand_t
    real(wp) :: farthest = 0, looser = 1
    real(wp), allocatable :: weights(:, :), until(:)
    logical, allocatable :: closes(:)
  contains
    procedure :: is_met
  end type demand_t

  !> Largest ratio of the change of the axis gap to that of h0 in an outer contact: at least nine
  !> tenths of the approach go into the deformation of the bodies. (Whether meshes are locked to the
  !> edge of an outer contact is another question, which the cost decides: `mesh_insertion`.)
  real(wp), parameter :: resting = 0.1_wp
  !> Number of parts of an interval of the path; Q is evaluated at the ends of each part.
  integer, parameter :: looks = 4
  !> Contact radius, over the largest expected, that no path reaches.
  real(wp), parameter :: too_large = 5

contains

  !> Whether a path goes far enough for a demand.
  pure logical function is_met(self, equations, path)
    class(demand_t), intent(in) :: self
    type(equations_t), intent(in) :: equations
    type(traced_path_t), intent(in) :: path
    integer :: k

    associate (last => path%point(path%held))
      is_met = all([(last%state%of(self%weights(:, k)) <= self%until(k), k=1, size(self%until))])
      if (is_met .and. any(self%closes)) is_met = touches(equations, last)
      do k = 1, size(self%closes)
        if (is_met .and. self%closes(k)) is_met = is_lowest(self%weights(:, k))
      end do
    end associate

  contains

    !> Whether weights(1) h0 + weights(2) load is least at the last point of the path.
    pure logical function is_lowest(weights)
      real(wp), intent(in) :: weights(2)
      type(hermite_t) :: curve
      real(wp) :: ends(2), at_end
      integer :: i, j

      at_end = path%point(path%held)%state%of(weights)
      is_lowest = .true.
      do i = path%undeformed + 1, path%held - 1
        if (.not. path%point(i)%leads_on) cycle
        call path%curve_between(i, weights, curve, ends)
        do j = 0, looks - 1
          is_lowest = is_lowest .and. curve%value(ends(1) + (ends(2) - ends(1))*j/looks) > at_end
        end do
        if (.not. is_lowest) return
      end do
    end function is_lowest

  end function is_met

  !> The interval in which the path reaches h0_end in a stable outer contact; 0: there is none.
  integer function outer_end(solver, path, h0_end) result(i)
    class(solver_t), intent(inout) :: solver
    type(traced_path_t), intent(in) :: path
    real(wp), intent(in) :: h0_end
    type(path_span_t) :: span
    type(path_point_t) :: at_end, point
    logical :: done

    if (.not. (solver%problem%law%edge_gap > 0 .and. path%held > 1)) then
      i = 0
      return
    end if
    do i = path%undeformed + 1, path%held - 1
      associate (from => path%point(i), to => path%point(i + 1))
        if (from%modes > 0 .or. .not. from%leads_on) cycle
        if (.not. (from%state%h0 >= h0_end .and. to%state%h0 < h0_end)) cycle
        ! Most laws have no barrier, and need no solve.
        if (.not. any(solver%problem%law%slope([from%state%axis_gap, to%state%axis_gap]) < 0)) &
          cycle
        span = new_path_span(path, i)
        call span%solve_at_h0(solver, h0_end, at_end)
        if (.not. at_end%converged) cycle
        call span%solve_at(solver, coordinate_of(solver%problem, solver%meshes, span%mesh, &
          at_end%state), point, done)
        if (.not. done) cycle
        if (rests_outside(solver%problem%law, point)) return
      end associate
    end do
    i = 0
  end function outer_end

  !> Whether a point of the path is an outer contact.
  pure logical function rests_outside(law, point)
    class(force_law_t), intent(in) :: law
    type(path_point_t), intent(in) :: point

    rests_outside = point%state%axis_gap > law%edge_gap .and. &
      abs(point%tangent%axis_gap) < resting*abs(point%tangent%h0)
    if (rests_outside) rests_outside = law%at(of_slope, point%state%axis_gap) < 0
  end function rests_outside

  !> Whether the bodies are in contact, within all barriers, at a point of the path. Under a law
  !> with repulsion, bodies in contact repel each other somewhere; bodies that are only near do not.
  pure logical function touches(equations, point)
    type(equations_t), intent(in) :: equations
    type(path_point_t), intent(in) :: point

    associate (meshes => equations%meshes, law => equations%problem%law, state => point%state)
      if (law%rest_gap > 0) then
        touches = min(state%axis_gap, minval(state%gap)) < law%rest_gap
      else
        touches = meshes%in_contact(point%mesh) .or. state%axis_gap < law%edge_gap
      end if
    end associate
  end function touches

  !> Whether the contact is much larger than expected. This ends a path that has missed folds on a
  !> coarse mesh, since no later state would count as stable.
  pure logical function astray(equations, path)
    type(equations_t), intent(in) :: equations
    type(traced_path_t), intent(in) :: path

    associate (last => path%point(path%held), meshes => equations%meshes)
      astray = meshes%in_contact(last%mesh) .and. &
        last%state%scale > too_large*meshes%passage(size(meshes%passage))
    end associate
  end function astray

  !> Whether the newest state of a path belongs to a collapse: its gap on the axis is below the
  !> law's limit, or the path was lost on an unstable branch within the attraction.
  pure logical function collapsed(problem, path, lost)
    type(problem_t), intent(in) :: problem
    type(traced_path_t), intent(in) :: path
    logical, intent(in) :: lost
    real(wp) :: apart
    integer :: first

    apart = 1
    first = findloc(path%point(:path%held)%fold, .true., 1)
    if (first > 0) apart = path%point(first)%state%axis_gap
    associate (last => path%point(path%held), law => problem%law)
      collapsed = last%state%axis_gap < law%fallen_below(apart) .or. &
        lost .and. last%modes > 0 .and. last%state%axis_gap < law%falls_below
    end associate
  end function collapsed

end module path_end
