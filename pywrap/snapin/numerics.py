"""Kernel, quadrature, force laws, meshes, and one state of equilibrium.

Kernel, quadrature and meshes have no units. Force laws are in SI. A state of equilibrium is in the
units of src/model/dimensionless_problem.f90: gaps in the law's length, lateral positions in
sqrt(R length), pressures in the law's unit, loads in that unit times R length.
"""

from dataclasses import dataclass, field
from typing import NamedTuple, Optional

import _snapin
import numpy as np
from numpy.typing import ArrayLike

from .arguments import (
    Array,
    Flags,
    as_long_as,
    ascending,
    count,
    instance,
    not_negative,
    one_of,
    positive,
    positive_vector,
    room_for,
    scalar,
    vector,
)
from .deck import Groups, accept_deck, problem_deck

_flat = _snapin.flat_numerics

METHODS = ("mixing", "anderson_mixing", "anderson", "newton")

_LARGEST_ORDER = 64
# The map of meshes without one; mapped meshes are not for users.
_UNMAPPED = (0.0, 0.0, 0.0, 1.0, 0.0)
# As in src/scene/numerics_group.f90.
_MOST_NODES = 20000
# More than the deck allows: differences of so many iterations still fit into memory.
_MOST_DEPTH = 1000


def bytes_for(nodes: int) -> int:
    """Return the memory [bytes] of a calculation on so many nodes: at most three matrices, and some
    vectors of an accelerated iteration."""
    return 8 * (3 * nodes**2 + 100 * nodes)


# --- Kernel and quadrature


def _sum_and_distance(total, distance):
    total = positive_vector("total", total)
    distance = positive_vector("distance", as_long_as("distance", distance, total.size))
    if not (distance <= total).all():
        raise ValueError("distance: |r - t| cannot be above the total r + t")
    return total, distance


def kernel(total: ArrayLike, distance: ArrayLike) -> Array:
    """Return k(r, t) for arrays of r + t and |r - t|, both positive."""
    return _flat.kernel_values(*_sum_and_distance(total, distance))[0]


def kernel_log_coefficient(total: ArrayLike, distance: ArrayLike) -> Array:
    """Return a in k(r, t) = -a ln|r - t| + smooth, for arrays of r + t and |r - t|."""
    return _flat.kernel_values(*_sum_and_distance(total, distance))[1]


class GaussRule(NamedTuple):
    """Nodes on [0, 1]; weights of f and of f(s) ln(s); barycentric weights of the nodes."""

    x: Array
    weight: Array
    log_weight: Array
    barycentric: Array


def gauss_rule(points: int) -> GaussRule:
    """Return the Gauss-Legendre rule with `points` points (src/base/quadrature.f90)."""
    return GaussRule(*_flat.gauss_rule(count("points", points, 1, _LARGEST_ORDER)))


def turning_intervals(x: ArrayLike, value: ArrayLike, slope: ArrayLike) -> Flags:
    """Return for each interval of a curve whether it may turn there (src/path/path_search.f90).

    `x` must ascend; `value` and `slope` are those of the curve at `x`.
    """
    x = ascending("x", x, 2)
    value, slope = as_long_as("value", value, x.size), as_long_as("slope", slope, x.size)
    return _flat.turning_intervals(x, value, slope) > 0


def panel_weights(node: ArrayLike, target: ArrayLike, left: float, right: float, *,
                  centre: float = 0.0) -> Array:
    """Return the integrals of k(r, t) L_j(t) t dt over the panel of offsets [left, right].

    L_j are the Lagrange polynomials on the nodes `node` of [0, 1]; r = centre + target for every
    offset in `target`. The result has shape (targets, nodes).
    """
    node = ascending("node", node, 2)
    if node[0] < 0 or node[-1] > 1 or node.size > _LARGEST_ORDER:
        raise ValueError(f"node: at most {_LARGEST_ORDER} values within [0, 1] are needed")
    centre = not_negative("centre", centre)
    target = vector("target", target)
    left, right = scalar("left", left), scalar("right", right)
    if not left < right:
        raise ValueError("right: must be above left")
    if centre + left < 0:
        raise ValueError("left: lies beyond the axis")
    if (centre + target < 0).any():
        raise ValueError("target: lies beyond the axis")
    return _flat.panel_integrals(node, centre, target, left, right).T


# --- Force laws


class LawValues(NamedTuple):
    """Pressure [Pa], its derivative by the gap [Pa/m], its integral to infinity [J/m^2]."""

    pressure: Array
    slope: Array
    energy: Array


class LawNumbers(NamedTuple):
    """SI: the law's own units and the separation at its gap 0; surface energy; separations of
    largest tension and of zero pressure, NaN if there is none, and the separation beyond which the
    repulsion vanishes."""

    length: float
    pressure_unit: float
    origin: float
    surface_energy: float
    edge_gap: float
    rest_gap: float
    range: float


def force_law(law: Groups, gap: ArrayLike) -> LawValues:
    """Return the `LawValues` at gaps [m] of a law: the groups of a deck that describe it."""
    gap = vector("gap", gap, most=np.inf)
    *values, _, stat, message = _snapin.flat_deck.law_values(problem_deck(law), gap)
    accept_deck(stat, message)
    if not np.isfinite(values).all():
        raise ValueError("gap: the law has no pressure there, or pressure, slope or energy leave "
                         "the range of float64")
    return LawValues(*values)


def law_numbers(law: Groups) -> LawNumbers:
    """Return the `LawNumbers` of a law, as in `force_law`."""
    *_, numbers, stat, message = _snapin.flat_deck.law_values(problem_deck(law), np.empty(0))
    accept_deck(stat, message)
    return LawNumbers(*map(float, numbers))


# --- Meshes


class KernelMatrix(NamedTuple):
    """Integrals of k(r, t) p(t) t dt as products with nodal values of p.

    `axis` and `centre` (nodes,) are for r on the axis and at the mesh's centre, `nodes` (nodes,
    nodes) for r at the nodes.
    """

    axis: Array
    centre: Array
    nodes: Array


@dataclass(frozen=True, eq=False)
class Mesh:
    """Nodes `x`, weights of the integral of f x dx, and the distance between nodes.

    From `uniform_mesh` or `panel_mesh`; `kind`, `centre`, `ends`, `order` describe it.
    """

    kind: str
    centre: float
    ends: Array
    order: int
    x: Array = field(init=False)
    weight: Array = field(init=False)
    spacing: float = field(init=False)

    def __post_init__(self):
        panels = one_of("kind", self.kind, ("uniform", "panels")) == "panels"
        # A read-only copy, since the mesh is made again from it.
        ends = ascending("ends", self.ends, 2).copy()
        ends.flags.writeable = False
        centre = not_negative("centre", self.centre)
        if centre + ends[0] < 0:
            raise ValueError("ends: the first lies beyond the axis")
        if not panels and (centre != 0 or ends[0] != 0 or ends.size != 2):
            raise ValueError("ends: a uniform mesh has centre 0 and ends 0 and its extent")
        name = "order" if panels else "nodes"
        limits = (3, _LARGEST_ORDER) if panels else (2, _MOST_NODES)
        order = count(name, self.order, *limits)
        if order * (ends.size - 1) > _MOST_NODES:
            raise ValueError(f"ends: these panels have more than {_MOST_NODES} nodes")
        for key, value in {"kind": str(self.kind), "centre": centre, "ends": ends}.items():
            object.__setattr__(self, key, value)
        object.__setattr__(self, "order", order)
        values = _flat.mesh_nodes(*self._description, order * (ends.size - 1))
        for key, value in zip(("x", "weight", "spacing"), values):
            if isinstance(value, np.ndarray):
                value.flags.writeable = False
            object.__setattr__(self, key, value)

    @property
    def _description(self):
        return self.kind, self.centre, self.ends, [self.order], _UNMAPPED

    def matrix(self) -> KernelMatrix:
        """Return the `KernelMatrix`, computed anew at each call."""
        room_for("mesh", bytes_for(self.x.size))
        rows = _flat.mesh_matrix(*self._description, self.x.size)
        return KernelMatrix(rows[0], rows[1], rows[2:])

    def interpolate(self, values: ArrayLike, at: ArrayLike) -> Array:
        """Return the function with the given nodal values at positions `at` on the mesh."""
        values = as_long_as("values", values, self.x.size)
        at = vector("at", at)
        if (at < self.centre + self.ends[0]).any() or (at > self.centre + self.ends[-1]).any():
            raise ValueError("at: lies outside the mesh")
        return _flat.mesh_interpolation(*self._description, values, at)


def uniform_mesh(nodes: int, extent: float) -> Mesh:
    """Return a mesh of equally spaced nodes on [0, extent], pressure linear between them."""
    return Mesh("uniform", 0.0, np.array([0.0, positive("extent", extent)]), nodes)


def panel_mesh(ends: ArrayLike, order: int, *, centre: float = 0.0) -> Mesh:
    """Return a mesh of Gauss-Legendre panels of `order` nodes each.

    `ends` are the panels' ends as offsets from `centre`, ascending, none beyond the axis.
    """
    return Mesh("panels", centre, ascending("ends", ends, 2), order)


# --- Equilibrium


class State(NamedTuple):
    """A state of the bodies, dimensionless, and its cost.

    `converged`: whether the stopping rule was met; `residual`: the largest error in the equations
    of equilibrium.
    """

    gap: Array
    pressure: Array
    axis_gap: float
    load: float
    residual: float
    converged: bool
    operator_products: int
    factorisations: int
    rejected_steps: int


def equilibrium(
    law: Groups,
    mesh: Mesh,
    h0: float,
    coupling: float,
    *,
    method: str = "anderson",
    start: Optional[ArrayLike] = None,
    scale: float = 1.0,
    tolerance: float = 1e-8,
    most_iterations: int = 60,
    depth: int = 5,
    patience: int = 8,
    mixing_limit: float = 0.2,
    displacement_tolerance: Optional[float] = None,
) -> State:
    """Return the state at a prescribed h0, iterated from the gaps `start`.

    `law` is as in `force_law`, here in its own units. `coupling` is sigma (40) for Lennard-Jones,
    Lambda (39) at h0 = 0 for the exponential law, and 0 for rigid bodies. The mesh is enlarged
    `scale` times. Without `start` the iteration begins with the undeformed gaps, none below the gap
    of zero force. `depth` is for "anderson_mixing" and "anderson", `patience` for "anderson",
    `mixing_limit` for "mixing" and "anderson_mixing", and `displacement_tolerance` for "mixing":
    with it mixing stops as in the paper, on a small change of the gap on the axis.
    """
    deck = problem_deck(law)
    method = one_of("method", method, METHODS)
    instance("mesh", mesh, Mesh, "uniform_mesh(...) or panel_mesh(...)")
    room_for("mesh", bytes_for(mesh.x.size))
    h0, scale = scalar("h0", h0), positive("scale", scale)
    if start is None:
        numbers = law_numbers(law)
        rest = (numbers.rest_gap - numbers.origin) / numbers.length
        start = np.fmax(h0 + (scale * mesh.x) ** 2 / 2, rest)
    start = as_long_as("start", start, mesh.x.size)
    if displacement_tolerance is not None and method != "mixing":
        raise ValueError("displacement_tolerance: only mixing has this stopping rule")
    gap, pressure, numbers, counts, stat, message = _flat.equilibrium_state(
        deck,
        not_negative("coupling", coupling),
        *mesh._description,
        scale,
        h0,
        start,
        method,
        positive("tolerance", tolerance),
        count("most_iterations", most_iterations, 1),
        count("depth", depth, 0, _MOST_DEPTH),
        count("patience", patience, 1),
        positive("mixing_limit", mixing_limit),
        int(displacement_tolerance is not None),
        0.0 if displacement_tolerance is None
        else not_negative("displacement_tolerance", displacement_tolerance),
    )
    accept_deck(stat, message)
    axis_gap, load, residual = map(float, numbers)
    converged, products, factorisations, rejected = map(int, counts)
    return State(gap, pressure, axis_gap, load, residual, bool(converged), products,
                 factorisations, rejected)
