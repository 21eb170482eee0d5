!> Reads &measurement, which describes a measured force curve.
module measurement_group
  use kinds, only: wp
  use text, only: listing, lower, quoted, spelled, word_count, word_of
  use deck, only: deck_t
  use data_table, only: plain_label
  use deck_keys, only: key_spec, real_value, real_list, integer_value, logical_value, word_value, &
    text_value, names_value
  use baseline, only: baseline_t
  use fit_request, only: of_position, of_separation, of_load, of_segment, of_radius
  use scene_groups, only: scene_t
  use units, only: find_unit
  implicit none
  private
  public :: measurement_keys, take_measurement

  integer, parameter :: most_skipped = 40, most_labels = 8
  !> The kinds of baseline by their degree, counted from 0.
  character(len=*), parameter :: kinds(*) = [character(len=9) :: 'constant', 'linear', 'quadratic']

  !> The names of the quantities of columns, in the order of their numbers in `fit_request`.
  character(len=*), parameter :: quantities = 'position separation load segment contact_radius'

  !> The rows of &measurement.
  type(key_spec), parameter :: measurement_keys(*) = [ &
    key_spec('measurement', meaning='A measured force curve, for &fit.', &
      choices='&measurement file = ''curve.csv'', spring_constant = 40 /'), &
    key_spec('measurement', 'file', text_value, 'File of the curve: a table of numbers, # ' // &
      'before comments, perhaps a line of names; a relative path begins at the deck''s folder.', &
      most=1000, otherwise='required, unless &sweep gives it'), &
    key_spec('measurement', 'curves', names_value, 'Name or number of the column that numbers ' // &
      'the curves, if the file has several; the rows of a curve are together.', &
      otherwise='the file has one', spaced=.true.), &
    key_spec('measurement', 'curve', integer_value, 'The number of the curve, in this column; ' // &
      'a &sweep over it without values takes all.', low=-1.0e9_wp, high=1.0e9_wp, &
      otherwise='required with curves'), &
    key_spec('measurement', 'x', real_value, 'Place of the curve on the sample, repeated in ' // &
      'results, for maps.', 'm', otherwise='none'), &
    key_spec('measurement', 'y', real_value, 'The same in the other direction.', 'm', &
      otherwise='none'), &
    key_spec('measurement', 'columns', names_value, 'Name or number of the columns of the ' // &
      'base''s position, the signal (force, positive: repulsion, or deflection) and, if there ' // &
      'is one, the segment; or position and signal of approach and of retract. A minus ' // &
      'changes the sign.', most=4, otherwise='the first two', spaced=.true.), &
    key_spec('measurement', 'quantity', names_value, 'What the first column is, or all, in ' // &
      'their order: position (of the base of the spring), separation (of the bodies), load ' // &
      '(the signal), contact_radius, segment; a load with a position, a separation or a ' // &
      'contact_radius.', most=4, otherwise='position'), &
    key_spec('measurement', 'approach', names_value, 'Numbers or words that the approach has ' // &
      'in the column of segments.', most=most_labels, spaced=.true., &
      otherwise='0, a word for it, or by the position'), &
    key_spec('measurement', 'retract', names_value, 'Numbers or words that the retract has in ' // &
      'the column of segments; rows with other numbers or words are left out.', &
      most=most_labels, spaced=.true., otherwise='1, a word for it, or by the position', &
      former='retreat'), &
    key_spec('measurement', 'skip_lines', integer_value, 'Number of lines at the begin of the ' // &
      'file that are left out.', default='0', low=0.0_wp, high=1.0e5_wp), &
    key_spec('measurement', 'spring_constant', real_value, 'Stiffness of the spring.', 'N/m', &
      above=0.0_wp, otherwise='required; none for separations'), &
    key_spec('measurement', 'sensitivity', real_value, 'Deflection of the spring for one ' // &
      'volt; 1 for a deflection in metres.', 'm/V', above=0.0_wp, &
      otherwise='the signal is the force'), &
    key_spec('measurement', 'contact_point', real_value, 'Position of the base at which ' // &
      'undeformed bodies would touch.', 'm', otherwise='an unknown of &fit, in its parameters'), &
    key_spec('measurement', 'units', names_value, 'Units of position (m, mm, um, nm, pm) and ' // &
      'signal (N, mN, uN, nN, pN; N/m, mN/m, ... for the force over the radius; V, mV, or as ' // &
      'of position) in the file.', most=2, otherwise='those in the names, or m and N or V'), &
    key_spec('measurement', 'skip', real_list, 'Pairs of positions of the base, SI; samples ' // &
      'between the two of a pair are left out.', 'm', most=most_skipped, otherwise='none'), &
    key_spec('measurement', 'segment', word_value, 'The branches to fit; ' // &
      'retreat is retract.', choices='both approach retract retreat', default='both'), &
    key_spec('measurement', 'baseline', word_value, 'The signal without force: a constant on ' // &
      'each way, and for linear a slope, for quadratic also a bow, common to both.', &
      choices='constant linear quadratic', default='linear'), &
    key_spec('measurement', 'slope_each_way', logical_value, 'Whether the slope of the ' // &
      'baseline is another one on each way, as under a drift in time.', default='.false.'), &
    key_spec('measurement', 'ripple', logical_value, 'Whether the baseline has a ripple, as ' // &
      'interference of light makes it: a sinusoid of one period on both ways.', &
      default='.false.')]

contains

  !> Reads &measurement, but not the file of the curve.
  subroutine take_measurement(scene)
    type(scene_t), intent(inout) :: scene
    character(len=:), allocatable :: names
    real(wp), allocatable :: radius
    integer :: i

    associate (deck => scene%deck, measurement => scene%measured)
      if (.not. (deck%is_set('measurement', 'file') .or. scene%sweeps('measurement.file'))) then
        call deck%mistake('measurement', 'file', 'missing; the file of the curve')
        return
      end if
      measurement%file = deck%path_of('measurement', 'file')
      call take_number(scene)
      call deck%assume('measurement', 'columns', '1 2')
      call deck%get('measurement', 'columns', names)
      if (word_count(names) < 2) then
        call deck%mistake('measurement', 'columns', 'names the columns of position and ' // &
          'signal, and of the segment if the file has one')
        return
      end if
      allocate (measurement%columns(word_count(names)))
      do i = 1, size(measurement%columns)
        measurement%columns(i) = spelled(word_of(names, i))
      end do
      call take_quantities(deck, size(measurement%columns), measurement%quantity)
      if (allocated(deck%error)) return
      call deck%get('measurement', 'skip_lines', measurement%skip_lines)
      call take_labels(deck, 'approach', measurement%approach)
      call take_labels(deck, 'retract', measurement%retreat)
      if (.not. measurement%has(of_segment)) then
        if (deck%is_set('measurement', 'approach')) call deck%mistake('measurement', 'approach', &
          'needs a column of segments, the third of columns')
        if (deck%is_set('measurement', 'retract')) call deck%mistake('measurement', 'retract', &
          'needs a column of segments, the third of columns')
      end if
      call take_spring(scene)
      call deck%get_optional('measurement', 'sensitivity', measurement%sensitivity)
      call deck%get_optional('measurement', 'contact_point', measurement%contact_point)
      call deck%get('measurement', 'segment', measurement%segment)
      if (measurement%segment == 'retreat') measurement%segment = 'retract'
      call deck%get('measurement', 'skip', measurement%skip)
      if (mod(size(measurement%skip), 2) == 1) then
        call deck%mistake('measurement', 'skip', 'positions come in pairs: from and to')
      else if (any(measurement%skip(1::2) > measurement%skip(2::2))) then
        call deck%mistake('measurement', 'skip', 'the first of each pair must be the smaller')
      end if
      call take_baseline(deck, measurement%baseline)
      call take_units(deck, measurement%quantity, measurement%unit, measurement%signal_in)
      call deck%get_optional('bodies', 'radius', radius)
      if (allocated(radius)) measurement%radius = radius
      if (measurement%signal_in == 'R' .and. .not. allocated(radius)) call deck%mistake( &
        'measurement', 'units', 'a force over a radius needs radius in &bodies')
      call take_noise(scene)
    end associate
  end subroutine take_measurement

  !> Reads the quantity of each column.
  subroutine take_quantities(deck, columns, quantity)
    type(deck_t), intent(inout) :: deck
    integer, intent(in) :: columns
    integer, allocatable, intent(out) :: quantity(:)
    character(len=:), allocatable :: names
    integer :: i, k

    call deck%get('measurement', 'quantity', names)
    allocate (quantity(max(1, word_count(names))))
    quantity = of_position
    do i = 1, word_count(names)
      quantity(i) = 0
      do k = 1, word_count(quantities)
        if (lower(word_of(names, i)) == word_of(quantities, k)) quantity(i) = k
      end do
      if (quantity(i) == 0) call deck%mistake('measurement', 'quantity', &
        quoted(word_of(names, i)) // ' is not a quantity; allowed are ' // &
        listing(quantities, '', ''))
    end do
    if (allocated(deck%error)) return
    if (size(quantity) == 1 .and. any(quantity(1) == [of_position, of_separation])) then
      quantity = [quantity, of_load, of_segment]
      if (columns == 4) quantity = quantity([1, 2, 1, 2])
      quantity = quantity(:columns)
    else if (size(quantity) /= columns) then
      call deck%mistake('measurement', 'quantity', 'give what the first column is, or one ' // &
        'quantity for each of columns')
    else if (count(quantity == of_position .or. quantity == of_separation) > 1 .or. &
      any([(count(quantity == k) > 1, k=1, word_count(quantities))])) then
      call deck%mistake('measurement', 'quantity', 'a curve has each quantity once, and a ' // &
        'position or a separation')
    else if (.not. any(quantity == of_load)) then
      call deck%mistake('measurement', 'quantity', 'a curve needs a load: separations and ' // &
        'contact radii stay as they are if all forces and moduli change by the same factor, ' // &
        'so that alone they show only the work of adhesion over the modulus')
    else if (all(quantity == of_load .or. quantity == of_segment)) then
      call deck%mistake('measurement', 'quantity', 'a load needs a position, a separation or a ' &
        // 'contact_radius')
    end if
  end subroutine take_quantities

  !> Reads the spring. A column of separations needs no spring, since a separation is that of the
  !> bodies themselves.
  subroutine take_spring(scene)
    type(scene_t), intent(inout) :: scene
    real(wp), allocatable :: spring_constant

    associate (deck => scene%deck)
      call deck%get_optional('measurement', 'spring_constant', spring_constant)
      if (scene%sweeps('measurement.spring_constant') .and. .not. allocated(spring_constant)) &
        spring_constant = 1
      if (allocated(spring_constant)) then
        if (scene%measured%under_loads()) call deck%mistake('measurement', 'spring_constant', &
          'contact radii under loads have no position, and need no spring')
        scene%measured%spring_constant = spring_constant
      else if (scene%measured%has(of_position)) then
        call deck%mistake('measurement', 'spring_constant', 'missing; the position of the base ' &
          // 'of a spring needs it; without a spring, quantity = ''separation''')
      else if (deck%is_set('measurement', 'sensitivity')) then
        call deck%mistake('measurement', 'sensitivity', 'a deflection is that of a spring, whose ' &
          // 'spring_constant is missing')
      end if
    end associate
  end subroutine take_spring

  !> Reads the standard deviation of the noise of the signal and of the contact radius, or of the
  !> only one of them in the data.
  subroutine take_noise(scene)
    type(scene_t), intent(inout) :: scene
    real(wp), allocatable :: noise(:)

    call scene%deck%get('fit', 'noise', noise)
    if (size(noise) == 0) return
    if (scene%measured%under_loads()) then
      scene%fit%noise_radius = noise(1)
    else
      scene%fit%noise = noise(1)
      if (size(noise) > 1) scene%fit%noise_radius = noise(2)
    end if
    if (size(noise) > 1 .and. (scene%measured%under_loads() .or. &
      .not. scene%measured%has(of_radius))) call scene%deck%mistake('fit', 'noise', &
      'one value, since the curve has a signal or a contact radius, and not both')
  end subroutine take_noise

  !> Reads the number of the curve in its file.
  subroutine take_number(scene)
    type(scene_t), intent(inout) :: scene
    character(len=:), allocatable :: names

    associate (deck => scene%deck)
      call deck%get('measurement', 'curves', names)
      if (word_count(names) > 0) scene%measured%curves = spelled(word_of(names, 1))
      call deck%get_optional('measurement', 'curve', scene%measured%curve)
      if (scene%sweeps('measurement.curve')) scene%measured%curve = 0
      if (allocated(scene%measured%curve) .and. .not. allocated(scene%measured%curves)) then
        call deck%mistake('measurement', 'curve', 'needs curves, the column of these numbers')
      else if (allocated(scene%measured%curves) .and. .not. allocated(scene%measured%curve)) then
        call deck%mistake('measurement', 'curves', 'needs curve, the number of the curve, or a ' &
          // '&sweep over it')
      end if
    end associate
  end subroutine take_number

  !> Reads labels of segments. Numbers are written without superfluous digits.
  subroutine take_labels(deck, key, labels)
    type(deck_t), intent(inout) :: deck
    character(len=*), intent(in) :: key
    character(len=*), allocatable, intent(out) :: labels(:)
    character(len=:), allocatable :: names
    integer :: i

    call deck%get('measurement', key, names)
    if (word_count(names) == 0) return
    allocate (labels(word_count(names)))
    do i = 1, size(labels)
      labels(i) = plain_label(spelled(word_of(names, i)))
    end do
  end subroutine take_labels

  !> Reads the kind of the baseline.
  subroutine take_baseline(deck, baseline)
    type(deck_t), intent(inout) :: deck
    type(baseline_t), intent(inout) :: baseline
    character(len=:), allocatable :: kind
    integer :: i

    call deck%get('measurement', 'baseline', kind)
    ! findloc finds no string of another length (compiler note 14).
    do i = 1, size(kinds)
      if (kind == kinds(i)) baseline%degree = i - 1
    end do
    call deck%get('measurement', 'slope_each_way', baseline%slope_each_way)
    call deck%get('measurement', 'ripple', baseline%ripple)
    if (baseline%slope_each_way .and. baseline%degree == 0) call deck%mistake('measurement', &
      'slope_each_way', 'baseline = ''constant'' has no slope')
  end subroutine take_baseline

  !> Reads the units of the file's columns: metres, newtons, newtons per metre and volts, with SI
  !> prefixes. The first unit is that of lengths, the second that of the signal.
  subroutine take_units(deck, quantity, unit, signal_in)
    type(deck_t), intent(inout) :: deck
    integer, intent(in) :: quantity(:)
    real(wp), allocatable, intent(out) :: unit(:)
    character, intent(out) :: signal_in
    character(len=*), parameter :: bases(2) = ['m   ', 'NVmR']
    character(len=:), allocatable :: names, name
    character :: base
    real(wp) :: factor
    integer :: i

    allocate (unit(size(quantity)), source=0.0_wp)
    signal_in = ' '
    call deck%get('measurement', 'units', names)
    do i = 1, min(2, word_count(names))
      name = word_of(names, i)
      call find_unit(name, factor, base)
      if (base == ' ' .or. index(trim(bases(i)), base) == 0) &
        call deck%mistake('measurement', 'units', quoted(name) // ' is not a unit of ' // &
        trim(merge('position', 'signal  ', i == 1)) // ' such as ' // &
        trim(merge('nm', 'nN', i == 1)))
      where ((quantity == of_load) .eqv. i == 2) unit = factor
    end do
    if (word_count(names) < 2) return
    signal_in = base
    if (deck%is_set('measurement', 'sensitivity')) then
      if (base == 'R') call deck%mistake('measurement', 'units', 'a force over a radius is no ' // &
        'deflection, and has no sensitivity')
    else if (scan(base, 'Vm') > 0) then
      call deck%mistake('measurement', 'units', 'a signal in volts needs sensitivity, the ' // &
        'deflection of the spring for one volt, and a deflection sensitivity = 1')
    end if
  end subroutine take_units

end module measurement_group
