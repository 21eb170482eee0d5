"""The contact law's tables: Chebyshev series fitted to solved states.

A path begins far outside and ends deep in contact. It is divided into parts with coordinates in
which all its functions are smooth, around the turns of h0 too:

- outside contact: the root of the gap on the axis, h_centre = offset + scale p^2;
- near contact: the contact radius, as x = (a/A)^2, A^2 = R z0 (1 + GAP mu), where the whole path is
  represented (x = 0 is the end of contact); as q = sqrt(a/a1), a1 = (pi w R^2/K)^(1/3), where the
  two stable pieces are represented, as deviations from JKR theory;
- deep contact: q = sqrt(a'/a1) of the contact radius a' of JKR theory under the load. Then h0 is
  that of JKR theory, and on it the mean gap of a wall that yields to the pressures of Hertz, and a
  deviation, which soon vanishes.

In panels of Tabor's parameter (the first begins at rigid bodies) the coefficients are Chebyshev
series too.
"""

import numpy as np
from law_states import Unsuitable, jkr, jkr_root, mu_of, path, sigma_of
from snapin._contact_tables import GAP, SPREAD

ORDER = 12           # coefficients of a function of the path on one tile
UNIT = 1e-7          # what a coefficient is rounded to
RIGID_TO = 0.03      # Tabor's parameter at which the panel of nearly rigid bodies ends
LEAST, LARGEST = 1e-4, 200.0
DEEP_TO = 1800.0     # contact radius [a1] beyond which the deviation is left out
JOIN_LOAD, END_LOAD = 0.05, 0.2   # where deep contact begins, and where tiles near contact end
LONGEST = {True: 1.0, False: 1.7}   # panels, in natural logarithms
NODES = 14           # values of Tabor's parameter in a panel
WALL = 1e-3, 1e8     # pressures [w/z0] of the wall's mean gap


def chebyshev_nodes(count):
    """Return the Chebyshev points of the first kind, ascending."""
    return -np.cos(np.pi*(np.arange(count) + 0.5)/count)


def series(values, order=None):
    """Return the Chebyshev coefficients, along the first axis, of values at the points."""
    count = len(values)
    basis = np.polynomial.chebyshev.chebvander(chebyshev_nodes(count), count - 1)
    found = np.tensordot(basis.T, values, 1)*2/count
    found[0] /= 2
    return found[:order]


def rounded(coefficients, unit=UNIT):
    """Return a table: whole multiples of a unit, rows without their last zeros."""
    whole = np.rint(np.asarray(coefficients)/unit).astype(np.int64)
    rows = [np.trim_zeros(row, "b").tolist() for row in whole]
    while len(rows) > 1 and not rows[-1]:
        rows.pop()
    return {"unit": unit, "rows": rows}


def fitted(coordinate, edges, functions):
    """Return the coefficients of functions on each tile between edges, from scattered states."""
    tiles = []
    for low, high in zip(edges[:-1], edges[1:]):
        local = (2*coordinate - low - high)/(high - low)
        near = np.abs(local) <= 1.02
        if near.sum() < 2*ORDER:
            raise Unsuitable(f"only {near.sum()} states in a tile")
        basis = np.polynomial.chebyshev.chebvander(local[near], ORDER - 1)
        # Crowded states count less.
        weight = np.sqrt(np.gradient(np.sort(local[near]))[np.argsort(np.argsort(local[near]))])
        weight = np.maximum(weight, 1e-4)[:, None]
        values = np.stack([function[near] for function in functions], axis=1)
        found, *_ = np.linalg.lstsq(basis*weight, values*weight, rcond=None)
        tiles.append(found)
    return np.array(tiles)   # tile, coefficient, function


class Near:
    """One panel of Tabor's parameter: the path from far outside to zero load."""

    def __init__(self, force, whole, variable, low, high):
        self.force, self.whole, self.variable = force, whole, variable
        self.low, self.high = low, high
        middle = (low + high)/2 + (high - low)/2*chebyshev_nodes(NODES)
        self.mus = mu_of(middle) if variable == "sigma" else np.exp(middle)
        self.exponent = 1/(force.power + 1.5) if not whole and force.power else 0.0
        self.offset = 0.0 if self.exponent else force.contact - force.length
        self.runs = [self._run(mu) for mu in self.mus]
        self._divide()
        # The second time from the denser states of the first.
        for _ in range(2):
            self.runs = [self._run(mu, self._loads(states))
                         for mu, (states, _) in zip(self.mus, self.runs)]

    def scale(self, mu):
        return sigma_of(mu)**self.exponent

    def spread(self, mu):
        """Return the length of contact radii, in sqrt(R z0)."""
        if self.whole:
            return np.sqrt(1 + (0 if self.variable == "sigma" else GAP*mu))
        return SPREAD*sigma_of(mu)**(1/3)

    def _run(self, mu, loads=()):
        """Return the path from far outside to beyond zero load, with states under the loads."""
        reach = 26*self.scale(mu) if self.exponent else self.force.rest + 30*self.force.length
        end = -GAP*mu*jkr(jkr_root(3.5))[0] - 0.5*self.force.length + self.force.rest
        states, numbers = path(self.force, mu, 1.1*reach, end, loads)
        states["p"] = np.sqrt(np.maximum((states["centre"] - self.offset)/self.scale(mu), 0))
        local = states["radius"]/self.spread(mu)
        states["x"] = local**2 if self.whole else np.sqrt(local)
        return states, numbers

    def _divide(self):
        """Choose the edges of tiles."""
        length = self.force.length
        ends, starts, turns = [], [], []
        for states, _ in self.runs:
            bottom = np.argmin(states["load"])
            ends.append(np.interp(END_LOAD, states["load"][bottom:], states["x"][bottom:]))
            if not self.whole:
                contact = states["radius"] > 0.1*states["radius"][bottom]
                starts.append(states["x"][contact][np.argmax(states["h0"][contact])])
                fold = np.flatnonzero(np.diff(states["h0"]) > 0)[0]
                turns.append(states["p"][fold])
        if self.whole:
            self.outside = np.sqrt(length*np.array([1.0, 1.3, 1.9, 4.0, 27.0]))
            self.contact = max(ends)*np.array([0, 0.1, 0.4, 1])
        else:
            far = np.sqrt(24.0) if self.exponent else np.sqrt(27*length)
            self.outside = 0.97*min(turns)*np.array([1, 1.25, 1.9, 0])
            self.outside[-1] = far
            self.contact = np.geomspace(0.93*min(starts), max(ends), 3)

    def _loads(self, states):
        """Return loads that show the path on every tile."""
        inside = states["radius"] > 0
        x = np.append(0, states["x"][inside])
        edge = np.interp(-self.force.contact, -states["centre"], states["load"])
        return np.unique(np.concatenate([
            self._loads_at(states["load"], states["p"], self.outside),
            self._loads_at(np.append(edge, states["load"][inside]), x, self.contact)]))

    @staticmethod
    def _loads_at(load, coordinate, edges):
        """Return loads at which states are spread over tiles as Chebyshev points are."""
        order = slice(None, None, -1) if coordinate[0] > coordinate[-1] else slice(None)
        local = chebyshev_nodes(2*ORDER)/np.cos(np.pi/(4*ORDER))
        at = [(low + high)/2 + (high - low)/2*local for low, high in zip(edges[:-1], edges[1:])]
        # Far away few rows show a load that falls by orders of magnitude.
        known = np.arcsinh(load[order]*1e6)
        found = np.sinh(np.interp(np.concatenate(at), coordinate[order], known))/1e6
        return np.maximum(found, load.min()*(1 - 1e-6))

    def _energy(self, mu, outside, contact):
        """Return the energy from the end of `outside` to the beginning of `contact`, unstable
        states between them, from its tiles' coefficients there."""
        first = np.array([np.polynomial.chebyshev.chebval(-1, column) for column in outside[0].T])
        first[0] = self.offset + self.scale(mu)*self.outside[0]**2 - first[0]
        last = np.array([np.polynomial.chebyshev.chebval(-1, column) for column in contact[0].T])
        base = jkr(self.contact[0])
        last += -GAP*mu*base[0], base[1]
        states, _ = self._run(mu, -np.geomspace(-0.9*first[1], -1.02*last[1], 400))
        between = ((states["p"] < self.outside[0])
                   & (states["x"] < self.contact[0]))
        h0 = np.concatenate([first[:1], states["h0"][between], last[:1]])
        load = np.concatenate([first[1:], states["load"][between], last[1:]])
        return -np.sum(np.diff(h0)*(load[1:] + load[:-1])/2)/(1 + GAP*mu)

    def tables(self):
        """Return the panel's tables."""
        found = {"outside": [], "contact": [], "energy": []}
        for mu, (states, _) in zip(self.mus, self.runs):
            deformed = states["centre"] - states["h0"]
            found["outside"].append(fitted(
                states["p"], self.outside, [deformed, states["load"]]))
            base = np.zeros(2)
            inside = states["radius"] > 0
            if self.whole:
                h0, load = states["h0"], states["load"]
            else:
                base = jkr(states["x"])
                h0, load = states["h0"] + GAP*mu*base[0], states["load"] - base[1]
            found["contact"].append(fitted(
                np.where(inside, states["x"], -9), self.contact, [h0, load]))
            if not self.whole:
                found["energy"].append(self._energy(
                    mu, found["outside"][-1], found["contact"][-1]))
        return {name: series(np.array(values)) for name, values in found.items() if values}


def wall_series(force):
    """Return the wall's mean gap under Hertz's pressures, over the logarithm of the largest."""
    low, high = np.log(WALL)
    largest = np.exp((low + high)/2 + (high - low)/2*chebyshev_nodes(70))
    node, weight = np.polynomial.legendre.leggauss(80)
    # Gaps at small pressures are linear in them, at large ones powers: s = v^3.
    s = ((node + 1)/2)**3
    weight = 1.5*((node + 1)/2)**2*weight
    return series(force.wall(np.outer(largest, s)) @ weight)


def wall_gap(coefficients, pressure, rest):
    """Return the mean gap at largest pressures [w/z0] of Hertz theory."""
    low, high = np.log(WALL)
    inside = np.clip(pressure, *WALL)
    local = (2*np.log(inside) - low - high)/(high - low)
    gap = np.polynomial.chebyshev.chebval(local, coefficients)
    return np.where(pressure < WALL[0], rest + (gap - rest)*pressure/WALL[0], gap)


class Deep:
    """One panel of Tabor's parameter: from zero load to contact as deep as any."""

    def __init__(self, force, low, high, wall):
        self.force, self.low, self.high, self.wall = force, low, high, wall
        self.mus = np.exp((low + high)/2 + (high - low)/2*chebyshev_nodes(NODES))
        self.edges = np.log([float(jkr_root(JOIN_LOAD/2))**2, 5.0, 25.0, 150.0, DEEP_TO])

    def tables(self):
        """Return the coefficients of the deviations of h0 and contact radius on each tile."""
        local = chebyshev_nodes(2*ORDER)/np.cos(np.pi/(4*ORDER))
        at = np.unique(np.concatenate([
            (low + high)/2 + (high - low)/2*local
            for low, high in zip(self.edges[:-1], self.edges[1:])]))
        root = np.exp(at/2)
        displacement, load = jkr(root)
        found = []
        for mu in self.mus:
            sigma = sigma_of(mu)
            end = -GAP*mu*displacement[-1]*1.001 - 2*self.force.length
            states, _ = path(self.force, mu, self.force.rest + 30*self.force.length, end, load)
            rows = np.array([np.flatnonzero(np.abs(states["load"]/one - 1) < 1e-9)[-1]
                             for one in load])
            radius = SPREAD*sigma**(1/3)*root**2
            gap = (states["h0"][rows] + GAP*mu*displacement
                   - wall_gap(self.wall, radius/(np.pi*sigma), self.force.rest))
            found.append(fitted(at, self.edges, [gap, states["radius"][rows] - radius]))
        return series(np.array(found))


def ladder(force, least, largest):
    """Return the panels of Tabor's parameter near contact: whole path or not, and their ends.

    From where the snap-off is well within contact on, only the stable pieces are represented.
    """
    for split in np.geomspace(0.3, 10, 60):
        states, numbers = path(force, split, force.rest + 30*force.length, force.rest
                               - GAP*split*jkr(jkr_root(0.5))[0] - force.length)
        bottom = np.argmin(states["load"])
        contact = states["radius"] > 0
        last = np.argmax(np.where(contact, states["h0"], -np.inf))
        at_fold = abs(states["h0"][last] - numbers.get("jump_out_h0", np.inf)) < 1e-6
        if at_fold and states["radius"][last] > 0.3*states["radius"][bottom]:
            break
    else:
        raise Unsuitable("the bodies do not snap off contact at a Tabor parameter up to 10")
    panels = []
    if least < RIGID_TO:
        panels.append((True, "sigma", 0.0, float(sigma_of(min(RIGID_TO, largest)))))
    for whole, low, high in ((True, max(RIGID_TO, least), min(split, largest)),
                             (False, max(split, least), largest)):
        if low < high:
            count = int(np.ceil(np.log(high/low)/LONGEST[whole]))
            edges = np.log(np.geomspace(low, high, 1 + count))
            panels += [(whole, "mu", *pair) for pair in zip(edges[:-1], edges[1:])]
    return panels


def law_tables(force, title, least=LEAST, largest=LARGEST, told=print):
    """Return the whole law: what header, Python and calculator are made from."""
    wall = wall_series(force)
    near = []
    for whole, variable, low, high in ladder(force, least, largest):
        panel = Near(force, whole, variable, float(low), float(high))
        found = panel.tables()
        near.append({
            "whole": whole, "variable": variable, "low": panel.low, "high": panel.high,
            "offset": panel.offset, "exponent": panel.exponent,
            "outside_edges": panel.outside.tolist(), "contact_edges": panel.contact.tolist(),
            "outside": [[rounded(tile[:, :, one]) for one in (0, 1)]
                        for tile in np.moveaxis(found["outside"], 1, 0)],
            "contact": [[rounded(tile[:, :, one]) for one in (0, 1)]
                        for tile in np.moveaxis(found["contact"], 1, 0)],
            "energy": rounded(found["energy"][:, None]) if "energy" in found else None})
        told(f"near contact: Tabor's parameter to {panel.mus[-1]:.3g}")
    deep = []
    edges = np.geomspace(least, largest, 1 + int(np.ceil(np.log(largest/least)/3)))
    for low, high in zip(np.log(edges[:-1]), np.log(edges[1:])):
        panel = Deep(force, float(low), float(high), wall)
        tiles = panel.tables()
        deep.append({"low": panel.low, "high": panel.high,
                     "tiles": [[rounded(tile[:, :, one]) for one in (0, 1)]
                               for tile in np.moveaxis(tiles, 1, 0)]})
        told(f"deep contact: Tabor's parameter to {np.exp(high):.3g}")
    return {
        "title": title, "force": force.groups, "order": ORDER,
        "rest": force.rest, "contact": force.contact, "length": force.length,
        "power": force.power, "tail": force.tail, "decay": force.decay,
        "least": least, "largest": largest, "lowest": 0.0 if least < RIGID_TO else least,
        "highest": largest if near[-1]["whole"] else 0.0,
        "join_load": JOIN_LOAD, "wall_low": float(np.log(WALL[0])),
        "wall_high": float(np.log(WALL[1])), "wall": rounded(wall[None]),
        "deep_edges": panel.edges.tolist(), "deep": deep, "near": near}
