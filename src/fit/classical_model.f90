!> The theories of JKR, DMT and Maugis-Dugdale as models of a measured curve, and Hertz's for bodies
!> that do not attract each other. Bodies in contact follow the theory's curve, ordered by contact
!> radius. In these theories separated bodies have no force, and there is no snap-in.
module classical_model
  use kinds, only: wp
  use root_finding, only: bracket_t
  use classical, only: jkr_load, jkr_displacement, dmt_load, hertz_displacement, hertz, jkr, dmt, &
    maugis_dugdale
  use maugis, only: maugis_t, new_maugis
  use fit_request, only: fine_change
  use force_branch, only: force_branch_t, weights_of
  use force_model, only: force_model_t, response_t, way_t, inward, outward
  implicit none
  private
  public :: classical_model_t, adhesive

  !> The theories of bodies that attract each other, by their numbers in `classical`.
  integer, parameter :: adhesive(*) = [jkr, dmt, maugis_dugdale]

  !> Number of panels of the branch in contact.
  integer, parameter :: panels = 200
  !> Number of contact radii at which the position is computed to find its maximum; ratio of the
  !> smallest of these radii to the largest; number of sections that refine the maximum.
  integer, parameter :: tried = 400, sections = 60
  !> These radii grow as i**2, with i from 0 to `tried`; `first` stands for the i of the first one,
  !> which is not 0.
  real(wp), parameter :: first = 0.01_wp

  !> The unknowns are the work of adhesion w [J/m^2] and the plane-strain modulus (`stiffness`)
  !> [Pa]. If one of them is not fitted, its value is `work` or `stiffness`. theory: one of
  !> `adhesive`, or Hertz's. radius [m]: the radius of the bodies; range [m]: the range of the
  !> tension in Maugis-Dugdale theory.
  type, extends(force_model_t) :: classical_model_t
    integer :: theory = jkr
    real(wp) :: radius = 1, work = 1, stiffness = 1, range = 1
    logical :: finds_work = .true., finds_stiffness = .true.
  contains
    procedure :: respond
  end type classical_model_t

contains

  subroutine respond(self, value, stiffness, farthest, largest, with_rates, response, found)
    class(classical_model_t), intent(inout) :: self
    real(wp), intent(in) :: value(:), stiffness, farthest, largest
    logical, intent(in) :: with_rates
    type(response_t), intent(out) :: response
    logical, intent(out) :: found
    real(wp) :: number(2), widest, turn
    integer :: unknowns

    number = [self%work, self%stiffness]
    number(pack([1, 2], [self%finds_work, self%finds_stiffness])) = value
    if (self%theory == hertz) number(1) = 0
    ! The Hertzian contact radius under the largest load plus a hundred times the adhesion.
    widest = (1.5_wp*self%radius*(2*max(largest, 0.0_wp) + 100*number(1)*self%radius)/ &
      number(2))**(1.0_wp/3)
    turn = turning_radius(self, number, weights_of(stiffness), widest)
    found = turn < 0.5_wp*widest
    if (.not. found) return
    allocate (response%branch(2))
    unknowns = merge(size(value), 0, with_rates)
    associate (apart => response%branch(1))
      ! Separated bodies have no load. The panel lets h0 fall linearly from farther than any
      ! position.
      allocate (apart%panel(1))
      associate (panel => apart%panel(1))
        panel%x = panel%ends
        panel%h0 = widest*reshape([1, -1, 0, -1], [2, 2])
        panel%load = 0*panel%h0
        allocate (panel%h0_rate(unknowns, 2), panel%load_rate(unknowns, 2), source=0.0_wp)
        panel%square = panel%load
        panel%square_rate = panel%load_rate
      end associate
      apart%turns_last = .true.
    end associate
    call set_in_contact(self, number, turn, widest, unknowns, response%branch(2))
    call response%branch(1)%close(stiffness)
    call response%branch(2)%close(stiffness)
    response%way(inward) = way_t([1, 2], [0.0_wp, -huge(1.0_wp)], 1, .false.)
    response%way(outward) = way_t([2, 1], [response%branch(2)%position(1), huge(1.0_wp)], 1)
    ! Without adhesion there is no jump.
    if (self%theory == hertz) response%way%main = 0
    if (stiffness > 0) return
    response%way(inward) = way_t([2], [-huge(1.0_wp)])
    response%way(outward) = way_t([2], [huge(1.0_wp)])
  end subroutine respond

  !> The branch in contact, from the turn of the position towards the other body. Panels become
  !> longer as the contact grows.
  subroutine set_in_contact(model, number, turn, widest, unknowns, branch)
    class(classical_model_t), intent(in) :: model
    real(wp), intent(in) :: number(2), turn, widest
    integer, intent(in) :: unknowns
    type(force_branch_t), intent(inout) :: branch
    real(wp) :: a, edge(0:panels), now(2), by_a(2), rate(2)
    integer, allocatable :: which(:)
    integer :: i, k, side

    which = pack([1, 2], [model%finds_work, model%finds_stiffness])
    edge = [(turn + (widest - turn)*(real(i, wp)/panels)**2, i=0, panels)]
    allocate (branch%panel(panels))
    branch%turns_first = .true.
    do i = 1, panels
      associate (panel => branch%panel(i))
        panel%ends = edge(i - 1:i)
        panel%x = panel%ends
        allocate (panel%h0(2, 2), panel%load(2, 2), panel%h0_rate(unknowns, 2), &
          panel%load_rate(unknowns, 2), panel%square(2, 2))
        allocate (panel%square_rate(unknowns, 2), source=0.0_wp)
        do side = 1, 2
          a = panel%x(side)
          now = state(model, number, a)
          by_a = (state(model, number, a*(1 + fine_change)) - &
            state(model, number, a*(1 - fine_change)))/(2*fine_change*a)
          panel%h0(:, side) = [now(1), by_a(1)]
          panel%load(:, side) = [now(2), by_a(2)]
          panel%square(:, side) = [a**2, 2*a]
          do k = 1, unknowns
            rate = varied(model, number, which(k), a)
            panel%h0_rate(k, side) = rate(1)
            panel%load_rate(k, side) = rate(2)
          end do
        end do
      end associate
    end do
  end subroutine set_in_contact

  !> Derivatives of h0 and load by number k.
  pure function varied(model, number, k, a)
    class(classical_model_t), intent(in) :: model
    real(wp), intent(in) :: number(2), a
    integer, intent(in) :: k
    real(wp) :: varied(2), more(2), less(2)

    more = number
    less = number
    more(k) = number(k)*(1 + fine_change)
    less(k) = number(k)*(1 - fine_change)
    varied = (state(model, more, a) - state(model, less, a))/(2*fine_change*number(k))
  end function varied

  !> h0 and load at a contact radius. number: work of adhesion and stiffness.
  pure function state(model, number, a)
    class(classical_model_t), intent(in) :: model
    real(wp), intent(in) :: number(2), a
    real(wp) :: state(2)
    type(maugis_t) :: theory

    associate (r => model%radius, w => number(1), y => number(2))
      select case (model%theory)
      case (jkr)
        state = [-jkr_displacement(a, r, y, w), jkr_load(a, r, y, w)]
      case (dmt, hertz)
        state = [-hertz_displacement(a, r), dmt_load(a, r, y, w)]
      case default
        theory = new_maugis(r, y, w, w/model%range)
        state = [-theory%displacement(a), theory%load(a)]
      end select
    end associate
  end function state

  !> The contact radius at which the position of the drive is largest.
  pure real(wp) function turning_radius(model, number, weights, widest) result(turn)
    class(classical_model_t), intent(in) :: model
    real(wp), intent(in) :: number(2), weights(2), widest
    type(bracket_t) :: bracket
    real(wp) :: at(0:tried), position(0:tried), points(2)
    integer :: i

    at = [(widest*(max(real(i, wp), first)/tried)**2, i=0, tried)]
    position = [(position_at(at(i)), i=0, tried)]
    i = maxloc(position, 1) - 1
    bracket = bracket_t(at(max(i - 1, 0)), at(min(i + 1, tried)))
    do i = 1, sections
      points = bracket%golden_points()
      call bracket%keep_larger([position_at(points(1)), position_at(points(2))])
    end do
    turn = bracket%middle()

  contains

    pure real(wp) function position_at(a)
      real(wp), intent(in) :: a

      position_at = dot_product(state(model, number, a), weights)
    end function position_at

  end function turning_radius

end module classical_model
