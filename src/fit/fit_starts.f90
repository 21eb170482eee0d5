!> Starting values of a model's unknowns: the deck's values, and values with the work of adhesion,
!> the plane-strain modulus and the range of the force that the data and the classical theories
!> suggest. If bodies do not attract each other, only the modulus is adapted.
module fit_starts
  use kinds, only: wp
  use failure, only: failure_t
  use linear_algebra, only: factorisation_t, factorise, solve
  use dimensionless_problem, only: problem_t, surface_energy, largest_tension
  use variation, only: problem_family_t
  use fit_request, only: unknown_t, of_model, farthest_off, settled_within, change
  implicit none
  private
  public :: character_t, character_of, starts_like

  !> Work of adhesion [J/m^2], plane-strain modulus (`stiffness`) [Pa], and range of the force [m],
  !> defined as the work over the largest tensile stress.
  type :: character_t
    real(wp) :: work = 0, stiffness = 0, range = 0
  end type character_t

  !> Largest number of steps of the secant method. Starts whose logarithms differ by less than
  !> `alike` are the same.
  integer, parameter :: steps = 6
  real(wp), parameter :: alike = 0.05_wp
  !> Damping of the steps; without it, unknowns with hardly any effect would move far.
  real(wp), parameter :: damping = 1.0e-4_wp

contains

  !> The character of a problem. The range is 0 for a force law without a largest tension.
  pure type(character_t) function character_of(problem) result(character)
    type(problem_t), intent(in) :: problem
    real(wp) :: tension

    character%work = surface_energy(problem)
    character%stiffness = problem%stiffness
    tension = largest_tension(problem)
    if (tension > 0) character%range = character%work/tension
  end function character_of

  !> Starting values, (unknown, start). The first start has the deck's values. Each other start has
  !> the character `wanted(i)`, with the smallest change from the deck's values.
  subroutine starts_like(wanted, family, unknown, start)
    type(character_t), intent(in) :: wanted(:)
    class(problem_family_t), intent(in) :: family
    type(unknown_t), intent(in) :: unknown(:)
    real(wp), allocatable, intent(out) :: start(:, :)
    real(wp), dimension(size(unknown)) :: value, varied
    real(wp) :: own(3), other(3), by(3, size(unknown))
    logical :: found, new
    integer :: i, k, n

    n = size(unknown)
    start = reshape(unknown%value, [n, 1])
    call traits(unknown%value, own)
    if (.not. found) return
    by = 0
    do k = 1, n
      if (unknown(k)%role /= of_model .or. .not. unknown(k)%in_log) cycle
      varied = unknown%value
      varied(k) = varied(k)*exp(change)
      call traits(varied, other)
      if (found) by(:, k) = (other - own)/change
    end do
    do i = 1, size(wanted)
      call move_to(wanted(i))
      if (.not. found) cycle
      new = .true.
      do k = 1, size(start, 2)
        new = new .and. any(unknown%in_log .and. abs(value - start(:, k)) > alike*abs(value))
      end do
      if (new) start = reshape([start, value], [n, size(start, 2) + 1])
    end do

  contains

    !> Finds the values whose problem has the wanted character and whose logarithms are nearest to
    !> those of the deck's values. own: the traits of the deck's problem. by: the derivatives of the
    !> traits, which each step updates (Broyden, 1965).
    subroutine move_to(wanted)
      type(character_t), intent(in) :: wanted
      type(factorisation_t) :: square
      real(wp) :: now(3), next(3), missing(3), slope(3, size(unknown)), step(size(unknown)), low, &
        high
      integer :: i, k

      value = unknown%value
      now = own
      slope = by
      do i = 1, steps
        missing = logarithms(wanted) - now
        square%lu = matmul(slope, transpose(slope))
        do k = 1, 3
          square%lu(k, k) = square%lu(k, k) + damping
        end do
        call factorise(square)
        found = square%valid
        if (.not. found) return
        call solve(square, missing)
        step = max(-2.0_wp, min(2.0_wp, matmul(missing, slope)))
        do k = 1, size(unknown)
          if (.not. unknown(k)%in_log) cycle
          ! A start lies well within the limits of the search.
          low = unknown(k)%value*exp(0.5_wp - farthest_off)
          high = unknown(k)%value*exp(farthest_off - 0.5_wp)
          if (allocated(unknown(k)%lower)) low = max(low, unknown(k)%lower)
          if (allocated(unknown(k)%upper)) high = min(high, unknown(k)%upper)
          step(k) = log(max(low, min(high, value(k)*exp(step(k))))/value(k))
        end do
        value = value*exp(step)
        if (maxval(abs(step)) <= settled_within) return
        call traits(value, next)
        if (.not. found) return
        do k = 1, 3
          slope(k, :) = slope(k, :) + &
            (next(k) - now(k) - dot_product(slope(k, :), step))*step/sum(step**2)
        end do
        now = next
      end do
    end subroutine move_to

    !> The traits of a problem, which are the logarithms of its character, for values of the
    !> unknowns.
    subroutine traits(value, trait)
      real(wp), intent(in) :: value(:)
      real(wp), intent(out) :: trait(3)
      type(problem_t) :: problem
      type(failure_t), allocatable :: error

      trait = 0
      call family%pose(pack(value, unknown%role == of_model), problem, error)
      found = .not. allocated(error)
      if (found) found = surface_energy(problem) > 0 .or. .not. problem%law%adhesion > 0
      if (found) trait = logarithms(character_of(problem))
    end subroutine traits

  end subroutine starts_like

  pure function logarithms(character) result(trait)
    type(character_t), intent(in) :: character
    real(wp) :: trait(3)

    trait = log(max([character%work, character%stiffness, character%range], tiny(1.0_wp)))
  end function logarithms

end module fit_starts
