!> Which theory of contact describes a scene: the parameters for this choice, and the errors of the
!> theories in pull-off force, contact radius and indentation relative to the computed path.
module regime_rows
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: wp, pi, nan
  use dimensionless_problem, only: problem_t, surface_energy, largest_tension, tension_is_even, &
    tabor_parameter
  use layered_contact, only: layered_contact_t, new_layered_contact, has_layers, of_displacement
  use classical, only: hertz, jkr, hertz_radius_at_load, hertz_displacement, jkr_radius_at_load, &
    jkr_displacement, jkr_pull_off, dmt_radius_at_load, dmt_pull_off
  use maugis, only: maugis_t, new_maugis
  use transition_fits, only: transition_fit_t, carpick_fit, pietrement_fit
  use reported_place, only: place_t, of_h0, of_load, of_radius, of_edge
  use places, only: places_t
  use reported_values, only: readings_t, read_numbers
  use summary, only: summary_t
  implicit none
  private
  public :: summarise_regime

  !> The theories: those of half-spaces (for layers, of half-spaces of the top layers' materials),
  !> those of layers, and formulas fitted to one of them. closed: the theories that are closed forms
  !> of the load.
  character(len=*), parameter :: theories(*) = [character(len=13) :: 'hertz', 'jkr', 'dmt', &
    'maugis', 'hertz_layered', 'jkr_layered', 'carpick', 'pietrement']
  integer, parameter :: by_hertz = 1, by_jkr = 2, by_dmt = 3, by_maugis = 4, &
    by_hertz_layered = 5, by_jkr_layered = 6, by_carpick = 7, by_pietrement = 8
  integer, parameter :: closed(*) = [by_jkr, by_dmt, by_carpick, by_pietrement]
  !> The numbers in which the theories are compared: pull-off force [N], negative; contact radius
  !> and indentation [m] at the largest load.
  integer, parameter :: pull_off = 1, radius = 2, indentation = 3
  character(len=*), parameter :: numbers(3) = [character(len=14) :: 'pull-off', 'contact radius', &
    'indentation']
  !> Largest error of a theory that is recommended.
  real(wp), parameter :: acceptable = 0.1_wp
  !> Largest error that a message shows.
  real(wp), parameter :: largest_shown = 1.0e6_wp

contains

  !> Adds the regime to the summary. The theories' contact radius, where the tension begins, is
  !> compared with the computed radius of largest tension; if the force has a step, it is compared
  !> with the computed contact radius. Touching bodies have zero separation in the theories, and the
  !> equilibrium separation here; indentations are measured from these separations. Their errors are
  !> relative to a^2/R.
  subroutine summarise_regime(problem, places, summary)
    type(problem_t), intent(in) :: problem
    type(places_t), intent(in) :: places
    type(summary_t), intent(inout) :: summary
    real(wp), dimension(3) :: solved, uncertain
    type(layered_contact_t) :: layered
    type(maugis_t) :: cohesive
    real(wp), allocatable :: errors(:, :), spread(:, :)
    real(wp) :: load, load_error, gamma, strength
    integer :: i
    logical :: there

    gamma = surface_energy(problem)
    strength = largest_tension(problem)
    call summary%set('regime_tabor', tabor_parameter(problem))
    call measure()
    if (.not. (there .and. gamma > 0 .and. strength > 0)) then
      call summary%warn('regime: the path does not end in a contact that theories can be ' // &
        'compared with')
      return
    end if
    ! This range is also deep enough for theories whose load at an indentation is smaller than that
    ! of the path.
    layered = new_layered_contact(problem, 2*solved(indentation))
    associate (r => problem%radius, y => problem%stiffness)
      ! Tabor's parameter with the reduced modulus E* = y/2 and the range w/strength of the force.
      call summary%set('regime_tabor_range', (4*r*strength**3/(y**2*gamma))**(1.0_wp/3))
      cohesive = new_maugis(r, y, gamma, strength)
      call summary%set('regime_maugis_lambda', cohesive%lambda)
      call summary%set('regime_load_number', load/(pi*gamma*r), load_error/(pi*gamma*r))
      errors = all_errors(load, solved)
      ! By how much the errors of the computed numbers change the errors of the theories.
      spread = abs(all_errors(load + load_error, solved) - errors) + &
        abs(all_errors(load, solved + [uncertain(pull_off), 0.0_wp, 0.0_wp]) - errors) + &
        abs(all_errors(load, solved + [0.0_wp, uncertain(radius), 0.0_wp]) - errors)
      do i = 1, size(theories)
        if (any(i == [by_hertz_layered, by_jkr_layered]) .and. .not. has_layers(problem)) cycle
        call summary%set('regime_error_' // trim(theories(i)), errors(:, i), spread(:, i))
      end do
    end associate
    call recommend()
    call recommend_formula()

  contains

    function all_errors(at_load, numbers) result(errors)
      real(wp), intent(in) :: at_load
      real(wp), intent(in) :: numbers(3)
      real(wp) :: errors(3, size(theories))
      integer :: k

      errors = of_theories(at_load)
      do k = 1, size(theories)
        errors(:, k) = [errors(:radius, k)/numbers(:radius), 1 + (errors(indentation, k) - &
          numbers(indentation))*problem%radius/numbers(radius)**2] - 1
      end do
    end function all_errors

    !> Takes the numbers of the path, with errors. there = .false.: the path has no pull-off, or no
    !> contact at its end.
    subroutine measure()
      type(place_t) :: lowest, finish
      integer :: edge

      edge = merge(of_radius, of_edge, tension_is_even(problem))
      lowest = places%place_of('path_tension')
      finish = places%place_of('path_end')
      there = min(finish%at(of_edge), finish%at(of_radius)) > 0 .and. lowest%at(of_load) < 0
      load = finish%at(of_load)*problem%load
      solved = [lowest%at(of_load)*problem%load, finish%at(edge)*problem%lateral, &
        (problem%law%rest_gap - finish%at(of_h0))*problem%length]
      load_error = error_of('path_end', of_load)
      uncertain = [error_of('path_tension', of_load), error_of('path_end', edge), &
        error_of('path_end', of_h0)]
    end subroutine measure

    real(wp) function error_of(name, quantity) result(error)
      character(len=*), intent(in) :: name
      integer, intent(in) :: quantity
      type(readings_t) :: found

      found = read_numbers(places, problem, name, quantity)
      error = nan
      if (size(found%error) > 0) error = found%error(1)
    end function error_of

    !> The numbers that all theories predict at a load [N]; NaN if a theory has none.
    function of_theories(load) result(says)
      real(wp), intent(in) :: load
      real(wp) :: says(3, size(theories)), a
      type(transition_fit_t) :: fit
      integer :: i

      says = nan
      associate (r => problem%radius, y => problem%stiffness, gamma => surface_energy(problem))
        a = hertz_radius_at_load(load, r, y)
        says(:, by_hertz) = [0.0_wp, a, hertz_displacement(a, r)]
        a = jkr_radius_at_load(load, r, y, gamma)
        says(:, by_jkr) = [jkr_pull_off(r, gamma), a, jkr_displacement(a, r, y, gamma)]
        a = dmt_radius_at_load(load, r, y, gamma)
        says(:, by_dmt) = [dmt_pull_off(r, gamma), a, hertz_displacement(a, r)]
      end associate
      says(:radius, by_maugis) = [cohesive%pull_off(), cohesive%radius_at_load(load)]
      if (says(radius, by_maugis) > 0) says(indentation, by_maugis) = &
        cohesive%displacement(says(radius, by_maugis))
      ! Carpick's formula gives no displacement.
      fit = carpick_fit(cohesive)
      says(:radius, by_carpick) = [fit%pull_off, fit%radius_at_load(load)]
      fit = pietrement_fit(cohesive)
      says(:, by_pietrement) = [fit%pull_off, fit%radius_at_load(load), &
        fit%displacement_at_load(load)]
      if (.not. has_layers(problem)) return
      do i = by_hertz_layered, by_jkr_layered
        associate (theory => merge(hertz, jkr, i == by_hertz_layered))
          a = layered%radius_at(theory, load=load/problem%load)
          says(:radius, i) = [0.0_wp, a*problem%lateral]
          if (theory == jkr) says(pull_off, i) = layered%pull_off()*problem%load
          if (.not. ieee_is_nan(a)) &
            says(indentation, i) = layered%value_of(of_displacement, theory, a)*problem%length
        end associate
      end do
    end function of_theories

    !> Recommends the theory whose largest error is the smallest, and gives the reason. A formula
    !> fitted to a theory can be nearer to the path than the theory only by chance, and is not
    !> recommended here.
    subroutine recommend()
      real(wp) :: worst(size(errors, 2))
      character(len=*), parameter :: none_is_near = 'no theory is within 10 %; '
      character(len=160) :: nearest
      character(len=16) :: percent
      integer :: i, best, where_worst

      worst = largest_of_each(errors)
      do i = 1, size(worst)
        if (worst(i) < huge(1.0_wp)) call summary%set('regime_worst_' // trim(theories(i)), &
          worst(i))
      end do
      best = minloc(worst(:by_jkr_layered), 1)
      call summary%set('regime_theory', merge(real(best, wp), 0.0_wp, worst(best) <= acceptable))
      where_worst = maxloc(abs(errors(:, best)), 1)
      write (percent, '(f16.1)') 100*min(worst(best), largest_shown)
      nearest = 'nearest is '//trim(theories(best))//', off by at most '//trim(adjustl(percent))// &
        ' % ('//trim(numbers(where_worst))//')'
      if (worst(best) <= acceptable) then
        call summary%set('regime_recommended', trim(theories(best)))
        call summary%set('regime_reason', trim(nearest))
      else
        call summary%set('regime_recommended', 'none')
        call summary%set('regime_reason', none_is_near//trim(nearest))
      end if
    end subroutine recommend

    !> Recommends the closed form whose pull-off force and contact radius are nearest to those of
    !> the path.
    subroutine recommend_formula()
      real(wp) :: worst(size(closed))
      integer :: best

      worst = largest_of_each(errors(:2, closed))
      best = minloc(worst, 1)
      if (.not. worst(best) < huge(1.0_wp)) return
      call summary%set('regime_formula', trim(theories(closed(best))))
      call summary%set('regime_formula_error', worst(best))
    end subroutine recommend_formula

    !> The largest error of each theory; huge if the theory does not give all numbers.
    pure function largest_of_each(errors) result(largest)
      real(wp), intent(in) :: errors(:, :)
      real(wp) :: largest(size(errors, 2))

      largest = maxval(merge(huge(1.0_wp), abs(errors), ieee_is_nan(errors)), 1)
    end function largest_of_each

  end subroutine summarise_regime

end module regime_rows
