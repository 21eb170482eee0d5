!> What derivatives by the parameters of &sensitivity are found with.
module sensitivity_finder
  use kinds, only: wp
  use traced_path, only: traced_path_t
  use variation, only: variation_t
  use path_stepper, only: path_stepper_t
  implicit none
  private
  public :: finder_t, apart_at, h0_alone, load_alone

  !> The first of `varied` is the path's coordinate; steps: the path, and what solves on it.
  type :: finder_t
    type(variation_t), allocatable :: varied(:)
    class(path_stepper_t), pointer :: steps => null()
    !> Whether all that was looked for exists.
    logical :: whole = .true.
  end type finder_t

  !> Weights of h0 and load.
  real(wp), parameter :: h0_alone(2) = [1.0_wp, 0.0_wp], load_alone(2) = [0.0_wp, 1.0_wp]
  !> Part of the distance of two points of the path over which second derivatives are taken, and
  !> that distance where it is not known.
  real(wp), parameter :: part = 0.015_wp, usual = 0.1_wp

contains

  !> Over which distance of the coordinate second derivatives are taken at s: a part of that between
  !> the points of the path about it, polished ones aside, which may be as near as they like.
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

end module sensitivity_finder
