"""Claims about contact that lies behind a barrier: scan and path of DLVO forces and of a simpler
law with a barrier, against equations and elastic states that share nothing with the program."""

import functools
import math

import f90nml
import numpy as np
import pytest
import snapin
from conftest import ROOT
from support.calculus import zero
from support.dlvo import Dlvo
from support import half_space
from support.half_space import path_by_axis
from support.scenes import JKR, agreeing, of_numbers, path_of

DECK = ROOT / "inputs" / "examples" / "dlvo.nml"
# Gaps on the axis from far away into contact, and panels, narrow where the contact has its edge.
AXIS = (*np.linspace(12, 3, 12), *np.linspace(2.8, 1.1, 18), *np.linspace(1.09, 1.0, 14))
ENDS = (*np.arange(0, 1.8, 0.15), 1.8, 2.2, 2.7, 3.4, 4.4, *np.geomspace(6, 300, 8))


# --- Lennard-Jones and a repulsion of ten times its range


def behind_a_barrier(sigma, accuracy, h0_end=-1.0):
    """The summary of a path; sigma is that of the Lennard-Jones part, lengths are in z0."""
    return snapin.run({
        "bodies": {"radius": 1.0, "stiffness": 1.0},
        "force": {"law": "lennard_jones", "hamaker": 16 * math.pi * sigma, "z0": 1.0},
        "hydration": {"pressure": 0.03 * sigma, "decay_length": 10.0},
        "equilibrium_path": {"h0_end": h0_end},
        "numerics": {"accuracy": accuracy},
    }).summary


@pytest.mark.parametrize("accuracy", [1e-6, 1e-8])
def test_a_barrier_changes_tension_and_jumps_as_another_program_found(accuracy):
    found = behind_a_barrier(1.0, accuracy)
    # Its digits, to half a unit of the last.
    assert found["max_tension"] / JKR == pytest.approx(0.736483, abs=5e-7)
    assert found["max_tension_h0"] == pytest.approx(2.09881, abs=5e-6)
    assert found["jump_in_h0"] == pytest.approx(2.85785, abs=5e-6)
    assert found["jump_in_load"] == pytest.approx(-0.01136, abs=5e-6)
    assert found["jump_out_h0"] == pytest.approx(3.36022, abs=5e-6)
    assert found["jump_out_load"] == pytest.approx(-1.5618, abs=5e-5)


@pytest.mark.parametrize("h0_end", [0.0, -6.0])
def test_the_path_does_not_depend_on_gaps_where_no_force_acts(h0_end):
    """The mesh ends the farther out the deeper the path goes: gaps there are 10^7 z0 and more."""
    found = behind_a_barrier(1.0, 1e-8, h0_end)
    assert not of_numbers(found.get("warnings", []))
    assert found["jump_out_h0"] == pytest.approx(3.360222026703, rel=1e-11)


@pytest.mark.parametrize("accuracy", [2e-5, 1e-5])
def test_a_path_does_not_end_just_before_a_barrier_gives_way(accuracy):
    """Bodies that are stable at h0_end come near before the barrier gives way, far below h0_end; a
    path that ended there, as some accuracies had it, had no contact at h0_end."""
    agreeing(snapin.run, lambda each: path_of(
        125465636.12137541, -2.0483375925639015e-09, each, force=None,
        van_der_waals={"hamaker": 1e-19}, born={"hamaker": 1e-19, "z0": 4.842064940925915e-10},
        double_layer={"potential": -0.09329605816529256, "regulation": 0.17932669570039272,
                      "salt": 18.12033177346722, "valence": 1}), (accuracy, 1e-6),
        ("folds_h0", "folds_load", "jump_out_load", "end_load"), lambda _: 1e-5)


def test_jumps_of_a_law_with_a_barrier_are_those_of_independent_states():
    _, (h0, load) = path_by_axis(1.0, AXIS, ENDS, half_space.behind_a_barrier)
    found = behind_a_barrier(1.0, 1e-8)
    assert [found["jump_in_h0"], found["jump_out_h0"]] == pytest.approx(h0, rel=1e-9)
    # Beside a fold the load goes with the root of an error in H0.
    assert [found["jump_in_load"], found["jump_out_load"]] == pytest.approx(load, abs=1e-8)


# --- DLVO forces


@functools.cache
def scene():
    """The result of the example, its numbers, and the law from the equations."""
    keys = f90nml.read(DECK)
    layers = {name: keys["double_layer"][name] for name in ("potential", "regulation", "salt")}
    law = Dlvo(**keys["van_der_waals"], z0=keys["born"]["z0"], **layers)
    return snapin.run(DECK), keys["bodies"], law


def test_the_scan_finds_the_extrema_of_the_equations():
    summary, law = scene()[0].summary, scene()[2]

    pressure, slope, energy = (lambda gap, k=k: float(law(np.array([gap]))[k][0]) for k in range(3))
    rest = zero(pressure, 0.25e-9, 0.35e-9)
    top = zero(pressure, 0.4e-9, 3e-9)
    bottom = zero(pressure, 20e-9, 50e-9)
    assert summary["rest_gap"] == pytest.approx(rest, rel=1e-9)
    assert summary["work_of_adhesion"] == pytest.approx(-energy(rest), rel=1e-7)
    assert summary["edge_gap"] == pytest.approx(zero(slope, 0.32e-9, 0.5e-9), rel=1e-9)
    assert summary["barrier_energy"] == pytest.approx(energy(top), rel=1e-7)
    steepest = zero(slope, top, 10e-9)
    assert summary["barrier_pressure"] == pytest.approx(pressure(steepest), rel=1e-7)
    assert summary["secondary_minimum_gap"] == pytest.approx(bottom, rel=1e-7)
    assert summary["secondary_minimum_energy"] == pytest.approx(energy(bottom), rel=1e-6)


def test_before_the_jump_the_load_is_that_of_undeformed_bodies():
    result, bodies, law = scene()
    assert "warnings" not in result.summary
    loading = result.curve[result.curve["branch"] == "loading"]
    before = loading[loading["h0"] > result.summary["jump_in_h0"]]
    sphere = 2 * math.pi * bodies["radius"]
    deepest = sphere * result.summary["secondary_minimum_energy"]
    assert before["load"].min() == pytest.approx(deepest, rel=1e-3)
    highest = sphere * result.summary["barrier_energy"]
    assert before["load"].max() == pytest.approx(highest, rel=0.01)
    # Outside the barrier the load lies between those of the gap that was and of the gap that is.
    before = before[before["h0"] > 2e-9]
    assert len(before) > 200
    ends = np.array([sphere * law(before[gap])[2] for gap in ("h0", "h_centre")])
    slack = 1e-6 * abs(deepest)
    assert (before["load"] >= ends.min(axis=0) - slack).all()
    assert (before["load"] <= ends.max(axis=0) + slack).all()


@pytest.mark.slow
def test_dlvo_jumps_are_those_of_independent_states():
    result, bodies, law = scene()
    z0 = law.z0
    energy = law.hamaker / (16 * math.pi * z0**2)
    sigma = energy * math.sqrt(bodies["radius"] * z0) / (bodies["stiffness"] * z0**2)
    _, (h0, load) = path_by_axis(
        sigma, (20.0, 16.0, *AXIS), ENDS, half_space.in_units(law, z0, energy))
    summary = result.summary
    # The pushing load before the jump: the bodies are over the barrier under compression.
    assert summary["jump_in_load"] > 0
    assert [summary["jump_in_h0"], summary["jump_out_h0"]] == pytest.approx(h0 * z0, rel=1e-7)
    unit = energy * bodies["radius"] / sigma
    assert [summary["jump_in_load"], summary["jump_out_load"]] == pytest.approx(
        load * unit, rel=1e-6)


def test_a_soft_spring_jumps_at_the_top_of_the_barrier_and_lands_pushing():
    deck = DECK.read_text().split("&loading")[0]
    deck += "&equilibrium_path h0_end = -4e-9 /\n&device stiffness = 1.0 /\n"
    found = snapin.run(deck).summary
    summary = scene()[0].summary
    # Below the top by the square of the spring over the curve's own stiffness.
    highest = 2 * math.pi * scene()[1]["radius"] * summary["barrier_energy"]
    before, after = found["device_jump_in_load"], found["device_jump_in_load_after"]
    assert highest < before < 1.02 * highest
    # The drive stands still while the bodies close by a nanometre or two.
    assert 0 < before - after < 3e-9 * 1.0
    assert found["device_energy_lost"] == pytest.approx(found["device_cycle_energy"], rel=1e-6)
