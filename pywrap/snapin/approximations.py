"""Slowly varying deformation, (21)-(37) of the paper: src/theory/slow_deformation.f90.

SI; `radius`, `stiffness`, `rigid` and `law` are as in `force_curve`.
"""

from typing import NamedTuple, Optional

import _snapin
import numpy as np
from numpy.typing import ArrayLike

from .arguments import Array, one_of, vector
from .deck import Groups, accept_deck, problem_deck, scene
from .experiment import run
from .numerics import law_numbers

_FORMS = ("quadrature", "closed_form", "attraction_only")
# The names of jumps in &approximations, in the order of `JumpEstimates`.
_JUMPS = ("jump_criterion_29", "jump_equation_37", "fold_attractive_only", "fold_closed_form")


class SlowDeformation(NamedTuple):
    """States of the approximation, SI; `slope` is the derivative of the displacement by the gap."""

    h0: Array
    displacement: Array
    slope: Array
    load: Array


class JumpState(NamedTuple):
    """The state from which approaching bodies jump, SI; `gap` is the gap on the axis."""

    gap: float
    h0: float
    displacement: float
    load: float


class JumpEstimates(NamedTuple):
    """Jumps by (29), by (37), and at the folds of h0 along (35b) and (35a); None: there is none."""

    criterion: Optional[JumpState]
    equation_37: Optional[JumpState]
    fold_attraction: Optional[JumpState]
    fold: Optional[JumpState]


def slow_deformation(gap: ArrayLike, *, radius: float, stiffness: Optional[float] = None,
                     law: Groups, rigid: bool = False,
                     form: str = "quadrature") -> SlowDeformation:
    """Return the `SlowDeformation` at gaps on the axis [m].

    `form` is "quadrature", (22) and (23); "closed_form", (31) and (32) or (35a) and (36a); or
    "attraction_only", (35b) and (36b).
    """
    gap = vector("gap", gap)
    deck = problem_deck(law, radius, stiffness, rigid)
    *values, stat, message = _snapin.flat_theory.slow_states(
        deck, one_of("form", form, _FORMS), gap)
    accept_deck(stat, message)
    displacement, slope, load = values
    if not np.isfinite(values).all():
        raise ValueError("gap: the law has no pressure there, or displacement, slope or load leave "
                         "the range of float64")
    return SlowDeformation(gap - displacement, displacement, slope, load)


def jump_estimates(*, radius: float, stiffness: Optional[float] = None, law: Groups,
                   rigid: bool = False) -> JumpEstimates:
    """Return the `JumpEstimates` for approaching bodies."""
    # Estimates do not depend on the range of the curves.
    numbers = law_numbers(law)
    far, near = (numbers.origin + n * numbers.length for n in (2, 1))
    rows = approximation_rows(
        far, near, radius=radius, stiffness=stiffness, law=law, rigid=rigid, count=2)
    found = {row["theory"]: row for row in rows}
    return JumpEstimates(*(_jump(found[name]) if name in found else None for name in _JUMPS))


def _jump(row):
    h0, displacement, load = (float(row[key]) for key in ("h0", "displacement", "load"))
    return JumpState(h0 + displacement, h0, displacement, load)


def approximation_rows(h0_start: float, h0_end: float, *, radius: float,
                       stiffness: Optional[float] = None, law: Groups, rigid: bool = False,
                       count: int = 200) -> np.ndarray:
    """Return the table of &approximations over a range of h0 [m]."""
    group = {"h0_start": h0_start, "h0_end": h0_end, "count": count}
    return run(scene(law, radius, stiffness, rigid, approximations=group)).approximations
