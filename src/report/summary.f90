!> The summary of a run as namelist groups: &summary, &cost, and the deck as resolved, so that the
!> file can be run again. gfortran, f90nml and this program read it.
module summary
  use kinds, only: wp
  use equilibrium, only: cost_t
  use namelist_writer, only: line_t, assignment_of
  implicit none
  private
  public :: summary_t, summary_text

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
    !> Maugis' parameter, and his pull-off, positive [N].
    real(wp), allocatable :: maugis_lambda, maugis_pull_off
    !> Positive [N], and where [m]. What ends in _error is the estimated error of the number before.
    real(wp), allocatable :: max_tension, max_tension_h0, max_tension_error, max_tension_h0_error
    !> Folds in h0 [m], the load [N] there and, from a cycle, how well h0 is known [m].
    real(wp), allocatable :: jump_in_h0, jump_in_load, jump_in_uncertainty, jump_in_h0_error, &
      jump_in_load_error
    real(wp), allocatable :: jump_out_h0, jump_out_load, jump_out_uncertainty, &
      jump_out_h0_error, jump_out_load_error
    !> One a turning point: [m], [N], [m], [m].
    real(wp), allocatable :: unload_from(:), unload_max_tension(:), unload_max_tension_h0(:), &
      unload_jump_out_h0(:), unload_max_tension_error(:), unload_max_tension_h0_error(:), &
      unload_jump_out_h0_error(:)
    !> All folds in h0 along the path ([m], [N], whether what follows is stable: 1 or 0), and all
    !> extrema of the load.
    real(wp), allocatable :: folds_h0(:), folds_load(:), folds_h0_error(:), folds_load_error(:)
    integer, allocatable :: folds_stable(:)
    real(wp), allocatable :: load_folds_h0(:), load_folds_load(:), load_folds_h0_error(:), &
      load_folds_load_error(:)
    !> The last equilibrium of the loading or, without one, of the path: [m], [m], [N].
    real(wp), allocatable :: end_h0, end_displacement, end_load, end_displacement_error, &
      end_load_error
    !> Of each profile, in the order in which they were computed: of gaps in the law's lengths, or
    !> of pressures over the largest, whichever is larger.
    real(wp), allocatable :: profiles_error(:)
    !> Where approaching bodies jump in the approximation of slow deformation, by the criteria of
    !> `jumps_t`: h0 [m], the load [N] there; and the gap (37) itself [m].
    real(wp), allocatable :: jump_criterion_29_h0, jump_criterion_29_load, jump_equation_37_h0, &
      jump_equation_37_load, jump_equation_37_gap, fold_closed_form_h0, fold_closed_form_load, &
      fold_attractive_only_h0, fold_attractive_only_load
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

contains

  !> Adds a warning, one line; repeated ones and those beyond the twentieth are dropped.
  pure subroutine warn(self, text)
    class(summary_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    type(line_t) :: line
    integer :: i

    if (.not. allocated(self%warnings)) allocate (self%warnings(0))
    if (size(self%warnings) == most_warnings) return
    do i = 1, size(self%warnings)
      if (self%warnings(i)%text == text) return
    end do
    ! A structure constructor inside an array constructor would leak in gfortran.
    line%text = text
    self%warnings = [self%warnings, line]
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
      assignment_of('maugis_lambda', self%maugis_lambda) // &
      assignment_of('maugis_pull_off', self%maugis_pull_off) // &
      assignment_of('max_tension', self%max_tension) // &
      assignment_of('max_tension_h0', self%max_tension_h0) // &
      assignment_of('max_tension_error', self%max_tension_error) // &
      assignment_of('max_tension_h0_error', self%max_tension_h0_error) // &
      assignment_of('jump_in_h0', self%jump_in_h0) // &
      assignment_of('jump_in_load', self%jump_in_load) // &
      assignment_of('jump_in_h0_error', self%jump_in_h0_error) // &
      assignment_of('jump_in_load_error', self%jump_in_load_error) // &
      assignment_of('jump_in_uncertainty', self%jump_in_uncertainty) // &
      assignment_of('jump_out_h0', self%jump_out_h0) // &
      assignment_of('jump_out_load', self%jump_out_load) // &
      assignment_of('jump_out_h0_error', self%jump_out_h0_error) // &
      assignment_of('jump_out_load_error', self%jump_out_load_error) // &
      assignment_of('jump_out_uncertainty', self%jump_out_uncertainty)
    text = text // &
      assignment_of('unload_from', self%unload_from) // &
      assignment_of('unload_max_tension', self%unload_max_tension) // &
      assignment_of('unload_max_tension_h0', self%unload_max_tension_h0) // &
      assignment_of('unload_jump_out_h0', self%unload_jump_out_h0) // &
      assignment_of('unload_max_tension_error', self%unload_max_tension_error) // &
      assignment_of('unload_max_tension_h0_error', self%unload_max_tension_h0_error) // &
      assignment_of('unload_jump_out_h0_error', self%unload_jump_out_h0_error) // &
      assignment_of('folds_h0', self%folds_h0) // &
      assignment_of('folds_load', self%folds_load) // &
      assignment_of('folds_stable', self%folds_stable) // &
      assignment_of('folds_h0_error', self%folds_h0_error) // &
      assignment_of('folds_load_error', self%folds_load_error) // &
      assignment_of('load_folds_h0', self%load_folds_h0) // &
      assignment_of('load_folds_load', self%load_folds_load) // &
      assignment_of('load_folds_h0_error', self%load_folds_h0_error) // &
      assignment_of('load_folds_load_error', self%load_folds_load_error) // &
      assignment_of('energy_lost', self%energy_lost) // &
      assignment_of('energy_lost_uncertainty', self%energy_lost_uncertainty) // &
      assignment_of('end_h0', self%end_h0) // &
      assignment_of('end_displacement', self%end_displacement) // &
      assignment_of('end_load', self%end_load) // &
      assignment_of('end_displacement_error', self%end_displacement_error) // &
      assignment_of('end_load_error', self%end_load_error) // &
      assignment_of('profiles_error', self%profiles_error)
    text = text // &
      assignment_of('jump_criterion_29_h0', self%jump_criterion_29_h0) // &
      assignment_of('jump_criterion_29_load', self%jump_criterion_29_load) // &
      assignment_of('jump_equation_37_h0', self%jump_equation_37_h0) // &
      assignment_of('jump_equation_37_load', self%jump_equation_37_load) // &
      assignment_of('jump_equation_37_gap', self%jump_equation_37_gap) // &
      assignment_of('fold_closed_form_h0', self%fold_closed_form_h0) // &
      assignment_of('fold_closed_form_load', self%fold_closed_form_load) // &
      assignment_of('fold_attractive_only_h0', self%fold_attractive_only_h0) // &
      assignment_of('fold_attractive_only_load', self%fold_attractive_only_load)
    text = text // &
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

end module summary
