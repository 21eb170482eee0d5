!> Warnings before a run about numerical choices that would fail or be slow: mixing in stiff
!> contacts, and uniform grids whose nodes are too far apart.
!>
!> In one iteration, mixing multiplies the error component that belongs to the eigenvalue lambda of
!> 1 - W p' by 1 - ratio lambda. The ratio is at most about the inverse of the largest eigenvalue;
!> therefore the error component of the smallest eigenvalue decreases slowly. The largest eigenvalue
!> belongs to the contact as a whole, the smallest one to a motion of its edge. Both are estimated
!> for the contact of JKR or Hertz theory at the smallest h0.
module forecast
  use kinds, only: wp, pi
  use text, only: brief, rounded
  use failure, only: failure_t
  use root_finding, only: bracket_t
  use dimensionless_problem, only: problem_t, coupling_over, yielding_gap, neck_width, &
    spacing_over_neck
  use contact_scales, only: contact_level, largest_radius, cohesive_width
  use scene_groups, only: scene_t
  use scene_problem, only: problem_of
  use scene, only: swept_scene
  use numerics_choice, only: choice_t, choose, uniform, comfortable
  use h0_schedule, only: states_planned
  use progress, only: duration
  implicit none
  private
  public :: advice_t, advice_on

  type :: advice_t
    character(len=:), allocatable :: text
  end type advice_t

  !> Estimates of the smallest and the largest eigenvalue of 1 - W p' for a contact.
  type :: spectrum_t
    real(wp) :: least = 1, largest = 1
  end type spectrum_t

  !> Time per entry of the matrix in a matrix-vector product [s]. Calculations that take longer than
  !> `long_run` [s] are announced.
  real(wp), parameter :: an_entry = 3.0e-10_wp, long_run = 20
  !> How often a state that does not converge is tried, each time with a shorter step.
  integer, parameter :: attempts = 8
  !> Error of the first iterate of a state, in lengths L of the law.
  real(wp), parameter :: first_error = 0.1_wp

contains

  !> The advice on a scene and its problem. The advice on numerical choices of a sweep is that on
  !> its last case.
  function advice_on(scene, problem) result(advice)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(advice_t), allocatable :: advice(:)
    type(scene_t) :: last
    type(failure_t), allocatable :: error
    character(len=:), allocatable :: stiffness

    allocate (advice(0))
    stiffness = advice_on_stiffness(problem)
    if (stiffness /= '') call add(advice, stiffness)
    if (.not. prescribes_numerics(scene)) return
    if (allocated(scene%sweep)) then
      call swept_scene(scene, scene%sweep%names, scene%sweep%last(), last, error)
      if (.not. allocated(error)) call advise(last, scene%sweep%cases(), advice)
    else
      call advise(scene, 1, advice)
    end if
  end function advice_on

  !> Advice on bodies so soft that adhesion alone draws them into each other, whose paths may take
  !> minutes. In this case the modulus may have a wrong unit. The text is empty for other bodies.
  pure function advice_on_stiffness(problem) result(text)
    type(problem_t), intent(in) :: problem
    character(len=:), allocatable :: text
    real(wp) :: slope
    !> absurd: slope at the contact edge without load, far above all slopes for which the model is
    !> valid. short: ratio of L to the radius above which no advice is given.
    real(wp), parameter :: absurd = 2, short = 0.1_wp

    text = ''
    if (problem%rigid .or. .not. problem%law%adhesion > 0) return
    ! If L is about as large as the radius, the deck uses dimensionless units.
    if (problem%length > short*problem%radius) return
    slope = problem%shape%slope(largest_radius(problem, 1.0_wp, 1.0_wp))*problem%length/ &
      problem%lateral
    if (slope > absurd) text = 'beyond the model: with a stiffness of ' // &
      rounded(problem%stiffness) // ' Pa adhesion alone makes a contact with a slope of ' // &
      rounded(slope) // ' at its edge; moduli of a deck are in Pa: 70 GPa are 70e9'
  end function advice_on_stiffness

  !> Whether the deck or its sweep may choose a fixed grid or mixing. The default choices need no
  !> advice, and the problem is then not made.
  pure logical function prescribes_numerics(scene) result(prescribes)
    type(scene_t), intent(in) :: scene

    prescribes = scene%numerics%grid /= 'auto' .or. index(scene%numerics%method, 'mixing') > 0
    if (allocated(scene%sweep)) &
      prescribes = prescribes .or. index(scene%sweep%names, 'numerics.') > 0
  end function prescribes_numerics

  !> Gives advice on one scene. cases: number of cases of its sweep.
  subroutine advise(scene, cases, advice)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: cases
    type(advice_t), allocatable, intent(inout) :: advice(:)
    type(problem_t) :: problem
    type(choice_t) :: chosen
    real(wp) :: spacing

    if (.not. allocated(scene%loading) .or. allocated(scene%drive)) return
    problem = problem_of(scene)
    if (problem%rigid) return
    chosen = choose(scene, problem)
    ! Without contact there is neither a stiff contact nor a cohesive zone.
    if (.not. chosen%is_fixed() .or. chosen%low > max(1.0_wp, yielding_gap(problem, 1.0_wp))) return
    if (chosen%grid == uniform .and. problem%law%adhesion > 0) then
      spacing = chosen%extent/(chosen%nodes - 1)
      if (spacing_over_neck(problem, spacing) > comfortable) call add(advice, 'nodes are ' // &
        rounded(spacing*problem%lateral) // ' m apart, ' // &
        rounded(spacing_over_neck(problem, spacing)) // ' widths of the cohesive zone: the ' // &
        'contact edge will be pinned between them, and the pull-off too large; about ' // &
        brief(nodes_for(comfortable*neck_width(problem), chosen%extent)) // &
        ' nodes resolve it, or grid = ''auto''')
    end if
    if (chosen%options%mixing) &
      call advise_on_mixing(problem, chosen, states_planned(scene)*real(cases, wp), advice)
  end subroutine advise

  subroutine advise_on_mixing(problem, chosen, states, advice)
    type(problem_t), intent(in) :: problem
    type(choice_t), intent(in) :: chosen
    real(wp), intent(in) :: states
    type(advice_t), allocatable, intent(inout) :: advice(:)
    type(spectrum_t) :: spectrum
    real(wp) :: iterations, took
    character(len=:), allocatable :: which

    spectrum = spectrum_of(problem, chosen%low)
    iterations = iterations_of(spectrum, chosen%options%mixing_limit, chosen%options%tolerance)
    took = states*min(iterations, real(chosen%options%most_iterations, wp))* &
      real(chosen%nodes, wp)**2*an_entry
    which = 'in contact mixing needs about ' // rounded(iterations) // ' iterations for a ' // &
      'state (the eigenvalues of 1 - W p'' are from ' // rounded(spectrum%least) // ' to ' // &
      rounded(spectrum%largest) // ')'
    if (iterations > chosen%options%most_iterations) then
      took = attempts*took
      if (chosen%options%stop_on_change) then
        which = which // ', and will stop on a small change long before'
      else if (chosen%options%is_plain_mixing()) then
        which = which // ', more than max_iterations = ' // brief(chosen%options%most_iterations) &
          // ': states will not converge, which takes up to ' // duration(took)
      else
        which = which // ', more than max_iterations = ' // brief(chosen%options%most_iterations) &
          // ': after a jump, which begins with mixing, states will not converge, which takes ' // &
          'up to ' // duration(took)
      end if
      call add(advice, which // '; method = ''auto'' needs a few')
    else if (took > long_run .and. chosen%options%is_plain_mixing()) then
      call add(advice, which // ', about ' // duration(took) // ' in all; method = ' // &
        '''anderson_mixing'' or ''auto'' need far fewer')
    end if
  end subroutine advise_on_mixing

  !> Estimates the eigenvalues for an H0 at which the bodies are in contact. The pressure at the
  !> centre of the contact is that of JKR or Hertz theory. If the slope of the law varied as the
  !> pressure of Hertz theory, the row of -W p' on the axis would have the sum pi coupling a |p'|,
  !> and no eigenvalue exceeds this sum. The edge moves nearly freely: the narrower the cohesive
  !> zone, the smaller the eigenvalue.
  type(spectrum_t) function spectrum_of(problem, h0) result(spectrum)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0
    type(bracket_t) :: gap
    real(wp) :: level, a, coupling, adhesion, pressure, touching, at(1)

    level = 1
    adhesion = max(problem%law%adhesion, 0.0_wp)
    if (.not. adhesion > 0) level = contact_level(problem)
    a = largest_radius(problem, h0, level)
    coupling = max(problem%coupling, coupling_over(problem, a))
    pressure = (max(level - h0, 0.0_wp) + sqrt(4*pi*coupling*adhesion*a))/(pi*coupling*a) - &
      sqrt(adhesion/(pi*coupling*a))
    touching = problem%law%edge_gap
    if (.not. adhesion > 0) touching = problem%law%range + 500
    gap = bracket_t(problem%law%smallest_gap, touching)
    do while (gap%is_open())
      at = problem%law%pressure([gap%middle()])
      call gap%narrow(at(1) > pressure)
    end do
    at = problem%law%slope([gap%middle()])
    spectrum%largest = 1 + pi*coupling*a*max(-at(1), 0.0_wp)
    if (adhesion > 0) spectrum%least = 1/(1 + 1/cohesive_width(problem))
  end function spectrum_of

  !> Number of iterations with mixing that reduce the first error to the tolerance.
  pure real(wp) function iterations_of(spectrum, limit, tolerance) result(iterations)
    type(spectrum_t), intent(in) :: spectrum
    real(wp), intent(in) :: limit, tolerance

    iterations = log(max(first_error/tolerance, 2.0_wp))/ &
      (spectrum%least*min(limit, 2/spectrum%largest, 1.0_wp))
  end function iterations_of

  !> Number of nodes that have this spacing over the extent of a grid.
  pure integer function nodes_for(spacing, extent)
    real(wp), intent(in) :: spacing, extent

    nodes_for = ceiling(min(extent/spacing, real(huge(1)/2, wp))) + 1
  end function nodes_for

  pure subroutine add(advice, text)
    type(advice_t), allocatable, intent(inout) :: advice(:)
    character(len=*), intent(in) :: text
    ! Not by a structure constructor: compiler note 1.
    type(advice_t) :: new

    new%text = text
    advice = [advice, new]
  end subroutine add

end module forecast
