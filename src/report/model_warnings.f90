!> Warnings about the validity of the model: slopes and strains must be small, states must be within
!> the points of tables and profiles, and layers must be thick enough for bulk elasticity.
module model_warnings
  use kinds, only: wp, pi
  use force_law, only: of_pressure, of_energy
  use dimensionless_problem, only: problem_t, surface_energy, largest_tension
  use text, only: rounded
  use layered_body, only: layered_body_t
  use layered_surface, only: layered_surface_t
  use records, only: quality_t
  use summary, only: summary_t
  implicit none
  private
  public :: judge_law, judge_model, judge_theories

  !> Ratios of lengths to the radius that give a note (noted) and a warning (warned); a parabola
  !> differs from a circle by a quarter of the squared ratio. Ratio of pressure to modulus,
  !> approximately the strain, that gives a warning (strained).
  real(wp), parameter :: noted = 0.1_wp, warned = 1.0_wp/3, strained = 0.1_wp
  !> A radius [m] larger than `huge_radius`, together with a range of the force [m] shorter than
  !> `short_range`, probably has a wrong unit: lenses are smaller, and dimensionless decks have
  !> longer ranges.
  real(wp), parameter :: huge_radius = 0.1_wp, short_range = 1.0e-6_wp

contains

  !> Checks the force law and the shape.
  subroutine judge_law(problem, summary)
    type(problem_t), intent(in) :: problem
    type(summary_t), intent(inout) :: summary

    if (problem%law%caveat /= '') call summary%warn(trim(problem%law%caveat))
    if (problem%law%rest_gap > 0) then
      call take_table_error(problem, summary)
      if (.not. surface_energy(problem) > 0) call summary%warn('contact is only metastable: ' // &
        'the bodies have less energy apart, and no classical theory applies')
    end if
    ! Shapes other than parabolas, circles and ellipses have no radius of curvature on the axis.
    if (abs(problem%shape%exponent - 2) > 0) return
    call judge(summary, 'range_over_radius', range_of(problem)/problem%radius, &
      'the range of the force over the radius of the bodies', &
      'Derjaguin''s approximation needs forces of short range')
    if (problem%radius >= huge_radius .and. range_of(problem) < short_range) call summary%warn( &
      'units: a radius of ' // rounded(problem%radius) // ' m under a force with a range of ' // &
      rounded(range_of(problem)) // ' m; lengths of a deck are in m: 5 um are 5e-6')
  end subroutine judge_law

  !> Sets and checks the relative error that the interpolation of a table causes in the depth of the
  !> well and in the largest tension. The pull-off force of rigid and of very soft bodies is
  !> proportional to the depth; for other bodies it depends on depth and largest tension.
  subroutine take_table_error(problem, summary)
    type(problem_t), intent(in) :: problem
    type(summary_t), intent(inout) :: summary
    real(wp) :: of_well(2, 1), of_edge(2, 1), error
    !> Error above which the table, and not the mesh, limits the accuracy.
    real(wp), parameter :: coarse = 1.0e-3_wp

    associate (law => problem%law)
      of_well = law%table_error([law%rest_gap])
      if (.not. of_well(2, 1) > 0) return
      error = of_well(2, 1)/max(abs(law%at(of_energy, law%rest_gap)), tiny(1.0_wp))
      if (law%edge_gap > 0) then
        of_edge = law%table_error([law%edge_gap])
        error = max(error, of_edge(1, 1)/max(abs(law%at(of_pressure, law%edge_gap)), tiny(1.0_wp)))
      end if
    end associate
    call summary%set('table_error', error)
    if (error > coarse) call summary%warn('the points of the table are far apart or noisy, or ' // &
      'do not lead into its tail: work of adhesion and pull-off have relative errors of about ' // &
      rounded(error))
  end subroutine take_table_error

  !> Checks the states of the experiments.
  subroutine judge_model(problem, quality, summary)
    type(problem_t), intent(in) :: problem
    type(quality_t), intent(in) :: quality
    type(summary_t), intent(inout) :: summary

    call judge_files()
    call judge_extent()
    select type (body => problem%body)
    type is (layered_body_t)
      call judge_layers(body)
    end select

  contains

    subroutine judge_extent()
      real(wp) :: strain

      if (quality%contact_radius > 0) call judge(summary, 'contact_over_radius', &
        problem%shape%slope(quality%contact_radius/problem%lateral)*problem%length/ &
        problem%lateral, &
        'the slope at the contact''s edge', 'the model is for half-spaces with small slopes')
      if (problem%rigid .or. .not. quality%pressure > 0) return
      strain = quality%pressure*problem%pressure/problem%stiffness
      call summary%set('pressure_over_stiffness', strain)
      if (strain > strained) call summary%warn('beyond the model: the largest pressure is ' // &
        rounded(strain) // ' of the stiffness, ' // rounded(problem%stiffness) // &
        ' Pa; strains are no longer small')
    end subroutine judge_extent

    !> Warns of states outside a profile's last point, or at separations smaller than a table's
    !> first point.
    subroutine judge_files()
      call judge_reach(problem, quality%contact_radius, 'the contact reaches ', summary)
      associate (law => problem%law)
        if (.not. law%known_from > 0) return
        if (quality%gap < law%gap_of(law%known_from)) call summary%warn('beyond the file of ' // &
          '&tabulated: gaps are down to ' // rounded(law%separation_of(quality%gap)) // &
          ' m, the points to ' // rounded(law%known_from) // ' m; below, the pressure is a power')
      end associate
    end subroutine judge_files

    !> Warns of layers thinner than the range of the force, of soft layers whose compression is not
    !> small compared with their thickness, and of strains below the top layer that are not small.
    subroutine judge_layers(body)
      type(layered_body_t), intent(in) :: body
      real(wp) :: reach, thinnest, total, strain
      integer :: i

      reach = range_of(problem)
      thinnest = huge(thinnest)
      total = 0
      strain = 0
      do i = 1, 2
        if (size(body%surface(i)%thickness) == 0) cycle
        associate (thickness => body%surface(i)%thickness*problem%lateral)
          thinnest = min(thinnest, minval(thickness))
          total = total + sum(thickness)
          strain = max(strain, strain_below(body%surface(i), thickness, quality%load, &
            quality%contact_radius))
        end associate
      end do
      if (thinnest < reach) call summary%warn('beyond the model: a layer of ' // &
        rounded(thinnest) // ' m is thinner than the range of the force, ' // &
        rounded(reach) // ' m; bulk elasticity does not hold for it')
      if (body%bottom < 1 .and. quality%depth > strained*total) call summary%warn( &
        'beyond the model: the bodies are pressed together by ' // &
        rounded(quality%depth/total) // ' of the thickness of the layers; ' // &
        'strains are no longer small')
      if (strain > strained) call summary%warn('beyond the model: the strain below the ' // &
        'top layer is about ' // rounded(strain) // ', which is not small')
    end subroutine judge_layers

    !> Estimate of the largest strain below the top layer for a load [N] on a contact of a radius
    !> [m]: the stress over Young's modulus, if the load spreads at 45 degrees.
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

  end subroutine judge_model

  !> Checks the rows of theories. contact_radius [m]: that of their widest contact.
  subroutine judge_theories(problem, contact_radius, summary)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: contact_radius
    type(summary_t), intent(inout) :: summary

    associate (a => contact_radius/problem%lateral, shape => problem%shape)
      call judge(summary, 'classical_over_radius', shape%slope(a)*problem%length/problem%lateral, &
        'the slope at the edge of the widest contact in classical.csv', &
        'the theories are for small slopes')
    end associate
    call judge_reach(problem, contact_radius, 'contacts in classical.csv reach ', summary)
  end subroutine judge_theories

  !> Warns of contacts whose radius [m] is beyond the points of a profile. what: the name of the
  !> contacts in the message.
  subroutine judge_reach(problem, contact_radius, what, summary)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: contact_radius
    character(len=*), intent(in) :: what
    type(summary_t), intent(inout) :: summary

    associate (last => problem%shape%known_to)
      if (contact_radius/problem%lateral > last) call summary%warn('beyond the file of &shape: ' &
        // what // rounded(contact_radius) // ' m from the axis, the points ' // &
        rounded(last*problem%lateral) // ' m; there the body goes on as a parabola')
    end associate
  end subroutine judge_reach

  !> Sets the ratio of a length to the radius, or a slope, in the summary, and warns if it is not
  !> small.
  subroutine judge(summary, key, part, what, why)
    type(summary_t), intent(inout) :: summary
    character(len=*), intent(in) :: key, what, why
    real(wp), intent(in) :: part

    call summary%set(key, part)
    if (part > warned) then
      call summary%warn('beyond the model: ' // what // ' is ' // rounded(part) // '; ' // why)
    else if (part > noted) then
      call summary%note(what // ' is ' // rounded(part) // ', which is not small; ' // why)
    end if
  end subroutine judge

  !> Range of the force [m]: the depth of its well over its largest tension; without attraction, the
  !> length L of the law.
  pure real(wp) function range_of(problem)
    type(problem_t), intent(in) :: problem

    range_of = problem%length
    if (problem%law%edge_gap > 0 .and. problem%law%adhesion > 0) range_of = &
      problem%law%adhesion*problem%pressure*problem%length/largest_tension(problem)
  end function range_of

end module model_warnings
