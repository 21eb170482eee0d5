"""Solved spheres under a Lennard-Jones law at any Tabor parameter, for the chapters on others.

Units are z0 of the law, R and E/(1-nu^2) of two identical bodies, twice E*. Loads are in pi w R,
radii and displacements in Maugis' units, (pi w R^2/K)^(1/3) with K = 4 E*/3 and its square over R;
h0 in z0.
"""

import functools
import math
import warnings
from typing import NamedTuple

import curves
import numpy as np
import pages  # noqa: F401 (one thread)
import runs  # noqa: F401 (makes the pictures' style importable)
import snapin
import style

ACCURACY = 1e-8
# Largest tension of the law over w/z0, at h = 3^(1/6) z0.
PEAK = 16 / (9 * math.sqrt(3))


def sigma(tabor):
    """Return the work of adhesion in these units, the paper's sigma."""
    return tabor**1.5 / 2


def unit(tabor):
    """Return Maugis' unit of the contact radius."""
    return (1.5 * math.pi * sigma(tabor)) ** (1 / 3)


def maugis_lambda(tabor):
    """Return Maugis' parameter, with the law's largest tension as the strength: 1.157 mu."""
    return 2 * PEAK * tabor * (9 / (16 * math.pi)) ** (1 / 3)


def tabor_of(lam):
    """Return the Tabor parameter of a Lennard-Jones law with this Maugis parameter."""
    return lam / maugis_lambda(1.0)


def spaced(low, high, count):
    """Return numbers evenly spaced in the logarithm."""
    return tuple(float(each) for each in np.geomspace(low, high, count))


# Maugis parameters of pictures, and the looks of curves in them.
LAMBDAS = spaced(0.01, 100, 81)
SOLVED = {"color": style.BLACK, "label": "Lennard-Jones, solved"}
MAUGIS = {"color": style.VERMILION, "dashes": (5, 1.5), "label": "Maugis-Dugdale theory"}


def theory(name, lam, load=0.0):
    """Return pull-off, positive, and radius at a load, on the stable branch, of a theory at a
    Maugis parameter, in pi w R and Maugis' units."""
    # With R = 1 and K = 1, pi w is the unit of load and 1/pi w the cube of the radii's unit.
    material = {"radius": 1.0, "stiffness": 1.5, "surface_energy": 1 / math.pi, "strength": lam / 2}
    return (-snapin.pull_off(name, **material),
            float(snapin.contact_radius(name, "load", [load], **material)[0]))


class Sphere(NamedTuple):
    """The results at one Tabor parameter; a jump that does not exist is None.

    Loads in pi w R, tension positive but for `load`; h0 in z0; `lost` in w R z0. `h0` and `load`
    are those along the path.
    """

    tension: float
    tension_h0: float
    jump_in: tuple
    jump_out: tuple
    lost: float
    h0: np.ndarray
    load: np.ndarray


def solved(**groups):
    """Return the results of a deck in units in which R is as short as the range of the force."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", snapin.SnapinWarning)
        return snapin.run(groups)


def run(tabor, h0_end, **groups):
    """Return the results of the whole path down to an h0."""
    return solved(bodies={"radius": 1.0, "stiffness": 1.0},
                  force={"law": "lennard_jones", "surface_energy": sigma(tabor), "z0": 1.0},
                  equilibrium_path={"h0_end": h0_end}, numerics={"accuracy": ACCURACY}, **groups)


@functools.lru_cache(maxsize=None)
def sphere(tabor):
    loads = math.pi * sigma(tabor)
    found = run(tabor, _deep(tabor, 0))
    summary = found.summary
    jumps = ((summary[f"jump_{way}_h0"], -summary[f"jump_{way}_load"] / loads)
             if f"jump_{way}_h0" in summary else None for way in ("in", "out"))
    return Sphere(summary["max_tension"] / loads, summary["max_tension_h0"], *jumps,
                  summary.get("energy_lost", 0.0) / sigma(tabor), found.curve["h0"],
                  found.curve["load"] / loads)


class Contact(NamedTuple):
    """A contact under a load, in Maugis' units: its radius, its displacement if bodies touch at
    z0, and the errors of theories in pull-off, radius and indentation, from the program's
    &regime."""

    radius: float
    displacement: float
    errors: dict


THEORIES = ("hertz", "jkr", "dmt", "maugis", "carpick", "pietrement")
# Loads [pi w R] at which contacts are compared.
LOADS = (0.0, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0)


@functools.lru_cache(maxsize=None)
def _places(tabor, loads):
    """Return h0 under each of some loads [pi w R], in compression, of one path."""
    newtons = [load * math.pi * sigma(tabor) for load in loads]
    table = run(tabor, _deep(tabor, max(loads)), fixed_load={"load": newtons}).fixed_load
    return {load: float(table["h0"][np.isclose(table["load"], each, rtol=1e-12, atol=0)].min())
            for load, each in zip(loads, newtons)}


@functools.lru_cache(maxsize=None)
def contact(tabor, load):
    """Return the Contact of a Tabor parameter under a load [pi w R], one of LOADS."""
    h0 = _places(tabor, LOADS if load else (0.0,))[load]
    summary = run(tabor, h0, regime={}).summary
    errors = {name: np.asarray(summary[f"regime_error_{name}"]) for name in THEORIES}
    (jkr,) = snapin.contact_radius("jkr", "load", [summary["end_load"]], radius=1.0, stiffness=1.0,
                                   surface_energy=sigma(tabor))
    return Contact(jkr / (1 + errors["jkr"][1]) / unit(tabor), (1 - h0) / unit(tabor) ** 2, errors)


def solved_at(lam):
    """Return pull-off [pi w R] and radius without load of solved spheres at a Maugis parameter."""
    return sphere(tabor_of(lam)).tension, contact(tabor_of(lam), 0.0).radius


def errors(name, lam, load=0.0):
    """Return the errors of a theory at a Maugis parameter in pull-off, radius and indentation."""
    return contact(tabor_of(lam), load).errors[name]


def _deep(tabor, load):
    """Return an h0 at which the load is certainly larger; DMT theory has the deepest h0, and the
    gap on the axis is between 0 and 1."""
    return (0.6 if load == 0 else -0.4) - (max(load, 0.0) + 2.5) ** (2 / 3) * 1.3 * unit(tabor) ** 2


def where(found, low, high, accuracy):
    """Return the number at which `found(x)` turns from false to true, between two numbers, in
    the logarithm."""
    return float(np.exp(curves.bisected(lambda x: found(float(np.exp(x))), *np.log([low, high]),
                                        accuracy)))
