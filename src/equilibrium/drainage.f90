!> A fluid between the bodies, which flows out while they approach and in while they separate. In
!> the thin gap it is a film of Reynolds (1886): between parabolas, in the units of
!> `dimensionless_problem`,
!>
!>     dH/dt = (1/strength) (1/rho) d/drho [rho m(H) dP_h/drho] ,  strength = 12 eta R/(p0 L) [s],
!>
!> so two integrals give the pressure from the rate of change of the gap at fixed rho:
!>
!>     P_h(rho) = -strength Int_rho^infinity [1/(rho' m)] Int_0^rho' dH/dt rho'' drho'' drho' .
!>
!> The mobility m is that between walls with the slip lengths b1 and b2 (Navier):
!>
!>     m = H**2 [H**2 + 4 H (b1 + b2) + 12 b1 b2]/(H + b1 + b2) ,
!>
!> which is H**3 without slip, H**3 + 6 b H**2 if both lengths are b, and 4 H**3 if one wall has
!> perfect slip. The rate follows from the present gap and the gaps of the last two instants, to
!> second order in the time step. At fixed rho the rate of the gap is that of the deformation.
module drainage
  use kinds, only: wp
  use discretisation, only: discretisation_t
  use running_integrals, only: running_integrals_t, new_running_integrals
  use advected_values, only: advected_t, new_advected
  use earlier_deformation, only: earlier_deformation_t
  implicit none
  private
  public :: fluid_t, drainage_t, earlier_t, rate_weights, farthest_pole

  !> The strength of the fluid [s], and its slip lengths in the law's lengths.
  type :: fluid_t
    real(wp) :: strength = 0, slip(2) = 0
  contains
    procedure :: mobility
  end type fluid_t

  !> An earlier state: its mesh, scale, gaps minus the shape, and weight in the rate [1/s].
  type :: earlier_t
    integer :: mesh = 1
    real(wp) :: scale = 1, weight = 0
    real(wp), allocatable :: raised(:)
  end type earlier_t

  !> The fluid in a time step. It has a film on each mesh of a family, and the weight [1/s] of the
  !> present gap in the rate. It also has the earlier states, and their part of the rate at the
  !> nodes of the present mesh.
  type, extends(fluid_t) :: drainage_t
    type(running_integrals_t), allocatable :: film(:)
    real(wp) :: weight = 0
    !> The two earlier states. (The array is allocatable: compiler note 11.)
    type(earlier_t), allocatable :: earlier(:)
    type(earlier_deformation_t), private :: known
  contains
    procedure :: lay_out
    procedure :: place
    procedure :: rate
    procedure :: pressure
    procedure :: changes
  end type drainage_t

  !> Relative difference of positions for the difference quotient.
  real(wp), parameter :: apart = 1.0e-5_wp

contains

  !> The mobility of the fluid, and its derivative by the gap.
  elemental subroutine mobility(self, gap, m, slope)
    class(fluid_t), intent(in) :: self
    real(wp), intent(in) :: gap
    real(wp), intent(out) :: m, slope
    real(wp) :: freer

    associate (sum => self%slip(1) + self%slip(2), product => self%slip(1)*self%slip(2))
      freer = (gap*(gap + 4*sum) + 12*product)/(gap + sum)
      m = gap**2*freer
      slope = 2*gap*freer + gap**2*(2*gap + 4*sum - freer)/(gap + sum)
    end associate
  end subroutine mobility

  !> Largest distance below a gap of zero at which the mobility has a pole or a zero, in the law's
  !> lengths.
  pure real(wp) function farthest_pole(fluid) result(depth)
    type(fluid_t), intent(in) :: fluid

    associate (sum => fluid%slip(1) + fluid%slip(2))
      depth = 2*(sum + sqrt(sum**2 - 3*fluid%slip(1)*fluid%slip(2)))
    end associate
  end function farthest_pole

  !> Weights [1/s] of the present value and of the two earlier values in the rate at the end of a
  !> step. The rate is the slope of the parabola through all three values or, if before = 0, of the
  !> line through the last two.
  pure function rate_weights(seconds, before) result(weights)
    real(wp), intent(in) :: seconds, before
    real(wp) :: weights(3), ratio

    ratio = 0
    if (before > 0) ratio = seconds/before
    weights = [(1 + 2*ratio)/(1 + ratio), -(1 + ratio), ratio**2/(1 + ratio)]/seconds
  end function rate_weights

  !> Makes the films on meshes.
  pure subroutine lay_out(self, grids)
    class(drainage_t), intent(inout) :: self
    type(discretisation_t), intent(in) :: grids(:)
    integer :: k

    if (allocated(self%film)) deallocate (self%film)
    allocate (self%film(size(grids)))
    if (.not. allocated(self%earlier)) allocate (self%earlier(2))
    do k = 1, size(grids)
      if (allocated(grids(k)%kernel)) self%film(k) = new_running_integrals(grids(k))
    end do
  end subroutine lay_out

  !> Computes the earlier states' part of the rate at the nodes of a mesh at an expected scale.
  pure subroutine place(self, grids, mesh, scale)
    class(drainage_t), intent(inout) :: self
    type(discretisation_t), intent(in) :: grids(:)
    integer, intent(in) :: mesh
    real(wp), intent(in) :: scale
    real(wp), dimension(grids(mesh)%nodes) :: value, growth
    type(advected_t) :: carried
    integer :: i, k

    value = 0
    growth = 0
    do k = 1, size(self%earlier)
      associate (past => self%earlier(k), x => grids(mesh)%x)
        if (.not. abs(past%weight) > 0) cycle
        associate (from => grids(past%mesh), ratio => scale/past%scale)
          carried = new_advected(from, past%raised, ratio > 1)
          do i = 1, size(value)
            value(i) = value(i) + past%weight*carried%at(from, ratio*x(i))
            growth(i) = growth(i) + past%weight/(2*apart)* &
              (carried%at(from, (1 + apart)*ratio*x(i)) - carried%at(from, (1 - apart)*ratio*x(i)))
          end do
        end associate
      end associate
    end do
    self%known = earlier_deformation_t(scale, value, growth)
  end subroutine place

  !> The rate [1/s] of the gaps; raised: the gaps minus the shape.
  pure function rate(self, scale, raised) result(change)
    class(drainage_t), intent(in) :: self
    real(wp), intent(in) :: scale, raised(:)
    real(wp) :: change(size(raised))

    change = self%weight*raised + self%known%at_scale(scale)
  end function rate

  !> The pressure of the fluid at the nodes of a mesh.
  function pressure(self, mesh, scale, gap, rate) result(p)
    class(drainage_t), intent(in) :: self
    integer, intent(in) :: mesh
    real(wp), intent(in) :: scale, gap(:), rate(:)
    real(wp), dimension(size(gap)) :: p, m, slope

    call self%mobility(gap, m, slope)
    associate (film => self%film(mesh))
      p = -self%strength*scale**2*film%beyond%of(film%gathered%of(rate)/m)
    end associate
  end function pressure

  !> Derivatives of weighted sums of the pressures: by the gaps, by_gap (sums, nodes), and by the
  !> scale of the mesh at fixed gaps, by_scale. weights (sums, nodes): of the nodes in each sum;
  !> shape_slope: x f'(c x), the derivative of the shape by the scale.
  subroutine changes(self, mesh, scale, gap, raised, shape_slope, weights, by_gap, by_scale)
    class(drainage_t), intent(in) :: self
    integer, intent(in) :: mesh
    real(wp), intent(in) :: scale, gap(:), raised(:), shape_slope(:), weights(:, :)
    real(wp), intent(out) :: by_gap(:, :), by_scale(:)
    real(wp), dimension(size(gap)) :: now, m, slope
    real(wp), allocatable :: flow(:, :)
    integer :: sums

    now = self%rate(scale, raised)
    call self%mobility(gap, m, slope)
    sums = size(weights, 1)
    associate (film => self%film(mesh))
      flow = -self%strength*scale**2*film%beyond%after(weights)/spread(m, 1, sums)
      by_gap = self%weight*film%gathered%after(flow) - &
        flow*spread(film%gathered%of(now)*slope/m, 1, sums)
    end associate
    by_scale = matmul(weights, 2*self%pressure(mesh, scale, gap, now)/scale + &
      self%pressure(mesh, scale, gap, self%known%growth/scale - self%weight*shape_slope))
  end subroutine changes

end module drainage
