"""The solved contact law of two elastic spheres under a force of finite range, on arrays.

`ContactLaw` is the law of `contact_law/snapin_contact.h` with the same coefficients, which
contact_law.json has; tools/contact_law.py makes both out of a deck. docs/tables.md explains the
law, and tools/law/tables.py its coordinates. Inside, gaps are in z0, contact radii in sqrt(R z0),
loads in pi w R, and energies in pi w R z0.
"""

import functools
import json
import pathlib
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev, polynomial

from .arguments import flags, positive, vector

# JKR theory's units of h0 and contact radius, with K = 4 E*/3: (pi^2 w^2 R/K^2)^(1/3) is GAP mu z0,
# and (pi w R^2/K)^(1/3) is SPREAD sigma^(1/3) sqrt(R z0), sigma = mu^(3/2)/2.
_GAP = (9*np.pi**2/16)**(1/3)
_SPREAD = (1.5*np.pi)**(1/3)
_ROOT6 = np.sqrt(6)
_DEEP_PANELS = 8
# JKR theory over the root q of the contact radius: displacement, load and their integral.
_JKR_GAP = np.array([0, -2*_ROOT6/3, 0, 0, 1])
_JKR_LOAD = np.array([0, 0, 0, -_ROOT6, 0, 0, 1])
_JKR_ENERGY = polynomial.polyint(polynomial.polymul(_JKR_LOAD, polynomial.polyder(_JKR_GAP)))


@functools.cache
def coefficients():
    """Return the coefficients of the Lennard-Jones law 9-3: nested lists of whole numbers."""
    return json.loads(pathlib.Path(__file__).with_name("contact_law.json").read_text())


class _Place(NamedTuple):
    """A place on the path: its panel and xi there, and h0 in z0."""

    panel: int
    xi: float
    gap: float


class _Panel(NamedTuple):
    """Polynomials of xi from -1 (far) to 1 (near); `outside`: no contact; `squared`: radius^2."""

    gap: np.ndarray
    load: np.ndarray
    radius: np.ndarray
    energy: np.ndarray
    outside: bool
    squared: bool


class ContactLaw:
    """Load, contact radius, stiffness and energy of two spheres over h0, the gap that they would
    have without deformation, in SI units.

    radius is R, 1/R = 1/R1 + 1/R2; reduced_modulus is E*, 1/E* = (1-nu1^2)/E1 + (1-nu2^2)/E2;
    z0 is the length of the force law, for the law 9-3 the gap of zero force. `table` has the
    coefficients of another force, as tools/contact_law.py --deck writes them.

    `load`, `contact_radius`, `stiffness` and `energy` take h0 and whether the bodies were in
    contact before, for all h0 or for each, and return arrays. Where the bodies cannot be in this
    state they have jumped to the other; `in_contact` tells. `history` follows a sequence of h0.
    """

    def __init__(self, radius, reduced_modulus, work_of_adhesion, z0, *, table=None):
        radius, modulus = positive("radius", radius), positive("reduced_modulus", reduced_modulus)
        work, z0 = positive("work_of_adhesion", work_of_adhesion), positive("z0", z0)
        self._table = coefficients() if table is None else table
        self.radius, self.reduced_modulus = radius, modulus
        self.work_of_adhesion, self.z0 = work, z0
        log_mu = (np.log(radius) + 2*(np.log(work) - np.log(modulus)))/3 - np.log(z0)
        self.tabor = float(np.exp(log_mu)) if abs(log_mu) < 50 else np.inf
        low, high = self._table["lowest"], self._table["highest"] or np.inf
        if not low*(1 - 1e-12) <= self.tabor <= high*(1 + 1e-12) or np.isinf(self.tabor):
            raise ValueError("Tabor's parameter is beyond the range of the law")
        self._load_unit, self._radius_unit = np.pi*work*radius, np.sqrt(radius*z0)
        self._jkr_gap = _GAP*self.tabor
        self._jkr_radius = _SPREAD*np.exp(log_mu/2)/2**(1/3)
        panels, outside, between = self._near(log_mu)
        self._find_jumps(panels)
        panels += self._deep(log_mu, panels)
        self._far(panels[0])
        self._panels = self._with_energies(panels, outside, between)
        self._divide()
        self._find_pull_off()

    # --- Numbers of the law

    @property
    def jumps(self):
        """Whether there are jumps when h0 is prescribed."""
        return self._snap_in is not None

    @property
    def pull_off(self):
        """Pull-off force [N]: the largest tension, at which a dead load separates the bodies."""
        return -self._load_unit*self._load_at(self._tension)

    @property
    def pull_off_h0(self):
        """h0 [m] of the largest tension."""
        return self.z0*self._tension.gap

    @property
    def snap_in(self):
        """h0 [m] of the jump into contact; NaN without jumps."""
        return self.z0*self._snap_in.gap if self.jumps else np.nan

    @property
    def snap_off(self):
        """h0 [m] of the jump out of contact; NaN without jumps."""
        return self.z0*self._snap_off.gap if self.jumps else np.nan

    @property
    def snap_in_load(self):
        """Load [N] just before the jump into contact."""
        return self._load_unit*self._load_at(self._snap_in) if self.jumps else np.nan

    @property
    def snap_off_load(self):
        """Load [N] just before the jump out of contact: minus the pull-off force at given h0."""
        return self._load_unit*self._load_at(self._snap_off) if self.jumps else np.nan

    @property
    def energy_lost(self):
        """Energy [J] lost in both jumps; 0 without jumps."""
        if not self.jumps:
            return 0.0
        ends = np.array([self.snap_in, self.snap_off])
        outside, contact = self.energy(ends, False), self.energy(ends, True)
        return float(outside[0] - outside[1] - contact[0] + contact[1])

    # --- Functions of h0

    def in_contact(self, h0, before=False):
        """Return whether the bodies are in contact at h0 [m] if they were or were not before."""
        gap = vector("h0", h0)/self.z0
        return self._contact(gap, flags("before", before, gap.size))

    def history(self, h0, before=False):
        """Return whether the bodies are in contact at each of a sequence of h0 [m]."""
        gap = vector("h0", h0)/self.z0
        state, found = flags("before", before, 1), np.empty(gap.shape, bool)
        for index in range(gap.size):
            state = self._contact(gap[index:index + 1], state)
            found[index] = state[0]
        return found

    def load(self, h0, in_contact=False):
        """Return the load [N]: positive under pressure."""
        far = self._far_load
        return self._load_unit*self._evaluate(
            h0, in_contact, far, lambda panel, xi: polynomial.polyval(xi, panel.load),
            lambda root: polynomial.polyval(root, _JKR_LOAD))

    def contact_radius(self, h0, in_contact=False):
        """Return the contact radius [m], 0 outside contact."""

        def inside(panel, xi):
            found = polynomial.polyval(xi, panel.radius)
            return np.sqrt(np.maximum(found, 0)) if panel.squared else found

        return self._radius_unit*self._evaluate(
            h0, in_contact, np.zeros_like, inside,
            lambda root: self._jkr_radius*root**2 + self._deep_radius)

    def stiffness(self, h0, in_contact=False):
        """Return -dF/dh0 [N/m], which goes to minus infinity at a jump."""

        def inside(panel, xi):
            with np.errstate(divide="ignore"):
                return (-polynomial.polyval(xi, polynomial.polyder(panel.load))
                        / polynomial.polyval(xi, polynomial.polyder(panel.gap)))

        return self._load_unit/self.z0*self._evaluate(
            h0, in_contact, self._far_stiffness, inside,
            lambda root: polynomial.polyval(root, polynomial.polyder(_JKR_LOAD))
            / (self._jkr_gap*polynomial.polyval(root, polynomial.polyder(_JKR_GAP))))

    def energy(self, h0, in_contact=False):
        """Return the energy [J] of bodies and surfaces, 0 far apart: dE/dh0 = -F."""
        return self._load_unit*self.z0*self._evaluate(
            h0, in_contact, self._far_energy,
            lambda panel, xi: polynomial.polyval(xi, panel.energy),
            lambda root: self._deep_energy + self._jkr_gap*polynomial.polyval(root, _JKR_ENERGY))

    def _contact(self, gap, before):
        """Return whether bodies are in contact, for arrays in z0."""
        if not self.jumps:
            return before
        # A snap-off that was converted to metres and back is not beyond itself.
        return np.where(before, gap <= self._snap_off.gap*(1 + 1e-14),
                        gap < self._snap_in.gap*(1 - 1e-14))

    def _evaluate(self, h0, in_contact, far, inside, deep):
        """Return a function of h0: beyond the panels' first, on them, and beyond their last."""
        gap = vector("h0", h0)/self.z0
        contact = self._contact(gap, flags("in_contact", in_contact, gap.size))
        found = np.full(gap.shape, np.nan)
        for state in (False, True):
            rest = contact == state
            if not (state and self.jumps):
                beyond = rest & (gap > self._far_gap)
                found[beyond] = far(gap[beyond])
                rest &= ~beyond
            for panel, low, high, bottom in self._pieces[state]:
                here = rest & (gap >= bottom)
                if self.jumps and not state and panel == self._snap_in.panel:
                    # Whose end is a snap-in that may be missed by rounding.
                    here = rest
                xi = _solved(self._panels[panel].gap, gap[here], low, high)
                found[here] = inside(self._panels[panel], xi)
                rest = rest & ~here
            found[rest] = deep(self._deep_root(gap[rest]))
        return found

    # --- The path

    def _near(self, log_mu):
        """Return the panels outside contact and near it, how many are outside, and the energy
        between the two where unstable states are left out."""
        table = self._table
        log_sigma = 1.5*log_mu - np.log(2)
        held = min(log_mu, np.log(table["largest"]))
        beyond = np.exp(held - log_mu)
        for near in table["near"]:
            value = np.exp(log_sigma) if near["variable"] == "sigma" else held
            if value <= near["high"]:
                break
        local = _local(value, near["low"], near["high"])
        scale = np.exp(near["exponent"]*log_sigma)
        stretch = beyond**(-1.5*near["exponent"])
        panels = []
        edges = near["outside_edges"]
        for low, high, (gap, load) in reversed(list(zip(edges, edges[1:], near["outside"]))):
            middle, half = (low + high)/2, (low - high)/2
            deformed = _powers(_folded(gap, local), -1)
            base = _composed([near["offset"], 0, scale], middle, half)
            panels.append(_Panel(
                polynomial.polysub(base, stretch*deformed),
                stretch**-table["power"]*_powers(_folded(load, local), -1),
                np.zeros(1), None, True, False))
        edges = near["contact_edges"]
        for low, high, (gap, load) in zip(edges, edges[1:], near["contact"]):
            middle, half = (low + high)/2, (high - low)/2
            gap, load = _powers(_folded(gap, local)), _powers(_folded(load, local))
            if near["whole"]:
                spread = 1 + (0 if near["variable"] == "sigma" else self._jkr_gap)
                radius = spread*np.array([middle, half])
            else:
                gap[0] -= table["rest"]
                gap, load = beyond*gap, beyond**2*load
                gap[0] += table["rest"]
                gap = polynomial.polysub(gap, self._jkr_gap*_composed(_JKR_GAP, middle, half))
                load = polynomial.polyadd(load, _composed(_JKR_LOAD, middle, half))
                radius = self._jkr_radius*_composed([0, 0, 1], middle, half)
            panels.append(_Panel(gap, load, radius, None, False, near["whole"]))
        between = 0.0
        if near["energy"]:
            between = _folded(near["energy"], local)[0]*(1 + self._jkr_gap)
        return panels, len(near["outside"]), between

    def _deep(self, log_mu, panels):
        """Return the panels of deep contact; the last one near contact is cut where they begin."""
        table = self._table
        least, largest = np.log(table["least"]), np.log(table["largest"])
        held, at = np.clip(log_mu, least, largest), max(log_mu, least)
        beyond = min(np.exp(held - log_mu), 1.0)
        deep = next(deep for deep in table["deep"]
                    if held <= deep["high"] or deep is table["deep"][-1])
        local = _local(held, deep["low"], deep["high"])
        unit = _SPREAD*np.exp(at/2)/2**(1/3)
        node = chebyshev.chebpts1(table["order"])
        start, found = _jkr_root(table["join_load"]), []
        for low in start*2.0**np.arange(_DEEP_PANELS):
            root = low*(1.5 + 0.5*node)
            length = 2*np.log(root)
            held_length = np.minimum(length, table["deep_edges"][-1])
            tile = np.searchsorted(table["deep_edges"][1:-1], held_length)
            gap, radius = np.empty(len(node)), np.empty(len(node))
            for index, (gaps, radii) in enumerate(deep["tiles"]):
                here = tile == index
                x = _local(held_length[here], *table["deep_edges"][index:index + 2])
                gap[here] = chebyshev.chebval(x, _folded(gaps, local))
                radius[here] = chebyshev.chebval(x, _folded(radii, local))
            pressure = np.log(unit/np.pi) - 1.5*at + np.log(2) + length
            gap = self._wall(pressure) + gap*beyond*np.exp(held_length - length)
            plain = unit*root**2
            radius = plain + radius*beyond
            ratio = self._jkr_radius/unit
            if ratio < 1:
                radius = np.sqrt(radius**2 - (1 - ratio**2)*plain**2)
            found.append(_Panel(
                polynomial.polysub(_powers(_series(gap)),
                                   self._jkr_gap*_composed(_JKR_GAP, 1.5*low, 0.5*low)),
                _composed(_JKR_LOAD, 1.5*low, 0.5*low), _powers(_series(radius)), None, False,
                False))
        last = panels[-1]
        end = _solved(-last.load, -table["join_load"], -1, 1)
        cut = [_composed(one, (end - 1)/2, (end + 1)/2) for one in last[:3]]
        panels[-1] = last._replace(gap=cut[0], load=cut[1], radius=cut[2])
        shift = polynomial.polyval(1, cut[0]) - polynomial.polyval(-1, found[0].gap)
        for panel in found:
            panel.gap[0] += shift
        end = start*2.0**_DEEP_PANELS
        self._deep_gap = (polynomial.polyval(1, found[-1].gap)
                          + self._jkr_gap*polynomial.polyval(end, _JKR_GAP))
        self._deep_radius = polynomial.polyval(1, found[-1].radius) - self._jkr_radius*end**2
        self._deep_end = end
        return found

    def _wall(self, pressure):
        """Return the mean gap of a wall under the pressures of Hertz, the largest by logarithm."""
        table = self._table
        low, high = table["wall_low"], table["wall_high"]
        series = np.array(table["wall"]["rows"][0])*table["wall"]["unit"]
        gap = chebyshev.chebval(_local(np.clip(pressure, low, high), low, high), series)
        rest = table["rest"]
        return np.where(pressure < low, rest + (gap - rest)*np.exp(np.minimum(pressure - low, 0)),
                        gap)

    def _deep_root(self, gap):
        """Return the root of JKR theory's contact radius beyond the last panel."""
        goal = (self._deep_gap - gap)/self._jkr_gap
        root = goal**0.25
        for _ in range(4):
            root = (goal + 2*_ROOT6/3*root)**0.25
        return root

    def _find_jumps(self, panels):
        """Find the first place on the path where h0 ceases to fall, the last where it begins to."""
        turns = []
        for index, panel in enumerate(panels):
            slope = polynomial.polyder(panel.gap)
            bend = polynomial.polyder(slope)
            for xi in _real_roots(slope):
                kind = np.sign(polynomial.polyval(xi, bend))
                turns.append((kind, _Place(index, xi, float(polynomial.polyval(xi, panel.gap)))))
        least = [place for kind, place in turns if kind > 0]
        most = [place for kind, place in turns if kind < 0]
        both = bool(least and most)
        self._snap_in, self._snap_off = (least[0], most[-1]) if both else (None, None)

    def _find_pull_off(self):
        """Find the largest tension in contact."""
        candidates = []
        for index, low, high, _ in self._pieces[True]:
            panel = self._panels[index]
            for xi in _real_roots(polynomial.polyder(panel.load), low, high):
                candidates.append(_Place(index, xi, float(polynomial.polyval(xi, panel.gap))))
        self._tension = min(candidates, key=self._load_at)

    def _load_at(self, place):
        return float(polynomial.polyval(place.xi, self._panels[place.panel].load))

    def _with_energies(self, panels, outside, between):
        """Return the panels with energies, the integrals of load times change of h0."""
        start, found = self._far_energy(self._far_gap), []
        for index, panel in enumerate(panels):
            energy = -polynomial.polyint(
                polynomial.polymul(panel.load, polynomial.polyder(panel.gap)))
            start += between if index == outside else 0
            energy[0] += start - polynomial.polyval(-1, energy)
            start = polynomial.polyval(1, energy)
            found.append(panel._replace(energy=energy))
        self._deep_energy = start - self._jkr_gap*polynomial.polyval(self._deep_end, _JKR_ENERGY)
        return found

    def _divide(self):
        """Divide the path into its stable pieces: panel, xi at both ends, h0 at the second."""
        count = len(self._panels)

        def piece(index, low=-1.0, high=1.0):
            return index, low, high, float(polynomial.polyval(high, self._panels[index].gap))

        whole = [piece(index) for index in range(count)]
        self._pieces = {False: whole, True: whole}
        if self.jumps:
            last, first = self._snap_in, self._snap_off
            self._pieces = {
                False: [*whole[:last.panel], piece(last.panel, -1.0, last.xi)],
                True: [piece(first.panel, first.xi), *whole[first.panel + 1:]]}

    # --- Beyond the first panel

    def _far(self, panel):
        """Take over h0 and load at the beginning of the path."""
        self._far_gap = float(polynomial.polyval(-1, panel.gap))
        self._far_end = float(polynomial.polyval(-1, panel.load))
        power, tail = self._table["power"], self._table["tail"]
        self._second = self._far_end*self._far_gap**power/-tail - 1 if power else 0.0

    def _far_parts(self, gap):
        """Return the load of undeformed bodies, and what deformation adds to it relatively."""
        power = self._table["power"]
        if not power:
            return self._far_end*np.exp((self._far_gap - gap)/self._table["decay"]), 0.0
        ratio = self._far_gap/gap
        return self._far_end/(1 + self._second)*ratio**power, self._second*ratio**(power + 1.5)

    def _far_load(self, gap):
        rigid, second = self._far_parts(gap)
        return rigid*(1 + second)

    def _far_stiffness(self, gap):
        rigid, second = self._far_parts(gap)
        power = self._table["power"]
        if not power:
            return rigid/self._table["decay"]
        return rigid/gap*(power + (2*power + 1.5)*second)

    def _far_energy(self, gap):
        rigid, second = self._far_parts(gap)
        power = self._table["power"]
        if not power:
            return rigid*self._table["decay"]
        return rigid*gap*(1/(power - 1) + second/(2*power + 0.5))


# --- Polynomials


def _folded(table, local):
    """Return the Chebyshev coefficients of a function at a place in a panel of parameters."""
    width = max(1, *map(len, table["rows"]))
    rows = np.array([row + [0]*(width - len(row)) for row in table["rows"]], float)
    return chebyshev.chebval(local, rows)*table["unit"]


def _local(value, low, high):
    return (2*value - low - high)/(high - low)


def _powers(series, direction=1):
    """Return coefficients of powers of xi, or of -xi."""
    return _composed(chebyshev.cheb2poly(series), 0, direction)


def _series(values):
    """Return the Chebyshev coefficients of values at the points."""
    count = len(values)
    found = chebyshev.chebvander(chebyshev.chebpts1(count), count - 1).T @ values*2/count
    found[0] /= 2
    return found


def _composed(outer, middle, half):
    """Return the coefficients of a polynomial of middle + half xi."""
    found = np.zeros(1)
    for coefficient in outer[::-1]:
        found = polynomial.polyadd(polynomial.polymul(found, [middle, half]), [coefficient])
    return found


def _real_roots(coefficients, low=-1, high=1):
    """Return the real roots between low and high, ascending."""
    # Leading coefficients of rounding errors would give roots of rounding errors.
    trimmed = polynomial.polytrim(coefficients, 1e-13*np.abs(coefficients).max())
    roots = polynomial.polyroots(trimmed)
    real = np.sort(roots[np.abs(roots.imag) < 1e-9].real)
    return real[(real >= low) & (real <= high)]


def _solved(coefficients, values, low, high):
    """Return xi at which a polynomial that falls between low and high has the values."""
    values = np.asarray(values, float)
    slope = polynomial.polyder(coefficients)
    low, high = np.full(values.shape, float(low)), np.full(values.shape, float(high))
    xi = (low + high)/2
    for _ in range(80):
        excess = polynomial.polyval(xi, coefficients) - values
        low, high = np.where(excess > 0, xi, low), np.where(excess > 0, high, xi)
        with np.errstate(divide="ignore", invalid="ignore"):
            following = xi - excess/polynomial.polyval(xi, slope)
        inside = (following >= low) & (following <= high)
        following = np.where(inside, following, (low + high)/2)
        settled = np.all(np.abs(following - xi) < 1e-13)
        xi = following
        if settled:
            break
    return xi


def _jkr_root(load):
    """Return the root of JKR theory's larger contact radius under a load."""
    return ((_ROOT6 + np.sqrt(6 + 4*load))/2)**(1/3)
