!> &sensitivity: parameters by which results are differentiated.
module sensitivity_group
  use failure, only: failure_t
  use deck_keys, only: key_spec, group, names_key
  use variation, only: vary, to_report
  use scene_groups, only: scene_t
  use path_group, only: check_path
  use deck_family, only: deck_family_t, new_deck_family
  implicit none
  private
  public :: sensitivity_keys, take_sensitivity

contains

  !> Its rows of the table.
  pure function sensitivity_keys() result(specs)
    type(key_spec), allocatable :: specs(:)

    specs = [ &
      group('sensitivity', 'Derivatives of what is reported by numbers of bodies, shape and ' // &
            'forces; needs &equilibrium_path.'), &
      names_key('sensitivity', 'parameters', 20, 'The numbers, as ''group.key'', of a list as ' // &
                '''group.key(2)''.', required=.true.)]
  end function sensitivity_keys

  !> &sensitivity.
  subroutine take_sensitivity(scene, error)
    type(scene_t), intent(inout) :: scene
    type(failure_t), allocatable, intent(inout) :: error
    type(deck_family_t) :: family
    type(failure_t), allocatable :: trouble
    character(len=:), allocatable :: keys
    integer :: i

    if (.not. scene%deck%has_group('sensitivity')) return
    call check_path(scene, 'sensitivity', error)
    if (scene%deck%has_group('sweep')) call scene%deck%mistake('sensitivity', '', &
      'not together with &sweep, whose cases show no curve', error)
    if (allocated(error)) return
    call scene%deck%get('sensitivity', 'parameters', keys)
    call new_deck_family(scene%deck, keys, family, trouble)
    allocate (scene%sensitivity)
    if (.not. allocated(trouble)) then
      allocate (scene%sensitivity%varied(size(family%parameter)))
      do i = 1, size(family%parameter)
        call vary(family, i, to_report, scene%sensitivity%varied(i), trouble)
        if (allocated(trouble)) exit
      end do
    end if
    if (allocated(trouble)) &
      call scene%deck%mistake('sensitivity', 'parameters', trouble%message, error)
  end subroutine take_sensitivity

end module sensitivity_group
