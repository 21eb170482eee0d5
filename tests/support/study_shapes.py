"""True and estimated errors of springs, fixed loads and cycles between bodies of every shape, with
layers or without, under every law with a contact: random scenes.

The truth is the same scene at a much higher accuracy, as in `study_laws`, which makes the tables.
Besides, a truth has two ways to the energy that a cycle loses, which must agree. Scene k of a seed
is always the same scene.
"""

import functools
import math
import random

import numpy as np
from support import study_laws, study_layers
from support.study_experiments import NAMES, springs_and_loads
from support.study_laws import LAWS, RADIUS, compared, logarithmic, table

__all__ = ["examine", "jobs", "table"]

# Strengths of adhesion; flat face of a punch over its lateral unit; radius of the last point of a
# profile over that of the contact without load; part of the scenes that have layers.
STRENGTHS, FACES, WIDTHS, LAYERED = (1e-2, 1e2), (0.03, 10), (6, 20), 0.25

jobs = functools.partial(study_laws.jobs, study="shapes", names=NAMES, strengths=STRENGTHS)


def power(rng, law, scene, exponent=None):
    """A gap B r^n of half the law's length at the lateral unit of a parabola."""
    exponent = exponent or rng.uniform(1, 6)
    return {"kind": "power", "exponent": exponent,
            "coefficient": 0.5 * law.length / lateral(law) ** exponent}


def cone(rng, law, scene):
    return {"kind": "cone", "half_angle": math.atan(2 * lateral(law) / law.length)}


def spheroid(rng, law, scene):
    return {"kind": "spheroid", "semi_axis": RADIUS * logarithmic(rng, 0.1, 10)}


def rounded_punch(rng, law, scene):
    return {"kind": "rounded_punch", "flat_radius": lateral(law) * logarithmic(rng, *FACES)}


def profile(rng, law, scene):
    """A body that is blunter the farther out, as a file."""
    top = lateral(law) * (9 * math.pi * scene.sigma) ** (1 / 3) * logarithmic(rng, *WIDTHS)
    r = np.linspace(0, top, 100)
    height = r**2 / (2 * RADIUS) * (1 + rng.random() * (r / top) ** 2)
    scene.folder.mkdir(parents=True, exist_ok=True)
    np.savetxt(scene.folder / "profile.txt", np.column_stack([r, height]), fmt="%.17g")
    return {"kind": "profile", "file": "profile.txt"}


SHAPES = (power, cone, lambda rng, law, scene: {"kind": "sphere"}, spheroid, rounded_punch, profile)
# Shapes without a radius.
PLAIN = ("power", "cone", "profile")


def lateral(law):
    return math.sqrt(RADIUS * law.length)


def examine(scene):
    """The findings of a job: one."""
    rng = random.Random(f"shape {scene.seed} {scene.number}")
    law = LAWS[scene.law](rng)
    shape = rng.choice(SHAPES)(rng, law, scene)
    layers = rng.choice(("layer", "film", "layers")) if rng.random() < LAYERED else None

    def bodies(stiffness):
        groups = {"bodies": {"radius": RADIUS, "stiffness": stiffness}}
        if layers:
            groups = study_layers.bodies(rng, scene._replace(law=layers), stiffness)
        if shape["kind"] in PLAIN:
            del groups["bodies"]["radius"]
        return {**groups, "shape": shape}

    more = springs_and_loads if scene.kind == "path" else nothing
    return [compared(scene, rng, law, bodies, more)._replace(scene=scene._replace(
        law=f"{scene.law}, {shape['kind']}{', ' + layers if layers else ''}"))]


def nothing(rng, law, scales):
    return {}
