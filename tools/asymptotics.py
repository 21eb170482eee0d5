#!/usr/bin/env python3
"""Renew docs/table_lennard_jones.csv and the table of docs/asymptotics.md: some seconds.

    ./run inputs/table_lennard_jones.nml && .venv/bin/python tools/asymptotics.py
"""

import csv
import math
import pathlib
import re
import sys

import pages

DOCS = pages.ROOT / "docs"
EVERY = 8
# Radius and z0 of the deck [m].
RADIUS, Z0 = 1.5e-2, 0.5e-9
HEADER = ("σ", "pull-off/JKR", "jump-in h0", "load", "jump-out h0", "load", "energy lost/(γ R z0)",
          "error estimate")


def rows(path):
    """Return the rows of a sweep, a dict of numbers each."""
    lines = [line for line in path.read_text(encoding="utf-8").splitlines()
             if not line.startswith("#")]
    return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(lines)]


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
    found = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else default
    if not found.is_file():
        sys.exit(f"no {found}; first: ./run inputs/table_lennard_jones.nml")
    table = rows(found)
    if not all(row["converged"] == 1 for row in table):
        sys.exit(f"{found}: not every case converged")
    (DOCS / "table_lennard_jones.csv").write_bytes(found.read_bytes())
    lines = ["| " + " | ".join(HEADER) + " |", "|" + "---|" * len(HEADER)]
    lines += ["| " + " | ".join(cells(row)) + " |" for row in table[::EVERY]]
    page = DOCS / "asymptotics.md"
    text = page.read_text(encoding="utf-8")
    new = re.sub(r"(<!-- table -->\n).*?(<!-- /table -->)",
                 lambda match: match[1] + "\n".join(lines) + "\n" + match[2], text, flags=re.S)
    page.write_text(new, encoding="utf-8")
    pages.mark(page)


if __name__ == "__main__":
    main()
