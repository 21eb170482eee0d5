!> Runs a loading, and an unloading from each of its turning points. Branches are computed by a
!> stepper (`one_run`) or, for rigid bodies, by integrals (`rigid_bodies`).
module loading_cycle
  use kinds, only: wp
  use force_law, only: force_law_t
  use experiment_request, only: request_t
  use ending, only: turn_not_reached
  use h0_schedule, only: h0_schedule_t, loading_plan, unloading_plan, thinned
  use places, only: places_t
  use records, only: branch_t
  implicit none
  private
  public :: branches_t, run_cycle

  !> What computes the branches of a cycle. from: the turning points (law's lengths), which the plan
  !> of the loading contains.
  type, abstract :: branches_t
    real(wp), allocatable :: from(:)
  contains
    procedure(run_one), deferred :: run_branch
  end type branches_t

  abstract interface
    !> Runs the loading (k = 0), or unloading k, through plan%h0, and enters its places. reached =
    !> .false.: the loading did not reach the turning point.
    subroutine run_one(self, plan, k, branch, places, reached)
      import :: branches_t, h0_schedule_t, branch_t, places_t
      class(branches_t), intent(inout) :: self
      type(h0_schedule_t), intent(in) :: plan
      integer, intent(in) :: k
      type(branch_t), intent(out) :: branch
      type(places_t), intent(inout) :: places
      logical, intent(out) :: reached
    end subroutine run_one
  end interface

contains

  !> Runs the loading, then the unloadings. rows: whether all rows are wanted, or only those at
  !> which numbers are read.
  subroutine run_cycle(branches, request, law, rows, loading, unloading, places)
    class(branches_t), intent(inout) :: branches
    class(request_t), intent(in) :: request
    class(force_law_t), intent(in) :: law
    logical, intent(in) :: rows
    type(branch_t), allocatable, intent(out) :: loading, unloading(:)
    type(places_t), intent(inout) :: places
    type(h0_schedule_t) :: plan
    integer :: k
    logical :: reached

    if (allocated(branches%from)) deallocate (branches%from)
    allocate (branches%from(0))
    if (allocated(request%unloading)) branches%from = law%gap_of(request%unloading%from)
    allocate (loading)
    plan = loading_plan(request, law, branches%from)
    if (.not. rows) plan = thinned(plan, branches%from)
    call branches%run_branch(plan, 0, loading, places, reached)
    ! If the path was traced, its jumps are exact and were entered before.
    if (allocated(loading%jump) .and. .not. places%has('jump_in')) &
      call places%enter('jump_in', 1, loading%jump)
    if (allocated(request%unloading)) allocate (unloading(size(branches%from)))
    do k = 1, size(branches%from)
      associate (branch => unloading(k))
        plan = unloading_plan(request, law, k)
        if (.not. rows) plan = thinned(plan, plan%h0(:0))
        call branches%run_branch(plan, k, branch, places, reached)
        if (.not. reached) branch%ending%cause = turn_not_reached
        ! An argument that is not allocated counts as absent.
        call places%enter('unload_max_tension', k, branch%lowest)
        call places%enter('unload_jump_out', k, branch%jump)
        if (allocated(branch%jump) .and. .not. places%has('jump_out')) &
          call places%enter('jump_out', 1, branch%jump)
      end associate
    end do
  end subroutine run_cycle

end module loading_cycle
