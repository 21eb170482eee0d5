!> The content of a deck: this program's groups, with defaults, checked as a whole. The reader,
!> `--keys` and the resolved deck use one table of all groups and keys. The rows of a group are in
!> the module that reads this group.
module scene
  use kinds, only: wp
  use text, only: brief, quoted, listing, first_line, word_count, word_of
  use failure, only: failure_t, fail, bad_input
  use deck, only: deck_t, read_deck
  use deck_numbers, only: find_number, set_number, set_text
  use deck_keys, only: key_spec, ignored_group, text_value
  use scene_groups, only: scene_t
  use scene_problem, only: keys_of_model, take_model
  use curve_groups, only: cycle_keys, take_loading, take_unloading, path_keys, profiles_keys, &
    take_path, take_readings, take_regime, take_profiles, has_states
  use deck_family, only: sensitivity_keys, take_sensitivity
  use rate_groups, only: rate_keys, take_drive, take_creep, take_fluid
  use theory_groups, only: theory_keys, take_approximations, take_classical
  use sweep_group, only: sweep_keys, take_sweep
  use fit_group, only: fit_keys, take_fit, check_sharing, load_curve
  use measurement_group, only: measurement_keys
  use numerics_group, only: numerics_keys, take_numerics
  use scene_checks, only: check_derived, check_shape
  implicit none
  private
  public :: scene_t, keys_of_scene, read_scene, swept_scene

  !> The groups that start a computation; a deck needs at least one of them.
  character(len=*), parameter :: computing(*) = [character(len=17) :: 'loading', &
    'equilibrium_path', 'drive', 'approximations', 'classical', 'fit']

contains

  !> The table, with one row for each group and key; the keys of a group follow the row of the
  !> group.
  pure function keys_of_scene() result(specs)
    type(key_spec), allocatable :: specs(:)

    specs = [ &
      key_spec('scene', meaning='Name of the calculation.', &
        choices='&scene title = ''Silica probe on a polymer'' /'), &
      key_spec('scene', 'title', text_value, 'Title, repeated in all files of results.', most=200, &
        otherwise='none'), &
      keys_of_model(), &
      cycle_keys, &
      path_keys, &
      sensitivity_keys, &
      key_spec('regime', meaning='Which theory of contact describes the scene: parameters, ' // &
        'and errors against the path; needs &equilibrium_path.', &
        choices='&regime /'), &
      rate_keys, &
      profiles_keys, &
      theory_keys(), &
      key_spec('stability', meaning='Stability of every equilibrium, by criterion and by ' // &
        'smallest eigenvalue; needs &loading or &equilibrium_path.', &
        choices='&stability /'), &
      measurement_keys, &
      fit_keys, &
      sweep_keys, &
      numerics_keys, &
      key_spec('summary', meaning='Results in a summary file; skipped, so that the file can ' // &
        'be run again.', kind=ignored_group), &
      key_spec('cost', meaning='As &summary.', kind=ignored_group)]
  end function keys_of_scene

  !> Reads and checks a deck, from the file, or from `text` with the name `file` in messages. error:
  !> lists the mistakes, each with file, line, group and key.
  subroutine read_scene(file, scene, error, text)
    character(len=*), intent(in) :: file
    type(scene_t), intent(out) :: scene
    type(failure_t), allocatable, intent(out) :: error
    character(len=*), intent(in), optional :: text
    type(failure_t), allocatable :: trouble
    type(deck_t) :: deck

    call read_deck(file, keys_of_scene(), deck, text)
    call make_scene(deck, scene)
    if (allocated(scene%fit) .and. .not. allocated(scene%deck%error)) call check_sharing(scene)
    if (allocated(scene%sweep)) then
      if (.not. allocated(scene%deck%error)) call check_sweep(scene)
    else if (allocated(scene%fit) .and. .not. allocated(scene%deck%error)) then
      call load_curve(scene, trouble)
      if (allocated(trouble)) call scene%deck%mistake('measurement', 'file', trouble%message)
    end if
    call move_alloc(scene%deck%error, error)
  end subroutine read_scene

  !> Makes the scene of a deck that has been read, group by group. Keys that contradict each other
  !> are mistakes.
  subroutine make_scene(deck, scene)
    type(deck_t), intent(in) :: deck
    type(scene_t), intent(out) :: scene
    character(len=len(computing)*size(computing)) :: all_names
    integer :: i

    scene%deck = deck
    if (allocated(deck%error)) return
    call deck%get('scene', 'title', scene%title)
    call take_model(scene)
    if (deck%has_group('loading')) call take_loading(scene)
    ! The groups below take defaults from &loading and are checked against it.
    if (allocated(scene%deck%error)) return
    if (deck%has_group('unloading')) call take_unloading(scene)
    if (deck%has_group('equilibrium_path')) call take_path(scene)
    if (allocated(scene%deck%error)) return
    call take_readings(scene)
    if (deck%has_group('sensitivity')) call take_sensitivity(scene)
    if (deck%has_group('regime')) call take_regime(scene)
    if (deck%has_group('drive')) call take_drive(scene)
    if (deck%has_group('viscoelastic')) call take_creep(scene)
    if (deck%has_group('fluid')) call take_fluid(scene)
    if (deck%has_group('profiles')) call take_profiles(scene)
    if (deck%has_group('approximations')) call take_approximations(scene)
    if (deck%has_group('classical')) call take_classical(scene)
    scene%stability = has_states(scene, 'stability')
    if (deck%has_group('sweep')) call take_sweep(scene)
    call take_numerics(scene)
    if (deck%has_group('fit') .or. deck%has_group('measurement')) call take_fit(scene)
    if (.not. any([(deck%has_group(trim(computing(i))), i=1, size(computing))])) &
      call scene%deck%mistake('', '', 'nothing to compute; a deck needs at least one of ' // &
        listing(transfer(computing, all_names), '&', ''))
    if (.not. allocated(scene%deck%error)) call check_derived(scene)
    if (.not. allocated(scene%deck%error)) call check_shape(scene)
  end subroutine make_scene

  !> The scene of one case of a sweep: the keys `names`, blank-separated, have the `values`, and
  !> &sweep and &sensitivity are removed. text: the text of the key that holds a text; without it
  !> this key keeps its value. The measured curve of a fit is not read here (`load_curve`).
  subroutine swept_scene(scene, names, values, variant, error, text)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: names
    real(wp), intent(in) :: values(:)
    type(scene_t), intent(out) :: variant
    type(failure_t), allocatable, intent(out) :: error
    character(len=*), intent(in), optional :: text
    type(deck_t) :: deck
    integer :: k, text_key

    deck = scene%deck
    text_key = 0
    if (allocated(scene%sweep)) text_key = scene%sweep%text_key
    call deck%drop_group('sweep')
    call deck%drop_group('sensitivity')
    do k = 1, size(values)
      if (k /= text_key) then
        call set_number(deck, word_of(names, k), values(k), error)
      else if (present(text)) then
        call set_text(deck, word_of(names, k), text, error)
      end if
      if (allocated(error)) return
    end do
    call make_scene(deck, variant)
    call move_alloc(variant%deck%error, error)
  end subroutine swept_scene

  !> Checks the sweep, so that a mistake is reported before hours of work. Every value is compared
  !> with the bounds of its key. The whole scene is made with the smallest and with the largest
  !> values of all keys, or with the first and the last case of a file.
  subroutine check_sweep(scene)
    type(scene_t), intent(inout) :: scene
    type(failure_t), allocatable :: trouble
    type(deck_t) :: trial
    character(len=:), allocatable :: key
    integer :: place(2, word_count(scene%sweep%names)), k, i

    trial = scene%deck
    call trial%drop_group('sweep')
    do k = 1, word_count(scene%sweep%names)
      call find_number(trial, word_of(scene%sweep%names, k), place(1, k), place(2, k), trouble, &
        words=.true.)
      place(2, k) = max(1, place(2, k))
      if (.not. allocated(trouble) .and. any([(all(place(:, i) == place(:, k)), i=1, k - 1)])) &
        call fail(trouble, bad_input, quoted(word_of(scene%sweep%names, k)) // ' is there twice')
      if (allocated(trouble)) then
        call scene%deck%mistake('sweep', trim(merge('file', 'key ', allocated(scene%sweep%file))), &
          trouble%message)
        return
      end if
      if (k == scene%sweep%text_key) then
        cycle
      else if (allocated(scene%sweep%file)) then
        call try_values(scene, trial, k, scene%sweep%file%telling(:, k), 'file')
      else
        key = 'from'
        if (scene%deck%is_set('sweep', 'values')) key = 'values'
        if (scene%sweep%words(k) /= '') key = 'words'
        call try_values(scene, trial, k, scene%sweep%axis(k)%values, key)
      end if
      if (allocated(scene%deck%error)) return
    end do
    call try_ends(scene)
  end subroutine check_sweep

  !> Refuses a sweep if values of key k are outside the key's bounds. key: the key of &sweep that
  !> the message names.
  subroutine try_values(scene, trial, k, values, key)
    type(scene_t), intent(inout) :: scene
    type(deck_t), intent(inout) :: trial
    integer, intent(in) :: k
    real(wp), intent(in) :: values(:)
    character(len=*), intent(in) :: key
    type(failure_t), allocatable :: trouble
    integer :: i

    do i = 1, size(values)
      call set_number(trial, word_of(scene%sweep%names, k), values(i), trouble)
      if (.not. allocated(trouble)) cycle
      if (key == 'file') trouble%message = 'case ' // &
        brief(scene%sweep%file%of_case(i, k)) // ': ' // trouble%message
      call scene%deck%mistake('sweep', key, trouble%message)
      return
    end do
  end subroutine try_values

  !> Refuses a sweep if the scene with the smallest or the largest values, or of the first or last
  !> case, is wrong.
  subroutine try_ends(scene)
    type(scene_t), intent(inout) :: scene
    type(failure_t), allocatable :: trouble
    type(scene_t) :: variant
    character(len=:), allocatable :: key, said, text
    real(wp), allocatable :: values(:)
    integer :: i, k

    associate (sweep => scene%sweep)
      key = 'from'
      if (scene%deck%is_set('sweep', 'values')) key = 'values'
      if (scene%deck%is_set('sweep', 'words')) key = 'words'
      if (allocated(sweep%file)) key = 'file'
      do i = 1, 2
        if (allocated(sweep%file)) then
          values = sweep%file%first
          if (i == 2) values = sweep%file%last
          text = sweep%file%first_text
          if (i == 2) text = sweep%file%last_text
        else
          values = [(merge(minval(sweep%axis(k)%values), maxval(sweep%axis(k)%values), i == 1), &
            k=1, size(sweep%axis))]
          text = sweep%text_of(values)
        end if
        call swept_scene(scene, sweep%names, values, variant, trouble, text)
        if (.not. allocated(trouble)) cycle
        said = 'with '
        do k = 1, size(values)
          if (k > 1) said = said // ', '
          said = said // word_of(sweep%names, k) // ' = ' // sweep%shown(k, values(k), text)
        end do
        call scene%deck%mistake('sweep', key, said // ' the deck is wrong: ' // &
          first_line(trouble%message))
        return
      end do
    end associate
  end subroutine try_ends

end module scene
