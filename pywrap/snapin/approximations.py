"""Slowly varying deformation: src/theory/slow_deformation.f90 and src/report/approximation_tables.f90.

(21)-(37) of the paper, SI. `radius`, `stiffness`, `rigid` and `law` are as in `force_curve`.
"""

from typing import NamedTuple

import _snapin
import numpy as np

from .arguments import accept, one_of, positive_vector, scalar, vector
from .arguments import count as whole
from .scene import law_of, scene_of, within_reach

_flat = _snapin.flat_approximations

_FORMS = ("quadrature", "closed_form", "attraction_only")
_LARGEST_COUNT = 1000000


class SlowDeformation(NamedTuple):
    """States of the approximation, SI; `slope` is the derivative of the displacement by the gap."""

    h0: np.ndarray
    displacement: np.ndarray
    slope: np.ndarray
    load: np.ndarray


class JumpState(NamedTuple):
    """The state from which approaching bodies jump, SI; `gap` is that on the axis."""

    gap: float
    h0: float
    displacement: float
    load: float


class JumpEstimates(NamedTuple):
    """Jumps by (29), by (37), and at the folds of h0 along (35b) and (35a); None: there is none."""

    criterion: JumpState
    equation_37: JumpState
    fold_attraction: JumpState
    fold: JumpState


class Row(NamedTuple):
    """A row of approximations.csv, SI; `contact_radius` is NaN."""

    theory: str
    h0: float
    displacement: float
    load: float
    contact_radius: float


def slow_deformation(gap, *, radius, stiffness=None, law, rigid=False, form="quadrature"):
    """Return the `SlowDeformation` at gaps on the axis [m].

    `form` is "quadrature", (22) and (23); "closed_form", (31) and (32) or (35a) and (36a); or
    "attraction_only", (35b) and (36b).
    """
    law = law_of(law)
    gap = (positive_vector if law.law == "lennard_jones" else vector)("gap", gap)
    within_reach("gap", gap, law)
    scene = scene_of(law, radius, stiffness, rigid)
    *values, stat, message = _flat.slow_states(*scene, one_of("form", form, _FORMS), gap)
    accept(stat, message)
    displacement, slope, load = values
    return SlowDeformation(gap - displacement, displacement, slope, load)


def jump_estimates(*, radius, stiffness=None, law, rigid=False):
    """Return the `JumpEstimates` for approaching bodies."""
    values, stat, message = _flat.slow_jumps(*scene_of(law, radius, stiffness, rigid))
    accept(stat, message)
    return JumpEstimates(
        *(None if np.isnan(jump).any() else JumpState(*map(float, jump)) for jump in values.T)
    )


def approximation_rows(
    h0_start, h0_end, *, radius, stiffness=None, law, rigid=False, count=200
):
    """Return the rows of approximations.csv over a range of h0 [m], a list of `Row`."""
    h0_start, h0_end = scalar("h0_start", h0_start), scalar("h0_end", h0_end)
    if not h0_end < h0_start:
        raise ValueError(f"h0_end: {h0_end} is not below h0_start = {h0_start}")
    scene = scene_of(law, radius, stiffness, rigid)
    within_reach("h0_start", h0_start, law)
    within_reach("h0_end", h0_end, law)
    count = whole("count", count, 2, _LARGEST_COUNT)
    theory, values, rows, stat, message = _flat.approximation_table(
        *scene, h0_start, h0_end, count, 3 * count + 4
    )
    accept(stat, message)
    names = (name.decode().strip() for name in theory[:rows])
    return [Row(name, *map(float, row)) for name, row in zip(names, values.T)]
