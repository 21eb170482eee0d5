"""Random cycles against the reference: for any steps, the numbers are those of the path.

A job is a strength with a few decks of it; deck k of a seed is always the same deck.
"""

import collections
import math
import random
from typing import NamedTuple

from support.comparison import deviations, missing
from support.decks_in_units import PLAIN, REAL, report, said
from support.experiment import cycle, reported
from support.reference import Path
from support.scenes import loading

# A default deck is accurate to 1e-6; ten times this is wrong. The place of a flat extremum is less
# accurate.
WRONG, WRONG_PLACE = 1e-5, 1e-3
# At this distance from a fold or a tie, both decisions of the program are right.
UNDECIDED = 1e-4
MOST_STATES = 400
# The last h0 of most loadings, and of some deeper loadings, in z0.
DEEPEST, ABYSS = -10.0, (-30.0, -5000.0)


class Job(NamedTuple):
    """A strength, the depth of its loadings, and the numbers of its decks."""

    sigma: float
    deepest: float
    decks: tuple
    seed: int
    folder: object


class Finding(NamedTuple):
    """The errors of a deck: kinds of error, each with a line; and its deviations."""

    sigma: float
    deck: int
    wrong: dict
    deviations: list
    text: str


def jobs(count, folder, *, seed=1, low=1e-3, high=1e3, each=8):
    """Random strengths with a uniform logarithm."""
    rng = random.Random(f"strengths {seed} {low} {high}")
    starts = range(0, count, each)
    return [
        Job(
            float(f"{logarithmic(rng, low, high):.6g}"),
            -logarithmic(rng, *(-h0 for h0 in ABYSS)) if rng.random() < 0.2 else DEEPEST,
            tuple(range(first, min(first + each, count))), seed, folder / f"job{first}")
        for first in starts
    ]


def logarithmic(rng, low, high):
    """A number whose logarithm is uniform."""
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def reach_of(sigma):
    """Beyond the jump out."""
    return 3 + 3.5 * sigma ** (2 / 3)


def drawn(sigma, deepest, deck, seed):
    """Start, end, step, turning points, end and step of the retreat."""
    rng = random.Random(f"{seed} {deck}")
    far = reach_of(sigma)
    start = far * rng.uniform(0.3, 1.5) if rng.random() < 0.85 else rng.uniform(-4, 4)
    low = deepest if rng.random() < 0.7 else start - 0.7 * far
    end = rng.uniform(max(deepest, min(low, start - 0.5)), start - 0.3)
    step = drawn_step(rng, start - end)
    turning, retreat, back = [], None, step
    if rng.random() < 0.85:
        turning = [end] if rng.random() < 0.5 else []
        turning += [rng.uniform(end, start) for _ in range(rng.choice([0, 1, 1, 2, 3]))]
        turning = turning or [end]
        top = max(turning)
        retreat = top + (1.5 * far - top) * rng.uniform(0.1, 1) if top < far else top + 1.0
        if rng.random() < 0.5:
            back = drawn_step(rng, retreat - min(turning))
    return start, end, step, turning, retreat, back


def drawn_step(rng, span):
    """A random step, from fine to longer than the range, with a limit of the number of states."""
    way = rng.random()
    if way < 0.5:
        step = logarithmic(rng, 0.02, 5)
    elif way < 0.9:
        step = span * 10 ** rng.uniform(-2.5, -0.3)
    else:
        step = span * rng.uniform(0.4, 3)
    return max(step, span / MOST_STATES)


def ambiguous(path, places):
    """Whether an end is so close to a fold that both answers are right."""
    return any(abs(h0 - fold.h0) < UNDECIDED for h0 in places for fold in path.folds)


def examine(job):
    """The findings of a job: one for each deck that is not ambiguous."""
    path = Path(job.sigma, 1.05 * job.deepest, 2 * reach_of(job.sigma) + 2)
    return [
        examined(path, drawn(job.sigma, job.deepest, deck, job.seed), job.folder, deck)
        for deck in job.decks
    ]


def examined(path, scene, folder, deck=0):
    """One deck against its path; decks with odd numbers are in metres."""
    sigma = path.sigma
    start, end, step, turning, retreat, back = scene
    groups = {"loading": loading(start, end, step)}
    if turning:
        groups["unloading"] = {
            "from_": [float(x) for x in turning], "h0_end": float(retreat), "h0_step": float(back),
        }
    expected = cycle(path, start, end, turning, retreat)
    units = REAL if deck % 2 else PLAIN
    found = report(sigma, groups, folder, f"deck{deck}", rows=True, units=units)
    text = f"loading {start:.6g} to {end:.6g} by {step:.3g}, from {[f'{x:.6g}' for x in turning]}"
    text += f" to {retreat:.6g} by {back:.3g}" if turning else ""
    if ambiguous(path, [start, end, *turning, *([retreat] if turning else [])]):
        return Finding(sigma, deck, {}, [], text + " (undecided)")
    return judged(path, sigma, expected, found, deck, text)


def judged(path, sigma, expected, found, deck, text):
    numbers = reported(expected)
    wrong = {}
    if found.status != 0:
        wrong["status"] = said(found)
        return Finding(sigma, deck, wrong, [], text)
    for line in missing(found, numbers):
        wrong.setdefault(line.split(" has ")[0].split()[0] + " missing or invented", line)
    off = deviations(found, numbers, path)
    for one in off:
        limit = WRONG_PLACE if "tension_h0" in one.key else WRONG
        if not one.relative <= limit:
            wrong.setdefault(one.key, f"off by {one.relative:.1e}, should be {one.value:.9g}")
    line = rows_off(path, expected, found.rows)
    if line:
        wrong["rows"] = line
    return Finding(sigma, deck, wrong, off, text)


def rows_off(path, expected, table):
    """The first, middle and last states of each branch: whether they are on the right branch."""
    branches = [("loading", expected.loading)]
    branches += [(f"unloading_{k + 1}", legs) for k, legs in enumerate(expected.unloadings)]
    for name, legs in branches:
        rows = table.rows(name)
        if len(rows) == 0:
            return f"{name} has no rows"
        for i in sorted({0, len(rows) // 3, len(rows) // 2, len(rows) - 1}):
            h0, load = rows["h0"][i], rows["load"][i]
            loads = [true_load(path, leg, h0) for leg in legs]
            near = [abs(load - x) for x in loads if x is not None]
            if not near or not min(near) <= WRONG * max(abs(load), abs(path.pull_off.load)):
                return f"{name} at h0 {h0:.9g} has load {load:.9g}, not {loads}"
    return ""


def true_load(path, leg, h0):
    """The load at h0 on a leg, or None if the leg does not contain h0."""
    low, high = sorted((leg.first.h0, leg.last.h0))
    if not low - 1e-9 <= h0 <= high + 1e-9:
        return None
    branch = path.far_branch if leg.first.place <= path.far_branch.last.place else None
    if branch is None or leg.last.place > path.far_branch.last.place:
        branch = path.contact_branch
    found = path.on(branch, min(max(h0, low), high))
    return found and found.load


def table(findings):
    """Lines of a report: the number of wrong decks and the kinds of error."""
    decided = [f for f in findings if "(undecided)" not in f.text]
    kinds = collections.Counter(kind for f in decided for kind in f.wrong)
    bad = [f for f in decided if f.wrong]
    lines = [f"decks {len(decided)}, undecided {len(findings) - len(decided)}, wrong {len(bad)}"]
    lines += [f"  {kind:<44} {count:5d}" for kind, count in kinds.most_common()]
    for kind in kinds:
        shown = [f for f in bad if kind in f.wrong][:2]
        lines += [f"    sigma {f.sigma:g} {f.text}: {kind}: {f.wrong[kind]}" for f in shown]
    return lines
