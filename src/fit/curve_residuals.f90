!> What a model with given unknowns leaves of a measured curve:
!>
!>     signal = F(Z)/(k s) + baseline of the way + slope z ,   Z = facing (z - contact point) ,
!>
!> k the spring's stiffness, s the detector's sensitivity. Baselines and slope enter linearly: the
!> residuals are what is left when the best ones are taken off (variable projection; Golub and
!> Pereyra, 1973; `baseline`). Samples are made white first. Where a jump starts is a datum of its
!> own, and so is what is known of an unknown before; no sample within a jump counts.
module curve_residuals
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kinds, only: wp
  use fit_request, only: unknown_t, of_model, of_contact_point, of_sensitivity, of_spring
  use fit_samples, only: fit_samples_t
  use force_model, only: force_model_t, response_t
  use force_branch, only: load_at_t
  use least_squares, only: residuals_t
  use unknowns, only: value_of, value_by_free, value_by_fitted, fitted_of
  implicit none
  private
  public :: curve_residuals_t

  !> What a jump that the model does not have counts, in standard deviations.
  real(wp), parameter :: missed = 10
  !> A trial is no farther than a factor of exp of this from the deck's value: paths of problems
  !> that are nothing like it may take for ever.
  real(wp), parameter :: farthest_off = 5

  type, extends(residuals_t) :: curve_residuals_t
    class(force_model_t), pointer, private :: model => null()
    type(fit_samples_t) :: data
    type(unknown_t), allocatable :: unknown(:)
    !> Spring, detector and contact point where they are no unknowns. Where the signal is the force,
    !> it is the deflection of the deck's spring.
    real(wp) :: spring = 1, sensitivity = 1, contact_point = 0
    !> Signals up to this are wanted of the model, less their baseline.
    real(wp) :: largest = 0
    type(response_t), private :: response
    real(wp), allocatable, private :: asked(:)
    real(wp), private :: deepest = 0
    logical, private :: has_rates = .false.
  contains
    procedure :: set_model
    procedure :: rows
    procedure :: values
    procedure :: residuals_of
    procedure :: reach
    procedure :: evaluate
    procedure :: differentiate
    procedure :: jacobian_of
    procedure :: split
    procedure :: jump_of
    procedure, private :: ask, number_of, signal_of
  end type curve_residuals_t

contains

  !> Sets the model, which is to live as long as it is asked, or none.
  subroutine set_model(self, model)
    class(curve_residuals_t), intent(inout) :: self
    class(force_model_t), intent(in), target, optional :: model

    nullify (self%model)
    if (present(model)) self%model => model
    if (allocated(self%asked)) deallocate (self%asked)
  end subroutine set_model

  !> Number of residuals: samples, jumps that the theory speaks of, what was known before.
  pure integer function rows(self)
    class(curve_residuals_t), intent(in) :: self

    rows = size(self%data%sample) + count(self%data%jump%before > 0) + count(self%unknown%prior > 0)
  end function rows

  !> The values of the unknowns.
  pure function values(self, x) result(value)
    class(curve_residuals_t), intent(in) :: self
    real(wp), intent(in) :: x(:)
    real(wp) :: value(size(x))
    integer :: i

    value = [(value_of(self%unknown(i), x(i)), i=1, size(x))]
  end function values

  subroutine evaluate(self, x, residual, found)
    class(curve_residuals_t), intent(inout) :: self
    real(wp), intent(in) :: x(:)
    real(wp), intent(out) :: residual(:)
    logical, intent(out) :: found

    call self%residuals_of(self%values(x), residual, found)
  end subroutine evaluate

  !> The residuals at values of the unknowns.
  subroutine residuals_of(self, value, residual, found)
    class(curve_residuals_t), intent(inout) :: self
    real(wp), intent(in) :: value(:)
    real(wp), intent(out) :: residual(:)
    logical, intent(out) :: found
    real(wp) :: left(size(self%data%sample), 1)
    integer :: i, n

    found = .not. any(self%unknown%in_log .and. &
      abs(fitted_of(self%unknown, value)) > farthest_off)
    if (found) call self%ask(value, .false., found)
    if (.not. found) return
    associate (s => self%data%sample)
      left(:, 1) = self%data%measured%signal(s) - self%signal_of(value, s)
    end associate
    n = size(self%data%sample)
    call self%data%clean(left)
    residual(:n) = left(:, 1)
    do i = 1, 2
      if (self%data%jump(i)%before == 0) cycle
      n = n + 1
      residual(n) = jump_residual(self, value, i)
    end do
    do i = 1, size(value)
      if (.not. self%unknown(i)%prior > 0) cycle
      n = n + 1
      residual(n) = (fitted_of(self%unknown(i), value(i)) - &
        fitted_of(self%unknown(i), self%unknown(i)%value))/prior_of(self%unknown(i))
    end do
  end subroutine residuals_of

  subroutine differentiate(self, x, jacobian, found)
    class(curve_residuals_t), intent(inout) :: self
    real(wp), intent(in) :: x(:)
    real(wp), intent(out) :: jacobian(:, :)
    logical, intent(out) :: found
    integer :: i

    call self%jacobian_of(self%values(x), jacobian, found)
    if (.not. found) return
    do i = 1, size(x)
      jacobian(:, i) = jacobian(:, i)*value_by_free(self%unknown(i), x(i))
    end do
  end subroutine differentiate

  !> Derivatives of the residuals by the values of the unknowns.
  subroutine jacobian_of(self, value, jacobian, found)
    class(curve_residuals_t), intent(inout) :: self
    real(wp), intent(in) :: value(:)
    real(wp), intent(out) :: jacobian(:, :)
    logical, intent(out) :: found
    type(load_at_t) :: load
    real(wp) :: by(size(self%data%sample), size(value)), k
    integer :: i, j, n

    call self%ask(value, .true., found)
    if (.not. found) return
    k = self%number_of(value, of_spring, self%spring)
    associate (facing => self%data%measured%facing, s => self%number_of(value, of_sensitivity, &
      self%sensitivity))
      do n = 1, size(self%data%sample)
        i = self%data%sample(n)
        load = self%response%load_on(self%data%way(i), self%data%side(i), &
          position_of(self, value, i))
        by(n, :) = -unfolded(self%unknown%role, load%rate/(k*s), -facing*load%slope/(k*s), &
          -load%load/(k*s**2), -(load%slope*load%load/k**2 + load%load/k)/(k*s))
      end do
      n = size(self%data%sample)
      call self%data%clean(by)
      jacobian(:n, :) = by
      do i = 1, 2
        if (self%data%jump(i)%before == 0) cycle
        n = n + 1
        jacobian(n, :) = jump_rates(self, i, k, facing)
      end do
    end associate
    do j = 1, size(value)
      if (.not. self%unknown(j)%prior > 0) cycle
      n = n + 1
      jacobian(n, :) = 0
      jacobian(n, j) = 1/(prior_of(self%unknown(j))*value_by_fitted(self%unknown(j), value(j)))
    end do
  end subroutine jacobian_of

  !> What is known before of an unknown, as a deviation of its fitted number.
  pure real(wp) function prior_of(unknown) result(deviation)
    type(unknown_t), intent(in) :: unknown

    deviation = unknown%prior/value_by_fitted(unknown, unknown%value)
  end function prior_of

  !> Where the model's jump starts, less where the measured one does, over its uncertainty.
  real(wp) function jump_residual(self, value, way) result(residual)
    class(curve_residuals_t), intent(in) :: self
    real(wp), intent(in) :: value(:)
    integer, intent(in) :: way

    residual = 0
    if (.not. self%response%way(way)%foretold) return
    residual = missed
    if (self%response%way(way)%main == 0) return
    residual = self%data%measured%facing*(self%jump_of(value, way) - self%data%jump(way)%z)/ &
      self%data%jump(way)%uncertainty
  end function jump_residual

  !> Where the base is when the model's main jump on a way starts; NaN without one.
  real(wp) function jump_of(self, value, way) result(z)
    class(curve_residuals_t), intent(in) :: self
    real(wp), intent(in) :: value(:)
    integer, intent(in) :: way
    real(wp) :: position, load
    real(wp), allocatable :: rate(:)

    z = ieee_value(z, ieee_quiet_nan)
    if (self%response%way(way)%main == 0 .or. .not. self%response%way(way)%foretold) return
    call self%response%jump_from(way, position, rate, load)
    z = self%number_of(value, of_contact_point, self%contact_point) + &
      self%data%measured%facing*position
  end function jump_of

  !> Its derivatives.
  function jump_rates(self, way, k, facing) result(by)
    class(curve_residuals_t), intent(in) :: self
    integer, intent(in) :: way
    real(wp), intent(in) :: k, facing
    real(wp) :: by(size(self%unknown))
    real(wp) :: position, load
    real(wp), allocatable :: rate(:)

    by = 0
    if (.not. self%response%way(way)%foretold .or. self%response%way(way)%main == 0) return
    call self%response%jump_from(way, position, rate, load)
    by = unfolded(self%unknown%role, rate, facing, 0.0_wp, load/k**2)/ &
      self%data%jump(way)%uncertainty
  end function jump_rates

  !> Derivatives by the unknowns in their order, from those by the model's and by the others.
  pure function unfolded(role, by_model, by_contact_point, by_sensitivity, by_spring) result(by)
    integer, intent(in) :: role(:)
    real(wp), intent(in) :: by_model(:), by_contact_point, by_sensitivity, by_spring
    real(wp) :: by(size(role))

    by = unpack(by_model, role == of_model, 0.0_wp)
    where (role == of_contact_point) by = by_contact_point
    where (role == of_sensitivity) by = by_sensitivity
    where (role == of_spring) by = by_spring
  end function unfolded

  !> The model's part of the signal at samples, for the values asked for last.
  function signal_of(self, value, sample) result(signal)
    class(curve_residuals_t), intent(in) :: self
    real(wp), intent(in) :: value(:)
    integer, intent(in) :: sample(:)
    real(wp) :: signal(size(sample))
    type(load_at_t) :: load
    integer :: i, n

    do n = 1, size(sample)
      i = sample(n)
      load = self%response%load_on(self%data%way(i), max(self%data%side(i), 0), &
        position_of(self, value, i))
      signal(n) = load%load
    end do
    signal = signal/(self%number_of(value, of_spring, self%spring)* &
      self%number_of(value, of_sensitivity, self%sensitivity))
  end function signal_of

  !> The model with its baseline at all samples, and the baseline alone.
  subroutine split(self, value, model, baseline)
    class(curve_residuals_t), intent(in) :: self
    real(wp), intent(in) :: value(:)
    real(wp), allocatable, intent(out) :: model(:), baseline(:)
    integer :: i

    model = self%signal_of(value, [(i, i=1, size(self%data%way))])
    baseline = self%data%baseline_under(self%data%measured%signal - model)
    model = model + baseline
  end subroutine split

  !> The contact points with which the nearest sample is anywhere from the end of what the model
  !> knows of the contact out to where nothing holds the bodies together.
  subroutine reach(self, value, ends, found)
    class(curve_residuals_t), intent(inout) :: self
    real(wp), intent(in) :: value(:)
    real(wp), intent(out) :: ends(2)
    logical, intent(out) :: found
    real(wp) :: nearest, inner, outer
    integer :: i

    ends = 0
    call self%ask(value, .false., found)
    if (.not. found) return
    nearest = minval(self%data%measured%facing*self%data%measured%z)
    inner = huge(inner)
    outer = 0
    do i = 1, size(self%response%branch)
      associate (position => self%response%branch(i)%position)
        inner = min(inner, minval(position))
        if (i > 1) outer = max(outer, maxval(position))
      end associate
    end do
    ! Z = facing z - facing (contact point).
    ends = self%data%measured%facing*(nearest - [inner, outer])
  end subroutine reach

  !> Position of the drive at a sample.
  pure real(wp) function position_of(self, value, i) result(position)
    class(curve_residuals_t), intent(in) :: self
    real(wp), intent(in) :: value(:)
    integer, intent(in) :: i

    position = self%data%measured%facing*(self%data%measured%z(i) - &
      self%number_of(value, of_contact_point, self%contact_point))
  end function position_of

  !> The value of the unknown with a role; `otherwise` where there is none.
  pure real(wp) function number_of(self, value, role, otherwise) result(number)
    class(curve_residuals_t), intent(in) :: self
    real(wp), intent(in) :: value(:), otherwise
    integer, intent(in) :: role
    integer :: i

    number = otherwise
    i = findloc(self%unknown%role, role, 1)
    if (i > 0) number = value(i)
  end function number_of

  !> Has the model answer for these values, unless it has.
  subroutine ask(self, value, with_rates, found)
    class(curve_residuals_t), intent(inout) :: self
    real(wp), intent(in) :: value(:)
    logical, intent(in) :: with_rates
    logical, intent(out) :: found
    real(wp), allocatable :: asked(:)
    real(wp) :: k, farthest, largest

    k = self%number_of(value, of_spring, self%spring)
    asked = [pack(value, self%unknown%role == of_model), k]
    largest = self%largest*k*self%number_of(value, of_sensitivity, self%sensitivity)
    found = allocated(self%asked)
    if (found) found = all(abs(asked - self%asked) <= 0) .and. largest <= self%deepest .and. &
      (self%has_rates .or. .not. with_rates)
    if (found) return
    if (allocated(self%asked)) deallocate (self%asked)
    ! From twice the travel, wherever the contact point is.
    farthest = 2*(maxval(self%data%measured%z) - minval(self%data%measured%z))
    call self%model%respond(asked(:size(asked) - 1), k, farthest, largest, with_rates, &
      self%response, found)
    if (.not. found) return
    self%asked = asked
    self%deepest = largest
    self%has_rates = with_rates
  end subroutine ask

end module curve_residuals
