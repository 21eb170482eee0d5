!> The model for bodies that only repel each other. There is one state for every h0; therefore h0 is
!> stepped from large separations into contact, and the loads at these steps form the only branch.
!> Derivatives by the unknowns are finite differences between the loads of two other problems at the
!> same h0.
module stepped_model
  use kinds, only: wp
  use failure, only: failure_t
  use dimensionless_problem, only: problem_t
  use variation, only: problem_family_t
  use undeformed, only: load_undeformed
  use convex_contact, only: hertz_like_load
  use interpolation, only: polynomial_slope
  use root_finding, only: bracket_t
  use contact_scales, only: contact_level
  use edge_locked, only: new_mesh_family
  use mesh_store, only: mesh_store_t
  use stepper, only: branch_point_t, step_result_t
  use locked_stepper, only: unique_stepper_t
  use experiment_request, only: request_t, numerics_t
  use numerics_choice, only: choice_t, choose
  use fit_request, only: change
  use force_branch, only: force_branch_t
  use force_model, only: force_model_t, response_t, inward, outward
  implicit none
  private
  public :: stepped_model_t

  !> Numbers of panels: where bodies do not deform, from there to the beginning of contact, and in
  !> contact. Number of neighbours on each side of a load that determine its slope.
  integer, parameter :: afar = 24, near = 32, within = 48, neighbours = 2
  !> Distance from contact, in lengths L of the force law, beyond which the bodies do not deform,
  !> since the exponential is smaller than rounding errors. Natural logarithm of the largest contact
  !> radius in the search.
  real(wp), parameter :: no_deformation = 36, widest_power = 60
  !> Ratio of the depth to that of a Hertzian contact under the largest load; how often the depth is
  !> doubled at most if this is not enough.
  real(wp), parameter :: deeper = 1.3_wp
  integer, parameter :: most_doublings = 12

  type, extends(force_model_t) :: stepped_model_t
    !> The problems; the unknowns are its parameters.
    class(problem_family_t), allocatable :: family
    type(numerics_t) :: numerics
    type(mesh_store_t), private :: store
  contains
    procedure :: respond
    procedure, private :: find_loads
  end type stepped_model_t

contains

  subroutine respond(self, value, stiffness, farthest, largest, with_rates, response, found)
    class(stepped_model_t), intent(inout) :: self
    real(wp), intent(in) :: value(:), stiffness, farthest, largest
    logical, intent(in) :: with_rates
    type(response_t), intent(out) :: response
    logical, intent(out) :: found
    real(wp), allocatable :: h0(:), load(:), more(:), less(:), rate(:, :)
    type(problem_t) :: problem
    type(failure_t), allocatable :: error
    real(wp) :: varied(size(value)), off, begins
    integer :: i

    call self%family%pose(value, problem, error)
    found = .not. allocated(error)
    if (.not. found) return
    call lay_out_h0(problem, farthest, largest, h0)
    do i = 0, most_doublings
      call self%find_loads(value, h0, load, found)
      if (.not. found) return
      if (load(size(load)) >= largest) exit
      begins = h0(afar + near + 1)
      where (h0 < begins) h0 = begins + 2*(h0 - begins)
    end do
    found = load(size(load)) >= largest
    if (.not. found) return
    allocate (rate(merge(size(value), 0, with_rates), size(h0)))
    do i = 1, size(rate, 1)
      off = change*merge(abs(value(i)), 1.0_wp, abs(value(i)) > 0)
      varied = value
      varied(i) = value(i) + off
      call self%find_loads(varied, h0, more, found)
      varied(i) = value(i) - off
      if (found) call self%find_loads(varied, h0, less, found)
      if (.not. found) return
      rate(i, :) = (more - less)/(2*off)
    end do
    allocate (response%branch(1))
    call make_branch(h0, load, rate, response%branch(1))
    call response%branch(1)%close(stiffness)
    do i = inward, outward
      response%way(i)%branch = [1]
      response%way(i)%leaves_at = [merge(-huge(1.0_wp), huge(1.0_wp), i == inward)]
    end do
  end subroutine respond

  !> Values of h0 [m], from large to small. They are evenly spaced in the logarithm where bodies do
  !> not deform, and denser towards the beginning of contact. In contact they are spaced as squares,
  !> since the Hertzian load is a power of the depth. The depth is that of Hertz theory for a
  !> half-space.
  subroutine lay_out_h0(problem, farthest, largest, h0)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: farthest, largest
    real(wp), allocatable, intent(out) :: h0(:)
    type(bracket_t) :: bracket
    real(wp) :: depth, begins, outer
    integer :: i

    bracket = bracket_t(-widest_power, widest_power)
    do while (bracket%is_open())
      call bracket%narrow(hertz_like_load(problem, exp(bracket%middle()))*problem%load < largest)
    end do
    depth = deeper*problem%shape%indentation(exp(bracket%middle()))*problem%length
    begins = problem%law%separation_of(contact_level(problem))
    outer = no_deformation*problem%length
    h0 = [[(begins + outer*(max(farthest, 2*outer)/outer)**(real(afar - i, wp)/afar), i=0, &
      afar - 1)], [(begins + outer*(1 - i/real(near, wp))**2, i=0, near - 1)], &
      [(begins - depth*(i/real(within, wp))**2, i=0, within)]]
  end subroutine lay_out_h0

  !> The loads [N] at values of h0 [m]. Where the bodies do not deform, the loads are those of
  !> undeformed bodies.
  subroutine find_loads(self, value, h0, load, found)
    class(stepped_model_t), intent(inout) :: self
    real(wp), intent(in) :: value(:), h0(:)
    real(wp), allocatable, intent(out) :: load(:)
    logical, intent(out) :: found
    type(unique_stepper_t) :: steps
    type(branch_point_t) :: position
    type(step_result_t) :: event
    type(request_t) :: request
    type(problem_t) :: problem
    type(choice_t) :: chosen
    type(failure_t), allocatable :: error
    integer :: i
    logical :: begun

    allocate (load(size(h0)))
    call self%family%pose(value, problem, error)
    found = .not. allocated(error)
    if (.not. found) return
    request%numerics = self%numerics
    allocate (request%path)
    request%path%h0_end = h0(size(h0))
    chosen = choose(request, problem)
    call steps%set_up(problem, chosen%options)
    steps%options%mixing = .false.
    steps%meshes = new_mesh_family(problem, chosen%high, chosen%low, chosen%digits, &
      store=self%store)
    begun = .false.
    do i = 1, size(h0)
      associate (gap => problem%law%gap_of(h0(i)))
        if (i <= afar) then
          load(i) = problem%load*load_undeformed(problem, gap)
          cycle
        end if
        if (begun) then
          call steps%step_to(gap, position, event)
        else
          call steps%approach_to(gap, position, event)
        end if
      end associate
      begun = .true.
      found = event%converged .and. .not. event%ending%early()
      if (.not. found) return
      load(i) = problem%load*position%state%load
    end do
  end subroutine find_loads

  !> The branch through the loads at values of h0. The slope at a load is that of the polynomial
  !> through this load and its neighbours.
  subroutine make_branch(h0, load, rate, branch)
    real(wp), intent(in) :: h0(:), load(:), rate(:, :)
    type(force_branch_t), intent(out) :: branch
    real(wp), dimension(size(h0)) :: slope
    integer :: i, n

    n = size(h0) - 1
    do i = 1, n + 1
      associate (first => max(1, min(i - neighbours, n + 1 - 2*neighbours)))
        associate (last => first + 2*neighbours)
          slope(i) = polynomial_slope(h0(first:last), load(first:last), h0(i))
        end associate
      end associate
    end do
    allocate (branch%panel(n))
    do i = 1, n
      associate (panel => branch%panel(i))
        ! The coordinate is -h0, which increases along the branch.
        panel%ends = -h0(i:i + 1)
        panel%x = panel%ends
        panel%h0 = reshape([h0(i), -1.0_wp, h0(i + 1), -1.0_wp], [2, 2])
        panel%load = reshape([load(i), -slope(i), load(i + 1), -slope(i + 1)], [2, 2])
        panel%load_rate = rate(:, i:i + 1)
        panel%h0_rate = 0*panel%load_rate
      end associate
    end do
  end subroutine make_branch

end module stepped_model
