"""Claims about drives that are refused, lost or doubtful."""

import math

import pytest
from support.driven import scene
from support.scenes import UNIT, deck, lennard_jones


@pytest.mark.parametrize("change, message", [
    ({"viscoelastic": {"stiffness_relaxed": 2.0, "retardation_time": 1.0}},
     "above the instantaneous"),
    ({"drive": {"velocity": 1.0, "z_start": 10.0, "z_turn": -1.0, "z_end": 1e16}},
     "h0 reaches 1e16 m, more than 1e15 of these lengths"),
    ({"drive": {"velocity": 1.0, "z_start": 10.0, "z_turn": -1e16}}, "more than 1e15"),
    ({"viscoelastic": {"retardation_time": 1.0}}, "give one of"),
    ({"viscoelastic": {"compliance": [1.0, 2.0], "retardation_time": 1.0}}, "1 value for 2 terms"),
    ({"drive": None, "viscoelastic": {"stiffness_relaxed": 0.5, "retardation_time": 1.0},
      "equilibrium_path": {"h0_end": 0.0}}, "needs &drive"),
    ({"drive": {"velocity": 1.0, "z_start": 1.0, "z_turn": 2.0}}, "is not above z_turn"),
    ({"drive": {"velocity": 1.0, "z_start": 3.0, "z_turn": 2.0, "time_step": 1e-9}}, "steps"),
    ({"equilibrium_path": {"h0_end": 0.0}}, "which &drive does not have"),
    ({"bodies": {"radius": 1.0, "rigid": True}}, "needs bodies that deform, or &fluid"),
    ({"bodies": {"radius": 1.0, "rigid": True}, "fluid": {"viscosity": 1.0},
      "viscoelastic": {"stiffness_relaxed": 1.0, "retardation_time": 1.0}}, "these are rigid"),
    ({"fluid": {"slip_length": 1.0}}, '&fluid: key "viscosity"'),
    ({"fluid": {"viscosity": 1.0, "slip_length": [1.0, 2.0, 3.0]}}, '&fluid: key "slip_length"'),
    ({"fluid": {"viscosity": 1.0}, "drive": None, "equilibrium_path": {"h0_end": 0.0}},
     "&fluid: needs &drive"),
    ({"fluid": {"viscosity": 1.0}, "shape": {"kind": "rounded_punch", "flat_radius": 3.0}},
     "&fluid: is for parabolas"),
    ({"fluid": {"viscosity": 1.0}, "force": {"law": "exponential", "p0": 1.0, "decay_length": 1.0}},
     "&fluid: needs a force that attracts"),
])
def test_mistakes_are_named(run, change, message):
    groups = {"bodies": UNIT, "force": {"law": "lennard_jones", "surface_energy": 0.1, "z0": 1.0},
              "drive": {"velocity": 1.0, "z_start": 10.0, "z_turn": -1.0}}
    assert message in run(deck(**groups | change), status=2).stderr


def test_a_start_in_contact_is_refused(run):
    found = run(scene(2.0, 4.0, start=0.5, turn=-1.0), status=1)
    assert any("start farther apart" in text for text in found.summary["warnings"])
    # There are no numbers whose error could be estimated.
    assert not any("error" in text for text in found.summary["warnings"])


@pytest.mark.long
def test_a_fast_drive_of_soft_bodies_is_as_exact_as_it_says(run):
    rough, fine = (run(scene(4.0, 80.0, velocity=20.0, start=80.0, turn=-8.0, accuracy=accuracy)
                       ).summary for accuracy in (1e-2, 1e-3))
    assert rough["error_estimate"] <= 1e-2 and fine["error_estimate"] <= 1e-3
    for key in ("max_tension", "energy_dissipated"):
        assert abs(rough[key] - fine[key]) <= rough[f"{key}_error"] + fine[f"{key}_error"]


@pytest.mark.slow
def test_bodies_that_are_lost_have_no_numbers(run):
    # A fluid that hardly resists, between bodies fifty times as soft at rest. Rounding decides
    # whether the bodies are lost or come to the end with an unknown error.
    found = run(lennard_jones(
        0.1, drive={"velocity": 5.0, "z_start": 60.0, "z_turn": -2.0},
        viscoelastic={"stiffness_relaxed": 0.02, "retardation_time": 1.0},
        fluid={"viscosity": 1e-6}, numerics={"accuracy": 1e-2}), status=None)
    lost = any("the curve ends there" in text for text in found.warnings)
    assert lost == (found.status == 1) == ("energy_dissipated" not in found.summary)
    if lost:
        assert any("after" in text and ("no further state was found;" in text) != (
            "too many steps" in text) for text in found.warnings)
        assert any("the error could not be estimated" in text for text in found.warnings)


@pytest.mark.slow
def test_a_drive_of_too_many_steps_says_so(run):
    # With halved steps they are a few more than the largest number.
    found = run(deck(
        bodies={"radius": 1e-5, "rigid": True},
        force={"law": "lennard_jones", "hamaker": 1e-21, "z0": 0.2e-9},
        fluid={"viscosity": 1e-3},
        drive={"velocity": 1e-6, "z_start": 20e-9, "z_turn": 10e-9, "time_step": 20e-3 / 39999},
        numerics={"accuracy": 1e-2}), status=1)
    said = " ".join(found.warnings)
    assert "there were too many steps or jumps" in said and "no further state" not in said
    # It is unknown, but a number.
    assert 1 <= found.summary["error_estimate"] < math.inf


def test_a_drive_may_begin_where_loads_underflow(run):
    """Steps without any load became ever shorter."""
    found = run(deck(bodies={"radius": 1e-5, "stiffness": 1e9},
                     hydrophobic={"energy": 1e-3, "decay_length": 0.3e-9},
                     hydration={"energy": 2e-3, "decay_length": 0.15e-9},
                     drive={"velocity": 1e-6, "z_start": 4e-7, "z_turn": -5e-9}))
    assert found.curve["load"][0] == 0
    assert not found.warnings


def test_a_largest_tension_at_the_end_has_a_warning(run):
    def drive(end):
        return run(deck(
            bodies={"radius": 1e-6, "stiffness": 2.2e9},
            force={"law": "lennard_jones", "surface_energy": 0.05, "z0": 0.5e-9},
            drive={"velocity": 1e-6, "z_start": 60e-9, "z_turn": -20e-9, "z_end": end,
                   "stiffness": 1.0}, numerics={"accuracy": 1e-3}))
    # The spring parts the bodies after 250 nm.
    held, apart = drive(60e-9), drive(300e-9)
    for found, warned in ((held, True), (apart, False)):
        assert any("largest at the end" in text for text in found.warnings) is warned
        last = -found.curve["load"][-1]
        assert (abs(found.summary["max_tension"] / last - 1) < 1e-12) == warned
    assert held.summary["max_tension"] < 0.9 * apart.summary["max_tension"]


@pytest.mark.slow
def test_what_bodies_keep_of_their_start_is_told_where_it_matters(run):
    """Relaxed bodies are drawn out at z_start. Fast ones keep this and pull less than elastic ones,
    by ten times the error or more; slow ones forget it; from farther away there is none."""
    bodies = {"radius": 1e-6, "stiffness": 2.2e10}
    force = {"law": "lennard_jones", "z0": 0.5e-9, "surface_energy": 0.05}
    elastic = run(deck(bodies=bodies, force=force, equilibrium_path={"h0_end": -2e-9})).summary

    def drive(velocity, start):
        return run(deck(
            bodies=bodies, force=force, numerics={"accuracy": 1e-3},
            viscoelastic={"stiffness_relaxed": 2.2e9, "retardation_time": 1e-3},
            drive={"velocity": velocity, "z_start": start, "z_turn": -2e-9, "z_end": 2e-8}))

    for start in (2e-9, 4e-9):
        fast = drive(0.1, start)
        change = 1 - fast.summary["max_tension"] / elastic["max_tension"]
        assert change > 10 * fast.summary["max_tension_error"] / fast.summary["max_tension"]
        (said,) = [one for one in fast.warnings if "already drawn out" in one]
        # The estimate is linear in the deformation.
        told = float(said.split("a part of ")[1].split(",")[0])
        assert change < told < 2.5 * change
    near, far = drive(1e-7, 2e-9), drive(0.1, 4e-8)
    assert not any("already drawn out" in one for one in near.warnings + far.warnings)
    assert near.summary["max_tension"] == pytest.approx(
        drive(1e-7, 1e-8).summary["max_tension"], rel=2e-3)
