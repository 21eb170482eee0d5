!> Whether a scene is on the ground of its model, and how far inside: shapes that are shallow where
!> forces act and bodies touch, strains that are small, and what a force law says of itself.
module validity
  use kinds, only: wp, pi
  use dimensionless_problem, only: problem_t, surface_energy, largest_tension
  use text, only: brief
  use layered_body, only: layered_body_t
  use layered_surface, only: layered_surface_t
  use records, only: extent_t
  use reported_place, only: place_t, of_h0, of_load
  use places, only: places_t
  use summary, only: summary_t
  use quality_warnings, only: short_number
  implicit none
  private
  public :: judge_law, judge_extent, judge_layers

  !> Part of the radius that is worth a note, and a warning: a parabola is off from a circle by a
  !> quarter of its square. Pressure over stiffness, about the strain, that is worth a warning.
  real(wp), parameter :: noted = 0.1_wp, warned = 1.0_wp/3, strained = 0.1_wp

contains

  !> What follows from law and shape alone.
  subroutine judge_law(problem, summary)
    type(problem_t), intent(in) :: problem
    type(summary_t), intent(inout) :: summary

    if (problem%law%caveat /= '') call summary%warn(trim(problem%law%caveat))
    if (problem%law%rest_gap > 0) then
      call take_table_error(problem, summary)
      if (.not. surface_energy(problem) > 0) &
        call summary%warn('contact is only metastable: the bodies have less energy apart, '// &
        'and no classical theory applies')
    end if
    ! Other shapes than parabolas, circles and ellipses have no radius on the axis.
    if (abs(problem%shape%exponent - 2) > 0) return
    call judge(summary, 'range_over_radius', range_of(problem)/problem%radius, &
      'the range of the force', &
      'Derjaguin''s approximation needs forces of short range')
  end subroutine judge_law

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

  !> What follows from the states of the experiments.
  subroutine judge_extent(problem, extent, summary)
    type(problem_t), intent(in) :: problem
    type(extent_t), intent(in) :: extent
    type(summary_t), intent(inout) :: summary
    real(wp) :: strain

    if (extent%contact_radius > 0) call judge(summary, 'contact_over_radius', &
      problem%shape%slope(extent%contact_radius/problem%lateral)*problem%length/problem%lateral, &
      'the contact radius', 'half-spaces with small slopes stand for the bodies')
    if (problem%rigid .or. .not. extent%pressure > 0) return
    strain = extent%pressure*problem%pressure/problem%stiffness
    call summary%set('pressure_over_stiffness', strain)
    if (strain > strained) call summary%warn('beyond the model: the largest pressure is ' // &
      short_number(strain) // ' of the stiffness; strains are no longer small')
  end subroutine judge_extent

  !> Enters a length as a part of the radius, or a slope, and says so where that is not small.
  subroutine judge(summary, key, part, what, why)
    type(summary_t), intent(inout) :: summary
    character(len=*), intent(in) :: key, what, why
    real(wp), intent(in) :: part

    call summary%set(key, part)
    if (part > warned) then
      call summary%warn('beyond the model: ' // what // ' is ' // short_number(part) // &
        ' of the radius of the bodies; ' // why)
    else if (part > noted) then
      call summary%note(what // ' is ' // short_number(part) // &
        ' of the radius of the bodies, which is not small; ' // why)
    end if
  end subroutine judge

  !> Range of the force [m]: the depth of its well over its largest tension or, of a law that does
  !> not attract, its length.
  pure real(wp) function range_of(problem)
    type(problem_t), intent(in) :: problem

    range_of = problem%length
    if (problem%law%edge_gap > 0 .and. problem%law%adhesion > 0) range_of = &
      problem%law%adhesion*problem%pressure*problem%length/largest_tension(problem)
  end function range_of

  !> Warns of layers that are thinner than the force reaches; of soft ones that are pressed to a
  !> part of their thickness that is not small; and of what lies deeper and is strained by the load.
  subroutine judge_layers(problem, extent, places, summary)
    type(problem_t), intent(in) :: problem
    type(extent_t), intent(in) :: extent
    type(places_t), intent(in) :: places
    type(summary_t), intent(inout) :: summary
    type(place_t) :: finish, lowest
    real(wp) :: reach, deepest, force, strain
    integer :: i

    select type (body => problem%body)
    type is (layered_body_t)
      reach = range_of(problem)
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

end module validity
