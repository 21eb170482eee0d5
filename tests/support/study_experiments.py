"""True and estimated errors of springs and fixed loads under every law: random scenes.

The truth is the same scene at a much higher accuracy, as in `study_laws`, which makes the tables.
Scene k of a seed is always the same scene.
"""

import functools
import random

from support import study_laws
from support.study_laws import LAWS, RADIUS, compared, logarithmic, table

__all__ = ["examine", "jobs", "table"]

# Laws with a contact; strengths of adhesion; stiffness of a spring over pull-off and length.
NAMES = tuple(name for name in LAWS if name not in ("repulsive", "exponential"))
STRENGTHS, STIFFNESSES = (1e-3, 1e3), (0.03, 30)

jobs = functools.partial(study_laws.jobs, study="experiments", names=NAMES, strengths=STRENGTHS)


def examine(scene):
    """The findings of a job: one."""
    rng = random.Random(f"experiment {scene.seed} {scene.number}")
    return [compared(scene._replace(kind="path"), rng, LAWS[scene.law](rng),
                     lambda stiffness: {"bodies": {"radius": RADIUS, "stiffness": stiffness}},
                     springs_and_loads)]


def springs_and_loads(rng, law, scales):
    """Two springs, and loads up to the pull-off of JKR theory."""
    pull_off = scales["jkr_pull_off"]
    return {
        "device": {"stiffness": [pull_off / law.length * logarithmic(rng, *STIFFNESSES)
                                 for _ in range(2)]},
        "fixed_load": {"load": [pull_off * part for part in (0, -0.3, rng.uniform(-1, 1))]}}
