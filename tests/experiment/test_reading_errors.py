"""Claims about errors of what is read from the path: springs, fixed loads, tables, regimes."""

import math
import subprocess

import numpy as np
import pytest
from support.processes import HANG
from support.scenes import lennard_jones, loading, path_of, several

# Strength of adhesion, accuracy, stiffness over sigma, load over sigma.
SCENES = [(0.02, 1e-4, 0.3, -1.0), (0.87, 1e-5, 3.0, 2.0), (8.7, 1e-6, 0.05, -3.0),
          (300.0, 1e-4, 0.5, 4.0)]
KEYS = [*(f"device_jump_{way}_{what}" for way in ("in", "out")
          for what in ("z", "load", "load_after")), "device_energy_lost", "device_cycle_energy",
        "regime_load_number", "regime_error_jkr", "regime_error_hertz"]


def scene(sigma, stiffness, load, accuracy):
    return lennard_jones(sigma, equilibrium_path={"h0_end": -1.0},
                         device={"stiffness": sigma * stiffness},
                         fixed_load={"load": [0.5 * sigma, load * sigma]}, table={}, regime={},
                         numerics={"accuracy": accuracy})


@pytest.fixture(scope="module", params=SCENES, ids=lambda scene: f"sigma {scene[0]}")
def pair(request, run):
    """The same scene at an accuracy, and far more accurate."""
    sigma, accuracy, stiffness, load = request.param
    return tuple(run(scene(sigma, stiffness, load, each)) for each in (accuracy, 1e-10))


def test_what_is_read_is_off_by_no_more_than_estimated(pair):
    found, truth = pair
    compared = 0
    for key in KEYS:
        values, errors, exact = (
            np.array(several(result.summary[name]), float)
            for result, name in ((found, key), (found, f"{key}_error"), (truth, key)))
        there = np.isfinite(exact)
        assert (np.isfinite(values) == there).all() and (np.isfinite(errors) == there).all()
        off = abs(values - exact)[there]
        # Below a digit of the truth's own error nothing is told.
        own = np.array(several(truth.summary[f"{key}_error"]), float)[there]
        assert (off <= errors[there] + 3 * own).all(), key
        if "energy" not in key and "regime" not in key:
            assert (errors[there] <= 100 * found.summary["error_estimate"] * abs(exact[there])
                    + 1e-6 * abs(exact[there]).max()).all()
        else:
            # Errors of theories are fractions.
            size = np.maximum(abs(exact[there]), float("regime" in key))
            assert (errors[there] <= 1e-3 * size).all(), key
        compared += there.sum()
    # One of each but of the errors of theories, which are three; Hertz's has fewer where bodies
    # adhere strongly.
    assert compared == (15 if found.summary["sigma"] < 0.1 else 13)


def test_rows_under_fixed_loads_have_errors_that_hold(pair):
    found, truth = (result.table("fixed_load.csv") for result in pair)
    assert len(found["h0"]) == len(truth["h0"]) > 0
    for key in "h0", "displacement", "contact_radius":
        off = abs(found[key] - truth[key])
        assert (off <= found[f"{key}_error"] + 3 * truth[f"{key}_error"]).all(), key


def test_the_estimate_of_the_run_covers_what_is_read(pair):
    found, truth = pair
    estimate = found.summary["error_estimate"]
    for key in KEYS[:6]:
        exact = np.array(several(truth.summary[key]), float)
        assert np.isfinite(exact).tolist() == [True]
        off = abs(np.array(several(found.summary[key]), float) - exact)
        scale = np.maximum(abs(exact), 1.0) if key.endswith("_z") else abs(exact)
        assert (off <= estimate * scale).all(), key
    radius = [result.table("fixed_load.csv")["contact_radius"] for result in pair]
    assert (abs(radius[0] - radius[1]) <= estimate * radius[1]).all()


def errors_between_rows(found, truth):
    """Errors of cubic polynomials through the rows of a table, at the rows of a finer table."""
    rows, exact = found.table("table.csv"), truth.table("table.csv")
    errors, beyond = [], 0
    for branch in "approach", "retreat":
        x, f, slope = (rows[key][rows["branch"] == branch]
                       for key in ("indentation", "load", "stiffness"))
        at, load = (exact[key][exact["branch"] == branch] for key in ("indentation", "load"))
        # From row to row between jumps, where the slope is known.
        for i in range(len(x) - 1):
            width = x[i + 1] - x[i]
            inside = (at - x[i]) * (at - x[i + 1]) < 0
            if not np.isfinite(slope[i:i + 2]).all() or width == 0:
                continue
            t = (at[inside] - x[i]) / width
            cubic = (f[i] * (1 + 2 * t) * (1 - t) ** 2 + f[i + 1] * t**2 * (3 - 2 * t)
                     + width * t * (1 - t) * (slope[i] * (1 - t) - slope[i + 1] * t))
            # Just before a jump a row of the finer table may be after its own.
            near = np.isclose(cubic, load[inside], rtol=0.3)
            errors += list(abs(cubic - load[inside])[near])
            beyond += (~near).sum()
    assert len(errors) > 30 and beyond <= 4, (len(errors), beyond)
    return np.array(errors)


def test_a_table_says_what_lies_between_its_rows(pair):
    found, truth = pair
    bound = found.summary["table_load_error"] + found.summary["table_interpolation_error"]
    assert (errors_between_rows(found, truth) <= 2 * bound).all()


def test_loads_of_a_table_are_off_by_no_more_than_estimated(pair):
    """At the end of the path, which both tables have."""
    mine, exact = (result.table("table.csv").rows("approach") for result in pair)
    assert mine["indentation"][-1] == pytest.approx(exact["indentation"][-1], rel=1e-12)
    own, error = (result.summary["table_load_error"] for result in pair[::-1])
    assert abs(mine["load"][-1] - exact["load"][-1]) <= error + own
    assert 0 < error < 1e-3 * abs(mine["load"]).max()


@pytest.mark.slow
def test_a_table_of_many_rows_is_judged_where_its_slope_has_a_kink(run):
    """Every seventieth interval was judged, none of them at the gap at which a brush is touched."""
    def table(accuracy):
        return run(path_of(8.758e10, -1.307e-9, radius=2.19e-3, force=None,
                           van_der_waals={"hamaker": 1.138e-19}, born={"z0": 2.864e-10},
                           steric={"brush_thickness": 8.93e-10, "grafting_density": 2.317e18,
                                   "sides": 1}, table={}, numerics={"accuracy": accuracy}))
    found, truth = table(1e-5), table(1e-6)
    errors = errors_between_rows(found, truth)
    assert errors.max() > 1e-5 * found.summary["max_tension"]
    bound = found.summary["table_load_error"] + found.summary["table_interpolation_error"]
    assert (errors <= 2 * bound).all()


@pytest.fixture(scope="module")
def radii(snapin_path, tmp_path_factory):
    """radii(deck) -> the contact radii at the places of each name, and their errors."""
    path = tmp_path_factory.mktemp("radii") / "deck.nml"

    def of_places(text):
        path.write_text(text)
        done = subprocess.run([snapin_path.parent / "ring_image", path, "0", "1"],
                              capture_output=True, text=True, check=True, timeout=HANG)
        rows = [line.split(",") for line in done.stdout.splitlines() if line.startswith("place,")]
        return {row[1]: np.split(np.array(row[3].split(), float), 2)
                for row in rows if row[2] == "radius"}

    return of_places


CYCLE = {"loading": loading(10, -3, 0.25), "unloading": {"from": [-1.0, -3.0]}}


def pairs():
    """Each scene at an accuracy, and far more accurate."""
    for sigma, accuracy, stiffness, load in SCENES:
        yield [scene(sigma, stiffness, load, each) for each in (accuracy, 1e-10)]
    yield [lennard_jones(8.7, **CYCLE, profiles={"h0": [2.0, -1.0]}, numerics={"accuracy": each})
           for each in (1e-4, 1e-9)]


@pytest.mark.parametrize("decks", pairs())
def test_every_place_has_a_contact_radius_off_by_no_more_than_its_error(radii, decks):
    """So that a row of `result_rows` may report the contact radius at a place of any name."""
    found, truth = map(radii, decks)
    assert set(found) == set(truth) and len(found) > 5
    compared = 0
    for name in set(found) - {"table"}:  # The table has other rows at another accuracy.
        (radius, error), (exact, own) = found[name], truth[name]
        there = np.isfinite(exact)
        compared += there.sum()
        assert (np.isfinite(radius) == there).all(), name
        assert (abs(radius - exact) <= error + 3 * own)[there].all(), name
        assert (error <= 1e-4 * (1 + abs(radius)))[there].all(), name
    assert found["end"][0] > 0 and found["max_tension"][0] > 0
    assert compared >= 18


def test_the_contact_radius_of_rigid_bodies_is_that_of_their_shape(radii):
    """A sphere is a parabola of the height r^2/2, cut at the level 1.1 z0."""
    found = radii(lennard_jones(1.0, bodies={"radius": 1.0, "rigid": True},
                                loading=loading(4, 0.7, 0.1)))
    radius, error = found["end"]
    assert radius == pytest.approx(math.sqrt(2 * 0.4)) and 0 < error < 1e-10
    # The tension is largest without contact, or at h0 = z0.
    radius, error = found["max_tension"]
    assert abs(radius - math.sqrt(2 * 0.1)) <= error < 1e-4


def test_on_a_fixed_grid_a_state_has_a_contact_radius_and_a_jump_between_steps_has_none(radii):
    found, truth = (radii(lennard_jones(1.0, **CYCLE, numerics=numerics))
                    for numerics in ({"grid": "uniform", "nodes": 300}, {"accuracy": 1e-8}))
    assert np.isnan(found["jump_out"]).all()
    radius, error = found["end"]
    assert abs(radius - truth["end"][0]) <= error < 0.1 * radius


@pytest.mark.parametrize("scene", [
    {"force": {"law": "lennard_jones", "surface_energy": 0.05, "z0": 0.5e-9},
     "device": {"stiffness": [0.1, 1.0, 10.0]}},
    {"morse": {"surface_energy": 0.05, "z0": 0.3e-9, "decay_length": 0.2e-9},
     "device": {"stiffness": [10.0, 20.0]}, "force": None},
], ids=["Lennard-Jones", "loads of nearly nothing"])
def test_a_landing_of_undeformed_bodies_is_as_uncertain_as_the_jump(run, scene):
    """The load after the jump was given to rounding, whatever its magnitude."""
    loads = {}
    for accuracy in (1e-3, 1e-9):
        found = run(path_of(1e10, -2e-9, accuracy, radius=1e-6, **scene)).summary
        loads[accuracy] = np.array(found["device_jump_out_load_after"])
        if accuracy > 1e-6:
            allowed = np.array(found["device_jump_out_load_after_error"])
    off = abs(loads[1e-3] - loads[1e-9])
    assert (off < allowed).all() and (allowed < 30 * off).all()
