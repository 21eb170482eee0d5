!> &bodies and &layer: the two bodies, how they deform, and layers bonded to them. With forces and
!> shape of the deck they make the dimensionless problem of a scene.
module scene_problem
  ! The order of modules is one that compilers read: compiler note 12.
  use kinds, only: wp
  use deck_keys, only: key_spec, real_value, real_list, logical_value, word_value
  use text, only: brief, counted
  use deck, only: deck_t
  use layered_surface, only: layered_surface_t
  use dimensionless_problem, only: problem_t, new_problem
  use laws, only: keys_of_laws, read_laws
  use shapes, only: keys_of_shapes, read_shapes
  use layered_body, only: new_layered_body
  use scene_groups, only: scene_t
  implicit none
  private
  public :: keys_of_model, take_model, problem_of

  character(len=*), parameter :: one_way = 'give one of: stiffness; reduced_modulus; young ' // &
    'and poisson; rigid = .true.'

  !> The rows of &bodies.
  type(key_spec), parameter :: bodies_keys(*) = [ &
    key_spec('bodies', meaning='The two bodies. Exactly one of: stiffness; ' // &
      'reduced_modulus; young and poisson; rigid = .true.', required=.true.), &
    key_spec('bodies', 'radius', real_value, 'Radius R of the gap h0 + r^2/(2R), or of ' // &
      '&shape; a sphere on a plane has its own radius.', 'm', above=0.0_wp, otherwise='none'), &
    key_spec('bodies', 'stiffness', real_value, 'E/(1-nu^2) of two identical bodies, twice ' // &
      'the reduced modulus.', 'Pa', above=0.0_wp), &
    key_spec('bodies', 'reduced_modulus', real_value, 'Reduced modulus E*: 1/E* is the sum of ' // &
      '(1-nu^2)/E over the two bodies.', 'Pa', above=0.0_wp), &
    key_spec('bodies', 'young', real_list, 'Young''s moduli of the two bodies; one value: the ' // &
      'same.', 'Pa', most=2, above=0.0_wp), &
    key_spec('bodies', 'poisson', real_list, 'Poisson''s ratios of the two bodies; one value: ' // &
      'the same.', most=2, above=-1.0_wp, high=0.5_wp), &
    key_spec('bodies', 'rigid', logical_value, 'Whether the bodies do not deform at all.', &
      default='.false.')]

  !> Largest ratio of two thicknesses or moduli.
  real(wp), parameter :: most_unlike = 1.0e9_wp
  !> Smallest thickness of the top layer over the lateral unit. Contacts are wider than that unit.
  !> The number of waves that a thin layer affects grows as the contact radius over the thickness;
  !> at this limit they take gigabytes of memory, and minutes of work.
  real(wp), parameter :: thinnest = 1.0e-3_wp

  !> Largest number of layers.
  integer, parameter :: most = 20

  !> The rows of &layer.
  type(key_spec), parameter :: layer_keys(*) = [ &
    key_spec('layer', meaning='Layers bonded to a body, from the top down, on the half-space ' // &
      'of &bodies.'), &
    key_spec('layer', 'thickness', real_list, 'Thickness of each layer.', 'm', most=most, &
      above=0.0_wp, required=.true.), &
    key_spec('layer', 'young', real_list, 'Young''s modulus of each layer.', 'Pa', most=most, &
      above=0.0_wp, required=.true.), &
    key_spec('layer', 'poisson', real_list, 'Poisson''s ratio of each layer; 0.5: ' // &
      'incompressible.', most=most, above=-1.0_wp, high=0.5_wp, required=.true.), &
    key_spec('layer', 'body', word_value, 'The body that has the layers.', choices='1 2 both', &
      default='1'), &
    key_spec('layer', 'base', word_value, 'The base below the layers: the half-space of ' // &
      '&bodies, or rigid.', choices='elastic rigid', otherwise='elastic, or as &bodies rigid'), &
    key_spec('layer', 'partner', word_value, 'The body without layers.', choices='elastic rigid', &
      otherwise='elastic, or as &bodies rigid')]

contains

  !> Reads &bodies, which must say in exactly one way how the bodies deform.
  subroutine take_bodies(scene)
    type(scene_t), intent(inout) :: scene
    real(wp), allocatable :: young(:), poisson(:)
    real(wp) :: compliance(2)
    character(len=:), allocatable :: key
    integer :: ways
    logical :: pair, reduced

    associate (deck => scene%deck, bodies => scene%bodies)
      call deck%get('bodies', 'rigid', bodies%rigid)
      call deck%get('bodies', 'young', young)
      call deck%get('bodies', 'poisson', poisson)
      pair = size(young) > 0 .or. size(poisson) > 0
      reduced = deck%is_set('bodies', 'reduced_modulus')
      ways = count([reduced, deck%is_set('bodies', 'stiffness'), pair, bodies%rigid])
      if (ways == 0 .and. layer_bears_all(deck)) then
        bodies%rigid = .true.
      else if (ways == 0) then
        call deck%mistake('bodies', 'stiffness', 'missing; ' // one_way)
      else if (ways > 1) then
        ! The message points at the last of the given ways in the order of the table.
        key = 'stiffness'
        if (size(poisson) > 0) key = 'poisson'
        if (size(young) > 0) key = 'young'
        if (bodies%rigid) key = 'rigid'
        call deck%mistake('bodies', key, 'more than one way to say how the bodies deform; ' // &
          one_way)
      else if (size(young) > 0 .and. size(poisson) == 0) then
        call deck%mistake('bodies', 'poisson', 'missing; young and poisson go together')
      else if (size(poisson) > 0 .and. size(young) == 0) then
        call deck%mistake('bodies', 'young', 'missing; young and poisson go together')
      else if (pair) then
        ! A single value holds for both.
        bodies%young = [young(1), young(size(young))]
        bodies%poisson = [poisson(1), poisson(size(poisson))]
        ! The compliances (1-nu^2)/E add, and identical bodies that deform together as much have
        ! their mean; each body's part of the deformation is its compliance over this mean. The two
        ! may differ by any factor.
        compliance = compliance_of(bodies%young, bodies%poisson)
        bodies%stiffness = 2/sum(compliance)
        bodies%share = bodies%stiffness*compliance
      else if (reduced) then
        call deck%get('bodies', 'reduced_modulus', bodies%stiffness)
        bodies%stiffness = 2*bodies%stiffness
      else
        call deck%get('bodies', 'stiffness', bodies%stiffness)
      end if
    end associate
  end subroutine take_bodies

  !> Whether only layers deform, so that &bodies need not say how the bodies do.
  logical function layer_bears_all(deck)
    type(deck_t), intent(in) :: deck

    layer_bears_all = deck%has_group('layer') .and. word_is(deck, 'base', 'rigid') .and. &
      (word_is(deck, 'body', 'both') .or. word_is(deck, 'partner', 'rigid'))
  end function layer_bears_all

  !> Reads &layer, after &bodies: the surfaces, and the stiffness of the two bodies as given by
  !> their top layers.
  subroutine take_layer(scene)
    type(scene_t), intent(inout) :: scene
    type(layered_surface_t) :: coat
    real(wp), allocatable :: young(:)
    real(wp) :: compliance(2)
    character(len=:), allocatable :: body, partner
    logical :: has_coat(2)
    integer :: i

    if (.not. scene%deck%has_group('layer') .or. allocated(scene%deck%error)) return
    associate (deck => scene%deck, bodies => scene%bodies)
      call deck%assume('layer', 'base', trim(merge('rigid  ', 'elastic', bodies%rigid)))
      call deck%get('layer', 'body', body)
      if (body /= 'both') &
        call deck%assume('layer', 'partner', trim(merge('rigid  ', 'elastic', bodies%rigid)))
      call deck%get('layer', 'partner', partner)
      call deck%get('layer', 'thickness', coat%thickness)
      call deck%get('layer', 'young', young)
      call deck%get('layer', 'poisson', coat%poisson)
      call check_layers(scene, coat%thickness, young, coat%poisson)
      if (allocated(scene%deck%error)) return
      call join_alike(coat%thickness, young, coat%poisson)
      coat%shear = young/(2*(1 + coat%poisson))
      coat%on_rigid = word_is(deck, 'base', 'rigid')
      has_coat = [body /= '2', body /= '1']
      allocate (bodies%surface(2))
      do i = 1, 2
        if (has_coat(i)) then
          compliance(i) = compliance_of(young(1), coat%poisson(1))
          if (.not. coat%on_rigid) then
            coat%base_shear = bodies%young(i)/(2*(1 + bodies%poisson(i)))
            coat%base_poisson = bodies%poisson(i)
          end if
          bodies%surface(i) = coat
        else
          allocate (bodies%surface(i)%thickness(0))
          compliance(i) = 0
          if (partner /= 'elastic') cycle
          compliance(i) = 1/bodies%stiffness
          if (allocated(bodies%young)) &
            compliance(i) = compliance_of(bodies%young(i), bodies%poisson(i))
        end if
      end do
      bodies%stiffness = 2/sum(compliance)
      bodies%share = compliance*bodies%stiffness
      bodies%rigid = .false.
    end associate
  end subroutine take_layer

  !> Refuses a top layer that is too thin to be computed; called after forces and shape are read.
  subroutine check_thinness(scene)
    type(scene_t), intent(inout) :: scene
    real(wp), allocatable :: thickness(:)

    if (.not. scene%deck%has_group('layer')) return
    call scene%deck%get('layer', 'thickness', thickness)
    associate (least => thinnest*sqrt(scene%shape%radius*scene%law%length))
      if (thickness(1) < least) call scene%deck%mistake('layer', 'thickness', 'the top layer ' // &
        'is thinner than ' // brief(least) // ' m, ' // brief(thinnest) // ' of sqrt(R L), ' // &
        'with the range L of the force; contacts are too wide beside it; leave it out')
    end associate
  end subroutine check_thinness

  !> Joins neighbouring layers of the same material to one.
  pure subroutine join_alike(thickness, young, poisson)
    real(wp), allocatable, intent(inout) :: thickness(:), young(:), poisson(:)
    integer :: i

    do i = size(thickness) - 1, 1, -1
      if (abs(young(i + 1) - young(i)) > 0 .or. abs(poisson(i + 1) - poisson(i)) > 0) cycle
      thickness = [thickness(:i - 1), thickness(i) + thickness(i + 1), thickness(i + 2:)]
      young = [young(:i), young(i + 2:)]
      poisson = [poisson(:i), poisson(i + 2:)]
    end do
  end subroutine join_alike

  !> (1-nu^2)/E.
  elemental real(wp) function compliance_of(young, poisson)
    real(wp), intent(in) :: young, poisson

    compliance_of = (1 - poisson)*(1 + poisson)/young
  end function compliance_of

  !> Refuses keys that contradict each other or &bodies.
  subroutine check_layers(scene, thickness, young, poisson)
    type(scene_t), intent(inout) :: scene
    real(wp), intent(in) :: thickness(:), young(:), poisson(:)

    associate (deck => scene%deck, bodies => scene%bodies)
      if (size(young) /= size(thickness)) call deck%mistake('layer', 'young', &
        brief(size(young)) // ' for ' // counted(size(thickness), 'layer') // &
        '; give one value for each thickness, from the top down')
      if (size(poisson) /= size(thickness)) call deck%mistake('layer', 'poisson', &
        brief(size(poisson)) // ' for ' // counted(size(thickness), 'layer') // &
        '; give one value for each thickness, from the top down')
      call check_spread(scene, 'thickness', thickness)
      call check_spread(scene, 'young', young)
      if (allocated(bodies%young) .and. word_is(deck, 'base', 'elastic')) &
        call check_spread(scene, 'young', [young, bodies%young])
      if (allocated(scene%deck%error)) return
      if (word_is(deck, 'base', 'elastic')) then
        if (bodies%rigid) then
          call deck%mistake('layer', 'base', 'the bodies are rigid; give base = ''rigid'', or ' // &
            'young and poisson in &bodies')
        else if (.not. allocated(bodies%young)) then
          call deck%mistake('bodies', 'stiffness', 'the material below the layers must be ' // &
            'known; give young and poisson here, or base = ''rigid'' in &layer')
        end if
      end if
      if (word_is(deck, 'body', 'both')) then
        if (deck%is_set('layer', 'partner')) call deck%mistake('layer', 'partner', &
          'both bodies have layers; leave it out')
      else if (bodies%rigid .and. word_is(deck, 'partner', 'elastic')) then
        call deck%mistake('layer', 'partner', 'the bodies are rigid; leave it out, or give ' // &
          'how they deform in &bodies')
      end if
    end associate
  end subroutine check_layers

  !> Refuses numbers so different that rounding would hide the smaller ones.
  subroutine check_spread(scene, key, values)
    type(scene_t), intent(inout) :: scene
    character(len=*), intent(in) :: key
    real(wp), intent(in) :: values(:)

    if (maxval(values) > most_unlike*minval(values)) call scene%deck%mistake('layer', key, 'from ' &
      // brief(minval(values)) // ' to ' // brief(maxval(values)) // ' is more than a factor of ' &
      // brief(most_unlike) // '; leave out layers so thin or soft, or make so stiff a body rigid')
  end subroutine check_spread

  pure logical function word_is(deck, key, word)
    type(deck_t), intent(in) :: deck
    character(len=*), intent(in) :: key, word
    character(len=:), allocatable :: held

    call deck%get('layer', key, held)
    word_is = held == word
  end function word_is

  !> The rows of bodies, layers, shapes and forces in the table of keys.
  pure function keys_of_model() result(specs)
    type(key_spec), allocatable :: specs(:)

    specs = [bodies_keys, layer_keys, keys_of_shapes(), keys_of_laws()]
  end function keys_of_model

  !> Reads bodies, layers, forces and shape of the scene's deck.
  subroutine take_model(scene)
    type(scene_t), intent(inout) :: scene

    call take_bodies(scene)
    call take_layer(scene)
    call read_laws(scene%deck, scene%law)
    if (allocated(scene%law)) call read_shapes(scene%deck, scene%law%length, scene%shape)
    if (.not. allocated(scene%deck%error)) call check_thinness(scene)
  end subroutine take_model

  !> The problem of a scene.
  type(problem_t) function problem_of(scene) result(problem)
    type(scene_t), intent(in) :: scene
    type(layered_surface_t) :: surface(2)
    integer :: i

    problem = new_problem(scene%law, scene%shape, scene%bodies%stiffness, scene%bodies%rigid)
    problem%share = scene%bodies%share
    if (.not. allocated(scene%bodies%surface)) return
    surface = scene%bodies%surface
    do i = 1, 2
      surface(i)%thickness = surface(i)%thickness/problem%lateral
    end do
    deallocate (problem%body)
    allocate (problem%body, source=new_layered_body(surface, problem%share/2))
  end function problem_of

end module scene_problem
