"""Claims about single weights of product integration: the integral of kernel times polynomial."""

import numpy as np
import pytest
import snapin
from support.calculus import graded_rule
from support.half_space import kernel
from test_discretisation import local_nodes


def reference(node, centre, target, left, right, columns):
    """Return the integrals of k(r, t) L_j(t) t dt, by a graded rule in distances s from the
    target."""
    at = left + (right - left) * node
    total = np.zeros(len(columns))
    points, weights = graded_rule()
    for side, near, far in (
            (1, max(left - target, 0), right - target),
            (-1, max(target - right, 0), target - left)):
        if far > near:
            # Close to the singularity.
            s = near + (far - near) * points
            x = target + side * s
            r, t = centre + target, centre + x
            weighted = (2 if r == 0 else kernel(r, t, s) * t) * weights
            for i, j in enumerate(columns):
                others = np.delete(at, j)
                lagrange = np.prod((x[:, None] - others) / (at[j] - others), axis=1)
                total[i] += (far - near) * weighted @ lagrange
    return total


PANELS = {
    "beside the edge": (1.0, -0.25, 0.0),
    "outside the edge": (1.0, 0.5, 1.5),
    "on the axis": (0.0, 0.0, 0.5),
    "as far from the axis as long": (0.0, 0.5, 1.0),
    "down to the axis": (1.0, -1.0, -0.5),
}
# Targets in panel lengths from the left end; the middle node comes besides.
TARGETS = [0.37, 0.0, 1.0, 1 - 1e-9, 1 + 1e-14, 1 + 1e-9, 1.001, 1.3, 4.0, 60.0, -1e-9, -0.02, -0.9]


@pytest.mark.parametrize("order", [2, 12])
@pytest.mark.parametrize("place", PANELS)
def test_weights_of_a_panel_have_thirteen_digits_wherever_the_target_is(place, order):
    centre, left, right = PANELS[place]
    node = local_nodes(order)
    length = right - left
    targets = [left + length * x for x in [*TARGETS, node[order // 2]]]
    targets = np.array([-centre, *(t for t in targets if centre + t > 0)])
    weights = snapin.panel_weights(node, targets, left, right, centre=centre)
    columns = sorted({0, order // 2, order - 1})
    for target, row in zip(targets, weights):
        exact = reference(node, centre, target, left, right, columns)
        assert (abs(row[columns] - exact) < 1e-13 * abs(row).max()).all(), target


@pytest.mark.parametrize("order", [2, 3, 5, 8, 12, 16, 20, 24])
def test_weights_do_not_depend_on_how_a_panel_is_cut(order):
    # Any polynomial below the order has the same integral over a panel and over two parts of it,
    # whichever rules the three distances call for.
    rng = np.random.default_rng(order)
    node = local_nodes(order)
    for _ in range(60):
        centre = rng.choice([0.0, 1.0])
        left = rng.choice([-centre, rng.uniform(-centre, 2)])
        right = left + 10 ** rng.uniform(-3, 1)
        middle = left + (right - left) * rng.uniform(0.05, 0.95)
        away = (right - left) * 10 ** rng.uniform(-15, 1.5, 20)
        target = np.concatenate([[left, middle, right], rng.uniform(left, right, 20)])
        target = np.concatenate([target, right + away, left - away])
        target = target[centre + target >= 0]
        values = rng.uniform(-1, 1, order)

        whole, first, second = (
            snapin.panel_weights(node, target, a, b, centre=centre)
            for a, b in ((left, right), (left, middle), (middle, right))
        )
        mesh = snapin.panel_mesh([0.0, 1.0], order) if order > 2 else snapin.uniform_mesh(2, 1.0)
        cut = (middle - left) / (right - left)
        parts = first @ mesh.interpolate(values, cut * node) + second @ mesh.interpolate(
            values, np.minimum(cut + (1 - cut) * node, 1.0))
        # The positions of left, middle and right carry rounding of their own.
        size = abs(whole).sum(1) * abs(values).max()
        noise = 4e-16 * (1 + abs(centre) + abs(right)) / (right - left)
        assert (abs(whole @ values - parts) <= (2e-13 + 100 * noise) * size).all()
