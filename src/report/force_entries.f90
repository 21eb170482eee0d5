!> What the scan of a force law has found, as entries of the summary.
module force_entries
  use kinds, only: wp
  use dimensionless_problem, only: problem_t, surface_energy, largest_tension
  use text, only: brief
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
      call take_table_error(problem, summary)
      if (.not. surface_energy(problem) > 0) &
        call summary%warn('contact is only metastable: the bodies have less energy apart, '// &
        'and no classical theory applies')
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

  !> How well the points of a table tell the depth of the well and the largest tension: the pull-off
  !> is in proportion to the first for hard bodies and for soft ones, and depends on both between.
  subroutine take_table_error(problem, summary)
    type(problem_t), intent(in) :: problem
    type(summary_t), intent(inout) :: summary
    real(wp) :: of_well(2, 1), of_edge(2, 1), depth(1), tension(1), error
    !> Beyond this the table and not the mesh decides what is found.
    real(wp), parameter :: coarse = 1.0e-3_wp

    associate (law => problem%law)
      of_well = law%table_error([law%rest_gap])
      if (.not. of_well(2, 1) > 0) return
      depth = abs(law%energy([law%rest_gap]))
      error = of_well(2, 1)/max(depth(1), tiny(1.0_wp))
      if (law%edge_gap > 0) then
        of_edge = law%table_error([law%edge_gap])
        tension = abs(law%pressure([law%edge_gap]))
        error = max(error, of_edge(1, 1)/max(tension(1), tiny(1.0_wp)))
      end if
    end associate
    call summary%set('table_error', error)
    if (error > coarse) call summary%warn('the points of the table are far apart: work of ' // &
      'adhesion and pull-off are uncertain by about ' // brief(error) // ' of themselves')
  end subroutine take_table_error

end module force_entries
