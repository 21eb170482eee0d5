"""Claims about the far ends of the parameters: nothing there fails, and nothing there is wrong.

With a build of -Dtraps=true behind $SNAPIN the same scenes show that nothing overflows on the way.
"""

import math

import numpy as np
import pytest
from support.decks_in_units import PLAIN, REAL, Units
from support.scenes import JKR, agreeing, deck, exponential, lennard_jones, loading, path_of


def check(result, may_warn=False):
    """Every state of a run is a state, and converged; and nothing is hidden."""
    curve = result.curve
    for name in curve.names[1:]:
        assert np.isfinite(curve[name]).all(), name
    assert curve["residual"].max() <= 1e-8
    assert result.summary["converged"]
    # A loading that begins in contact has no pull-off; a radius of metres may be a slip of units.
    assert may_warn or all("no pull-off" in said or said.startswith("units:")
                           for said in result.warnings)
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


@pytest.mark.parametrize(("young", "poisson", "stiffness"), [
    ([0.5e6, 0.5], 0.0, 1 / (1 + 1e-6)), ([0.5, 0.5e6], 0.0, 1 / (1 + 1e-6)), (0.75, 0.5, 1.0)])
def test_moduli_enter_by_the_stiffness_alone(run, young, poisson, stiffness):
    """The compliances add: with a rigid partner the stiffness is twice that of the soft one."""
    by_young, by_stiffness = (check(run(lennard_jones(
        0.87, bodies={"radius": 1.0, **bodies}, loading=loading(6, -2, 0.5), unloading={})))
        for bodies in ({"young": young, "poisson": poisson}, {"stiffness": stiffness}))
    np.testing.assert_allclose(by_young["load"], by_stiffness["load"], rtol=1e-9, atol=1e-9)


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


@pytest.mark.parametrize("units", [
    PLAIN, Units(15.0, 1e10, 5e-7), Units(1.5e-2, 1e13, 5e-10), Units(1.5e-5, 1e7, 5e-13),
    Units(15.0, 1e4, 5e-7)])
def test_units_do_not_matter(run, units):
    """The dimensionless problem is the same: the same digits. Tests pose most scenes in units of
    1."""
    def cycle(units):
        curve = check(run(units.deck(8.7, {"loading": loading(13, -4, 0.5), "unloading": {}})))
        unit = {"load": units.load(8.7), "contact_radius": math.sqrt(units.radius * units.z0)}
        return {name: curve[name] / unit.get(name, units.z0)
                for name in ("h0", "h_centre", "displacement", "load", "contact_radius")}

    expected = cycle(REAL)
    for name, values in cycle(units).items():
        np.testing.assert_allclose(values, expected[name], rtol=1e-9, atol=1e-9, err_msg=name)


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
