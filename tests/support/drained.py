"""An independent solution for bodies with a fluid between them, for comparison with the program. It
uses a dense matrix on a mesh fixed in space. The film is computed by finite volumes: the flow
through the edge of a ring is the volume that the gaps inside this edge lose, and is equal to the
mobility times the difference of the pressures on either side. The rule in time is Euler's implicit
rule, with Newton's method for the gaps. Results are extrapolated from runs with half the step and
twice the number of rings.

Units: z0 for gaps, gamma/z0 for pressures, gamma R for loads. strength = 12 eta R/gamma is a time.
"""

import functools

import numpy as np
from support.abel import Mesh
from support.series import USUAL
from support.states import pressure, slope


@functools.lru_cache(maxsize=None)
def the_mesh():
    return Mesh(0.0, 0.5, 200.0, USUAL, 2)


class Drained:
    """The moving bodies: gaps at the nodes, and the film in `rings` rings of equal width in z."""

    def __init__(self, sigma, strength, start, rings):
        self.mesh = mesh = the_mesh()
        self.strength = strength
        self.shape = mesh.x**2 / 2
        self.w = 2 * sigma * mesh.operator
        width = mesh.ends[-1] / rings
        edge = width * np.arange(1, rings + 1)
        self.edge, self.speed = mesh.position(edge), mesh.growth(edge)
        area = np.diff(np.concatenate([[0], self.edge**2])) / 2
        # Matrix from rates at nodes to flows through edges.
        self.gather = np.cumsum(area[:, None] * mesh.interpolation(edge - width / 2), axis=0)
        self.at_edge = mesh.interpolation(edge)
        # Matrix from drops of the pressure between rings to pressures at nodes: sums from outside,
        # interpolated by parabolas through three rings.
        middle = edge - width / 2
        sums = np.triu(np.ones((rings, rings)))
        k = np.clip(np.round(mesh.z / width - 0.5).astype(int), 1, rings - 2)
        s = (mesh.z - middle[k]) / width
        three = np.zeros((mesh.x.size, rings))
        i = np.arange(mesh.x.size)
        three[i, k - 1], three[i, k], three[i, k + 1] = s * (s - 1) / 2, 1 - s**2, s * (s + 1) / 2
        self.drops = three @ sums * width
        # Beyond the last ring, flow and gap are assumed to grow as the square of the position.
        self.beyond = 2 * strength / self.edge[-1]**6
        self.gap = start + self.shape
        for _ in range(60):
            left = self.gap - start - self.shape - self.w @ pressure(self.gap)
            step = np.linalg.solve(np.eye(mesh.x.size) - self.w * slope(self.gap), -left)
            self.gap = self.gap + step
            if np.abs(step).max() < 1e-12:
                break

    def go(self, h0, time):
        """A step to h0 in a time."""
        known, gap = self.gap, self.gap
        for _ in range(60):
            at_edge = self.at_edge @ (gap - self.shape) + self.edge**2 / 2
            over = self.strength * self.speed / (self.edge * at_edge**3)
            flow = self.gather @ (gap - known) / time
            fluid = -self.drops @ (over * flow) - self.beyond * flow[-1]
            by_gap = 3 * (self.drops * (over * flow / at_edge)) @ self.at_edge - (
                (self.drops * over) @ self.gather + self.beyond * self.gather[-1]) / time
            left = gap - h0 - self.shape - self.w @ (pressure(gap) + fluid)
            matrix = np.eye(gap.size) - self.w * slope(gap) - self.w @ by_gap
            step = np.linalg.solve(matrix, -left)
            gap = gap + min(1.0, 0.3 / np.abs(step / gap).max()) * step
            if np.abs(step / gap).max() < 1e-7:
                break
        else:
            raise ArithmeticError("no step")
        self.gap = gap
        self.pressure = pressure(gap) + fluid

    @property
    def load(self):
        # The last term is the tail of a pressure that decreases as x**-4.
        last = self.mesh.x[-1]
        return 2 * np.pi * (self.mesh.area @ self.pressure + self.pressure[-1] * last**2 / 2)


def cycle(sigma, strength, start, turn, velocity, steps, rings):
    """Loads of an approach and a retreat at the ends of ten equal parts of each. Steps in the first
    part after a turn are proportional to the time since the turn; the other parts have `steps`
    equal steps."""
    bodies = Drained(sigma, strength, start, rings)
    part = (start - turn) / velocity / 10
    loads = []
    for begin, sign in ((start, -1), (turn, 1)):
        passed = 0.0
        for k in range(10):
            ends = np.linspace(0, 1, steps + 1) if k else [0, *np.geomspace(1e-4, 1, 3 * steps)]
            for length in np.diff(ends) * part:
                passed += length
                bodies.go(begin + sign * velocity * passed, length)
            loads.append(bodies.load)
    return np.array(loads)


def extrapolated(*case, steps=8, rings=120):
    """The extrapolated loads, and estimates of their remaining errors."""
    a, b, c = (cycle(*case, steps * 2**k, rings) for k in range(3))
    coarse, fine = 2 * b - a, 2 * c - b
    best = fine + (fine - coarse) / 3
    in_space = (cycle(*case, steps, 2 * rings) - a) * 4 / 3
    return best + in_space, np.abs(best - fine) + np.abs(in_space) / 10
