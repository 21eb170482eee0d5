"""The snapin library as NumPy sees it: arrays in, arrays out, SI units.

Meant for tests and for looking at pieces by hand; calculations are run by the program on decks.
Each module here wraps one part of the library; this file gathers the names that users call.
"""

from .classical import (
    cohesive_zone,
    contact_curve,
    contact_radius,
    load_at_displacement,
    profile,
    pull_off,
)
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

__all__ = [
    "cohesive_zone",
    "contact_curve",
    "contact_radius",
    "equilibrium",
    "force_law",
    "gauss_rule",
    "kernel",
    "kernel_log_coefficient",
    "law_numbers",
    "load_at_displacement",
    "panel_mesh",
    "panel_weights",
    "profile",
    "pull_off",
    "uniform_mesh",
]
