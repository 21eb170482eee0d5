!> Where between two points of the path its states must be known for straight lines through them to
!> show the curve: load and contact radius against h0, beside folds and far apart too.
module straight_lines
  use kinds, only: wp
  use dimensionless_problem, only: contact_level_of
  use contact_state, only: state_t, radius_of_gap
  use equilibrium, only: control_t, at_axis_gap
  use solver, only: solver_t
  use path_coordinate, only: path_control
  use path_span, only: path_span_t
  implicit none
  private
  public :: places_between

  !> How far the curve may be from a line, in parts of h0 and load at the ends of the span (which
  !> are small far apart) and of the widest contact.
  real(wp), parameter :: allowed = 0.003_wp
  !> Parts of a span at whose ends the curve is looked at; most lines of a span.
  integer, parameter :: parts = 4, most_lines = 16

contains

  !> Coordinates of a span between `from` and `to`, in order. Equal parts will do: each is as far
  !> from its line as the square of its length. widest: contact radius, lateral units.
  pure function places_between(solver, span, from, to, widest) result(places)
    class(solver_t), intent(in) :: solver
    type(path_span_t), intent(in) :: span
    real(wp), intent(in) :: from, to, widest
    real(wp), allocatable :: places(:)
    real(wp) :: seen(3, 0:parts), chord(3), aside(3), farthest
    integer :: j, lines

    do j = 0, parts
      seen(:, j) = seen_at(from + (to - from)*j/parts)
    end do
    do j = 1, 2
      seen(j, :) = seen(j, :)/max(abs(seen(j, 0)), abs(seen(j, parts)), tiny(1.0_wp))
    end do
    seen(3, :) = seen(3, :)/widest
    chord = seen(:, parts) - seen(:, 0)
    chord = chord/max(norm2(chord), tiny(1.0_wp))
    farthest = 0
    do j = 1, parts - 1
      aside = seen(:, j) - seen(:, 0)
      farthest = max(farthest, norm2(aside - dot_product(aside, chord)*chord))
    end do
    lines = ceiling(min(real(most_lines, wp), sqrt(farthest/allowed)))
    places = [(from + (to - from)*j/lines, j=1, lines - 1)]

  contains

    !> H0, load and contact radius that are expected at s.
    pure function seen_at(s) result(values)
      real(wp), intent(in) :: s
      real(wp) :: values(3)
      type(control_t) :: control
      type(state_t) :: state

      control = path_control(solver%problem, span%mesh, s)
      values = [span%h0_and_load(s), control%value]
      if (control%kind /= at_axis_gap) return
      values(3) = 0
      if (control%value >= contact_level_of(solver%problem)) return
      call span%expected(solver, s, state)
      state%axis_gap = control%value
      values(3) = radius_of_gap(solver%problem%shape, contact_level_of(solver%problem), &
        solver%meshes%grid(span%mesh), state)
    end function seen_at

  end function places_between

end module straight_lines
