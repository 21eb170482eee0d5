"""Writes references.csv: the results of the reference at many strengths, including slow ones.

    PYTHONPATH=tests .venv/bin/python -m support.tabulate

Each row is computed at two resolutions; `difference` is their largest relative difference.
The numbers are those of the finer resolution, in units of z0 and gamma R.
"""

import csv
import pathlib

import numpy as np
from support.reference import CUSP, Path
from support.series import FINE

FILE = pathlib.Path(__file__).resolve().parent / "references.csv"
# The end of every path.
DEPTH = -4.0
COLUMNS = (
    "max_tension", "max_tension_h0", "jump_in_h0", "jump_in_load", "jump_out_h0", "jump_out_load",
    "energy_lost", "end_load", "end_displacement", "folds", "load_folds",
)  # fmt: skip


def strengths():
    """Strengths from the weakest to the strongest, and dense near the cusp."""
    wide = np.logspace(-3, 4, 43)
    dense = np.concatenate([np.arange(0.25, 0.6, 0.01), np.arange(0.6, 1.5, 0.05)])
    beside = CUSP * (1 + np.array([-1e-2, -1e-3, 1e-3, 3e-3, 1e-2, 2e-2]))
    named = [0.87, 8.7]
    return sorted({float(f"{sigma:.9g}") for sigma in (*wide, *dense, *beside, *named)})


def numbers(path):
    """One row of the table."""
    end = path.on(path.contact_branch, DEPTH)
    pull_off = path.pull_off
    row = [-pull_off.load, pull_off.h0]
    for fold in (path.jump_in, path.jump_out):
        row += [fold.h0, fold.load] if fold else [np.nan, np.nan]
    lost = np.nan if path.energy_lost is None else path.energy_lost
    return [*row, lost, end.load, end.displacement, len(path.folds), len(path.load_folds)]


def main():
    with FILE.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["sigma", *COLUMNS, "difference"])
        for sigma in strengths():
            usual = np.array(numbers(Path(sigma, DEPTH)))
            fine = np.array(numbers(Path(sigma, DEPTH, resolution=FINE)))
            known = fine != 0
            difference = np.nanmax(abs(usual[known] / fine[known] - 1))
            cells = [f"{x:.12g}" for x in fine]
            table.writerow([f"{sigma:.9g}", *cells, f"{difference:.1e}"])
            print(f"{sigma:.9g} {difference:.1e}", flush=True)


if __name__ == "__main__":
    main()
