!> &sensitivity: the parameters by which results are differentiated.
module sensitivity_group
  use failure, only: failure_t, fail, bad_input
  use text, only: lower, quoted, word_count, word_of
  use deck_numbers, only: find_number
  use deck_keys, only: key_spec, group, names_key, real_value, real_list
  use variation, only: vary, to_report
  use scene_groups, only: scene_t
  use path_groups, only: check_path
  use deck_family, only: deck_family_t, new_deck_family
  implicit none
  private
  public :: sensitivity_keys, take_sensitivity

contains

  !> The rows of &sensitivity.
  pure function sensitivity_keys() result(specs)
    type(key_spec), allocatable :: specs(:)

    specs = [ &
      group('sensitivity', 'Derivatives of reported numbers by numbers of bodies, shape and ' // &
            'forces; needs &equilibrium_path, or &drive.'), &
      names_key('sensitivity', 'parameters', 20, 'The numbers, as ''group.key''; an element ' // &
                'of a list as ''group.key(2)''.', required=.true.)]
  end function sensitivity_keys

  !> Reads &sensitivity.
  subroutine take_sensitivity(scene, error)
    type(scene_t), intent(inout) :: scene
    type(failure_t), allocatable, intent(inout) :: error
    type(deck_family_t) :: family
    type(failure_t), allocatable :: trouble
    character(len=:), allocatable :: keys
    integer :: i

    if (.not. scene%deck%has_group('sensitivity')) return
    scene%deck%varied = .true.
    if (scene%deck%has_group('drive')) then
      call take_for_drive(scene, error)
      return
    end if
    call check_path(scene, 'sensitivity', error)
    if (scene%deck%has_group('sweep')) call scene%deck%mistake('sensitivity', '', &
      'not together with &sweep, whose cases show no curve', error)
    if (allocated(error)) return
    call scene%deck%get('sensitivity', 'parameters', keys)
    allocate (scene%sensitivity)
    allocate (scene%sensitivity%varied(word_count(keys)))
    do i = 1, word_count(keys)
      ! Each alone: where a default follows the number, it follows whatever else is named.
      call new_deck_family(scene%deck, word_of(keys, i), family, trouble)
      if (.not. allocated(trouble)) &
        call vary(family, 1, to_report, scene%sensitivity%varied(i), trouble)
      if (.not. allocated(trouble)) cycle
      call scene%deck%mistake('sensitivity', 'parameters', trouble%message, error)
      return
    end do
  end subroutine take_sensitivity

  !> The same for a drive in time, which is differentiated by whole runs: any numbers of its deck
  !> except those of &numerics.
  subroutine take_for_drive(scene, error)
    type(scene_t), intent(inout) :: scene
    type(failure_t), allocatable, intent(inout) :: error
    type(failure_t), allocatable :: trouble
    character(len=:), allocatable :: keys, name
    integer :: i, row, term

    associate (deck => scene%deck)
      if (deck%has_group('sweep')) call deck%mistake('sensitivity', '', &
        'not together with &sweep', error)
      call deck%get('sensitivity', 'parameters', keys)
      allocate (scene%sensitivity)
      allocate (scene%sensitivity%varied(word_count(keys)))
      do i = 1, word_count(keys)
        name = lower(word_of(keys, i))
        call find_number(deck, name, row, term, trouble)
        if (.not. allocated(trouble)) then
          scene%sensitivity%varied(i)%parameter%name = name
          if (index(name, 'numerics.') == 1 .or. &
            all(deck%specs(row)%kind /= [real_value, real_list])) then
            call fail(trouble, bad_input, quoted(name) // ' is not a number on which results ' // &
              'depend smoothly')
          else if (.not. allocated(deck%values(row)%reals)) then
            call fail(trouble, bad_input, 'the deck gives no ' // quoted(name))
          else if (term == 0 .and. size(deck%values(row)%reals) > 1) then
            call fail(trouble, bad_input, quoted(name) // ' is a list; name an element of it, ' // &
              'as ' // quoted(name // '(1)'))
          else
            associate (value => deck%values(row)%reals(max(1, term)))
              scene%sensitivity%varied(i)%parameter%value = value
              if (.not. abs(value) > 0) call fail(trouble, bad_input, quoted(name) // &
                ' is 0, so that no relative change of it can be made')
            end associate
          end if
        end if
        if (allocated(trouble)) then
          call deck%mistake('sensitivity', 'parameters', trouble%message, error)
          return
        end if
      end do
    end associate
  end subroutine take_for_drive

end module sensitivity_group
