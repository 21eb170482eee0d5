"""Errors of a contact law at random states of solved paths."""

import numpy as np
from law_states import jkr, jkr_root, path
from snapin.contact_law import ContactLaw
from snapin._contact_tables import GAP

# What is measured, and in what it is told.
KINDS = {
    "load": "load or h0, in pull-off forces or z0",
    "radius": "contact radius, in that at pull-off",
    "pull_off": "pull-off force, relative",
    "snap": "h0 of snap-in and snap-off, in z0",
    "snap_load": "loads there, in pull-off forces",
    "energy_lost": "energy lost in a cycle, in pull-off force times z0"}
PER_PATH = 100


def random_loads(count, tension, generator):
    """Return loads [pi w R] of which half are near zero, and a third deep in contact."""
    kind = generator.integers(0, 6, count)
    return np.select(
        [kind < 2, kind < 4],
        [-tension*generator.uniform(0, 1, count), -10**generator.uniform(-6, 0, count)],
        10**generator.uniform(-2, 6, count))


def errors_at(table, force, mu, generator, count=PER_PATH):
    """Return the errors by kind of random stable states of one path, as arrays, and of its
    numbers."""
    # Any bodies: the law has only Tabor's parameter.
    radius, work, z0 = 10**generator.uniform([-9, -3, -10], [-1, 0, -8])
    modulus = np.sqrt(radius*work**2/(mu*z0)**3)
    law = ContactLaw(radius, modulus, work, z0, table=table)
    unit = np.pi*work*radius
    start = (force.rest + 40*force.length)*max(1, mu/20)**0.5
    shallow = path(force, mu, start, force.rest - GAP*mu*jkr(jkr_root(1))[0] - force.length)[1]
    loads = random_loads(3*count, shallow["max_tension"], generator)
    end = -GAP*mu*jkr(jkr_root(loads.max()))[0]*1.01 - 3*force.length
    states, numbers = path(force, mu, start, end, loads)
    # Between the first and the last unstable state no approach and no separation leads.
    unstable = np.flatnonzero(states["stable"] != 1)
    ends = (unstable[0], unstable[-1]) if unstable.size else (len(states["h0"]), -1)
    reached = np.flatnonzero((np.arange(len(states["h0"])) < ends[0])
                             | (np.arange(len(states["h0"])) > ends[1]))
    chosen = generator.choice(reached, min(count, reached.size), replace=False)
    h0, load, contact = (states[name][chosen] for name in ("h0", "load", "radius"))
    inside = chosen > ends[1]
    if law.jumps:
        # A state at a snap may lie beyond the law's by its error, which is counted itself.
        h0 = np.where(inside, np.minimum(h0, law.snap_off/z0), np.maximum(h0, law.snap_in/z0))
    pull_off = law.pull_off/unit
    slope = np.abs(law.stiffness(h0*z0, inside))*z0/unit
    found = np.abs(law.load(h0*z0, inside)/unit - load)
    result = {"load": found/(pull_off + slope)}
    step = 1e-6
    radii = law.contact_radius(h0*z0, inside)/np.sqrt(radius*z0)
    changed = law.contact_radius((h0 - step)*z0, inside)/np.sqrt(radius*z0)
    scale = law.contact_radius(law.pull_off_h0, True)/np.sqrt(radius*z0)
    result["radius"] = np.abs(radii - contact)/(scale + np.abs(changed - radii)/step)
    result["pull_off"] = [abs(pull_off/numbers["max_tension"] - 1)]
    if law.jumps != ("jump_out_h0" in numbers):
        result["snap"] = [np.inf]
    elif law.jumps:
        result["snap"] = [abs(law.snap_in/z0 - numbers["jump_in_h0"]),
                          abs(law.snap_off/z0 - numbers["jump_out_h0"])]
        result["snap_load"] = [abs(law.snap_in_load/unit - numbers["jump_in_load"])/pull_off,
                               abs(law.snap_off_load/unit - numbers["jump_out_load"])/pull_off]
        result["energy_lost"] = [
            abs(law.energy_lost/(unit*z0) - numbers["energy_lost"])/pull_off]
    return result


def largest_errors(table, force, states, seed, low=None, high=None):
    """Return the largest error of each kind over random states of random paths, and where."""
    generator = np.random.default_rng(seed)
    low, high = low or table["least"], high or table["largest"]
    worst = {}
    for mu in 10**generator.uniform(*np.log10([low, high]), max(states//PER_PATH, 1)):
        for kind, errors in errors_at(table, force, mu, generator).items():
            largest = float(np.max(errors))
            if not largest <= worst.get(kind, (0, 0))[0]:
                worst[kind] = largest, float(mu)
    return worst
