"""Solved states of a deck's contact at any Tabor parameter, in the units of the contact law.

Gaps are in z0 of the deck, contact radii in sqrt(R z0), loads in pi w R, energies in pi w R z0.
Between parabolic elastic half-spaces the force and Tabor's parameter mu, or sigma = mu^(3/2)/2,
then determine the contact.
"""

import pathlib
import warnings

import f90nml
import numpy as np
import snapin

ACCURACY = 1e-9
FORCES = {"force", "morse", "van_der_waals", "born", "hydration", "hydrophobic", "double_layer"}
# Other groups of a deck that do not change the contact.
IGNORED = {"scene", "bodies", "loading", "unloading", "equilibrium_path", "device", "fixed_load",
           "table", "sensitivity", "regime", "profiles", "approximations", "classical",
           "stability", "sweep", "numerics", "summary", "cost"}
WITH_Z0 = "force", "born", "morse"


class Unsuitable(Exception):
    """The deck's contact cannot be a contact law; the message says why."""


def jkr(root):
    """Return displacement and load of JKR theory at a square root of the contact radius."""
    return root**4 - 2/3*np.sqrt(6)*root, root**6 - np.sqrt(6)*root**3


def jkr_root(load):
    """Return the square root of the larger contact radius of JKR theory under a load >= -1.5."""
    return ((np.sqrt(6) + np.sqrt(6 + 4*np.asarray(load)))/2)**(1/3)


class Force:
    """The force of a deck: its groups, its lengths in z0, and its decay at large gaps."""

    def __init__(self, deck):
        groups = deck if isinstance(deck, dict) else f90nml.read(pathlib.Path(deck)).todict()
        for name in sorted(set(groups) - FORCES - IGNORED):
            raise Unsuitable(f"&{name}: the law is for smooth forces between parabolic elastic "
                             "half-spaces at rest")
        self.groups = {name: dict(keys) for name, keys in groups.items() if name in FORCES}
        lengths = [self.groups[name]["z0"] for name in WITH_Z0
                   if "z0" in self.groups.get(name, {})]
        if not lengths or lengths[0] <= 0:
            raise Unsuitable("no force of the deck has a positive z0, the unit of length")
        self.z0 = lengths[0]
        numbers = snapin.law_numbers(self.groups)
        self.work = numbers.surface_energy
        if not self.work > 0:
            raise Unsuitable("the work of adhesion is not positive")
        self.rest = numbers.rest_gap/self.z0
        self.length = numbers.length/self.z0
        self.contact = self.rest + self.length/10
        self.power, self.tail, self.decay = self._tail()

    def load(self, gap):
        """Return the load between rigid bodies."""
        return 2*snapin.force_law(self.groups, np.asarray(gap)*self.z0).energy/self.work

    def pressure(self, gap):
        """Return the pressure in w/z0."""
        gap = np.asarray(gap)
        found = snapin.force_law(self.groups, gap.ravel()*self.z0).pressure
        return found.reshape(gap.shape)*self.z0/self.work

    def wall(self, pressure):
        """Return the gaps at pressures >= 0, by bisection."""
        pressure = np.asarray(pressure, float)
        try:
            self.pressure(np.array([self.rest - 40*self.length]))
            low, gap_of = self.rest - 40*self.length, lambda value: value
        except ValueError:
            # The pressure is infinite at a gap of 0.
            low, gap_of = np.log(1e-4*self.rest), np.exp
        low = np.full(pressure.shape, low)
        high = np.full(pressure.shape, self.rest if gap_of is not np.exp else np.log(self.rest))
        for _ in range(70):
            middle = (low + high)/2
            above = self.pressure(gap_of(middle)) >= pressure
            low, high = np.where(above, middle, low), np.where(above, high, middle)
        return gap_of((low + high)/2)

    def _tail(self):
        """Return how loads decay at large gaps: power and coefficient of the tension, or decay
        length."""
        gaps = self.rest + self.length*np.array([40.0, 80.0, 160.0])
        loads = np.abs(self.load(gaps))
        if loads[1] > 1e-9:
            powers = -np.diff(np.log(loads))/np.diff(np.log(gaps))
            power = float(round(powers[1], 3))
            if abs(powers[1] - powers[0]) < 1e-3 and power > 1:
                return power, float(loads[2]*gaps[2]**power), 0.0
            raise Unsuitable("the force decays neither as a power of the gap nor exponentially")
        gaps = self.rest + self.length*np.array([4.0, 6.0, 8.0])
        rates = -np.diff(np.log(np.abs(self.load(gaps))))/np.diff(gaps)
        if abs(rates[1]/rates[0] - 1) > 1e-2:
            raise Unsuitable("the force decays neither as a power of the gap nor exponentially")
        return 0.0, 0.0, float(1/rates[1])


def path(force, mu, start, end, loads=(), accuracy=ACCURACY):
    """Return the states on the path at Tabor's parameter mu, from far to near, and the summary.

    They are the rows of the path from h0 = start to end [z0] and all equilibria under the loads.
    """
    # Bodies for which the unit of lateral lengths is 1000 z0.
    radius = 1e6*force.z0
    modulus = np.sqrt(radius*force.work**2/(mu*force.z0)**3)
    unit = np.pi*force.work*radius
    deck = {"bodies": {"radius": radius, "stiffness": 2*modulus}, **force.groups,
            "equilibrium_path": {"h0_start": start*force.z0, "h0_end": end*force.z0},
            "numerics": {"accuracy": accuracy}}
    if len(loads):
        deck["fixed_load"] = {"load": np.asarray(loads)*unit}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", snapin.SnapinWarning)
        result = snapin.run(deck)
    tables = [result.curve] + [result.tables[name] for name in ("fixed_load",) if len(loads)]
    rows = np.concatenate([
        np.stack([table["h0"]/force.z0, (table["h0"] + table["displacement"])/force.z0,
                  table["load"]/unit, table["contact_radius"]/np.sqrt(radius*force.z0),
                  table["stable"]], axis=1) for table in tables])
    rows = rows[np.argsort(-rows[:, 1], kind="stable")]
    distinct = np.append(True, np.abs(np.diff(rows[:, 1])) > 1e-9*np.abs(rows[1:, 1]))
    rows = rows[distinct & np.isfinite(rows).all(axis=1)]
    names = "h0", "centre", "load", "radius", "stable"
    states = dict(zip(names, rows.T))
    summary = result.summary
    scales = {"h0": force.z0, "load": unit, "energy_lost": unit*force.z0, "max_tension": unit}
    numbers = {"stable_pieces": 1 + len(np.atleast_1d(summary.get("folds_h0", [])))//2}
    for key in ("jump_in_h0", "jump_in_load", "jump_out_h0", "jump_out_load", "max_tension",
                "max_tension_h0", "energy_lost"):
        if key in summary:
            numbers[key] = float(np.atleast_1d(summary[key])[-1 if "out" in key else 0])
            numbers[key] /= scales[key if key in scales else key.rsplit("_", 1)[1]]
    return states, numbers


def sigma_of(mu):
    """Return sigma at Tabor's parameter."""
    return np.asarray(mu)**1.5/2


def mu_of(sigma):
    """Return Tabor's parameter at sigma."""
    return (2*np.asarray(sigma))**(2/3)
