!> Where a path ends: what is read from it decides how far it goes; it is given up where the contact
!> is larger than any, and has no further states where bodies collapse.
module path_end
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use contact_state, only: state_t
  use equilibrium, only: equations_t
  use traced_path, only: traced_path_t, path_point_t
  implicit none
  private
  public :: demand_t, touches, astray, collapsed

  !> What is read from a path: undeformed bodies fill the range from h0 = `farthest` to its start,
  !> and at its end by_h0*h0 - by_load*load is at most `until`, for each element.
  type :: demand_t
    real(wp) :: farthest = 0
    real(wp), allocatable :: by_h0(:), by_load(:), until(:)
  contains
    procedure :: is_met
  end type demand_t

  !> Contact radius, over the largest expected, that no path reaches.
  real(wp), parameter :: too_large = 5

contains

  !> Whether a path that ends at a state goes as far as is read from it.
  pure logical function is_met(self, state)
    class(demand_t), intent(in) :: self
    type(state_t), intent(in) :: state

    is_met = all(self%by_h0*state%h0 - self%by_load*state%load <= self%until)
  end function is_met

  !> Whether the bodies are in contact, also in an outer minimum, at a point of the path. Under a
  !> law with repulsion, bodies in contact repel each other somewhere. Bodies that are only near, as
  !> just before a barrier gives way, do not.
  pure logical function touches(equations, point)
    type(equations_t), intent(in) :: equations
    type(path_point_t), intent(in) :: point

    associate (meshes => equations%meshes, law => equations%problem%law, state => point%state)
      touches = meshes%is_in_outer_contact(point%mesh)
      if (touches) return
      if (law%rest_gap > 0) then
        touches = min(state%axis_gap, minval(state%gap)) < law%rest_gap
      else
        touches = meshes%in_contact(point%mesh) .or. state%axis_gap < law%edge_gap
      end if
    end associate
  end function touches

  !> Whether the contact is much larger than expected: on a mesh that is too coarse folds can be
  !> lost, and then no later state counts as stable.
  pure logical function astray(equations, path)
    type(equations_t), intent(in) :: equations
    type(traced_path_t), intent(in) :: path

    associate (last => path%point(path%held), meshes => equations%meshes)
      astray = meshes%in_contact(last%mesh) .and. &
        last%state%scale > too_large*meshes%passage(size(meshes%passage))
    end associate
  end function astray

  !> Whether the newest state of a path belongs to a collapse. A path that is lost on an unstable
  !> branch within the attraction has no other end.
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
