!> The profile of a state in SI units: separation, deformation, pressure and energy against r, on
!> the axis and at the nodes of its mesh.
module state_profile
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t, axis_row, first_node
  use elastic_operator, only: elastic_operator_t
  use contact_state, only: state_t
  use represented_pressure, only: pressure_at_nodes
  implicit none
  private
  public :: state_profile_t, profile_of, alike

  !> r: radii [m], beginning with 0. At these radii: the separation [m], the mean outward
  !> displacement of the two surfaces [m], pressure [Pa] and energy per area [J/m^2]. each: the
  !> displacements of the two surfaces [m], (size(r), 2).
  type :: state_profile_t
    real(wp), allocatable :: r(:), gap(:), deformation(:), pressure(:), energy(:), each(:, :)
  end type state_profile_t

contains

  !> Whether the two bodies deform equally.
  pure logical function alike(problem)
    type(problem_t), intent(in) :: problem

    alike = problem%body%is_alike() .and. .not. abs(problem%share(1) - problem%share(2)) > 0
  end function alike

  !> The profile of a state on its mesh.
  type(state_profile_t) function profile_of(problem, grid, state) result(profile)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state
    real(wp), dimension(size(state%gap) + 1) :: r, gap, deformation
    real(wp) :: each(size(state%gap) + 1, 2)
    integer, allocatable :: kept(:)
    integer :: j

    associate (n => size(state%gap), law => problem%law)
      r = [0.0_wp, state%scale*grid%x(:n)]
      gap = [state%axis_gap, state%gap]
      ! A mesh may have a node on the axis; the axis must not appear twice.
      kept = [1, pack([(j, j=2, n + 1)], [(j > 2 .or. r(j) > 0, j=2, n + 1)])]
      ! h = h0 + f - 2u.
      deformation = -0.5_wp*(gap - state%h0 - problem%shape%height(r))
      if (problem%rigid) deformation = 0
      each(:, 1) = problem%share(1)*deformation
      if (.not. problem%body%is_alike()) each(:, 1) = deformation_of_first(problem, grid, state)
      each(:, 2) = 2*deformation - each(:, 1)
      profile%pressure = [law%pressure([state%axis_gap]), &
        pressure_at_nodes(law, grid, state%gap, state%pressure)]
      profile%pressure = problem%pressure*profile%pressure(kept)
      profile%energy = law%energy(gap(kept))*problem%pressure*problem%length
      profile%gap = law%separation_of(gap(kept))
      profile%r = problem%lateral*r(kept)
      profile%deformation = problem%length*deformation(kept)
      profile%each = problem%length*each(kept, :)
    end associate
  end function profile_of

  !> Outward displacement of the first body's surface, on the axis and at the nodes, for bodies that
  !> deform by different amounts.
  function deformation_of_first(problem, grid, state) result(deformation)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state
    real(wp) :: deformation(size(state%gap) + 1)
    type(problem_t) :: first
    type(elastic_operator_t) :: operator
    real(wp) :: rise(first_node - 1 + size(state%gap))

    first = problem
    first%coupling = problem%coupling*problem%share(1)/2
    call problem%body%take_one(1, first%body)
    call operator%deform(first, grid, state%scale, size(state%gap), state%pressure, rise)
    deformation = -[rise(axis_row), rise(first_node:)]
  end function deformation_of_first

end module state_profile
