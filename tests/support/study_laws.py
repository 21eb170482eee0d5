"""True and estimated errors under every law: random scenes, paths and cycles.

There is no independent solution for most laws. The truth is the same scene at a much higher
accuracy, and a deviation counts if it is well above the estimated error of the truth. Scene k of a
seed is always the same scene.
"""

import math
import random
import shutil
from typing import NamedTuple

import numpy as np
from support import comparison
from support.comparison import Deviation
from support.decks_in_units import LENGTHS, LOADS, run_deck
from support.scenes import deck, read_groups, read_table, several
from support.study_cycles import logarithmic

ACCURACIES = (1e-3, 1e-8)
STRENGTHS = (1e-4, 1e4)
RADIUS, STIFFNESS, Z0 = 1.5e-2, 1e10, 0.5e-9
SPRING_LOADS = tuple(f"device_jump_{way}_{what}" for way in ("in", "out")
                     for what in ("load", "load_after"))
ENERGIES = ("energy_lost", "device_energy_lost")
KEYS = (*LOADS, *SPRING_LOADS, *LENGTHS, "device_jump_in_z", "device_jump_out_z", "fixed_load_h0",
        *ENERGIES)
# Ratio of the accuracies of truth and run (meshes gain three quarters of a digit for each digit of
# the accuracy), and the smallest possible accuracy.
FINER, FINEST = 1e-4, 1e-10
# The error of the truth is its estimate; a deviation this many times larger is that of the run.
WELL_ABOVE = 3
SECONDS = 30
# A run without an estimate of its error is no truth.
NO_ERROR = "the error could not be estimated"
# Largest difference between the two ways to an energy, the area of a cycle and its jumps: relative,
# and over largest load times length, which narrow cycles are much smaller than.
TWO_WAYS, NARROW = 1e-3, 1e-5


class Law(NamedTuple):
    """The groups of a law, the approximate equilibrium gap, and its length [m]."""

    groups: dict
    rest: float
    length: float


class Scene(NamedTuple):
    """A scene: its study, number and seed, and its random values."""

    study: str
    number: int
    seed: int
    law: str
    sigma: float
    kind: str
    accuracy: float
    folder: object


class Finding(NamedTuple):
    """A scene with its deviations, the number of values as accurate as the truth, and the errors;
    of the run at the requested accuracy the time, infinite if too long, and the warnings."""

    scene: Scene
    deviations: list
    unknown: int
    wrong: list
    seconds: float = math.inf
    warnings: tuple = ()


def lennard_jones(rng, **more):
    return {"force": {"law": "lennard_jones", "hamaker": 1e-19, "z0": Z0, **more}}


def beside(rng, **groups):
    return Law({**lennard_jones(rng), **groups}, Z0, Z0)


def dispersion(rng, **groups):
    """Van der Waals attraction and Born repulsion, retarded or not, and others."""
    hamaker, z0 = 1e-19, rng.uniform(0.2, 0.5) * 1e-9
    retarded = {"retardation_length": rng.uniform(2, 100) * 1e-9} if rng.random() < 0.5 else {}
    return Law({"van_der_waals": {"hamaker": hamaker, **retarded},
                "born": {"hamaker": hamaker, "z0": z0}, **groups}, z0, z0)


def morse(rng):
    decay = rng.uniform(0.1, 0.5) * 1e-9
    z0 = rng.uniform(0.3, 3) * 1e-9
    return Law({"morse": {"surface_energy": 0.05, "z0": z0, "decay_length": decay}}, z0, 2 * decay)


def other_powers(rng):
    n, m = rng.choice([(9, 3), (10, 4), (12, 6), (7, 3)])
    force = {"law": "lennard_jones", "surface_energy": 0.01, "z0": Z0, "exponents": [n, m]}
    return Law({"force": force}, Z0, Z0)


def table_of(rng):
    """A Lennard-Jones law as a table of pressures."""
    return Law({"tabulated": {"file": "law.txt", "tail_exponent": 3}}, Z0, Z0)


# Each draws its numbers; the range of an exponential or a step is some of the first law's lengths.
LAWS = {
    "lennard_jones": lambda rng: Law(lennard_jones(rng), Z0, Z0),
    "repulsive": lambda rng: Law(lennard_jones(rng, part="repulsive"), Z0, Z0),
    "powers": other_powers,
    "exponential": lambda rng: Law(
        {"force": {"law": "exponential", "p0": 2.5e8, "decay_length": 0.2e-9}}, 0.0, 0.2e-9),
    "morse": morse,
    "dispersion": dispersion,
    "double_layer": lambda rng: dispersion(
        rng, double_layer={"potential": -rng.uniform(0.02, 0.1), "regulation": rng.random(),
                           "salt": 10 ** rng.uniform(-1, 2), "valence": 1}
    ),
    "hydration": lambda rng: beside(
        rng,
        hydration={"energy": rng.uniform(1e-3, 1e-2), "decay_length": rng.uniform(0.2, 1) * 1e-9}),
    "hydrophobic": lambda rng: beside(
        rng,
        hydrophobic={"energy": rng.uniform(1e-3, 2e-2), "decay_length": rng.uniform(0.5, 2) * 1e-9},
    ),
    "steric": lambda rng: beside(
        rng, steric={"brush_thickness": rng.uniform(1, 4) * 1e-9, "grafting_density": 1e16}),
    "structural": lambda rng: beside(
        rng, structural={"amplitude": rng.uniform(1e5, 3e6), "period": rng.uniform(0.8, 2) * 1e-9,
                         "decay_length": 1e-9}
    ),
    "depletion": lambda rng: beside(
        rng, depletion={"osmotic_pressure": 1e5, "diameter": rng.uniform(1, 5) * 1e-9}),
    "capillary": lambda rng: beside(rng, capillary={"humidity": rng.uniform(0.2, 0.7)}),
    "dugdale": lambda rng: beside(
        rng, dugdale={"stress": 1e7, "range": rng.uniform(0.7, 2) * 1e-9}),
    "tabulated": table_of,
}


def jobs(count, folder, *, seed=1, study="law", names=tuple(LAWS), strengths=STRENGTHS):
    """Scenes of a study one by one, the laws (or bodies) of these names in turn."""
    made = []
    for number in range(count):
        rng = random.Random(f"{study}s {seed} {number}")
        made.append(Scene(
            study, number, seed, names[number % len(names)],
            float(f"{logarithmic(rng, *strengths):.4g}"),
            rng.choice(("path", "cycle")), float(f"{logarithmic(rng, *ACCURACIES):.1g}"),
            folder / f"scene{number}"))
    return made


def examine(scene):
    rng = random.Random(f"law {scene.seed} {scene.number}")
    return [compared(scene, rng, LAWS[scene.law](rng), parabolas)]


def parabolas(stiffness):
    return {"bodies": {"radius": RADIUS, "stiffness": stiffness}}


def nothing(rng, law, scales):
    return {}


def compared(scene, rng, law, bodies, more=nothing):
    """The finding of a scene; bodies(stiffness): the groups of its bodies; more: further groups, by
    the scales of the law."""
    scene.folder.mkdir(parents=True, exist_ok=True)
    if scene.law == "tabulated":
        gap = np.geomspace(0.5, 60, 300) * Z0
        pressure = 1e-19 / (6 * math.pi) * (Z0**6 / gap**9 - 1 / gap**3)
        np.savetxt(scene.folder / "law.txt", np.column_stack([gap, pressure]))
    scales = scales_of(scene, law)
    strength = scales.get("sigma") or scales.get("big_lambda") or 1.0
    groups = {**bodies(STIFFNESS * strength / scene.sigma), **law.groups}
    groups.update(driven(rng, scene, law))
    groups.update(more(rng, law, scales))
    found = run(scene, "asked", {**groups, "numerics": {"accuracy": scene.accuracy}})
    truth = run(scene, "truth", {**groups, "numerics": {
        "accuracy": max(FINER * scene.accuracy, FINEST), "residual_tolerance": 1e-12}})
    shutil.rmtree(scene.folder)
    return judged(scene, law, found, truth)


def driven(rng, scene, law):
    """A path, or a cycle of a hundred states, to some lengths beyond the first contact."""
    far = law.rest + (4 + 3.5 * scene.sigma ** (2 / 3)) * law.length * rng.uniform(0.5, 1.2)
    depth = law.rest - logarithmic(rng, 0.5, 20) * law.length
    if scene.kind == "path":
        return {"equilibrium_path": {"h0_end": depth}}
    step = (far - depth) / rng.uniform(20, 60)
    return {"loading": {"h0_start": far, "h0_end": depth, "h0_step": step},
            "unloading": {"from_": depth}}


def scales_of(scene, law):
    """The summary of the law on bodies of the usual stiffness, from a table without solved
    equations."""
    return run(scene, "strength", {
        **parabolas(STIFFNESS), **law.groups,
        "classical": {"h0_start": law.rest + law.length, "h0_end": law.rest}})[0]


def run(scene, name, groups):
    """The summary of a deck and the reason of a failure, if it failed."""
    status, stderr, found = run_deck(scene.folder, name, deck(**groups), SECONDS)
    if status is None:
        return {}, stderr
    if not (found / "summary.nml").exists():
        return {}, f"status {status}: {stderr.strip()[-200:]}"
    results = read_groups(found / "summary.nml")
    summary = {**results["summary"], "wall_seconds": results["cost"]["wall_seconds"]}
    if (found / "fixed_load.csv").exists():
        rows = read_table(found / "fixed_load.csv")
        summary["fixed_load_h0"] = list(rows["h0"])
        summary["fixed_load_h0_error"] = list(rows["h0_error"])
    said = " | ".join(several(summary.get("warnings", [])))
    return summary, f"status {status}: {said[:200]}" if status else ""


def judged(scene, law, found, truth):
    """The numbers of a run compared with those of the truth, or the reason of no comparison."""
    (mine, trouble), (theirs, doubt) = found, truth
    cost = {"seconds": mine.get("wall_seconds", math.inf),
            "warnings": tuple(several(mine.get("warnings", [])))}
    # There is no result without a truth, or for a run that took too long.
    doubt = doubt or any(NO_ERROR in said for said in several(theirs.get("warnings", [])))
    if doubt or trouble.startswith("more than"):
        return Finding(scene, [], 0, [], **cost)
    if trouble:
        return Finding(scene, [], 0, [trouble], **cost)
    loads = (*several(theirs.get("max_tension", 0.0)), theirs.get("end_load", 0.0))
    load = max(map(abs, loads))
    deviations, wrong, unknown = [], [], 0
    for key in KEYS:
        one, other = (several(summary.get(key, [])) for summary in (mine, theirs))
        if len(one) != len(other) or [math.isnan(x) for x in one] != [math.isnan(x) for x in other]:
            wrong.append(f"{key} has {one} for {other}")
            continue
        scale = load if key in (*LOADS, *SPRING_LOADS) else law.length
        if key in ENERGIES:
            scale = 0.0
        for i, (a, b) in enumerate(zip(one, other)):
            if math.isnan(a):
                continue
            size = max(abs(b), scale)
            allowed, known = (of_number(summary, key, i, size) for summary in (mine, theirs))
            if abs(a - b) > WELL_ABOVE * known:
                deviations.append(Deviation(key, b, abs(a - b), allowed))
            else:
                unknown += 1
    wrong += contradictions(theirs, load * law.length)
    return Finding(scene, deviations, unknown, wrong, **cost)


def contradictions(summary, unit):
    """Energies lost in the jumps of a spring's cycle that are not its area."""
    pairs = zip(*(several(summary.get(f"device_{name}", [])) for name in (
        "energy_lost", "cycle_energy")))
    return [f"energy {lost} is not the area {area}" for lost, area in pairs
            if abs(lost - area) > TWO_WAYS * abs(area) + NARROW * unit]


def of_number(summary, key, i, size):
    """The estimate of a number: its own, otherwise the common estimate times the size."""
    for name in (f"{key}_error", f"{key}_uncertainty"):
        errors = several(summary.get(name, []))
        if i < len(errors):
            return errors[i]
    return summary.get("error_estimate", 0.0) * size


def is_warned(finding):
    """Whether a run warns that it is less accurate than requested."""
    return any("resolve" in said or "error" in said for said in finding.warnings)


def table(findings):
    """Lines of a report: errors and estimates, and what the scenes cost."""
    lines = comparison.table((named(f.scene), f.scene.kind, f) for f in findings)
    unknown = sum(finding.unknown for finding in findings)
    compared = sum(bool(f.deviations) or f.unknown > 0 for f in findings)
    seconds = [f.seconds for f in findings]
    return [
        *lines,
        f"scenes {len(findings)}, compared {compared}; numbers as good as the truth {unknown}",
        f"seconds: median {np.median(seconds):.2g}, 99 % "
        f"{np.quantile(seconds, 0.99, method='higher'):.2g}, largest {max(seconds):.2g}; "
        f"with a warning on the mesh or the error {sum(map(is_warned, findings))}, lost "
        f"{sum(bool(f.wrong) for f in findings)}"]


def named(scene):
    return (f"scene {scene.number} of seed {scene.seed}: {scene.law}, sigma {scene.sigma:g}, "
            f"{scene.kind}, accuracy {scene.accuracy:g},")
