!> The two elastic bodies as one.
module bodies
  use kinds, only: wp
  implicit none
  private
  public :: composite_stiffness, compliance_shares

contains

  !> Stiffness E/(1-nu^2) [Pa] of two identical bodies that deform together as much as these two.
  !> `young` [Pa] and `poisson` have one value for each body. The compliances add, so that
  !> (1-nu^2)/E of the identical bodies is the mean of the two bodies' values; the usual composite
  !> modulus E* is half of this stiffness. The two stiffnesses may differ by any factor.
  pure real(wp) function composite_stiffness(young, poisson) result(stiffness)
    real(wp), intent(in) :: young(2), poisson(2)

    stiffness = 2/sum((1 - poisson)*(1 + poisson)/young)
  end function composite_stiffness

  !> The deformation of each of two bodies over that of identical bodies of the composite stiffness:
  !> its compliance over the mean compliance. Arguments as in `composite_stiffness`.
  pure function compliance_shares(young, poisson) result(share)
    real(wp), intent(in) :: young(2), poisson(2)
    real(wp) :: share(2)

    share = composite_stiffness(young, poisson)*(1 - poisson)*(1 + poisson)/young
  end function compliance_shares

end module bodies
