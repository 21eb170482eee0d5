"""Claims about the table for discrete-element and finite-element programs."""

import numpy as np
import pytest
from support.known import BY_SIGMA
from support.scenes import lennard_jones, loading, path_of


def table_of(run, sigma, h0_end):
    deck = lennard_jones(sigma, equilibrium_path={"h0_end": h0_end}, table={})
    return run(deck).table("table.csv")


def test_stiffness_is_the_slope_of_loads_that_stepping_h0_finds(run):
    retreat = table_of(run, 0.87, -2.0).rows("retreat")
    row, step = np.argmin(abs(retreat["indentation"] - 1)), 1e-3
    h0, stiffness = -retreat["indentation"][row], retreat["stiffness"][row]
    load = run(lennard_jones(0.87, loading=loading(h0 + step, h0 - step, step))).curve["load"]
    assert (load[2] - load[0]) / (2 * step) == pytest.approx(stiffness, rel=1e-5)


def test_branches_fall_and_rise_and_jump_where_the_path_folds(run):
    table = table_of(run, 0.87, -2.0)
    approach, retreat = table.rows("approach"), table.rows("retreat")
    assert (np.diff(approach["indentation"]) >= -1e-9).all()
    assert (np.diff(retreat["indentation"]) <= 1e-9).all()
    _, _, jump_in, _, jump_out, _ = BY_SIGMA[0.87]
    for branch, h0 in ((approach, jump_in), (retreat, jump_out)):
        jump = np.isnan(branch["stiffness"])
        assert jump.sum() == 1
        assert branch["indentation"][jump][0] == pytest.approx(-h0, rel=1e-7)


def test_at_large_sigma_the_dimensionless_columns_are_the_one_curve_of_jkr_theory(run):
    retreat = table_of(run, 1000.0, -200.0).rows("retreat")
    # The radius of the table is where the gap is 1.1 z0, a little inside JKR's edge.
    inside = retreat["contact_radius_jkr"] > 1
    a, load, delta = (
        retreat[f"{name}_jkr"][inside] for name in ("contact_radius", "load", "indentation"))
    np.testing.assert_allclose(load, a**3 - a * np.sqrt(6 * a), rtol=0.02, atol=0.02)
    np.testing.assert_allclose(delta, a**2 - 2 / 3 * np.sqrt(6 * a), rtol=0.02, atol=0.02)


def test_indentation_is_minus_h0_wherever_the_law_has_its_well(run):
    """It was counted from one length before the well."""
    found = run(path_of(1e9, 1.5e-9, radius=1e-6, force=None,
                        morse={"surface_energy": 0.02, "z0": 5e-9, "decay_length": 4e-10},
                        table={}))
    approach = found.table("table.csv").rows("approach")
    assert approach["indentation"][-1] == pytest.approx(-1.5e-9, rel=1e-12)
    jump = np.isnan(approach["stiffness"])
    assert approach["indentation"][jump][0] == pytest.approx(-found.summary["jump_in_h0"], rel=1e-9)


@pytest.mark.parametrize("sigma, h0_start, most", [(0.87, None, 0.05), (2.0, None, 0.05),
                                                   (2.0, 30.0, 2e-3)])
def test_the_first_load_is_nearly_that_of_undeformed_bodies(run, sigma, h0_start, most):
    found = run(lennard_jones(sigma, equilibrium_path={"h0_start": h0_start, "h0_end": -8.0},
                              table={}))
    approach = found.table("table.csv").rows("approach")
    gap, load = -approach["indentation"][0], approach["load"][0]
    rigid = 2 * np.pi * sigma * (gap**-8 - 4 * gap**-2) / 3
    assert 0 < (load - rigid) / rigid < most
    assert rigid - load < 3.5e-3 * found.summary["max_tension"]
