!> The energy lost in the jumps of an experiment at controlled h0: the difference of potential
!> energy between the fold that a jump starts from and the state that it ends in. Over a closed
!> cycle it is the area between the ways out and back.
module hysteresis
  use kinds, only: wp
  use equilibrium, only: equations_t
  use known_path, only: known_path_t, landing_t
  use potential_energy, only: energy_of
  implicit none
  private
  public :: lost_energy_t, energy_lost

  !> Lost energy, the same on the finer mesh of the error estimate, and what rounding leaves; in
  !> units of load times length. The folds that the jumps start from.
  type :: lost_energy_t
    real(wp) :: energy = 0, fine_energy = 0, rounding = 0
    integer, allocatable :: fold(:)
  end type lost_energy_t

contains

  !> Adds what is lost in the jumps that lead from the stable piece `from` to the piece `to`, h0
  !> going no lower than `lowest`; whole = .false. where no jumps lead there.
  subroutine energy_lost(equations, known, from, to, lowest, lost, whole)
    type(equations_t), intent(in) :: equations
    type(known_path_t), intent(in) :: known
    integer, intent(in) :: from, to
    real(wp), intent(in) :: lowest
    type(lost_energy_t), intent(inout) :: lost
    logical, intent(out) :: whole
    integer :: k

    if (.not. allocated(lost%fold)) allocate (lost%fold(0))
    k = from
    do while (k /= to)
      if (to > k) then
        call add(known%inward(k))
      else
        call add(known%outward(k))
      end if
      if (.not. whole) return
    end do
    whole = .true.

  contains

    subroutine add(landing)
      type(landing_t), intent(in) :: landing
      real(wp) :: before, after, uncertainty(2)

      whole = landing%piece > 0 .and. landing%converged
      ! Beyond where it was to lead: another way.
      if (whole) whole = (landing%piece - to)*(k - to) >= 0
      if (.not. whole) return
      associate (fold => known%path%point(landing%fold))
        whole = fold%state%h0 >= lowest
        call energy_of(equations, fold%mesh, fold%state, before, uncertainty(1))
        call energy_of(equations, landing%mesh, landing%state, after, uncertainty(2))
        lost%energy = lost%energy + (before - after)
        if (allocated(fold%fine) .and. allocated(landing%fine)) &
          lost%fine_energy = lost%fine_energy + (fold%fine%energy - landing%fine%energy)
        lost%rounding = lost%rounding + sum(uncertainty)
        lost%fold = [lost%fold, landing%fold]
      end associate
      k = landing%piece
    end subroutine add

  end subroutine energy_lost

end module hysteresis
