"""Claims about drives of bodies that only repel: as the repulsion hardens those that remember are
Hertz's, of which load and depth are known in closed form (Lee and Radok; Ting on the way back)."""

import math

import numpy as np
import pytest
from support.calculus import gauss, zero
from support.scenes import UNIT, deck, exponential

# Depth in decay lengths of the repulsion, and stiffness at rest over that at once.
DEPTH, RELAXED = 1000.0, 0.25
MODULUS = 0.5  # E* at once
EXPONENTIAL = {"law": "exponential", "p0": 1e-2, "decay_length": 1.0}


def scene(accuracy=1e-3, **drive):
    return exponential(1.0, drive={"z_start": 20.0, **drive}, numerics={"accuracy": accuracy},
                       viscoelastic={"stiffness_relaxed": RELAXED, "retardation_time": 1.0})


def relaxation(time):
    """E* a time after a step of depth."""
    return MODULUS * (RELAXED + (1 - RELAXED) * np.exp(-time / RELAXED))


def relaxed_between(time, first, last):
    """The integral of relaxation(time - s) over s."""
    late, early = (np.exp((s - time) / RELAXED) for s in (last, first))
    return MODULUS * RELAXED * (last - first + (1 - RELAXED) * (late - early))


def ting(time, turn):
    """Load of a sphere of radius 1 that goes in with velocity DEPTH/turn, and back."""

    def longer(first):
        return relaxed_between(time, first, turn) - relaxed_between(time, turn, time)

    # On the way back the contact is as wide as it was at a time when it grew, until it is gone.
    grown = time if time <= turn else zero(longer, 0.0, turn) if longer(0.0) > 0 else 0.0
    root, weights = gauss(40, 0, np.sqrt(grown))
    integral = weights @ (2 * root**2 * relaxation(time - root**2))
    return 4 / 3 * 1.5 * (DEPTH / turn)**1.5 * integral


@pytest.mark.parametrize("turn", [0.1, 1.0])
def test_a_hard_sphere_has_tings_load_on_both_ways(run, turn):
    curve = run(scene(velocity=DEPTH / turn, z_turn=-DEPTH)).curve
    begun = np.interp(0.0, -curve["h0"][curve["branch"] == "approach"],
                      curve["time"][curve["branch"] == "approach"])
    largest = curve["load"].max()
    for i in range(0, len(curve), max(1, len(curve) // 40)):
        time = curve["time"][i] - begun
        if time > 0:
            assert abs(curve["load"][i] - ting(time, turn)) < 0.01 * largest


def test_depth_under_a_constant_load_relaxes_exponentially(run):
    soft, travel = 0.01, 2.0e6
    curve = run(scene(1e-2, velocity=2.0e10, z_turn=-travel, dwell=3.0, stiffness=soft)).curve
    dwell = curve["branch"] == "dwell"
    time = curve["time"][dwell] - curve["time"][dwell][0]
    load = curve["load"][dwell]
    assert np.ptp(load) < 1e-3 * load[0]
    compliance = (1 + (1 / RELAXED - 1) * (1 - np.exp(-time))) / MODULUS
    np.testing.assert_allclose((-curve["h0"][dwell])**1.5, 0.75 * load * compliance, rtol=0.01)


def far_drive(bodies, z_end=0.0, **groups):
    """A drive through a thousand decay lengths without any load."""
    return deck(bodies=bodies, force=EXPONENTIAL, numerics={"accuracy": 1e-4}, **groups,
                drive={"velocity": 1.0, "z_start": 1000.0, "z_turn": -25.0, "z_end": z_end})


@pytest.mark.parametrize("stiffness", [1.0, 1e6])
def test_steps_from_far_away_are_long_until_there_is_a_load(run, stiffness):
    bodies = {"radius": 1.0, "stiffness": stiffness}
    found = run(far_drive(bodies))
    summary = found.summary
    # Soft bodies need a pass more for the balance of energies.
    assert summary["time_steps"] < 3500
    assert summary["error_estimate"] < 1e-4
    path = run(deck(bodies=bodies, force=EXPONENTIAL, equilibrium_path={"h0_end": 0.0})).curve
    assert summary["end_load"] == pytest.approx(path["load"][-1], rel=1e-6)
    if stiffness > 1:
        # Rigid bodies.
        assert summary["end_load"] == pytest.approx(2 * math.pi * EXPONENTIAL["p0"], rel=1e-6)
    # Elastic bodies give back the whole energy.
    assert abs(summary["energy_dissipated"]) <= summary["energy_dissipated_error"]
    assert summary["energy_dissipated_error"] < 1e-4 * found.curve["load"].max()


def test_creeping_bodies_dissipate_the_same_energy_from_near_and_from_far(run):
    creep = {"stiffness_relaxed": 0.1, "retardation_time": 10.0}
    far = run(far_drive(UNIT, 20.0, viscoelastic=creep)).summary
    near = run(deck(bodies=UNIT, force=EXPONENTIAL, numerics={"accuracy": 1e-4},
                    viscoelastic=creep, drive={"velocity": 1.0, "z_start": 20.0, "z_turn": -25.0,
                                               "z_end": 20.0, "time_step": 0.01})).summary
    key = "energy_dissipated"
    assert far["time_steps"] < 5000
    assert abs(far[key] - near[key]) <= far[key + "_error"] + near[key + "_error"]
    assert far[key + "_error"] < 1e-4 * far[key]


def test_a_drive_may_begin_deep_in_contact(run):
    found = run(deck(bodies=UNIT, force=EXPONENTIAL, numerics={"accuracy": 1e-2}, drive={
        "velocity": 1.0, "z_start": -1e4, "z_turn": -1.5e4}))
    assert found.curve["load"][0] == pytest.approx(2 / 3 * 1e6, rel=0.01)
    assert found.cost["iterations"] < 1e5
