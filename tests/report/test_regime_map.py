"""The errors that `&regime` gives, over all strengths of adhesion: those of theories against the
profile and the curve in the results."""

import math

import numpy as np
import pytest
import snapin
from support.scenes import UNIT, lennard_jones, several

THEORIES = ("hertz", "jkr", "dmt", "maugis", "carpick", "pietrement")
EDGE, REST = 3 ** (1 / 6), 1.0
# Largest tension of the Lennard-Jones law over gamma/z0.
STRENGTH = 16 / (9 * math.sqrt(3))
SIGMAS = np.geomspace(1e-3, 1e3, 10)


# --- Theories. R = z0 = E/(1-nu^2) = 1 and w = sigma


def says(theory, load, w):
    """Pull-off, and contact radius and indentation under a load. tests/theory has the equations."""
    name = "pietrement_troyon" if theory == "pietrement" else theory
    bodies = dict(UNIT)
    if name != "hertz":
        bodies["surface_energy"] = w
    if name in ("maugis", "carpick", "pietrement_troyon"):
        bodies["strength"] = STRENGTH * w
    pull = 0.0 if name == "hertz" else snapin.pull_off(name, **bodies)
    (radius,) = snapin.contact_radius(name, "load", [load], **bodies)
    if name == "carpick":
        return pull, radius, math.nan
    if name == "pietrement_troyon":
        (alone,) = snapin.contact_radius(name, "load", [0.0], **bodies)
        return pull, radius, radius**2 - pietrement_shift(w, radius / alone) * alone**2
    carried, (indentation,) = snapin.contact_curve(name, [radius], **bodies)
    assert carried[0] == pytest.approx(load, rel=1e-9)
    return pull, radius, indentation


def pietrement_shift(w, ratio):
    """S of the formula, at a ratio of contact radii."""
    lam = 2 * STRENGTH * w * (9 / (4 * math.pi * w)) ** (1 / 3)
    alpha = (1 - math.exp(-lam / 0.924)) / 1.02
    s = -2.160 * alpha**0.019 + 2.7531 * alpha**0.064 + 0.073 * alpha**1.919
    return s * ratio ** (0.516 * alpha**4 - 0.683 * alpha**3 + 0.235 * alpha**2 + 0.429 * alpha)


# --- What the path says


def solved(found, sigma, h0_end):
    """Load, then pull-off, contact radius and indentation, from the tables."""
    table = found.table("profiles.csv")
    r, gap = table["r"], table["separation"]
    i = int(np.flatnonzero(gap > EDGE)[0])
    # Through the points around the edge: the gap opens as a root of the distance, but smoothly.
    near = slice(max(i - 4, 0), i + 4)
    radius = _inverse(r[near], gap[near], EDGE)
    load = found.summary["end_load"]
    return load, (-found.summary["max_tension"], radius, REST - h0_end)


def _inverse(r, gap, at):
    """r at a gap, by the polynomial through all points."""
    weights = [np.prod([(at - gap[k]) / (gap[i] - gap[k]) for k in range(r.size) if k != i])
               for i in range(r.size)]
    return float(np.dot(weights, r))


def scene(sigma, accuracy):
    h0_end = -(20 + 3 * sigma ** (2 / 3))
    text = lennard_jones(sigma, equilibrium_path={"h0_end": h0_end}, regime={},
                         profiles={"h0": h0_end}, numerics={"accuracy": accuracy})
    return text, h0_end


@pytest.mark.parametrize("sigma, accuracy", [
    *((sigma, 1e-5) for sigma in SIGMAS[::3]),
    *(pytest.param(sigma, 1e-7, marks=pytest.mark.long) for sigma in SIGMAS)])
def test_errors_are_those_of_the_theories_against_the_tables(run, sigma, accuracy):
    text, h0_end = scene(sigma, accuracy)
    found = run(text)
    load, (pull, radius, indentation) = solved(found, sigma, h0_end)
    for name in THEORIES:
        tension, a, depth = says(name, load, sigma)
        expected = (tension / pull - 1, a / radius - 1, (depth - indentation) / radius**2)
        errors = several(found.summary[f"regime_error_{name}"])
        assert errors == pytest.approx(expected, abs=2e-4, nan_ok=True), name


def test_theories_are_recommended_where_they_hold(run):
    best = {sigma: run(scene(sigma, 1e-5)[0]).summary["regime_recommended"]
            for sigma in (SIGMAS[0], SIGMAS[-1])}
    assert best[SIGMAS[0]] in ("dmt", "maugis")
    assert best[SIGMAS[-1]] in ("jkr", "maugis")
