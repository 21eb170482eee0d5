!> What a deck asks for: this program's groups read, defaults filled in, checked as a whole.
module scene
  use kinds, only: wp
  use failure, only: failure_t
  use bodies, only: composite_stiffness, compliance_shares
  use text, only: brief
  use deck, only: deck_t, read_deck
  use laws, only: read_laws
  use scene_keys, only: keys_of_scene
  use scene_groups, only: scene_t, bodies_t, range_t, stability_t, sweep_t
  use experiment_request, only: loading_t, unloading_t, path_range_t, profiles_t, numerics_t
  use scene_ranges, only: take_loading, take_unloading, take_path, take_profiles, take_range, &
                          take_stability
  use scene_sweep, only: take_sweep
  use magnitudes, only: check_derived
  implicit none
  private
  public :: scene_t, read_scene, make_scene, swept_scene

  character(len=*), parameter :: one_way = 'give one of: stiffness; young and poisson; ' // &
    'rigid = .true.'

contains

  !> Reads and checks a deck: the file, or the text that is called `file` in messages. `error` lists
  !> what is wrong, each mistake with file, line, group and key.
  subroutine read_scene(file, scene, error, text)
    character(len=*), intent(in) :: file
    type(scene_t), intent(out) :: scene
    type(failure_t), allocatable, intent(out) :: error
    character(len=*), intent(in), optional :: text
    type(deck_t) :: deck

    call read_deck(file, keys_of_scene(), deck, error, text)
    if (allocated(error)) return
    call make_scene(deck, scene, error)
    if (allocated(error)) return
    if (allocated(scene%sweep)) call check_sweep(scene, error)
  end subroutine read_scene

  !> The scene of a deck that has been read; fails where keys contradict each other.
  subroutine make_scene(deck, scene, error)
    type(deck_t), intent(in) :: deck
    type(scene_t), intent(out) :: scene
    type(failure_t), allocatable, intent(out) :: error

    scene%deck = deck
    call deck%get('scene', 'title', scene%title)
    if (allocated(error)) return
    call take_bodies(scene, error)
    call read_laws(scene%deck, scene%law, error)
    call take_loading(scene, error)
    ! The groups below take their defaults from &loading and are checked against it.
    if (allocated(error)) return
    call take_unloading(scene, error)
    call take_path(scene, error)
    if (allocated(error)) return
    call take_profiles(scene, error)
    call take_range(scene, 'approximations', scene%approximations, error)
    call take_range(scene, 'classical', scene%classical, error)
    call take_stability(scene, error)
    call take_sweep(scene, error)
    call take_numerics(scene)
    if (.not. (allocated(scene%loading) .or. allocated(scene%path) .or. &
               allocated(scene%approximations) .or. allocated(scene%classical))) &
      call deck%mistake('', '', 'nothing to compute; a deck needs at least one of &loading, ' // &
                        '&equilibrium_path, &approximations, &classical', error)
    if (.not. allocated(error)) call check_derived(scene, error)
  end subroutine make_scene

  !> The scene, which has a sweep, with the sweep's key set to `value` and without the sweep.
  subroutine swept_scene(scene, value, variant, error)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: value
    type(scene_t), intent(out) :: variant
    type(failure_t), allocatable, intent(out) :: error
    type(deck_t) :: deck

    deck = scene%deck
    call deck%drop_group('sweep')
    call deck%set_real(scene%sweep%key, value, error)
    if (allocated(error)) return
    call make_scene(deck, variant, error)
  end subroutine swept_scene

  !> &bodies: exactly one way to say how the bodies deform.
  subroutine take_bodies(scene, error)
    type(scene_t), intent(inout) :: scene
    type(failure_t), allocatable, intent(inout) :: error
    real(wp), allocatable :: young(:), poisson(:)
    integer :: ways
    logical :: pair

    associate (deck => scene%deck, bodies => scene%bodies)
      call deck%get('bodies', 'radius', bodies%radius)
      call deck%get('bodies', 'rigid', bodies%rigid)
      call deck%get('bodies', 'young', young)
      call deck%get('bodies', 'poisson', poisson)
      pair = size(young) > 0 .or. size(poisson) > 0
      ways = count([deck%is_set('bodies', 'stiffness'), pair, bodies%rigid])
      if (ways == 0) then
        call deck%mistake('bodies', 'stiffness', 'missing; ' // one_way, error)
      else if (ways > 1) then
        call deck%mistake('bodies', second_way(), 'one way too many to say how the bodies ' // &
                          'deform; ' // one_way, error)
      else if (size(young) > 0 .and. size(poisson) == 0) then
        call deck%mistake('bodies', 'poisson', 'missing; young and poisson go together', error)
      else if (size(poisson) > 0 .and. size(young) == 0) then
        call deck%mistake('bodies', 'young', 'missing; young and poisson go together', error)
      else if (pair) then
        bodies%stiffness = composite_stiffness(spread_out(young), spread_out(poisson))
        bodies%share = compliance_shares(spread_out(young), spread_out(poisson))
      else
        call deck%get('bodies', 'stiffness', bodies%stiffness)
      end if
    end associate

  contains

    !> The last of the ways in the order of the table, at which the message points.
    pure function second_way() result(key)
      character(len=:), allocatable :: key

      key = 'poisson'
      if (size(young) > 0) key = 'young'
      if (scene%bodies%rigid) key = 'rigid'
    end function second_way

    !> One value stands for both bodies.
    pure function spread_out(list) result(both)
      real(wp), intent(in) :: list(:)
      real(wp) :: both(2)

      both = [list(1), list(size(list))]
    end function spread_out

  end subroutine take_bodies

  !> &numerics.
  subroutine take_numerics(scene)
    type(scene_t), intent(inout) :: scene

    associate (deck => scene%deck, numerics => scene%numerics)
      call deck%get('numerics', 'method', numerics%method)
      call deck%get('numerics', 'accuracy', numerics%accuracy)
      call deck%get('numerics', 'grid', numerics%grid)
      call deck%get('numerics', 'convergence', numerics%convergence)
      call deck%get('numerics', 'displacement_tolerance', numerics%displacement_tolerance)
      call deck%get('numerics', 'max_iterations', numerics%max_iterations)
      call deck%get('numerics', 'mixing_limit', numerics%mixing_limit)
      call deck%get('numerics', 'anderson_depth', numerics%anderson_depth)
      call deck%get_optional('numerics', 'r_max', numerics%r_max)
      call deck%get_optional('numerics', 'residual_tolerance', numerics%residual_tolerance)
      call deck%get_optional('numerics', 'nodes', numerics%nodes)
      call deck%get_optional('numerics', 'panel_order', numerics%panel_order)
    end associate
  end subroutine take_numerics

  !> Tries the sweep: every value against the key's own bounds, smallest and largest in the whole
  !> scene, so that a mistake shows before hours of work and not after.
  subroutine check_sweep(scene, error)
    type(scene_t), intent(in) :: scene
    type(failure_t), allocatable, intent(inout) :: error
    type(failure_t), allocatable :: trouble
    type(deck_t) :: trial
    type(scene_t) :: variant
    character(len=:), allocatable :: key
    real(wp) :: ends(2)
    integer :: i, row

    trial = scene%deck
    call trial%drop_group('sweep')
    call trial%find_number(scene%sweep%key, row, trouble)
    if (allocated(trouble)) then
      call scene%deck%mistake('sweep', 'key', trouble%message, error)
      return
    end if
    key = 'from'
    if (scene%deck%is_set('sweep', 'values')) key = 'values'
    do i = 1, size(scene%sweep%values)
      call trial%set_real(scene%sweep%key, scene%sweep%values(i), trouble)
      if (.not. allocated(trouble)) cycle
      call scene%deck%mistake('sweep', key, trouble%message, error)
      return
    end do
    ends = [minval(scene%sweep%values), maxval(scene%sweep%values)]
    do i = 1, size(ends)
      call swept_scene(scene, ends(i), variant, trouble)
      if (.not. allocated(trouble)) cycle
      call scene%deck%mistake('sweep', key, 'with ' // scene%sweep%key // ' = ' // brief(ends(i)) &
                              // ' the deck is wrong: ' // first_line(trouble%message), error)
      return
    end do

  contains

    pure function first_line(message) result(line)
      character(len=*), intent(in) :: message
      character(len=:), allocatable :: line

      line = message(:index(message // new_line('a'), new_line('a')) - 1)
    end function first_line

  end subroutine check_sweep

end module scene
