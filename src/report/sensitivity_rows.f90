!> Derivatives of reported numbers and of the curve by the parameters of &sensitivity, as rows of
!> tables.
module sensitivity_rows
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_positive_inf, ieee_is_nan
  use kinds, only: wp, nan
  use text, only: brief
  use dimensionless_problem, only: problem_t
  use variation, only: variation_t
  use reported_place, only: of_h0, of_displacement, of_radius
  use path_point, only: path_point_t
  use experiment_result, only: experiment_result_t
  use reported_values, only: readings_t, read_numbers
  use path_sensitivity, only: rate_t, held
  use driven_pieces, only: through_spring
  use path_readings, only: path_readings_t
  use results, only: results_t
  use result_rows, only: rows
  use summary, only: summary_t
  implicit none
  private
  public :: write_sensitivities

  !> The position z has a turn where its derivative along the path is smaller than this fraction of
  !> the terms of this derivative, or of the law's units. Folds are located to a millionth of a unit
  !> of the coordinate.
  real(wp), parameter :: turning = 1.0e-6_wp

contains

  !> Writes the derivatives by the parameters of `varied`, if the scene has results that can be
  !> differentiated.
  subroutine write_sensitivities(varied, problem, outcome, summary, results)
    type(variation_t), intent(in) :: varied(:)
    type(problem_t), intent(in) :: problem
    type(experiment_result_t), intent(in) :: outcome
    type(summary_t), intent(in) :: summary
    type(results_t), intent(inout) :: results

    if (.not. allocated(outcome%places%number)) return
    call write_numbers()
    if (.not. allocated(outcome%readings)) return
    if (allocated(outcome%readings%rate)) call write_curve(outcome%readings)

  contains

    !> Writes the derivatives of the numbers of the summary in its order, then those of the rows of
    !> fixed_load.csv.
    subroutine write_numbers()
      type(readings_t) :: number, h0, displacement, radius
      integer :: i, k

      call results%begin_table('sensitivity.csv')
      do i = 1, size(rows)
        number = summary%numbers_of_row(i)
        do k = 1, size(number%rate, 2)
          if (rows(i)%list) call write_element(trim(rows(i)%key), number, k)
          if (.not. rows(i)%list) call write_lines(trim(rows(i)%key), number, k)
        end do
      end do
      h0 = read_numbers(outcome%places, problem, 'fixed_load', of_h0)
      displacement = read_numbers(outcome%places, problem, 'fixed_load', of_displacement)
      radius = read_numbers(outcome%places, problem, 'fixed_load', of_radius)
      do i = 1, size(h0%value)
        call write_element('fixed_load.h0', h0, i)
        call write_element('fixed_load.displacement', displacement, i)
        if (radius%value(i) > 0) call write_element('fixed_load.contact_radius', radius, i)
      end do
    end subroutine write_numbers

    subroutine write_element(key, number, k)
      character(len=*), intent(in) :: key
      type(readings_t), intent(in) :: number
      integer, intent(in) :: k

      call write_lines(key // '(' // brief(k) // ')', number, k)
    end subroutine write_element

    subroutine write_lines(quantity, number, k)
      character(len=*), intent(in) :: quantity
      type(readings_t), intent(in) :: number
      integer, intent(in) :: k
      real(wp) :: relative
      integer :: j

      do j = 1, size(number%rate, 1)
        associate (value => number%value(k), rate => number%rate(j, k), &
          parameter => varied(j)%parameter)
          relative = nan
          if (.not. ieee_is_nan(value)) then
            if (abs(value) > 0) relative = rate*parameter%value/value
          end if
          call results%row(quantity // ',' // parameter%name, &
            [value, rate, relative, number%rate_error(j, k)])
        end associate
      end do
    end subroutine write_lines

    !> Writes, for each parameter, the derivatives of the curve at prescribed h0, then those with
    !> each spring.
    subroutine write_curve(readings)
      type(path_readings_t), intent(in) :: readings
      real(wp), allocatable :: stiffness(:)
      integer :: i, j, k

      call results%begin_table('curve_sensitivity.csv')
      stiffness = [ieee_value(1.0_wp, ieee_positive_inf)]
      if (allocated(readings%device)) stiffness = [stiffness, &
        pack(readings%device%stiffness, readings%device%stiffness <= huge(1.0_wp))]
      do j = 1, size(varied)
        do k = 1, size(stiffness)
          do i = 1, size(readings%node)
            call add(varied(j)%parameter%name, stiffness(k), readings%node(i), readings%rate(j, i))
          end do
        end do
      end do
    end subroutine write_curve

    subroutine add(parameter, stiffness, node, by)
      character(len=*), intent(in) :: parameter
      real(wp), intent(in) :: stiffness
      type(path_point_t), intent(in) :: node
      type(rate_t), intent(in) :: by
      type(rate_t) :: rate
      real(wp) :: weights(2), terms(2), z

      associate (drive => through_spring(stiffness))
        weights = drive%weights
      end associate
      terms = weights*[node%tangent%h0*problem%length, node%tangent%load*problem%load]
      rate = held(problem, node, by, weights)
      if (.not. abs(sum(terms)) > turning*sum(abs(terms) + &
        abs(weights)*[problem%length, problem%load])) then
        rate%h0 = nan
        rate%load = rate%h0
      end if
      z = nan
      if (weights(1) > 0) z = problem%law%separation_of(node%state%h0) + &
        weights(2)*node%state%load*problem%load
      call results%row(parameter, [stiffness, z, problem%law%separation_of(node%state%h0), &
        node%state%load*problem%load, rate%h0, rate%load])
    end subroutine add

  end subroutine write_sensitivities

end module sensitivity_rows
