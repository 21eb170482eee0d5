#!/usr/bin/env python3
"""Fits curves of the independent model together, and counts how often intervals hold the truth.

    .venv/bin/python tools/verify/joint_curves.py [--fits 100] [--seed 0]

Each fit has two to six curves of one modulus and radius, alternately of other works of adhesion
(shared: the modulus), and of the same work of adhesion with other springs (shared: both). Noise,
samples, outliers and baselines differ from curve to curve, and the starting values are wrong by
factors up to three. Wrong is a value more than six standard errors off.
"""

import argparse
import math
import pathlib
import sys

import numpy as np
import snapin
from snapin.command import as_command

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.append(str(ROOT / "tests"))

from many_curves import FAR, KEYS, share  # noqa: E402
from support.reference_curves import RADIUS, Z0, measure, truth  # noqa: E402
from support.study_fits import cpu  # noqa: E402

ENERGY, STIFFNESS, POINT = KEYS
MODULUS = 1e10
# Strengths of adhesion of the curves of one fit, for one modulus: Tabor's parameters 0.7 to 12.
SIGMAS = (0.3, 1.0, 3.0, 10.0, 20.0)


def of_modulus(sigma, softness):
    """The bodies of a strength of adhesion that have the modulus."""
    return truth(sigma, softness, MODULUS / min(1.0, 5 / sigma))


def draw(number, rng):
    """The true bodies of the curves of a fit, its shared and its own parameters."""
    count = rng.integers(2, 7)
    if number % 2:
        sigma = rng.choice(SIGMAS)
        return ([of_modulus(sigma, 10 ** rng.uniform(-0.5, 0.7)) for _ in range(count)],
                [ENERGY, STIFFNESS], [POINT])
    softness = 10 ** rng.uniform(-0.5, 0.7)
    return [of_modulus(sigma, softness) for sigma in rng.choice(SIGMAS, count)], [
        STIFFNESS], [ENERGY, POINT]


def fit(number, seed):
    """Fit one set of curves together: whether each interval holds the truth and how many standard
    errors each value is off, for shared and own parameters; the verdicts; whether it disagrees."""
    rng = np.random.default_rng((seed, number))
    bodies, shared, own = draw(number, rng)
    curves = [measure(true, int(10 ** rng.uniform(2, 2.7)), 10 ** rng.uniform(-2, -1.3), rng,
                      rng.choice([0.0, 0.01])) for true in bodies]
    off = 3 ** rng.uniform(-1, 1, 2)
    energy = math.exp(np.mean([math.log(true.energy) for true in bodies]))
    fits = snapin.fit_many(
        [(curve.z, curve.force, curve.segment) for curve in curves], shared=shared, own=own,
        spring_constant=[true.spring for true in bodies], deck={
            "bodies": {"radius": RADIUS, "stiffness": MODULUS * off[0]},
            "force": {"law": "lennard_jones", "z0": Z0, "work_of_adhesion": energy * off[1]},
            "numerics": {"accuracy": 1e-4}})
    truths = [{ENERGY: true.energy, STIFFNESS: true.stiffness, POINT: 0.0} for true in bodies]
    found = [(key, fits.shared.estimate[key], fits.shared.standard_error[key],
              fits.shared.interval_95[key], truths[0][key]) for key in shared]
    for key in own:
        found += [(key, fits.estimate[key][i], fits.standard_error[key][i],
                   fits.interval_95[key][i], truths[i][key]) for i in range(len(bodies))]
    rows = [(key in shared, key, low <= true <= high, (value - true) / error)
            for key, value, error, (low, high), true in found]
    return rows, list(fits.table["verdict"]), bool(fits.shared.warnings)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--fits", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    began, rows, verdicts, apart = cpu(), [], [], 0
    for number in range(options.fits):
        new, said, disagree = fit(number, options.seed)
        rows += new
        verdicts += said
        apart += disagree
        wrong = [f"{key} {off:+.1f}" for _, key, _, off in new if not abs(off) < FAR]
        odd = [word for word in said if word != "described"]
        print(f"{number:4d} {len(said)} curves", *wrong, *odd, "disagree" * disagree, flush=True)
    print(f"{options.fits} fits of {len(verdicts)} curves, {cpu() - began:.0f} s; of the curves "
          f"{verdicts.count('described')} described, {verdicts.count('warned')} warned; called "
          f"disagreeing: {apart} fits")
    for is_shared in (True, False):
        for key in KEYS:
            mine = [row for row in rows if row[0] == is_shared and row[1] == key]
            if mine:
                print(f"{'shared' if is_shared else 'own':7s}{key:28s}{len(mine):5d} intervals "
                      f"hold {share([row[2] for row in mine])}, wrong "
                      f"{sum(not abs(row[3]) < FAR for row in mine)}, rms of errors "
                      f"{np.sqrt(np.mean([row[3] ** 2 for row in mine])):.2f}")


if __name__ == "__main__":
    sys.exit(as_command(main)())
