#!/usr/bin/env python3
"""Count how often the intervals of a fit contain the truth, for curves of an independent solution.

    .venv/bin/python tools/bench/coverage.py [--curves 40] [--first 0] [--wrong]

Strength of adhesion, spring, noise, number of samples, outliers and where the search starts are
drawn for each curve by its number. A fit arrives if no estimate is 6 standard errors off.
--wrong fits with z0 fixed at twice the truth, which the fit must detect. Rows go to standard
output, followed by the table.
"""

import argparse
import math
import pathlib
import sys
import tempfile
import time
import warnings

import numpy as np
import snapin

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.append(str(ROOT / "tests"))

from snapin.command import as_command  # noqa: E402
from support.measured import write  # noqa: E402
from support.reference_curves import RADIUS, Z0, Driven, measure, truth  # noqa: E402

SIGMAS = (0.05, 0.3, 1.0, 5.0, 20.0, 60.0, 200.0)
KEYS = ("force.surface_energy", "bodies.stiffness", "measurement.contact_point", "force.z0")
WRONG = "does not describe"


class Case:
    """A curve, by its number, and the deck that fits it."""

    def __init__(self, number, wrong=False):
        rng = np.random.default_rng(number)
        self.number = number
        while True:
            self.true = truth(SIGMAS[rng.integers(len(SIGMAS))], 10 ** rng.uniform(-0.7, 1))
            self.noise = 10 ** rng.uniform(math.log10(0.003), math.log10(0.05))
            self.samples = int(10 ** rng.uniform(2, 4))
            self.outliers = rng.choice([0.0, 0.01, 0.05])
            self.off = 10 ** rng.uniform(-1, 1, 3)
            self.with_z0 = bool(rng.random() < 0.5) and not wrong
            driven = Driven(self.true)
            travel = 1.5 * (driven.jump_out + 1.7 * driven.pull_off / self.true.spring)
            self.step = self.true.spring * travel / self.samples / (self.noise * driven.pull_off)
            if 0.05 <= self.step <= 50:
                break
        self.curve = measure(self.true, self.samples, self.noise, rng, self.outliers)
        self.z0 = 2 * Z0 if wrong else Z0 * (self.off[2] ** 0.5 if self.with_z0 else 1)

    def deck(self, file):
        return {
            "bodies": {"radius": RADIUS, "stiffness": self.true.stiffness * self.off[1]},
            "force": {"law": "lennard_jones", "z0": self.z0,
                      "surface_energy": self.true.energy * self.off[0]},
            "measurement": {"file": file, "columns": ["z", "force", "segment"],
                            "spring_constant": self.true.spring},
            "fit": {"parameters": list(KEYS[:4 if self.with_z0 else 3])},
            "numerics": {"accuracy": 1e-4},
        }

    @property
    def truths(self):
        return np.array([self.true.energy, self.true.stiffness, 0.0, Z0][:4 if self.with_z0 else 3])


class Outcome:
    def __init__(self, case):
        began = time.perf_counter()
        with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
            warnings.simplefilter("ignore", snapin.SnapinWarning)
            curve = case.curve
            file = write(f"{folder}/curve.csv", curve.z, curve.force, curve.segment, digits=6)
            fitted, self.warnings = None, []
            try:
                result = snapin.run(case.deck(file))
                fitted, self.warnings = result.fitted, list(result.summary.get("warnings", []))
            except snapin.SnapinError as refused:
                self.warnings = [str(refused)]
        self.seconds = time.perf_counter() - began
        # Errors over standard errors; those of numbers that are positive from their logarithms.
        self.off = np.full(len(case.truths), np.inf)
        self.reduced = self.noise = math.nan
        if fitted:
            fit = fitted["fit"]
            estimate, error = np.array(fit["estimate"]), np.array(fit["standard_error"])
            with np.errstate(all="ignore"):
                far = np.where(case.truths == 0, estimate,
                               np.log(estimate / case.truths) * estimate)
            self.off = far / error
            self.reduced = fit["chi_squared"][0] / fit["degrees_of_freedom"][0]
            self.noise = fit["noise"][0] / curve.noise
        self.arrived = bool(np.abs(self.off).max() < 6)
        self.found_wrong = any(WRONG in text for text in self.warnings)


def line_of(case, outcome):
    start = " ".join(f"{x:5.2f}" for x in case.off[:len(outcome.off)])
    return (f"{case.number:5} sigma {case.true.sigma:6g} k dz/noise {case.step:6.2f} noise "
            f"{100 * case.noise:4.1f} % samples {case.samples:5} "
            f"outliers {100 * case.outliers:2.0f} % start {start} off "
            f"{' '.join(f'{x:7.2f}' for x in outcome.off)} left {outcome.reduced:7.3f} noise "
            f"{outcome.noise:5.2f} {'WRONG' if outcome.found_wrong else ''} "
            f"{outcome.seconds:5.1f} s")


def share(rows):
    return f"{np.mean(rows):6.1%} of {len(rows)}" if len(rows) else "none"


def report(cases, outcomes):
    print("arrived", share([o.arrived for o in outcomes]))
    print("called wrong", share([o.found_wrong for o in outcomes]))
    seconds = [o.seconds for o in outcomes]
    print(f"seconds: median {np.median(seconds):.1f}, largest {max(seconds):.1f}")
    steps = np.array([case.step for case in cases])
    edges = np.quantile(steps, [0, 0.25, 0.5, 0.75, 1])
    for low, high in zip(edges[:-1], edges[1:]):
        inside = [o for c, o in zip(cases, outcomes) if low <= c.step <= high]
        columns = [[abs(o.off[i]) < 1.96 for o in inside if len(o.off) > i]
                   for i in range(len(KEYS))]
        print(f"k dz/noise {low:.2f} to {high:.2f}: 95 % intervals hold",
              ", ".join(f"{key.split('.')[1]} {share(rows)}" for key, rows in zip(KEYS, columns)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--curves", type=int, default=40)
    parser.add_argument("--first", type=int, default=0, help="number of the first curve")
    parser.add_argument("--wrong", action="store_true", help="hold z0 at twice the truth")
    options = parser.parse_args()
    cases, outcomes = [], []
    for number in range(options.first, options.first + options.curves):
        cases.append(Case(number, options.wrong))
        outcomes.append(Outcome(cases[-1]))
        print(line_of(cases[-1], outcomes[-1]), flush=True)
    report(cases, outcomes)


if __name__ == "__main__":
    sys.exit(as_command(main)())
