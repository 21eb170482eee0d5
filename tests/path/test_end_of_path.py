"""Claims about where a path ends, whatever the accuracy: in a contact outside a barrier if this is
stable at h0_end, as a loading does; and how far it goes for springs."""

import numpy as np
import pytest
from support.scenes import deck, several

ACCURACIES = (1e-2, 1e-3, 1e-4, 1e-6, 1e-8)

# Soft bodies whose outer contact is stable at the last h0, and a barrier of each kind.
OUTER = {
    "a meniscus inside a strong repulsion": dict(
        bodies={"radius": 9.174e-4, "stiffness": 1.034e10}, born={"z0": 1.3048e-9},
        capillary={"humidity": 0.33307, "contact_angle": 0.73114},
        van_der_waals={"hamaker": 1e-20}, h0_end=-6.1765e-9),
    "hydration": dict(
        bodies={"radius": 9.188e-5, "stiffness": 2.0338e9}, born={"z0": 5.8893e-10},
        hydration={"energy": 0.1098, "decay_length": 1.2338e-9},
        van_der_waals={"hamaker": 8.877e-19}, h0_end=-8.3063e-9),
    "a double layer": dict(
        bodies={"radius": 1.5e-2, "stiffness": 1.2547e8}, born={"z0": 4.842e-10},
        double_layer={"potential": -0.0933, "regulation": 0.179, "salt": 18.12},
        van_der_waals={"hamaker": 1e-19}, h0_end=-2e-8),
}
SPRINGS = {
    "a jump far beyond h0_end": (OUTER["hydration"], [4.234e4, 4129.6]),
    "a landing beyond h0_end": (dict(
        bodies={"radius": 2.2588e-6, "stiffness": 1.46785e9}, born={"z0": 5.167e-10},
        hydration={"energy": 0.39272, "decay_length": 6.0655e-10},
        van_der_waals={"hamaker": 2.77587e-18}, h0_end=-2.5258e-9), [6094.43, 233.24, 90.216]),
}
JUMPS = [f"device_jump_{way}_{what}" for way in ("in", "out")
         for what in ("z", "load", "load_after")]


def scene(h0_end, accuracy, **groups):
    return deck(**groups, equilibrium_path={"h0_end": h0_end}, numerics={"accuracy": accuracy})


@pytest.mark.parametrize("name", OUTER)
def test_a_path_ends_in_the_outer_contact_of_a_loading_at_any_accuracy(run, name):
    """The accuracy decided: at some the path went on to where the barrier gives way."""
    loaded = {**OUTER[name]}
    end = loaded.pop("h0_end")
    stepped = run(deck(**loaded, loading={"h0_start": 1.5e-8, "h0_end": end, "h0_step": 5e-9},
                       numerics={"accuracy": 1e-6})).summary["end_load"]
    for accuracy in ACCURACIES:
        found = run(scene(accuracy=accuracy, **OUTER[name]))
        assert found.summary["end_load"] == pytest.approx(stepped, rel=max(accuracy, 1e-6))
        assert not {"jump_in_h0", "energy_lost"} & set(found.summary)


def test_springs_do_not_change_where_the_path_ends(run):
    groups, springs = SPRINGS["a jump far beyond h0_end"]
    alone = run(scene(accuracy=1e-4, **groups)).summary
    driven = run(scene(accuracy=1e-4, **groups, device={"stiffness": springs}, table={}))
    for key in ("end_load", "max_tension"):
        assert driven.summary[key] == pytest.approx(alone[key], rel=1e-6)
    assert driven.table("table.csv")["load"].max() == pytest.approx(alone["end_load"], rel=1e-4)


@pytest.mark.slow
def test_a_path_beyond_its_end_says_so(run):
    """At h0_end a barrier keeps these bodies apart, without contact; only far below they come
    together, and the path goes there."""
    groups = {**OUTER["a double layer"], "h0_end": -2.05e-9}
    for accuracy in (1e-2, 1e-5):
        found = run(scene(accuracy=accuracy, **groups))
        assert found.summary["jump_in_h0"] < -2.5e-7 and found.summary["end_load"] < 0
        assert any("a barrier keeps the bodies apart down to" in said for said in found.warnings)


@pytest.mark.parametrize("name", SPRINGS)
def test_springs_are_followed_into_contact_at_any_accuracy(run, name):
    """Jumps and landings beyond h0_end were found at some accuracies, and NaN at others."""
    groups, springs = SPRINGS[name]
    exact = None
    for accuracy in reversed(ACCURACIES):
        summary = run(scene(accuracy=accuracy, **groups, device={"stiffness": springs})).summary
        found = np.array([several(summary[key]) for key in JUMPS], float)
        assert np.isfinite(found).all()
        exact = found if exact is None else exact
        np.testing.assert_allclose(found, exact, rtol=max(accuracy, 1e-6))


def test_springs_over_six_decades_do_not_depend_on_where_the_path_ends(run):
    groups = {**OUTER["hydration"]}
    springs = [float(k) for k in np.geomspace(1e6, 1.0, 7)]
    found = []
    for h0_end in (2e-9, -3e-9, groups.pop("h0_end"), -60e-9):
        summary = run(scene(h0_end, 1e-5, **groups, device={"stiffness": springs})).summary
        found.append([several(summary[key]) for key in JUMPS])
    for one in found[1:]:
        np.testing.assert_allclose(one, found[0], rtol=1e-4)
    assert np.isfinite(found[0]).all()


def test_bodies_too_soft_for_a_barrier_turn_outside_it(run):
    """Within the model they do not come through; springs turn at h0_end, at any accuracy."""
    groups = dict(bodies={"radius": 9.188e-5, "stiffness": 2e7}, born={"z0": 5.8893e-10},
                  hydration={"energy": 0.1098, "decay_length": 1.2338e-9},
                  van_der_waals={"hamaker": 8.877e-19}, h0_end=-8.3e-9)
    for accuracy in (1e-2, 1e-4, 1e-6):
        found = run(scene(accuracy=accuracy, **groups, device={"stiffness": [1e3, 10.0]}))
        assert found.summary["converged"]
        table = found.table("device.csv")
        assert table["h0"][table["direction"] != "path"].min() == pytest.approx(-8.3e-9, rel=1e-9)
