!> A measured curve as a model with given unknowns predicts it:
!>
!>     signal = F(Z)/(k s) + baseline of the segment + slope z ,   Z = facing (z - contact point) ,
!>
!> k: spring constant; s: sensitivity of the detector. The last response of the model is kept, since
!> a change of the contact point or of the sensitivity needs no new solution.
module modelled_curve
  use kinds, only: wp, nan
  use fit_request, only: unknown_t, of_model, of_contact_point, of_sensitivity, of_spring, of_radius
  use fit_samples, only: fit_samples_t
  use force_branch, only: load_at_t
  use force_model, only: force_model_t, response_t
  implicit none
  private
  public :: modelled_curve_t, beyond, level_of

  !> Smallest distance between the ends of contact, relative to the travel of the base. It is needed
  !> because a model with a single branch may have its innermost position at Z > 0.
  real(wp), parameter :: least_reach = 0.01_wp
  !> Limit of the ratio of the slope of the load to the spring constant. A sample with a larger
  !> slope is at the turn of its branch, where derivatives are unbounded and useless.
  real(wp), parameter :: steep = 10
  !> The model is solved up to this many times the largest signal, since the bodies of a trial may
  !> be too soft.
  real(wp), parameter :: beyond = 1.2_wp

  type :: modelled_curve_t
    !> The model must exist as long as this object is used.
    class(force_model_t), pointer :: model => null()
    type(fit_samples_t) :: data
    type(unknown_t), allocatable :: unknown(:)
    !> Values of spring constant, sensitivity and contact point, for those that are not unknowns.
    real(wp) :: spring = 1, sensitivity = 1, contact_point = 0
    !> Whether the signal is the force. The sensitivity then is 1/k for any k.
    logical :: is_force = .false.
    !> The largest slope of the signal over z outside jumps, set by the spring or by the contact.
    real(wp) :: largest_slope = huge(1.0_wp)
    !> The largest signal, without baseline, that the model must reach.
    real(wp) :: largest = 0
    type(response_t) :: response
    real(wp), allocatable, private :: asked(:)
    real(wp), private :: deepest = 0
    logical, private :: has_rates = .false.
  contains
    procedure :: use_model
    procedure :: needs_more
    procedure :: ask
    procedure :: signal_of
    procedure :: signal_rates
    procedure :: jump_of
    procedure :: jump_rates
    procedure :: split
    procedure :: reach
    procedure :: contact_height
    procedure, private :: number_of, positions_of, newtons
  end type modelled_curve_t

contains

  !> Sets another model; its response is computed later.
  subroutine use_model(self, model)
    class(modelled_curve_t), intent(inout) :: self
    class(force_model_t), intent(in), target :: model

    self%model => model
    if (allocated(self%asked)) deallocate (self%asked)
  end subroutine use_model

  !> Whether the model must reach a larger signal than so far; if so, the range of the model is
  !> extended. The spring cannot be deflected by more than the travel.
  logical function needs_more(self, signal)
    class(modelled_curve_t), intent(inout) :: self
    real(wp), intent(in) :: signal
    real(wp) :: most

    needs_more = .false.
    if (self%data%measured%under_loads()) return
    most = (maxval(self%data%measured%z) - minval(self%data%measured%z))/self%sensitivity
    needs_more = signal > self%largest .and. self%largest < most
    if (needs_more) self%largest = min(beyond*signal, most)
  end function needs_more

  !> Computes the response of the model for these values, unless the last response can be used.
  subroutine ask(self, value, with_rates, found)
    class(modelled_curve_t), intent(inout) :: self
    real(wp), intent(in) :: value(:)
    logical, intent(in) :: with_rates
    logical, intent(out) :: found
    real(wp), allocatable :: asked(:)
    real(wp) :: k, farthest, largest

    k = self%number_of(value, of_spring, self%spring)
    asked = [pack(value, self%unknown%role == of_model), k]
    largest = self%largest*self%newtons(value)
    found = allocated(self%asked)
    if (found) found = all(abs(asked - self%asked) <= 0) .and. largest <= self%deepest .and. &
      (self%has_rates .or. .not. with_rates)
    if (found) return
    if (allocated(self%asked)) deallocate (self%asked)
    ! Twice the travel is enough for any contact point.
    farthest = 2*(maxval(self%data%measured%z) - minval(self%data%measured%z))
    if (self%data%measured%under_loads()) farthest = 0
    call self%model%respond(asked(:size(asked) - 1), k, farthest, largest, with_rates, &
      self%response, found)
    if (.not. found) return
    self%asked = asked
    self%deepest = largest
    self%has_rates = with_rates
  end subroutine ask

  !> The model's signal at samples, without baseline, from the last response. side: the side of the
  !> jump, one for all samples; if it is absent, each sample is on the side on which it was
  !> measured.
  function signal_of(self, value, sample, side) result(signal)
    class(modelled_curve_t), intent(in) :: self
    real(wp), intent(in) :: value(:)
    integer, intent(in) :: sample(:)
    integer, intent(in), optional :: side
    real(wp) :: signal(size(sample))
    type(load_at_t) :: state
    real(wp) :: position(size(sample)), newtons
    integer :: i, n, on_side

    position = self%positions_of(value, sample)
    newtons = self%newtons(value)
    do n = 1, size(sample)
      i = sample(n)
      on_side = max(self%data%side(i), 0)
      if (present(side)) on_side = side
      if (self%data%measured%observed(i) == of_radius) then
        state = self%response%load_on(self%data%way(i), on_side, position(n))
        signal(n) = state%radius
      else
        signal(n) = self%response%value_on(self%data%way(i), on_side, position(n))/newtons
      end if
    end do
  end function signal_of

  !> Derivatives of the signal by the unknowns, (sample, unknown), at the samples that count.
  function signal_rates(self, value) result(by)
    class(modelled_curve_t), intent(in) :: self
    real(wp), intent(in) :: value(:)
    real(wp) :: by(size(self%data%sample), size(value))
    type(load_at_t) :: load
    real(wp) :: k, compliance, newtons, by_force, position(size(self%data%sample))
    integer :: i, n

    position = self%positions_of(value, self%data%sample)
    k = self%number_of(value, of_spring, self%spring)
    ! Under dead loads there is no spring.
    compliance = 0
    if (k > 0) compliance = 1/k
    newtons = self%newtons(value)
    ! If the signal is the force, it depends on the spring only through the position.
    by_force = merge(0.0_wp, compliance, self%is_force)
    do n = 1, size(self%data%sample)
      i = self%data%sample(n)
      load = self%response%load_on(self%data%way(i), self%data%side(i), position(n))
      by(n, :) = 0
      if (k > 0 .and. self%data%side(i) == 0 .and. &
        abs(load%slope)/(steep*newtons) > self%largest_slope) cycle
      if (self%data%measured%observed(i) == of_radius) then
        by(n, :) = unfolded(self%unknown%role, load%radius_rate, &
          -self%data%measured%facing*load%radius_slope, 0.0_wp, &
          load%radius_slope*load%load*compliance**2)
        cycle
      end if
      by(n, :) = unfolded(self%unknown%role, load%rate/newtons, &
        -self%data%measured%facing*load%slope/newtons, -load%load*k/newtons**2, &
        -(load%slope*compliance**2 + by_force)*load%load/newtons)
    end do
  end function signal_rates

  !> Position of the base at the start of the model's main jump on a segment; NaN without one.
  real(wp) function jump_of(self, value, way) result(z)
    class(modelled_curve_t), intent(in) :: self
    real(wp), intent(in) :: value(:)
    integer, intent(in) :: way
    real(wp) :: position, load
    real(wp), allocatable :: rate(:)

    z = nan
    if (self%response%way(way)%main == 0 .or. .not. self%response%way(way)%predicted) return
    call self%response%jump_from(way, position, rate, load)
    z = self%number_of(value, of_contact_point, self%contact_point) + &
      self%data%measured%facing*position
  end function jump_of

  !> Derivatives of `jump_of` by the unknowns; 0 without a jump.
  function jump_rates(self, value, way) result(by)
    class(modelled_curve_t), intent(in) :: self
    real(wp), intent(in) :: value(:)
    integer, intent(in) :: way
    real(wp) :: by(size(value)), position, load
    real(wp), allocatable :: rate(:)

    by = 0
    if (.not. self%response%way(way)%predicted .or. self%response%way(way)%main == 0) return
    call self%response%jump_from(way, position, rate, load)
    by = self%data%measured%facing*unfolded(self%unknown%role, rate, self%data%measured%facing, &
      0.0_wp, load/self%number_of(value, of_spring, self%spring)**2)
  end function jump_rates

  !> Collects the derivatives by the unknowns in their order, from those by the model's unknowns and
  !> those by contact point, sensitivity and spring.
  pure function unfolded(role, by_model, by_contact_point, by_sensitivity, by_spring) result(by)
    integer, intent(in) :: role(:)
    real(wp), intent(in) :: by_model(:), by_contact_point, by_sensitivity, by_spring
    real(wp) :: by(size(role))

    by = unpack(by_model, role == of_model, 0.0_wp)
    where (role == of_contact_point) by = by_contact_point
    where (role == of_sensitivity) by = by_sensitivity
    where (role == of_spring) by = by_spring
  end function unfolded

  !> The modelled signal with its baseline at all samples, and the baseline alone.
  subroutine split(self, value, model, baseline)
    class(modelled_curve_t), intent(in) :: self
    real(wp), intent(in) :: value(:)
    real(wp), allocatable, intent(out) :: model(:), baseline(:)
    integer :: i

    model = self%signal_of(value, [(i, i=1, size(self%data%way))])
    baseline = self%data%baseline_under(self%data%measured%signal - model)
    model = model + baseline
  end subroutine split

  !> The contact points for which the nearest sample lies at the inner end of the model's contact,
  !> at the outermost state in contact, and farther out than this state by the travel of the
  !> samples.
  subroutine reach(self, value, ends, found)
    class(modelled_curve_t), intent(inout) :: self
    real(wp), intent(in) :: value(:)
    real(wp), intent(out) :: ends(3)
    logical, intent(out) :: found
    real(wp) :: nearest, inner, outer, travel
    integer :: i

    ends = 0
    call self%ask(value, .false., found)
    if (.not. found) return
    nearest = minval(self%data%measured%facing*self%data%measured%z)
    travel = maxval(self%data%measured%z) - minval(self%data%measured%z)
    inner = huge(inner)
    outer = 0
    do i = 1, size(self%response%branch)
      associate (position => self%response%branch(i)%position)
        inner = min(inner, minval(position))
        if (i > 1) outer = max(outer, maxval(position))
      end associate
    end do
    outer = max(outer, inner + least_reach*travel)
    ! Z = facing (z - contact point), solved for the contact point.
    ends = self%data%measured%facing*(nearest - [inner, outer, outer + travel])
  end subroutine reach

  !> The contact point, whether it is fitted or given; NaN for contact radii under dead loads.
  pure real(wp) function contact_height(self, value)
    class(modelled_curve_t), intent(in) :: self
    real(wp), intent(in) :: value(:)

    contact_height = nan
    if (.not. self%data%measured%under_loads()) &
      contact_height = self%number_of(value, of_contact_point, self%contact_point)
  end function contact_height

  !> Positions of the base at samples.
  pure function positions_of(self, value, sample) result(position)
    class(modelled_curve_t), intent(in) :: self
    real(wp), intent(in) :: value(:)
    integer, intent(in) :: sample(:)
    real(wp) :: position(size(sample))

    position = self%data%measured%facing*(self%data%measured%z(sample) - &
      self%number_of(value, of_contact_point, self%contact_point))
    if (self%data%measured%under_loads()) position = position*self%newtons(value)
  end function positions_of

  !> The load of one unit of the signal, k s.
  pure real(wp) function newtons(self, value)
    class(modelled_curve_t), intent(in) :: self
    real(wp), intent(in) :: value(:)

    newtons = self%data%measured%load_of_unit()
    if (.not. self%is_force) newtons = self%number_of(value, of_spring, self%spring)* &
      self%number_of(value, of_sensitivity, self%sensitivity)
  end function newtons

  !> The value of the unknown with this role; `otherwise` if there is no such unknown.
  pure real(wp) function number_of(self, value, role, otherwise) result(number)
    class(modelled_curve_t), intent(in) :: self
    real(wp), intent(in) :: value(:), otherwise
    integer, intent(in) :: role
    integer :: i

    number = otherwise
    i = findloc(self%unknown%role, role, 1)
    if (i > 0) number = value(i)
  end function number_of

  !> The mean signal of the far samples.
  pure real(wp) function level_of(curve) result(level)
    type(modelled_curve_t), intent(in) :: curve

    associate (data => curve%data%measured)
      associate (far => data%far .and. data%usable)
        level = sum(data%signal, far)/max(1, count(far))
      end associate
    end associate
  end function level_of

end module modelled_curve
