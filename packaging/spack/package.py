"""A package of Spack: the program, its library with modules, and the Python package."""

from spack_repo.builtin.build_systems.meson import MesonPackage

from spack.package import *


class Snapin(MesonPackage):
    """Elastic deformation and adhesion of two bodies in contact, under surface forces of finite
    range."""

    # The owner fills in homepage and maintainers, and the address and checksum of the source
    # distribution:
    #   homepage = ...
    #   url = .../snapin-0.1.0.tar.gz
    #   maintainers(...)
    #   version("0.1.0", sha256=...)
    # Without them: spack dev-build snapin@0.1.0 in an unpacked source distribution.
    version("0.1.0")

    license("MIT AND Minpack")

    variant("python", default=True, description="Build the Python package")
    variant("mpi", default=False, description="Sweeps on many processes")

    depends_on("c", type="build")
    depends_on("fortran", type="build")
    depends_on("meson@1.4:", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("python@3.9:", type="build")
    depends_on("blas")
    depends_on("lapack")
    depends_on("mpi", when="+mpi")
    with when("+python"):
        extends("python")
        depends_on("py-numpy@2:", type=("build", "run"))

    def meson_args(self):
        python = "enabled" if self.spec.satisfies("+python") else "disabled"
        mpi = "enabled" if self.spec.satisfies("+mpi") else "disabled"
        blas = "openblas" if self.spec["blas"].name == "openblas" else "lapack"
        # Spack's compiler wrappers choose the processor.
        return [f"-Dpython={python}", f"-Dmpi={mpi}", f"-Dblas={blas}", "-Dprocessor=any"]

    def setup_build_environment(self, env):
        if self.spec.satisfies("+mpi"):
            env.set("FC", self.spec["mpi"].mpifc)
