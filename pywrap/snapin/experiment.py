"""Whole experiments, as the program runs them on decks: a force curve, the equilibrium path.

`radius` is R [m] of the gap h0 + r^2/(2R); `stiffness` is E/(1-nu^2) [Pa] of two identical bodies,
not given for `rigid` ones; `law` comes from `lennard_jones` or `exponential`; `accuracy` is the
relative one of loads and displacements. The other options are keys of &numerics in a deck.

What a result cannot vouch for is told by a `SnapinWarning`; numbers that do not exist are NaN.
A calculation holds Python's global lock until it is done: threads wait, and so does Ctrl-C.
"""

import warnings
from typing import NamedTuple

import _snapin
import numpy as np

from .arguments import SnapinWarning, accept, one_of, positive, room_for, scalar, vector
from .arguments import count as whole
from .numerics import METHODS, MOST_NODES, bytes_for
from .scene import accuracy_of, scene_of, within_reach

_flat = _snapin.flat_experiment

_METHODS = ("auto", *METHODS)
_GRIDS = ("auto", "uniform", "panels")
# The path takes steps of its own choice; the program gives up after some 5000.
_MOST_PATH_STATES = 20000


# --- Experiments


class Point(NamedTuple):
    """Where the bodies jump, or the path folds: h0 [m] and the load [N] just before."""

    h0: float
    load: float


class ForceCurve(NamedTuple):
    """A force curve, SI; arrays have one value for each h0.

    `h_centre` is the gap on the axis, `displacement` h_centre - h0, `load` negative under tension,
    `contact_radius` where the gap is 1.1 times that of zero force, `residual` the largest error of
    the equations in lengths of the force law. `jumps` are in the order of the experiment.
    `max_tension` is positive, NaN if there was no tension; the largest between the h0 too.
    `error_estimate` is the relative error of loads and displacements. `converged` says that every
    state was found.
    """

    h0: np.ndarray
    h_centre: np.ndarray
    displacement: np.ndarray
    load: np.ndarray
    contact_radius: np.ndarray
    residual: np.ndarray
    jumps: list
    max_tension: float
    max_tension_h0: float
    error_estimate: float
    converged: bool


class EquilibriumPath(NamedTuple):
    """The path from far apart to the end, SI; arrays have one value for each state on it.

    As in `ForceCurve`; `stable` (bool) is stability at controlled h0, and `folds` are all points
    at which h0 turns round: the first is the jump in, the last, if more than one, the jump out.
    """

    h0: np.ndarray
    h_centre: np.ndarray
    displacement: np.ndarray
    load: np.ndarray
    contact_radius: np.ndarray
    stable: np.ndarray
    residual: np.ndarray
    folds: list
    max_tension: float
    max_tension_h0: float
    error_estimate: float
    converged: bool


def force_curve(
    h0,
    *,
    radius,
    stiffness=None,
    law,
    rigid=False,
    method="auto",
    grid="auto",
    accuracy=1e-6,
    nodes=None,
    r_max=None,
):
    """Return the `ForceCurve` through the separations `h0` [m], in the order of the experiment.

    The bodies approach from afar to the first value; from there each state comes from the one
    before, so that where h0 turns round the curve shows hysteresis. States that did not converge
    are returned as they are, with a warning; after an early end there are NaN.

    `method` is "auto", "mixing", "anderson" or "newton", `grid` "auto", "uniform" or "panels";
    `nodes` and `r_max` [m] are for grids that are fixed in space, "uniform" or those of mixing.
    """
    h0 = vector("h0", h0).copy()
    if h0.size < 2:
        raise ValueError(f"h0: at least 2 values are needed, not {h0.size}")
    scene = scene_of(law, radius, stiffness, rigid)
    within_reach("h0", h0, law)
    nodes = 0 if nodes is None else whole("nodes", nodes, 2, MOST_NODES)
    room_for("nodes", bytes_for(nodes))
    states, jumps, count, highest, error, reached, reason, told, stat, message = _flat.force_curve(
        *scene,
        one_of("method", method, _METHODS),
        one_of("grid", grid, _GRIDS),
        accuracy_of(accuracy),
        nodes,
        0.0 if r_max is None else positive("r_max", r_max),
        h0,
    )
    accept(stat, message)
    _, h_centre, displacement, load, contact_radius, _, residual, converged = states.T
    _tell("force_curve", h0, states[:reached], reason, told)
    return ForceCurve(
        h0,
        h_centre,
        displacement,
        load,
        contact_radius,
        residual,
        _points(jumps[:count]),
        *map(float, highest),
        error,
        bool((converged == 1).all()),
    )


def equilibrium_path(
    h0_end, *, radius, stiffness=None, law, rigid=False, h0_start=None, accuracy=1e-6
):
    """Return the `EquilibriumPath` to the contact at `h0_end` [m].

    It holds the unstable states too, which no experiment at controlled h0 shows. It begins where
    the bodies hardly deform, or farther apart at `h0_start` [m].
    """
    h0_end = scalar("h0_end", h0_end)
    if h0_start is not None:
        h0_start = scalar("h0_start", h0_start)
        if h0_start <= h0_end:
            raise ValueError(f"h0_start: {h0_start} is not above h0_end = {h0_end}")
    scene = scene_of(law, radius, stiffness, rigid)
    within_reach("h0_end", h0_end, law)
    if h0_start is not None:
        within_reach("h0_start", h0_start, law)
    states, folds, count, highest, error, reached, reason, told, stat, message = (
        _flat.equilibrium_path(
            *scene,
            accuracy_of(accuracy),
            0.0 if h0_start is None else h0_start,
            h0_start is not None,
            h0_end,
            _MOST_PATH_STATES,
        )
    )
    accept(stat, message)
    states = states[:reached]
    h0, h_centre, displacement, load, contact_radius, stable, residual, converged = states.T.copy()
    _tell("equilibrium_path", h0, states, "", told)
    return EquilibriumPath(
        h0,
        h_centre,
        displacement,
        load,
        contact_radius,
        stable == 1,
        residual,
        _points(folds[:count]),
        *map(float, highest),
        error,
        bool((converged == 1).all()) and not reason.strip(),
    )


# --- What goes in and comes out


def _points(rows):
    return [Point(*map(float, row)) for row in rows]


def _tell(name, h0, states, reason, told):
    """Warn of states that did not converge, of an early end, and of what the library warns of."""
    texts = [text for text in told.decode().strip().split("\n") if text]
    *_, residual, converged = states.T
    wrong = np.flatnonzero(converged != 1)
    if wrong.size:
        texts.append(
            f"{wrong.size} of {len(states)} states did not converge, the first at "
            f"h0 = {h0[wrong[0]]:.4g} m; the largest residual is {residual[wrong].max():.2g} "
            "lengths of the force law"
        )
    if len(states) < h0.size:
        texts.append(
            f"ended early, before h0 = {h0[len(states)]:.4g} m: {reason.decode().strip()}"
        )
    for text in texts:
        warnings.warn(f"{name}: {text}", SnapinWarning, stacklevel=3)
