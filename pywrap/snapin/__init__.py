"""snapin from Python: a deck in, arrays and dictionaries out, SI units, errors as exceptions.

`run` computes any deck; `force_curve` and `equilibrium_path` write the deck themselves. The other
functions are the pieces of a calculation, for a closer look and for tests. Each module here wraps
one part of the library; this file has the names that users call.
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
