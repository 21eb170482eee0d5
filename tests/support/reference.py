"""An independent solution of the Lennard-Jones problem, for comparison with the program.

All methods differ from those of the program: the kernel is two Abel transforms (`abel`), the
unknown is the logarithm of the gap (`states`), and the path is a chain of Chebyshev series
(`series`) in its parameter: the gap on the axis before contact, then the radius of the contact.
Folds, extrema, states at given h0 and areas are those of the series. The accuracy is known from the
joints of the series, where meshes change, and from a second resolution. Units: z0 for h0, gamma R
for loads.
"""

import functools
import math
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from support.abel import Mesh
from support.series import USUAL, stretch, trimmed
from support.states import edge_radius, jkr_radius, neck, solve

# The gap on the axis where the parameter changes.
PASSAGE = 1.1
# Radius at which meshes end: the pressure beyond changes no result by 1e-12; its load is added.
REACH = 2000.0
# Where an S-shape begins: the cusp.
CUSP = 0.29108493


class Point(NamedTuple):
    """A place on the path: its position along the path, and the quantities there."""

    place: float
    h0: float
    load: float
    axis: float

    @property
    def displacement(self):
        return self.axis - self.h0


class Branch(NamedTuple):
    """The part between two folds in h0 (or an end), and the number of unstable directions there."""

    first: Point
    last: Point
    unstable: int


class Path:
    """All equilibria from far apart to h0_end on the last branch, for one sigma."""

    def __init__(self, sigma, h0_end=-4.0, far=None, resolution=USUAL):
        self.sigma, self.h0_end = sigma, h0_end
        self.far = far or 6.0 + 6.0 * sigma ** (2 / 3)
        self.pieces = self.before_contact(resolution)
        self.in_contact(resolution)
        self.folds = self.extrema("h0")
        self.load_folds = self.extrema("load")
        self.branches = self.between_folds()

    # --- Making it

    def before_contact(self, resolution):
        """The gap on the axis from `far` to PASSAGE."""
        mesh = Mesh(0.0, 2 * resolution.scale * neck(self.sigma, 0.0), REACH, resolution, finer=2)
        begin, end = math.log(self.far - 0.9), math.log(PASSAGE - 0.9)
        state = solve(self.sigma, mesh, self.far, np.log(self.far + mesh.x**2 / 2), self.far)
        pieces = []
        cuts = np.linspace(begin, end, max(2, math.ceil(begin - end)) + 1)
        for limits in zip(cuts[:-1], cuts[1:]):
            pieces += stretch(
                self.sigma, mesh, lambda s: 0.9 + math.exp(s), limits, state, resolution)
            state = pieces[-1].last
        return pieces

    def in_contact(self, resolution):
        """c from the end of the other parameter until the last branch is past h0_end."""
        state = self.pieces[-1].last
        c, largest = edge_radius(state), jkr_radius(self.sigma, self.h0_end)
        while True:
            wide = min(3.0, max(1.05 * largest / c, 1.1))
            fine = resolution.scale * neck(self.sigma, wide * c) / (c * math.sqrt(wide))
            # While the contact is smaller than the zone, sharp features are close to the axis too.
            finer = 2 if c < 4 * neck(self.sigma, c) else 1
            reach = max(REACH / c, 50.0)
            mesh = Mesh(1.0, min(fine, resolution.scale), reach, resolution, finer)
            state = state._replace(mesh=mesh, c=c, gap=state.at(c * mesh.x))
            limits = math.log(c), math.log(c) + math.log(wide)
            self.pieces += stretch(self.sigma, mesh, math.exp, limits, state, resolution)
            state, c = self.pieces[-1].last, c * wide
            falling = self.pieces[-1].h0 @ np.arange(len(self.pieces[-1].h0)) ** 2.0 < 0
            if state.h0 < self.h0_end and falling:
                return

    # --- Reading it

    def point(self, place):
        """The quantities at a place: number of the piece + position in the piece from 0 to 1."""
        k = min(int(place), len(self.pieces) - 1)
        u = 2 * (place - k) - 1
        piece = self.pieces[k]
        values = (chebyshev.chebval(u, c) for c in (piece.h0, piece.load, piece.axis))
        return Point(place, *map(float, values))

    @property
    def beginning(self):
        return self.point(0.0)

    @property
    def ending(self):
        return self.point(float(len(self.pieces)))

    def roots(self, coefficients_of, first=0.0, last=math.inf):
        """Places between `first` and `last` where a series made of each piece is zero."""
        found = []
        for k, piece in enumerate(self.pieces):
            if k + 1 < first or k > last:
                continue
            roots = chebyshev.chebroots(trimmed(coefficients_of(piece)))
            real = roots[abs(roots.imag) < 1e-9].real
            found += [k + (float(u) + 1) / 2 for u in np.sort(real) if -1 - 1e-12 <= u < 1 + 1e-12]
        found = [min(max(place, 0.0), float(len(self.pieces))) for place in found]
        apart = [b for a, b in zip([-1.0, *found[:-1]], found) if b - a > 1e-9]
        return [place for place in apart if first - 1e-9 <= place <= last + 1e-9]

    def extrema(self, name):
        """Points where h0 or the load is extreme, in order."""
        places = self.roots(lambda piece: chebyshev.chebder(getattr(piece, name)))
        return [self.point(place) for place in places]

    def derivative(self, name, place, order):
        """A derivative by the place in the piece; it has the sign of that along the path."""
        k = min(int(place), len(self.pieces) - 1)
        series_of = chebyshev.chebder(getattr(self.pieces[k], name), order)
        return float(chebyshev.chebval(2 * (place - k) - 1, series_of))

    def between_folds(self):
        """The branches. A turn to the left in the plane of h0 and load loses stability."""
        branches, unstable, first = [], 0, self.beginning
        for fold in self.folds:
            branches.append(Branch(first, fold, unstable))
            turn = self.derivative("h0", fold.place, 2) * self.derivative("load", fold.place, 1)
            unstable += 1 if turn < 0 else -1
            first = fold
        return [*branches, Branch(first, self.ending, unstable)]

    def on(self, branch, h0):
        """The state of a branch at h0, or None."""
        low, high = sorted((branch.first.h0, branch.last.h0))
        if not low <= h0 <= high:
            return None
        places = self.roots(
            lambda piece: chebyshev.chebsub(piece.h0, [h0]), branch.first.place, branch.last.place)
        if not places:  # So close to a fold that rounding hides the distance.
            return min((branch.first, branch.last), key=lambda point: abs(point.h0 - h0))
        # A root near a fold has a second root on the other side of the fold.
        middle = (branch.first.place + branch.last.place) / 2
        return self.point(min(places, key=lambda place: abs(place - middle)))

    def work(self, first, last):
        """Int load dh0 along the path between two points."""
        total = 0.0
        for k, piece in enumerate(self.pieces):
            low, high = max(first.place, k), min(last.place, k + 1)
            if low < high:
                rate = chebyshev.chebmul(piece.load, chebyshev.chebder(piece.h0))
                whole = chebyshev.chebint(rate)
                ends = chebyshev.chebval(2 * (np.array([low, high]) - k) - 1, whole)
                total += float(ends[1] - ends[0])
        return total

    # --- Results of an experiment that controls h0

    @property
    def far_branch(self):
        return self.branches[0]

    @property
    def contact_branch(self):
        return self.branches[-1]

    @property
    def jump_in(self):
        return self.folds[0] if self.folds else None

    @property
    def jump_out(self):
        return self.folds[-1] if self.folds else None

    @property
    def energy_lost(self):
        """Area between the branches from jump in to jump out, in units of gamma R z0."""
        if not self.folds:
            return None
        # The area that the path encloses with the two jumps, at which h0 is constant.
        after_in = self.on(self.contact_branch, self.jump_in.h0)
        before_out = self.on(self.far_branch, self.jump_out.h0)
        return self.work(self.jump_out, after_in) - self.work(before_out, self.jump_in)

    @property
    def pull_off(self):
        """The point of largest tension on stable branches."""
        return min(
            (p for b in self.branches if b.unstable == 0 for p in self.swept(b.first, b.last)),
            key=lambda p: p.load)

    def swept(self, first, last):
        """Points that contain the extrema of the load from one point to another."""
        low, high = sorted((first.place, last.place))
        return [first, last, *(p for p in self.load_folds if low < p.place < high)]


@functools.lru_cache(maxsize=64)
def path(sigma, h0_end=-4.0, far=None):
    """A path at the usual resolution, cached."""
    return Path(sigma, h0_end, far)
