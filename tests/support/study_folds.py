"""States just before and beyond a fold: no state before it may jump, every state beyond it must.

The distance is that from the program's own fold, which a first run of the same range reports, and
in the reference that from its own fold: the two folds differ by the error of the program's mesh.
The first run has profiles if the later runs have profiles, since profiles need a finer mesh.
"""

import collections
from typing import NamedTuple

import numpy as np
from support.comparison import deviations, missing
from support.decks_in_units import report, said
from support.experiment import cycle, reported
from support.reference import Path
from support.scenes import loading

DEPTH = -4.0
# Default decks are accurate to 1e-6. Near a fold the load varies as the root of the distance: this
# part of its difference from the load of the fold may be wrong (at 1e-8 z0 the fold, accurate to
# rounding and the tolerance of the solver, moves by a part of the distance).
WRONG, WRONG_BESIDE = 1e-5, 0.1
WAYS = {"in": ("step", "turning point", "profile"), "out": ("step", "profile")}


class Job(NamedTuple):
    """A strength, an accuracy, an experiment ('cycle' or 'path') and the distances 10^-k."""

    sigma: float
    accuracy: float
    experiment: str
    powers: tuple
    folder: object


class Finding(NamedTuple):
    sigma: float
    accuracy: float
    experiment: str
    fold: str
    way: str
    side: int
    power: int
    wrong: list


def jobs(count, folder, *, low=0.3, high=1e3, accuracies=(1e-4, 1e-6), powers=tuple(range(1, 9))):
    """Strengths evenly spaced in their logarithm."""
    strengths = [float(f"{sigma:.6g}") for sigma in np.geomspace(low, high, count)]
    return [
        Job(sigma, accuracy, experiment, powers, folder / f"{experiment}{sigma:g}_{accuracy:g}")
        for sigma in strengths
        for accuracy in accuracies
        for experiment in ("cycle", "path")
    ]


def examine(job):
    far = 4 + 3.5 * job.sigma ** (2 / 3)
    path = Path(job.sigma, DEPTH, far + 1)
    groups = {"numerics": {"accuracy": job.accuracy}}
    if job.experiment == "cycle":
        groups["loading"] = loading(far, DEPTH, (far - DEPTH) / 40)
        groups["unloading"] = {"from_": [DEPTH], "h0_end": far}
    else:
        groups["equilibrium_path"] = {"h0_end": DEPTH}
    profiled = {**groups, "profiles": {"h0": [DEPTH]}}
    first = {way: report(job.sigma, profiled if way == "profile" else groups, job.folder, way)
             for way in ({*WAYS["in"]} if job.experiment == "cycle" else {"profile"})}
    findings = []
    for fold in ("in", "out"):
        ways = WAYS[fold] if job.experiment == "cycle" else ("profile",)
        theirs = path.jump_in.h0 if fold == "in" else path.jump_out.h0
        width = path.jump_out.h0 - path.jump_in.h0
        for way, power, side in (
                (way, power, side) for way in ways for power in job.powers for side in (1, -1)):
            # A state farther away than the other fold is not near this fold.
            if 10.0**-power > 0.5 * width:
                continue
            mine = first[way].numbers.get(f"jump_{fold}_h0")
            wrong = ["no fold in the first run"]
            if mine is not None:
                place, true = mine + side * 10.0**-power, theirs + side * 10.0**-power
                look = look_at_path if job.experiment == "path" else look_at_cycle
                wrong = look(job, path, groups, fold, way, place, true, far)
            case = (job.sigma, job.accuracy, job.experiment, fold, way, side, power)
            findings.append(Finding(*case, wrong))
    return findings


def look_at_path(job, path, groups, fold, way, place, true, far):
    """All states of the path at h0."""
    found = report(
        job.sigma, {**groups, "profiles": {"h0": [place]}}, job.folder, "deck", rows=True)
    if found.status != 0:
        return [said(found)]
    loads = found.rows["load"][abs(found.rows["h0"] - place) < 1e-13 * max(1, abs(place))]
    wanted = [p.load for p in (path.on(branch, true) for branch in path.branches) if p]
    if len(loads) != len(wanted):
        return [f"{len(loads)} states at h0, not {len(wanted)}"]
    limits = [limit_of(path, fold, load, job.accuracy) for load in wanted]
    off = [abs(mine - load) > limit for mine, load, limit in zip(loads, wanted, limits)]
    return ["load of a state beside the fold"] if any(off) else []


def limit_of(path, fold, load, accuracy):
    at = path.jump_in.load if fold == "in" else path.jump_out.load
    return max(WRONG, 10 * accuracy) * abs(path.pull_off.load) + WRONG_BESIDE * abs(load - at)


def look_at_cycle(job, path, groups, fold, way, place, true, far):
    groups = {name: dict(keys) for name, keys in groups.items()}
    turning = [DEPTH]
    branch, start = ("loading", far) if fold == "in" else ("unloading_1", DEPTH)
    if way == "step":
        group = groups["loading" if fold == "in" else "unloading"]
        group["h0_step"] = abs(start - place) / 20
    elif way == "profile":
        groups["profiles"] = {"h0": [place]}
    else:
        turning = [true, DEPTH]
        groups["unloading"]["from_"] = [place, DEPTH]
    found = report(job.sigma, groups, job.folder, "deck", rows=True)
    if found.status != 0:
        return [said(found)]
    expected = cycle(path, far, DEPTH, turning, far)
    return cycle_off(job, path, expected, found, fold, branch, place, true)


def cycle_off(job, path, expected, found, fold, branch, place, true):
    """The errors: keys, numbers, the state at h0 itself."""
    numbers = reported(expected)
    wrong = missing(found, numbers)
    for one in deviations(found, numbers, path):
        limit = max(WRONG, 10 * job.accuracy)
        if one.key == "unload_max_tension":
            limit = limit_of(path, fold, one.value, job.accuracy) / abs(path.pull_off.load)
        if "tension_h0" not in one.key and not one.relative <= limit:
            wrong.append(f"{one.key} off by {one.relative:.1e}")
    rows = found.rows.rows(branch)
    here = np.flatnonzero(abs(rows["h0"] - place) < 1e-12 * max(1, abs(place)))
    if len(here) != 1:
        return [*wrong, f"{len(here)} rows at h0 in {branch}"]
    beyond = true < path.jump_in.h0 if fold == "in" else true > path.jump_out.h0
    on_contact = beyond if fold == "in" else not beyond
    load = path.on(path.contact_branch if on_contact else path.far_branch, true).load
    mine = rows["load"][here[0]]
    if not abs(mine - load) <= limit_of(path, fold, load, job.accuracy):
        word = "has not jumped" if beyond else "has jumped or is elsewhere"
        wrong.append(f"state {word}: load {mine:.8g}, not {load:.8g}")
    return wrong


def table(findings):
    """Lines of a report: number of wrong decks by experiment, fold and way, and their errors."""
    lines = [f"decks {len(findings)}, wrong {sum(bool(f.wrong) for f in findings)}"]
    kinds = collections.defaultdict(list)
    for f in findings:
        side = "before" if (f.side > 0) == (f.fold == "in") else "beyond"
        kinds[f.experiment, f.fold, f.way, side].append(f)
    for name, ones in sorted(kinds.items()):
        bad = [f for f in ones if f.wrong]
        by_power = collections.Counter(f.power for f in bad)
        powers = ", ".join(f"1e-{k}: {n}" for k, n in sorted(by_power.items()))
        lines.append(f"  {' '.join(name):<36} {len(ones):5d} decks, wrong {len(bad):5d}   {powers}")
        lines += [
            f"      sigma {f.sigma:g} accuracy {f.accuracy:g} 1e-{f.power}: {'; '.join(f.wrong)}"
            for f in bad[:3]
        ]
    return lines
