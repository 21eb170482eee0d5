"""The paper's iteration on its uniform grid; what the paper gives only in words are parameters.

Units are z0, sqrt(R z0) and gamma/z0, in which sigma is the only parameter; a load is in gamma R.
The program has one of these readings: `inputs/fig10c_paper.nml`.
"""

import dataclasses
import math

import numpy as np
from misprints import elliptic

# For the iteration: below this gap [z0] a state is meaningless, and a step is shortened.
_CLOSEST = 0.25


@dataclasses.dataclass(frozen=True)
class Reading:
    """One reading of the paper's rule; lengths in nm.

    `fall` is the factor of the mixing ratio if the change of the central displacement changes its
    sign or grows by more than `growth`, `rise` the factor otherwise; `least` is the smallest ratio.
    `carried`: the ratio is kept from one h0 to the next. The iteration ends if the change is below
    `tolerance`; `unmixed`: the change before mixing; `everywhere`: at every node; or after `most`
    iterations. `passes`, if not 0, is a fixed number of iterations.
    `interpolated`: the pressure is linear between nodes, otherwise constant about them.
    """

    name: str
    spacing: float = 50.0
    step: float = 0.25
    fall: float = 0.5
    rise: float = 1.05
    growth: float = 2.0
    least: float = 1e-6
    limit: float = 0.2
    carried: bool = False
    tolerance: float = 1e-4
    unmixed: bool = False
    everywhere: bool = False
    most: int = 1000
    passes: int = 0
    interpolated: bool = True


class Scene:
    """Bodies of one sigma on a uniform grid."""

    def __init__(self, sigma, spacing, extent, interpolated):
        """`spacing` and `extent` in lateral units."""
        self.r = np.arange(0.0, extent + spacing / 2, spacing)
        self.sigma = sigma
        self.kernel = _kernel(self.r, interpolated)
        self.weights = 2 * math.pi * _ring_weights(self.r, interpolated)
        self.shape = self.r**2 / 2

    def deformed(self, pressure):
        """Return what the gap gains, -2u, under a pressure."""
        return 2 * self.sigma * (self.kernel @ pressure)


def pressure(gap):
    inverse = 1 / np.maximum(gap, _CLOSEST) ** 3
    return 8 / 3 * inverse * (inverse * inverse - 1)


def cycle(scene, reading, turns, start, end, z0):
    """Return the loading from `start` and one unloading for each turning point, to `end` or to the
    separation of the bodies; h0 in z0, `turns` decreasing, `z0` in nm.

    Each is a record array of the rows of `settle`.
    """
    step = reading.step / z0
    places = np.arange(start, turns[-1] - step / 2, -step)
    gap, memory, loading, kept = places[0] + scene.shape, [reading.limit], [], {}
    for h0 in places:
        gap, row = settle(scene, reading, gap, h0, memory, z0)
        loading.append(row)
        for turn in turns:
            if abs(h0 - turn) < step / 2:
                kept[turn] = gap, list(memory)
    branches = [_branch(loading)]
    for turn in turns:
        gap, memory = kept[turn]
        rows = []
        for h0 in np.arange(turn, end + step / 2, step):
            gap, row = settle(scene, reading, gap, h0, memory, z0)
            rows.append(row)
            if row[0] > 4 and gap[0] > 0.8 * row[0]:
                break
        branches.append(_branch(rows))
    return branches


def _branch(rows):
    return np.rec.fromrecords(rows, names="h0, load, displacement, residual, iterations, ratio")


def settle(scene, reading, gap, h0, memory, z0):
    """Iterate at an h0 according to the reading; return the gap and a row: h0 [z0], load [gamma R],
    displacement and largest residual [z0], number of iterations, and mixing ratio at the end.
    `memory` holds the mixing ratio."""
    ratio = memory[0] if reading.carried else reading.limit
    tolerance, before = reading.tolerance / z0, 0.0
    most = reading.passes or reading.most
    for iteration in range(1, most + 1):
        step = h0 + scene.shape + scene.deformed(pressure(gap)) - gap
        change = ratio * step[0]
        if iteration > 1:
            if change * before < 0 or abs(change) > reading.growth * abs(before):
                ratio = max(reading.fall * ratio, reading.least)
            else:
                ratio = min(reading.rise * ratio, reading.limit)
        before = ratio * step[0]
        # At most half of the distance to the smallest gap of the law.
        room = np.maximum(0.5 * (gap - _CLOSEST), 1e-3)
        cut = min(1.0, float(np.min(room / np.maximum(-ratio * step, room))))
        gap = gap + cut * ratio * step
        if reading.passes or iteration == 1:
            continue
        judged = abs(step).max() if reading.everywhere else abs(step[0])
        if judged * (1.0 if reading.unmixed else ratio) <= tolerance:
            break
    memory[0] = ratio
    now = pressure(gap)
    left = h0 + scene.shape + scene.deformed(now) - gap
    return gap, (h0, float(scene.weights @ now), gap[0] - h0, float(abs(left).max()), iteration,
                 ratio)


def _kernel(r, interpolated):
    """Return the matrix of int p(t) k(r, t) t dt for pressures at nodes, with k of (15).

    The pressure is linear between nodes, or constant between midpoints; the integrals are by the
    Gauss rule with points graded towards r = t, where the kernel is logarithmic.
    """
    n, spacing = r.size, r[1]
    matrix = np.zeros((n, n))
    plain, graded = _gauss(4), _graded(10)
    for panel in range(n - 1):
        for near in (True, False):
            # Rows next to the panel need the graded rule.
            rows = (np.arange(max(panel - 2, 0), min(panel + 4, n)) if near else
                    np.concatenate([np.arange(0, max(panel - 2, 0)),
                                    np.arange(min(panel + 4, n), n)]))
            if not rows.size:
                continue
            x, weight = graded if near else plain
            t = r[panel] + spacing * x
            values = _k(r[rows][:, None], t) * t * weight * spacing
            right = x if interpolated else (x > 0.5).astype(float)
            matrix[rows, panel] += values @ (1 - right)
            matrix[rows, panel + 1] += values @ right
    return matrix


def _k(r, t):
    """Return the kernel (15) with its factor 1/pi."""
    larger = np.maximum(r, t)
    return 4 / (math.pi * larger) * elliptic((np.minimum(r, t) / larger) ** 2)


def _gauss(points):
    x, weight = np.polynomial.legendre.leggauss(points)
    return (x + 1) / 2, weight / 2


def _graded(points):
    """Return a rule on (0, 1) graded towards both ends."""
    x, weight = _gauss(points)
    # The map x^2 (3 - 2 x) concentrates the points at the ends; it is applied twice.
    for _ in range(2):
        x, weight = x**2 * (3 - 2 * x), weight * 6 * x * (1 - x)
    return x, weight


def _ring_weights(r, interpolated):
    x, weight = _gauss(4)
    right = x if interpolated else (x > 0.5).astype(float)
    values = weight * r[1] * (r[:-1, None] + r[1] * x)
    result = np.zeros(r.size)
    result[:-1] += values @ (1 - right)
    result[1:] += values @ right
    return result
