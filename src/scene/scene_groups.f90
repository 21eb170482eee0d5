!> This program's groups, one derived type each; those of the experiments are in
!> `experiment_request`. What is optional is allocatable there and here.
module scene_groups
  use kinds, only: wp
  use text, only: brief, word_of
  use deck, only: deck_t
  use experiment_request, only: request_t
  use force_law, only: force_law_t
  use shape, only: shape_t
  use layered_surface, only: layered_surface_t
  use fit_request, only: measurement_t, fit_t
  use measured_curve, only: measured_t
  use theory_names, only: theories, usual
  implicit none
  private
  public :: scene_t, bodies_t, range_t, sweep_t, axis_t, case_file_t

  !> &bodies
  type :: bodies_t
    !> E/(1-nu^2) of two identical bodies equivalent to these [Pa]; without meaning if `rigid`.
    real(wp) :: stiffness = 0
    !> Moduli [Pa] and Poisson's ratios of the bodies, where they are given.
    real(wp), allocatable :: young(:), poisson(:)
    !> With &layer: the surfaces, SI units. Stiffness and shares are those of the top layers then.
    type(layered_surface_t), allocatable :: surface(:)
    !> Compliance of each body over their mean.
    real(wp) :: share(2) = 1
    logical :: rigid = .false.
  end type bodies_t

  !> &approximations and &classical: `count` points over a range of h0 [m]; h0_start unallocated:
  !> from where the equilibrium path starts.
  type :: range_t
    real(wp), allocatable :: h0_start
    real(wp) :: h0_end = 0
    integer :: count = 0
    !> Of &classical: which of `theories`.
    logical :: shown(size(theories)) = usual
  end type range_t

  !> The values of one key.
  type :: axis_t
    real(wp), allocatable :: values(:)
  end type axis_t

  !> The cases of a file, which stay there: how many, the first and the last, and those values of
  !> each key (value, key) that show whether all are allowed, with their cases.
  type :: case_file_t
    character(len=:), allocatable :: path
    integer :: cases = 0
    real(wp), allocatable :: first(:), last(:), telling(:, :)
    integer, allocatable :: of_case(:, :)
  end type case_file_t

  !> &sweep: blank-separated keys as 'group.key', and either the values of each, of which every
  !> combination is a case, the last key varying fastest; or a file, row by row. words: those
  !> that a key may hold, whose numbers are its values; blank of keys that hold numbers.
  type :: sweep_t
    character(len=:), allocatable :: names
    character(len=80), allocatable :: words(:)
    type(axis_t), allocatable :: axis(:)
    type(case_file_t), allocatable :: file
  contains
    procedure :: cases
    procedure :: values
    procedure :: last
    procedure :: shown
  end type sweep_t

  !> All that a deck asks for: of the experiments, and beside them.
  type, extends(request_t) :: scene_t
    !> The deck itself, with every default filled in.
    type(deck_t) :: deck
    character(len=:), allocatable :: title
    type(bodies_t) :: bodies
    !> The sum of the deck's forces.
    class(force_law_t), allocatable :: law
    !> In the units of that law.
    class(shape_t), allocatable :: shape
    type(range_t), allocatable :: approximations, classical
    !> &stability and &regime have no keys.
    logical :: stability = .false., regime = .false.
    type(sweep_t), allocatable :: sweep
    type(measurement_t), allocatable :: measurement
    type(measured_t), allocatable :: measured
    type(fit_t), allocatable :: fit
  contains
    procedure :: has_curve
    procedure :: has_eigenvalues
    procedure :: drive_columns
  end type scene_t

contains

  !> How many cases a sweep has.
  pure integer function cases(self)
    class(sweep_t), intent(in) :: self
    integer :: i

    if (allocated(self%file)) then
      cases = self%file%cases
    else
      cases = product([(size(self%axis(i)%values), i=1, size(self%axis))])
    end if
  end function cases

  !> The values of the keys in case i of ranges and lists.
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

  !> A value of key k as text for a message.
  pure function shown(self, k, value) result(text)
    class(sweep_t), intent(in) :: self
    integer, intent(in) :: k
    real(wp), intent(in) :: value
    character(len=:), allocatable :: text

    if (self%words(k) == '') then
      text = brief(value)
    else
      text = word_of(self%words(k), nint(value))
    end if
  end function shown

  !> Whether equilibria are shown one by one. The cases of a sweep leave numbers, not their curves.
  pure logical function has_curve(self)
    class(scene_t), intent(in) :: self

    has_curve = self%finds_states() .and. .not. allocated(self%sweep)
  end function has_curve

  !> Whether the smallest eigenvalue of each state is shown.
  pure logical function has_eigenvalues(self)
    class(scene_t), intent(in) :: self

    has_eigenvalues = self%has_curve() .and. self%stability
  end function has_eigenvalues

  !> How many columns of the curve a drive in time adds.
  pure integer function drive_columns(self)
    class(scene_t), intent(in) :: self

    drive_columns = 0
    if (.not. allocated(self%drive)) return
    drive_columns = 1
    if (allocated(self%drive%stiffness)) drive_columns = 2
  end function drive_columns

end module scene_groups
