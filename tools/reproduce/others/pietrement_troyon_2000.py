"""Pietrement and Troyon (2000): contact radius and indentation under a load, in closed form."""

import numpy as np
import spheres
from others import fits

_SOURCE = "coefficients of the caption, confirmed by the theory that they fit"
_LOW = 0.1
_of_both, draw, _rows = fits.chapter("pietrement_troyon", "Pietrement and Troyon", _SOURCE)


def _fitted(lam):
    """Return errors [%] of pull-off and radius against Maugis' theory with alpha fitted to it."""
    least, rest = spheres.theory("maugis", lam)
    loads = np.linspace(-0.99999 * least, least, 200)
    curve = np.array([spheres.theory("maugis", lam, float(load))[1] for load in loads]) / rest
    alphas = np.linspace(0, 1, 2001)[:, None]
    form = ((alphas + np.sqrt(1 + loads / least)) / (1 + alphas)) ** (2 / 3)
    alpha = float(alphas[np.argmin(((form - curve) ** 2).sum(axis=1)), 0])
    pull = 0.267 * alpha**2 - 0.767 * alpha + 2
    radius = -0.451 * alpha**4 + 1.417 * alpha**3 - 1.365 * alpha**2 + 0.950 * alpha + 1.264
    return 100 * (pull / least - 1), 100 * (radius / rest - 1)


def numbers(runs):
    pull, radius = np.max([np.abs(_fitted(lam)) for lam in spheres.spaced(0.01, 100, 33)], axis=0)
    indentation = max(abs(spheres.errors("pietrement", lam)[2])
                      for lam in spheres.spaced(_LOW, 100, 31))
    # S passes through zero here.
    zero = spheres.where(lambda a: -2.160 * a**0.019 + 2.7531 * a**0.064 + 0.073 * a**1.919 > 0,
                         1e-3, 1e-2, 1e-6)
    return {**_of_both(runs), "fitted_pull": pull, "fitted_radius": radius,
            "indentation": 100 * indentation, "indentation_low": _LOW, "zero": zero,
            "zero_lambda": -0.924 * np.log(1 - 1.02 * zero)}


def rows(runs):
    """Return the rows against the theory that the formulas fit, which confirm the coefficients."""
    return [one for one in _rows(runs) if one.item.endswith("Maugis-Dugdale")]
