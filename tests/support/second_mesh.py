"""Equilibria of a deck on a mesh of its own, begun from profiles of the program.

The panels follow the steep parts of these profiles; kernel and matrix are those of `half_space`,
pressures those of the deck's law, and each state is solved by Newton's method. SI units.
"""

import math

import numpy as np
import snapin
from numpy.polynomial import chebyshev
from support.half_space import HalfSpace

# Panels of the resolutions, the finest last (two of them may be off alike beside a sharp step), and
# nodes of a panel.
PANELS = COARSE, *_ = 36, 54, 80
ORDER = 10
# Chebyshev points between two states, and how often a bracket of a fold is made narrower.
POINTS, CLOSER = chebyshev.chebpts1(9), 2
# The last coefficients of resolved series over their largest.
RESOLVED = 1e-5
# States whose gaps differ by less than this part are one, and have no fold between them.
SAME = 1e-6
NOT_FORCES = ("bodies", "shape", "equilibrium_path", "device", "loading", "numerics", "layer")


def rise(groups):
    """The height of the undeformed bodies over the radius."""
    shape, bodies = groups.get("shape", {"kind": "parabola"}), groups["bodies"]
    if shape["kind"] == "power":
        return lambda r: shape["coefficient"] * r ** shape["exponent"]
    return lambda r: r**2 / (2 * bodies["radius"])


class SecondMesh:
    """States near some given profiles (h0, r, gap)."""

    def __init__(self, groups, profiles, panels):
        self.forces = {name: keys for name, keys in groups.items() if name not in NOT_FORCES}
        self.profiles, self.rise = profiles, rise(groups)
        self.unit = profiles[0][1].max()
        ends = self.ends(panels)
        self.bodies = HalfSpace(ends / self.unit, order=ORDER)
        self.r = np.concatenate([[0.0], self.bodies.r]) * self.unit
        self.softness = 2 / groups["bodies"]["stiffness"] * self.unit
        self.area = 2 * np.pi * self.bodies.weight * self.unit**2

    @classmethod
    def twice(cls, groups, profiles, read):
        """What is read from the finest resolution, and how far the others are from it at most, of
        each number; None if Newton's method finds no state from these profiles."""
        try:
            found = [read(cls(groups, profiles, panels)) for panels in PANELS]
        except ArithmeticError:
            return None
        return [(numbers[-1], np.ptp(numbers)) for numbers in zip(*found)]

    def ends(self, panels):
        """Ends of panels between which pressures and gaps change about equally, and as the radius;
        then ever longer ones."""
        last = max(r.max() for _, r, _ in self.profiles)
        fine = np.concatenate([[0.0], np.geomspace(1e-4 * last, last, 4000)])
        fine = np.sort(np.concatenate([fine, np.linspace(0, last, 4000)[1:-1]]))
        rate = 0.0
        for _, r, gap in self.profiles:
            h = np.exp(np.interp(fine, r, np.log(gap)))
            p = self.law(h)[0]
            changes = np.diff(p) / np.ptp(p), np.diff(np.log(h)) / 4, np.diff(
                np.arcsinh(p / (1e-3 * abs(p).max()))) / 4
            rate = rate + sum(map(abs, changes))
        rate = rate + np.diff(fine) / last + np.diff(np.log(fine + 0.01 * last)) / 4
        total = np.concatenate([[0.0], np.cumsum(rate)])
        near = np.interp(np.linspace(0, total[-1], panels + 1), total, fine)
        return np.concatenate([near, last * np.geomspace(1, 300, panels // 3)[1:]])

    def law(self, gap):
        """Pressure, slope and energy at gaps."""
        return snapin.force_law(self.forces, gap)[:3]

    def begun(self, profile):
        """Gaps at the nodes from a profile; beyond it the deformation falls as 1/r."""
        h0, r, gap = profile
        deformed = np.interp(self.r, r, gap - h0 - self.rise(r))
        return h0 + self.rise(self.r) + deformed * np.minimum(1, r[-1] / np.maximum(self.r, r[-1]))

    def solved(self, gap, h0, node=None):
        """The gaps at h0; with a node, the gap there is kept and h0 is found."""
        for _ in range(60):
            pressure, slope, _ = self.law(gap[1:])
            left = gap - h0 - self.rise(self.r) - self.softness * self.bodies.matrix @ pressure
            jacobian = np.eye(len(gap))
            jacobian[:, 1:] -= self.softness * self.bodies.matrix * slope
            if node is not None:
                jacobian[:, node] = -1
            step = np.linalg.solve(jacobian, -left)
            if node is not None:
                h0 += step[node]
                step[node] = 0
            gap = np.maximum(gap + step, 0.7 * gap)
            if not np.isfinite(gap).all():
                break
            if abs(step / gap).max() < 1e-9:
                return gap, h0
        raise ArithmeticError("no state near the profile on the second mesh")

    def load(self, gap):
        """The load, without that beyond the mesh."""
        pressure = self.law(gap[1:])[0]
        return self.area @ pressure

    def load_at(self, h0):
        """The load of the first profile's state at h0, as a list."""
        return [self.load(self.solved(self.begun(self.profiles[0]), h0)[0])]

    @classmethod
    def fold(cls, groups, profiles):
        """H0 and load of the fold between two profiles, as `twice` gives them."""
        try:
            # The edge of a contact moves between the profiles; then the mesh follows the fold.
            for _ in range(CLOSER):
                profiles = cls(groups, profiles, COARSE).closer()
        except ArithmeticError:
            return None
        return cls.twice(groups, profiles, lambda one: one.between()[1:])

    def along(self):
        """States between the two profiles at Chebyshev points of the gap of the node that changes
        most: (h0, load, gap) of each, and the place of the fold, where h0 is extreme."""
        one, two = (self.solved(self.begun(profile), profile[0])[0] for profile in self.profiles)
        apart = abs(np.log(two / one))
        node = int(apart.argmax())
        if apart[node] < SAME:
            raise ArithmeticError("two states that are one on the second mesh")
        wanted = one[node] ** ((1 - POINTS) / 2) * two[node] ** ((1 + POINTS) / 2)
        states, gaps = [], [two, one]
        for value in wanted:
            # Begun as the gaps changed last, with the wanted gap at the node.
            before, last = gaps[-2:]
            rate = np.log(last / before) / math.log(last[node] / before[node])
            begun = last * np.exp(np.clip(rate * math.log(value / last[node]), -1, 1))
            gap, h0 = self.solved(begun, self.profiles[0][0], node)
            gaps.append(gap)
            states.append((h0, self.load(gap), gap))
        series = chebyshev.chebfit(POINTS, [h0 for h0, _, _ in states], len(POINTS) - 1)
        roots = chebyshev.chebroots(chebyshev.chebder(series))
        inside = roots[(abs(roots.imag) < 1e-6) & (abs(roots.real) <= 1)].real
        if not len(inside):
            raise ArithmeticError("no fold between the profiles on the second mesh")
        return states, inside[abs(inside).argmin()]

    def between(self):
        """The place of the fold, its h0 and its load, by polynomials that resolve both."""
        states, place = self.along()
        values = zip(*((h0, load) for h0, load, _ in states))
        fits = [chebyshev.chebfit(POINTS, value, len(POINTS) - 1) for value in values]
        if any(abs(fit[-2:]).max() > RESOLVED * abs(fit[1:]).max() for fit in fits):
            raise ArithmeticError("the states beside the fold are too far apart on the second mesh")
        return place, *(float(chebyshev.chebval(place, fit)) for fit in fits)

    def closer(self):
        """Profiles of the two states next to the fold, one on either side."""
        states, place = self.along()
        after = int(np.clip(np.searchsorted(POINTS, place), 1, len(POINTS) - 1))
        inside = self.r <= self.profiles[0][1][-1]
        return [(states[i][0], self.r[inside], states[i][2][inside]) for i in (after - 1, after)]
