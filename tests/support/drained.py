"""An independent solution for bodies with a fluid between them, to hold the program against: dense, on a
mesh fixed in space, where the elastic operator is inverted to have the pressure from the gaps. The film
is one of finite volumes: through the edge of a ring flows the mobility there times the difference of
the pressures beside it. Euler's implicit rule in time, with Newton's method for the gaps; runs with
steps halved and rings refined are extrapolated.

Units: z0 for gaps, gamma/z0 for pressures, gamma R for loads. strength = 12 eta R/gamma is a time.
"""

import numpy as np
from support.abel import Mesh
from support.series import USUAL
from support.states import pressure, slope


class Drained:
    """Bodies on their way: gaps in the middle of rings."""

    def __init__(self, sigma, strength, start, finer):
        self.mesh = Mesh(0.0, 0.5, 200.0, USUAL, finer)
        self.strength = strength
        x = self.x = self.mesh.x
        self.shape = x**2 / 2
        # Between nodes in the coordinate in which they are even.
        self.edge = np.concatenate([[0], np.sqrt(x[1:] * x[:-1]), [x[-1]**2 / np.sqrt(x[-1] * x[-2])]])
        self.area = np.diff(self.edge**2) / 2
        w = 2 * sigma * self.mesh.operator
        self.stiff = np.linalg.inv(w)
        self.gap = start + self.shape
        for _ in range(60):
            left = self.gap - start - self.shape - w @ pressure(self.gap)
            step = np.linalg.solve(np.eye(x.size) - w * slope(self.gap), -left)
            self.gap = self.gap + step
            if np.abs(step).max() < 1e-12:
                break

    def go(self, h0, time):
        """A step to h0 in a time."""
        known, n = self.gap, self.x.size
        gap, area = known.copy(), self.area[:, None]
        over = self.edge[1:-1] / np.diff(self.x) * (time / self.strength)
        k = np.arange(n - 1)
        for _ in range(60):
            fluid = self.stiff @ (gap - h0 - self.shape) - pressure(gap)
            by_gap = self.stiff - np.diag(slope(gap))
            middle = (gap[1:] + gap[:-1]) / 2
            drop = np.diff(fluid)
            flux = middle**3 * over * drop
            change = (middle**3 * over)[:, None] * np.diff(by_gap, axis=0)
            half = 1.5 * middle**2 * over * drop
            change[k, k] += half
            change[k, k + 1] += half
            # Beyond the last ring the pressure falls as the inverse fourth power.
            out = 4 * gap[-1]**3 * time / self.strength
            flux = np.concatenate([[0], flux, [-out * fluid[-1]]])
            last = -out * by_gap[-1]
            change = np.vstack([np.zeros(n), change, last])
            left = (gap - known) * self.area - np.diff(flux)
            matrix = np.diag(self.area) - np.diff(change, axis=0)
            step = np.linalg.solve(matrix / area, -left / self.area)
            gap = gap + min(1.0, 0.3 / np.abs(step / gap).max()) * step
            if np.abs(step / gap).max() < 1e-10:
                break
        else:
            raise ArithmeticError("no step")
        self.gap = gap
        self.pressure = self.stiff @ (gap - h0 - self.shape)

    @property
    def load(self):
        # With the tail of a pressure that falls as x**-4.
        return 2 * np.pi * self.mesh.area @ self.pressure


def cycle(sigma, strength, start, turn, velocity, steps, finer):
    """Loads of an approach and a retreat at the ends of so many equal parts of each, steps being
    halved in the first part after a turn, again and again."""
    bodies = Drained(sigma, strength, start, finer)
    part = (start - turn) / velocity / 20
    loads = []
    for begin, sign in ((start, -1), (turn, 1)):
        passed = 0.0
        for k in range(20):
            lengths = np.full(steps, part / steps)
            if k == 0:
                powers = 0.5 ** np.arange(12, -1, -1)
                pieces = np.diff(np.concatenate([[0], powers * part]))
                lengths = np.repeat(pieces / max(2, steps // 4), max(2, steps // 4))
            for length in lengths:
                passed += length
                bodies.go(begin + sign * velocity * passed, length)
            loads.append(bodies.load)
    return np.array(loads)


def extrapolated(*case, steps=4, finer=2):
    """The loads, and about what is left of their errors."""
    a, b, c = (cycle(*case, steps * 2**k, finer) for k in range(3))
    coarse = 2 * b - a
    fine = 2 * c - b
    best = fine + (fine - coarse) / 3
    rings = [cycle(*case, steps, m * finer) for m in (1, 2)]
    in_space = (rings[1] - rings[0]) * 4 / 3
    return best + in_space, np.abs(best - fine) + np.abs(in_space) / 4
