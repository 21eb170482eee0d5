"""The errors that `&regime` gives, over all strengths of adhesion: those of the theories'
equations, solved here, against the profile and the curve in the results."""

import math

import numpy as np
import pytest
from support.calculus import zero
from support.scenes import lennard_jones, several

THEORIES = ("hertz", "jkr", "dmt", "maugis", "carpick", "pietrement")
EDGE, REST = 3 ** (1 / 6), 1.0
# Largest tension of the Lennard-Jones law over gamma/z0.
STRENGTH = 16 / (9 * math.sqrt(3))
SIGMAS = np.geomspace(1e-3, 1e3, 10)


# --- Theories. R = z0 = E/(1-nu^2) = 1, so that K = 4/3 E* = 2/3 and w = sigma. Each gives
# pull-off, and contact radius and indentation under a load.

K = 2 / 3


def hertz(load, _):
    a = (load / K) ** (1 / 3)
    return 0.0, a, a**2


def dmt(load, w):
    a = ((load + 2 * math.pi * w) / K) ** (1 / 3)
    return -2 * math.pi * w, a, a**2


def jkr(load, w):
    pull = 3 * math.pi * w
    a = ((load + pull + math.sqrt(2 * pull * load + pull**2)) / K) ** (1 / 3)
    return -pull / 2, a, a**2 - math.sqrt(8 * math.pi * w * a / (3 * K))


def edge_ratio(a, strength):
    """m of Maugis' first equation: the radius at which the tension ends over that of contact."""
    def equation(log_excess):
        m = 1 + math.exp(log_excess)
        t, angle = math.sqrt(m * m - 1), math.acos(1 / m)
        return (strength * a**2 / 2 * (t + (m * m - 2) * angle)
                + 4 / 3 * strength**2 * a * (t * angle - m + 1) - 1)

    return 1 + math.exp(zero(equation, -35.0, 25.0))


def maugis_load(a, strength):
    m = edge_ratio(a, strength)
    return a**3 - strength * a**2 * (math.sqrt(m * m - 1) + m * m * math.acos(1 / m))


def maugis(load, w):
    strength = lambda_of(w)
    unit = (math.pi * w / K) ** (1 / 3)
    radii = np.geomspace(1e-3, 3, 400)
    loads = [maugis_load(a, strength) for a in radii]
    i = int(np.clip(np.argmin(loads), 1, radii.size - 2))
    low, high = radii[i - 1], radii[i + 1]
    for _ in range(100):
        one, two = (2 * low + high) / 3, (low + 2 * high) / 3
        low, high = ((low, two) if maugis_load(one, strength) < maugis_load(two, strength)
                     else (one, high))
    pull = min(maugis_load(low, strength), loads[0])
    wanted = load / (math.pi * w)
    a = zero(lambda a: maugis_load(a, strength) - wanted, low, 2 * (wanted + 10) ** (1 / 3))
    m = edge_ratio(a, strength)
    indentation = a**2 - 4 / 3 * strength * a * math.sqrt(m * m - 1)
    return math.pi * w * pull, a * unit, indentation * unit**2


def fitted(load, w, pull, a0, s=math.nan, beta=math.nan):
    """Carpick's and Pietrement and Troyon's forms; `pull` > 0 and `a0` in Maugis' units."""
    alpha, unit = alpha_of(w), (math.pi * w / K) ** (1 / 3)
    z = (alpha + math.sqrt(1 + load / (math.pi * w * pull))) / (1 + alpha)
    indentation = (a0 * unit) ** 2 * (z ** (4 / 3) - s * z ** (2 * beta / 3))
    return -math.pi * w * pull, a0 * unit * z ** (2 / 3), indentation


def lambda_of(w):
    return 2 * STRENGTH * w * (1 / (math.pi * w * K**2)) ** (1 / 3)


def alpha_of(w):
    return (1 - math.exp(-lambda_of(w) / 0.924)) / 1.02


def carpick(load, w):
    power, other = 4.04 * lambda_of(w) ** 1.4, 2.28 * lambda_of(w) ** 1.3
    return fitted(load, w, 7 / 4 - (power - 1) / (power + 1) / 4,
                  1.54 + 0.279 * (other - 1) / (other + 1))


def pietrement(load, w):
    alpha = alpha_of(w)
    return fitted(
        load, w, 0.267 * alpha**2 - 0.767 * alpha + 2,
        -0.451 * alpha**4 + 1.417 * alpha**3 - 1.365 * alpha**2 + 0.950 * alpha + 1.264,
        -2.160 * alpha**0.019 + 2.7531 * alpha**0.064 + 0.073 * alpha**1.919,
        0.516 * alpha**4 - 0.683 * alpha**3 + 0.235 * alpha**2 + 0.429 * alpha)


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
        says = globals()[name](load, sigma)
        expected = (says[0] / pull - 1, says[1] / radius - 1, (says[2] - indentation) / radius**2)
        errors = several(found.summary[f"regime_error_{name}"])
        assert errors == pytest.approx(expected, abs=2e-4, nan_ok=True), name


def test_theories_are_recommended_where_they_hold(run):
    best = {sigma: run(scene(sigma, 1e-5)[0]).summary["regime_recommended"]
            for sigma in (SIGMAS[0], SIGMAS[-1])}
    assert best[SIGMAS[0]] in ("dmt", "maugis")
    assert best[SIGMAS[-1]] in ("jkr", "maugis")
