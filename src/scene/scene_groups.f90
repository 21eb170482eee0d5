!> This program's groups, one derived type for each. The types of the experiments are in
!> `experiment_request`. Optional groups and keys are allocatable.
module scene_groups
  use kinds, only: wp, long
  use text, only: brief, lower, word_of
  use deck, only: deck_t
  use namelist_writer, only: line_t
  use experiment_request, only: request_t
  use force_law, only: force_law_t
  use shape, only: shape_t
  use layered_surface, only: layered_surface_t
  use fit_request, only: fit_t
  use curve_index, only: curve_index_t
  use measured_curve, only: measured_curve_t
  use classical, only: theories, usual
  implicit none
  private
  public :: scene_t, bodies_t, range_t, sweep_t, axis_t, case_file_t, compliance_of

  !> The group &bodies.
  type :: bodies_t
    !> The plane-strain modulus E/(1-nu^2) of two identical bodies with the same compliance as these
    !> bodies [Pa]; undefined if `rigid`.
    real(wp) :: stiffness = 0
    !> Young's moduli [Pa] and Poisson's ratios of the bodies, if they are given.
    real(wp), allocatable :: young(:), poisson(:)
    !> With &layer: the surfaces, in SI units. The modulus `stiffness` and the shares are then those
    !> of the top layers.
    type(layered_surface_t), allocatable :: surface(:)
    !> The compliance of each body, relative to the mean of both.
    real(wp) :: share(2) = 1
    logical :: rigid = .false.
  end type bodies_t

  !> &approximations and &classical: `count` points over a range of h0 [m]. If h0_start is not
  !> allocated, the range begins where the equilibrium path starts.
  type :: range_t
    real(wp), allocatable :: h0_start
    real(wp) :: h0_end = 0
    integer :: count = 0
    !> For &classical: whether each of `theories` is shown.
    logical :: shown(size(theories)) = usual
  end type range_t

  !> The values of one key.
  type :: axis_t
    real(wp), allocatable :: values(:)
  end type axis_t

  !> The cases of a file, of which only some are kept. cases: their number; digest: the checksum of
  !> all lines; first, last: the first and the last case. telling: for each key three values (value,
  !> key) that show whether all its values are allowed; of_case: the cases with these values.
  type :: case_file_t
    character(len=:), allocatable :: path
    integer :: cases = 0
    integer(long) :: digest = 0
    real(wp), allocatable :: first(:), last(:), telling(:, :)
    character(len=:), allocatable :: first_text, last_text
    integer, allocatable :: of_case(:, :)
  end type case_file_t

  !> The group &sweep. names: blank-separated keys of the form 'group.key'. axis: the values of each
  !> key, every combination of which is a case (the last key varies fastest). file: instead of
  !> these, a file with one case per row. words: for each key the words that it may hold, blank for
  !> numbers; the value of such a key is the number of one word. text_key: the number of the key
  !> that holds a text, such as the name of a file; 0 if there is none. Its value is the number of
  !> one of `texts` or, with a file of cases, that of the row.
  type :: sweep_t
    character(len=:), allocatable :: names
    character(len=80), allocatable :: words(:)
    integer :: text_key = 0
    type(line_t), allocatable :: texts(:)
    type(axis_t), allocatable :: axis(:)
    type(case_file_t), allocatable :: file
    !> The positions of the curves in a file with several curves, once they are known.
    type(curve_index_t) :: index
    !> Whether the cost of each case is measured.
    logical :: costs = .false.
  contains
    procedure :: cases
    procedure :: values
    procedure :: last
    procedure :: text_of
    procedure :: varies
    procedure :: shown
  end type sweep_t

  !> The whole content of a deck: the experiments, and everything else.
  type, extends(request_t) :: scene_t
    !> The deck itself, including all defaults.
    type(deck_t) :: deck
    character(len=:), allocatable :: title
    type(bodies_t) :: bodies
    !> The sum of the deck's forces.
    class(force_law_t), allocatable :: law
    !> The shape, in the units of the force law.
    class(shape_t), allocatable :: shape
    type(range_t), allocatable :: approximations, classical
    !> Whether the deck has &stability, and &regime.
    logical :: stability = .false., regime = .false.
    type(sweep_t), allocatable :: sweep
    type(measured_curve_t), allocatable :: measured
    type(fit_t), allocatable :: fit
  contains
    procedure :: has_curve
    procedure :: sweeps
    procedure :: has_eigenvalues
    procedure :: drive_columns
  end type scene_t

contains

  !> (1-nu^2)/E.
  elemental real(wp) function compliance_of(young, poisson)
    real(wp), intent(in) :: young, poisson

    compliance_of = (1 - poisson)*(1 + poisson)/young
  end function compliance_of

  !> Number of cases of a sweep.
  pure integer function cases(self)
    class(sweep_t), intent(in) :: self
    integer :: i

    if (allocated(self%file)) then
      cases = self%file%cases
    else
      cases = product([(size(self%axis(i)%values), i=1, size(self%axis))])
    end if
  end function cases

  !> The values of the keys in case i of a sweep with ranges and lists.
  pure function values(self, i)
    class(sweep_t), intent(in) :: self
    integer, intent(in) :: i
    real(wp), allocatable :: values(:)
    integer :: k, left

    allocate (values(size(self%axis)))
    left = i - 1
    do k = size(self%axis), 1, -1
      associate (of_key => self%axis(k)%values)
        values(k) = of_key(1 + mod(left, size(of_key)))
        left = left/size(of_key)
      end associate
    end do
  end function values

  !> The values of the keys in the last case.
  pure function last(self) result(values)
    class(sweep_t), intent(in) :: self
    real(wp), allocatable :: values(:)

    if (allocated(self%file)) then
      values = self%file%last
    else
      values = self%values(self%cases())
    end if
  end function last

  !> The text of a case with these values, if one of its keys holds a text and the cases are not
  !> read from a file; otherwise ''.
  pure function text_of(self, values) result(text)
    class(sweep_t), intent(in) :: self
    real(wp), intent(in) :: values(:)
    character(len=:), allocatable :: text

    text = ''
    if (self%text_key == 0 .or. .not. allocated(self%texts)) return
    text = self%texts(nint(values(self%text_key)))%text
  end function text_of

  !> Whether the sweep varies a key.
  pure logical function varies(self, key)
    class(sweep_t), intent(in) :: self
    character(len=*), intent(in) :: key

    varies = index(' ' // lower(self%names) // ' ', ' ' // key // ' ') > 0
  end function varies

  !> A value of key k as text for a message. of_case: the text of its case.
  pure function shown(self, k, value, of_case) result(text)
    class(sweep_t), intent(in) :: self
    integer, intent(in) :: k
    real(wp), intent(in) :: value
    character(len=*), intent(in) :: of_case
    character(len=:), allocatable :: text

    if (k == self%text_key) then
      text = of_case
    else if (self%words(k) == '') then
      text = brief(value)
    else
      text = word_of(self%words(k), nint(value))
    end if
  end function shown

  !> Whether a sweep of the scene varies a key.
  pure logical function sweeps(self, key)
    class(scene_t), intent(in) :: self
    character(len=*), intent(in) :: key

    sweeps = allocated(self%sweep)
    if (sweeps) sweeps = self%sweep%varies(key)
  end function sweeps

  !> Whether the states of a curve are written; a sweep writes only numbers derived from its curves.
  pure logical function has_curve(self)
    class(scene_t), intent(in) :: self

    has_curve = self%finds_states() .and. .not. allocated(self%sweep)
  end function has_curve

  !> Whether the smallest eigenvalue of each state is written.
  pure logical function has_eigenvalues(self)
    class(scene_t), intent(in) :: self

    has_eigenvalues = self%has_curve() .and. self%stability
  end function has_eigenvalues

  !> Number of columns by which a drive in time extends the curve.
  pure integer function drive_columns(self)
    class(scene_t), intent(in) :: self

    drive_columns = 0
    if (.not. allocated(self%drive)) return
    drive_columns = 1
    if (allocated(self%drive%stiffness)) drive_columns = 2
  end function drive_columns

end module scene_groups
