"""True and estimated errors, number by number, for paths and cycles of any strength."""

from typing import NamedTuple

import numpy as np
from support import comparison
from support.comparison import deviations, missing
from support.decks_in_units import report, said
from support.experiment import cycle, reported, reported_of_path
from support.reference import Path
from support.scenes import loading

ACCURACIES = (1e-3, 1e-4, 1e-6, 1e-8)
DEPTH = -4.0


class Job(NamedTuple):
    sigma: float
    accuracies: tuple
    folder: object


class Finding(NamedTuple):
    """One deck: its error estimate, its deviations, and other errors."""

    sigma: float
    kind: str
    accuracy: float
    estimate: float
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
            findings.append(Finding(job.sigma, kind, accuracy, found.estimate, off, wrong))
    return findings


def table(findings):
    """Lines of a report, and how many errors are above the requested accuracy."""
    lines = comparison.table(
        (f"sigma {f.sigma:g} {f.kind} {f.accuracy:g}", f.kind, f) for f in findings)
    above = sum(one.relative > f.accuracy for f in findings for one in f.deviations)
    return [*lines, f"decks {len(findings)}, failed or with a number missing or invented "
            f"{sum(bool(f.wrong) for f in findings)}, errors above the accuracy {above}"]
