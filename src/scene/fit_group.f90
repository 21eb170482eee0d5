!> &fit: the keys of the deck that are fitted to a measured force curve.
module fit_group
  use kinds, only: wp, long
  use checksums, only: checksum
  use failure, only: failure_t
  use text, only: lower, quoted, rounded, word_count, word_of
  use deck, only: deck_t
  use deck_numbers, only: find_number, present_name
  use deck_keys, only: key_spec, real_value, real_list, names_value
  use fit_request, only: unknown_t, of_contact_point, of_sensitivity, of_spring, of_separation
  use deck_source, only: source_t, load_source
  use data_table, only: largest_table
  use curve_index, only: curve_index_t
  use measured_curve, only: read_measured
  use measurement_group, only: take_measurement
  use scene_groups, only: scene_t
  use deck_family, only: deck_family_t, new_deck_family
  implicit none
  private
  public :: fit_keys, take_fit, load_curve, family_of_fit

  integer, parameter :: most_unknowns = 20

  !> The rows of &fit.
  type(key_spec), parameter :: fit_keys(*) = [ &
    key_spec('fit', meaning='Fits keys of this deck to the curve of &measurement.', &
      choices='&fit parameters = ''force.work_of_adhesion'', ''measurement.contact_point'' /'), &
    key_spec('fit', 'parameters', names_value, 'The unknowns, as ''group.key'': numbers of ' // &
      'bodies, shape and forces, and measurement.contact_point, sensitivity or spring_constant.', &
      most=most_unknowns, required=.true.), &
    key_spec('fit', 'lower', real_list, 'Smallest value of each, in the unit of the key.', &
      most=most_unknowns, otherwise='none'), &
    key_spec('fit', 'upper', real_list, 'Largest value of each.', most=most_unknowns, &
      otherwise='none'), &
    key_spec('fit', 'prior', real_list, 'Standard deviation of each before the measurement, ' // &
      'about the value in the deck; 0: unknown.', most=most_unknowns, low=0.0_wp, &
      otherwise='unknown'), &
    key_spec('fit', 'noise', real_list, 'Standard deviation of the signal, in its unit, and ' // &
      'then of the contact radius.', most=2, above=0.0_wp, otherwise='those of the data')]

contains

  !> Reads &measurement and &fit.
  subroutine take_fit(scene)
    type(scene_t), intent(inout) :: scene

    associate (deck => scene%deck)
      if (deck%has_group('measurement') .and. .not. deck%has_group('fit')) &
        call deck%mistake('measurement', '', 'needs &fit')
      if (.not. deck%has_group('fit')) return
      deck%varied = .true.
      if (.not. deck%has_group('measurement')) then
        call deck%mistake('fit', '', 'needs &measurement')
        return
      end if
      if (scene%bodies%rigid) call deck%mistake('fit', '', 'needs elastic bodies' // &
        stiff_enough(scene))
    end associate
    if (allocated(scene%deck%error)) return
    allocate (scene%measured, scene%fit)
    if (allocated(scene%bodies%poisson)) scene%fit%poisson = scene%bodies%poisson
    call take_measurement(scene)
    if (.not. allocated(scene%deck%error)) call take_unknowns(scene)
  end subroutine take_fit

  !> Reads the curve of a scene with a fit, whose file becomes a part of the deck's checksums.
  !> trouble: why the curve cannot be read. index: where the curves of a file with several are; it
  !> is made unless it is of this file.
  subroutine load_curve(scene, trouble, index)
    type(scene_t), intent(inout) :: scene
    type(failure_t), allocatable, intent(out) :: trouble
    type(curve_index_t), intent(inout), optional, target :: index
    type(curve_index_t), target :: own
    type(curve_index_t), pointer :: curves
    type(source_t) :: source
    integer(long) :: digest

    curves => own
    if (present(index)) curves => index
    associate (measured => scene%measured)
      if (allocated(measured%curves)) then
        call curves%find_curves(measured%file, measured%curves, measured%skip_lines, trouble)
        if (.not. allocated(trouble)) call curves%load(measured%curve, source, trouble)
        digest = curves%digest
      else
        call load_source(measured%file, source, trouble, largest_table)
        digest = 0
        if (.not. allocated(trouble)) digest = checksum(source%text)
      end if
      if (allocated(trouble)) return
      call scene%deck%note_file('measurement', 'file', digest)
      call read_measured(measured, source, trouble)
      if (allocated(trouble)) trouble%message = 'the curve cannot be used: ' // trouble%message
    end associate
  end subroutine load_curve

  !> ', such as ...' with a stiffness above which it does not matter for rigid bodies: then the
  !> strength of adhesion or, without attraction, the deformation under the law's own pressure
  !> changes loads by less than a hundredth.
  function stiff_enough(scene) result(words)
    type(scene_t), intent(in) :: scene
    character(len=:), allocatable :: words
    real(wp), parameter :: hardly = 1.0e-3_wp

    words = ''
    if (.not. (allocated(scene%law) .and. allocated(scene%shape))) return
    associate (law => scene%law)
      words = '; with stiffness = ' // rounded(law%pressure_unit*sqrt(scene%shape%radius/ &
        law%length)*max(law%adhesion, merge(0.0_wp, 1.0_wp, law%adhesion > 0))/hardly) // &
        ' or more they are as good as rigid'
    end associate
  end function stiff_enough

  !> The family of problems whose parameters are the unknowns of bodies, shape and forces, in order.
  subroutine family_of_fit(deck, family, error)
    type(deck_t), intent(in) :: deck
    type(deck_family_t), intent(out) :: family
    type(failure_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: names, own
    integer :: i

    call deck%get('fit', 'parameters', names)
    own = ''
    do i = 1, word_count(names)
      if (.not. is_measured(word_of(names, i))) own = own // ' ' // word_of(names, i)
    end do
    call new_deck_family(deck, own, family, error)
  end subroutine family_of_fit

  pure logical function is_measured(name)
    character(len=*), intent(in) :: name

    is_measured = index(lower(name), 'measurement.') == 1
  end function is_measured

  !> Reads the unknowns of &fit with their bounds and prior standard deviations.
  subroutine take_unknowns(scene)
    type(scene_t), intent(inout) :: scene
    type(deck_family_t) :: family
    type(failure_t), allocatable :: trouble
    character(len=:), allocatable :: names
    integer :: i, k, own, row, term

    call scene%deck%get('fit', 'parameters', names)
    call family_of_fit(scene%deck, family, trouble)
    if (allocated(trouble)) then
      call scene%deck%mistake('fit', 'parameters', trouble%message // &
        ', measurement.contact_point, measurement.sensitivity, measurement.spring_constant')
      return
    end if
    allocate (scene%fit%unknown(word_count(names)))
    own = 0
    do i = 1, size(scene%fit%unknown)
      associate (unknown => scene%fit%unknown(i))
        unknown%name = lower(word_of(names, i))
        if (is_measured(unknown%name)) then
          call take_measured(scene, unknown)
        else
          own = own + 1
          unknown%value = family%parameter(own)%value
          unknown%scale = family%parameter(own)%scale
          call find_number(scene%deck, unknown%name, row, term, trouble)
          unknown%unit = trim(scene%deck%specs(row)%unit)
          unknown%in_log = unknown%value > 0 .and. &
            max(scene%deck%specs(row)%low, scene%deck%specs(row)%above) >= 0
          unknown%origin = unknown%value
          call take_range(scene%deck%specs(row), unknown)
        end if
      end associate
      do k = 1, i - 1
        if (present_name(scene%deck, scene%fit%unknown(k)%name) == &
          present_name(scene%deck, scene%fit%unknown(i)%name)) call scene%deck%mistake('fit', &
          'parameters', quoted(scene%fit%unknown(i)%name) // ' is there twice')
      end do
      if (allocated(scene%deck%error)) return
    end do
    if (.not. any(scene%fit%unknown%role == of_contact_point) .and. &
      .not. (allocated(scene%measured%contact_point) .or. scene%measured%under_loads())) &
      call scene%deck%mistake('fit', 'parameters', 'the contact point is unknown: add ' // &
      'measurement.contact_point here, or give contact_point in &measurement')
    call take_bounds(scene%deck, scene%fit%unknown)
  end subroutine take_unknowns

  !> Makes the ends of a key's range bounds of the unknown: a search that may not go beyond them
  !> otherwise ends there before the others are found.
  pure subroutine take_range(spec, unknown)
    type(key_spec), intent(in) :: spec
    type(unknown_t), intent(inout) :: unknown
    !> Part of the value by which the search stays inside an end that is excluded.
    real(wp), parameter :: inside = 1.0e-6_wp

    associate (value => unknown%value)
      if (.not. unknown%in_log) then
        if (spec%low > -huge(1.0_wp)) unknown%lower = spec%low
        if (spec%above > -huge(1.0_wp)) unknown%lower = spec%above + inside*abs(value - spec%above)
      end if
      if (spec%high < huge(1.0_wp)) unknown%upper = spec%high
      if (spec%below < huge(1.0_wp)) unknown%upper = spec%below - inside*abs(spec%below - value)
    end associate
  end subroutine take_range

  !> Sets role, value and scale of an unknown in &measurement.
  subroutine take_measured(scene, unknown)
    type(scene_t), intent(inout) :: scene
    type(unknown_t), intent(inout) :: unknown

    select case (unknown%name)
    case ('measurement.contact_point')
      unknown%unit = 'm'
      unknown%role = of_contact_point
      if (allocated(scene%measured%contact_point)) unknown%value = scene%measured%contact_point
    case ('measurement.spring_constant')
      unknown%unit = 'N/m'
      unknown%role = of_spring
      unknown%value = scene%measured%spring_constant
    case ('measurement.sensitivity')
      unknown%unit = 'm/V'
      unknown%role = of_sensitivity
      if (allocated(scene%measured%sensitivity)) then
        unknown%value = scene%measured%sensitivity
      else
        call scene%deck%mistake('fit', 'parameters', 'the signal is a force: &measurement has ' // &
          'no sensitivity')
      end if
    case default
      call scene%deck%mistake('fit', 'parameters', quoted(unknown%name) // ' cannot be ' // &
        'fitted; of &measurement only contact_point, sensitivity and spring_constant can')
    end select
    if (scene%measured%under_loads() .and. .not. allocated(scene%deck%error)) then
      call scene%deck%mistake('fit', 'parameters', quoted(unknown%name) // ' does not change ' // &
        'contact radii under loads')
      return
    end if
    if (any(unknown%role == [of_sensitivity, of_spring]) .and. scene%measured%has(of_separation)) &
      call scene%deck%mistake('fit', 'parameters', quoted(unknown%name) // ' cannot be fitted to ' &
      // 'separations, which were computed with it; fit positions of the base')
    unknown%in_log = unknown%role /= of_contact_point
    if (unknown%in_log .and. unknown%value > 0) unknown%scale = unknown%value
  end subroutine take_measured

  !> Reads bounds and prior standard deviations, one for each unknown.
  subroutine take_bounds(deck, unknown)
    type(deck_t), intent(inout) :: deck
    type(unknown_t), intent(inout) :: unknown(:)
    character(len=*), parameter :: keys(*) = [character(len=5) :: 'lower', 'upper', 'prior']
    real(wp), allocatable :: value(:)
    integer :: i, k

    do k = 1, size(keys)
      call deck%get('fit', trim(keys(k)), value)
      if (size(value) == 0) cycle
      if (size(value) /= size(unknown)) then
        call deck%mistake('fit', trim(keys(k)), 'give one value for each of parameters')
        return
      end if
      do i = 1, size(unknown)
        select case (keys(k))
        case ('lower')
          if (unknown(i)%in_log .and. value(i) <= 0) cycle
          if (allocated(unknown(i)%lower)) value(i) = max(value(i), unknown(i)%lower)
          unknown(i)%lower = value(i)
        case ('upper')
          if (allocated(unknown(i)%upper)) value(i) = min(value(i), unknown(i)%upper)
          unknown(i)%upper = value(i)
        case default
          unknown(i)%prior = value(i)
        end select
      end do
    end do
    do i = 1, size(unknown)
      if (unknown(i)%role == of_contact_point .and. .not. deck%is_set('measurement', &
        'contact_point')) then
        if (unknown(i)%prior > 0) call deck%mistake('fit', 'prior', &
          'measurement.contact_point is not given, so that it has no prior')
        cycle
      end if
      if (allocated(unknown(i)%lower)) then
        if (unknown(i)%value < unknown(i)%lower) call deck%mistake('fit', 'lower', &
          unknown(i)%name // ' is below this bound in the deck')
      end if
      if (allocated(unknown(i)%upper)) then
        if (unknown(i)%value > unknown(i)%upper) call deck%mistake('fit', 'upper', &
          unknown(i)%name // ' is above this bound in the deck')
      end if
    end do
  end subroutine take_bounds

end module fit_group
