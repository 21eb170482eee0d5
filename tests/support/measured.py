"""Simulated force curves of an instrument, for tests: from the exact states of a device, at equal
steps of the base, or by a closed form."""

import warnings

import numpy as np
import pytest
import snapin
from support.calculus import hermite

BODIES = {"radius": 50e-9, "stiffness": 1e10}
LENNARD_JONES = {"bodies": BODIES, "force": {"law": "lennard_jones", "hamaker": 1e-19, "z0": 3e-10}}
SPRING = 1.2
CONTACT_POINT = 3e-6
# Unknowns of most fits.
POINT = "measurement.contact_point"
STRENGTH, STIFFNESS = "force.hamaker", "bodies.stiffness"


def states_of_device(groups, spring=SPRING, start=40e-9, h0_end=-2e-9):
    """Return position, load and segment of the states of a device, each solved."""
    table = snapin.run({
        **groups, "equilibrium_path": {"h0_end": h0_end},
        "device": {"stiffness": spring, "z_start": start}, "numerics": {"accuracy": 1e-8}}).device
    ways = [table[table["direction"] == way] for way in ("approach", "retreat")]
    segment = np.repeat([0, 1], [len(way) for way in ways])
    z, load = (np.concatenate([way[name] for way in ways]) for name in ("z", "load"))
    return z, load, segment


class Branches:
    """The outer and the inner stable branch with a spring, from many states at given h0."""

    def __init__(self, groups, spring=SPRING, far=60e-9, h0_end=-5e-10, step=1e-11):
        run = snapin.run({
            **groups, "loading": {"h0_start": far, "h0_end": h0_end, "h0_step": step},
            "unloading": {"from": h0_end, "h0_end": far, "h0_step": step}})
        way_in, way_out = (run.curve[run.curve["branch"] == name]
                           for name in ("loading", "unloading_1"))
        self.outer = self._until_turn(way_in, spring)
        self.inner = self._until_turn(way_out, spring)

    @staticmethod
    def _until_turn(rows, spring):
        """Position and load along the way up to the turn of the position, ascending."""
        z = rows["h0"] - rows["load"] / spring
        ahead = np.diff(z) * np.sign(z[-1] - z[0]) > 0
        last = len(z) if ahead.all() else np.argmin(ahead) + 1
        order = slice(None) if z[-1] > z[0] else slice(None, None, -1)
        return z[:last][order], rows["load"][:last][order]

    def force(self, z, inward):
        """Load at positions of the drive on the way in or out."""
        jump = self.outer[0][0] if inward else self.inner[0][-1]
        return np.where(z > jump, through(z, *self.outer), through(z, *self.inner))

    def measure(self, n, noise=0.0, seed=0):
        """z, force and segment of n samples on each way; `noise` is white. The positions of the
        samples are random too, so a jump may be anywhere between two of them."""
        rng = np.random.default_rng(seed)
        near, far = self.inner[0][0], self.outer[0][-1]
        step = (far - near) / n
        z = np.concatenate([
            far - step * (np.arange(n) + rng.random()), near + step * (np.arange(n) + rng.random())
        ])
        segment = np.repeat([0, 1], n)
        force = np.concatenate([self.force(z[:n], True), self.force(z[n:], False)])
        return z, force + noise * rng.standard_normal(2 * n), segment


@pytest.fixture(scope="session")
def branches():
    """The branches of the Lennard-Jones scene, for tests that import them."""
    return Branches(LENNARD_JONES)


def through(at, x, y):
    """A smooth curve through points."""
    return hermite(at, x, y, np.gradient(y, x))


def write(path, z, signal, segment=None, header="z,force,segment", digits=16):
    """Write a measured curve; without segments the file has two columns."""
    columns = [z, signal] if segment is None else [z, signal, segment]
    names = ",".join(header.split(",")[: len(columns)])
    np.savetxt(path, np.column_stack(columns), f"%.{digits}e", ",", header=names, comments="")
    return str(path)


def fit_deck(groups, file, parameters, fit=None, measurement=None, **others):
    """The deck of a fit; `fit` and `measurement` are further keys of these groups."""
    return {
        **groups,
        "measurement": {
            "file": file, "columns": ["z", "force", "segment"], "spring_constant": SPRING,
            **(measurement or {})},
        "fit": {"parameters": list(parameters), **(fit or {})},
        **others,
    }


def fitted(folder, curve, groups, parameters, fit=None, **others):
    """The result of the fit of a measured curve, which is written into a folder."""
    return run(fit_deck(groups, write(folder / "curve.csv", *curve), parameters, fit, **others))


def run(deck):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", snapin.SnapinWarning)
        return snapin.run(deck)
