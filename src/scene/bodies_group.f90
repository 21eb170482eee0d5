!> &bodies: the two bodies, and how they deform.
module bodies_group
  use kinds, only: wp
  use deck_keys, only: key_spec, real_value, real_list, logical_value
  use scene_groups, only: scene_t
  use layer_group, only: layer_bears_all
  implicit none
  private
  public :: bodies_keys, take_bodies

  character(len=*), parameter :: one_way = 'give one of: stiffness; young and poisson; ' // &
    'rigid = .true.'

  !> The rows of &bodies.
  type(key_spec), parameter :: bodies_keys(*) = [ &
    key_spec('bodies', meaning='The two bodies. Exactly one of: stiffness; young and poisson; ' // &
      'rigid = .true.', required=.true.), &
    key_spec('bodies', 'radius', real_value, 'Radius R of the gap h0 + r^2/(2R), or of ' // &
      '&shape; a sphere on a plane has its own radius.', 'm', above=0.0_wp, otherwise='none'), &
    key_spec('bodies', 'stiffness', real_value, 'E/(1-nu^2) of two identical bodies: the ' // &
      'compliance (1-nu^2)/E is the mean over the two.', 'Pa', above=0.0_wp), &
    key_spec('bodies', 'young', real_list, 'Young''s moduli of the two bodies; one value: the ' // &
      'same.', 'Pa', most=2, above=0.0_wp), &
    key_spec('bodies', 'poisson', real_list, 'Poisson''s ratios of the two bodies; one value: ' // &
      'the same.', most=2, above=-1.0_wp, high=0.5_wp), &
    key_spec('bodies', 'rigid', logical_value, 'Whether the bodies do not deform at all.', &
      default='.false.')]

contains

  !> Reads &bodies, which must say in exactly one way how the bodies deform.
  subroutine take_bodies(scene)
    type(scene_t), intent(inout) :: scene
    real(wp), allocatable :: young(:), poisson(:)
    real(wp) :: compliance(2)
    integer :: ways
    logical :: pair

    associate (deck => scene%deck, bodies => scene%bodies)
      call deck%get('bodies', 'rigid', bodies%rigid)
      call deck%get('bodies', 'young', young)
      call deck%get('bodies', 'poisson', poisson)
      pair = size(young) > 0 .or. size(poisson) > 0
      ways = count([deck%is_set('bodies', 'stiffness'), pair, bodies%rigid])
      if (ways == 0 .and. layer_bears_all(deck)) then
        bodies%rigid = .true.
      else if (ways == 0) then
        call deck%mistake('bodies', 'stiffness', 'missing; ' // one_way)
      else if (ways > 1) then
        call deck%mistake('bodies', second_way(), 'more than one way to say how the bodies ' // &
                          'deform; ' // one_way)
      else if (size(young) > 0 .and. size(poisson) == 0) then
        call deck%mistake('bodies', 'poisson', 'missing; young and poisson go together')
      else if (size(poisson) > 0 .and. size(young) == 0) then
        call deck%mistake('bodies', 'young', 'missing; young and poisson go together')
      else if (pair) then
        bodies%young = spread_out(young)
        bodies%poisson = spread_out(poisson)
        ! The compliances (1-nu^2)/E add, and identical bodies that deform together as much have
        ! their mean; each body's part of the deformation is its compliance over this mean. The two
        ! may differ by any factor.
        compliance = (1 - bodies%poisson)*(1 + bodies%poisson)/bodies%young
        bodies%stiffness = 2/sum(compliance)
        bodies%share = bodies%stiffness*compliance
      else
        call deck%get('bodies', 'stiffness', bodies%stiffness)
      end if
    end associate

  contains

    !> The last of the given ways in the order of the table; the message points at it.
    pure function second_way() result(key)
      character(len=:), allocatable :: key

      key = 'poisson'
      if (size(young) > 0) key = 'young'
      if (scene%bodies%rigid) key = 'rigid'
    end function second_way

    !> Values for both bodies; a single value holds for both.
    pure function spread_out(list) result(both)
      real(wp), intent(in) :: list(:)
      real(wp) :: both(2)

      both = [list(1), list(size(list))]
    end function spread_out

  end subroutine take_bodies

end module bodies_group
