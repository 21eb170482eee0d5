"""snapin from Python: a deck in, arrays and dictionaries out, SI units, errors as exceptions.

A first curve, and its pull-off force [N] with its error:

    import snapin
    result = snapin.run({
        "bodies": {"radius": 1.5e-2, "stiffness": 1e10},                     # m, Pa
        "force": {"law": "lennard_jones", "hamaker": 1e-20, "z0": 0.5e-9},   # J, m
        "equilibrium_path": {"h0_end": -2e-9}})                              # m
    result.summary["max_tension"], result.summary["max_tension_error"]
    result.curve["h0"], result.curve["load"]                                 # m, N

A group of a deck is a dictionary of its keys; `./run --keys GROUP` explains each, with an example.
More of it:

    snapin.run("inputs/first.nml", out="results/first")    # a deck's file; results are kept
    snapin.read_results("results/first").curve             # later
    snapin.fit(z, force, spring_constant=42.0, deck={...}, parameters=[...])   # a measured curve
    snapin.contact_law.ContactLaw(1e-6, 5e9, 0.05, 3e-10)  # the solved contact, without a run
    snapin.pull_off("jkr", radius=1e-6, stiffness=1e10, surface_energy=0.05)   # of a theory

`run` computes any deck; `force_curve` and `equilibrium_path` write the deck themselves. The other
functions are the pieces of a calculation, for a closer look and for tests. Each module here wraps
one part of the library; this file has the names that users call. `snapin.plots` draws results.
"""

import os

import _snapin

from . import contact_law
from .approximations import approximation_rows, jump_estimates, slow_deformation
from .arguments import DeckError, SnapinError, SnapinWarning
from .classical import (
    cohesive_zone, contact_curve, contact_radius, load_at_displacement, profile, pull_off)
from .curve_fit import Fit, fit
from .deck import deck_text, exponential, lennard_jones
from .experiment import EquilibriumPath, ForceCurve, equilibrium_path, force_curve, run
from .many_curves import fit_many
from .numerics import (
    equilibrium, force_law, gauss_rule, kernel, kernel_log_coefficient, law_numbers, panel_mesh,
    panel_weights, turning_intervals, uniform_mesh)
from .results import Result, read_results

#: The version of the library, which is that of the program.
__version__: str = _snapin.flat_deck.library_version().decode().rstrip()

# Systems without fork need no registration.
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_snapin.flat_deck.use_one_thread)

__all__ = [
    "DeckError", "EquilibriumPath", "Fit", "ForceCurve", "Result", "SnapinError",
    "SnapinWarning", "approximation_rows", "cohesive_zone", "contact_curve", "contact_law",
    "contact_radius", "deck_text", "equilibrium", "equilibrium_path", "exponential", "fit",
    "fit_many", "force_curve", "force_law", "gauss_rule", "jump_estimates", "kernel",
    "kernel_log_coefficient", "law_numbers", "lennard_jones", "load_at_displacement",
    "panel_mesh", "panel_weights", "profile", "pull_off", "read_results", "run",
    "slow_deformation", "turning_intervals", "uniform_mesh"]
