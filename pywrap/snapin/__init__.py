"""The snapin library as NumPy sees it: arrays in, arrays out, SI units, errors as exceptions.

`force_curve` and `equilibrium_path` run whole calculations, as the program does on decks; the rest
is the pieces, for looking at by hand and for tests. Each module here wraps one part of the library;
this file gathers the names that users call.
"""

import os

import _snapin

from .approximations import approximation_rows, jump_estimates, slow_deformation
from .arguments import SnapinError, SnapinWarning
from .classical import (
    cohesive_zone,
    contact_curve,
    contact_radius,
    load_at_displacement,
    profile,
    pull_off,
)
from .experiment import EquilibriumPath, ForceCurve, equilibrium_path, force_curve
from .numerics import (
    equilibrium,
    force_law,
    gauss_rule,
    kernel,
    kernel_log_coefficient,
    law_numbers,
    panel_mesh,
    panel_weights,
    uniform_mesh,
)
from .scene import ForceLaw, exponential, lennard_jones

# Where there is no fork there is nothing to register.
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_snapin.snapin_flat.use_one_thread)

__all__ = [
    "EquilibriumPath",
    "ForceCurve",
    "ForceLaw",
    "SnapinError",
    "SnapinWarning",
    "approximation_rows",
    "cohesive_zone",
    "contact_curve",
    "contact_radius",
    "equilibrium",
    "equilibrium_path",
    "exponential",
    "force_curve",
    "force_law",
    "gauss_rule",
    "jump_estimates",
    "kernel",
    "kernel_log_coefficient",
    "law_numbers",
    "lennard_jones",
    "load_at_displacement",
    "panel_mesh",
    "panel_weights",
    "profile",
    "pull_off",
    "slow_deformation",
    "uniform_mesh",
]
