!> Checks of a scene as a whole: its numbers and units must be within range, a body must be large
!> enough, and its load must be finite. The calculation is dimensionless, but the units are products
!> of powers of the numbers in the deck and may overflow.
module scene_checks
  use kinds, only: wp, pi
  use text, only: brief
  use force_law, only: of_pressure, of_energy
  use dimensionless_problem, only: problem_t
  use contact_scales, only: largest_radius, contact_level
  use path_demand, only: range_of
  use group_reading, only: check_decades
  use scene_groups, only: scene_t
  use scene_problem, only: problem_of
  implicit none
  private
  public :: check_derived, check_shape

  !> Decimal order of the largest h0 in lengths L of the law. Beyond it rounding errors exceed L.
  integer, parameter :: most_lengths = 15
  !> Decimal order of the largest sigma for which states are searched. Above 3e8, rounding hides the
  !> states in contact; the search finds this in seconds here, and would take minutes at 1e45.
  integer, parameter :: most_adhesion = 39
  !> The groups with values of h0 or positions of a drive, and the keys of these values.
  character(len=*), parameter :: groups(*) = [character(len=16) :: 'loading', 'unloading', &
    'equilibrium_path', 'device', 'drive', 'classical', 'approximations'], &
    keys(*) = [character(len=8) :: 'h0_start', 'h0_end', 'z_start', 'z_turn', 'z_end']

contains

  !> Refuses a scene whose units, coupling or h0 are out of range. Logarithms are added, since
  !> products might overflow.
  subroutine check_derived(scene)
    type(scene_t), intent(inout) :: scene
    real(wp) :: length, pressure, radius, coupling, farthest, position
    integer :: i, k

    radius = log10(scene%shape%radius)
    length = log10(scene%law%length)
    pressure = log10(scene%law%pressure_unit)
    call check(pressure + radius + length, 'loads', ' N')
    if (.not. scene%bodies%rigid) then
      coupling = pressure - log10(scene%bodies%stiffness) + 0.5_wp*(radius - length)
      call check(coupling, 'a coupling of law and bodies (sigma or Lambda)', '')
      if (scene%finds_states() .and. scene%law%adhesion > 0) &
        call check(coupling + log10(scene%law%adhesion), 'a strength of adhesion (sigma)', '', &
        most_adhesion)
    end if
    farthest = 0
    do i = 1, size(groups)
      if (.not. scene%deck%has_group(trim(groups(i)))) cycle
      do k = 1, size(keys)
        position = 0
        call scene%deck%get(trim(groups(i)), trim(keys(k)), position)
        farthest = max(farthest, abs(position))
      end do
    end do
    if (.not. farthest <= 10.0_wp**most_lengths*scene%law%length) &
      call scene%deck%mistake(trim(scene%law%group), trim(scene%law%length_key), 'h0 reaches '// &
      brief(farthest)//' m, more than 1e15 of these lengths, so that the law is lost in rounding')

  contains

    subroutine check(decades, what, unit, most)
      real(wp), intent(in) :: decades
      character(len=*), intent(in) :: what, unit
      integer, intent(in), optional :: most

      call check_decades(scene%deck, trim(scene%law%group), trim(scene%law%strength_key), decades, &
        what, unit, most)
    end subroutine check

  end subroutine check_derived

  !> Refuses a scene whose load cannot be computed.
  subroutine check_shape(scene)
    type(scene_t), intent(inout) :: scene

    if (.not. scene%finds_states()) return
    if (scene%shape%ends < huge(1.0_wp)) then
      call check_end(scene)
    else if (scene%law%tail_power <= 2/scene%shape%growth) then
      call scene%deck%mistake('shape', 'kind', 'the load has no limit: far out the gap grows ' // &
        'as r^' // brief(scene%shape%growth) // ' and the pressure falls as its power -' // &
        brief(scene%law%tail_power) // ', too slowly for the area there')
    end if
  end subroutine check_shape

  !> Refuses a body that ends within the contact, or where the force still acts, since Derjaguin's
  !> approximation does not hold at an end. The load at the end is estimated as the pressure there
  !> times the squared size of the body. Relative to the load of bodies without an end, it must be
  !> below the accuracy.
  subroutine check_end(scene)
    type(scene_t), intent(inout) :: scene
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
          'body, ' // share // ' m from the axis')
        return
      end if
      part = abs(law%at(of_pressure, gap))*shape%ends**2
      if (part > 0) part = part/(2*pi*max(law%adhesion, tiny(1.0_wp), &
        abs(law%at(of_energy, max(low, 1.0_wp)))))
    end associate
    write (share, '(es7.1)') min(part, 1.0_wp)
    if (.not. part <= scene%numerics%accuracy) call scene%deck%mistake('shape', 'kind', &
      'the body ends where the force still acts: at its end it makes ' // share // &
      ' of the load, above the accuracy; give &numerics a larger accuracy')
  end subroutine check_end

end module scene_checks
