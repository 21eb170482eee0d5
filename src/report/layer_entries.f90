!> What the summary says of a scene of layered bodies that is not on the ground of their model.
module layer_entries
  use kinds, only: wp, pi
  use dimensionless_problem, only: problem_t, largest_tension
  use layered_body, only: layered_body_t
  use layered_surface, only: layered_surface_t
  use records, only: extent_t
  use reported, only: reported_t, of_h0, of_load
  use places, only: places_t
  use summary, only: summary_t
  use validity, only: strained
  use quality_warnings, only: short_number
  implicit none
  private
  public :: judge_layers

contains

  !> Warns of layers that are thinner than the force reaches; of soft ones that are pressed to a
  !> part of their thickness that is not small; and of what lies deeper and is strained by the load.
  subroutine judge_layers(problem, extent, places, summary)
    type(problem_t), intent(in) :: problem
    type(extent_t), intent(in) :: extent
    type(places_t), intent(in) :: places
    type(summary_t), intent(inout) :: summary
    type(reported_t) :: finish, lowest
    real(wp) :: reach, deepest, force, strain
    integer :: i

    select type (body => problem%body)
    type is (layered_body_t)
      reach = problem%length
      if (problem%law%edge_gap > 0 .and. problem%law%adhesion > 0) reach = &
        problem%law%adhesion*problem%pressure*problem%length/largest_tension(problem)
      finish = places%place_of('end')
      lowest = places%place_of('max_tension')
      deepest = -problem%law%separation_of(finish%at(of_h0))
      if (.not. places%has('end')) deepest = 0
      force = problem%load*max(-lowest%at(of_load), abs(finish%at(of_load)))
      do i = 1, 2
        if (size(body%surface(i)%thickness) == 0) cycle
        associate (thickness => body%surface(i)%thickness*problem%lateral)
          if (minval(thickness) < reach) call summary%warn('beyond the model: a layer of ' // &
            short_number(minval(thickness)) // ' m is thinner than the range of the force, ' // &
            short_number(reach) // ' m; elasticity of bulk does not hold for it')
          if (body%bottom < 1 .and. deepest > strained*sum(thickness)) call summary%warn( &
            'beyond the model: the bodies are pressed together by ' // &
            short_number(deepest/sum(thickness)) // ' of the thickness of the layers; ' // &
            'strains are no longer small')
          strain = strain_below(body%surface(i), thickness, force, extent%contact_radius)
          if (strain > strained) call summary%warn('beyond the model: what is below the top ' // &
            'layer is strained by about ' // short_number(strain) // ', which is not small')
          exit
        end associate
      end do
    end select
  end subroutine judge_layers

  !> About the largest strain below the top layer under a load [N] on a contact of some radius [m]:
  !> stress over Young's modulus, as if the load spread at half a right angle.
  pure real(wp) function strain_below(surface, thickness, load, radius) result(strain)
    type(layered_surface_t), intent(in) :: surface
    real(wp), intent(in) :: thickness(:), load, radius
    real(wp), allocatable :: young(:)
    integer :: i

    young = 2*surface%shear*(1 + surface%poisson)
    if (.not. surface%on_rigid) young = [young, 2*surface%base_shear*(1 + surface%base_poisson)]
    strain = 0
    if (.not. radius > 0) return
    do i = 2, size(young)
      strain = max(strain, load/(pi*(radius + sum(thickness(:i - 1)))**2*young(i)))
    end do
  end function strain_below

end module layer_entries
