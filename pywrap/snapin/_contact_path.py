"""The contact at one Tabor parameter without units: the path from far apart to any depth.

Gaps are in z0, contact radii in sqrt(R z0), loads in pi w R, and energies in pi w R z0. The path
is a list of panels (`_contact_tables`); beyond the first the bodies hardly deform, and beyond the
last the contact is that of JKR theory.
"""

from typing import NamedTuple

import numpy as np
from numpy.polynomial import polynomial

from ._contact_tables import (
    JKR_ENERGY, JKR_GAP, JKR_LOAD, ROOT6, deep_panels, jkr_units, near_panels)
from ._polynomials import real_roots, solved


class _Place(NamedTuple):
    """A place on the path: its panel and xi there, and h0."""

    panel: int
    xi: float
    gap: float


class ContactPath:
    """The states of the path over h0, in contact or outside; its jumps and its largest tension.

    `snap_in` and `snap_off` are places on the path, None without jumps; `tension` is the place of
    the largest tension. Functions have h0 and contact as arrays.
    """

    def __init__(self, table, log_mu):
        self._jkr_gap, self._jkr_radius = jkr_units(log_mu)
        self._power, self._decay = table["power"], table["decay"]
        panels, outside, between = near_panels(table, log_mu)
        self.snap_in, self.snap_off = _jumps(panels)
        deep, self._deep_end = deep_panels(table, log_mu, panels[-1])
        panels[-1:] = deep
        self._far_gap = float(polynomial.polyval(-1, panels[0].gap))
        self._far_end = float(polynomial.polyval(-1, panels[0].load))
        # What the first term of the deformation adds to the load of undeformed bodies.
        self._second = (self._far_end*self._far_gap**self._power/-table["tail"] - 1
                        if self._power else 0.0)
        self._deep_gap = (polynomial.polyval(1, panels[-1].gap)
                          + self._jkr_gap*polynomial.polyval(self._deep_end, JKR_GAP))
        self._deep_radius = (polynomial.polyval(1, panels[-1].radius)
                             - self._jkr_radius*self._deep_end**2)
        self._panels = self._with_energies(panels, outside, between)
        self._pieces = self._divided()
        self.tension = self._largest_tension()

    @property
    def jumps(self):
        """Whether there are jumps when h0 is prescribed."""
        return self.snap_in is not None

    def load_at(self, place):
        """Return the load at a place."""
        return float(polynomial.polyval(place.xi, self._panels[place.panel].load))

    def contact(self, gap, before):
        """Return whether bodies are in contact that were or were not before."""
        if not self.jumps:
            return before
        # A snap-off that was converted to metres and back is not beyond itself.
        return np.where(before, gap <= self.snap_off.gap*(1 + 1e-14),
                        gap < self.snap_in.gap*(1 - 1e-14))

    # --- Functions of h0

    def load(self, gap, before):
        """Return the load, positive under pressure."""
        return self._evaluated(
            gap, before, self._far_load, lambda panel, xi: polynomial.polyval(xi, panel.load),
            lambda root: polynomial.polyval(root, JKR_LOAD))

    def radius(self, gap, before):
        """Return the contact radius, 0 outside contact."""

        def inside(panel, xi):
            found = polynomial.polyval(xi, panel.radius)
            return np.sqrt(np.maximum(found, 0)) if panel.squared else found

        return self._evaluated(gap, before, np.zeros_like, inside,
                               lambda root: self._jkr_radius*root**2 + self._deep_radius)

    def stiffness(self, gap, before):
        """Return minus the derivative of the load, minus infinity at a jump."""

        def inside(panel, xi):
            with np.errstate(divide="ignore"):
                return (-polynomial.polyval(xi, polynomial.polyder(panel.load))
                        / polynomial.polyval(xi, polynomial.polyder(panel.gap)))

        return self._evaluated(
            gap, before, self._far_stiffness, inside,
            lambda root: polynomial.polyval(root, polynomial.polyder(JKR_LOAD))
            / (self._jkr_gap*polynomial.polyval(root, polynomial.polyder(JKR_GAP))))

    def energy(self, gap, before):
        """Return the energy of bodies and surfaces, 0 far apart."""
        return self._evaluated(
            gap, before, self._far_energy,
            lambda panel, xi: polynomial.polyval(xi, panel.energy),
            lambda root: self._deep_energy + self._jkr_gap*polynomial.polyval(root, JKR_ENERGY))

    def _evaluated(self, gap, before, far, inside, deep):
        """Return a function of h0: beyond the panels' first, on them, and beyond their last."""
        contact = self.contact(gap, before)
        found = np.full(gap.shape, np.nan)
        for state in (False, True):
            rest = contact == state
            if not (state and self.jumps):
                beyond = rest & (gap > self._far_gap)
                found[beyond] = far(gap[beyond])
                rest &= ~beyond
            for panel, low, high, bottom in self._pieces[state]:
                here = rest & (gap >= bottom)
                if self.jumps and not state and panel == self.snap_in.panel:
                    # Whose end is a snap-in that may be missed by rounding.
                    here = rest
                xi = solved(self._panels[panel].gap, gap[here], low, high)
                found[here] = inside(self._panels[panel], xi)
                rest = rest & ~here
            found[rest] = deep(self._deep_root(gap[rest]))
        return found

    # --- The path

    def _with_energies(self, panels, outside, between):
        """Return the panels with energies, the integrals of load times change of h0; `between` is
        what the states left out between the first `outside` panels and the others add."""
        start, found = self._far_energy(self._far_gap), []
        for index, panel in enumerate(panels):
            energy = -polynomial.polyint(
                polynomial.polymul(panel.load, polynomial.polyder(panel.gap)))
            start += between if index == outside else 0
            energy[0] += start - polynomial.polyval(-1, energy)
            start = polynomial.polyval(1, energy)
            found.append(panel._replace(energy=energy))
        self._deep_energy = start - self._jkr_gap*polynomial.polyval(self._deep_end, JKR_ENERGY)
        return found

    def _divided(self):
        """Return the stable pieces outside and in contact: panel, xi at both ends, h0 at the
        second."""
        def piece(index, low=-1.0, high=1.0):
            return index, low, high, float(polynomial.polyval(high, self._panels[index].gap))

        whole = [piece(index) for index in range(len(self._panels))]
        if not self.jumps:
            return {False: whole, True: whole}
        last, first = self.snap_in, self.snap_off
        return {False: [*whole[:last.panel], piece(last.panel, -1.0, last.xi)],
                True: [piece(first.panel, first.xi), *whole[first.panel + 1:]]}

    def _largest_tension(self):
        """Return the place of the largest tension in contact."""
        candidates = []
        for index, low, high, _ in self._pieces[True]:
            panel = self._panels[index]
            for xi in real_roots(polynomial.polyder(panel.load), low, high):
                candidates.append(_Place(index, xi, float(polynomial.polyval(xi, panel.gap))))
        return min(candidates, key=self.load_at)

    def _deep_root(self, gap):
        """Return the root of JKR theory's contact radius beyond the last panel."""
        goal = (self._deep_gap - gap)/self._jkr_gap
        root = goal**0.25
        for _ in range(4):
            root = (goal + 2*ROOT6/3*root)**0.25
        return root

    # --- Beyond the first panel

    def _far_parts(self, gap):
        """Return the load of undeformed bodies, and what deformation adds to it relatively."""
        if not self._power:
            return self._far_end*np.exp((self._far_gap - gap)/self._decay), 0.0
        ratio = self._far_gap/gap
        return (self._far_end/(1 + self._second)*ratio**self._power,
                self._second*ratio**(self._power + 1.5))

    def _far_load(self, gap):
        rigid, second = self._far_parts(gap)
        return rigid*(1 + second)

    def _far_stiffness(self, gap):
        rigid, second = self._far_parts(gap)
        if not self._power:
            return rigid/self._decay
        return rigid/gap*(self._power + (2*self._power + 1.5)*second)

    def _far_energy(self, gap):
        rigid, second = self._far_parts(gap)
        if not self._power:
            return rigid*self._decay
        return rigid*gap*(1/(self._power - 1) + second/(2*self._power + 0.5))


def _jumps(panels):
    """Return the first place on the path where h0 ceases to fall, and the last where it begins to;
    None for both without jumps."""
    turns, before = [], 0.0
    for index, panel in enumerate(panels):
        slope = polynomial.polyder(panel.gap)
        bend = polynomial.polyder(slope)
        first = polynomial.polyval(-1, slope)
        if before*first < 0:
            # Between two panels, whose slopes there differ by the rounding of the tables.
            turns.append((np.sign(first), _Place(index, -1.0, float(polynomial.polyval(
                -1, panel.gap)))))
        before = polynomial.polyval(1, slope)
        for xi in real_roots(slope):
            kind = np.sign(polynomial.polyval(xi, bend))
            turns.append((kind, _Place(index, xi, float(polynomial.polyval(xi, panel.gap)))))
    least = [place for kind, place in turns if kind > 0]
    most = [place for kind, place in turns if kind < 0]
    return (least[0], most[-1]) if least and most else (None, None)
