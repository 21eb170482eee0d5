"""One equilibrium of the Lennard-Jones problem, by Newton's method for the logarithm of the gap.

In units of z0 (gaps), sqrt(R z0) (radii), gamma/z0 (pressures) and gamma R (loads):

    H(r) = H0 + r^2/2 + 2 sigma Int P(H(t)) k(r,t) t dt,   P(H) = (8/3) (H^-9 - H^-3)

On a mesh around the axis the parameter is the gap on the axis; on a mesh around the edge of the
contact it is the radius c of the edge, where the gap is EDGE. With r = c x the operator is
multiplied by c.
"""

import math
from typing import NamedTuple

import numpy as np
from support.abel import Mesh
from support.calculus import zero

# The gap at the edge of the contact.
EDGE = 1.25

# --- The law


def pressure(gap):
    """Lennard-Jones pressure in units of gamma/z0."""
    return (8 / 3) * gap**-3 * (gap**-6 - 1)


def slope(gap):
    return 8 * gap**-4 * (1 - 3 * gap**-6)


def energy(gap):
    """The integral of the pressure from the gap to infinity."""
    return (gap**-8 - 4 * gap**-2) / 3


# --- One equilibrium


class State(NamedTuple):
    """An equilibrium: gaps at the nodes of a mesh that is scaled by c."""

    mesh: Mesh
    c: float
    gap: np.ndarray
    h0: float
    axis: float
    load: float

    def at(self, r):
        """The gap at radii r; beyond the mesh the deformation decreases as 1/r."""
        end = self.c * self.mesh.x[-1]
        deformation = self.gap - self.h0 - (self.c * self.mesh.x) ** 2 / 2
        inside = np.minimum(r, end)
        found = self.mesh.interpolate(deformation, inside / self.c)
        return self.h0 + r**2 / 2 + found * inside / r


class Lost(ArithmeticError):
    """Newton's method did not converge."""


def solve(sigma, mesh, value, log_gap, h0):
    """The equilibrium with the parameter `value`: c in contact, otherwise the gap on the axis."""
    contact = mesh.centre > 0
    c = value if contact else 1.0
    coupling, row = 2 * sigma * c, mesh.edge if contact else mesh.axis
    wanted, shape = (EDGE - c**2 / 2, (c * mesh.x) ** 2 / 2) if contact else (value, mesh.x**2 / 2)
    n = len(log_gap)
    for _ in range(60):
        gap = np.exp(log_gap)
        p = pressure(gap)
        residual = np.append(
            gap - h0 - shape - coupling * (mesh.operator @ p), wanted - h0 - coupling * (row @ p))
        change = coupling * slope(gap) * gap
        # Farther out pressures hardly change, and gaps follow from what is near.
        m = np.flatnonzero(abs(change) > 1e-10 * gap)[-1] + 1
        matrix = np.full((m + 1, m + 1), -1.0)
        matrix[:m, :m] = -mesh.operator[:m, :m] * change[:m]
        matrix[np.arange(m), np.arange(m)] += gap[:m]
        matrix[m, :m] = -row[:m] * change[:m]
        *near, shift = np.linalg.solve(matrix, -residual[[*range(m), n]])
        far = shift - residual[m:n] + mesh.operator[m:, :m] @ (change[:m] * near)
        step = np.concatenate([near, far / gap[m:], [shift]])
        largest = abs(step[:n]).max()
        if not np.isfinite(largest):
            break
        step *= min(1.0, 0.5 / largest)
        log_gap, h0 = log_gap + step[:n], h0 + step[n]
        if largest < 1e-8 and abs(step[n]) < 1e-8 * (1 + abs(h0)):
            return finished(sigma, mesh, c, np.exp(log_gap), h0)
    raise Lost(f"sigma {sigma}, parameter {value}")


def finished(sigma, mesh, c, gap, h0):
    """The state with its load, including the load beyond the mesh."""
    p = pressure(gap)
    axis = h0 + 2 * sigma * c * (mesh.axis @ p)
    end = h0 + (c * float(mesh.position(mesh.ends[-1]))) ** 2 / 2
    load = 2 * math.pi * (c**2 * (mesh.area @ p) + energy(end))
    return State(mesh, c, gap, h0, axis, load)


def neck(sigma, c):
    """The shortest length at the edge: the cohesive zone, or Hertz's edge between large bodies."""
    return min(0.375 / sigma, 0.5 * max(c, 1.0) ** (-1 / 3))


def edge_radius(state):
    """The radius at which the gap is EDGE."""
    return zero(lambda r: state.at(np.array([r]))[0] - EDGE, 1e-9, 10.0)


def jkr_radius(sigma, h0):
    """Contact radius of JKR theory at h0 (at the pull-off if this is larger)."""
    c = 1.0
    for _ in range(200):
        c = math.sqrt(max(1 - h0, 1.0) + math.sqrt(4 * math.pi * sigma * c))
    return c
