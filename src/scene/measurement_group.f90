!> &measurement: a measured force curve.
module measurement_group
  use kinds, only: wp
  use text, only: quoted, spelled, word_count, word_of
  use deck, only: deck_t
  use data_table, only: plain_label
  use deck_keys, only: key_spec, real_value, real_list, integer_value, logical_value, word_value, &
    text_value, names_value
  use baseline, only: baseline_t
  use scene_groups, only: scene_t
  use units, only: find_unit
  implicit none
  private
  public :: measurement_keys, take_measurement

  integer, parameter :: most_skipped = 40, most_labels = 8
  !> The baselines by their degree, from 0.
  character(len=*), parameter :: kinds(*) = [character(len=9) :: 'constant', 'linear', 'quadratic']

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
      'is one, the segment; or position and signal of approach and of retreat. A minus ' // &
      'changes the sign.', most=4, otherwise='the first two', spaced=.true.), &
    key_spec('measurement', 'approach', names_value, 'Numbers or words that the approach has ' // &
      'in the column of segments.', most=most_labels, spaced=.true., &
      otherwise='0, a word for it, or by the position'), &
    key_spec('measurement', 'retreat', names_value, 'Numbers or words that the retreat has in ' // &
      'the column of segments; rows with other numbers or words are left out.', &
      most=most_labels, spaced=.true., otherwise='1, a word for it, or by the position'), &
    key_spec('measurement', 'skip_lines', integer_value, 'Number of lines at the begin of the ' // &
      'file that are left out.', default='0', low=0.0_wp, high=1.0e5_wp), &
    key_spec('measurement', 'spring_constant', real_value, 'Stiffness of the spring.', 'N/m', &
      above=0.0_wp, required=.true.), &
    key_spec('measurement', 'sensitivity', real_value, 'Deflection of the spring for one ' // &
      'volt; 1 for a deflection in metres.', 'm/V', above=0.0_wp, &
      otherwise='the signal is the force'), &
    key_spec('measurement', 'contact_point', real_value, 'Position of the base at which ' // &
      'undeformed bodies would touch.', 'm', otherwise='an unknown of &fit, in its parameters'), &
    key_spec('measurement', 'units', names_value, 'Units of position (m, mm, um, nm, pm) and ' // &
      'signal (N, mN, uN, nN, pN, V, mV, or as of position) in the file.', most=2, &
      otherwise='those in the names, or m and N or V'), &
    key_spec('measurement', 'skip', real_list, 'Pairs of positions of the base, SI; samples ' // &
      'between the two of a pair are left out.', 'm', most=most_skipped, otherwise='none'), &
    key_spec('measurement', 'segment', word_value, 'The branches to fit.', &
      choices='both approach retreat', default='both'), &
    key_spec('measurement', 'baseline', word_value, 'The signal without force: a constant on ' // &
      'each way, and for linear a slope, for quadratic also a bow, common to both.', &
      choices='constant linear quadratic', default='linear'), &
    key_spec('measurement', 'slope_each_way', logical_value, 'Whether the slope of the ' // &
      'baseline is another one on each way, as under a drift in time.', default='.false.'), &
    key_spec('measurement', 'ripple', logical_value, 'Whether the baseline has a ripple, as ' // &
      'interference of light makes it: a sinusoid of one period on both ways.', &
      default='.false.')]

contains

  !> Reads &measurement, without the file.
  subroutine take_measurement(scene)
    type(scene_t), intent(inout) :: scene
    character(len=:), allocatable :: names
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
      call deck%get('measurement', 'skip_lines', measurement%skip_lines)
      call take_labels(deck, 'approach', measurement%approach)
      call take_labels(deck, 'retreat', measurement%retreat)
      if (size(measurement%columns) /= 3) then
        if (deck%is_set('measurement', 'approach')) call deck%mistake('measurement', 'approach', &
          'needs a column of segments, the third of columns')
        if (deck%is_set('measurement', 'retreat')) call deck%mistake('measurement', 'retreat', &
          'needs a column of segments, the third of columns')
      end if
      call deck%get('measurement', 'spring_constant', measurement%spring_constant)
      call deck%get_optional('measurement', 'sensitivity', measurement%sensitivity)
      call deck%get_optional('measurement', 'contact_point', measurement%contact_point)
      call deck%get('measurement', 'segment', measurement%segment)
      call deck%get('measurement', 'skip', measurement%skip)
      if (mod(size(measurement%skip), 2) == 1) then
        call deck%mistake('measurement', 'skip', 'positions come in pairs: from and to')
      else if (any(measurement%skip(1::2) > measurement%skip(2::2))) then
        call deck%mistake('measurement', 'skip', 'the first of each pair must be the smaller')
      end if
      call take_baseline(deck, measurement%baseline)
      call take_units(deck, measurement%unit, measurement%signal_in)
      call deck%get_optional('fit', 'noise', scene%fit%noise)
    end associate
  end subroutine take_measurement

  !> Reads which curve of the file is meant.
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

  !> Reads labels of segments; numbers without superfluous digits.
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
    ! Not findloc, which finds no shorter string: compiler note 14.
    do i = 1, size(kinds)
      if (kind == kinds(i)) baseline%degree = i - 1
    end do
    call deck%get('measurement', 'slope_each_way', baseline%slope_each_way)
    call deck%get('measurement', 'ripple', baseline%ripple)
    if (baseline%slope_each_way .and. baseline%degree == 0) call deck%mistake('measurement', &
      'slope_each_way', 'baseline = ''constant'' has no slope')
  end subroutine take_baseline

  !> Reads the units of the file's columns: metres, newtons and volts, with SI prefixes.
  subroutine take_units(deck, unit, signal_in)
    type(deck_t), intent(inout) :: deck
    real(wp), intent(out) :: unit(2)
    character, intent(out) :: signal_in
    character(len=*), parameter :: bases(2) = ['m  ', 'NVm']
    character(len=:), allocatable :: names, name
    character :: base
    integer :: i

    unit = 0
    signal_in = ' '
    call deck%get('measurement', 'units', names)
    do i = 1, min(2, word_count(names))
      name = word_of(names, i)
      call find_unit(name, unit(i), base)
      if (base == ' ' .or. index(trim(bases(i)), base) == 0) &
        call deck%mistake('measurement', 'units', quoted(name) // ' is not a unit of ' // &
        trim(merge('position', 'signal  ', i == 1)) // ' such as ' // &
        trim(merge('nm', 'nN', i == 1)))
    end do
    if (word_count(names) < 2) return
    signal_in = base
    if (deck%is_set('measurement', 'sensitivity')) return
    if (scan(base, 'Vm') > 0) call deck%mistake('measurement', 'units', 'a signal in ' &
      // 'volts needs sensitivity, the deflection of the spring for one volt, and a ' // &
      'deflection sensitivity = 1')
  end subroutine take_units

end module measurement_group
