!> base_values: for tests of `base`. Reads requests, each a word and the numbers that follow it, and
!> prints what the procedure of that name makes of them, one line each.
program base_values
  use kinds, only: wp
  use adaptive_quadrature, only: integral_t, new_integral
  use special_functions, only: bessel_t, new_bessel, carlson_rf
  use chebyshev, only: chebyshev_points, chebyshev_series, series_value, series_slope, &
    series_integral
  use interpolation, only: spline, monotone, polynomial_weights, polynomial_slope, &
    hermite_t, hermite_through
  use decimal, only: put_real, longest_real
  use linear_algebra, only: solve_tridiagonal, singular_values
  use order_statistics, only: ranked, median_of
  use local_nodes, only: local_nodes_t, given_nodes
  use quadrature, only: gauss_legendre, legendre_values, logarithm_weights, wave_rule
  use root_finding, only: bracket_t, root_search_t, new_root_search
  use text, only: lower, quoted, unquoted, brief
  implicit none

  character(len=*), parameter :: numbers = '(*(es25.16e3))'
  character(len=longest_real) :: buffer
  character(len=200) :: name
  real(wp), allocatable :: x(:), y(:), z(:), c(:, :)
  type(hermite_t) :: hermite
  type(local_nodes_t) :: nodes
  integer :: n, ended, length, i

  do
    read (*, *, iostat=ended) name, n
    if (ended /= 0) exit
    allocate (x(n), y(n), z(n))
    select case (name)
    case ('text')
      read (*, '(a)') name
      print '(7a)', lower(trim(name)), achar(9), quoted(trim(name)), achar(9), &
        unquoted(quoted(trim(name))), achar(9), brief(n/10.0_wp)
    case ('decimal')
      read (*, *) x
      do i = 1, n
        call put_real(x(i), buffer, length)
        print '(a)', buffer(:length)
      end do
    case ('bessel')
      read (*, *) x
      call j0_of(x, y)
      print numbers, y
    case ('elliptic')
      read (*, *) x, y, z
      print numbers, carlson_rf(x, y, z)
    case ('quadrature')
      call gauss_legendre(x, y)
      z = logarithm_weights(x, y)
      nodes = given_nodes(x)
      print numbers, x, y, z, nodes%bases([0.3_wp]), legendre_values([0.3_wp], n)
    case ('wave')
      deallocate (y, z)
      read (*, *) x
      call wave_rule(x, [(40.0_wp, i=1, n)], 16.0_wp, [12.0_wp, 20.0_wp], 0.0_wp, 0.1_wp, &
        40.0_wp, y, z)
      print numbers, (sum(z*exp(-y)*cos(y*x(i))), i=1, n)
    case ('chebyshev')
      x = chebyshev_points(n - 1)
      y = chebyshev_series(exp(2*x))
      print numbers, series_value(y, 0.3_wp), series_value(series_slope(y), 0.3_wp), &
        series_value(series_integral(y), 0.3_wp)
    case ('cubic')
      read (*, *) x, y
      c = spline(x, y)
      print numbers, c, monotone(x, y)
    case ('interpolation')
      read (*, *) x, y, z
      hermite = hermite_through(x, y, z)
      print numbers, sum(polynomial_weights(x, 0.3_wp)*y), polynomial_slope(x, y, 0.3_wp), &
        hermite%value(0.3_wp), hermite%slope(0.3_wp)
    case ('ranks')
      read (*, *) x
      print numbers, (ranked(x, i), i=1, n), median_of(x)
    case ('tridiagonal')
      read (*, *) x, y, z
      c = reshape([y(2:), y(2:)], [n - 1, 2])
      call solve_tridiagonal(c(:, 1), x, c(:, 2), z)
      print numbers, z
    case ('singular')
      deallocate (y, z)
      allocate (c(n + 2, n), y(n))
      read (*, *) c
      call singular_values(c, y, c(:n, :))
      print numbers, y
    case default
      read (*, *) x
      call search(trim(name), x)
    end select
    deallocate (x)
    if (allocated(y)) deallocate (y)
    if (allocated(z)) deallocate (z)
    if (allocated(c)) deallocate (c)
  end do

contains

  subroutine j0_of(x, value)
    real(wp), intent(in) :: x(:)
    real(wp), intent(out) :: value(:)
    type(bessel_t) :: bessel

    bessel = new_bessel()
    call bessel%j0(x, value)
  end subroutine j0_of

  !> `root NAME`, `maximum` and `integral`: of a function between two places, and how many values
  !> that took.
  subroutine search(what, ends)
    character(len=*), intent(in) :: what
    real(wp), intent(in) :: ends(:)
    type(root_search_t) :: root
    type(bracket_t) :: bracket
    type(integral_t) :: integral
    integer :: asked, mark

    asked = 0
    mark = index(what, ':')
    select case (what(:mark - 1))
    case ('root')
      root = new_root_search(ends(1), f(what(mark + 1:), ends(1)), ends(2), &
        f(what(mark + 1:), ends(2)))
      do while (root%is_open())
        call root%note(root%place(), f(what(mark + 1:), root%place()))
        asked = asked + 1
      end do
      print numbers, root%root, real(asked, wp)
    case ('maximum')
      bracket%low = ends(1)
      bracket%high = ends(2)
      do i = 1, 60
        call bracket%keep_larger(f(what(mark + 1:), bracket%golden_points()))
      end do
      print numbers, bracket%middle()
    case ('integral')
      integral = new_integral(ends(:size(ends) - 1), ends(2:))
      do while (integral%is_open())
        call integral%note(f(what(mark + 1:), integral%places()))
        asked = asked + 1
      end do
      print numbers, integral%value, integral%error, real(asked, wp)
    end select
  end subroutine search

  elemental real(wp) function f(name, x)
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: x

    select case (name)
    case ('cosine')
      f = cos(x) - x
    case ('cube')
      f = x**3 - 2
    case ('flat')
      f = (x - 1)**9
    case ('step')
      f = sign(1.0_wp, x - 1/3.0_wp)
    case ('hump')
      f = exp(-(x - 0.7_wp)**2)
    case ('root')
      f = sqrt(x)
    case ('kink')
      f = abs(x - 1/3.0_wp)
    case ('waves')
      f = sin(50*x)**2
    case default
      f = 0
    end select
  end function f

end program base_values
