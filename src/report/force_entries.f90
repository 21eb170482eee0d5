!> What the scan of a force law has found, as entries of the summary.
module force_entries
  use kinds, only: wp
  use dimensionless_problem, only: problem_t, surface_energy, largest_tension
  use law_scan, only: surroundings_t, surroundings_of
  use summary, only: summary_t
  implicit none
  private
  public :: take_forces

contains

  !> The well of contact and what lies outside it; nothing of what the law does not have.
  subroutine take_forces(problem, summary)
    type(problem_t), intent(in) :: problem
    type(summary_t), intent(inout) :: summary
    type(surroundings_t) :: outside
    real(wp) :: energy

    associate (law => problem%law)
      if (.not. law%rest_gap > 0) return
      energy = problem%pressure*problem%length
      call summary%set('work_of_adhesion', surface_energy(problem))
      call summary%set('rest_gap', law%separation_of(law%rest_gap))
      if (.not. surface_energy(problem) > 0) call summary%warn('contact is only metastable: the '// &
        'bodies have less energy apart, and no classical theory applies')
      if (law%edge_gap > 0) then
        call summary%set('edge_gap', law%separation_of(law%edge_gap))
        call summary%set('cohesive_stress', largest_tension(problem))
        call summary%set('cohesive_range', law%adhesion*energy/largest_tension(problem))
      end if
      outside = surroundings_of(law)
      if (outside%has_barrier) then
        call summary%set('barrier_pressure', outside%barrier_pressure*problem%pressure)
        call summary%set('barrier_energy', outside%barrier_energy*energy)
      end if
      if (outside%has_well) then
        call summary%set('secondary_minimum_gap', law%separation_of(outside%well_gap))
        call summary%set('secondary_minimum_energy', outside%well_energy*energy)
      end if
    end associate
  end subroutine take_forces

end module force_entries
