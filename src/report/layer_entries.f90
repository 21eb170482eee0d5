!> What the summary says of layered bodies, and of a scene that is not on the ground of their model.
module layer_entries
  use kinds, only: wp
  use dimensionless_problem, only: problem_t, largest_tension
  use layered_body, only: layered_body_t
  use summary, only: summary_t
  use quality_warnings, only: short_number
  implicit none
  private
  public :: summarise_layers, judge_layers

  !> Indentation as a part of the layers' thickness that is worth a warning, of soft layers.
  real(wp), parameter :: strained = 0.1_wp

contains

  !> The moduli of short and of long waves.
  subroutine summarise_layers(problem, summary)
    type(problem_t), intent(in) :: problem
    type(summary_t), intent(inout) :: summary

    select type (body => problem%body)
    type is (layered_body_t)
      call summary%set('top_modulus', 0.5_wp*problem%stiffness)
      if (body%bottom > 0) &
        call summary%set('bottom_modulus', 0.5_wp*problem%stiffness/body%bottom)
    end select
  end subroutine summarise_layers

  !> Warns of layers that are thinner than the force reaches, and of soft ones that are pressed to a
  !> part of their thickness that is not small.
  subroutine judge_layers(problem, summary)
    type(problem_t), intent(in) :: problem
    type(summary_t), intent(inout) :: summary
    real(wp) :: reach, deepest
    integer :: i

    select type (body => problem%body)
    type is (layered_body_t)
      reach = problem%length
      if (problem%law%edge_gap > 0 .and. problem%law%adhesion > 0) reach = &
        problem%law%adhesion*problem%pressure*problem%length/largest_tension(problem)
      deepest = 0
      if (summary%has('end_displacement')) deepest = -summary%number('end_h0')
      do i = 1, 2
        if (size(body%surface(i)%thickness) == 0) cycle
        associate (thickness => body%surface(i)%thickness*problem%lateral)
          if (minval(thickness) < reach) call summary%warn('beyond the model: a layer of ' // &
            short_number(minval(thickness)) // ' m is thinner than the range of the force, ' // &
            short_number(reach) // ' m; elasticity of bulk does not hold for it')
          if (body%bottom < 1 .and. deepest > strained*sum(thickness)) call summary%warn( &
            'beyond the model: the bodies are pressed together by ' // &
            short_number(deepest/sum(thickness)) // ' of the thickness of the layers; ' // &
            'strains are no longer small')
          exit
        end associate
      end do
    end select
  end subroutine judge_layers

end module layer_entries
