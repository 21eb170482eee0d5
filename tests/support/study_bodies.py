"""True and estimated errors of experiments with bodies of other kinds: random scenes.

Three studies: springs and fixed loads under every law with a contact; paths and cycles of bodies
with layers; and all of these between bodies of every shape, with layers or without.

The truth is the same scene at a much higher accuracy, as in `study_laws`, which makes the tables.
Besides, a truth has two ways to the energy that a cycle loses, which must agree.
"""

import functools
import math
import random

import numpy as np
from support import study_laws
from support.study_laws import (
    LAWS, RADIUS, Z0, Law, compared, lennard_jones, logarithmic, nothing, parabolas)

# Laws with a contact; ways to put layers.
CONTACTS = tuple(name for name in LAWS if name not in ("repulsive", "exponential"))
LAYERS = ("layer", "film", "layers")
# Stiffness of a spring over pull-off and length.
STIFFNESSES = (0.03, 30)
# Thickness over the contact radius of JKR theory without load; ratios of moduli of neighbours.
THICKNESSES, RATIOS = (0.1, 10), (1e-2, 1e2)
# Flat face of a punch over its lateral unit; radius of the last point of a profile over that of the
# contact without load; part of the scenes of shapes that have layers.
FACES, WIDTHS, LAYERED = (0.03, 10), (6, 20), 0.25

experiments = functools.partial(
    study_laws.jobs, study="experiment", names=CONTACTS, strengths=(1e-3, 1e3))
layers = functools.partial(study_laws.jobs, study="layer", names=LAYERS, strengths=(1e-2, 1e2))
shapes = functools.partial(study_laws.jobs, study="shape", names=CONTACTS, strengths=(1e-2, 1e2))

table = study_laws.table


def examine(scene):
    return [{"experiment": experiment, "layer": layer, "shape": shape}[scene.study](
        scene, random.Random(f"{scene.study} {scene.seed} {scene.number}"))]


def experiment(scene, rng):
    return compared(scene._replace(kind="path"), rng, LAWS[scene.law](rng), parabolas,
                    springs_and_loads)


def layer(scene, rng):
    return compared(scene, rng, Law(lennard_jones(rng), Z0, Z0),
                    lambda stiffness: layered(rng, scene, stiffness))


def shape(scene, rng):
    law = LAWS[scene.law](rng)
    outline = rng.choice(SHAPES)(rng, law, scene)
    kind = rng.choice(LAYERS) if rng.random() < LAYERED else None

    def bodies(stiffness):
        groups = layered(rng, scene._replace(law=kind), stiffness) if kind else parabolas(stiffness)
        if outline["kind"] in PLAIN:
            del groups["bodies"]["radius"]
        return {**groups, "shape": outline}

    more = springs_and_loads if scene.kind == "path" else nothing
    return compared(scene, rng, law, bodies, more)._replace(scene=scene._replace(
        law=f"{scene.law}, {outline['kind']}{', ' + kind if kind else ''}"))


def springs_and_loads(rng, law, scales):
    """Two springs, and loads up to the pull-off of JKR theory."""
    pull_off = scales["jkr_pull_off"]
    return {
        "device": {"stiffness": [pull_off / law.length * logarithmic(rng, *STIFFNESSES)
                                 for _ in range(2)]},
        "fixed_load": {"load": [pull_off * part for part in (0, -0.3, rng.uniform(-1, 1))]}}


def layered(rng, scene, stiffness):
    """Bodies with this stiffness of their top layers: a film on a rigid base, one or several layers
    on an elastic base; the other body is of the same modulus or has the same layers."""
    count = rng.randint(2, 4) if scene.law == "layers" else 1
    body = rng.choice(("1", "2", "both"))
    radius = math.sqrt(RADIUS * Z0) * (9 * math.pi * scene.sigma) ** (1 / 3)
    total = radius * logarithmic(rng, *THICKNESSES)
    parts = [rng.uniform(0.2, 1) for _ in range(count)]
    poisson = [rng.choice((0.5, rng.uniform(0, 0.5))) for _ in range(count + 1)]
    young = [stiffness * (1 - poisson[0] ** 2)]
    for _ in range(count):
        young.append(young[-1] * logarithmic(rng, *RATIOS) ** (1 / count))
    layer = {"thickness": [total * part / sum(parts) for part in parts], "young": young[:-1],
             "poisson": poisson[:-1], "body": body}
    # The body without layers has the stiffness of the top layer.
    base = {"young": [young[-1]] * 2, "poisson": [poisson[-1]] * 2}
    if body != "both":
        other = 1 if body == "1" else 0
        base["young"][other], base["poisson"][other] = stiffness, 0.0
    if scene.law == "film":
        layer["base"] = "rigid"
    return {"bodies": {"radius": RADIUS, **base}, "layer": layer}


def power(rng, law, scene):
    """A gap B r^n of half the law's length at the lateral unit of a parabola."""
    exponent = rng.uniform(1, 6)
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
