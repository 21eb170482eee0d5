"""Greenwood (1997), Feng (2000), Muller, Yushchenko and Derjaguin (1980): spheres between Bradley's
theory and JKR's, and their S-shaped curves."""

import math

import numpy as np
import spheres
import style
from report import Comparison

TABORS = (0.01, 0.1, 0.5, 0.8, 1.0, 2.0, 5.0)
_SHOWN = (0.1, 0.5, 1.0, 2.0, 5.0)
_COLORS = (style.BLACK, style.BLUE, style.GREEN, style.ORANGE, style.VERMILION)
# Dissipation in a cycle of JKR theory at fixed displacement, in (R^4 w^5/E*^2)^(1/3), by both
# jumps.
_MULLER = 32 / (3 * math.pi) * (2 / math.pi) ** (1 / 3)


def cusp():
    """Return the Tabor parameter above which there are jumps."""
    return spheres.where(lambda tabor: spheres.sphere(tabor).jump_in is not None, 0.6, 0.8, 2e-5)


def numbers(_):
    first = cusp()
    above = spheres.sphere(first * 1.0001)
    bradley = spheres.where(lambda tabor: spheres.sphere(tabor).tension < 1.98, 0.01, 0.5, 1e-3)
    jkr = spheres.where(lambda tabor: spheres.sphere(tabor).tension < 1.515, 2, 20, 1e-3)
    return {"cusp": first, "sigma": spheres.sigma(first), "cusp_h0": above.jump_in[0],
            "lost": spheres.sphere(1.0).lost, "bradley": bradley, "jkr": jkr,
            "range": jkr / bradley, "muller": _MULLER}


def draw(_):
    page, (left, right) = style.figure(1, 2, height=3.9)
    for tabor, color in zip(_SHOWN, _COLORS):
        found = spheres.sphere(tabor)
        left.plot(-found.h0, found.load, color=color, linewidth=1,
                  linestyle=":" if found.jump_in else "-")
        for part in _stable(found):
            left.plot(*part, color=color, linewidth=1.8)
        left.plot([], [], color=color, label=f"$\\mu$ = {tabor:g}")
    style.label(left, "approach $-h_0/z_0$", "load $F/\\pi wR$", "xy", xlim=(-10, 4),
                ylim=(-2.1, 1.5))
    left.legend(loc="upper left")
    tabors = spheres.spaced(0.01, 100, 81)
    right.semilogx(tabors, [spheres.sphere(each).tension for each in tabors], color=style.BLACK)
    right.axhline(1.5, color=style.GREY, linewidth=0.8, dashes=(5, 2))
    style.word(right, 0.012, 1.51, "JKR", va="bottom")
    style.label(right, "Tabor's parameter $\\mu$", "pull-off $/\\pi wR$", ylim=(1.45, 2.05))
    other = right.twinx()
    folded = [each for each in tabors if each > cusp()]
    for way, color in (("jump_in", style.BLUE), ("jump_out", style.VERMILION)):
        other.loglog(folded, [getattr(spheres.sphere(each), way)[0] for each in folded],
                     color=color, dashes=(5, 1.5))
    other.set_ylabel("$h_0/z_0$ at jumps: in (blue), out (red)")
    other.spines["right"].set_visible(True)
    right.axvline(cusp(), color=style.GREY, linewidth=0.6)
    return page


def _stable(found):
    """Return the pieces of a path on an approach and a retract."""
    if found.jump_in is None:
        return [(-found.h0, found.load)]
    first, last = (int(np.argmin(abs(found.h0 - h0) + abs(found.load + tension)))
                   for h0, tension in (found.jump_in, found.jump_out))
    return [(-found.h0[: first + 1], found.load[: first + 1]),
            (-found.h0[last:], found.load[last:])]


def rows(_):
    bradley = "Bradley (1932), DMT (1975): rigid spheres"
    jkr = "Johnson, Kendall and Roberts (1971): mu to infinity"
    found = []
    for tabor in TABORS:
        one, name = spheres.sphere(tabor), f"mu = {tabor:g}"
        limit, why = (2.0, bradley) if tabor < 0.5 else (1.5, jkr)
        found.append(Comparison(f"{name}, pull-off", "theory", limit, one.tension, "pi w R", why))
        if one.jump_in:
            found.append(Comparison(f"{name}, tension before the jump out", "theory", 5 / 6,
                                    one.jump_out[1], "pi w R", f"{jkr}, at fixed displacement"))
    return found
