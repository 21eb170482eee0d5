"""Force curves of the Lennard-Jones model with a spring, by the independent solution (`reference`),
as an instrument would measure them, with noise, outliers and a baseline. Paths are kept in a
folder, so many curves need as much time as one.
"""

import math
import pathlib
import tempfile
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from support.measured import through
from support.reference import Path

RADIUS, Z0 = 50e-9, 3e-10
KEPT = pathlib.Path(tempfile.gettempdir()) / "snapin-reference-paths"
# Points of a piece of the path.
POINTS = 600


class Truth(NamedTuple):
    """The true values of a curve, in SI units; `sigma` is the strength of adhesion."""

    sigma: float
    energy: float
    stiffness: float
    spring: float
    radius: float = RADIUS

    @property
    def load_unit(self):
        return self.energy * self.radius


def truth(sigma, softness, modulus=1e10):
    """Bodies of a strength of adhesion. softness: deflection of the spring at pull-off, over the
    length by which adhesion deforms the bodies (or the range of the force, if this is larger)."""
    stiffness = modulus * min(1.0, 5 / sigma)
    # Two equal bodies: the deck's stiffness is twice that of the contact.
    energy = sigma * stiffness * Z0**1.5 / math.sqrt(RADIUS)
    length = Z0 * max(1.0, 3.4 * sigma ** (2 / 3))
    return Truth(sigma, energy, stiffness, 1.5 * math.pi * energy * RADIUS / (softness * length))


def path_of(sigma):
    """h0 in z0 and load in gamma R along the path, from far apart into contact."""
    KEPT.mkdir(exist_ok=True)
    file = KEPT / f"{sigma:g}.npy"
    if not file.exists():
        path = Path(sigma, h0_end=-(3 + 9 * sigma ** (2 / 3)))
        at = np.cos(np.linspace(np.pi, 0, POINTS))
        rows = [np.array([chebyshev.chebval(at, piece.h0), chebyshev.chebval(at, piece.load)])
                for piece in path.pieces]
        np.save(file, np.concatenate([row[:, :-1] for row in rows], axis=1))
    return np.load(file)


class Driven:
    """Load against position of the drive, on approach and retreat, each with its jump (or none)."""

    def __init__(self, true):
        h0, load = path_of(true.sigma)
        # Beyond the path the deformation is negligible, and the force is that of rigid spheres.
        tail = h0[0] * np.geomspace(400, 1, 400)[:-1]
        h0 = np.append(tail, h0)
        load = np.append(load[0] * (h0[len(tail)] / tail) ** 2, load)
        self.z = h0 * Z0 - load * true.load_unit / true.spring
        self.load = load * true.load_unit
        ahead = np.diff(self.z) < 0
        self.turns = not ahead.all()
        self.outer = self._part(0, np.argmin(ahead) + 1 if self.turns else len(self.z))
        first = len(ahead) - np.argmin(ahead[::-1]) if self.turns else 0
        self.inner = self._part(first, len(self.z))
        self.pull_off = -self.load.min()
        # Without jumps there is at least a place of largest tension.
        self.jump_in = self.jump_out = self.z[self.load.argmin()]
        if self.turns:
            self.jump_in, self.jump_out = self.outer[0][0], self.inner[0][-1]

    def _part(self, first, last):
        return self.z[first:last][::-1], self.load[first:last][::-1]

    def force(self, z, inward):
        if not self.turns:
            return through(z, *self.outer)
        jump = self.jump_in if inward else self.jump_out
        return np.where(z > jump, through(z, *self.outer), through(z, *self.inner))


class Curve(NamedTuple):
    """z, force, segment; the noise, and which samples are outliers."""

    z: np.ndarray
    force: np.ndarray
    segment: np.ndarray
    noise: float
    outlier: np.ndarray


def measure(true, samples, noise, rng, outliers=0.0, push=0.7, baseline=0.5):
    """A curve of `samples` on each way; noise over the pull-off; outliers: their share; push: load
    at the turn over the pull-off; baseline: its length over that of the part before it."""
    driven = Driven(true)
    pulled = driven.load.argmin()
    near = np.interp(push * driven.pull_off, driven.load[pulled:], driven.z[pulled:])
    reach = max(driven.jump_out, 8 * Z0)
    far = reach + baseline * (reach - near)
    step = (far - near) / samples
    number = np.arange(samples)
    z = np.concatenate([far - step * (number + rng.random()),
                        near + step * (number + rng.random())])
    segment = np.repeat([0, 1], samples)
    force = np.concatenate([driven.force(z[:samples], True), driven.force(z[samples:], False)])
    deviation = noise * driven.pull_off
    offsets = deviation * rng.normal(0, 20, 3)
    force += offsets[segment] + offsets[2] * z / (far - near)
    force += deviation * rng.standard_normal(2 * samples)
    outlier = rng.random(2 * samples) < outliers
    off = rng.uniform(10, 40, 2 * samples) * rng.choice([-1, 1], 2 * samples)
    force += outlier * deviation * off
    return Curve(z, force, segment, deviation, outlier)
