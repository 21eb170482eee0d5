!> A force law from a file of gaps and pressures, or of gaps and energies per area, measured or
!> computed.
module tabulated
  use kinds, only: wp
  use failure, only: failure_t
  use deck, only: deck_t
  use deck_keys, only: key_spec, real_value, word_value, text_value
  use data_table, only: data_table_t, read_columns
  use force_law, only: force_law_t, of_pressure, of_energy, closure_of_power, length_of_power, &
    usual_closure, nearest_power
  use force_table, only: force_table_t, new_force_table, largest_step
  use table_noise, only: noise_of, noise_of_integral
  use group_reading, only: check_decades
  implicit none
  private
  public :: keys, read_law

  type, extends(force_law_t) :: tabulated_t
    !> fine: the table. coarse: the table of every second point. share: ratio of the error of the
    !> table to the difference of these two.
    type(force_table_t) :: fine, coarse
    real(wp) :: share = 1
    !> Change of the energy of the tail if the pressure fell as the last points do.
    real(wp) :: tail_error = 0
    !> Errors of pressure and energy at the points due to the noise of the points.
    real(wp), allocatable :: noise(:, :)
  contains
    procedure :: evaluate
    procedure :: table_error
    procedure, private :: error_between
  end type tabulated_t

  integer, parameter :: fewest = 8
  !> Number of standard deviations that an error due to noise is unlikely to exceed.
  real(wp), parameter :: likely = 2
  !> The tail is compared with the points beyond this fraction of the last gap. Smallest amount by
  !> which the power of a falling pressure exceeds one.
  real(wp), parameter :: end_of_lever = 0.8_wp, nearly_none = 0.01_wp
  !> Relative error of a table's pressure, relative to the accuracy, that has no effect on a path;
  !> and the smallest error for which splitting integrals at the points is worth the time.
  real(wp), parameter :: unnoticed = 1.0_wp/30, least = 1.0e-6_wp
  !> The error of a spline decreases as the fourth power of the distance of points. With monotone
  !> slopes it decreases as the second power at an extremum.
  real(wp), parameter :: share_of_spline = 1.0_wp/15, share_of_monotone = 1.0_wp/3

  !> The rows of &tabulated.
  type(key_spec), parameter :: keys(*) = [ &
    key_spec('tabulated', meaning='A law from a file. Give tail_exponent or tail_decay_length.', &
      choices='&tabulated file = ''law.txt'', tail_exponent = 3 /'), &
    key_spec('tabulated', 'file', text_value, 'File of two columns, gap and quantity in SI, # ' // &
      'before comments; a relative path begins at the deck''s folder.', most=1000, &
      required=.true.), &
    key_spec('tabulated', 'quantity', word_value, 'The second column: pressure [Pa] or energy ' // &
      'per area [J/m^2].', choices='pressure energy', default='pressure'), &
    key_spec('tabulated', 'interpolation', word_value, 'Smooth curvature, or no extremum ' // &
      'between points.', choices='spline monotone', default='spline'), &
    key_spec('tabulated', 'tail_exponent', real_value, 'Beyond the last point the pressure ' // &
      'falls as this power of the gap: 3 for van der Waals attraction.', above=1.0_wp, &
      high=30.0_wp, otherwise='none'), &
    key_spec('tabulated', 'tail_decay_length', real_value, 'Beyond the last point the ' // &
      'pressure falls by a factor of e over this length.', 'm', above=0.0_wp, otherwise='none')]

contains

  !> Reads the law from its group.
  subroutine read_law(deck, law)
    type(deck_t), intent(inout) :: deck
    class(force_law_t), allocatable, intent(out) :: law
    type(tabulated_t) :: this
    type(failure_t), allocatable :: trouble
    type(data_table_t) :: table

    if (deck%is_set('tabulated', 'tail_exponent') .eqv. &
        deck%is_set('tabulated', 'tail_decay_length')) then
      call deck%mistake('tabulated', 'tail_exponent', 'give tail_exponent or ' // &
        'tail_decay_length, one of the two, for gaps beyond the table')
      return
    end if
    call read_columns(deck, 'tabulated', 'file', fewest, table, trouble)
    if (.not. allocated(trouble)) call put_in_order(table, trouble)
    if (allocated(trouble)) then
      call deck%mistake('tabulated', 'file', 'the table cannot be used: ' // trouble%message)
      return
    end if
    call take_table(deck, table, this)
    if (.not. allocated(deck%error)) allocate (law, source=this)
  end subroutine read_law

  !> Puts gaps in ascending order; fails if they neither ascend nor descend, or are not positive.
  subroutine put_in_order(table, error)
    type(data_table_t), intent(inout) :: table
    type(failure_t), allocatable, intent(inout) :: error
    integer :: i

    associate (gap => table%value(:, 1), n => size(table%place))
      do i = 1, n
        if (.not. gap(i) > 0) then
          call table%source%complain(table%place(i), 'a gap that is not positive', error)
          return
        end if
        if (i == 1) cycle
        if ((gap(i) - gap(i - 1))*(gap(2) - gap(1)) > 0) cycle
        call table%source%complain(table%place(i), 'gaps neither increase all the way nor ' // &
          'decrease', error)
        return
      end do
      if (gap(1) < gap(n)) return
    end associate
    table%value = table%value(size(table%place):1:-1, :)
    table%place = table%place(size(table%place):1:-1)
  end subroutine put_in_order

  !> Makes the law of an ordered table, in units of its first gap and of its largest value.
  subroutine take_table(deck, table, this)
    type(deck_t), intent(inout) :: deck
    type(data_table_t), intent(inout) :: table
    type(tabulated_t), intent(inout) :: this
    character(len=:), allocatable :: quantity, interpolation
    real(wp), allocatable :: g(:), value(:)
    real(wp) :: exponent, decay_length
    integer :: n, i

    n = size(table%place)
    exponent = 2
    decay_length = 0
    call deck%get('tabulated', 'quantity', quantity)
    call deck%get('tabulated', 'interpolation', interpolation)
    call deck%get('tabulated', 'tail_exponent', exponent)
    call deck%get('tabulated', 'tail_decay_length', decay_length)
    this%length = table%value(1, 1)
    this%known_from = this%length
    g = table%value(:, 1)/this%length
    this%pressure_unit = maxval(abs(table%value(:, 2)))
    value = table%value(:, 2)/max(this%pressure_unit, tiny(1.0_wp))
    if (quantity == 'energy') this%pressure_unit = this%pressure_unit/this%length
    call check_decades(deck, 'tabulated', 'file', &
      log10(max(this%pressure_unit, tiny(1.0_wp))), 'a pressure', ' Pa')
    if (allocated(deck%error)) return
    decay_length = decay_length/this%length
    do i = 1, n - 1
      if (.not. fall(g(i), g(i + 1)) > largest_step) cycle
      call deck%mistake('tabulated', 'file', 'from one point of the table to the next the ' // &
        'tail falls by more than exp(-10)')
      return
    end do
    this%fine = new_force_table(g, value, quantity == 'energy', exponent, decay_length, &
      interpolation == 'spline')
    ! Both tables contain the first and the last point.
    i = 2 + mod(n, 2)
    this%coarse = new_force_table([g(1), g(i:n:2)], [value(1), value(i:n:2)], &
      quantity == 'energy', exponent, decay_length, interpolation == 'spline')
    this%share = merge(share_of_spline, share_of_monotone, interpolation == 'spline')
    i = max(1, count(g <= end_of_lever*g(n)))
    this%tail_error = tail_error_of(g([i, n]), this%pressure(g([i, n])))
    call take_noise()
    call take_scales()
    if (.not. decay_length > 0) this%tail_power = exponent
    this%breaks = g
    call find_kinks()

  contains

    !> Logarithm of the ratio of the tail at two gaps.
    pure real(wp) function fall(from, to)
      real(wp), intent(in) :: from, to

      if (decay_length > 0) then
        fall = (to - from)/decay_length
      else
        fall = exponent*log(to/from)
      end if
    end function fall

    !> The error of the tail, from two gaps and their pressures, the latter being the last points of
    !> the table.
    pure real(wp) function tail_error_of(gap, pressure) result(error)
      real(wp), intent(in) :: gap(2), pressure(2)
      real(wp) :: seen

      error = 0
      if (.not. pressure(1)/pressure(2) > 1) return
      seen = log(pressure(1)/pressure(2))
      if (decay_length > 0) then
        error = abs(pressure(2)*(decay_length - (gap(2) - gap(1))/seen))
      else
        seen = seen/log(gap(2)/gap(1))
        error = abs(pressure(2)*gap(2)*(1/(exponent - 1) - 1/max(seen - 1, nearly_none)))
      end if
    end function tail_error_of

    !> Sets the errors due to noise. The values divided by their tail vary smoothly.
    subroutine take_noise()
      real(wp) :: tail(n), noise(n), beyond

      associate (table => this%fine)
        tail = exp(-table%rate*table%u)
        noise = likely*tail*noise_of(table%u, value/tail)
        allocate (this%noise(2, n))
        if (table%of_energy) then
          ! The pressure is the slope of the given energies.
          this%noise(2, :) = noise
          this%noise(1, :n - 1) = noise(:n - 1)/(g(2:) - g(:n - 1))
          this%noise(1, n) = this%noise(1, n - 1)
        else
          beyond = merge(decay_length, g(n)/max(table%energy_rate, tiny(1.0_wp)), decay_length > 0)
          this%noise(1, :) = noise
          this%noise(2, :) = noise_of_integral(g, noise, beyond)
        end if
      end associate
    end subroutine take_noise

    !> Finds the points near which the error of the table is not small. At other points the
    !> derivatives jump so little that a mesh need not resolve them.
    subroutine find_kinks()
      real(wp), dimension(size(this%breaks) - 1) :: middle
      real(wp) :: error(2, size(middle)), accuracy
      logical :: rough(0:size(middle) + 1)

      call deck%get('numerics', 'accuracy', accuracy)
      associate (g => this%breaks, n => size(middle))
        middle = (g(:n) + g(2:))/2
        error = this%error_between(middle)
        rough = .false.
        rough(1:n) = error(1, :) > max(unnoticed*accuracy, least)* &
          max(abs(this%pressure(middle)), middle*abs(this%slope(middle)))
        this%kinks = pack(g, rough(0:n) .or. rough(1:))
      end associate
      if (size(this%kinks) == 0) deallocate (this%kinks)
    end subroutine find_kinks

    !> Sets the scales of the repulsion, which is a power of the gap before the first point.
    subroutine take_scales()
      if (.not. this%fine%power > 0) then
        call deck%mistake('tabulated', 'file', 'the force does not grow towards the first gap, ' &
          // 'so that it cannot be continued to smaller ones')
        return
      end if
      ! For the ninth power the last two numbers equal those of the Lennard-Jones law.
      this%smallest_gap = max(nearest_power, 10.0_wp**(-110/(this%fine%power + 1)))
      this%repulsion_length = length_of_power/max(this%fine%power, 1.0_wp)
      this%closure_fraction = min(usual_closure, closure_of_power/this%fine%power)
      this%group = 'tabulated'
      this%strength_key = 'file'
      this%length_key = 'file'
      this%has_units = .false.
    end subroutine take_scales

  end subroutine take_table

  pure subroutine evaluate(self, quantity, gap, value)
    class(tabulated_t), intent(in) :: self
    integer, intent(in) :: quantity
    real(wp), intent(in) :: gap(:)
    real(wp), intent(out) :: value(size(gap))

    value = quantity_of(self%fine, quantity, max(gap, self%smallest_gap))
  end subroutine evaluate

  !> The sum of the errors due to interpolation, to the tail, and to the noise of the points.
  pure function table_error(self, gap) result(value)
    class(tabulated_t), intent(in) :: self
    real(wp), intent(in) :: gap(:)
    real(wp) :: value(2, size(gap))
    integer :: i, k

    value = self%error_between(gap)
    value(2, :) = value(2, :) + self%tail_error
    do k = 1, size(gap)
      i = min(max(1, count(self%breaks <= gap(k))), size(self%breaks) - 1)
      value(:, k) = value(:, k) + maxval(self%noise(:, i:i + 1), 2)
    end do
  end function table_error

  !> The error of interpolation, from the table of every second point. For smooth laws the
  !> additional error of that table is a known multiple of the error of the whole table.
  pure function error_between(self, gap) result(value)
    class(tabulated_t), intent(in) :: self
    real(wp), intent(in) :: gap(:)
    real(wp) :: value(2, size(gap))

    associate (at => max(gap, self%smallest_gap))
      value(1, :) = quantity_of(self%coarse, of_pressure, at) - self%pressure(gap)
      value(2, :) = quantity_of(self%coarse, of_energy, at) - self%energy(gap)
    end associate
    value = self%share*abs(value)
  end function error_between

  !> A quantity at a gap, from one of the tables.
  elemental real(wp) function quantity_of(table, quantity, gap) result(value)
    type(force_table_t), intent(in) :: table
    integer, intent(in) :: quantity
    real(wp), intent(in) :: gap
    real(wp) :: at(3)

    at = table%values(gap, with_energy=quantity == of_energy)
    value = at(quantity)
  end function quantity_of

end module tabulated
