!> Numbers that follow from the problem alone: those of the force law, of theories, of layers. Their
!> derivatives by parameters of &sensitivity are finite differences between varied problems.
module problem_numbers
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: wp, nan
  use dimensionless_problem, only: problem_t, adhesion_strength, tabor_parameter, surface_energy, &
    largest_tension
  use classical, only: jkr_pull_off, dmt_pull_off
  use convex_contact, only: jkr_like_pull_off
  use layered_body, only: layered_body_t
  use law_scan, only: surroundings_t, surroundings_of
  use variation, only: variation_t
  use result_rows, only: rows, row_of
  use summary, only: summary_t
  implicit none
  private
  public :: describe_problem

contains

  !> Adds the numbers of a problem, with derivatives by the parameters of `varied`.
  subroutine describe_problem(problem, summary, varied)
    type(problem_t), intent(in) :: problem
    type(summary_t), intent(inout) :: summary
    type(variation_t), intent(in), optional :: varied(:)
    real(wp) :: own(size(rows)), other(size(rows))
    real(wp), allocatable, dimension(:, :) :: rate, error
    integer :: i, j, k

    own = numbers_of(problem)
    j = 0
    if (present(varied)) j = size(varied)
    allocate (rate(j, size(rows)), source=0.0_wp)
    error = rate
    do j = 1, size(rate, 1)
      do k = 1, size(varied(j)%problem)
        other = numbers_of(varied(j)%problem(k))
        ! Differences to the unvaried problem are summed, so that a number that does not depend on a
        ! parameter has the derivative 0 exactly.
        rate(j, :) = rate(j, :) + varied(j)%weight(k)*(other - own)
        error(j, :) = error(j, :) + (varied(j)%weight(k) - varied(j)%coarser(k))*(other - own)
      end do
    end do
    do i = 1, size(rows)
      if (.not. ieee_is_nan(own(i))) &
        call summary%set(trim(rows(i)%key), own(i:i), rate=rate(:, i:i), &
          rate_error=abs(error(:, i:i)))
    end do
  end subroutine describe_problem

  !> The number of each row; NaN if it does not exist.
  function numbers_of(problem) result(number)
    type(problem_t), intent(in) :: problem
    real(wp) :: number(size(rows))

    number = nan
    if (problem%law%adhesion > 0) then
      if (problem%law%work > 0) then
        call set('surface_energy', surface_energy(problem))
        call take_pull_offs()
      end if
      ! If the law has neither a work of adhesion nor an equilibrium separation, its adhesion is
      ! only a scale factor and gives no sigma.
      if (.not. problem%rigid .and. (problem%law%work > 0 .or. problem%law%rest_gap > 0)) then
        call set('sigma', adhesion_strength(problem))
        if (problem%shape%exponent > 0) call set('tabor', tabor_parameter(problem))
      end if
    else if (problem%law%coupling_name /= '' .and. .not. problem%rigid) then
      call set(trim(problem%law%coupling_name), problem%coupling)
    end if
    if (.not. problem%rigid .and. problem%body%is_homogeneous()) then
      call set('reduced_modulus', 0.5_wp*problem%stiffness)
      call set('plane_strain_modulus', problem%stiffness)
    end if
    select type (body => problem%body)
    type is (layered_body_t)
      ! The bodies respond with the modulus of the top layer to short wavelengths, and with that of
      ! the base to long ones.
      call set('top_modulus', 0.5_wp*problem%stiffness)
      if (body%bottom > 0) call set('bottom_modulus', 0.5_wp*problem%stiffness/body%bottom)
    end select
    if (problem%law%rest_gap > 0) then
      call set('rest_gap', problem%law%separation_of(problem%law%rest_gap))
      call take_forces()
    end if

  contains

    subroutine set(key, value)
      character(len=*), intent(in) :: key
      real(wp), intent(in) :: value

      number(row_of(key)) = value
    end subroutine set

    !> Pull-off forces of the theories. For shapes other than the parabola, the pull-off force of
    !> JKR theory depends on the modulus, and that of rigid bodies on the whole law.
    subroutine take_pull_offs()
      if (problem%shape%parabolic) call set('dmt_pull_off', &
        -dmt_pull_off(problem%radius, surface_energy(problem)))
      ! The JKR pull-off force of layered bodies is computed only for &classical.
      if (.not. problem%body%is_homogeneous()) return
      if (problem%shape%parabolic) then
        call set('jkr_pull_off', -jkr_pull_off(problem%radius, surface_energy(problem)))
      else if (.not. problem%rigid) then
        call set('jkr_pull_off', -jkr_like_pull_off(problem)*problem%load)
      end if
    end subroutine take_pull_offs

    !> The primary minimum of the force law, and the barrier and the secondary minimum, if the law
    !> has them.
    subroutine take_forces()
      type(surroundings_t) :: outside
      real(wp) :: energy

      associate (law => problem%law)
        energy = problem%pressure*problem%length
        call set('work_of_adhesion', surface_energy(problem))
        if (law%edge_gap > 0) then
          call set('edge_gap', law%separation_of(law%edge_gap))
          call set('cohesive_stress', largest_tension(problem))
          call set('cohesive_range', law%adhesion*energy/largest_tension(problem))
        end if
        outside = surroundings_of(law)
        if (outside%has_barrier) then
          call set('barrier_pressure', outside%barrier_pressure*problem%pressure)
          call set('barrier_energy', outside%barrier_energy*energy)
        end if
        if (outside%has_well) then
          call set('secondary_minimum_gap', law%separation_of(outside%well_gap))
          call set('secondary_minimum_energy', outside%well_energy*energy)
        end if
      end associate
    end subroutine take_forces

  end function numbers_of

end module problem_numbers
