!> Decks for f2py: the kind of a key of results, the force law of a deck, and the version.
!>
!> All flat modules have only scalars, arrays of explicit shape with their sizes last, and for each
!> procedure that may refuse its arguments `stat` (0, or the kind of `failure`) and `message`; no
!> derived types, no optional arguments. Decisions are left to the library, and checks of shape and
!> value to the Python package. Kinds are those of C, which f2py knows; the length of `message` must
!> be a literal for the same reason. A deck is its text.
!>
!> Nothing is kept between calls. f2py holds Python's global lock, so that calls do not overlap;
!> they must not (no `threadsafe`), since gfortran keeps lengths of intermediate strings in static
!> variables (compiler note 4).
module flat_deck
  use iso_c_binding, only: c_double, c_int
  implicit none
  private
  public :: is_list, law_values, library_version, use_one_thread

contains

  !> The version of the library.
  subroutine library_version(text)
    use build_info, only: version
    character(len=32), intent(out) :: text

    text = version
  end subroutine library_version

  !> Whether a key of &summary or &cost is a list, even with one value: 0 or 1.
  subroutine is_list(key, list)
    use result_rows, only: rows
    character(len=*), intent(in) :: key
    integer(c_int), intent(out) :: list
    integer :: row

    list = 0
    do row = 1, size(rows)
      ! The entry of a number, or of its error.
      if (rows(row)%list .and. (rows(row)%key == key .or. &
        trim(rows(row)%key) // rows(row)%error == key)) list = 1
    end do
  end subroutine is_list

  !> The force law of a deck: pressure [Pa], its derivative by the separation [Pa/m] and its
  !> integral from there to infinity [J/m^2], at separations `gap` [m]; pressures are NaN up to
  !> and beyond a pole in contact, where the formulas go on. numbers: units of gap [m]
  !> and pressure [Pa], separation at gap 0 [m], surface energy [J/m^2], separations of largest
  !> tension, of zero pressure and of vanishing repulsion [m]; NaN if there is none.
  subroutine law_values(deck, gap, pressure, slope, energy, numbers, stat, message, n)
    use kinds, only: nan
    use deck_problem, only: pose
    use dimensionless_problem, only: problem_t, surface_energy
    character(len=*), intent(in) :: deck
    integer(c_int), intent(in) :: n
    real(c_double), intent(in) :: gap(n)
    real(c_double), intent(out) :: pressure(n), slope(n), energy(n), numbers(7)
    integer(c_int), intent(out) :: stat
    character(len=16000), intent(out) :: message
    type(problem_t) :: problem

    pressure = 0
    slope = 0
    energy = 0
    numbers = 0
    call pose(deck, problem, stat, message)
    if (stat /= 0) return
    associate (law => problem%law)
      pressure = law%pressure_unit*law%pressure(law%gap_of(gap))
      if (law%smallest_gap > law%gap_of(0.0_c_double)) then
        where (law%gap_of(gap) < law%smallest_gap) pressure = nan
      end if
      slope = law%pressure_unit/law%length*law%slope(law%gap_of(gap))
      energy = law%pressure_unit*law%length*law%energy(law%gap_of(gap))
      numbers = [law%length, law%pressure_unit, law%origin, surface_energy(problem), &
        law%separation_of([law%edge_gap, law%rest_gap, law%range])]
      if (.not. law%edge_gap > 0) numbers(5) = nan
      if (.not. law%rest_gap > 0) numbers(6) = nan
    end associate
  end subroutine law_values

  !> Makes the calling thread compute alone from now on. In a process that was forked after the
  !> OpenMP run-time had started threads, these threads no longer exist, and the process would wait
  !> for them for ever.
  subroutine use_one_thread()
    !$ use omp_lib, only: omp_set_num_threads

    !$ call omp_set_num_threads(1)
  end subroutine use_one_thread

end module flat_deck
