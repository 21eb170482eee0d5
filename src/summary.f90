!> The summary of a run as namelist groups: &summary, &cost, and the deck as resolved, so that the
!> file can be run again. gfortran, f90nml and this program read it.
module summary
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kinds, only: wp
  use failure, only: failure_t, fail, file_trouble
  use deck, only: deck_t
  use equilibrium, only: cost_t
  use assignments, only: line_t, assignment_of
  implicit none
  private
  public :: summary_t, summary_text, resolved_text, number_columns, numbers_of

  !> More warnings than this are not read.
  integer, parameter :: most_warnings = 20

  !> What a run found, SI units; what is not allocated, or empty, is absent from the file. Where one
  !> value of an array does not exist, such as the jump out of an unloading without one, it is NaN.
  type :: summary_t
    character(len=:), allocatable :: title, version
    !> Whether every equation was solved as asked for.
    logical, allocatable :: converged
    !> Dimensionless; [J/m^2]; loads [N].
    real(wp), allocatable :: sigma, tabor, big_lambda, surface_energy, jkr_pull_off, dmt_pull_off
    !> Positive [N], and where [m].
    real(wp), allocatable :: max_tension, max_tension_h0
    !> Folds in h0 [m], the load [N] there and, from a cycle, how well h0 is known [m].
    real(wp), allocatable :: jump_in_h0, jump_in_load, jump_in_uncertainty
    real(wp), allocatable :: jump_out_h0, jump_out_load, jump_out_uncertainty
    !> One a turning point: [m], [N], [m], [m].
    real(wp), allocatable :: unload_from(:), unload_max_tension(:), unload_max_tension_h0(:), &
      unload_jump_out_h0(:)
    !> All folds in h0 along the path ([m], [N], whether what follows is stable: 1 or 0), and all
    !> extrema of the load.
    real(wp), allocatable :: folds_h0(:), folds_load(:)
    integer, allocatable :: folds_stable(:)
    real(wp), allocatable :: load_folds_h0(:), load_folds_load(:)
    !> In a cycle [J].
    real(wp), allocatable :: energy_lost, energy_lost_uncertainty
    !> In units of the law's length; dimensionless; whether that is fine enough; relative.
    real(wp), allocatable :: worst_residual, spacing_over_neck
    logical, allocatable :: resolved
    real(wp), allocatable :: error_estimate
    !> What was chosen where the deck says 'auto', and why; what the program is made of.
    character(len=:), allocatable :: grid, method, chosen_because, compiler, blas, build_options
    type(line_t), allocatable :: warnings(:)
    !> Written into &cost, beside what `cost_t` counts.
    real(wp), allocatable :: wall_seconds
    integer, allocatable :: nodes, threads
  contains
    procedure :: warn
  end type summary_t

  !> What `numbers_of` returns, as columns of a table.
  character(len=*), parameter :: number_columns(*) = [character(len=72) :: &
    'sigma [] parameter (40) of the paper', &
    'tabor [] Tabor parameter', &
    'big_lambda [] parameter (39) of the paper', &
    'surface_energy [J/m^2]', &
    'jkr_pull_off [N]', &
    'dmt_pull_off [N]', &
    'max_tension [N] largest tension, positive', &
    'max_tension_h0 [m]', &
    'jump_in_h0 [m]', &
    'jump_in_load [N]', &
    'jump_out_h0 [m]', &
    'jump_out_load [N]', &
    'energy_lost [J] in a cycle', &
    'worst_residual [] in units of the length of the force law', &
    'spacing_over_neck []', &
    'error_estimate [] relative', &
    'resolved [] whether the mesh is fine enough, 1 or 0', &
    'converged [] whether every equilibrium was found, 1 or 0']

contains

  !> Adds a warning, one line; repeated ones and those beyond the twentieth are dropped.
  pure subroutine warn(self, text)
    class(summary_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    integer :: i

    if (.not. allocated(self%warnings)) allocate (self%warnings(0))
    if (size(self%warnings) == most_warnings) return
    do i = 1, size(self%warnings)
      if (self%warnings(i)%text == text) return
    end do
    self%warnings = [self%warnings, line_t(text)]
    if (size(self%warnings) == most_warnings) &
      self%warnings(most_warnings)%text = 'further warnings are not shown'
  end subroutine warn

  !> The groups &summary and &cost.
  pure function summary_text(self, cost) result(text)
    type(summary_t), intent(in) :: self
    type(cost_t), intent(in) :: cost
    character(len=:), allocatable :: text
    character(len=1), parameter :: nl = new_line('a')
    real(wp), allocatable :: kernel_seconds, solve_seconds, estimate_seconds

    kernel_seconds = cost%kernel_seconds
    solve_seconds = cost%solve_seconds
    estimate_seconds = cost%estimate_seconds
    text = '! Results of snapin, SI units. What does not exist is NaN or left out.' // nl // &
      '! The groups after the first two are the deck, defaults included: run it again.' // nl // &
      '&summary' // nl // &
      assignment_of('title', self%title) // &
      assignment_of('version', self%version) // &
      assignment_of('converged', self%converged) // &
      assignment_of('sigma', self%sigma) // &
      assignment_of('tabor', self%tabor) // &
      assignment_of('big_lambda', self%big_lambda) // &
      assignment_of('surface_energy', self%surface_energy) // &
      assignment_of('jkr_pull_off', self%jkr_pull_off) // &
      assignment_of('dmt_pull_off', self%dmt_pull_off) // &
      assignment_of('max_tension', self%max_tension) // &
      assignment_of('max_tension_h0', self%max_tension_h0) // &
      assignment_of('jump_in_h0', self%jump_in_h0) // &
      assignment_of('jump_in_load', self%jump_in_load) // &
      assignment_of('jump_in_uncertainty', self%jump_in_uncertainty) // &
      assignment_of('jump_out_h0', self%jump_out_h0) // &
      assignment_of('jump_out_load', self%jump_out_load) // &
      assignment_of('jump_out_uncertainty', self%jump_out_uncertainty)
    text = text // &
      assignment_of('unload_from', self%unload_from) // &
      assignment_of('unload_max_tension', self%unload_max_tension) // &
      assignment_of('unload_max_tension_h0', self%unload_max_tension_h0) // &
      assignment_of('unload_jump_out_h0', self%unload_jump_out_h0) // &
      assignment_of('folds_h0', self%folds_h0) // &
      assignment_of('folds_load', self%folds_load) // &
      assignment_of('folds_stable', self%folds_stable) // &
      assignment_of('load_folds_h0', self%load_folds_h0) // &
      assignment_of('load_folds_load', self%load_folds_load) // &
      assignment_of('energy_lost', self%energy_lost) // &
      assignment_of('energy_lost_uncertainty', self%energy_lost_uncertainty) // &
      assignment_of('worst_residual', self%worst_residual) // &
      assignment_of('spacing_over_neck', self%spacing_over_neck) // &
      assignment_of('resolved', self%resolved) // &
      assignment_of('error_estimate', self%error_estimate) // &
      assignment_of('grid', self%grid) // &
      assignment_of('method', self%method) // &
      assignment_of('chosen_because', self%chosen_because) // &
      assignment_of('compiler', self%compiler) // &
      assignment_of('blas', self%blas) // &
      assignment_of('build_options', self%build_options) // &
      assignment_of('warnings', self%warnings) // '/' // nl
    text = text // '&cost' // nl // &
      assignment_of('wall_seconds', self%wall_seconds) // &
      assignment_of('kernel_seconds', kernel_seconds) // &
      assignment_of('solve_seconds', solve_seconds) // &
      assignment_of('estimate_seconds', estimate_seconds) // &
      assignment_of('threads', self%threads) // &
      assignment_of('nodes', self%nodes) // &
      assignment_of('states', cost%states) // &
      assignment_of('iterations', cost%iterations) // &
      assignment_of('kernel_entries', cost%kernel_entries) // &
      assignment_of('pressure_evaluations', cost%pressure_evaluations) // &
      assignment_of('operator_products', cost%operator_products) // &
      assignment_of('operator_columns', cost%operator_columns) // &
      assignment_of('factorisations', cost%factorisations) // &
      assignment_of('rejected_steps', cost%rejected_steps) // '/' // nl
  end function summary_text

  !> The deck with every default written out. It passes through the file `scratch`, which remains,
  !> since a deck writes itself to a unit; a short one means that the disk was full.
  subroutine resolved_text(deck, scratch, text, error)
    type(deck_t), intent(in) :: deck
    character(len=*), intent(in) :: scratch
    character(len=:), allocatable, intent(out) :: text
    type(failure_t), allocatable, intent(out) :: error
    character(len=200) :: reason
    integer :: unit, status, length

    length = 1
    reason = ''
    open (newunit=unit, file=scratch, status='replace', action='write', access='stream', &
      form='formatted', iostat=status, iomsg=reason)
    if (status == 0) then
      call deck%write_resolved(unit, status)
      inquire (unit, pos=length)
      close (unit, iostat=status)
      open (newunit=unit, file=scratch, status='old', action='read', access='stream', &
        form='unformatted', iostat=status, iomsg=reason)
    end if
    allocate (character(len=length - 1) :: text)
    if (status == 0) then
      read (unit, iostat=status, iomsg=reason) text
      close (unit)
      if (is_iostat_end(status)) reason = 'No space left on device'
    end if
    if (status /= 0) call fail(error, file_trouble, 'cannot write ' // scratch // ': ' // &
      trim(reason) // '; make room there, or choose another folder with --out')
  end subroutine resolved_text

  !> The numbers of a summary in the order of `number_columns`; NaN for what does not exist.
  pure function numbers_of(self) result(values)
    type(summary_t), intent(in) :: self
    real(wp) :: values(size(number_columns))

    values = [or_nan(self%sigma), or_nan(self%tabor), or_nan(self%big_lambda), &
      or_nan(self%surface_energy), or_nan(self%jkr_pull_off), or_nan(self%dmt_pull_off), &
      or_nan(self%max_tension), or_nan(self%max_tension_h0), or_nan(self%jump_in_h0), &
      or_nan(self%jump_in_load), or_nan(self%jump_out_h0), or_nan(self%jump_out_load), &
      or_nan(self%energy_lost), or_nan(self%worst_residual), or_nan(self%spacing_over_neck), &
      or_nan(self%error_estimate), as_number(self%resolved), as_number(self%converged)]
  end function numbers_of

  pure real(wp) function or_nan(value)
    real(wp), intent(in), optional :: value

    or_nan = ieee_value(or_nan, ieee_quiet_nan)
    if (present(value)) or_nan = value
  end function or_nan

  pure real(wp) function as_number(value)
    logical, intent(in), optional :: value

    as_number = ieee_value(as_number, ieee_quiet_nan)
    if (present(value)) as_number = merge(1, 0, value)
  end function as_number

end module summary
