!> The matrix of the elastic kernel on mapped panels.
!>
!> Away from the axis the coefficient of the kernel's logarithm is as smooth as the map. The nodes'
!> own rule with its defect for a logarithm (`logarithm_defect`) then integrates kernel times
!> pressure as accurately as the nodes resolve the pressure. At the axis this coefficient is
!> singular, and in a tail the map is; there the quadrature points are graded towards the target
!> (`graded_kernel`). On linear panels these points serve all targets, so that polynomials of any
!> degree below the number of nodes are integrated to the last digit.
module panel_kernel
  use kinds, only: wp, pi
  use elastic_kernel, only: kernel, kernel_log_coefficient
  use matrix_products, only: multiply_transposed
  use logarithm_defect, only: logarithm_defects, feels_logarithm
  use quadrature, only: gauss_legendre, legendre_values
  use local_nodes, only: local_nodes_t
  use panel_map, only: panel_map_t, sinh_map, algebraic_map
  use graded_kernel, only: add_graded
  implicit none
  private
  public :: add_panel

  !> Distance from the axis, in z, up to which points are graded; and fraction of a panel above
  !> which the whole panel gets graded points.
  real(wp), parameter :: about_axis = 1.8_wp, nearly_all = 0.8_wp

contains

  !> Adds the matrix of a panel: the sum of matrix(i, j) f(j) over j is the integral of k(r, t) f(t)
  !> t dt over the panel, for r = centre + target(i). Here f is a polynomial of the panel's local
  !> coordinate that the nodes resolve, times the tail if the panel has one. On a linear panel f is
  !> any polynomial through the nodes. own: the index of the panel's first node among the targets;
  !> 0: none is a node.
  subroutine add_panel(panel, local, digits, centre, target, own, matrix)
    type(panel_map_t), intent(in) :: panel
    type(local_nodes_t), intent(in) :: local
    real(wp), intent(in) :: digits, centre, target(:)
    integer, intent(in) :: own
    real(wp), intent(out) :: matrix(:, :)
    ! Integrals against Legendre polynomials, (order, targets); local coordinates of the targets.
    real(wp) :: moments(size(local%node), size(target)), place(size(target)), part
    integer :: k

    associate (node => local%node)
      ! A target outside a panel to infinity is left of it.
      place = -1
      if (panel%kind /= algebraic_map) place = panel%locals(target)
      if (own > 0) place(own:own + size(node) - 1) = node
      part = 1
      if (panel%kind == sinh_map) then
        part = part_about_axis(panel, centre, size(node), digits)
        if (.not. part > 0) then
          matrix = transpose(values_on(panel, node, local%weight, 0.0_wp, digits, centre, target, &
            place))
          return
        end if
      end if
      moments = 0
      call add_graded(panel, part, digits, centre, target, place, moments)
      if (part < 1) call add_rest(panel, part, digits, centre, target, place, moments)
      call multiply_transposed(moments, lagrange(local), matrix)
      if (.not. panel%decay > 0) return
      do k = 1, size(node)
        matrix(:, k) = matrix(:, k)/(1 - node(k))**panel%decay
      end do
    end associate
  end subroutine add_panel

  !> The part of a panel, from its left end, that needs graded points because of the axis, where the
  !> logarithm's coefficient has a logarithm of its own.
  pure real(wp) function part_about_axis(panel, centre, nodes, digits) result(part)
    type(panel_map_t), intent(in) :: panel
    real(wp), intent(in) :: centre, digits
    integer, intent(in) :: nodes
    real(wp) :: from_axis

    from_axis = max(0.0_wp, panel%z_left + asinh((centre + panel%focus)/panel%d))
    part = 0
    if (from_axis < about_axis .and. feels_logarithm(from_axis/panel%z_length, nodes, digits)) &
      part = (about_axis - from_axis)/panel%z_length
    ! A rule for a very small remaining part would cost more than it saves.
    if (part > nearly_all) part = 1
  end function part_about_axis

  !> Weights times kernel, (points, targets), for Gauss points s of the panel outside the part near
  !> the axis. place: local coordinates of the targets.
  function values_on(panel, s, weight, part, digits, centre, target, place) result(f)
    type(panel_map_t), intent(in) :: panel
    real(wp), intent(in) :: s(:), weight(:), part, digits, centre, target(:), place(:)
    real(wp) :: f(size(s), size(target))
    real(wp), dimension(size(s)) :: offset, t, speed, measure, a, total, distance
    real(wp), allocatable :: defect(:, :)
    logical :: near(size(target))
    integer :: i, j, k

    offset = panel%offset(s)
    t = centre + offset
    speed = (1 - part)*panel%speed(s)
    measure = t*speed
    near = feels_logarithm(max(part - place, place - 1, 0.0_wp)/(1 - part), size(s), digits)
    defect = logarithm_defects((s - part)/(1 - part), weight, (pack(place, near) - part)/(1 - part))
    j = 0
    do i = 1, size(target)
      total = 2*centre + target(i) + offset
      distance = abs(target(i) - offset)
      if (near(i)) then
        j = j + 1
        a = kernel_log_coefficient(total, distance)
        ! At the target itself the value is that of the kernel without its logarithm.
        k = minloc(abs(s - place(i)), 1)
        if (.not. abs(s(k) - place(i)) > 0) distance(k) = total(k)
        f(:, i) = measure*(weight*kernel(total, distance) + a*defect(:, j))
        if (.not. abs(s(k) - place(i)) > 0) &
          f(k, i) = measure(k)*a(k)*(weight(k)*log(8*t(k)/speed(k)) + defect(k, j))
      else
        f(:, i) = measure*weight*kernel(total, distance)
      end if
    end do
  end function values_on

  !> Adds the moments of the panel outside the part near the axis.
  subroutine add_rest(panel, part, digits, centre, target, place, moments)
    type(panel_map_t), intent(in) :: panel
    real(wp), intent(in) :: part, digits, centre, target(:), place(:)
    real(wp), intent(inout) :: moments(:, :)
    real(wp), allocatable :: s(:), weight(:)
    real(wp) :: of_these(size(moments, 1), size(moments, 2))
    integer :: points

    ! Polynomials oscillate uniformly in this angle; the kernel and the coupling to neighbouring
    ! panels need a few points more.
    points = ceiling(size(moments, 1)*(1 - acos(1 - 2*part)/pi) + 4 + 2*digits)
    allocate (s(points), weight(points))
    call gauss_legendre(s, weight)
    s = part + (1 - part)*s
    call multiply_transposed(legendre_values(s, size(moments, 1)), &
      values_on(panel, s, weight, part, digits, centre, target, place), of_these)
    moments = moments + of_these
  end subroutine add_rest

  !> The element (m, j): coefficient of the Legendre polynomial of degree m - 1 in the Lagrange
  !> polynomial of node j. The rule of as many Gauss points is exact for the product of the two.
  pure function lagrange(local) result(coefficient)
    type(local_nodes_t), intent(in) :: local
    real(wp) :: coefficient(size(local%node), size(local%node))
    real(wp), dimension(size(local%node)) :: x, weight
    integer :: m, k

    call gauss_legendre(x, weight)
    coefficient = transpose(legendre_values(x, size(x)))
    do k = 1, size(x)
      coefficient(:, k) = weight(k)*coefficient(:, k)
    end do
    if (maxval(abs(local%node - x)) > 0) &
      coefficient = matmul(coefficient, transpose(local%bases(x)))
    do m = 1, size(x)
      coefficient(m, :) = (2*m - 1)*coefficient(m, :)
    end do
  end function lagrange

end module panel_kernel
