"""Claims about laws without a repulsion in contact: their work of adhesion, the numbers that they
do not have, and paths that end where the bodies touch or fall onto each other."""

import math

import numpy as np
import pytest
from support.half_space import path_by_axis, sticky
from support.scenes import deck

RADIUS = 1e-6
# Each has the work of adhesion in its name's formula: stress times range, or the energy itself.
BOUNDED = {
    "dugdale": ({"stress": 1e7, "range": 1e-9}, 1e-2),
    "depletion": ({"osmotic_pressure": 1e5, "diameter": 1e-8}, 1e-3),
    "hydrophobic": ({"energy": 0.05, "decay_length": 1e-9}, 0.05),
    "capillary": ({"humidity": 0.5}, 0.1456),
}
FALLS = "the bodies fall onto each other"
AXIS = (*np.linspace(20, 3, 30), *np.linspace(2.9, 0.04, 60))
ENDS = (*np.arange(0, 6, 0.25), *np.geomspace(6, 150, 9))


def alone(stiffness=1e10, h0_end=0.0, **laws):
    return deck(bodies={"radius": RADIUS, "stiffness": stiffness}, **laws,
                equilibrium_path={"h0_end": h0_end})


@pytest.mark.parametrize("name", BOUNDED)
def test_the_work_of_adhesion_is_the_energy_at_contact(run, name):
    """Once it was the energy at an arbitrary gap, down to 177 times too small."""
    keys, work = BOUNDED[name]
    summary = run(alone(1e13, h0_end=2e-8, **{name: keys})).summary
    assert summary["surface_energy"] == pytest.approx(work, rel=1e-9)
    assert summary["dmt_pull_off"] == pytest.approx(2 * math.pi * RADIUS * work, rel=1e-9)


@pytest.mark.parametrize("name", ["depletion", "hydrophobic"])
def test_stiff_bodies_touch_under_the_tension_of_rigid_ones(run, name):
    keys, work = BOUNDED[name]
    result = run(alone(1e15, h0_end=-1e-9, **{name: keys}))
    assert FALLS in result.warnings[0]
    last = {key: result.curve[key][-1] for key in ("stable", "h0", "displacement", "load")}
    assert last["stable"] == 1 and abs(last["h0"] + last["displacement"]) < 1e-15
    # The step ends over its smoothing, of which meshes without a contact edge see different parts.
    assert -last["load"] == pytest.approx(2 * math.pi * RADIUS * work, rel=3e-2)


def test_a_singular_attraction_has_no_work_of_adhesion(run):
    result = run(alone(van_der_waals={"hamaker": 1e-20}))
    assert FALLS in result.warnings[0]
    assert not {"surface_energy", "sigma", "tabor", "jkr_pull_off"} & set(result.summary)


# Attraction at contact and repulsion outside, once a crash; a fold on the way over the barrier.
STICKY = {"hydrophobic": {"energy": 0.01, "decay_length": 0.5e-9},
          "hydration": {"energy": 0.005, "decay_length": 2e-9}}
UNBORN = {"van_der_waals": {"hamaker": 1e-20}, "double_layer": {"potential": 0.05, "salt": 10}}


@pytest.mark.parametrize("laws", [STICKY, UNBORN], ids=["exponentials", "double layer"])
def test_bodies_pressed_over_a_barrier_fall(run, laws):
    result = run(deck(bodies={"radius": 1.5e-2, "stiffness": 1e10}, **laws,
                      equilibrium_path={"h0_end": -2e-9}))
    assert FALLS in result.warnings[0]
    assert result.curve["stable"][0] == 1 and result.curve["stable"][-1] == 0


def test_the_folds_at_a_barrier_are_those_of_dense_states(run):
    summary = run(deck(
        bodies={"radius": 1.5e-2, "stiffness": 1e10}, **STICKY,
        equilibrium_path={"h0_end": -2e-9}, numerics={"accuracy": 1e-8})).summary
    # In units of 1 nm and 10 MPa, the attraction's stress over two.
    softness = 1e7 * math.sqrt(1.5e-2 / 1e-9) / 1e10
    _, folds = path_by_axis(softness, AXIS, ENDS, sticky)
    h0 = 1e9 * np.sort(summary["folds_h0"])
    assert h0 == pytest.approx(np.sort(folds[0]), abs=1e-6)
    unit = 2 * math.pi * 1.5e-2 * 1e7 * 1e-9
    assert np.sort(summary["folds_load"]) == pytest.approx(
        np.sort(folds[1] * unit / (2 * math.pi * softness)), rel=1e-6)


@pytest.mark.parametrize("shape", [
    {"kind": "parabola"}, {"kind": "sphere"}, {"kind": "cone", "half_angle": 1.3}])
def test_a_spring_pulls_bodies_of_any_shape_together_for_good(run, shape):
    """Once a crash: the largest pull was looked for at a separation of zero."""
    bodies = {"stiffness": 1e9} | ({"radius": RADIUS} if shape["kind"] != "cone" else {})
    force = {"law": "lennard_jones", "hamaker": 1e-20, "z0": 0.3e-9, "part": "attractive"}
    found = run(deck(bodies=bodies, shape=shape, force=force,
                     equilibrium_path={"h0_end": -1e-9}, device={"stiffness": [1.0]}))
    said = " ".join(found.warnings)
    assert FALLS in said and "no stable state is known" in said
    assert found.summary["device_jump_in_z"] > 0
    assert "device_jump_in_load_after" not in found.summary
