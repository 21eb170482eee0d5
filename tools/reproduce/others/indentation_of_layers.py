"""Dimitriadis et al. (2002), Garcia and Garcia (2018): a sphere on a thin layer."""

import functools

import layers
import numpy as np
import style
from report import Comparison

CHI = (0.1, 0.2, 0.41721, 0.62011, 0.74794, 1.05444, 1.34893, 2.0)
_PROGRAM = "as the source of PyFMRheo has it (jlopezalo/PyFMRheo, models/correction_factors.py)"
_SOURCES = {"dimitriadis": f"equation (12) {_PROGRAM}", "garcia": _PROGRAM}


@functools.lru_cache(maxsize=None)
def solved(chi):
    """Return load over that on a half-space for an incompressible bonded layer."""
    return layers.over_hertz(chi, 0.5, 0)


def error(name, chi):
    return 100 * (getattr(layers, name)(chi) / solved(chi) - 1)


def good_to(name, percent):
    """Return the chi up to which a formula is within so many per cent."""
    chis = [float(each) for each in np.arange(0.02, 1.5, 0.01)]
    return next(chi for chi in chis if abs(error(name, chi)) > percent) - 0.01


def numbers(_):
    found = {}
    for name in _SOURCES:
        found[f"one_{name[0]}"] = good_to(name, 1)
        for key, chi in (("06", 0.62011), ("1", 1.0), ("2", 2.0)):
            found[name[0] + key] = error(name, chi)
    return found


def draw(_):
    page, (left, right) = style.figure(1, 2, height=3.6)
    chis = [float(each) for each in np.arange(0.05, 2.001, 0.05)]
    left.semilogy(chis, [solved(chi) for chi in chis], color=style.BLACK, label="solved")
    right.axhspan(-1, 1, color=style.GREY, alpha=0.2, linewidth=0)
    for name, label, color in (("dimitriadis", "Dimitriadis et al.", style.BLUE),
                               ("garcia", "García and García", style.VERMILION)):
        left.semilogy(chis, [getattr(layers, name)(chi) for chi in chis], color=color,
                      dashes=(5, 1.5), label=label)
        right.plot(chis, [error(name, chi) for chi in chis], color=color)
    left.set_yticks([1, 2, 5, 10, 20], ["1", "2", "5", "10", "20"])
    style.label(left, "$\\chi = \\sqrt{R\\delta}/t$", "load / load on a half-space")
    style.label(right, "$\\chi = \\sqrt{R\\delta}/t$", "error [%]", "y", ylim=(-45, 45))
    style.legend(page, 3)
    return page


def rows(_):
    return [Comparison(f"chi = {chi:g}, load over that on a half-space, nu = 0.5", "formula",
                       getattr(layers, name)(chi), solved(chi), "", source)
            for name, source in _SOURCES.items() for chi in CHI]
