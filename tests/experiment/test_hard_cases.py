"""Claims about the far ends of the parameters: nothing there fails, and nothing there is wrong.

With a build of -Dtraps=true behind $SNAPIN the same scenes show that nothing overflows on the way.
"""

import math

import numpy as np
import pytest
from support.scenes import JKR, agreeing, deck, exponential, lennard_jones, loading, path_of


def check(result, may_warn=False):
    """Every state of a run is a state, and converged; and nothing is hidden."""
    curve = result.curve
    for name in curve.names[1:]:
        assert np.isfinite(curve[name]).all(), name
    assert curve["residual"].max() <= 1e-8
    assert result.summary["converged"]
    assert may_warn or result.warnings == []
    return curve


# --- Adhesion strength


@pytest.mark.parametrize("sigma", [1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4])
def test_cycle_at_any_sigma_is_solved_and_agrees_with_the_path(run, sigma):
    far = 3 + 3.5 * (sigma**2) ** (1 / 3)  # Beyond the jump out, 2.6 sigma^(2/3) or so.
    cycle = run(lennard_jones(sigma, loading=loading(far, -10, far / 40), unloading={}))
    curve = check(cycle)
    path = run(lennard_jones(sigma, equilibrium_path={"h0_end": -10.0}))
    check(path)
    for key in ("max_tension", "jump_in_h0", "jump_out_h0"):
        assert (key in cycle.summary) == (key in path.summary), key
        if key in path.summary:
            assert cycle.summary[key] == pytest.approx(path.summary[key], rel=2e-6), key
    # Between the limits of JKR and DMT.
    assert 1 < cycle.summary["max_tension"] / (sigma * JKR) < 4 / 3
    for branch in ("loading", "unloading_1"):
        assert curve.rows(branch)["h0"].min() == -10


# --- Repulsion strength


@pytest.mark.parametrize("big_lambda", [1e-6, 1e-3, 1.0, 1e3, 1e6, 1e8])
def test_exponential_at_any_lambda(run, big_lambda):
    """p0 and h0 are one parameter: a shift of h0 by ln(10) is a factor of 10."""
    shift = math.log(big_lambda)
    result = run(exponential(big_lambda, loading=loading(6 + shift, shift - 6, 0.5)))
    curve = check(result)
    reference = check(run(exponential(1, loading=loading(6, -6, 0.5))))
    np.testing.assert_allclose(curve["h0"] - shift, reference["h0"], atol=1e-12)
    np.testing.assert_allclose(curve["load"], reference["load"], rtol=1e-6)
    np.testing.assert_allclose(curve["displacement"], reference["displacement"], rtol=1e-6)


@pytest.mark.parametrize("big_lambda", [1e-6, 1e8])
def test_exponential_from_one_h0_at_any_lambda(run, big_lambda):
    check(run(exponential(big_lambda, loading=loading(10, -10, 1))))


# --- Sums of forces


def test_gaps_that_open_beside_a_steep_and_a_long_force_overflow_nothing(run):
    """A sum lets far gaps close by more than a law of powers does: with -Dtraps=true, as above."""
    check(run(deck(
        bodies={"radius": 8.3e-4, "stiffness": 2.94e10}, van_der_waals={"hamaker": 1.96e-19},
        born={"z0": 5e-10}, hydration={"energy": 6.45e-2, "decay_length": 1.06e-9},
        loading=loading(17e-9, -0.5e-9, 1e-9))))


# --- Deep indentation


@pytest.mark.parametrize("depth", [1e2, 1e3, 1e4])
def test_deep_indentation_by_repulsion_tends_to_hertz(run, depth):
    result = run(exponential(1, loading=loading(0, -depth, depth / 40)))
    curve = check(result)
    displacement, load = curve["displacement"][-1], curve["load"][-1]
    hertz = 2 / 3 * displacement**1.5
    # In these units E* = 1/2: F = (4/3) E* R^(1/2) delta^(3/2), delta from h0 down.
    assert load == pytest.approx(hertz, rel=20 / depth)
    assert (np.diff(curve["load"]) > 0).all()


@pytest.mark.parametrize("sigma", [0.87, 100.0])
@pytest.mark.parametrize("depth", [1e2, 1e3, 1e4])
def test_deep_indentation_with_adhesion_tends_to_jkr(run, sigma, depth):
    scene = lennard_jones(sigma, loading=loading(6, -depth, depth / 40), unloading={"h0_end": 6.0})
    curve = check(run(scene))
    down = curve.rows("loading")
    # JKR from the contact radius, with E* = 1/2: F = 4 E* a^3/(3 R) - (8 pi gamma E* a^3)^(1/2) and
    # delta = a^2/R - (2 pi gamma a/E*)^(1/2).
    a = math.sqrt(depth)
    for _ in range(100):
        a = math.sqrt(depth + 1 + math.sqrt(4 * math.pi * sigma * a))
    load = 2 / 3 * a**3 - math.sqrt(4 * math.pi * sigma * a**3)
    assert down["load"][-1] == pytest.approx(load, rel=20 / depth)
    # The contact's radius to a law's length of penetration or so.
    assert down["contact_radius"][-1] == pytest.approx(a, rel=20 / depth + 0.01)


# --- Bodies


def test_one_body_a_million_times_softer_deforms_alone(run):
    """The compliances add: with a rigid partner the stiffness is twice that of the soft one."""

    def scene(bodies):
        return lennard_jones(0.87, bodies={"radius": 1.0, **bodies}, loading=loading(6, -2, 0.5),
                             unloading={})

    soft = check(run(scene({"young": [0.5e6, 0.5], "poisson": [0.0, 0.0]})))
    one = check(run(scene({"stiffness": 1 / (1 + 1e-6)})))
    np.testing.assert_allclose(soft["load"], one["load"], rtol=1e-9, atol=1e-9)
    other = check(run(scene({"young": [0.5, 0.5e6], "poisson": [0.0, 0.0]})))
    np.testing.assert_allclose(soft["load"], other["load"], rtol=1e-12, atol=1e-12)


def test_poisson_ratio_enters_by_the_stiffness_alone(run):
    def scene(bodies):
        return deck(
            bodies={"radius": 1.0, **bodies},
            force={"law": "exponential", "p0": 1.0, "decay_length": 1.0}, loading=loading(4, -4, 1))

    by_young = run(scene({"young": 0.75, "poisson": 0.5})).curve
    by_stiffness = run(scene({"stiffness": 1.0})).curve
    np.testing.assert_allclose(by_young["load"], by_stiffness["load"], rtol=1e-12)


def test_rigid_bodies_under_exponential_repulsion_obey_derjaguin_even_overlapping(run):
    scene = exponential(1.0, loading=loading(10, -30, 1))
    curve = check(run(scene.replace("stiffness = 1.0", "rigid = .true.")))
    np.testing.assert_allclose(curve["load"], 2 * math.pi * np.exp(-curve["h0"]), rtol=1e-6)


# --- Steps and starts


@pytest.mark.parametrize("sigma", [0.01, 8.7, 1e3])
def test_start_anywhere_in_contact_is_the_state_that_an_approach_reaches(run, sigma):
    whole = check(run(lennard_jones(sigma, loading=loading(50, -20, 5))))
    for start in (0.0, -20.0 + 5):
        part = check(run(lennard_jones(sigma, loading=loading(start, -20, 5))))
        load = whole["load"][-len(part) :]
        np.testing.assert_allclose(part["load"], load, rtol=1e-6, atol=1e-7 * sigma)


def test_a_single_step_and_a_step_longer_than_the_range(run):
    for step in (1.0, 3.0, 1e6):
        curve = check(run(lennard_jones(0.87, loading=loading(6, 5, step))))
        assert list(curve["h0"]) == [6, 5]


@pytest.mark.parametrize("accuracy", [1e-2, 1e-4, 1e-8, 1e-9, 1e-10])
@pytest.mark.parametrize("sigma", [0.01, 0.1, 0.17, 0.87, 8.7])
def test_cycle_at_any_accuracy(run, sigma, accuracy):
    scene = lennard_jones(
        sigma, loading=loading(8, -4, 0.2), unloading={}, numerics={"accuracy": accuracy})
    result = run(scene)
    # At the finest accuracy rounding is a part of what the finer mesh differs by, and the estimate,
    # which is several times that difference, may say so; the numbers below are as good as asked.
    check(result, may_warn=accuracy <= 1e-10)
    exact = run(
        lennard_jones(sigma, equilibrium_path={"h0_end": -4.0}, numerics={"accuracy": 1e-10}))
    for key in ("max_tension", "jump_in_h0"):
        if key in exact.summary:
            asked = {"rel": accuracy + 1e-10}
            assert result.summary[key] == pytest.approx(exact.summary[key], **asked), key


# --- Invariance


def scaled(length, pressure):
    """A cycle at sigma 8.7, every length and every pressure of it multiplied; and its units."""
    radius, z0, stiffness, sigma = 1.5e-2 * length, 0.5e-9 * length, 1e10 * pressure, 8.7
    gamma = sigma * stiffness * math.sqrt(z0**3 / radius)
    return deck(
        bodies={"radius": radius, "stiffness": stiffness},
        force={"law": "lennard_jones", "hamaker": 16 * math.pi * z0**2 * gamma, "z0": z0},
        loading={"h0_start": 13 * z0, "h0_end": -4 * z0, "h0_step": 0.5 * z0},
        unloading={}), (z0, gamma * radius, math.sqrt(radius * z0))


@pytest.mark.parametrize(("length", "pressure"), [(1e3, 1), (1, 1e3), (1e-3, 1e-3), (1e3, 1e-6)])
def test_units_do_not_matter(run, length, pressure):
    """The dimensionless problem is the same: the same digits."""
    text, (z0, load, lateral) = scaled(1, 1)
    one = check(run(text))
    text, (z0_other, load_other, lateral_other) = scaled(length, pressure)
    other = check(run(text))
    for name, unit, unit_other in (
            ("h0", z0, z0_other), ("h_centre", z0, z0_other), ("displacement", z0, z0_other),
            ("load", load, load_other), ("contact_radius", lateral, lateral_other)):
        np.testing.assert_allclose(
            other[name] / unit_other, one[name] / unit, rtol=1e-9, atol=1e-9, err_msg=name)


def test_unit_scene_is_the_scene_of_fig10(run):
    """Tests pose most scenes with R = z0 = stiffness = 1: no digit depends on that."""
    text, (z0, load, _) = scaled(1, 1)
    real = check(run(text))
    unit = check(run(lennard_jones(8.7, loading=loading(13, -4, 0.5), unloading={})))
    np.testing.assert_allclose(real["h_centre"] / z0, unit["h_centre"], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(real["load"] / load, unit["load"] / 8.7, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("stiffness,diameter,h0,accuracy", [
    (1.4777209453e7, 3.43883312763e-9, -1.018545604e-9, 3e-4),
    (3.8855948810e7, 2.36262059847e-9, -4.084781606e-9, 8e-5)])
def test_a_step_beside_strong_adhesion_is_passed_on_meshes_with_digits_for_its_folds(
        run, stiffness, diameter, h0, accuracy):
    """Both paths were lost among folds that coarse meshes make; in the first, products read past
    their arrays, since the path went on from states of another mesh."""
    found, _ = agreeing(run, lambda each: path_of(stiffness, h0, each, depletion={
        "osmotic_pressure": 1e5, "diameter": diameter}), (accuracy, 1e-8),
        ("max_tension", "end_load"))
    assert "illegal" not in found.stderr
    assert not any("lost" in said for said in found.warnings)
