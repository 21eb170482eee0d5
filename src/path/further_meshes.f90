!> Meshes that are inserted while the path is traced. A new mesh about the axis begins where the
!> present one misses too much of the load, unless meshes are locked to the front of a step. Under a
!> law with several minima of its energy, bodies may be in contact in an outer minimum before the
!> contact proper. Such a contact has an edge of its own: there the tension outside the minimum is
!> largest. While this edge moves faster than the axis, meshes are locked to it.
module further_meshes
  use kinds, only: wp
  use force_law, only: force_law_t
  use contact_state, only: radius_of_gap
  use equilibrium, only: equations_t
  use mesh_plan, only: band_of_waves
  use arc, only: arc_t
  use path_coordinate, only: axis_coordinate
  use mending, only: left_in_state
  implicit none
  private
  public :: insert_mesh

  !> Ratio of the rates of the two coordinates at which a mesh is locked to the faster one.
  real(wp), parameter :: faster = 2
  !> Largest change of the gap on the axis over that of h0 in a contact that grows in a minimum.
  real(wp), parameter :: resting = 0.2_wp
  !> Depth for which a mesh about the axis is made, over the depth where it begins.
  real(wp), parameter :: deeper = 1.5_wp
  !> States of an arc, of which two are from the mesh before, after which a mesh is inserted.
  integer, parameter :: enough = 4
  !> Part of the period by which gaps differ among which an edge is looked for.
  real(wp), parameter :: apart = 1.0_wp/32

contains

  !> Inserts a mesh after that of an arc if the path should continue on another one. most: part of
  !> the load that the nodes may miss.
  subroutine insert_mesh(equations, arc, most, inserted)
    type(equations_t), intent(inout) :: equations
    type(arc_t), intent(in) :: arc
    real(wp), intent(in) :: most
    logical, intent(out) :: inserted
    real(wp) :: level, radius(2), nearer, wider

    inserted = .false.
    associate (meshes => equations%meshes, law => equations%problem%law, mesh => arc%mesh)
      if (.not. meshes%grows .or. meshes%fronts .or. .not. law%edge_gap > 0) return
      if (meshes%in_contact(mesh) .or. arc%held < enough) return
      if (meshes%passage(mesh) <= 0) return
      associate (before => arc%state(arc%held - 1), now => arc%state(arc%held))
        level = meshes%locked_gap(mesh)
        if (.not. level > 0 .and. law%period > 0) level = edge_beyond(law, now%axis_gap)
        radius = [radius_of_gap(equations%problem%shape, level, meshes%grid(mesh), before), &
          radius_of_gap(equations%problem%shape, level, meshes%grid(mesh), now)]
        nearer = axis_coordinate(law, now) - axis_coordinate(law, before)
        wider = 0
        if (minval(radius) > 0) wider = log(radius(2)/radius(1))
        if (meshes%is_about_axis(mesh)) then
          inserted = level > law%edge_gap .and. wider > faster*nearer .and. &
            wider < log(band_of_waves) .and. &
            abs(now%axis_gap - before%axis_gap) < resting*abs(now%h0 - before%h0)
          if (.not. inserted) level = 0
          inserted = inserted .or. left_in_state(equations, mesh, now) > most
        else
          inserted = nearer > faster*wider
          if (inserted) level = 0
          inserted = inserted .or. radius(2) > meshes%reach(2, mesh) .or. &
            left_in_state(equations, mesh, now) > most
        end if
      end associate
      if (.not. inserted) return
      if (level > 0) then
        call meshes%insert(mesh, level, radius(1), band_of_waves*radius(2))
      else
        ! The poles of the pressure are as far from the axis at h0 as at -h0.
        call meshes%insert(mesh, level, max(meshes%reach(1, 1), &
          deeper*abs(arc%state(arc%held)%h0)), 0.0_wp)
      end if
    end associate
    call equations%operator%forget()
  end subroutine insert_mesh

  !> The smallest gap above another one, approximately, at which the tension is largest.
  pure real(wp) function edge_beyond(law, gap) result(edge)
    class(force_law_t), intent(in) :: law
    real(wp), intent(in) :: gap
    real(wp) :: pressure(3), step
    integer :: k

    step = apart*law%period
    k = max(0, ceiling((gap - law%edge_gap)/step))
    do
      edge = law%edge_gap + k*step
      if (edge > law%range) exit
      pressure = law%pressure(edge + step*[-1, 0, 1])
      if (pressure(2) < min(pressure(1), pressure(3), 0.0_wp)) exit
      k = k + 1
    end do
  end function edge_beyond

end module further_meshes
