!> The two elastic bodies, seen as one.
module bodies
  use kinds, only: wp
  implicit none
  private
  public :: composite_stiffness, compliance_shares

contains

  !> Stiffness E/(1-nu^2) [Pa] of two identical bodies that deform together as these two do.
  !> `young` [Pa] and `poisson` hold one value a body. The compliances add, so that (1-nu^2)/E of
  !> the identical bodies is the arithmetic mean of the two bodies' values; the usual composite
  !> modulus E* is half of this stiffness. A body may be stiffer than the other by any factor.
  pure real(wp) function composite_stiffness(young, poisson) result(stiffness)
    real(wp), intent(in) :: young(2), poisson(2)

    stiffness = 2/sum((1 - poisson)*(1 + poisson)/young)
  end function composite_stiffness

  !> The deformation of each of two bodies over that of identical bodies of the composite stiffness:
  !> its compliance over the mean compliance. Arguments as above.
  pure function compliance_shares(young, poisson) result(share)
    real(wp), intent(in) :: young(2), poisson(2)
    real(wp) :: share(2)

    share = composite_stiffness(young, poisson)*(1 - poisson)*(1 + poisson)/young
  end function compliance_shares

end module bodies
