"""The energy lost in a cycle, and how well a run says that it knows it."""

from typing import NamedTuple

import numpy as np
from support.comparison import floor
from support.decks_in_units import report, said
from support.reference import CUSP, Path

ACCURACIES = (1e-3, 1e-4, 1e-6, 1e-8)
DEPTH = -4.0


class Job(NamedTuple):
    sigma: float
    accuracies: tuple
    folder: object


class Finding(NamedTuple):
    """One run: relative error of the energy, and the error over the uncertainty reported; 0 where
    the reference does not know better."""

    sigma: float
    accuracy: float
    energy: float
    relative: float
    ratio: float
    wrong: str


def jobs(count, folder, *, low=0.3, high=1e3, accuracies=ACCURACIES):
    """Strengths from just above the cusp, a third of them below 0.6."""
    dense = np.linspace(low, 0.6, count // 3)
    wide = np.geomspace(0.65, high, count - count // 3)
    return [
        Job(float(f"{sigma:.6g}"), accuracies, folder / f"{sigma:g}") for sigma in (*dense, *wide)]


def examine(job):
    """The path at every accuracy."""
    assert job.sigma > CUSP
    true = Path(job.sigma, DEPTH).energy_lost
    return [examined(job, true, accuracy) for accuracy in job.accuracies]


def examined(job, true, accuracy):
    """One run against the true energy."""
    groups = {"equilibrium_path": {"h0_end": DEPTH}, "numerics": {"accuracy": accuracy}}
    found = report(job.sigma, groups, job.folder, f"energy{accuracy:g}")
    if found.status != 0 or "energy_lost" not in found.numbers:
        return Finding(job.sigma, accuracy, true, 1.0, 0.0, f"{said(found)}, no energy")
    error = abs(found.numbers["energy_lost"] - true)
    allowed = found.errors.get("energy_lost", 0.0)
    if error <= floor("energy_lost", job.sigma) * true:
        ratio = 0.0
    else:
        ratio = error / allowed if allowed else float("inf")
    return Finding(job.sigma, accuracy, true, error / true, ratio, "")


def table(findings):
    """Lines of a report: a line a strength, error (error over uncertainty) at each accuracy."""
    accuracies = sorted({f.accuracy for f in findings}, reverse=True)
    lines = ["sigma     energy/(gamma R z0)   relative error (over the uncertainty) at accuracy"]
    lines.append(" " * 30 + "".join(f"{accuracy:>20g}" for accuracy in accuracies))
    for sigma in dict.fromkeys(f.sigma for f in findings):
        mine = [f for f in findings if f.sigma == sigma]
        cells = "".join(
            f"{f.wrong or f'{f.relative:.1e} ({f.ratio:.1e})':>20}"
            for accuracy in accuracies
            for f in mine
            if f.accuracy == accuracy
        )
        lines.append(f"{sigma:<10g} {mine[0].energy:<18.9g} {cells}")
    beyond = [f for f in findings if f.ratio > 1]
    worst = max(findings, key=lambda f: f.ratio)
    lines.append(
        f"runs {len(findings)}, failed {sum(bool(f.wrong) for f in findings)}, error beyond the "
        f"uncertainty {len(beyond)}, at most {worst.ratio:.1e} times at sigma {worst.sigma:g}; "
        f"error above the accuracy {sum(f.relative > f.accuracy for f in findings)}"
    )
    return lines
