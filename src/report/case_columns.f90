!> What a case of a sweep leaves in the table of all cases: a list of columns, which follows from
!> the deck, and one number a column, which follows from the summary of the case.
module case_columns
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kinds, only: wp
  use text, only: brief
  use scene_groups, only: scene_t
  use summary, only: summary_t
  implicit none
  private
  public :: columns_of, numbers_of

  integer, parameter :: width = 96

  !> In every sweep.
  character(len=*), parameter :: always(*) = [character(len=width) :: &
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
    'end_h0 [m] of the last equilibrium of the loading, or else of the path', &
    'end_displacement [m] there', &
    'end_load [N] there', &
    'energy_lost [J] in a cycle', &
    'worst_residual [] in units of the length of the force law', &
    'spacing_over_neck []', &
    'error_estimate [] relative', &
    'resolved [] whether the mesh is fine enough, 1 or 0', &
    'converged [] whether every equilibrium was found, 1 or 0']

  !> With &classical.
  character(len=*), parameter :: of_classical(*) = [character(len=width) :: &
    'maugis_lambda [] parameter of Maugis-Dugdale theory', &
    'maugis_pull_off [N] pull-off of Maugis-Dugdale theory']

  !> With &approximations.
  character(len=*), parameter :: of_approximations(*) = [character(len=width) :: &
    'jump_criterion_29_h0 [m] where approaching bodies violate (29)', &
    'jump_criterion_29_load [N] there', &
    'jump_equation_37_h0 [m] by (37), for the attraction alone', &
    'jump_equation_37_load [N] there', &
    'jump_equation_37_gap [m] separation (37) on the axis', &
    'fold_closed_form_h0 [m] least h0 of (35a)', &
    'fold_closed_form_load [N] there', &
    'fold_attractive_only_h0 [m] least h0 of (35b)', &
    'fold_attractive_only_load [N] there']

contains

  !> The columns of a sweep of this scene, each described as 'name [unit] what it is'.
  pure function columns_of(scene) result(columns)
    type(scene_t), intent(in) :: scene
    character(len=width), allocatable :: columns(:)
    character(len=:), allocatable :: number
    integer :: k, n

    n = size(always)
    if (allocated(scene%classical)) n = n + size(of_classical)
    if (allocated(scene%approximations)) n = n + size(of_approximations)
    if (allocated(scene%unloading)) n = n + 2*size(scene%unloading%from)
    ! Filled item by item: gfortran 12 overruns constructors of strings made on the way.
    allocate (columns(n))
    n = size(always)
    columns(:n) = always
    if (allocated(scene%classical)) then
      columns(n + 1:n + size(of_classical)) = of_classical
      n = n + size(of_classical)
    end if
    if (allocated(scene%approximations)) then
      columns(n + 1:n + size(of_approximations)) = of_approximations
      n = n + size(of_approximations)
    end if
    if (.not. allocated(scene%unloading)) return
    do k = 1, size(scene%unloading%from)
      number = brief(real(k, wp))
      columns(n + 2*k - 1) = 'unload_max_tension_' // number // ' [N] largest tension of ' // &
        'unloading_' // number
      columns(n + 2*k) = 'unload_jump_out_h0_' // number // ' [m] where it jumps apart'
    end do
  end function columns_of

  !> The numbers of a case's summary, one for each of `columns_of(scene)`; NaN for what does not
  !> exist.
  pure function numbers_of(summary, scene) result(values)
    type(summary_t), intent(in) :: summary
    type(scene_t), intent(in) :: scene
    real(wp), allocatable :: values(:)
    integer :: k

    associate (s => summary)
      values = [or_nan(s%sigma), or_nan(s%tabor), or_nan(s%big_lambda), or_nan(s%surface_energy), &
        or_nan(s%jkr_pull_off), or_nan(s%dmt_pull_off), or_nan(s%max_tension), &
        or_nan(s%max_tension_h0), or_nan(s%jump_in_h0), or_nan(s%jump_in_load), &
        or_nan(s%jump_out_h0), or_nan(s%jump_out_load), or_nan(s%end_h0), &
        or_nan(s%end_displacement), or_nan(s%end_load), or_nan(s%energy_lost), &
        or_nan(s%worst_residual), or_nan(s%spacing_over_neck), or_nan(s%error_estimate), &
        as_number(s%resolved), as_number(s%converged)]
      if (allocated(scene%classical)) values = [values, or_nan(s%maugis_lambda), &
        or_nan(s%maugis_pull_off)]
      if (allocated(scene%approximations)) values = [values, &
        or_nan(s%jump_criterion_29_h0), or_nan(s%jump_criterion_29_load), &
        or_nan(s%jump_equation_37_h0), or_nan(s%jump_equation_37_load), &
        or_nan(s%jump_equation_37_gap), or_nan(s%fold_closed_form_h0), &
        or_nan(s%fold_closed_form_load), or_nan(s%fold_attractive_only_h0), &
        or_nan(s%fold_attractive_only_load)]
      if (.not. allocated(scene%unloading)) return
      do k = 1, size(scene%unloading%from)
        values = [values, item(s%unload_max_tension, k), item(s%unload_jump_out_h0, k)]
      end do
    end associate
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

  !> An element of an array that a case which failed does not have.
  pure real(wp) function item(values, k)
    real(wp), intent(in), optional :: values(:)
    integer, intent(in) :: k

    item = ieee_value(item, ieee_quiet_nan)
    if (.not. present(values)) return
    ! A case may have fewer turning points than the deck.
    if (k <= size(values)) item = values(k)
  end function item

end module case_columns
