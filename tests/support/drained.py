"""An independent solution for bodies with a fluid between them, to hold the program against: dense,
on a mesh fixed in space. The film is one of finite volumes: through the edge of a ring flows what
the gaps inside it lose, and that is the mobility there times the difference of the pressures beside
it. Euler's implicit rule in time, with Newton's method for the gaps; runs with steps halved and
rings doubled are extrapolated.

Units: z0 for gaps, gamma/z0 for pressures, gamma R for loads. strength = 12 eta R/gamma is a time.
"""

import functools

import numpy as np
from support.abel import Mesh, lagrange
from support.series import USUAL
from support.states import pressure, slope


@functools.lru_cache(maxsize=None)
def the_mesh():
    return Mesh(0.0, 0.5, 200.0, USUAL, 2)


def interpolation(mesh, z):
    """The matrix that takes nodal values to the places z."""
    order = mesh.order
    panel = np.clip(np.searchsorted(mesh.ends, z, side="right") - 1, 0, mesh.ends.size - 2)
    u = (z - mesh.ends[panel]) / np.diff(mesh.ends)[panel]
    matrix = np.zeros((z.size, mesh.x.size))
    for row, (k, values) in enumerate(zip(panel, lagrange(u, order))):
        matrix[row, k * order:(k + 1) * order] = values
    return matrix


class Drained:
    """Bodies on their way: gaps at the nodes, and the film in so many rings of equal width in z."""

    def __init__(self, sigma, strength, start, rings):
        self.mesh = mesh = the_mesh()
        self.strength = strength
        self.shape = mesh.x**2 / 2
        self.w = 2 * sigma * mesh.operator
        width = mesh.ends[-1] / rings
        edge = width * np.arange(1, rings + 1)
        self.edge, self.speed = mesh.position(edge), mesh.growth(edge)
        area = np.diff(np.concatenate([[0], self.edge**2])) / 2
        # What flows through edges, of rates at nodes.
        self.gather = np.cumsum(area[:, None] * interpolation(mesh, edge - width / 2), axis=0)
        self.at_edge = interpolation(mesh, edge)
        # Pressures at nodes, of their drops from ring to ring: sums from without, on parabolas
        # through three rings.
        middle = edge - width / 2
        sums = np.triu(np.ones((rings, rings)))
        k = np.clip(np.round(mesh.z / width - 0.5).astype(int), 1, rings - 2)
        s = (mesh.z - middle[k]) / width
        three = np.zeros((mesh.x.size, rings))
        i = np.arange(mesh.x.size)
        three[i, k - 1], three[i, k], three[i, k + 1] = s * (s - 1) / 2, 1 - s**2, s * (s + 1) / 2
        self.drops = three @ sums * width
        # Beyond the last ring the flow goes on as the square of the position, and the gap too.
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
            if np.abs(step / gap).max() < 1e-9:
                break
        else:
            raise ArithmeticError("no step")
        self.gap = gap
        self.pressure = pressure(gap) + fluid

    @property
    def load(self):
        # With the tail of a pressure that falls as x**-4.
        last = self.mesh.x[-1]
        return 2 * np.pi * (self.mesh.area @ self.pressure + self.pressure[-1] * last**2 / 2)


def cycle(sigma, strength, start, turn, velocity, steps, rings):
    """Loads of an approach and a retreat at the ends of ten equal parts of each. Steps in the first
    part after a turn are in proportion to what has passed, in the others a part over `steps`."""
    bodies = Drained(sigma, strength, start, rings)
    part = (start - turn) / velocity / 10
    loads = []
    for begin, sign in ((start, -1), (turn, 1)):
        passed = 0.0
        first = True
        for k in range(10):
            lengths = np.full(steps, part / steps)
            if first:
                powers = np.concatenate([[0], np.geomspace(1e-4, 1, 3 * steps)])
                lengths = np.diff(powers) * part
                first = False
            for length in lengths:
                passed += length
                bodies.go(begin + sign * velocity * passed, length)
            loads.append(bodies.load)
    return np.array(loads)


def extrapolated(*case, steps=8, rings=120):
    """The loads, and about what is left of their errors."""
    a, b, c = (cycle(*case, steps * 2**k, rings) for k in range(3))
    coarse, fine = 2 * b - a, 2 * c - b
    best = fine + (fine - coarse) / 3
    in_space = (cycle(*case, steps, 2 * rings) - a) * 4 / 3
    return best + in_space, np.abs(best - fine) + np.abs(in_space) / 10
