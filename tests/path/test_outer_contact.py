"""Claims about soft bodies in contact in an outer minimum of an oscillating force: layers of liquid
remain between them, the contact has an edge of its own and grows while the axis rests."""

import functools

import numpy as np
import pytest
import snapin
from support.half_space import HalfSpace, lennard_jones
from support.scenes import agreeing, path_of

RADIUS, STIFFNESS, HAMAKER, Z0 = 0.94e-6, 42e6, 3.3e-21, 0.37e-9
AMPLITUDE, PERIOD, DECAY = 18e6, 0.53e-9, 0.42e-9
SCENE = {
    "bodies": {"radius": RADIUS, "stiffness": STIFFNESS},
    "van_der_waals": {"hamaker": HAMAKER},
    "born": {"z0": Z0},
    "structural": {"amplitude": AMPLITUDE, "period": PERIOD, "decay_length": DECAY},
}
# Panels to beyond the last ring that deforms the bodies.
ENDS = (*np.arange(0, 7.01, 0.1), *np.arange(7.4, 14, 0.4), *np.geomspace(14, 300, 12))


def force(gap):
    """Pressure, slope and energy of the scene's force in units of z0 and of the surface energy of
    its Lennard-Jones part over z0."""
    energy = HAMAKER / (16 * np.pi * Z0**2)
    amplitude, rate = AMPLITUDE * Z0 / energy, -Z0 / DECAY + 2j * np.pi * Z0 / PERIOD
    wave = -amplitude * np.exp(rate * gap)
    waves = wave.real, (rate * wave).real, -(wave / rate).real
    return tuple(map(sum, zip(lennard_jones(gap), waves)))


@functools.cache
def found(accuracy):
    return snapin.run({**SCENE, "numerics": {"accuracy": accuracy},
                       "equilibrium_path": {"h0_end": -4e-9}})


def test_the_path_goes_through_two_outer_contacts():
    summary = found(1e-6).summary
    assert summary["converged"]
    # A fold at which two meshes meet is on either of them, as rounding decides, and one of them is
    # too coarse for the farthest ring: the estimate, 4e-6, says so.
    assert summary["error_estimate"] < 1e-5
    assert len(summary["folds_h0"]) == 6
    # The axis rests in the second and in the first minimum outside the contact proper.
    axis = found(1e-6).curve["h_centre"]
    for minimum in (1.4e-9, 0.9e-9):
        assert (abs(axis - minimum) < 0.06e-9).sum() > 20
    assert found(1e-6).curve["contact_radius"].max() == 0


@pytest.mark.parametrize("name", ["folds_h0", "folds_load", "max_tension", "end_load"])
def test_numbers_of_outer_contacts_are_within_their_errors(name):
    """Errors far below the accuracy may exceed estimates, which compare meshes of equal panels."""
    near, exact = found(1e-6).summary, found(1e-9).summary
    allowed = np.maximum(near[name + "_error"], 1e-9 * np.abs(near[name]))
    assert (abs(np.subtract(near[name], exact[name])) <= allowed).all()


@pytest.mark.slow
def test_a_small_contact_far_inside_a_sharp_rim_has_meshes_for_narrow_bands():
    """A path that was lost: the last layer leaves the middle of a wide outer contact, and meshes
    for the small contact there, for all its radii at once, did not resolve the rim."""
    runs = agreeing(snapin.run, lambda accuracy: path_of(
        3.499e8, -2.272e-8, accuracy, radius=1.876e-6, force=None,
        van_der_waals={"hamaker": 1.205e-21}, born={"z0": 4.007e-10},
        structural={"amplitude": 2.235e7, "period": 8.46e-10, "decay_length": 1.163e-9}),
        (1e-4, 1e-6), ("folds_h0", "max_tension", "jump_in_h0", "jump_out_h0", "end_load"),
        lambda _: 1e-5)
    assert not any("warnings" in one.summary for one in runs)
    assert runs[0].summary["error_estimate"] < 1e-4 and len(runs[0].summary["folds_h0"]) > 4


@pytest.mark.parametrize("h0", [1e-9, -1e-9, -2e-9])
def test_outer_contacts_are_those_of_independent_states(h0):
    """Newton's method from the program's gaps, for equations that share nothing with it."""
    states = snapin.run({**SCENE, "numerics": {"accuracy": 1e-8}, "profiles": {"h0": h0},
                         "loading": {"h0_start": 4e-9, "h0_end": h0, "h0_step": 4e-9 - h0}})
    profile, lateral = states.profiles, np.sqrt(RADIUS * Z0)
    energy = HAMAKER / (16 * np.pi * Z0**2)
    s = energy * lateral / (STIFFNESS * Z0**2)
    bodies = HalfSpace(ENDS, order=10)
    gap = bodies.from_gaps(force, s, h0 / Z0, profile["r"] / lateral, profile["separation"] / Z0)
    assert states.curve["h_centre"][-1] == pytest.approx(gap[0] * Z0, rel=1e-7)
    load = bodies.load(force, s, gap) * energy * RADIUS / s
    assert states.curve["load"][-1] == pytest.approx(load, rel=1e-6)


def test_a_contact_outside_a_barrier_is_that_of_an_independent_state():
    """Under any law with a barrier the path ends in the outer minimum if this is stable at the last
    h0; it went on to where the barrier gives way, a thousand times as deep."""
    radius, stiffness, hamaker, z0, h0 = 1.5e-2, 6.56e7, 1e-19, 5e-10, -8.6e-9
    work, decay = 9.82e-3, 7.034e-10
    energy, lateral = hamaker / (16 * np.pi * z0**2), np.sqrt(radius * z0)

    def force(gap):
        repulsion, rate = work / energy * np.exp(-gap * z0 / decay), z0 / decay
        hydration = rate * repulsion, -rate**2 * repulsion, repulsion
        return tuple(map(sum, zip(lennard_jones(gap), hydration)))

    states = snapin.run({
        "bodies": {"radius": radius, "stiffness": stiffness},
        "force": {"law": "lennard_jones", "hamaker": hamaker, "z0": z0},
        "hydration": {"energy": work, "decay_length": decay},
        "equilibrium_path": {"h0_end": h0}, "profiles": {"h0": h0}, "numerics": {"accuracy": 1e-8}})
    assert not states.summary.get("warnings")
    profile = states.profiles
    bodies = HalfSpace((*np.arange(0, 60, 0.5), *np.geomspace(60, 3000, 14)), order=10)
    s = energy * lateral / (stiffness * z0**2)
    gap = bodies.from_gaps(force, s, h0 / z0, profile["r"] / lateral, profile["separation"] / z0)
    # The edge of the contact is where the tension outside the minimum is largest.
    assert 4 < gap[0] < 7 and profile["pressure"].min() < 0 < profile["pressure"][0]
    assert states.summary["end_load"] == pytest.approx(
        bodies.load(force, s, gap) * energy * radius / s, rel=1e-6)
