"""True and estimated errors, number by number, for paths and cycles of any strength."""

import collections
import statistics
from typing import NamedTuple

import numpy as np
from support.comparison import deviations, missing
from support.decks_in_units import report, said
from support.experiment import cycle, reported, reported_of_path
from support.reference import Path
from support.scenes import loading

ACCURACIES = (1e-3, 1e-4, 1e-6, 1e-8)
DEPTH = -4.0


class Job(NamedTuple):
    """A strength, and the requested accuracies."""

    sigma: float
    accuracies: tuple
    folder: object


class Finding(NamedTuple):
    """One deck: its deviations, or other errors."""

    sigma: float
    kind: str
    accuracy: float
    deviations: list
    wrong: list


def jobs(count, folder, *, strengths=None):
    """Strengths from 0.001 to 10000, evenly spaced in their logarithm, or those given."""
    if strengths is None:
        strengths = np.geomspace(1e-3, 1e4, count)
    return [Job(float(f"{sigma:.6g}"), ACCURACIES, folder / f"{sigma:g}") for sigma in strengths]


def energy_jobs(count, folder):
    """Strengths at which energy is lost, a third of them just above the cusp."""
    dense = np.linspace(0.3, 0.6, count // 3)
    wide = np.geomspace(0.65, 1e3, count - count // 3)
    return jobs(count, folder, strengths=(*dense, *wide))


def examine(job):
    """Path and cycle decks at every accuracy."""
    far = 4 + 3.5 * job.sigma ** (2 / 3)
    path = Path(job.sigma, DEPTH, far + 1)
    findings = []
    for accuracy in job.accuracies:
        numerics = {"accuracy": accuracy}
        scenes = {
            "path": ({"equilibrium_path": {"h0_end": DEPTH}}, reported_of_path(path, DEPTH)),
            "cycle": (
                {"loading": loading(far, DEPTH, (far - DEPTH) / 100), "unloading": {}},
                reported(cycle(path, far, DEPTH, [DEPTH], far))),
        }
        for kind, (groups, expected) in scenes.items():
            name = f"{kind}{accuracy:g}"
            found = report(job.sigma, {**groups, "numerics": numerics}, job.folder, name)
            wrong = missing(found, expected)
            if found.status != 0:
                wrong.append(said(found))
            off = deviations(found, expected, path)
            findings.append(Finding(job.sigma, kind, accuracy, off, wrong))
    return findings


def ratio(one, strict=False):
    """True error over the estimated error; None if the reference is not more accurate.

    strict: both are relative to the value itself; the scales of a common estimate have no effect.
    """
    if not one.known:
        return None
    if strict and not one.own:
        scale = one.error / one.relative
        return one.strict / (one.allowed / scale) if one.allowed else float("inf")
    return one.error / one.allowed if one.allowed else float("inf")


def table(findings):
    """Lines of a report: smallest, median and largest ratio of each number."""
    by_key = collections.defaultdict(list)
    for f in findings:
        for one in f.deviations:
            by_key[f.kind, one.key].append((one, f))
    lines = [
        f"{'true error over estimated':<34} {'own':>4} {'number':>6} {'least':>8} {'median':>8} "
        f"{'largest':>8} {'above 1':>8} {'below .01':>9} {'strictly':>9}"
        "   largest at; errors above the accuracy"
    ]
    for (kind, key), ones in sorted(by_key.items()):
        lines.append(row(kind, key, ones))
    wrong = [f for f in findings if f.wrong]
    lines.append(f"decks {len(findings)}, failed or with a number missing or invented {len(wrong)}")
    lines += [
        f"  sigma {f.sigma:g} {f.kind} {f.accuracy:g}: {'; '.join(f.wrong)}" for f in wrong[:12]]
    return lines


def row(kind, key, ones):
    """The line of one number."""
    known = [(ratio(one), one, f) for one, f in ones if ratio(one) is not None]
    above = sum(one.relative > f.accuracy for one, f in ones)
    head = f"{kind + ' ' + key:<34} {'yes' if ones[0][0].own else 'no':>4} {len(ones):6d}"
    if not known:
        return f"{head}   never known worse than by the reference"
    ratios = [r for r, _, _ in known]
    largest = max(known, key=lambda item: item[0])
    strictest = max(ratio(one, strict=True) for _, one, _ in known)
    low, high = sum(r < 0.01 for r in ratios), sum(r > 1 for r in ratios)
    return (
        f"{head} {min(ratios):8.1e} {statistics.median(ratios):8.1e} {largest[0]:8.1e} {high:8d} "
        f"{low:9d} {strictest:9.1e}   "
        f"sigma {largest[2].sigma:g} accuracy {largest[2].accuracy:g}; {above}"
    )
