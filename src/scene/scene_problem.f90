!> Reads &bodies: the two bodies and how they deform. With the layers, forces and shape of the deck
!> they define the dimensionless problem of a scene.
module scene_problem
  ! The order of the modules is one that all compilers accept: compiler note 12.
  use kinds, only: wp
  use deck_keys, only: key_spec, real_value, real_list, logical_value
  use layered_surface, only: layered_surface_t
  use dimensionless_problem, only: problem_t, new_problem
  use laws, only: keys_of_laws, read_laws
  use shapes, only: keys_of_shapes, read_shapes
  use layered_body, only: new_layered_body
  use scene_groups, only: scene_t, compliance_of
  use scene_layers, only: layer_keys, take_layer, layer_bears_all, check_thinness
  implicit none
  private
  public :: keys_of_model, take_model, problem_of

  character(len=*), parameter :: one_way = 'give one of: stiffness; reduced_modulus; young ' // &
    'and poisson; rigid = .true.'

  !> The rows of &bodies.
  type(key_spec), parameter :: bodies_keys(*) = [ &
    key_spec('bodies', meaning='The two bodies. Exactly one of: stiffness; ' // &
      'reduced_modulus; young and poisson; rigid = .true.', required=.true., &
      choices='&bodies radius = 5e-6, young = 70e9, 2e9, poisson = 0.17, 0.4 /'), &
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

contains

  !> Reads &bodies, which must specify in exactly one way how the bodies deform.
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
        ! The message refers to the last of the given ways in the order of the table.
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
        ! A single value holds for both bodies.
        bodies%young = [young(1), young(size(young))]
        bodies%poisson = [poisson(1), poisson(size(poisson))]
        ! The compliances (1-nu^2)/E of the bodies add up. Two identical bodies that together deform
        ! as much have the mean compliance. The share of a body in the deformation is its compliance
        ! divided by this mean. The two compliances may differ by any factor.
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

  !> The rows of bodies, layers, shapes and forces in the table of keys.
  pure function keys_of_model() result(specs)
    type(key_spec), allocatable :: specs(:)

    specs = [bodies_keys, layer_keys, keys_of_shapes(), keys_of_laws()]
  end function keys_of_model

  !> Reads bodies, layers, forces and shape of the scene's deck.
  subroutine take_model(scene)
    type(scene_t), intent(inout) :: scene

    call take_bodies(scene)
    if (scene%deck%has_group('layer')) call take_layer(scene)
    call read_laws(scene%deck, scene%law)
    if (allocated(scene%law)) call read_shapes(scene%deck, scene%law%length, scene%shape)
    if (scene%deck%has_group('layer') .and. .not. allocated(scene%deck%error)) &
      call check_thinness(scene)
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
