"""True and estimated errors for bodies with layers: random scenes, paths and cycles.

The truth is the same scene at a much higher accuracy, as in `study_laws`, which makes the tables.
Scene k of a seed is always the same scene.
"""

import functools
import math
import random

from support import study_laws
from support.study_laws import RADIUS, Law, compared, lennard_jones, logarithmic, table

__all__ = ["examine", "jobs", "table"]

# Strengths of adhesion.
STRENGTHS = (1e-2, 1e2)
# Thickness over the contact radius of JKR theory without load; ratios of moduli of neighbours.
THICKNESSES, RATIOS = (0.1, 10), (1e-2, 1e2)
Z0 = 0.5e-9


jobs = functools.partial(
    study_laws.jobs, study="layers", names=("layer", "film", "layers"), strengths=STRENGTHS)


def examine(scene):
    """The findings of a job: one."""
    rng = random.Random(f"layer {scene.seed} {scene.number}")
    return [compared(scene, rng, Law(lennard_jones(rng), Z0, Z0),
                     lambda stiffness: bodies(rng, scene, stiffness))]


def bodies(rng, scene, stiffness):
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
