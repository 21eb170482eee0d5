!> &sensitivity: the parameters by which results are differentiated.
module sensitivity_group
  use failure, only: failure_t, fail, bad_input
  use text, only: lower, quoted, word_count, word_of
  use deck, only: deck_t
  use deck_numbers, only: find_number
  use deck_keys, only: key_spec, names_value, real_value, real_list
  use variation, only: parameter_t, vary, to_report
  use scene_groups, only: scene_t
  use curve_groups, only: check_path
  use deck_family, only: deck_family_t, new_deck_family
  implicit none
  private
  public :: sensitivity_keys, take_sensitivity

  !> The rows of &sensitivity.
  type(key_spec), parameter :: sensitivity_keys(*) = [ &
    key_spec('sensitivity', meaning='Derivatives of reported numbers by numbers of bodies, ' // &
      'shape and forces; needs &equilibrium_path, or &drive.'), &
    key_spec('sensitivity', 'parameters', names_value, 'The numbers, as ''group.key''; an ' // &
      'element of a list as ''group.key(2)''.', most=20, required=.true.)]

contains

  !> Reads &sensitivity.
  subroutine take_sensitivity(scene)
    type(scene_t), intent(inout) :: scene
    type(deck_family_t) :: family
    type(failure_t), allocatable :: trouble
    character(len=:), allocatable :: keys, why
    logical :: driven
    integer :: i

    if (.not. scene%deck%has_group('sensitivity')) return
    scene%deck%varied = .true.
    driven = scene%deck%has_group('drive')
    why = ''
    if (.not. driven) then
      call check_path(scene, 'sensitivity')
      why = ', whose cases show no curve'
    end if
    if (scene%deck%has_group('sweep')) call scene%deck%mistake('sensitivity', '', &
      'not together with &sweep' // why)
    if (allocated(scene%deck%error) .and. .not. driven) return
    call scene%deck%get('sensitivity', 'parameters', keys)
    allocate (scene%sensitivity)
    allocate (scene%sensitivity%varied(word_count(keys)))
    do i = 1, word_count(keys)
      associate (varied => scene%sensitivity%varied(i))
        if (driven) then
          call take_number(scene%deck, lower(word_of(keys, i)), varied%parameter, trouble)
        else
          ! Each alone: where a default follows the number, it follows whatever else is named.
          call new_deck_family(scene%deck, word_of(keys, i), family, trouble)
          if (.not. allocated(trouble)) call vary(family, 1, to_report, varied, trouble)
        end if
      end associate
      if (.not. allocated(trouble)) cycle
      call scene%deck%mistake('sensitivity', 'parameters', trouble%message)
      return
    end do
  end subroutine take_sensitivity

  !> A parameter of a drive in time, which is differentiated by whole runs: any number of the deck
  !> except those of &numerics.
  subroutine take_number(deck, name, parameter, error)
    type(deck_t), intent(in) :: deck
    character(len=*), intent(in) :: name
    type(parameter_t), intent(inout) :: parameter
    type(failure_t), allocatable, intent(out) :: error
    integer :: row, term

    call find_number(deck, name, row, term, error)
    if (allocated(error)) return
    parameter%name = name
    if (index(name, 'numerics.') == 1 .or. &
      all(deck%specs(row)%kind /= [real_value, real_list])) then
      call fail(error, bad_input, quoted(name) // ' is not a number on which results depend ' // &
        'smoothly')
    else if (.not. allocated(deck%values(row)%reals)) then
      call fail(error, bad_input, 'the deck gives no ' // quoted(name))
    else if (term == 0 .and. size(deck%values(row)%reals) > 1) then
      call fail(error, bad_input, quoted(name) // ' is a list; name an element of it, as ' // &
        quoted(name // '(1)'))
    else
      parameter%value = deck%values(row)%reals(max(1, term))
      if (.not. abs(parameter%value) > 0) call fail(error, bad_input, quoted(name) // &
        ' is 0, so that no relative change of it can be made')
    end if
  end subroutine take_number

end module sensitivity_group
