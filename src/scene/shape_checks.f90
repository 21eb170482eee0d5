!> Checks that a body is large enough for a scene, and that its load is finite.
module shape_checks
  use kinds, only: wp, pi
  use failure, only: failure_t
  use text, only: brief
  use dimensionless_problem, only: problem_t
  use contact_scales, only: largest_radius, contact_level
  use path_demand, only: range_of
  use scene_groups, only: scene_t
  use scene_problem, only: problem_of
  implicit none
  private
  public :: check_shape

contains

  !> Refuses a scene whose load cannot be computed.
  subroutine check_shape(scene, error)
    type(scene_t), intent(in) :: scene
    type(failure_t), allocatable, intent(inout) :: error

    if (.not. scene%finds_states()) return
    if (scene%shape%ends < huge(1.0_wp)) then
      call check_end(scene, error)
    else if (scene%law%tail_power <= 2/scene%shape%growth) then
      call scene%deck%mistake('shape', 'kind', &
        'the load has no limit: far out the gap grows as r^' // brief(scene%shape%growth) // &
        ' and the pressure falls as its power -' // brief(scene%law%tail_power) // &
        ', too slowly for the area there', error)
    end if
  end subroutine check_shape

  !> Refuses a body that ends within the contact, or where the force still acts, since Derjaguin's
  !> approximation does not hold at an end. The pressure at the end times an area of the body's size
  !> must be below the accuracy, as a part of the load of bodies without an end.
  subroutine check_end(scene, error)
    type(scene_t), intent(in) :: scene
    type(failure_t), allocatable, intent(inout) :: error
    type(problem_t) :: problem
    real(wp) :: low, high, gap, part, widest
    character(len=7) :: share

    problem = problem_of(scene)
    call range_of(scene, problem, low, high)
    associate (law => problem%law, shape => problem%shape)
      widest = 0
      if (.not. problem%rigid) widest = largest_radius(problem, low, contact_level(problem))
      gap = shape%height(shape%ends) + min(low, 0.0_wp)
      if (.not. widest < shape%ends .or. .not. gap > max(law%rest_gap, law%edge_gap)) then
        write (share, '(es7.1)') shape%ends*problem%lateral
        call scene%deck%mistake('shape', 'kind', 'the contact would reach the end of the ' // &
          'body, ' // share // ' m from the axis', error)
        return
      end if
      part = abs(sum(law%pressure([gap])))*shape%ends**2
      if (part > 0) part = part/(2*pi*max(law%adhesion, tiny(1.0_wp), &
        abs(sum(law%energy([max(low, 1.0_wp)])))))
    end associate
    write (share, '(es7.1)') min(part, 1.0_wp)
    if (.not. part <= scene%numerics%accuracy) call scene%deck%mistake('shape', 'kind', &
      'the body ends where the force still acts: at its end it makes ' // share // &
      ' of the load, above the accuracy; give &numerics a larger accuracy', error)
  end subroutine check_end

end module shape_checks
