"""Largest tension against sigma and penetration: what Figs. 7 and 10 share."""

from typing import NamedTuple

import curves
import draws
import numpy as np

_RADIUS, _STIFFNESS = 1.5e-2, 1e10
FIG10 = ("a", "b", "c")


class Pull(NamedTuple):
    """The largest tension of one unloading over JKR's pull-off; `turn` is h0 [m] at its start."""

    sigma: float
    turn: float
    ratio: float


def of_cycle(results):
    """Return one Pull an unloading of a deck with &unloading."""
    summary = results.summary
    return [Pull(summary["sigma"], turn, tension / summary["jkr_pull_off"])
            for turn, tension in zip(np.atleast_1d(summary["unload_from"]),
                                     np.atleast_1d(summary["unload_max_tension"]))]


def of_sweep(results, turns):
    """Return one Pull a case and unloading of a sweep; `turns` are its turning points [m]."""
    columns = results.sweep
    found = []
    for number, turn in enumerate(turns, 1):
        tension = columns[f"unload_max_tension_{number}"]
        found += [Pull(*row) for row in zip(columns["sigma"], np.full(tension.size, turn),
                                            tension / columns["jkr_pull_off"])]
    return sorted(found)


def of_runs(runs):
    """Return, for each unloading of a deck, the Pulls of all its runs."""
    return list(zip(*(of_cycle(results) for results in runs)))


def ranged(sets, digits=2):
    """Return the ranges of the ratios of some unloadings as text, in the order given."""
    return draws.several([[pull.ratio for pull in pulls] for pulls in sets], digits)


def spread(pulls):
    """Return the difference between the largest and the smallest ratio."""
    ratios = [pull.ratio for pull in pulls]
    return max(ratios) - min(ratios)


def listed(pulls, digits=2):
    """Return the ratios as text, in the order given."""
    return ", ".join(f"{pull.ratio:.{digits}f}" for pull in pulls)


def turns(pulls):
    """Return the turning points as text [nm], in the order given."""
    return ", ".join(f"{pull.turn * 1e9:.0f}" for pull in pulls).replace("-0", "0")


def deepest(results):
    """Return the name of the last unloading, that from the deepest turning point."""
    return f"unloading_{np.atleast_1d(results.summary['unload_from']).size}"


def jkr(results, largest_load):
    """Return displacement [m] and load [N] of JKR theory up to a load."""
    surface_energy = results.summary["surface_energy"]
    return curves.jkr_curve(_RADIUS, _STIFFNESS, surface_energy, largest_load)[1:]


def jkr_apart(results):
    """Return the largest difference in load from JKR theory at the same displacement, in contact,
    over the pull-off."""
    summary, curve = results.summary, results.branch(deepest(results))
    inside = (curve["contact_radius"] > 0) & (curve["load"] < 0)
    displacement, load = jkr(results, curve["load"].max())
    apart = curve["load"][inside] - np.interp(curve["displacement"][inside], displacement, load)
    return float(abs(apart).max() / summary["jkr_pull_off"])


def between(results):
    """Return where JKR theory lies between loading (0) and the deepest unloading (1) in load at
    the same displacement, on average from -1 to 1 nm."""
    loading, retreat = results.branch("loading"), results.branch(deepest(results))
    displacement, load = jkr(results, 1e-3)
    at = np.linspace(-1e-9, 1e-9, 81)
    low, high = (_contact_load(curve, at) for curve in (loading, retreat))
    return float(np.mean((np.interp(at, displacement, load) - low) / (high - low)))


def _contact_load(curve, displacement):
    inside = curve["contact_radius"] > 0
    order = np.argsort(curve["displacement"][inside])
    return np.interp(displacement, curve["displacement"][inside][order],
                     curve["load"][inside][order])
