"""Every public callable of the package `snapin`, with one good call of each and the kinds of its
arguments. tests/support/wrapper_values.py has the values, good and bad, for each kind of argument.

A kind is a word: vector, paired (a vector as long as another), flags (bools, likewise), scalar,
positive, count, name, law, mesh; number, whole, word and switch are keys of a deck, whose range
and type the program checks.
"""

import dataclasses
import math

import numpy as np
import snapin
from snapin import contact_law, numerics
from support.scenes import UNIT  # noqa: F401 (tests import it from here too)


def law_of(sigma, part="full"):
    """The Lennard-Jones law of a given sigma in bodies of UNIT."""
    return snapin.lennard_jones(hamaker=16 * math.pi * sigma, z0=1.0, part=part)


LAW = snapin.lennard_jones(hamaker=5.0, z0=1.0)
MESH = snapin.panel_mesh([0.0, 1.0, 3.0], 4)
CONTACT = contact_law.ContactLaw(1.0, 1.0, 2.0, 1.0)

VECTOR, PAIRED, SCALAR, POSITIVE = "vector", "paired", "scalar", "positive"
COUNT, NAME, LAWS, MESHES, FLAGS = "count", "name", "law", "mesh", "flags"
NUMBER, WHOLE, WORD, SWITCH = "number", "whole", "word", "switch"


@dataclasses.dataclass(frozen=True)
class Entry:
    """`call(**good)` is right; `kinds` has the kind of each argument, by its public name."""

    call: object
    good: dict
    kinds: dict


def entry(call, **arguments):
    return Entry(
        call, {name: value for name, (_, value) in arguments.items()},
        {name: kind for name, (kind, _) in arguments.items()})


# Equal steps of h0 downwards.
STEPS = np.array([3.5, 3.0, 2.5, 2.0])
RISING = np.array([0.5, 0.75, 1.25, 2.0])
BODIES = {"radius": (POSITIVE, 1.0), "stiffness": (POSITIVE, 2.0)}
ADHESION = {"surface_energy": (POSITIVE, 1.5)}
SCENE = {
    "radius": (NUMBER, 1.0), "stiffness": (NUMBER, 2.0), "law": (LAWS, LAW),
    "rigid": (SWITCH, False)}
ONE_STATE = {
    "law": (LAWS, LAW),
    "mesh": (MESHES, MESH),
    "h0": (SCALAR, 3.0),
    "coupling": (SCALAR, 0.2),
    "start": (PAIRED, np.linspace(3.0, 7.0, 8)),
    "scale": (POSITIVE, 1.5),
    "tolerance": (POSITIVE, 1e-8),
}

# Between snap-in and snap-off both states exist.
CONTACT_STATE = {"h0": (VECTOR, RISING + 1), "in_contact": (FLAGS, np.array([True, False] * 2))}

REGISTRY = {
    "approximation_rows": entry(
        snapin.approximation_rows, h0_start=(NUMBER, 8.0), h0_end=(NUMBER, 5.0), **SCENE,
        count=(WHOLE, 5)),
    "cohesive_zone": entry(
        snapin.cohesive_zone, contact_radius=(VECTOR, RISING), **BODIES, **ADHESION,
        z0=(POSITIVE, 0.5)),
    "contact_curve": entry(
        snapin.contact_curve, theory=(NAME, "maugis"), contact_radius=(VECTOR, RISING), **BODIES,
        **ADHESION, strength=(POSITIVE, 0.8)),
    "contact_radius": entry(
        snapin.contact_radius, theory=(NAME, "maugis"), control=(NAME, "edge_ratio"),
        values=(VECTOR, RISING + 1), **BODIES, **ADHESION, strength=(POSITIVE, 0.8)),
    "contact_radius at load": entry(
        snapin.contact_radius, theory=(NAME, "jkr"), control=(NAME, "load"),
        values=(VECTOR, RISING), **BODIES, **ADHESION, strength=(SCALAR, 1.0)),
    "equilibrium": entry(
        snapin.equilibrium, **ONE_STATE, method=(NAME, "mixing"), most_iterations=(COUNT, 60),
        depth=(COUNT, 5), patience=(COUNT, 8), mixing_limit=(POSITIVE, 0.2),
        displacement_tolerance=(SCALAR, 1e-9)),
    "equilibrium by Anderson": entry(snapin.equilibrium, **ONE_STATE, depth=(COUNT, 5)),
    "equilibrium by accelerated mixing": entry(
        snapin.equilibrium, **ONE_STATE, method=(NAME, "anderson_mixing"),
        most_iterations=(COUNT, 60), depth=(COUNT, 5), mixing_limit=(POSITIVE, 0.2)),
    "equilibrium_path": entry(
        snapin.equilibrium_path, h0_end=(NUMBER, 1.0), **SCENE, h0_start=(NUMBER, 20.0),
        accuracy=(NUMBER, 1e-2)),
    "force_curve": entry(
        snapin.force_curve, h0=(VECTOR, STEPS), **SCENE, method=(WORD, "anderson"),
        grid=(WORD, "uniform"), accuracy=(NUMBER, 1e-2), nodes=(WHOLE, 60), r_max=(NUMBER, 12.0)),
    "force_curve on locked panels": entry(
        snapin.force_curve, h0=(VECTOR, STEPS), **SCENE, accuracy=(NUMBER, 1e-2)),
    "force_law": entry(snapin.force_law, law=(LAWS, LAW), gap=(VECTOR, RISING)),
    "force_law, exponential": entry(
        snapin.force_law, law=(LAWS, snapin.exponential(p0=5.0, decay_length=0.5)),
        gap=(VECTOR, RISING)),
    "gauss_rule": entry(snapin.gauss_rule, points=(COUNT, 7)),
    "jump_estimates": entry(snapin.jump_estimates, **SCENE),
    "kernel": entry(snapin.kernel, total=(PAIRED, RISING + 1), distance=(PAIRED, RISING)),
    "kernel_log_coefficient": entry(
        snapin.kernel_log_coefficient, total=(PAIRED, RISING + 1), distance=(PAIRED, RISING)),
    "law_numbers": entry(snapin.law_numbers, law=(LAWS, LAW)),
    "load_at_displacement": entry(
        snapin.load_at_displacement, theory=(NAME, "jkr"), displacement=(VECTOR, RISING), **BODIES,
        **ADHESION),
    "panel_mesh": entry(
        snapin.panel_mesh, ends=(VECTOR, RISING), order=(COUNT, 5), centre=(SCALAR, 1.0)),
    "panel_weights": entry(
        snapin.panel_weights, node=(VECTOR, RISING / 2), target=(VECTOR, RISING),
        left=(SCALAR, 0.5), right=(SCALAR, 1.5), centre=(SCALAR, 1.0)),
    "profile": entry(
        snapin.profile, theory=(NAME, "jkr"), r=(VECTOR, RISING), contact_radius=(POSITIVE, 1.0),
        **BODIES, **ADHESION),
    "pull_off": entry(
        snapin.pull_off, theory=(NAME, "maugis"), **BODIES, **ADHESION, strength=(POSITIVE, 0.8),
        control=(NAME, "load")),
    "slow_deformation": entry(
        snapin.slow_deformation, gap=(VECTOR, RISING + 3), **SCENE, form=(NAME, "closed_form")),
    "turning_intervals": entry(
        snapin.turning_intervals, x=(VECTOR, RISING), value=(PAIRED, RISING),
        slope=(PAIRED, RISING - 1)),
    "uniform_mesh": entry(snapin.uniform_mesh, nodes=(COUNT, 9), extent=(POSITIVE, 3.0)),
    "Mesh": entry(
        numerics.Mesh, kind=(NAME, "panels"), centre=(SCALAR, 1.0), ends=(VECTOR, RISING),
        order=(COUNT, 5)),
    "ContactLaw.contact_radius": entry(CONTACT.contact_radius, **CONTACT_STATE),
    "ContactLaw.energy": entry(CONTACT.energy, **CONTACT_STATE),
    "ContactLaw.history": entry(
        CONTACT.history, h0=(VECTOR, RISING + 1), before=(FLAGS, np.array([True]))),
    "ContactLaw.in_contact": entry(
        CONTACT.in_contact, h0=(VECTOR, RISING + 1), before=(FLAGS, np.array([True, False] * 2))),
    "ContactLaw.load": entry(CONTACT.load, **CONTACT_STATE),
    "ContactLaw.stiffness": entry(CONTACT.stiffness, **CONTACT_STATE),
    "Mesh.matrix": entry(MESH.matrix),
    "Mesh.interpolate": entry(
        MESH.interpolate, values=(PAIRED, np.linspace(1.0, 2.0, 8)), at=(VECTOR, RISING)),
}

# Arguments that a good call omits, and those collected by `**numerics`.
LEFT_OUT = {
    "equilibrium by Anderson": {
        "method", "most_iterations", "patience", "mixing_limit", "displacement_tolerance"},
    "equilibrium by accelerated mixing": {"patience", "displacement_tolerance"},
}
GATHERED = {"method", "grid", "accuracy", "nodes", "r_max"}
