"""The header of the contact law, compiled and called through ctypes, and what its values should
be."""

import copy
import ctypes
import pathlib
import shutil
import subprocess

import numpy as np
import pytest

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "contact_law"
HEADER = FOLDER / "snapin_contact.h"
COMPILER = shutil.which("cc") or shutil.which("gcc")
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wsign-conversion", "-Werror"]
# All functions at many h0, each with the state before, and the numbers of the law.
_SHARED = """
#include "snapin_contact.h"
int values(const double *b, int n, const double *h0, const int *before, double *out, int *after,
           double *numbers) {
  static snapin_contact law;
  int i, k, failed = snapin_contact_init(&law, b[0], b[1], b[2], b[3]);
  for (i = 0; i < n; ++i) {
    k = before[i]; out[4 * i] = snapin_contact_load(&law, h0[i], &k);
    k = before[i]; out[4 * i + 1] = snapin_contact_radius(&law, h0[i], &k);
    k = before[i]; out[4 * i + 2] = snapin_contact_stiffness(&law, h0[i], &k);
    k = before[i]; out[4 * i + 3] = snapin_contact_energy(&law, h0[i], &k);
    after[i] = k;
  }
  numbers[0] = snapin_contact_pull_off(&law);
  numbers[1] = snapin_contact_pull_off_h0(&law);
  numbers[2] = snapin_contact_snap_in(&law);
  numbers[3] = snapin_contact_snap_off(&law);
  numbers[4] = snapin_contact_snap_in_load(&law);
  numbers[5] = snapin_contact_snap_off_load(&law);
  numbers[6] = snapin_contact_energy_lost(&law);
  numbers[7] = snapin_contact_tabor(&law);
  return failed;
}
"""
# Tabor's parameters on all panels, at their ends, at the cusp and beyond the tables.
MUS = [1e-8, 1e-3, 0.0299, 0.0301, 0.3, 0.696, 0.6973, 0.72, 0.9, 1.4, 5, 40, 199, 201, 3000]
FUNCTIONS = "load", "contact_radius", "stiffness", "energy"
NUMBERS = ("pull_off", "pull_off_h0", "snap_in", "snap_off", "snap_in_load", "snap_off_load",
           "energy_lost", "tabor")


def compiled(folder, source, name, *options, header=HEADER):
    """Compile a program, or with -shared a library, from C text."""
    text, made = folder / f"{name}.c", folder / name
    text.write_text(source)
    subprocess.run([COMPILER, "-std=c99", "-O2", f"-I{header.parent}", *options, str(text), "-o",
                    str(made), "-lm"], check=True)
    return made


class Header:
    """The functions of a compiled header."""

    def __init__(self, folder, header=HEADER):
        made = compiled(folder, _SHARED, "law.so", "-shared", "-fPIC", header=header)
        self._call = ctypes.CDLL(str(made)).values

    def __call__(self, bodies, h0, before):
        """Return the code, functions at h0 (rows), contact after, and the law's numbers."""
        h0 = np.ascontiguousarray(h0, float)
        before = np.ascontiguousarray(np.broadcast_to(before, h0.shape), np.int32)
        found, after, numbers = np.empty((h0.size, 4)), np.empty_like(before), np.empty(8)
        failed = self._call(*(one.ctypes.data_as(ctypes.c_void_p) if isinstance(one, np.ndarray)
                              else ctypes.c_int(one) for one in (
                                  np.array(bodies, float), h0.size, h0, before, found, after,
                                  numbers)))
        return (failed, dict(zip(FUNCTIONS, found.T)), after.astype(bool),
                dict(zip(NUMBERS, numbers)))


def assert_same(law, h0, before, functions, after, numbers):
    """Functions and contact at h0, and numbers, of another program are those of the law."""
    assert (after == law.in_contact(h0, before)).all()
    for name, found in zip(FUNCTIONS, functions):
        expected = getattr(law, name)(h0, before)
        assert (np.abs(found - expected) <= allowed(law, name, h0, expected)).all(), name
    for name, found in zip(NUMBERS, numbers):
        # The energy lost is a difference of energies.
        least = 1e-9*scales_of(law)["energy"] if name == "energy_lost" else 0
        assert found == pytest.approx(getattr(law, name), rel=1e-9, abs=least, nan_ok=True), name


def bodies_at(mu, radius=2e-6, work=0.04, z0=0.35e-9):
    """Radius, E*, work of adhesion and z0 with a Tabor parameter."""
    return radius, np.sqrt(radius*work**2/(mu*z0)**3), work, z0


def gaps_of(law, generator):
    """h0 of all kinds: about the jumps, far and deep."""
    size = max(1.0, law.tabor)
    return law.z0*np.concatenate([
        generator.uniform(-6*size, 8*size, 400), 10**generator.uniform(0, 8, 60),
        -10**generator.uniform(-3, 9, 60)])


def scales_of(law):
    """The unit of each function."""
    load = np.pi*law.work_of_adhesion*law.radius
    return {"load": load, "contact_radius": np.sqrt(law.radius*law.z0),
            "stiffness": load/law.z0, "energy": load*law.z0}


def allowed(law, name, h0, expected):
    """How far two programs of one law may differ at h0: by the ends of their iterations, since near
    a jump the functions have infinite slopes over h0; far apart by rounding."""
    near = scales_of(law)[name]*(1 + law.tabor)*(h0 < 40*law.z0*max(1.0, law.tabor)**0.5)
    return 1e-8*(np.abs(expected) + near)


def parted(table):
    """A table in which a turn of h0 lies between two panels, and Tabor's parameters about it.

    At 0.75754 snap-in passes from the second to the first tile outside contact. The slope of the
    second is lowered by more than the slopes of the two differ by there.
    """
    changed = copy.deepcopy(table)
    near = next(panel for panel in changed["near"]
                if panel["variable"] == "mu" and np.exp(panel["high"]) > 0.75754)
    near["outside"][1][0]["rows"][0][1] -= 1000
    return changed, np.linspace(0.757, 0.7582, 13)
