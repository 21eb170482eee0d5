"""An independent solution for viscoelastic bodies, for comparison with the program. It uses a dense
matrix on a mesh fixed in space, Newton's method for the logarithm of the gap, and the trapezoidal
rule for the memory.

Units: z0 for gaps, gamma/z0 for pressures, gamma R for loads. The
strength of the bodies is sigma instantaneously and sigma (1 + share) at rest, with a time of
retardation of 1.
"""

import numpy as np
from support.abel import Mesh
from support.series import USUAL
from support.states import energy, pressure, slope


class Creeping:
    """The moving bodies: gaps, pressures and memory at the nodes."""

    def __init__(self, sigma, share, start, finer=2):
        self.mesh = Mesh(0.0, 0.5, 400.0, USUAL, finer)
        self.sigma, self.share = sigma, share
        self.shape = self.mesh.x**2 / 2
        self.gap = start + self.shape
        self.solve(start, sigma * (1 + share), 0 * self.shape)
        self.memory = self.pressure = pressure(self.gap)
        self.before = self.gap

    def solve(self, h0, sigma, rise):
        """The gaps at h0 with a given rise."""
        for _ in range(40):
            left = (self.gap - h0 - self.shape - rise
                    - 2 * sigma * self.mesh.operator @ pressure(self.gap))
            softness = 2 * sigma * slope(self.gap) * self.gap
            matrix = np.diag(self.gap) - self.mesh.operator * softness
            step = np.linalg.solve(matrix, -left)
            self.gap = self.gap * np.exp(np.clip(step, -0.3, 0.3))
            # What is left is the square of the step.
            if np.abs(step).max() < 1e-6:
                return
        raise ArithmeticError("no equilibrium")

    def go(self, h0, time):
        """A step to h0 in a time."""
        q = time / 2
        left = ((1 - q) * self.memory + q * self.pressure) / (1 + q)
        part = q / (1 + q)
        rise = 2 * self.sigma * self.share * self.mesh.operator @ left
        # Begun as the gaps change from step to step.
        self.gap, self.before = self.gap**2 / self.before, self.gap
        self.solve(h0, self.sigma * (1 + self.share * part), rise)
        self.pressure = pressure(self.gap)
        self.memory = left + part * self.pressure

    @property
    def load(self):
        return 2 * np.pi * self.mesh.area @ self.pressure

    @property
    def held(self):
        """The energy stored in surfaces and bodies."""
        area = 2 * np.pi * self.mesh.area
        elastic = [area @ (p * (self.mesh.operator @ p)) for p in (self.pressure, self.memory)]
        return area @ energy(self.gap) + self.sigma * (elastic[0] + self.share * elastic[1])


def cycle(sigma, share, start, turn, velocity, steps):
    """Largest tension, energy dissipated and last load of a cycle in equal steps of h0."""
    bodies = Creeping(sigma, share, start)
    held, work, loads = bodies.held, 0.0, [bodies.load]
    way = np.linspace(start, turn, steps + 1)
    places = np.concatenate([way, way[-2::-1]])
    for before, h0 in zip(places, places[1:]):
        bodies.go(h0, abs(h0 - before) / velocity)
        work -= (loads[-1] + bodies.load) / 2 * (h0 - before)
        loads.append(bodies.load)
    loads = np.array(loads)
    before, least, after = loads[loads.argmin() - 1:loads.argmin() + 2]
    tension = (after - before) ** 2 / 8 / (before + after - 2 * least) - least
    return np.array([tension, work - (bodies.held - held), loads[-1]])
