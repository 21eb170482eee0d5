"""Claims about what does not converge."""

import numpy as np
import pytest
from support.scenes import exponential, lennard_jones, loading

CYCLE = {"loading": loading(6, -2, 0.5), "unloading": {}}


STARVED = {
    "anderson": {"max_iterations": 1},
    "newton": {"method": "newton", "max_iterations": 1},
    "anderson, uniform": {"max_iterations": 1, "grid": "uniform", "nodes": 100},
    "newton, uniform": {"method": "newton", "max_iterations": 1, "grid": "uniform", "nodes": 100},
    "mixing": {"method": "mixing", "max_iterations": 3, "nodes": 100},
    "mixing, panels": {"method": "mixing", "max_iterations": 3, "grid": "panels"},
    "mixing limit": {"method": "mixing", "mixing_limit": 1e-9, "max_iterations": 100, "nodes": 100},
    "mixing, tolerance": {
        "method": "mixing", "residual_tolerance": 1e-13, "max_iterations": 50, "nodes": 100},
    "paper's rule": {
        "method": "mixing", "convergence": "displacement_change", "displacement_tolerance": 1e-30,
        "max_iterations": 5, "nodes": 100},
}


CASES = [("cycle", name) for name in STARVED] + [
    ("path", name) for name, numerics in STARVED.items() if numerics.get("method") != "mixing"]


@pytest.mark.parametrize(("scene", "name"), CASES)
def test_what_does_not_converge_says_so_and_invents_nothing(run, scene, name):
    groups = CYCLE if scene == "cycle" else {"equilibrium_path": {"h0_end": -2.0}}
    text = lennard_jones(0.87, **groups, numerics=STARVED[name])
    result = run(text, status=1)
    summary, curve = result.summary, result.curve
    assert not summary["converged"]
    assert any("converge" in text or "residual" in text for text in result.warnings)
    assert "jump_in_h0" not in summary and "jump_out_h0" not in summary
    # Stepping on a fixed grid has all rows, a path none. The table alone tells which rows are
    # equilibria.
    stepped = scene == "cycle" and name not in ("anderson", "newton")
    assert len(curve) == (34 if stepped else 0)
    assert ((curve["residual"] <= 1e-8) >= (curve["converged"] == 1)).all()
    equilibria = curve["converged"] == 1
    if "max_tension" in summary:
        assert summary["max_tension"] <= 1.01 * max(0, *-curve["load"][equilibria])
    else:
        assert not (curve["load"][equilibria] < 0).any()


@pytest.mark.parametrize("name", ["anderson, uniform", "mixing"])
def test_a_row_that_is_no_equilibrium_is_neither_stable_nor_unstable(run, name):
    scene = lennard_jones(0.87, **CYCLE, stability={}, numerics=STARVED[name])
    result = run(scene, status=1)
    curve, failed = result.curve, result.curve["converged"] == 0
    assert failed.any() and (curve["stable"][failed] == -1).all()
    for column in ("smallest_eigenvalue", "criterion_28", "criterion_29"):
        assert np.isnan(curve[column][failed]).all()
    assert result.summary["worst_residual"] == pytest.approx(curve["residual"].max())
    assert result.files == ["curve.csv", "summary.nml"] and "did not converge" in result.stderr


def test_what_came_before_the_fall_is_kept(run):
    """Nothing keeps bodies apart that only attract."""
    for numerics in ({}, {"grid": "uniform", "nodes": 60}, {"method": "mixing", "nodes": 60}):
        result = run(lennard_jones(0.87, part="attractive", **CYCLE, numerics=numerics), status=1)
        assert "no stable equilibrium exists" in result.warnings[0]
        assert len(result.curve) >= 5 and (result.curve["converged"] == 1).all()
        assert result.summary["jump_in_h0"] > 2 and "jump_out_h0" not in result.summary


def test_repulsion_alone_that_does_not_converge_says_so(run):
    starved = exponential(10, loading=loading(6, -6, 1), numerics={"max_iterations": 1})
    result = run(starved, status=1)
    assert len(result.curve) == 0 and "after 1 iterations" in result.warnings[0]
