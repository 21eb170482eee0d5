"""Claims about single weights of product integration: the integral of kernel times polynomial."""

import functools

import mpmath
import numpy as np
import pytest
import snapin
from test_discretisation import local_nodes


@functools.cache
def kernel_times_t(r, t, distance):
    return 2 if r == 0 else 2 * t / mpmath.agm(r + t, distance)


def reference(node, centre, target, left, right, j):
    """Return the integral of k(r, t) L_j(t) t dt, by mpmath, in distances s from the target."""
    centre, target, left, right = (mpmath.mpf(float(v)) for v in (centre, target, left, right))
    at = [left + (right - left) * mpmath.mpf(float(x)) for x in node]
    below = mpmath.fprod(at[j] - x for x in at if x != at[j])
    r = centre + target

    def integrand(s, side):
        t = target + side * s
        lagrange = mpmath.fprod(t - x for x in at if x != at[j]) / below
        return lagrange * kernel_times_t(r, centre + t, s)

    total = mpmath.mpf(0)
    for side, near, far in (
            (1, max(left - target, 0), right - target),
            (-1, max(target - right, 0), target - left)):
        if far > near:
            # Close to the singularity, which the rule likes at an end or far away.
            cuts = [near + (far - near) * mpmath.mpf(10) ** -n for n in (9, 6, 4, 2, 1)]
            points = [near, *(cuts if near > 0 else cuts[-2:]), far]
            total += mpmath.quad(lambda s, side=side: integrand(s, side), points)
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
    with mpmath.workdps(18):
        for target, row in zip(targets, weights):
            for j in {0, order // 2}:
                exact = reference(node, centre, target, left, right, j)
                assert abs(row[j] - exact) < 1e-13 * abs(row).max(), target


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
