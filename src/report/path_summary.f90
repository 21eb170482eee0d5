!> What the equilibrium path leaves in the summary: its folds, extrema and largest tension.
module path_summary
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use reported, only: reported_t
  use path, only: path_t
  use ending_text, only: text_of
  use quality_warnings, only: short_number
  use summary, only: summary_t
  use summary_entries, only: take_jump, take_profiles, raise_tension, widen_spacing, h0_of, &
    load_of, h0_error_of, load_error_of, rates_of
  implicit none
  private
  public :: summarise_path

contains

  !> Enters a path, whose folds are exact: they take the place of what a stepped cycle brackets.
  subroutine summarise_path(problem, path, summary)
    type(problem_t), intent(in) :: problem
    type(path_t), intent(in) :: path
    type(summary_t), intent(inout) :: summary
    integer :: n

    call summary%set('worst_residual', max(summary%number('worst_residual'), path%worst_residual))
    call widen_spacing(summary, path%worst_spacing)
    if (path%ending%early()) call summary%fail_with('path: '//trim(text_of(path%ending)))
    if (path%fallen) call summary%warn('path: nothing keeps the bodies apart under this law: '// &
      'the path ends in their fall onto each other, and there is no state in contact')
    if (allocated(path%lowest)) then
      if (path%lowest%load < 0) call raise_tension(problem, path%lowest, summary)
    end if
    if (ends_before_contact(problem, path)) call summary%note('path: it ends at h0 = ' // &
      short_number(h0_of(problem, path%finish)) // ' m, before contact, with the largest tension ' &
      // 'in its last row; lower h0_end')
    call take_profiles(path%profile, summary)
    call summary%set('folds_stable', merge(1, 0, path%unstable_after == 0))
    call take_list(problem, 'folds', path%fold, summary)
    call take_list(problem, 'load_folds', path%extremum, summary)
    n = size(path%fold)
    if (n == 0) return
    ! What a stretch of the path begins with may be another fold.
    if (path%first_piece == 1) call take_jump(problem, 'jump_in', path%fold(1), 0.0_wp, summary)
    if (path%unstable_after(n) == 0) &
      call take_jump(problem, 'jump_out', path%fold(n), 0.0_wp, summary)
  end subroutine summarise_path

  !> Whether bodies that would touch farther in have not come to that, and the tension still grows.
  pure logical function ends_before_contact(problem, path)
    type(problem_t), intent(in) :: problem
    type(path_t), intent(in) :: path

    ends_before_contact = problem%law%rest_gap > 0 .and. .not. path%fallen .and. &
      .not. path%extent%contact_radius > 0 .and. allocated(path%lowest) .and. &
      allocated(path%finish)
    if (ends_before_contact) &
      ends_before_contact = abs(path%lowest%h0 - path%finish%h0) <= 0 .and. path%lowest%load < 0
  end function ends_before_contact

  !> States in the order of the path, under the keys that begin with `name`.
  subroutine take_list(problem, name, list, summary)
    type(problem_t), intent(in) :: problem
    character(len=*), intent(in) :: name
    type(reported_t), intent(in) :: list(:)
    type(summary_t), intent(inout) :: summary
    integer :: k

    call summary%set(name//'_h0', [(h0_of(problem, list(k)), k=1, size(list))])
    call summary%set(name//'_load', [(load_of(problem, list(k)), k=1, size(list))])
    associate (rates => rates_of(list))
      call summary%set_rate(name//'_h0', rates%h0)
      call summary%set_rate(name//'_load', rates%load)
    end associate
    call summary%set(name//'_h0_error', [(h0_error_of(problem, list(k)), k=1, size(list))])
    call summary%set(name//'_load_error', [(load_error_of(problem, list(k)), k=1, size(list))])
  end subroutine take_list

end module path_summary
