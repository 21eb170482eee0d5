"""Claims about bodies that are driven in time, and bodies that remember."""

import math

import numpy as np
import pytest
from support.creeping import cycle
from support.driven import at_rest, near, scene
from support.scenes import JKR, deck, lennard_jones

# In units of z0, and of the time of retardation.
FAST, SLOW = 1.0e5, 0.01


@pytest.mark.parametrize("sigma", [0.1, 2.0])
def test_an_elastic_body_has_its_path_at_any_velocity(run, sigma):
    path = at_rest(run, sigma)
    for velocity in (0.1, 10.0):
        found = run(scene(sigma, velocity=velocity, accuracy=1e-5)).summary
        assert near(found, "max_tension", path["max_tension"])
        assert abs(found["max_tension"] / path["max_tension"] - 1) < 1e-5
        lost = path.get("energy_lost", 0.0)
        off = abs(found["energy_dissipated"] - lost)
        assert off <= found["energy_dissipated_error"] + 1e-4 * sigma


@pytest.mark.parametrize("groups, start, low", [
    ({"dugdale": {"stress": 1e6, "range": 5e-9},
      "hydration": {"pressure": 1e7, "decay_length": 0.3e-9}}, 100e-9, -20e-9),
    ({"van_der_waals": {"hamaker": 6.5e-20}, "born": {"z0": 0.25e-9},
      "structural": {"amplitude": 3e7, "period": 0.9e-9, "decay_length": 1e-9}}, 20e-9, 0.2e-9)])
def test_an_elastic_body_under_a_step_or_waves_has_its_path(run, groups, start, low):
    bodies = {"radius": 10e-6, "young": 2e6, "poisson": 0.49}
    if "structural" in groups:
        bodies = {"radius": 5e-6, "young": 1e10, "poisson": 0.35}
    path = run(deck(bodies=bodies, **groups, equilibrium_path={"h0_end": low})).summary
    found = run(deck(bodies=bodies, **groups, numerics={"accuracy": 1e-3}, drive={
        "velocity": 1e-6, "z_start": start, "z_turn": low})).summary
    for key in ("max_tension", "max_tension_h0"):
        assert abs(found[key] / path[key] - 1) < 1e-3
        assert near(found, key, path[key])


LAYERED = {"bodies": {"radius": 10e-6, "young": 70e9, "poisson": 0.2},
           "layer": {"thickness": 100e-9, "young": 3e6, "poisson": 0.45, "body": "1"}}


def test_a_cycle_of_layered_bodies_dissipates_the_energy_of_their_jumps(run):
    bodies = LAYERED | {"force": {"law": "lennard_jones", "surface_energy": 0.02, "z0": 2e-9}}
    path = run(deck(**bodies, equilibrium_path={"h0_end": -30e-9})).summary
    found = run(deck(**bodies, numerics={"accuracy": 1e-3}, drive={
        "velocity": 1e-6, "z_start": 30e-9, "z_turn": -30e-9})).summary
    assert found["error_estimate"] < 1e-3 and found["time_steps"] < 3000
    for key, exact in (("max_tension", path["max_tension"]),
                       ("energy_dissipated", path["energy_lost"])):
        assert near(found, key, exact)
        assert found[key + "_error"] < 5e-3 * exact


def test_layered_bodies_in_contact_store_the_work_of_a_drive_without_jumps(run):
    found = run(deck(**LAYERED, hydration={"pressure": 1e5, "decay_length": 1e-9}, drive={
        "velocity": 1e-6, "z_start": 30e-9, "z_turn": -10e-9, "z_end": -5e-9}))
    assert found.curve["load"][-1] > 0.2 * found.curve["load"].max()
    assert near(found.summary, "energy_dissipated", 0.0)
    assert found.summary["energy_dissipated_error"] < 1e-4 * 1e-9 * found.curve["load"].max()


@pytest.mark.parametrize("stiffness", [None, 0.4])
def test_a_drive_that_turns_at_a_fold_goes_back(run, stiffness):
    """It went on along the unstable states, into contact without the energy of the jump."""
    device = {"stiffness": stiffness} if stiffness else {}
    path = run(lennard_jones(2.0, equilibrium_path={"h0_end": -2.0}, device=device,
                             numerics={"accuracy": 1e-8})).summary
    for beside in (0.0, 1e-5):
        found = run(scene(2.0, stiffness=stiffness, start=60.0, accuracy=1e-3,
                          turn=path["device_jump_in_z"] + beside)).summary
        assert found["max_tension"] == pytest.approx(-path["device_jump_in_load"], rel=0.05)
        assert abs(found["energy_dissipated"]) < 1e-3 * path["device_energy_lost"]


def test_strong_adhesion_takes_few_steps_without_memory(run):
    path = at_rest(run, 20.0)
    found = run(scene(20.0, start=30.0, turn=-20.0)).summary
    assert found["time_steps"] < 1500
    for key, exact in (("max_tension", path["max_tension"]),
                       ("energy_dissipated", path["energy_lost"])):
        assert near(found, key, exact)
        assert found[key + "_error"] < 2e-4 * exact


def test_fast_bodies_are_those_at_once_and_slow_ones_those_at_rest(run):
    fast = run(scene(0.1, 0.5, velocity=FAST)).summary["max_tension"]
    slow, slower = (run(scene(0.1, 0.5, velocity=velocity, accuracy=1e-3)).summary["max_tension"]
                    for velocity in (2 * SLOW, SLOW))
    assert fast == pytest.approx(at_rest(run, 0.1)["max_tension"], rel=5e-4)
    # What is left goes with the velocity.
    assert 2 * slower - slow == pytest.approx(at_rest(run, 0.5)["max_tension"] / 5, rel=1e-3)


@pytest.mark.parametrize("time", [1e-20, 1e-45])
def test_a_time_of_retardation_within_the_rounding_of_times_leaves_bodies_at_rest(run, time):
    """Steps became shorter than this rounding, and the bodies were lost at their first jump."""
    path = at_rest(run, 2.0)
    found = run(scene(0.2, creep={"compliance": [9.0], "retardation_time": [time]}, accuracy=1e-2,
                      start=20.0)).summary
    assert near(found, "max_tension", path["max_tension"] / 10)
    assert near(found, "energy_dissipated", path["energy_lost"] / 10)
    assert found["energy_dissipated_error"] < 1e-2 * found["energy_dissipated"]


def test_a_drive_from_far_away_ends_as_one_from_near(run):
    """The rounding of times is a thousandth of the law's length there."""
    near_by, far = (run(scene(2.0, accuracy=1e-2, start=start, z_end=15.0)).summary
                    for start in (15.0, 1e13))
    for key in ("max_tension", "end_load"):
        off = abs(near_by[key] - far[key])
        assert off <= near_by[key + "_error"] + far[key + "_error"]


@pytest.mark.parametrize("velocity", [1.0, 20.0])
def test_a_dense_solution_of_another_kind_agrees(run, velocity):
    steps = 150 if velocity == 1 else 300
    coarse, fine = (cycle(0.05, 3.0, 12.0, -1.0, velocity, each) for each in (steps, 2 * steps))
    expected = 0.05 * (fine + (fine - coarse) / 3)
    found = run(scene(0.05, 0.2, velocity=velocity, start=12.0)).summary
    for key, value in zip(("max_tension", "energy_dissipated", "end_load"), expected):
        assert abs(found[key] - value) <= found[key + "_error"] + 1e-5 * abs(value)
        assert found[key + "_error"] < 3e-4 * abs(value)


def test_two_terms_of_one_time_are_one(run):
    one = run(scene(0.1, 0.3, time_step=0.1)).summary
    two = run(scene(0.1, creep={"compliance": [1.0, 1.0], "retardation_time": [1.0, 1.0]},
                    time_step=0.1)).summary
    # Sums in another order: rounding decides after which iteration a state is solved.
    for key in ("max_tension", "energy_dissipated", "end_load"):
        assert abs(two[key] - one[key]) <= 1e-4 * one[key + "_error"]


def test_steps_are_of_second_order(run):
    # Not so soft that they move fast about a jump, where some steps are halved on the way.
    found = [run(scene(0.05, 0.125, start=8.0, velocity=4.0, z_end=3.0, time_step=step,
                       accuracy=1e-7)).summary for step in (0.004, 0.002, 0.001)]
    for key in ("end_load", "energy_dissipated"):
        a, b, c = (summary[key] for summary in found)
        assert 3.6 < (a - b) / (b - c) < 4.4


def test_the_largest_tension_is_between_rows(run):
    found = [run(scene(0.05, 0.125, start=8.0, velocity=4.0, z_end=3.0, time_step=step,
                       accuracy=accuracy)) for step, accuracy in ((0.02, 1e-3), (0.001, 1e-7))]
    exact = found[1].summary
    for key, of_rows in (("max_tension", -found[0].curve["load"].min()),
                         ("max_tension_h0", found[0].curve["h0"][found[0].curve["load"].argmin()])):
        off = abs(found[0].summary[key] - exact[key])
        assert off < 0.3 * abs(of_rows - exact[key])
        assert off <= found[0].summary[key + "_error"] + exact[key + "_error"]


def test_pull_offs_rise_and_fall_with_velocity(run):
    slow, middle, fast = (
        run(scene(0.2, 2.0, velocity=velocity, start=20.0, turn=-4.0, accuracy=1e-3)).summary
        for velocity in (2.0, 20.0, 2.0e5))
    unit = JKR * 0.2
    assert fast["max_tension"] < slow["max_tension"] < middle["max_tension"]
    assert 3.1 < middle["max_tension"] / unit < 3.4
    assert middle["effective_work_of_adhesion"] == pytest.approx(
        middle["max_tension"] / (1.5 * math.pi))


def test_a_dwell_of_any_length_leaves_relaxed_bodies(run):
    # Ten times of retardation; much longer than the rest of the motion takes, in units of rounding.
    found = [run(scene(0.05, 0.2, velocity=20.0, start=20.0, accuracy=1e-3, dwell=dwell)).summary
             for dwell in (30.0, 1e9, 1e40)]
    for summary in found:
        assert summary["error_estimate"] < 3e-3
        for key in ("max_tension", "energy_dissipated"):
            off = abs(summary[key] - found[0][key])
            assert off <= summary[key + "_error"] + found[0][key + "_error"]


@pytest.mark.parametrize("seed", range(5))
def test_no_cycle_gives_energy(run, seed):
    rng = np.random.default_rng(seed)
    sigma = 10 ** rng.uniform(-2, -0.5)
    found = run(scene(sigma, sigma * 10 ** rng.uniform(0.1, 1), velocity=10 ** rng.uniform(0, 3),
                      turn=rng.uniform(-3, 0), start=20.0, accuracy=1e-2,
                      dwell=rng.choice([0.0, 1.0])))
    summary = found.summary
    assert summary["converged"]
    assert summary["energy_dissipated"] > -summary["energy_dissipated_error"]
    assert not [text for text in summary.get("warnings", []) if "drive" in text]


def test_a_spring_driven_slowly_is_the_device(run):
    device = run(lennard_jones(2.0, equilibrium_path={"h0_end": -2.0},
                               device={"stiffness": 0.4, "z_end": -1.0})).summary
    found = run(scene(2.0, stiffness=0.4, start=60.0, velocity=1.0)).summary
    assert near(found, "energy_dissipated", device["device_energy_lost"], 2.0)
    # The slowly driven bodies part under no less than the tension of the device.
    assert found["max_tension"] >= (
        -device["device_jump_out_load"] - 30 * found["max_tension_error"])


def test_h0_at_the_end_of_a_drive_has_an_error_only_behind_a_spring(run):
    loose, close = (run(scene(0.2, 0.3, stiffness=0.4, start=20.0, accuracy=accuracy)).summary
                    for accuracy in (1e-2, 1e-4))
    off = abs(loose["end_h0"] - close["end_h0"])
    assert 0 < off <= loose["end_h0_error"] + close["end_h0_error"]
    assert loose["end_h0_error"] < 1e-2
    assert "end_h0_error" not in run(scene(0.2, 0.3, start=20.0, accuracy=1e-2)).summary


@pytest.mark.parametrize("stiffness", [1e-4, 0.01])
def test_a_soft_spring_takes_the_bodies_through_both_jumps(run, stiffness):
    # In the jumps the spring would yield by thousands of lengths of the law, or millions.
    bodies = {"radius": 1e-6, "stiffness": 2.2e9}
    force = {"law": "lennard_jones", "surface_energy": 0.05, "z0": 0.5e-9}
    path = run(deck(bodies=bodies, force=force, equilibrium_path={"h0_end": -20e-9}))
    found = run(deck(bodies=bodies, force=force, drive={
        "velocity": 1e-6, "z_start": 1e-6, "z_turn": -1e-6, "z_end": 3e-7 / stiffness,
        "stiffness": stiffness}, numerics={"accuracy": 1e-3})).summary
    pull_off = path.summary["max_tension"]
    assert found["max_tension"] == pytest.approx(pull_off, rel=1e-4)
    # The energy of the spring, and little more.
    assert found["energy_dissipated"] == pytest.approx(pull_off**2 / (2 * stiffness), rel=1e-2)


def test_rows_have_times_and_ways(run):
    found = run(scene(0.1, 0.3, dwell=2.0, stiffness=10.0, accuracy=1e-2))
    table = found.table("curve.csv")
    assert table.names[-2:] == ["time", "z"]
    assert list(dict.fromkeys(table["branch"])) == ["approach", "dwell", "retreat"]
    assert (np.diff(table["time"]) >= 0).all()
    waiting = table["branch"] == "dwell"
    assert np.ptp(table["z"][waiting]) == 0 and np.ptp(table["time"][waiting]) > 1.5
    np.testing.assert_allclose(table["z"], table["h0"] - table["load"] / 10, atol=1e-9)


def test_rigid_bodies_have_the_drag_of_a_film_beside_their_force(run):
    curve = run(deck(
        bodies={"radius": 1e-5, "rigid": True},
        force={"law": "lennard_jones", "hamaker": 1e-21, "z0": 0.2e-9},
        fluid={"viscosity": 1e-3},
        drive={"velocity": 1e-6, "z_start": 500e-9, "z_turn": 10e-9},
        numerics={"accuracy": 1e-4})).curve
    # Some steps after each turn, where the fluid starts to move at once.
    for branch, sense in (("approach", 1), ("retreat", -1)):
        way = curve["branch"] == branch
        h0, load = curve["h0"][way][10:], curve["load"][way][10:]
        drag = 6 * math.pi * 1e-3 * 1e-10 * 1e-6 / h0
        force = -1e-21 * 1e-5 / (6 * h0**2) * (1 - (0.2e-9 / h0) ** 6 / 4)
        np.testing.assert_allclose(load, sense * drag + force, rtol=1e-7)
