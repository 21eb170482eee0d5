!> Derivatives of h0 and load by parameters of the problem, in SI units, at every point of the path,
!> for a fixed coordinate x along the path. `held` converts them to derivatives at a fixed h0 or
!> position of a drive, where x changes too.
module path_sensitivity
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use equilibrium, only: equations_t
  use frozen_jacobian, only: frozen_jacobian_t
  use traced_path, only: traced_path_t
  use path_point, only: path_point_t, no_mesh
  use undeformed, only: load_undeformed
  use variation, only: variation_t
  use state_sensitivity, only: change_t, differentiate
  implicit none
  private
  public :: rate_t, rates_along, held

  !> Derivatives of h0 [m] and load [N] by a parameter; left: the remaining derivative of the
  !> equations (`state_sensitivity`); uncertainty: the change of the load's derivative with a
  !> coarser difference rule. separation: the derivative of a separation, at a fixed radius.
  type :: rate_t
    real(wp) :: h0 = 0, load = 0, left = 0, uncertainty = 0, separation = 0
  end type rate_t

contains

  !> The element rate(i, j) is the derivative by parameter i at point j of the path, at fixed x.
  !> found = .false.: at some point the derivatives do not exist. enough: see `differentiate`.
  !> radius(j): the radius at which a separation is differentiated at point j, over the scale of its
  !> mesh; 0: there is none.
  subroutine rates_along(equations, path, varied, enough, rate, found, radius)
    type(equations_t), intent(inout) :: equations
    type(traced_path_t), intent(in) :: path
    type(variation_t), intent(in) :: varied(:)
    real(wp), intent(in) :: enough
    type(rate_t), allocatable, intent(out) :: rate(:, :)
    logical, intent(out) :: found
    real(wp), intent(in), optional :: radius(:)
    type(frozen_jacobian_t) :: frozen
    type(change_t) :: change(size(varied))
    integer :: i, j, n

    allocate (rate(size(varied), path%last))
    found = .true.
    do j = 1, path%last
      associate (point => path%point(j))
        if (point%mesh == no_mesh) then
          do i = 1, size(varied)
            rate(i, j) = rate_undeformed(equations, varied(i), point%state%h0)
          end do
          cycle
        end if
        call differentiate(equations, point, frozen, varied, change, found, enough)
        if (.not. found) return
        do i = 1, size(varied)
          n = size(change(i)%separation) - 1
          rate(i, j) = rate_t(change(i)%separation(n + 1), change(i)%load, change(i)%left, &
            change(i)%uncertainty)
          if (.not. present(radius)) cycle
          if (radius(j) > 0) rate(i, j)%separation = equations%meshes%grid(point%mesh)% &
            interpolate(change(i)%separation(:n), radius(j))
        end do
      end associate
    end do
  end subroutine rates_along

  !> The derivatives for undeformed bodies at a fixed h0.
  type(rate_t) function rate_undeformed(equations, varied, h0) result(rate)
    type(equations_t), intent(in) :: equations
    type(variation_t), intent(in) :: varied
    real(wp), intent(in) :: h0
    real(wp) :: load(size(varied%offset))
    integer :: k

    do k = 1, size(load)
      associate (problem => varied%problem(k))
        load(k) = problem%load*load_undeformed(problem, &
          problem%law%gap_of(equations%problem%law%separation_of(h0)))
      end associate
    end do
    rate%load = sum(varied%weight*load)
    rate%uncertainty = abs(rate%load - sum(varied%coarser*load))
  end function rate_undeformed

  !> The derivatives at a fixed value of Q = weights(1) h0 + weights(2) load, in SI units, instead
  !> of a fixed x. The weights are 1, 0 at fixed h0; 1, -1/k at a fixed position of a drive of
  !> stiffness k; 0, 1 under a fixed load. The derivatives are infinite where Q turns along the
  !> path.
  pure type(rate_t) function held(problem, node, rate, weights)
    type(problem_t), intent(in) :: problem
    type(path_point_t), intent(in) :: node
    type(rate_t), intent(in) :: rate
    real(wp), intent(in) :: weights(2)
    real(wp) :: slope(2), shift

    slope = [node%tangent%h0*problem%length, node%tangent%load*problem%load]
    shift = -dot_product(weights, [rate%h0, rate%load])/dot_product(weights, slope)
    held = rate
    held%h0 = rate%h0 + shift*slope(1)
    held%load = rate%load + shift*slope(2)
  end function held

end module path_sensitivity
