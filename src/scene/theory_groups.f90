!> Reads &approximations and &classical: closed forms, computed over a range of h0 for comparison
!> with the curve.
module theory_groups
  use text, only: clip, guess, listing, lower, quoted, word_count, word_of
  use deck_keys, only: key_spec, real_value, integer_value, names_value
  use classical, only: convex, theories
  use scene_groups, only: scene_t, range_t
  use curve_groups, only: check_order
  implicit none
  private
  public :: theory_keys, take_approximations, take_classical

  character(len=*), parameter :: no_range = 'missing; give h0_start and h0_end here, or a ' // &
    '&loading or &equilibrium_path to take the range from'

contains

  !> The rows of &approximations and &classical.
  pure function theory_keys() result(specs)
    type(key_spec), allocatable :: specs(:)

    specs = [ &
      range_keys('approximations', 'Closed-form approximations for slow deformation.', &
        '&approximations h0_start = 10e-9, h0_end = 3e-9 /'), &
      range_keys('classical', 'Hertz, JKR, DMT and Maugis-Dugdale beside the curve; Hertz ' // &
        'and JKR for the shape that &shape gives.', &
        '&classical theories = ''hertz'', ''jkr'', ''dmt'' /'), &
      key_spec('classical', 'theories', names_value, 'The theories to show, of ' // all_names() // &
        '.', most=size(theories), otherwise='hertz, jkr, dmt and maugis_dugdale')]
  end function theory_keys

  !> The rows of &approximations or &classical.
  pure function range_keys(name, meaning, example) result(specs)
    character(len=*), intent(in) :: name, meaning, example
    type(key_spec) :: specs(4)

    specs = [ &
      key_spec(name, meaning=meaning, choices=example), &
      key_spec(name, 'h0_start', real_value, 'Upper end of the range of h0.', 'm', &
        otherwise='as in &loading or &equilibrium_path'), &
      key_spec(name, 'h0_end', real_value, 'Lower end of the range of h0.', 'm', &
        otherwise='as in &loading or &equilibrium_path'), &
      key_spec(name, 'count', integer_value, 'Number of points.', low=2, high=1000000, &
        default='200')]
  end function range_keys

  !> Reads &approximations.
  subroutine take_approximations(scene)
    type(scene_t), intent(inout) :: scene

    if (.not. scene%shape%parabolic) &
      call scene%deck%mistake('approximations', '', 'the approximations are those of the ' // &
                              'parabola; leave out this group or &shape')
    if (scene%deck%has_group('layer')) &
      call scene%deck%mistake('approximations', '', 'the approximations are those of ' // &
                              'half-spaces; leave out this group or &layer')
    call take_range(scene, 'approximations', scene%approximations)
  end subroutine take_approximations

  !> Reads &classical.
  subroutine take_classical(scene)
    type(scene_t), intent(inout) :: scene

    call take_range(scene, 'classical', scene%classical)
    if (scene%deck%is_set('classical', 'theories')) call take_names(scene)
  end subroutine take_classical

  !> Reads the names of the theories to show.
  subroutine take_names(scene)
    type(scene_t), intent(inout) :: scene
    character(len=:), allocatable :: names, name
    integer :: i, which

    if (allocated(scene%deck%error)) return
    call scene%deck%get('classical', 'theories', names)
    scene%classical%shown = .false.
    do i = 1, word_count(names)
      name = lower(word_of(names, i))
      which = findloc(theories == name, .true., dim=1)
      if (which == 0) then
        call scene%deck%mistake('classical', 'theories', quoted(clip(name)) // ' is not a theory' &
          // guess(name, all_names(), '') // '; allowed: ' // listing(all_names(), '', ''))
        return
      end if
      if (.not. (convex(which) .or. scene%shape%parabolic .and. &
        .not. scene%deck%has_group('layer'))) then
        call scene%deck%mistake('classical', 'theories', name // ' is a theory of ' // &
          'the parabola on half-spaces; leave it out, or &shape and &layer')
        return
      end if
      scene%classical%shown(which) = .true.
    end do
  end subroutine take_names

  !> The names of all theories, blank-separated.
  pure function all_names() result(names)
    character(len=:), allocatable :: names
    integer :: i

    names = trim(theories(1))
    do i = 2, size(theories)
      names = names // ' ' // trim(theories(i))
    end do
  end function all_names

  !> Reads the range of &approximations or &classical. Its default is the range of &loading or
  !> &equilibrium_path.
  subroutine take_range(scene, group, range)
    type(scene_t), intent(inout) :: scene
    character(len=*), intent(in) :: group
    type(range_t), allocatable, intent(inout) :: range

    allocate (range)
    associate (deck => scene%deck)
      if (allocated(scene%loading)) then
        call deck%assume(group, 'h0_start', scene%loading%h0_start)
        call deck%assume(group, 'h0_end', scene%loading%h0_end)
      else if (allocated(scene%path)) then
        if (allocated(scene%path%h0_start)) call deck%assume(group, 'h0_start', scene%path%h0_start)
        call deck%assume(group, 'h0_end', scene%path%h0_end)
      else if (.not. deck%is_set(group, 'h0_start')) then
        call deck%mistake(group, 'h0_start', no_range)
        return
      else if (.not. deck%is_set(group, 'h0_end')) then
        call deck%mistake(group, 'h0_end', no_range)
        return
      end if
      call deck%get_optional(group, 'h0_start', range%h0_start)
      call deck%get(group, 'h0_end', range%h0_end)
      call deck%get(group, 'count', range%count)
      if (allocated(range%h0_start)) call check_order(deck, group, 'h0_end', range%h0_end, &
        'below', 'h0_start', range%h0_start)
    end associate
  end subroutine take_range

end module theory_groups
