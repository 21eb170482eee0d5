"""Claims about the rows of approximations.csv: where curves begin and end, and their steps."""

import math

import numpy as np
import pytest
import snapin
from support.scenes import deck
from test_approximations import UNITS, lennard_jones


# --- Rows of approximations.csv


def table(h0_start, h0_end, **kwargs):
    rows = {}
    for row in snapin.approximation_rows(h0_start, h0_end, **kwargs):
        rows.setdefault(str(row["theory"]), []).append(row)
    return rows


def columns(rows):
    """h0, displacement and load of rows, as arrays."""
    return np.array([[row[name] for name in ("h0", "displacement", "load")] for row in rows]).T


FORM = {
    "slow_deformation": "quadrature", "closed_form": "closed_form",
    "attractive_only": "attraction_only"}
JUMPS = ["jump_criterion_29", "jump_equation_37", "fold_attractive_only", "fold_closed_form"]


def test_curves_of_an_attraction_end_where_the_bodies_jump():
    rows = table(14.0, -4.0, **UNITS, law=lennard_jones(8.7), count=50)
    jumps = snapin.jump_estimates(**UNITS, law=lennard_jones(8.7))
    assert list(rows) == [*FORM, *JUMPS]
    for theory, form in FORM.items():
        h0, delta, load = columns(rows[theory])
        assert h0.size == 50
        state = snapin.slow_deformation(h0 + delta, **UNITS, law=lennard_jones(8.7), form=form)
        np.testing.assert_allclose(delta, state.displacement, rtol=1e-12)
        np.testing.assert_allclose(load, state.load, rtol=1e-12)
        end = jumps.equation_37 if theory == "attractive_only" else jumps.criterion
        assert h0[0] == pytest.approx(14, rel=1e-13)
        assert (h0[-1], delta[-1], load[-1]) == pytest.approx(end[1:], rel=1e-11)
        # No part of the curve is left without rows.
        assert (np.diff(h0) < 0).all() and (np.diff(delta) < 0).all()
        steps = -np.diff(h0 + delta) - np.diff(delta)
        np.testing.assert_allclose(steps, steps.mean(), rtol=1e-3)
    assert all(len(rows[name]) == 1 for name in JUMPS)
    assert all(math.isnan(row["contact_radius"]) for group in rows.values() for row in group)


def test_a_range_that_ends_before_the_jump_is_kept():
    rows = table(14.0, 8.0, **UNITS, law=lennard_jones(8.7), count=20)
    for theory in FORM:
        h0, _, _ = columns(rows[theory])
        assert (h0[0], h0[-1]) == pytest.approx((14, 8), rel=1e-13)
    assert all(len(rows[name]) == 1 for name in JUMPS)


def test_a_range_beyond_the_jump_has_no_curve():
    rows = table(5.0, -4.0, **UNITS, law=lennard_jones(8.7), count=20)
    assert list(rows) == JUMPS


def test_curves_without_a_jump_go_on_to_the_end():
    # sigma 0.0087; but the attraction alone has its jump, (37).
    rows = table(14.0, -4.0, **UNITS, law=lennard_jones(8.7e-3), count=200)
    assert list(rows) == [*FORM, "jump_equation_37", "fold_attractive_only"]
    for theory in ("slow_deformation", "closed_form"):
        h0, delta, load = columns(rows[theory])
        assert (h0[0], h0[-1]) == pytest.approx((14, -4), rel=1e-12)
        assert (h0 + delta > 0.1).all() and load[-1] > 0 > load.min()
    h0, delta, _ = columns(rows["attractive_only"])
    assert h0[-1] == pytest.approx(rows["jump_equation_37"][0]["h0"], rel=1e-12)


def test_a_curve_may_fold_before_the_criterion_is_met():
    # Between the thresholds of fold and criterion: on the gap as the parameter the curve passes it.
    rows = table(4.0, 0.0, **UNITS, law=lennard_jones(0.183), count=2000)
    assert "jump_criterion_29" not in rows
    h0, delta, _ = columns(rows["closed_form"])
    assert (h0[0], h0[-1]) == pytest.approx((4, 0), abs=1e-12)
    assert (np.diff(h0 + delta) < 0).all() and (np.diff(h0) > 0).any()
    (fold,) = rows["fold_closed_form"]
    assert abs(h0 - fold["h0"]).min() <= 1e-5


@pytest.mark.parametrize(
    ("law", "h0_start"),
    [(snapin.exponential(p0=1.0, decay_length=1.0), 40.0), (lennard_jones(1.0, "repulsive"), 20.0)],
    ids=["exponential", "repulsive"])
def test_repulsion_has_rows_at_equal_steps_of_h0(law, h0_start):
    rows = table(h0_start, -10.0, **UNITS, law=law, count=31)
    assert list(rows) == ["slow_deformation", "closed_form"]
    for theory in rows:
        h0, delta, load = columns(rows[theory])
        np.testing.assert_allclose(h0, np.linspace(h0_start, -10, 31), atol=2e-4)
        assert (h0[0], h0[-1]) == pytest.approx((h0_start, -10), rel=1e-12)
        assert (np.diff(delta) > 0).all() and (np.diff(load) > 0).all()


def test_rigid_bodies_have_rows_while_they_do_not_touch():
    rows = table(7.0, -2.0, radius=1.0, rigid=True, law=lennard_jones(1.0), count=10)
    assert list(rows) == list(FORM)
    for theory in FORM:
        h0, delta, load = columns(rows[theory])
        np.testing.assert_allclose(h0, np.arange(7.0, 0, -1), rtol=1e-14)
        assert not delta.any()
    h0, _, load = columns(rows["slow_deformation"])
    energy = snapin.force_law(lennard_jones(1.0), h0).energy
    np.testing.assert_allclose(load, 2 * math.pi * energy, rtol=1e-14)
    # A repulsion that is finite at any gap goes on.
    law = snapin.exponential(p0=1.0, decay_length=1.0)
    h0, _, load = columns(
        table(7.0, -2.0, radius=1.0, rigid=True, law=law, count=10)["slow_deformation"])
    np.testing.assert_allclose(h0, np.arange(7.0, -3, -1), atol=1e-14)
    np.testing.assert_allclose(load, 2 * math.pi * np.exp(-h0), rtol=1e-14)


@pytest.mark.parametrize("big_lambda", [1e-30, 1.0, 1e4, 1e30])
@pytest.mark.parametrize(("h0_start", "h0_end"), [(-1e3, -1e4), (1e4, -1e4), (1e4, 1e3)])
def test_any_range_has_its_rows(big_lambda, h0_start, h0_end):
    law = snapin.exponential(p0=big_lambda, decay_length=1.0)
    for rows in table(h0_start, h0_end, **UNITS, law=law, count=7).values():
        h0, _, _ = columns(rows)
        assert (h0[0], h0[-1]) == pytest.approx((h0_start, h0_end), rel=1e-11)
        assert (np.diff(h0) < 0).all()


def test_rows_without_a_range_of_their_own_begin_where_the_path_does(run):
    """Between stiff bodies there were none, since they began beyond contact."""
    found = run(deck(bodies={"radius": 1e-6, "stiffness": 1e11},
                     force={"law": "lennard_jones", "hamaker": 1e-20, "z0": 0.3e-9},
                     equilibrium_path={"h0_end": 0.6e-9}, approximations={}))
    rows = found.table("approximations.csv").rows("slow_deformation")
    assert rows["h0"][0] == pytest.approx(found.curve["h0"][0], rel=1e-6)
    assert rows["h0"][-1] == pytest.approx(0.6e-9, rel=1e-3)


def test_an_oscillation_ends_where_it_is_negligible():
    """It went on for ever, with an amplitude of 1e-261: an integral took 20,000 pieces, and a table
    of rows more than a minute."""
    law = {"structural": {"amplitude": 1e6, "period": 1e-9, "decay_length": 1e-9}}
    near, *far = snapin.slow_deformation(
        [5e-7, 7e-7, 1e-5, 1.0], radius=1e-6, stiffness=1e10, law=law).displacement
    assert near != 0 and far == [0, 0, 0]
