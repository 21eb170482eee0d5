"""Largest tension against sigma and penetration: the common part of Figs. 7 and 10."""

import curves
import numpy as np

# Letter of Fig. 10, sigma in the paper.
FIG10 = {"a": "1.7", "b": "4.4", "c": "8.7"}


def over_jkr(results):
    """Return the largest tension of each unloading over JKR's pull-off."""
    return np.ravel(results.summary["unload_max_tension"]) / results.summary["jkr_pull_off"]


def of_sweep(cases, count):
    """Return the same ratios of some cases of a sweep, a row for each of `count` unloadings."""
    return np.array([cases[f"unload_max_tension_{number}"] / cases["jkr_pull_off"]
                     for number in range(1, count + 1)])


def of_rule(runs):
    """Return the ratios of each cycle of Fig. 10 by the paper's rule: a row for each unloading,
    with all runs."""
    return {letter: np.transpose([*map(over_jkr, runs.draws(f"fig10{letter}_paper"))])
            for letter in FIG10}


def converged(runs):
    """Return the converged ratios of each cycle of Fig. 10."""
    return {letter: over_jkr(runs[f"fig10{letter}_converged"]) for letter in FIG10}


def listed(values, digits=2):
    """Return numbers as text, in the order given."""
    return ", ".join(f"{each:.{digits}f}" for each in values)


def turns(points):
    """Return turning points [m] as text [nm], in the order given."""
    return ", ".join(f"{each * 1e9:.0f}" for each in points).replace("-0", "0")


def branches(results):
    """Return the names of the unloadings; the last is from the deepest turning point."""
    return [f"unloading_{i + 1}" for i in range(np.size(results.summary["unload_from"]))]


def outermost(results):
    """Return the loading and the unloading from the deepest turning point."""
    return results.branch("loading"), results.branch(branches(results)[-1])


def jkr(results, largest_load):
    """Return displacement [m] and load [N] of JKR theory up to a load."""
    surface_energy = results.summary["surface_energy"]
    return curves.jkr_curve(curves.RADIUS, 1e10, surface_energy, largest_load)[1:]


def jkr_apart(results):
    """Return the largest difference in load from JKR theory at the same displacement, in contact,
    over the pull-off."""
    curve = results.branch(branches(results)[-1])
    theory = jkr(results, curve["load"].max())
    curve = curve[(curve["contact_radius"] > 0) & (curve["load"] < 0)]
    apart = curve["load"] - np.interp(curve["displacement"], *theory)
    return float(abs(apart).max() / results.summary["jkr_pull_off"])


def between(results):
    """Return the position of JKR theory between loading (0) and the deepest unloading (1) in
    load at the same displacement, on average from -1 to 1 nm."""
    at = np.linspace(-1e-9, 1e-9, 81)
    low, high = (curves.at(at, curve[curve["contact_radius"] > 0], "load", "displacement")
                 for curve in outermost(results))
    return float(np.mean((np.interp(at, *jkr(results, 1e-3)) - low) / (high - low)))
