!> The classical theories over the range of a scene, as rows of a table.
module classical_rows
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: wp
  use dimensionless_problem, only: problem_t, surface_energy, largest_tension
  use classical, only: hertz_load_at_displacement, hertz_radius_at_displacement, &
    jkr_load_at_displacement, jkr_radius_at_displacement, dmt_load_at_displacement, theories, &
    hertz, jkr, dmt, maugis_dugdale, carpick, pietrement_troyon
  use convex_contact, only: hertz_like_load, jkr_like_load, jkr_like_radius, detachment_radius
  use maugis, only: maugis_t, new_maugis
  use transition_fits, only: transition_fit_t, carpick_fit, pietrement_fit
  use layered_contact, only: layered_contact_t, new_layered_contact, has_layers, of_load, &
    of_displacement
  use scene_groups, only: range_t
  use model_warnings, only: judge_theories
  use results, only: results_t
  use summary, only: summary_t
  use text, only: rounded
  implicit none
  private
  public :: write_classical, summarise_classical

  !> Relative difference of two radii below which they count as equal.
  real(wp), parameter :: small = 1e-6_wp

contains

  !> Writes the wanted theories at range%count values of h0 [m]. Hertz theory needs no attraction,
  !> JKR and DMT need a law that attracts. Maugis-Dugdale theory needs a law with a largest tension;
  !> it is given this strength and the law's work of adhesion w. The formulas fitted to it need the
  !> same. In the theories the separation of touching bodies is zero, so the displacement is -h0.
  !> The rows are states that are stable at their h0. Carpick's formula gives no displacement: its
  !> contact radius is that at the load of Maugis-Dugdale theory. from [m]: the start if the range
  !> has none. Rigid bodies have no rows. For shapes other than the parabola, Hertz and JKR theory
  !> are those of convex bodies; for layered bodies they are those of layers. The summary gets a
  !> note if there is no row, and a warning if contacts are too wide for the theories.
  subroutine write_classical(problem, range, from, results, summary)
    type(problem_t), intent(in) :: problem
    type(range_t), intent(in) :: range
    real(wp), intent(in) :: from
    type(results_t), intent(inout) :: results
    type(summary_t), intent(inout) :: summary
    type(layered_contact_t) :: contact
    real(wp) :: start, h0, delta, gamma, strength, narrowest, a, widest
    logical :: layered
    integer :: i

    call results%begin_table('classical.csv')
    if (problem%rigid) then
      call summary%note('classical: rigid bodies have no displacement, and no theory has rows')
      return
    end if
    widest = -1
    layered = has_layers(problem)
    if (layered) contact = new_layered_contact(problem, problem%law%origin - range%h0_end)
    start = from
    if (allocated(range%h0_start)) start = range%h0_start
    gamma = surface_energy(problem)
    strength = largest_tension(problem)
    if (gamma > 0 .and. .not. (layered .or. problem%shape%parabolic)) &
      narrowest = detachment_radius(problem%shape, problem%coupling*problem%law%work)
    do i = 1, range%count
      h0 = start + (range%h0_end - start)*(i - 1)/(range%count - 1)
      delta = problem%law%origin - h0
      if (layered) then
        call add_layered(hertz)
        if (problem%law%work > 0) call add_layered(jkr)
      else if (problem%shape%parabolic) then
        call add_parabola()
      else
        call add_convex()
      end if
    end do
    if (widest > 0) call judge_theories(problem, widest, summary)
    if (widest < 0) call summary%note('classical: none of these theories has a state ' // &
      'in this range of h0; if the law does not attract, only Hertz theory has states')

  contains

    subroutine add_parabola()
      type(maugis_t) :: theory
      type(transition_fit_t) :: fit
      real(wp) :: load

      associate (r => problem%radius, y => problem%stiffness)
        call add(hertz, hertz_load_at_displacement(delta, r, y), &
          hertz_radius_at_displacement(delta, r))
        if (.not. gamma > 0) return
        call add(jkr, jkr_load_at_displacement(delta, r, y, gamma), &
          jkr_radius_at_displacement(delta, r, y, gamma))
        call add(dmt, dmt_load_at_displacement(delta, r, y, gamma), &
          hertz_radius_at_displacement(delta, r))
        if (.not. strength > 0) return
        theory = new_maugis(r, y, gamma, strength)
        if (any(range%shown([maugis_dugdale, carpick]))) then
          a = theory%radius_at_displacement(delta)
          if (.not. ieee_is_nan(a)) then
            load = theory%load(a)
            call add(maugis_dugdale, load, a)
            ! A state of Maugis-Dugdale theory beyond the pull-off at fixed load is stable only at
            ! fixed displacement.
            if (a >= theory%radius_at_load(load)*(1 - small)) then
              fit = carpick_fit(theory)
              call add(carpick, load, fit%radius_at_load(load))
            end if
          end if
        end if
        if (.not. range%shown(pietrement_troyon)) return
        fit = pietrement_fit(theory)
        load = fit%load_at_displacement(delta)
        call add(pietrement_troyon, load, fit%radius_at_load(load))
      end associate
    end subroutine add_parabola

    subroutine add_convex()
      if (.not. delta < 0) then
        a = problem%shape%contact_radius(delta/problem%length)
        call add(hertz, hertz_like_load(problem, a)*problem%load, a*problem%lateral)
      end if
      if (.not. gamma > 0) return
      a = jkr_like_radius(problem%shape, problem%coupling*problem%law%work, narrowest, &
        delta/problem%length)
      if (.not. ieee_is_nan(a)) &
        call add(jkr, jkr_like_load(problem, a)*problem%load, a*problem%lateral)
    end subroutine add_convex

    subroutine add_layered(theory)
      integer, intent(in) :: theory

      if (.not. range%shown(theory)) return
      a = contact%radius_at(theory, delta/problem%length)
      if (.not. ieee_is_nan(a)) &
        call add(theory, contact%value_of(of_load, theory, a)*problem%load, a*problem%lateral)
    end subroutine add_layered

    subroutine add(theory, load, contact_radius)
      integer, intent(in) :: theory
      real(wp), intent(in) :: load, contact_radius

      ! NaN: the theory has no state here.
      if (ieee_is_nan(load) .or. ieee_is_nan(contact_radius)) return
      if (.not. range%shown(theory)) return
      widest = max(widest, contact_radius)
      call results%row(trim(theories(theory))//trim(merge('_layered', '        ', layered)), &
        [h0, delta, load, contact_radius])
    end subroutine add

  end subroutine write_classical

  !> Adds numbers of layered bodies: the pull-off force of JKR theory, and the reduced modulus E* of
  !> half-spaces that have the same Hertzian load at the displacement of the deepest contact.
  subroutine summarise_layered(problem, range, summary)
    type(problem_t), intent(in) :: problem
    type(range_t), intent(in) :: range
    type(summary_t), intent(inout) :: summary
    type(layered_contact_t) :: contact
    real(wp) :: delta, a, homogeneous

    contact = new_layered_contact(problem, problem%law%origin - range%h0_end)
    a = contact%pull_off()
    if (problem%law%work > 0 .and. .not. ieee_is_nan(a)) &
      call summary%set('jkr_pull_off', -a*problem%load)
    delta = (problem%law%origin - range%h0_end)/problem%length
    if (.not. delta > 0) return
    ! At a given contact radius the displacement is smaller with adhesion than without.
    if (contact%value_of(of_displacement, merge(jkr, hertz, problem%law%work > 0), contact%last) &
      < delta) call summary%note('classical: theories of layers are computed up to a contact ' // &
      'radius of ' // rounded(contact%last*problem%lateral) // ' m, which these bodies reach ' // &
      'before h0_end')
    a = contact%radius_at(hertz, delta)
    if (ieee_is_nan(a)) return
    homogeneous = hertz_like_load(problem, problem%shape%contact_radius(delta))
    call summary%set('effective_modulus', &
      0.5_wp*problem%stiffness*contact%value_of(of_load, hertz, a)/homogeneous)
  end subroutine summarise_layered

  !> Adds numbers of Maugis-Dugdale theory with the law's work of adhesion and largest tension, and
  !> of the formulas fitted to this theory, if they are wanted.
  subroutine summarise_classical(problem, range, summary)
    type(problem_t), intent(in) :: problem
    type(range_t), intent(in) :: range
    type(summary_t), intent(inout) :: summary
    type(maugis_t) :: theory
    real(wp) :: gamma, strength

    if (has_layers(problem)) then
      call summarise_layered(problem, range, summary)
      return
    end if
    gamma = surface_energy(problem)
    strength = largest_tension(problem)
    if (problem%rigid .or. .not. problem%shape%parabolic) return
    if (.not. (gamma > 0 .and. strength > 0)) return
    theory = new_maugis(problem%radius, problem%stiffness, gamma, strength)
    call summary%set('maugis_lambda', theory%lambda)
    call summary%set('maugis_pull_off', -theory%pull_off())
    if (range%shown(carpick)) call tell('carpick', carpick_fit(theory))
    if (range%shown(pietrement_troyon)) call tell('pietrement_troyon', pietrement_fit(theory))

  contains

    subroutine tell(name, fit)
      character(len=*), intent(in) :: name
      type(transition_fit_t), intent(in) :: fit

      call summary%set('transition_alpha', fit%alpha)
      call summary%set(name//'_pull_off', -fit%pull_off)
      call summary%set(name//'_radius', fit%radius_at_load(0.0_wp))
    end subroutine tell

  end subroutine summarise_classical

end module classical_rows
