"""The committed table of the Lennard-Jones contact, and what it shows at both ends."""

import math

import numpy as np
import pytest
from conftest import ROOT
from support.reference import CUSP
from support.scenes import lennard_jones, read_table


def table():
    """The committed table: one dictionary of numbers a row."""
    columns = read_table(ROOT / "docs" / "table_lennard_jones.csv").columns
    rows = zip(*(column.tolist() for column in columns.values()))
    return [dict(zip(columns, row)) for row in rows]


def test_the_table_covers_seven_decades_and_every_case_converged():
    rows = table()
    assert len(rows) >= 40
    assert rows[0]["sigma"] == pytest.approx(1e-3, rel=1e-4)
    assert rows[-1]["sigma"] == pytest.approx(1e4, rel=1e-4)
    assert all(row["converged"] == 1 and row["resolved"] == 1 for row in rows)
    assert max(row["error_estimate"] for row in rows) < 1e-6


@pytest.mark.parametrize("row", [0, 20, 32, 48])
def test_rows_of_the_table_are_what_the_program_computes(run, row):
    expected = table()[row]
    deck = (ROOT / "inputs" / "table_lennard_jones.nml").read_text()
    kept = "".join(line for line in deck.splitlines(True) if not line.startswith("&sweep"))
    kept = kept.replace("hamaker = 1.0e-20", f"hamaker = {expected['force.hamaker']!r}")
    found = run(kept).summary
    # The table's own error, and the interpolation of the curve for the energy.
    for key in ("max_tension", "jump_in_h0", "jump_out_h0", "jump_in_load", "energy_lost"):
        if not math.isnan(expected[key]):
            assert found[key] == pytest.approx(expected[key], rel=1e-6), key


def test_tensions_go_from_dmt_to_jkr_theory():
    rows = table()
    ratio = [row["max_tension"] / row["jkr_pull_off"] for row in rows]
    assert all(np.diff(ratio) < 0)
    assert ratio[0] == pytest.approx(4 / 3, rel=2e-3)
    assert ratio[-1] == pytest.approx(1, rel=1e-5)
    assert rows[-1]["jump_out_load"] == pytest.approx(-5 / 9 * rows[-1]["jkr_pull_off"], rel=1e-5)


def test_jumps_begin_at_the_cusp(run):
    """Near a cusp the folds part as the power 3/2 of the distance to it."""
    sigmas = [0.2925, 0.293, 0.294, 0.296, 0.298]
    gaps = []
    for sigma in sigmas:
        found = run(lennard_jones(sigma, equilibrium_path={"h0_end": -2.0},
                                  numerics={"accuracy": 1e-10})).summary
        gaps.append((found["folds_h0"][1] - found["folds_h0"][0]) ** (2 / 3))
    cusp = np.polynomial.polynomial.polyfit(gaps, sigmas, 4)[0]
    assert cusp == pytest.approx(CUSP, abs=5e-7)
