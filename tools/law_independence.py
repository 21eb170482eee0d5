#!/usr/bin/env python3
"""Renew the table of docs/forces.md that compares pull-offs under different laws: seconds.

    .venv/bin/python tools/law_independence.py
"""

import math
import warnings

import pages
import snapin

PAGE = pages.ROOT / "docs" / "forces.md"
# Work of adhesion, radius and equilibrium separation are 1.
RANGES = (0.2, 0.5, 1, 2, 5)
LAWS = {
    **{f"{n:g}, {m:g}": {"force": {"law": "lennard_jones", "surface_energy": 1.0, "z0": 1.0,
                                   "exponents": [n, m]}}
       for n, m in ((9.0, 3.0), (10.0, 4.0), (12.0, 6.0), (6.0, 3.0))},
    "Morse": {"morse": {"surface_energy": 1.0, "z0": 1.0, "decay_length": 0.5}},
}


def pull_offs(law, tabor, accuracy=1e-8):
    """Return the largest tension over pi w R, and that of Maugis-Dugdale theory, under a law.

    tabor: Tabor's parameter with the law's range, the surface energy over the largest tension.
    """
    edge = snapin.law_numbers(law).edge_gap
    reach = -1 / snapin.force_law(law, [edge]).pressure[0]
    modulus = (tabor * reach) ** -1.5
    with warnings.catch_warnings():
        # R is 1, and so is the equilibrium separation.
        warnings.simplefilter("ignore", snapin.SnapinWarning)
        summary = snapin.run({
            "bodies": {"radius": 1.0, "stiffness": 2 * modulus}, **law,
            "equilibrium_path": {"h0_end": -1.0}, "regime": {}, "classical": {},
            "numerics": {"accuracy": accuracy}}).summary
    if abs(summary["regime_tabor_range"] / tabor - 1) > 1e-9:
        raise ArithmeticError(f"Tabor's parameter is {summary['regime_tabor_range']}, not {tabor}")
    return summary["max_tension"] / math.pi, summary["maugis_pull_off"] / math.pi


def table():
    names = ("by range", "Maugis-Dugdale", *LAWS)
    rows = []
    for tabor in RANGES:
        found = [pull_offs(law, tabor) for law in LAWS.values()]
        cells = [found[0][1], *(tension for tension, _ in found)]
        rows.append([f"{tabor:g}", *(f"{cell:.5f}" for cell in cells)])
    return pages.table(names, rows)


if __name__ == "__main__":
    pages.insert(PAGE, "laws", table(), "tools/law_independence.py")
