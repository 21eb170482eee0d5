"""Johnson and Greenwood (1997): the map of theories, with errors that were measured."""

import numpy as np
import spheres
import style
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patches import Patch

LAMBDAS = spheres.spaced(1e-3, 100, 31)
# Largest error with which a theory counts as valid.
_GOOD = 0.05
_THEORIES = ("bradley", "hertz", "dmt", "jkr", "maugis")
_NAMES = ("none", "Bradley", "Hertz", "DMT", "JKR", "Maugis-Dugdale")
_COLORS = ("#FFFFFF", style.GREY, style.SKY, style.ORANGE, style.GREEN, style.PURPLE)


def worst(theory, lam, load=0.0):
    """Return the larger error of contact radius and indentation; 1 for Hertz theory without a
    value; for Bradley's theory the error of h0 over z0."""
    if theory == "bradley":
        tabor = spheres.tabor_of(lam)
        h0 = 1 - spheres.contact(tabor, load).displacement * spheres.unit(tabor) ** 2
        return abs(_rigid(load) - h0)
    errors = abs(spheres.errors(theory, lam, load)[1:])
    return float(np.max(errors)) if np.isfinite(errors).all() else 1.0


def _rigid(load):
    """Return h0 [z0] of rigid bodies under a load: F = 2 pi R e(h0), by Derjaguin."""
    return spheres.where(lambda h: 2 / 3 * (h**-8 - 4 * h**-2) < load, 0.1, 1.0, 1e-12)


def simplest(lam, load):
    """Return the number of the simplest valid theory, 0 for none."""
    held = [worst(theory, lam, load) <= _GOOD for theory in _THEORIES]
    return held.index(True) + 1 if any(held) else 0


def _pull(theory, lam):
    return abs(spheres.errors(theory, lam)[0])


def numbers(_):
    at = min(LAMBDAS, key=lambda lam: abs(lam - 1))
    hertz = next(load for load in spheres.LOADS if worst("hertz", at, load) <= _GOOD)
    peak = max(LAMBDAS, key=lambda lam: _pull("maugis", lam))

    def turn(theory, low, high, error=worst):
        """Return the lambda at which a theory begins or ceases to be good without load."""
        begins = error(theory, low) > _GOOD
        return spheres.where(lambda lam: (error(theory, lam) <= _GOOD) == begins, low, high, 1e-3)

    return {"count": len(LAMBDAS) * len(spheres.LOADS), "hertz": hertz, "hertz_at": at,
            "bradley": turn("bradley", 1e-3, 1.0), "jkr": turn("jkr", 0.1, 20),
            "maugis": turn("maugis", 0.1, 20),
            "dmt_pull": turn("dmt", 0.01, 3, _pull), "jkr_pull": turn("jkr", 0.3, 30, _pull),
            "maugis_pull_low": turn("maugis", 0.01, peak, _pull),
            "maugis_pull_high": turn("maugis", peak, 30, _pull)}


def draw(_):
    page, panel = style.figure(height=4.4)
    loads = spheres.LOADS[1:]
    held = np.array([[simplest(lam, load) for lam in LAMBDAS] for load in loads])
    panel.pcolormesh(LAMBDAS, loads, held, cmap=ListedColormap(_COLORS), shading="nearest",
                     norm=BoundaryNorm(np.arange(-0.5, 6), 6), alpha=0.75)
    error = np.array([[worst("jkr", lam, load) for lam in LAMBDAS] for load in loads])
    panel.contour(LAMBDAS, loads, error, levels=[0.01], colors=["black"], linewidths=1)
    style.label(panel, "Maugis' parameter $\\lambda$", "load $F/\\pi wR$", log="xy",
                ylim=(0.07, 1500))
    page.legend(handles=[Patch(facecolor=color, edgecolor="#888888", alpha=0.75, label=name)
                         for name, color in zip(_NAMES, _COLORS)],
                loc="outside lower center", ncols=6, columnspacing=1, handlelength=1.4)
    return page
