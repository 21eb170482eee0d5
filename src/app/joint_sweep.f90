!> A sweep whose curves are fitted together, in one process: each is fitted alone, then all that the
!> model describes. The rows are written at the end.
module joint_sweep
  use failure, only: failure_t
  use scene_groups, only: scene_t
  use deck_family, only: deck_family_t, widened
  use fit_group, only: family_of_fit
  use curve_index, only: curve_index_t
  use fit_columns, only: described, not_described
  use fit_doubts, only: doubts_of
  use joint_fit, only: joint_curve_t, joint_fit_t, fit_jointly
  use joint_rows, only: joint_text
  use sweep_case, only: case_t, case_observer_t
  use case_fit, only: fitted_case_t, fit_case, finish_case
  use case_queue, only: case_queue_t
  implicit none
  private
  public :: fit_together

contains

  !> Fits all curves of the queue together, and enters their rows. A curve that takes no part has
  !> the row of its fit alone.
  subroutine fit_together(scene, queue, joint)
    type(scene_t), intent(in) :: scene
    type(case_queue_t), intent(inout) :: queue
    type(joint_fit_t), intent(out) :: joint
    type(case_t), allocatable :: case(:)
    type(fitted_case_t), allocatable :: fitted(:)
    type(joint_curve_t), allocatable :: curve(:)
    type(case_observer_t) :: observer
    type(curve_index_t) :: index
    logical :: found
    integer :: i

    allocate (case(scene%sweep%cases()))
    allocate (fitted(size(case)), curve(size(case)))
    index = scene%sweep%index
    do i = 1, size(case)
      call queue%next(case(i), found)
      if (.not. found) return
      call fit_case(scene, queue%results%progress, index, case(i), fitted(i))
      call take_curve(fitted(i), curve(i))
      call finish_case(scene, fitted(i), case(i))
      ! The others start from the first that is described.
      if (case(i)%verdict == described .and. .not. allocated(queue%like)) &
        queue%like = fitted(i)%outcome%fitted%value
    end do
    observer%case = 1
    observer%progress => queue%results%progress
    call fit_jointly(curve, observer, joint)
    do i = 1, size(case)
      call take_row(curve(i), fitted(i), case(i))
      call queue%enter(case(i))
    end do
    if (.not. allocated(joint%trouble)) &
      call queue%results%write_text('fit.nml', joint_text(joint, scene%title))

  contains

    !> Makes the row of a curve.
    subroutine take_row(curve, fitted, case)
      type(joint_curve_t), intent(inout) :: curve
      type(fitted_case_t), intent(inout) :: fitted
      type(case_t), intent(inout) :: case
      character(len=:), allocatable :: text

      if (.not. curve%takes_part) then
        text = 'not fitted together with the others: ' // trim(case%warning)
        if (case%verdict == not_described) case%warning = text
      else if (allocated(joint%trouble)) then
        case%converged = .false.
        case%failure = 'no fit of all curves: ' // joint%trouble
      else
        fitted%outcome = curve%outcome
        call finish_case(scene, fitted, case)
      end if
    end subroutine take_row

  end subroutine fit_together

  !> Makes a curve of the joint fit from its fit alone.
  subroutine take_curve(fitted, curve)
    type(fitted_case_t), intent(in) :: fitted
    type(joint_curve_t), intent(out) :: curve
    type(deck_family_t) :: family
    type(failure_t), allocatable :: error

    curve%outcome = fitted%outcome
    if (.not. fitted%readable) return
    ! The deck was read, so that the family has no mistake.
    call family_of_fit(fitted%scene%deck, family, error)
    allocate (curve%family, source=family)
    allocate (curve%wider, source=widened(family))
    curve%fit = fitted%scene%fit
    curve%numerics = fitted%scene%numerics
    curve%attracts = fitted%problem%law%adhesion > 0
  end subroutine take_curve

end module joint_sweep
