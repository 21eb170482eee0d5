"""Ciavarella, Greenwood and Barber (2017): the energy dissipated in a cycle of contact."""

import math

import numpy as np
import spheres
import style
from others import greenwood_1997, wu_2010
from report import Comparison

# A cycle of JKR theory at fixed displacement: in at displacement 0, out where
# d(displacement)/da = 0.
# In A = a/(pi w R^2/K)^(1/3), P = A^3 - A sqrt(6 A), D = A^2 - (2/3) sqrt(6 A); the loss in
# pi w R (pi^2 w^2 R/K^2)^(1/3) is the area between the jumps.
TABORS = (0.8, 1.0, 2.0, 5.0, 10.0, 100.0)
_MANY = spheres.spaced(0.7, 1000, 40)


def jkr():
    """Return the loss of JKR theory in (R^4 w^5/E*^2)^(1/3), by its integral."""
    low, high = (1 / 6) ** (1 / 3), (8 / 3) ** (1 / 3)
    x, weight = np.polynomial.legendre.leggauss(60)
    a = (low + high) / 2 + (high - low) / 2 * x
    load = a**3 - a * np.sqrt(6 * a)
    slope = 2 * a - np.sqrt(6 / a) / 3
    # Tension from D = 0 back to snap-off, which ends at zero load.
    area = -float(np.sum(weight * load * slope) * (high - low) / 2)
    return math.pi * (math.pi * 3 / 4) ** (2 / 3) * area


def formula(tabor, h0):
    """Return the loss over (R^4 w^5/E*^2)^(1/3) with a jump into contact at h0 [z0]."""
    return jkr() - 4 * math.pi / 3 * h0 / tabor


def _loss(tabor):
    """Return the solved loss over (R^4 w^5/E*^2)^(1/3)."""
    return spheres.sphere(tabor).lost / tabor


def _printed(tabor):
    return formula(tabor, wu_2010.jump(tabor)[1][0])


def _solved(tabor):
    return formula(tabor, spheres.sphere(tabor).jump_in[0])


def numbers(_):
    def error(found, tabor):
        return 100 * abs(found(tabor) / _loss(tabor) - 1)

    return {"jkr": jkr(), "cusp": greenwood_1997.cusp(),
            **{name: _loss(tabor) / jkr() for name, tabor in
               (("one", 1.0), ("ten", 10.0), ("hundred", 100.0))},
            "formula_one": error(_solved, 10.0), "formula_two": error(_solved, 100.0),
            "closed": error(_printed, 10.0), "closed_two": error(_printed, 100.0)}


def draw(_):
    page, panel = style.figure(height=3.8)
    for found, look, name in ((_loss, {"color": style.BLACK}, "solved"),
                              (_solved, {"color": style.BLUE, "dashes": (5, 1.5)},
                               "formula, $h_0$ of the jump solved"),
                              (_printed, {"color": style.VERMILION, "dashes": (2, 1.5)},
                               "formula, $h_0$ by (37)")):
        panel.semilogx(_MANY, [found(tabor) / jkr() for tabor in _MANY], label=name, **look)
    panel.axhline(1, color=style.GREY, linewidth=0.8, dashes=(5, 2))
    style.word(panel, 0.75, 0.985, "JKR theory")
    style.label(panel, "Tabor's parameter $\\mu$", "energy lost / that of JKR theory", "y",
                ylim=(-0.05, 1.05))
    panel.legend(loc="lower right")
    return page


def rows(_):
    return [Comparison(f"mu = {tabor:g}, energy lost", kind, theirs(tabor), _loss(tabor),
                       "(R^4 w^5/E*^2)^(1/3)", source)
            for tabor in TABORS
            for kind, theirs, source in (
                ("theory", lambda _: jkr(), "JKR theory at fixed displacement, mu to infinity"),
                ("formula", _solved, "7.0922 - (4 pi/3) h0/(mu z0), h0 of the jump solved"),
                ("formula", _printed, "the same with h0 by Attard and Parker's (37)"))]
