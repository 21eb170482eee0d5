#!/usr/bin/env python3
"""Renew docs/table_lennard_jones.csv and the table of docs/asymptotics.md: some seconds.

    ./run inputs/table_lennard_jones.nml && .venv/bin/python tools/asymptotics.py
"""

import math
import pathlib
import sys

import pages
from snapin import read_results

DOCS = pages.ROOT / "docs"
EVERY = 8
# Radius and z0 of the deck [m].
RADIUS, Z0 = 1.5e-2, 0.5e-9
HEADER = ("σ", "pull-off/JKR", "jump-in h0", "load", "jump-out h0", "load", "energy lost/(γ R z0)",
          "error estimate")


def cells(row):
    """Return a row of the page: gaps in z0, loads in gamma R."""
    load = row["surface_energy"] * RADIUS

    def shown(value, digits):
        return "–" if math.isnan(value) else f"{value:.{digits}f}"

    return (f"{row['sigma']:.4g}",
            shown(row["max_tension"] / row["jkr_pull_off"], 8),
            shown(row["jump_in_h0"] / Z0, 6), shown(row["jump_in_load"] / load, 6),
            shown(row["jump_out_h0"] / Z0, 6), shown(row["jump_out_load"] / load, 6),
            shown(row["energy_lost"] / (load * Z0), 4), f"{row['error_estimate']:.0e}")


def main():
    """Copy the sweep and rewrite the page's table."""
    default = pages.ROOT / "results" / "table_lennard_jones" / "sweep.csv"
    file = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else default
    if not file.is_file():
        sys.exit(f"no {file}; first: ./run inputs/table_lennard_jones.nml")
    sweep = read_results(file.parent).sweep
    if not (sweep["converged"] == 1).all():
        sys.exit(f"{file}: not every case converged")
    (DOCS / "table_lennard_jones.csv").write_bytes(file.read_bytes())
    pages.insert(DOCS / "asymptotics.md", "table",
                 pages.table(HEADER, [cells(row) for row in sweep[::EVERY]]),
                 "tools/asymptotics.py")


if __name__ == "__main__":
    main()
