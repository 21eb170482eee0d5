"""Claims about numbers out of range, and about what is too large or too long."""

import numpy as np
import pytest
from support.scenes import JKR, deck, exponential, lennard_jones, loading


@pytest.mark.parametrize(
    ("key", "value"),
    [("radius", 1e-200), ("stiffness", 1e200), ("hamaker", 1e-150), ("z0", 1e150)])
def test_numbers_whose_powers_would_overflow_are_refused(run, key, value):
    groups = {
        "bodies": {"radius": 1.0, "stiffness": 1.0},
        "force": {"law": "lennard_jones", "hamaker": 1.0, "z0": 1.0}}
    for keys in groups.values():
        if key in keys:
            keys[key] = value
    result = run(deck(**groups, loading=loading(3, 1, 1)), status=2)
    assert f'key "{key}"' in result.stderr
    assert not result.folder.exists()


def test_units_that_would_overflow_together_are_refused(run):
    """Each number is moderate; the pressure A/(16 pi z0^3) is not."""
    scene = deck(
        bodies={"radius": 1.0, "stiffness": 1.0},
        force={"law": "lennard_jones", "hamaker": 1.0, "z0": 1e-50},
        loading={"h0_start": 3e-50, "h0_end": 1e-50, "h0_step": 1e-50})
    assert "a pressure of about 1e149 Pa" in run(scene, status=2).stderr


@pytest.mark.slow
def test_adhesion_far_beyond_rounding_is_refused_by_sigma(run):
    """Bodies were searched for states for minutes."""
    said = run(lennard_jones(1e45, equilibrium_path={"h0_end": -2.0}), status=2).stderr
    assert '&force: key "hamaker"' in said
    assert "(sigma) of about 1e45; allowed: from 1e-100 to 1e39" in said
    # Bodies so far apart have no pull-off.
    (warning,) = run(lennard_jones(1e38, loading=loading(9e14, 8e14, 1e14))).warnings
    assert "no pull-off" in warning
    run(lennard_jones(1e45, classical={"h0_start": 1.0, "h0_end": -2.0}))


def test_h0_of_more_lengths_than_digits_is_refused(run):
    scene = lennard_jones(1.0, loading=loading(1e16, 1, 1e16))
    assert "lost in rounding" in run(scene, status=2).stderr


@pytest.mark.parametrize("sigma, limit, rel", [
    (1e-12, 2 * np.pi, 1e-6), (1e-9, 2 * np.pi, 1e-6), (1e-6, 2 * np.pi, 1e-4), (1e6, JKR, 1e-4),
    (1e9, None, None), (1e12, None, None)])
def test_sigma_out_of_any_range_is_solved_or_said_to_be_beyond_rounding(run, sigma, limit, rel):
    """DMT and JKR, which no such bodies can leave."""
    scene = lennard_jones(sigma, equilibrium_path={"h0_end": -2.0})
    if limit:
        assert run(scene).summary["max_tension"] / sigma == pytest.approx(limit, rel=rel)
    else:
        assert "rounding hides the force law" in run(scene, status=1).warnings[0]


@pytest.mark.parametrize("method", ["anderson", "newton"])
def test_adhesion_beyond_rounding_is_refused_at_once_on_a_fixed_grid_too(run, method):
    """Before, every step of the approach was tried, a hundred products and more each."""
    numerics = {"grid": "uniform", "nodes": 120, "method": method}
    scene = lennard_jones(1e13, loading=loading(1.5, -98, 10), numerics=numerics)
    result = run(scene, status=1)
    assert "rounding hides the force law" in result.warnings[0]
    # It is one state that shows it, of hundreds of steps and halvings.
    assert result.cost["states"] <= 1
    assert result.cost["operator_products"] < 1000 and result.cost["factorisations"] < 1000


def test_gaps_of_a_million_lengths_do_not_limit_steps(run):
    """A step may close a gap by some lengths of the law where forces act, and by more far away."""
    text = deck(bodies={"radius": 1e-6, "stiffness": 1e9},
                force={"law": "exponential", "p0": 5e7, "decay_length": 1e-9},
                loading={"h0_start": 1e-3, "h0_end": 1e-4, "h0_step": 1e-4})
    assert len(run(text).curve["h0"]) == 10


@pytest.mark.slow
def test_no_residual_above_a_thousandth_is_put_down_to_rounding(run):
    """At depths of 10^13 lengths rounding leaves a hundredth, too much for a state."""
    for scene in (
            lennard_jones(1, loading=loading(6, -1e13, 1e13), numerics={"accuracy": 1e-3}),
            exponential(1, loading=loading(0, -1e13, 1e13), numerics={"accuracy": 1e-3})):
        result = run(scene, status=1)
        equilibria = result.curve["converged"] == 1
        assert equilibria.sum() == 1
        assert (result.curve["residual"][equilibria] <= 1e-3).all()
        assert any("ended early" in text for text in result.warnings)


@pytest.mark.parametrize("nodes", [2, 3])
@pytest.mark.parametrize("method", ["anderson", "newton", "mixing"])
def test_two_nodes_are_a_grid_and_told_to_be_a_bad_one(run, method, nodes):
    numerics = {"method": method, "grid": "uniform", "nodes": nodes}
    text = lennard_jones(0.1, loading=loading(4, 2, 1), numerics=numerics)
    assert any("error" in warning for warning in run(text).warnings)


@pytest.mark.parametrize("rigid_grid", ["auto", "uniform"])
def test_rigid_bodies_keep_what_came_before_they_touch(run, rigid_grid):
    text = lennard_jones(1.0, loading=loading(3, -2, 0.5), numerics={"grid": rigid_grid})
    result = run(text.replace("stiffness = 1.0", "rigid = .true."), status=1)
    assert list(result.curve["h0"]) == [3.0, 2.5, 2.0, 1.5, 1.0, 0.5]
    assert (result.curve["converged"] == 1).all()
    assert "touch" in result.warnings[0]
