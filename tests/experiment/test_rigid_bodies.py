"""Claims about rigid bodies: their loads are integrals over the gap, exact and without a mesh."""

import math

import numpy as np
import pytest
import snapin
from conftest import ROOT
from support import derjaguin
from support.calculus import integrals
from support.laws import LAWS, TABLE
from support.scenes import deck, lennard_jones, loading, several

BODIES = {
    "parabola": derjaguin.parabola(1e-6),
    "power": derjaguin.power(1.5, 2e2),
    "flat": derjaguin.power(4.0, 1e18),
    "cone": derjaguin.cone(1.2),
    "rounded_punch": derjaguin.rounded_punch(1e-6, 5e-8),
    "sphere": derjaguin.spheroid(1e-5, 1e-5, "sphere"),
    "spheroid": derjaguin.spheroid(1e-6, 1e-4),
}
# Each law with a parabola, and with one of the other bodies in turn; the steps with all.
TURN = [name for name in BODIES if name != "parabola"]
PAIRS = [(law, "parabola") for law in LAWS]
PAIRS += [(law, TURN[i % len(TURN)]) for i, law in enumerate(LAWS)]
PAIRS += [(law, body) for law in ("dugdale", "sharp sum") for body in TURN]
STEPS = {"h0_start": 2.3e-8, "h0_end": 0.27e-9, "h0_step": 2.6e-9}


def rigid(law, body, **groups):
    return deck(**body.groups, **law, **groups)


def test_every_law_and_shape_is_here():
    for room, here in (("laws", LAWS), ("shapes", BODIES)):
        there = {path.stem for path in (ROOT / "src" / "model" / room).glob("*.f90")}
        assert there <= {*here, "profile"}  # A profile is a file: below.


# --- Loads


@pytest.mark.parametrize(("law", "body"), dict.fromkeys(PAIRS))
def test_loads_are_the_integral_of_the_pressure_over_the_gap(run, law, body):
    """Whatever the accuracy that is asked for, and with errors that say so."""
    result = run(rigid(LAWS[law], BODIES[body], loading=STEPS, numerics={"accuracy": 1e-2}))
    curve, summary = result.curve, result.summary
    for i in (0, 4, 7, -1):
        exact, size = derjaguin.load(LAWS[law], BODIES[body], curve["h0"][i])
        assert abs(curve["load"][i] - exact) <= 1e-12 * size + 1e-100
    assert abs(summary["end_load"] - exact) <= summary["end_load_error"] + 1e-13 * size
    assert summary["error_estimate"] <= 1e-9
    assert not [text for text in result.warnings if "error" in text]


def test_a_profile_is_integrated_between_its_points(run, tmp_path):
    body = derjaguin.profile(tmp_path / "p.txt", np.linspace(0, 3e-7, 40), 1e-6)
    curve = run(rigid(LAWS["sharp sum"], body, loading=STEPS)).curve
    for i in (5, -1):
        exact, _ = derjaguin.load(LAWS["sharp sum"], body, curve["h0"][i])
        assert curve["load"][i] == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize("exponent", [2.002, 2.1, 2.5])
def test_the_tail_of_a_force_that_falls_slowly_is_integrated_to_its_end(run, exponent):
    """Between cones a pressure of the power -p of the gap has a load while p is above 2."""
    law = {"tabulated": {"file": TABLE, "tail_exponent": exponent}}
    gap, h0, half_angle = np.loadtxt(TABLE)[:, 0], 4e-10, 1.2
    ends = np.concatenate([[h0], gap[gap > h0]])
    exact = integrals(lambda h: snapin.force_law(law, h).pressure * (h - h0), ends)[0].sum()
    last, a = snapin.force_law(law, gap[-1:]).pressure[0], gap[-1]
    exact += last * a**2 * (1 / (exponent - 2) - h0 / a / (exponent - 1))
    exact *= 2 * math.pi * math.tan(half_angle) ** 2
    found = run(rigid(law, derjaguin.cone(half_angle), loading=loading(1e-9, h0, 3e-10))).summary
    assert found["end_load"] == pytest.approx(exact, rel=1e-11)


@pytest.mark.parametrize("bodies", [{"rigid": True}, {"stiffness": 1e10}])
def test_a_load_without_a_limit_is_refused(snapin, tmp_path, bodies):
    law = {"tabulated": {"file": TABLE, "tail_exponent": 1.9}}
    text = deck(bodies=bodies, shape={"kind": "cone", "half_angle": 1.2}, **law,
                loading=loading(1e-9, 4e-10, 3e-10))
    (tmp_path / "d.nml").write_text(text)
    result = snapin("d.nml", cwd=tmp_path)
    assert result.returncode == 2
    assert "the load has no limit" in result.stderr


# --- The largest tension

ATTRACTING = ["lennard_jones", "morse", "hydrophobic", "depletion", "capillary", "dugdale",
              "sharp sum", "two steps", "tabulated"]


@pytest.mark.parametrize("law", ATTRACTING)
def test_parabolas_are_pulled_off_by_derjaguins_force_where_the_law_rests(run, law):
    """2 pi w R, however coarse the steps."""
    body = BODIES["parabola"]
    result = run(rigid(LAWS[law], body, loading=loading(2e-8, 0.24e-9, 1.1e-9), unloading={}))
    found = result.summary
    pull_off = 2 * math.pi * 1e-6 * found["surface_energy"]
    rest = found.get("rest_gap", 0.5e-9)
    for prefix in ("", "unload_"):
        tension, h0 = found[prefix + "max_tension"], found[prefix + "max_tension_h0"]
        assert abs(tension - pull_off) <= found[prefix + "max_tension_error"] + 1e-15 * pull_off
        assert 0 < found[prefix + "max_tension_error"] < 1e-11 * pull_off
        assert abs(h0 - rest) <= found[prefix + "max_tension_h0_error"]
        assert 0 < found[prefix + "max_tension_h0_error"] < 1e-11 * rest
    assert result.warnings == []


@pytest.mark.parametrize("body", TURN)
@pytest.mark.parametrize("law", ["lennard_jones", "dugdale", "sharp sum"])
def test_the_largest_tension_of_any_shape_is_where_the_load_is_lowest(run, law, body):
    law, body = LAWS[law], BODIES[body]
    found = run(rigid(law, body, loading=loading(2e-8, 0.12e-9, 3e-9))).summary
    tension, h0 = found["max_tension"], found["max_tension_h0"]
    error = found["max_tension_h0_error"]
    assert 0.12e-9 < h0 < 2e-9 and error < 1e-10 * h0
    step = 1e-3 * h0
    before, there, after = (derjaguin.load(law, body, h0 + d)[0] for d in (-step, 0.0, step))
    assert abs(-tension - there) <= found["max_tension_error"] + 1e-12 * tension
    # The load's slope there, by three points: off by the third derivative alone.
    assert there < min(before, after)
    assert abs(after - before) <= 0.02 * (before + after - 2 * there)


def test_cones_under_lennard_jones_have_their_largest_tension_in_closed_form(run):
    """(16 pi/7) 4^(1/6) gamma z0 tan(half_angle)^2 at h0 = 4^(-1/6) z0."""
    law, body = LAWS["lennard_jones"], derjaguin.cone(1.2)
    found = run(rigid(law, body, loading=loading(5e-9, 3e-10, 1e-9))).summary
    gamma = 1e-19 / (16 * math.pi * 0.25e-18)
    exact = 16 * math.pi / 7 * 4 ** (1 / 6) * gamma * 0.5e-9 * math.tan(1.2) ** 2
    assert found["max_tension"] == pytest.approx(exact, rel=1e-13)
    assert found["max_tension_h0"] == pytest.approx(0.5e-9 * 4 ** (-1 / 6), rel=1e-12)


def test_a_tension_that_grows_to_the_end_of_the_range_is_that_of_the_end(run):
    found = run(rigid(LAWS["lennard_jones"], BODIES["cone"], loading=loading(5e-9, 1e-9, 1e-9)))
    assert found.summary["max_tension_h0"] == 1e-9
    assert found.summary["max_tension"] == -found.curve["load"][-1]


# --- What there is, and what not


def test_there_is_no_mesh_and_nothing_is_solved(run):
    result = run(rigid(LAWS["dugdale"], BODIES["sphere"], loading=STEPS, unloading={},
                       equilibrium_path={}, numerics={"grid": "uniform", "method": "mixing"}))
    assert result.summary["grid"] == "none" and result.summary["method"] == "integral"
    for count in ("nodes", "iterations", "kernel_entries", "operator_products", "factorisations"):
        assert result.cost[count] == 0
    curve = result.curve
    assert (curve["residual"] == 0).all() and (curve["iterations"] == 0).all()
    assert (curve["displacement"] == 0).all() and (curve["converged"] == 1).all()
    assert set(curve.rows("path")["stable"]) == {1}
    assert not {"sigma", "tabor", "big_lambda", "spacing_over_neck"} & set(result.summary)
    assert result.warnings == []


@pytest.mark.parametrize("body", ["parabola", "rounded_punch", "spheroid"])
def test_profiles_show_the_gap_the_pressure_and_its_energy(run, body):
    law, body, h0 = LAWS["dugdale"], BODIES[body], 0.4e-9
    result = run(rigid(law, body, loading=loading(1e-9, 0.3e-9, 1e-10), profiles={"h0": h0}))
    table = result.table("profiles.csv")
    r, gap = table["r"], table["separation"]
    exact = snapin.force_law(law, gap)
    np.testing.assert_allclose(gap, h0 + body.height(r), rtol=1e-14)
    assert (table["deformation"] == 0).all()
    np.testing.assert_allclose(table["pressure"], exact.pressure, rtol=1e-12)
    np.testing.assert_allclose(table["energy"], exact.energy, rtol=1e-12)
    # Close enough for straight lines, of the step too: the load by the trapezoidal rule.
    lines = 2 * math.pi * np.trapezoid(table["pressure"] * r, r)
    assert lines == pytest.approx(derjaguin.load(law, body, h0)[0], rel=5e-3)
    assert several(result.summary["profiles_error"]) == [1e-13]


def test_profiles_under_a_force_with_a_kink_have_the_pressure_of_the_law(run):
    """Rigid bodies have no panels; the program looked for kinks on them and ended."""
    result = run(rigid(LAWS["steric"], BODIES["parabola"], loading=loading(4e-9, 2e-9, 1e-9),
                       profiles={"h0": 2e-9}))
    table = result.table("profiles.csv")
    assert table["separation"].min() < 1e-8 < table["separation"].max()
    exact = snapin.force_law(LAWS["steric"], table["separation"])
    np.testing.assert_allclose(table["pressure"], exact.pressure, rtol=1e-12)


def test_criteria_of_stability_are_those_of_bodies_that_do_not_yield(run):
    curve = run(rigid(LAWS["lennard_jones"], BODIES["cone"], loading=STEPS, stability={})).curve
    assert (curve["smallest_eigenvalue"] == 1).all() and (curve["stable"] == 1).all()
    assert (curve["criterion_28"] == 0).all()


def test_a_sweep_has_the_exact_loads(run):
    result = run(rigid(
        LAWS["dugdale"], BODIES["parabola"], loading=STEPS,
        sweep={"key": "dugdale.stress", "values": [1e6, 3e6, 1e7]}))
    table = result.table("sweep.csv")
    np.testing.assert_allclose(table["max_tension"],
                               2 * math.pi * 1e-6 * table["surface_energy"], rtol=1e-13)


def test_a_short_force_leaves_a_large_body_whole(run):
    """Brushes that do not meet at the body's end: nothing is divided by nothing."""
    run(rigid(LAWS["steric"], BODIES["sphere"], loading=STEPS))


# --- The limit of stiff bodies


@pytest.mark.parametrize("shape", [{"kind": "parabola", "radius": 1.0},
                                   {"kind": "cone", "half_angle": math.atan(2.0)},
                                   {"kind": "rounded_punch", "radius": 1.0, "flat_radius": 2.0}])
def test_elastic_bodies_tend_to_rigid_ones_as_they_get_stiff(run, shape):
    """In proportion to sigma, at every h0 of a cycle and at its largest tension."""
    def found(**bodies):
        result = run(lennard_jones(1.0, bodies=bodies, shape=shape, loading=loading(6, 0.9, 0.3),
                                   numerics={"accuracy": 1e-9}))
        return np.append(result.curve["load"], result.summary["max_tension"])

    exact = found(rigid=True)
    off = [np.abs(found(stiffness=stiffness) - exact) for stiffness in (1e6, 1e7)]
    assert (off[0] <= 1e-3 * np.abs(exact).max()).all()
    assert off[1].max() == pytest.approx(0.1 * off[0].max(), rel=0.05)
