!> The fit of several curves together: shared unknowns have one value for all curves, the others
!> have one value for each curve. Each curve is first fitted alone, which determines its noise,
!> outliers and jumps. Curves that the model does not describe alone are left out of the joint fit.
module joint_fit
  use kinds, only: wp
  use text, only: counted, rounded
  use progress_observer, only: progress_observer_t
  use variation, only: problem_family_t
  use experiment_request, only: numerics_t
  use fit_request, only: fit_t, unknown_t, of_radius
  use force_model, only: force_model_t
  use curve_models, only: curve_models_t
  use curve_residuals, only: curve_residuals_t
  use joint_residuals, only: joint_residuals_t, join
  use joint_search, only: search_all, agree
  use fit_errors, only: fitted_t, find_errors, examine_curve
  use significance, only: negligible
  use wider_errors, only: widen
  use mesh_refinement, only: too_much
  use fit_run, only: fit_outcome_t, examine_fit
  implicit none
  private
  public :: joint_curve_t, joint_fit_t, fit_jointly

  !> A curve: its problems and request as in `run_fit`, whether its bodies attract each other, and
  !> the fit of this curve alone. The curve takes part in the joint fit if the model describes it
  !> alone, since only then its noise is known. Its part of the joint fit then replaces the fit
  !> alone.
  type :: joint_curve_t
    class(problem_family_t), allocatable :: family, wider
    type(fit_t) :: fit
    type(numerics_t) :: numerics
    logical :: attracts = .true., takes_part = .false.
    type(fit_outcome_t) :: outcome
    type(curve_models_t) :: models
  end type joint_curve_t

  !> The result. trouble: the reason why there is no joint fit. unknown, fitted: the shared unknowns
  !> and their part of the fit, with chi squared and degrees of freedom of all curves. curves: the
  !> number of curves that take part. alone: the sum of chi squared over the fits of each curve
  !> alone, in which each curve has its own values of the shared unknowns. spared: by how many fewer
  !> values the joint fit has. doubt: a warning about the joint fit.
  type :: joint_fit_t
    character(len=:), allocatable :: trouble, doubt
    type(unknown_t), allocatable :: unknown(:)
    type(fitted_t) :: fitted
    integer :: curves = 0, spared = 0
    real(wp) :: alone = 0
  end type joint_fit_t

  !> Largest number of searches that continue from smaller residuals found with the errors.
  integer, parameter :: most_looks = 3

contains

  !> Fits the curves that take part together.
  subroutine fit_jointly(curves, observer, joint)
    type(joint_curve_t), intent(inout), target :: curves(:)
    class(progress_observer_t), intent(inout) :: observer
    type(joint_fit_t), intent(out) :: joint
    type(joint_residuals_t) :: residuals
    type(fitted_t) :: fitted
    real(wp), allocatable :: residual(:)
    integer, allocatable :: taking(:)
    integer :: i, n

    call choose_curves(curves)
    taking = pack([(i, i=1, size(curves))], curves%takes_part)
    joint%curves = size(taking)
    if (joint%curves == 0) then
      joint%trouble = 'the model describes none of the curves alone'
      return
    end if
    call observer%hear('fitting the curves together')
    call gather(curves, taking, residuals, joint%alone)
    n = count(residuals%unknown%shared)
    joint%spared = n*(size(taking) - 1)
    joint%unknown = residuals%unknown(:n)
    call search_all(residuals, joint%alone, joint%spared, fitted%value, fitted%found)
    call finish(residuals, fitted, residual)
    if (.not. fitted%found) then
      joint%trouble = 'no search from the fits of single curves ended in common values of ' // &
        'the shared parameters'
      return
    end if
    i = findloc(fitted%effect <= negligible, .true., 1)
    if (i > 0) then
      joint%trouble = residuals%unknown(i)%name // ' has no effect on these curves near the ' // &
        'best value found, ' // rounded(fitted%value(i))
      return
    end if
    call doubt_agreement(fitted%chi_squared, fitted%freedom, joint)
    joint%fitted = fitted%part_of([(i, i=1, n)], residual, 0, 0)
    joint%fitted%freedom = fitted%freedom
    joint%fitted%lack%excess = -huge(1.0_wp)
    do i = 1, size(taking)
      call take_part(curves(taking(i)))
    end do

  contains

    !> Replaces the fit of curve i alone by its part of the joint fit.
    subroutine take_part(curve)
      type(joint_curve_t), intent(inout) :: curve

      associate (own => residuals%part(i), before => residuals%before(i))
        associate (mine => residual(before + 1:before + own%rows()))
          curve%outcome%fitted = fitted%part_of(residuals%place(:, i), mine, before, own%removed())
          call examine_curve(own, mine, curve%outcome%fitted)
        end associate
        if (allocated(joint%doubt)) curve%outcome%of_all = joint%doubt
        curve%outcome%resolved = curve%models%path%left_out <= too_much*curve%numerics%accuracy
        call examine_fit(own, curve%fit, curve%family, curve%wider, curve%outcome)
        if (curve%outcome%fitted%lack%excess > joint%fitted%lack%excess) &
          joint%fitted%lack = curve%outcome%fitted%lack
      end associate
    end subroutine take_part

  end subroutine fit_jointly

  !> Chooses the curves that the model describes when they are fitted alone.
  pure subroutine choose_curves(curves)
    type(joint_curve_t), intent(inout) :: curves(:)
    integer :: i

    do i = 1, size(curves)
      associate (outcome => curves(i)%outcome)
        if (.not. allocated(outcome%trouble)) &
          curves(i)%takes_part = outcome%fitted%found .and. outcome%fitted%lack%is_noise()
      end associate
    end do
  end subroutine choose_curves

  !> Makes the residuals of the curves with the indices `taking`, each with a model of its own.
  !> alone: the sum of chi squared over the fits of these curves alone.
  subroutine gather(curves, taking, residuals, alone)
    type(joint_curve_t), intent(inout), target :: curves(:)
    integer, intent(in) :: taking(:)
    type(joint_residuals_t), intent(out) :: residuals
    real(wp), intent(out) :: alone
    type(curve_residuals_t) :: part(size(taking))
    real(wp) :: start(size(curves(taking(1))%outcome%fitted%value), size(taking))
    class(force_model_t), pointer :: model
    integer :: i

    alone = 0
    do i = 1, size(taking)
      associate (curve => curves(taking(i)))
        call curve%models%set(curve%family, curve%numerics, curve%attracts, &
          curve%outcome%curve%data%measured%has(of_radius), model)
        part(i)%curve = curve%outcome%curve
        call part(i)%curve%use_model(model)
        start(:, i) = curve%outcome%fitted%value
        alone = alone + curve%outcome%fitted%chi_squared
      end associate
    end do
    call join(part, start, residuals)
  end subroutine gather

  !> Finds the errors of the values and the residuals at the values. If smaller residuals are found
  !> some standard errors away, the search continues from there.
  subroutine finish(residuals, fitted, residual)
    type(joint_residuals_t), intent(inout) :: residuals
    type(fitted_t), intent(inout) :: fitted
    real(wp), allocatable, intent(out) :: residual(:)
    real(wp), allocatable :: better(:)
    real(wp) :: left
    logical :: found
    integer :: look

    allocate (residual(residuals%rows()))
    do look = 0, most_looks
      call find_errors(residuals, fitted, residual, found)
      if (.not. found) return
      if (look == most_looks) then
        call widen(residuals, fitted)
        return
      end if
      call widen(residuals, fitted, better)
      if (.not. allocated(better)) return
      fitted%value = better
      call residuals%descend(fitted%value, left, fitted%found)
    end do
  end subroutine finish

  !> Warns if the curves contradict each other about the values that they share.
  subroutine doubt_agreement(chi_squared, freedom, joint)
    real(wp), intent(in) :: chi_squared
    integer, intent(in) :: freedom
    type(joint_fit_t), intent(inout) :: joint

    if (agree(chi_squared, joint%alone, freedom, joint%spared)) return
    joint%doubt = 'the curves disagree about the shared parameters: chi squared is ' // &
      rounded(chi_squared) // ', that of each curve with its own values ' // &
      rounded(joint%alone) // ', with ' // counted(joint%spared, 'number') // ' more'
  end subroutine doubt_agreement

end module joint_fit
