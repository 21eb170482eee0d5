"""Largest tension against sigma and penetration: the common part of Figs. 7 and 10."""

from typing import NamedTuple

import curves
import draws
import numpy as np

# Letter of Fig. 10, sigma in the paper.
FIG10 = {"a": "1.7", "b": "4.4", "c": "8.7"}


class Pull(NamedTuple):
    """The largest tension of one unloading over JKR's pull-off; `turn` is h0 [m] at its start."""

    sigma: float
    turn: float
    ratio: float


def of_cycle(results):
    """Return one Pull for each unloading of a deck with &unloading."""
    summary = results.summary
    return [Pull(summary["sigma"], turn, tension / summary["jkr_pull_off"])
            for turn, tension in zip(np.atleast_1d(summary["unload_from"]),
                                     np.atleast_1d(summary["unload_max_tension"]))]


def of_sweep(results, turns):
    """Return one Pull for each case and unloading of a sweep; `turns` are its turning points
    [m]."""
    columns = results.sweep
    return sorted(
        Pull(sigma, turn, tension / jkr) for number, turn in enumerate(turns, 1)
        for sigma, tension, jkr in zip(columns["sigma"], columns[f"unload_max_tension_{number}"],
                                       columns["jkr_pull_off"]))


def of_rule(runs):
    """Return, for each cycle of Fig. 10 and each unloading, the Pulls of all runs by the paper's
    rule."""
    return {letter: list(zip(*map(of_cycle, runs.draws(f"fig10{letter}_paper"))))
            for letter in FIG10}


def converged(runs):
    """Return the converged Pulls of each cycle of Fig. 10."""
    return {letter: of_cycle(runs[f"fig10{letter}_converged"]) for letter in FIG10}


def ranged(sets, digits=2):
    """Return the ranges of the ratios of some unloadings as text, in the order given."""
    return draws.several([[pull.ratio for pull in pulls] for pulls in sets], digits)


def spread(pulls):
    """Return the difference between the largest and the smallest ratio."""
    return float(np.ptp([pull.ratio for pull in pulls]))


def listed(values, digits=2):
    """Return numbers, or the ratios of Pulls, as text, in the order given."""
    return ", ".join(f"{getattr(each, 'ratio', each):.{digits}f}" for each in values)


def turns(pulls):
    """Return turning points [m], or those of Pulls, as text [nm], in the order given."""
    return ", ".join(f"{getattr(each, 'turn', each) * 1e9:.0f}" for each in pulls).replace("-0", "0")


def branches(results):
    """Return the names of the unloadings; the last is from the deepest turning point."""
    return [f"unloading_{i + 1}" for i in range(np.size(results.summary["unload_from"]))]


def jkr(results, largest_load):
    """Return displacement [m] and load [N] of JKR theory up to a load."""
    surface_energy = results.summary["surface_energy"]
    return curves.jkr_curve(curves.RADIUS, 1e10, surface_energy, largest_load)[1:]


def jkr_apart(results):
    """Return the largest difference in load from JKR theory at the same displacement, in contact,
    over the pull-off."""
    summary, curve = results.summary, results.branch(branches(results)[-1])
    inside = (curve["contact_radius"] > 0) & (curve["load"] < 0)
    displacement, load = jkr(results, curve["load"].max())
    apart = curve["load"][inside] - np.interp(curve["displacement"][inside], displacement, load)
    return float(abs(apart).max() / summary["jkr_pull_off"])


def between(results):
    """Return the position of JKR theory between loading (0) and the deepest unloading (1) in
    load at the same displacement, on average from -1 to 1 nm."""
    at = np.linspace(-1e-9, 1e-9, 81)
    low, high = (
        curves.at(at, {key: values[curve["contact_radius"] > 0] for key, values in curve.items()},
                  "load", "displacement")
        for curve in map(results.branch, ("loading", branches(results)[-1])))
    return float(np.mean((np.interp(at, *jkr(results, 1e-3)) - low) / (high - low)))
