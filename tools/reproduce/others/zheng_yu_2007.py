"""Zheng and Yu (2007), Grierson et al. (2013): bodies f = B r^n, JKR theory and Lennard-Jones."""

import functools
import math

import spheres
import style
from report import Comparison

EXPONENTS = (1.0, 1.5, 2.0, 3.0, 4.0, 6.0)
_TABORS = (1.0, 3.0, 10.0, 30.0)
_MANY = spheres.spaced(0.1, 100, 25)
_COLORS = (style.BLACK, style.BLUE, style.VERMILION, style.GREEN, style.ORANGE, style.PURPLE)
_SOURCE = ("JKR theory for f = B r^n, from Galin (1946) and Sneddon (1965): the formula of the "
           "caption")
# E* = 1/2 and B = 1/2: mu_n = (2 w)^(n/(2n - 1)).
_B, _MODULUS = 0.5, 0.5


def _work(exponent, tabor):
    return tabor ** ((2 * exponent - 1) / exponent) / 2


def _kappa(n):
    return math.sqrt(math.pi) * math.gamma(n / 2 + 1) / math.gamma((n + 1) / 2)


def formula(exponent, work):
    """Return contact radius and pull-off of JKR theory."""
    n = exponent
    a = (3 * math.sqrt(2 * math.pi * work / _MODULUS) / (2 * n * _kappa(n) * _B)) ** (1 / (n - 0.5))
    return a, math.sqrt(8 * math.pi * work * _MODULUS) * a**1.5 * (2 * n - 1) / (2 * (n + 1))


def _deck(exponent, work, **groups):
    return spheres.solved(shape={"kind": "power", "exponent": exponent, "coefficient": _B},
                          force={"law": "lennard_jones", "surface_energy": work, "z0": 1.0},
                          **groups).summary


@functools.lru_cache(maxsize=None)
def solved(exponent, tabor):
    """Return the pull-off of Lennard-Jones bodies."""
    work = _work(exponent, tabor)
    a, _ = formula(exponent, work)
    depth = _kappa(exponent) * _B * a**exponent - math.sqrt(2 * math.pi * work * a / _MODULUS)
    return _deck(exponent, work, bodies={"stiffness": 1.0},
                 equilibrium_path={"h0_end": min(-0.5, -depth - 0.5 * abs(depth))})["max_tension"]


def ratio(exponent, tabor):
    """Return the solved pull-off over that of the formula."""
    return solved(exponent, tabor) / formula(exponent, _work(exponent, tabor))[1]


def rigid_cone():
    """Return pull-off and its h0 of rigid cones with tan(beta) = B, over w z0/B^2 and over z0."""
    summary = _deck(1.0, 1.0, bodies={"rigid": True}, loading={
        "h0_start": 3.0, "h0_end": 0.7, "h0_step": 0.1})
    return summary["max_tension"] * _B**2, summary["max_tension_h0"]


def _good(exponent):
    """Return the least mu_n, of those drawn, above which the formula is within 1 %."""
    bad = [tabor for tabor in _MANY if abs(1 / ratio(exponent, tabor) - 1) > 0.01]
    above = [tabor for tabor in _MANY if not bad or tabor > bad[-1]]
    return f"{above[0]:.2g}" if above else f"beyond {_MANY[-1]:g}"


def numbers(_):
    return {"goods": ", ".join(map(_good, EXPONENTS)),
            "exponents": ", ".join(f"{n:g}" for n in EXPONENTS)}


def draw(_):
    page, panel = style.figure(height=4.0)
    panel.axhspan(0.99, 1.01, color=style.GREY, alpha=0.2, linewidth=0)
    for exponent, color in zip(EXPONENTS, _COLORS):
        panel.semilogx(_MANY, [ratio(exponent, tabor) for tabor in _MANY], color=color,
                       label=f"n = {exponent:g}")
    style.label(panel, "$\\mu_n$", "pull-off, solved / JKR theory", ylim=(0.8, 1.6))
    panel.legend(loc="upper right")
    return page


def rows(_):
    works = {(exponent, tabor): _work(exponent, tabor)
             for exponent in EXPONENTS for tabor in _TABORS}
    found = [Comparison(f"f = B r^{exponent:g}, mu_n = {tabor:g}, pull-off", "formula",
                        formula(exponent, work)[1] / work, solved(exponent, tabor) / work,
                        "w, B = 1/(2 z0^(n-1)), lateral unit z0", _SOURCE)
             for (exponent, tabor), work in works.items()]
    tension, h0 = rigid_cone()
    return [*found,
            Comparison("rigid cones, pull-off", "formula", 16 * math.pi / 7 * 4 ** (1 / 6),
                       tension, "w z0/tan^2 beta", "Derjaguin's integral in closed form"),
            Comparison("rigid cones, h0 at the pull-off", "formula", 4 ** (-1 / 6), h0, "z0",
                       "Derjaguin's integral in closed form")]
