!> Reads &layer: layers bonded to a body, from the top down.
module scene_layers
  ! The order of the modules is one that all compilers accept: compiler note 12.
  use kinds, only: wp
  use deck_keys, only: key_spec, real_list, word_value
  use text, only: brief, counted
  use deck, only: deck_t
  use layered_surface, only: layered_surface_t
  use scene_groups, only: scene_t, compliance_of
  implicit none
  private
  public :: layer_keys, take_layer, layer_bears_all, check_thinness

  !> Largest ratio of two thicknesses, or of two moduli.
  real(wp), parameter :: most_unlike = 1.0e9_wp
  !> Smallest thickness of the top layer, relative to the lateral unit. Contacts are wider than this
  !> unit. The number of Hankel components that a thin layer affects is proportional to the ratio of
  !> contact radius and thickness; at this limit they take gigabytes of memory and minutes of work.
  real(wp), parameter :: thinnest = 1.0e-3_wp

  !> Largest number of layers.
  integer, parameter :: most = 20

  !> The rows of &layer.
  type(key_spec), parameter :: layer_keys(*) = [ &
    key_spec('layer', meaning='Layers bonded to a body, from the top down, on the half-space ' // &
      'of &bodies.', &
      choices='&layer thickness = 200e-9, young = 1e9, poisson = 0.4, body = 2 /'), &
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

  !> Whether only layers deform. Then &bodies need not give the moduli of the bodies.
  logical function layer_bears_all(deck)
    type(deck_t), intent(in) :: deck

    layer_bears_all = deck%has_group('layer') .and. word_is(deck, 'base', 'rigid') .and. &
      (word_is(deck, 'body', 'both') .or. word_is(deck, 'partner', 'rigid'))
  end function layer_bears_all

  !> Reads &layer, after &bodies: the surfaces, and the plane-strain modulus of the two bodies,
  !> which is that of their top layers.
  subroutine take_layer(scene)
    type(scene_t), intent(inout) :: scene
    type(layered_surface_t) :: coat
    real(wp), allocatable :: young(:)
    real(wp) :: compliance(2)
    character(len=:), allocatable :: body, partner
    logical :: has_coat(2)
    integer :: i

    if (allocated(scene%deck%error)) return
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

  !> Refuses a top layer that is too thin for the computation. It is called after forces and shape
  !> have been read.
  subroutine check_thinness(scene)
    type(scene_t), intent(inout) :: scene
    real(wp), allocatable :: thickness(:)

    call scene%deck%get('layer', 'thickness', thickness)
    associate (least => thinnest*sqrt(scene%shape%radius*scene%law%length))
      if (thickness(1) < least) call scene%deck%mistake('layer', 'thickness', 'the top layer ' // &
        'is thinner than ' // brief(least) // ' m, ' // brief(thinnest) // ' of sqrt(R L), ' // &
        'with the range L of the force; contacts are too wide beside it; leave it out')
    end associate
  end subroutine check_thinness

  !> Joins neighbouring layers of the same material into one.
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

  !> Refuses keys that contradict each other or contradict &bodies.
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

  !> Refuses numbers that differ so much that rounding would hide the smaller ones.
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

end module scene_layers
