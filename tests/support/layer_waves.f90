!> layer_waves: for tests of `layered_surface`. Reads the number of layers, thicknesses, shear
!> moduli and Poisson's ratios from the top down, whether the base is rigid, its shear modulus and
!> Poisson's ratio, the number of wave numbers and these; prints what the surface yields to each.
program layer_waves
  use kinds, only: wp
  use layered_surface, only: layered_surface_t
  implicit none

  type(layered_surface_t) :: surface
  real(wp), allocatable :: k(:)
  integer :: layers, waves, i, ended

  do
    read (*, *, iostat=ended) layers
    if (ended /= 0) exit
    allocate (surface%thickness(layers), surface%shear(layers), surface%poisson(layers))
    read (*, *) surface%thickness
    read (*, *) surface%shear
    read (*, *) surface%poisson
    read (*, *) surface%on_rigid, surface%base_shear, surface%base_poisson
    read (*, *) waves
    allocate (k(waves))
    read (*, *) k
    print '(*(es25.16))', (surface%compliance(k(i)), i=1, waves)
    deallocate (surface%thickness, surface%shear, surface%poisson, k)
  end do
end program layer_waves
