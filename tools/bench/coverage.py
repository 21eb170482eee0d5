#!/usr/bin/env python3
"""How often the intervals of a fit hold the truth: many noisy force curves, each fitted.

    .venv/bin/python tools/bench/coverage.py [--curves 500] [--samples 300] [--known]

For each parameter it prints in how many of the curves the true value lies within 1.96 standard
errors of the estimate, of which 95 % are expected, and within one, 68 %.
"""

import argparse
import pathlib
import sys
import tempfile
import warnings

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tests"))

import snapin  # noqa: E402
from support.measured import LENNARD_JONES, Branches, fit_deck, write  # noqa: E402

TRUTH = {"force.hamaker": 1e-19, "bodies.stiffness": 1e10, "measurement.contact_point": 0.0}


def deviations(curves, samples, noise, known):
    """Return (estimate - truth)/standard error, a row a curve, and chi squared over its freedom."""
    branches = Branches(LENNARD_JONES)
    keys = {"noise": noise} if known else {}
    rows, left = [], []
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore", snapin.SnapinWarning)
        for seed in range(curves):
            file = write(f"{folder}/curve.csv", *branches.measure(samples, noise, seed))
            fit = snapin.run(fit_deck(LENNARD_JONES, file, list(TRUTH), keys,
                                      numerics={"accuracy": 1e-5})).fitted["fit"]
            rows.append((fit["estimate"] - list(TRUTH.values())) / fit["standard_error"])
            left.append(fit["chi_squared"][0] / fit["degrees_of_freedom"][0])
    return np.array(rows), np.array(left)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--curves", type=int, default=500)
    parser.add_argument("--samples", type=int, default=300, help="on each way")
    parser.add_argument("--noise", type=float, default=1e-11, help="standard deviation [N]")
    parser.add_argument("--known", action="store_true", help="tell the fit the noise")
    options = parser.parse_args()
    rows, left = deviations(**vars(options))
    print(f"{options.curves} curves, chi squared over its freedom {left.mean():.3f}")
    for name, off in zip(TRUTH, np.abs(rows).T):
        print(f"{name:28} {np.mean(off < 1.96):7.1%} within 1.96, {np.mean(off < 1):7.1%} within 1 "
              f"standard error, root mean square {np.sqrt(np.mean(off**2)):.2f}, "
              f"largest {off.max():.1f}")


if __name__ == "__main__":
    main()
