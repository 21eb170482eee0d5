!> The problems of a deck in which some numbers are replaced. The deck is read again for each set of
!> numbers, so that laws, shapes and units need no code for this purpose. &sensitivity names such
!> numbers; the derivatives of results by them are computed.
module deck_family
  use kinds, only: wp
  use failure, only: failure_t, fail, bad_input
  use text, only: lower, quoted, brief, clip, listing, word_count, word_of
  use deck, only: deck_t
  use deck_numbers, only: find_number, present_name, set_number, guess_number
  use deck_keys, only: key_spec, real_value, real_list, names_value
  use deck_values, only: given
  use dimensionless_problem, only: problem_t
  use variation, only: problem_family_t, parameter_t, vary, to_report
  use scene_groups, only: scene_t
  use scene_problem, only: keys_of_model, take_model, problem_of
  implicit none
  private
  public :: deck_family_t, new_deck_family, widened, sensitivity_keys, take_sensitivity

  !> A deck, and those of its numbers that `pose` replaces.
  type, extends(problem_family_t) :: deck_family_t
    type(deck_t) :: deck
  contains
    procedure :: pose
  end type deck_family_t

  !> The rows of &sensitivity.
  type(key_spec), parameter :: sensitivity_keys(*) = [ &
    key_spec('sensitivity', meaning='Derivatives of reported numbers by numbers of bodies, ' // &
      'shape and forces; needs &equilibrium_path, or &drive.', &
      choices='&sensitivity parameters = ''force.work_of_adhesion'', ''bodies.young(2)'' /'), &
    key_spec('sensitivity', 'parameters', names_value, 'The numbers, as ''group.key''; an ' // &
      'element of a list as ''group.key(2)''.', most=20, required=.true.)]

contains

  !> The family of a deck with `keys` as parameters: blank-separated names of the form 'group.key',
  !> or 'group.key(2)' for an element of a list. It fails, with a message without a position in the
  !> file, if a key is not a number of bodies, shape or forces, or has no value in the deck.
  subroutine new_deck_family(deck, keys, family, error)
    type(deck_t), intent(in) :: deck
    character(len=*), intent(in) :: keys
    type(deck_family_t), intent(out) :: family
    type(failure_t), allocatable, intent(out) :: error
    integer :: i

    family%deck = deck
    allocate (family%parameter(word_count(keys)))
    do i = 1, size(family%parameter)
      family%parameter(i)%name = lower(word_of(keys, i))
      call take_value(deck, family%parameter(i), error)
      if (allocated(error)) return
    end do
  end subroutine new_deck_family

  !> The family with the other positive numbers of its deck as further parameters. For a number that
  !> the deck leaves out, the parameter is a factor of its default.
  type(deck_family_t) function widened(family) result(wider)
    type(deck_family_t), intent(in) :: family
    type(parameter_t) :: new, without_name
    type(failure_t), allocatable :: error
    character(len=:), allocatable :: names
    integer :: i, k, row, term

    wider = family
    names = parameters_of(family%deck)
    do i = 1, word_count(names)
      ! Not by a structure constructor: compiler note 1.
      new = without_name
      new%name = word_of(names, i)
      if (any([(present_name(family%deck, family%parameter(k)%name) == new%name, &
        k=1, size(family%parameter))])) cycle
      call take_value(family%deck, new, error)
      if (allocated(error) .or. .not. new%value > 0) cycle
      call find_number(family%deck, new%name, row, term, error)
      new%follows = family%deck%values(row)%status /= given
      if (new%follows) new%value = 1
      new%scale = new%value
      wider%parameter = [wider%parameter, new]
    end do
  end function widened

  !> Makes the problem of the deck with these values of the parameters.
  subroutine pose(self, value, problem, error)
    class(deck_family_t), intent(in) :: self
    real(wp), intent(in) :: value(:)
    type(problem_t), intent(out) :: problem
    type(failure_t), allocatable, intent(out) :: error
    type(scene_t) :: scene, usual
    integer :: i, row, term

    scene%deck = self%deck
    do i = 1, size(value)
      if (self%parameter(i)%follows) cycle
      call set_number(scene%deck, self%parameter(i)%name, value(i), error)
      if (allocated(error)) return
    end do
    do i = 1, size(value)
      if (.not. self%parameter(i)%follows .or. abs(value(i) - 1) <= 0) cycle
      usual = scene
      call take_model(usual)
      if (allocated(usual%deck%error)) then
        call move_alloc(usual%deck%error, error)
        return
      end if
      call find_number(usual%deck, self%parameter(i)%name, row, term, error)
      call set_number(scene%deck, self%parameter(i)%name, &
        value(i)*usual%deck%values(row)%reals(max(1, term)), error)
      if (allocated(error)) return
    end do
    call take_model(scene)
    call move_alloc(scene%deck%error, error)
    if (.not. allocated(error)) problem = problem_of(scene)
  end subroutine pose

  !> Sets value and scale of a parameter. The scale of a dimensionless number that is 0 is 1.
  subroutine take_value(deck, parameter, error)
    type(deck_t), intent(in) :: deck
    type(parameter_t), intent(inout) :: parameter
    type(failure_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: names
    integer :: row, term

    names = parameters_of(deck)
    if (index(names // ' ', ' ' // present_name(deck, parameter%name) // ' ') == 0) then
      call fail(error, bad_input, quoted(clip(parameter%name)) // ' is not a number of ' // &
        'bodies, shape or forces that this deck has' // guess_number(parameter%name, names) // &
        '; allowed: ' // listing(names, '', ''))
      return
    end if
    call find_number(deck, parameter%name, row, term, error)
    if (allocated(error)) return
    parameter%value = deck%values(row)%reals(max(1, term))
    if (abs(parameter%value) > 0) then
      parameter%scale = abs(parameter%value)
    else if (deck%specs(row)%unit /= '') then
      call fail(error, bad_input, quoted(parameter%name) // ' is 0, so that no relative ' // &
        'change of it can be made')
    end if
  end subroutine take_value

  !> Blank-separated names of all numbers that a deck has for bodies, shape and forces.
  function parameters_of(deck) result(names)
    type(deck_t), intent(in) :: deck
    character(len=:), allocatable :: names
    type(key_spec), allocatable :: specs(:)
    integer :: row, i, k

    names = ''
    specs = keys_of_model()
    do i = 1, size(specs)
      if (all(specs(i)%kind /= [real_value, real_list])) cycle
      if (.not. deck%has_group(trim(specs(i)%group))) cycle
      row = deck%row_of(trim(specs(i)%group), trim(specs(i)%key))
      if (.not. allocated(deck%values(row)%reals)) cycle
      do k = 1, size(deck%values(row)%reals)
        names = names // ' ' // trim(specs(i)%group) // '.' // trim(specs(i)%key)
        if (size(deck%values(row)%reals) == 1) cycle
        names = names // '(' // brief(k) // ')'
      end do
    end do
  end function parameters_of

  !> Reads &sensitivity.
  subroutine take_sensitivity(scene)
    type(scene_t), intent(inout) :: scene
    type(deck_family_t) :: family
    type(failure_t), allocatable :: trouble
    character(len=:), allocatable :: keys, why
    logical :: driven
    integer :: i

    scene%deck%varied = .true.
    driven = scene%deck%has_group('drive')
    why = ''
    if (.not. driven) then
      if (.not. allocated(scene%path)) call scene%deck%mistake('sensitivity', '', &
        'needs &equilibrium_path or &drive')
      why = ', whose cases show no curve'
    end if
    if (scene%deck%has_group('sweep')) call scene%deck%mistake('sensitivity', '', &
      'not together with &sweep' // why)
    if (allocated(scene%deck%error) .and. .not. driven) return
    call scene%deck%get('sensitivity', 'parameters', keys)
    allocate (scene%varied(word_count(keys)))
    do i = 1, word_count(keys)
      associate (varied => scene%varied(i))
        if (driven) then
          call take_number(scene%deck, lower(word_of(keys, i)), varied%parameter, trouble)
        else
          ! Each parameter is varied alone. A default that follows it then does so whatever other
          ! parameters are named.
          call new_deck_family(scene%deck, word_of(keys, i), family, trouble)
          if (.not. allocated(trouble)) call vary(family, 1, to_report, varied, trouble)
        end if
      end associate
      if (.not. allocated(trouble)) cycle
      call scene%deck%mistake('sensitivity', 'parameters', trouble%message)
      return
    end do
  end subroutine take_sensitivity

  !> Sets a parameter of a drive in time, whose derivatives are finite differences of whole runs. It
  !> may be any number of the deck except those of &numerics.
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

end module deck_family
