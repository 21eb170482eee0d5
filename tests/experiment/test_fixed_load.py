"""Claims about the equilibria under given loads."""

import numpy as np
import pytest
from support.scenes import deck, lennard_jones, loading, path_of, several

SIGMA = 0.87


def under(*loads, sigma=SIGMA, **groups):
    return lennard_jones(sigma, equilibrium_path={"h0_end": -2.0},
                         fixed_load={"load": [float(load) for load in loads]}, **groups)


def test_two_equilibria_under_tension_one_under_pressure_none_beyond_the_pull_off(run):
    # A load that is given twice has its own equilibria each time.
    found = run(under(-1.0, -4.0, 5.0, -1.0, -4.6))
    assert several(found.summary["fixed_load_equilibria"]) == [2, 2, 1, 2, 0]
    # Of two the nearer is stable: farther out the tension falls with the distance.
    assert several(found.summary["fixed_load_stable"]) == [1, 1, 1, 1, 0]
    table = found.table("fixed_load.csv")
    assert list(table["stable"]) == [0, 1, 0, 1, 1, 0, 1]
    assert (table["contact_radius"][table["stable"] == 1] > 0).all()
    for key in ("h0", "displacement", "contact_radius", "h0_error", "contact_radius_error"):
        np.testing.assert_array_equal(several(found.summary[f"fixed_load_{key}"]),
                                      [*table[key][table["stable"] == 1], np.nan])


def test_equilibria_have_the_load_that_stepping_h0_finds(run):
    table = run(under(-1.0, 5.0)).table("fixed_load.csv")
    for h0, displacement, load in zip(table["h0"], table["displacement"], table["load"]):
        # The outer one is stable at fixed h0, so both ways of stepping come to it.
        curve = run(lennard_jones(SIGMA, loading=loading(h0 + 1, h0, 0.5))).curve
        assert curve["load"][-1] == pytest.approx(load, rel=1e-6)
        assert curve["displacement"][-1] == pytest.approx(displacement, rel=1e-6)


def test_every_state_of_a_path_with_several_folds_is_found(run):
    # At large sigma the load falls, rises and falls again before contact.
    found = run(under(-4.0, sigma=8.7))
    path = run(lennard_jones(8.7, equilibrium_path={"h0_end": -2.0})).curve
    crossings = np.count_nonzero(np.diff(path["load"] < -4.0))
    # And one that lies behind the end of the path that is shown.
    h0 = found.table("fixed_load.csv")["h0"]
    assert crossings == np.count_nonzero(h0 > -2.0)
    assert several(found.summary["fixed_load_stable"]) == [1]


def test_a_faint_tension_is_met_by_undeformed_bodies(run):
    load = -1e-9
    table = run(under(load)).table("fixed_load.csv")
    assert table["h0"][0] == pytest.approx((16 * np.pi * SIGMA / (6 * -load)) ** 0.5, rel=1e-8)


def test_a_load_that_fades_by_orders_of_magnitude_has_its_own_zeros_alone(run):
    """Outside a step a repulsion of short range fades far out: the bodies have no equilibria under
    no load there, no outer well, and a dead load holds them up to the barrier."""
    found = run(path_of(2.5, -4.0, radius=1.0, force=None,
                        dugdale={"stress": 1.0, "range": 1.0, "smoothing": 0.02},
                        hydration={"pressure": 20.0, "decay_length": 0.07},
                        fixed_load={"load": [0.0]}, device={"stiffness": [0.0]}))
    table = found.table("fixed_load.csv")
    assert list(table["stable"]) == [0, 1]
    assert not any(key.startswith("secondary") for key in found.summary)
    jump_in = found.table("device_jumps.csv")["h0"][0]
    assert jump_in == pytest.approx(several(found.summary["load_folds_h0"])[0], rel=1e-8)
    assert jump_in < 1.2


@pytest.mark.parametrize("groups", [{}, {"device": {"stiffness": [0.01, 1.0, 100.0]}}])
def test_a_load_that_underflows_far_out_is_no_state_without_load(run, groups):
    """A soft spring has the path begin where the load of undeformed bodies is zero by rounding."""
    found = run(deck(
        bodies={"radius": 1e-6, "stiffness": 1e9},
        hydration={"pressure": 1.2182e9, "decay_length": 2e-10},
        hydrophobic={"energy": 0.139614, "decay_length": 4e-10},
        equilibrium_path={"h0_end": -3e-9}, fixed_load={"load": [0.0]}, **groups))
    assert found.table("fixed_load.csv")["h0"] == pytest.approx([-1.86793e-9], rel=1e-5)


@pytest.mark.parametrize("groups, warned", [
    ({"fixed_load": {"load": [1e-3]}}, "the slope at the contact's edge is 1.15"),
    ({"device": {"stiffness": [10.0], "z_end": -3e-6}}, "the slope at the contact's edge is 0.36")])
def test_states_far_beyond_the_end_of_the_path_are_judged_too(run, groups, warned):
    """The path ends at a nanometre; a contact wider than the radius had no warning."""
    found = run(path_of(1e9, -1e-9, radius=1e-6,
                        force={"law": "lennard_jones", "hamaker": 1e-19, "z0": 0.4e-9}, **groups))
    assert warned in str(found.summary["warnings"])


def test_states_that_no_drive_reaches_are_not_judged(run):
    """The last step of the path goes beyond its end, farther with less accuracy."""
    widest = [run(path_of(1e9, -1e-9, accuracy, radius=1e-6,
                          force={"law": "lennard_jones", "hamaker": 1e-19, "z0": 0.4e-9},
                          **groups)).summary["contact_over_radius"]
        for accuracy in (1e-4, 1e-6) for groups in ({}, {"device": {"stiffness": 10.0}})]
    assert widest == pytest.approx(4 * [widest[0]], rel=1e-4)


def test_states_beyond_the_points_of_files_have_a_warning(run, tmp_path):
    r, h = np.linspace(0, 1e-7, 20), np.geomspace(3.9e-10, 1e-7, 200)
    np.savetxt(tmp_path / "r.txt", np.column_stack([r, r**2 / 2e-6]))
    pressure = 1e-19 / (6 * np.pi * h**3) * ((4e-10 / h)**6 - 1)
    np.savetxt(tmp_path / "h.txt", np.column_stack([h, pressure]), "%.15e")
    found = run(path_of(1e9, -3e-8, 1e-3, radius=None, force=None,
                        shape={"kind": "profile", "file": str(tmp_path / "r.txt")},
                        tabulated={"file": str(tmp_path / "h.txt"), "tail_exponent": 3}))
    warnings = str(found.summary["warnings"])
    assert "the contact reaches 1.87e-7 m" in warnings
    assert "gaps are down to 3.79e-10 m" in warnings


def test_a_film_pressed_through_by_a_load_beyond_the_path_has_a_warning(run):
    found = run(deck(
        bodies={"radius": 1e-5, "young": 70e9, "poisson": 0.2},
        layer={"thickness": 1e-7, "young": 3e6, "poisson": 0.45},
        force={"law": "lennard_jones", "surface_energy": 0.02, "z0": 2e-9},
        equilibrium_path={"h0_end": -5e-9}, fixed_load={"load": [2e-6]}))
    assert "0.301 of the thickness of the layers" in str(found.summary["warnings"])
