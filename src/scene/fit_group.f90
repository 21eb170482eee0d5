!> Reads &fit: the keys of the deck that are fitted to a measured force curve.
module fit_group
  use kinds, only: wp, long
  use checksums, only: checksum
  use failure, only: failure_t
  use text, only: brief, lower, quoted, rounded, word_count, word_of
  use deck, only: deck_t
  use deck_numbers, only: find_number, present_name
  use deck_keys, only: key_spec, real_list, names_value
  use fit_request, only: unknown_t, of_contact_point, of_sensitivity, of_spring, of_separation
  use deck_source, only: source_t, load_source
  use data_table, only: largest_table
  use curve_index, only: curve_index_t
  use curve_reading, only: read_measured
  use measurement_group, only: take_measurement
  use scene_groups, only: scene_t
  use unknown_bounds, only: take_range, take_bounds
  use deck_family, only: deck_family_t, new_deck_family
  implicit none
  private
  public :: fit_keys, take_fit, check_sharing, load_curve, family_of_fit

  !> Largest number of unknowns of a curve; largest number of curves that are fitted together.
  integer, parameter :: most_unknowns = 20, most_joint = 100

  !> The rows of &fit.
  type(key_spec), parameter :: fit_keys(*) = [ &
    key_spec('fit', meaning='Fits keys of this deck to the curve of &measurement.', &
      choices='&fit parameters = ''force.work_of_adhesion'', ''measurement.contact_point'' /'), &
    key_spec('fit', 'parameters', names_value, 'The unknowns, as ''group.key'': numbers of ' // &
      'bodies, shape and forces, and measurement.contact_point, sensitivity or spring_constant.', &
      most=most_unknowns, otherwise='required, unless shared is given'), &
    key_spec('fit', 'shared', names_value, 'Instead of parameters, in a sweep over curves: ' // &
      'unknowns with one value for all of its curves, which are fitted together.', &
      most=most_unknowns, otherwise='each curve is fitted alone'), &
    key_spec('fit', 'own', names_value, 'With shared: unknowns with a value for each curve.', &
      most=most_unknowns, otherwise='none'), &
    key_spec('fit', 'lower', real_list, 'Smallest value of each (of shared, then of own), in ' // &
      'the unit of the key.', most=most_unknowns, otherwise='none'), &
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

  !> Reads the measured curve of a scene with a fit. Its file becomes a part of the deck's
  !> checksums. trouble: the reason why the curve cannot be read. index: the positions of the curves
  !> in a file with several curves; it is made here unless it already belongs to this file.
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

  !> Advice with a modulus above which the bodies may be called rigid. Then the strength of adhesion
  !> or, without attraction, the deformation under the law's pressure unit changes loads by less
  !> than a hundredth.
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

    names = names_of(deck)
    own = ''
    do i = 1, word_count(names)
      if (.not. is_measured(word_of(names, i))) own = own // ' ' // word_of(names, i)
    end do
    call new_deck_family(deck, own, family, error)
  end subroutine family_of_fit

  !> The names of all unknowns, the shared ones first.
  function names_of(deck) result(names)
    type(deck_t), intent(in) :: deck
    character(len=:), allocatable :: names, own

    if (deck%is_set('fit', 'shared')) then
      call deck%get('fit', 'shared', names)
      call deck%get('fit', 'own', own)
      names = names // ' ' // own
    else
      call deck%get('fit', 'parameters', names)
    end if
  end function names_of

  pure logical function is_measured(name)
    character(len=*), intent(in) :: name

    is_measured = index(lower(name), 'measurement.') == 1
  end function is_measured

  !> Reads the unknowns of &fit with their bounds and prior standard deviations.
  subroutine take_unknowns(scene)
    type(scene_t), intent(inout) :: scene
    type(deck_family_t) :: family
    type(failure_t), allocatable :: trouble
    character(len=:), allocatable :: names, key
    integer :: i, k, own, row, term, shared

    call take_sharing(scene%deck, shared)
    if (allocated(scene%deck%error)) return
    names = names_of(scene%deck)
    key = trim(merge('shared    ', 'parameters', shared > 0))
    call family_of_fit(scene%deck, family, trouble)
    if (allocated(trouble)) then
      call scene%deck%mistake('fit', key, trouble%message // &
        ', measurement.contact_point, measurement.sensitivity, measurement.spring_constant')
      return
    end if
    allocate (scene%fit%unknown(word_count(names)))
    own = 0
    do i = 1, size(scene%fit%unknown)
      associate (unknown => scene%fit%unknown(i))
        unknown%name = lower(word_of(names, i))
        unknown%shared = i <= shared
        if (shared > 0) key = trim(merge('shared', 'own   ', unknown%shared))
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
          key, quoted(scene%fit%unknown(i)%name) // trim(merge(' is in shared too', &
          ' is there twice  ', k <= shared .and. i > shared)))
      end do
      if (allocated(scene%deck%error)) return
    end do
    if (.not. any(scene%fit%unknown%role == of_contact_point) .and. &
      .not. (allocated(scene%measured%contact_point) .or. scene%measured%under_loads())) &
      call scene%deck%mistake('fit', key, 'the contact point is unknown: add ' // &
      'measurement.contact_point here, or give contact_point in &measurement')
    call take_bounds(scene%deck, scene%fit%unknown)
  end subroutine take_unknowns

  !> Reads the number of shared unknowns.
  subroutine take_sharing(deck, shared)
    type(deck_t), intent(inout) :: deck
    integer, intent(out) :: shared
    character(len=:), allocatable :: names

    call deck%get('fit', 'shared', names)
    shared = word_count(names)
    if (shared == 0 .and. deck%is_set('fit', 'own')) then
      call deck%mistake('fit', 'own', 'needs shared; to fit each curve alone, give parameters')
    else if (shared == 0 .and. .not. deck%is_set('fit', 'parameters')) then
      call deck%mistake('fit', 'parameters', 'missing; or shared and own, to fit several ' // &
        'curves together')
    else if (shared > 0 .and. deck%is_set('fit', 'parameters')) then
      call deck%mistake('fit', 'parameters', 'not together with shared, which with own has ' // &
        'all unknowns')
    end if
  end subroutine take_sharing

  !> If curves are to be fitted together, checks that there are several curves and that each shared
  !> unknown has one value.
  subroutine check_sharing(scene)
    type(scene_t), intent(inout) :: scene
    integer :: i, k

    if (.not. scene%fit%is_joint()) return
    associate (deck => scene%deck, unknown => scene%fit%unknown)
      if (.not. (scene%sweeps('measurement.file') .or. scene%sweeps('measurement.curve'))) then
        call deck%mistake('fit', 'shared', 'needs several curves: a &sweep with ' // &
          'measurement.file or measurement.curve')
        return
      end if
      if (scene%sweep%cases() > most_joint) call deck%mistake('fit', 'shared', 'there are ' // &
        brief(scene%sweep%cases()) // ' curves, and at most ' // brief(most_joint) // &
        ' are fitted together')
      do i = 1, count(unknown%shared)
        do k = 1, word_count(scene%sweep%names)
          if (present_name(deck, lower(word_of(scene%sweep%names, k))) == &
            present_name(deck, unknown(i)%name)) call deck%mistake('fit', 'shared', &
            quoted(unknown(i)%name) // ' is swept too, and would have a value for each curve')
        end do
      end do
    end associate
  end subroutine check_sharing

  !> Sets role, value and scale of an unknown that is a key of &measurement.
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

end module fit_group
