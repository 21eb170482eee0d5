"""Claims about the whole equilibrium path: its folds, its stable parts, its limits."""

import numpy as np
import pytest
from support.known import BY_SIGMA
from support.scenes import agreeing, exponential, lennard_jones, loading, path_of, several


def path(sigma, accuracy=None, part="full", **keys):
    """A path down to h0 = -2."""
    numerics = {"accuracy": accuracy} if accuracy else None
    return lennard_jones(
        sigma, part=part, equilibrium_path={"h0_end": -2.0, **keys}, numerics=numerics)


# --- Folds


def test_large_sigma_has_two_more_folds_before_contact(run):
    summary = run(path(8.7)).summary
    np.testing.assert_allclose(
        summary["folds_h0"], [5.972835, 6.2608, 6.2098, 11.9352327], atol=5e-5)
    # Between them two modes are unstable: signs that merely alternate would call it stable.
    assert several(summary["folds_stable"]) == [0, 0, 0, 1]


def test_h0_start_does_not_matter(run):
    whole = run(path(8.7)).summary
    for start in (6.3, 7.0, 12.0, 40.0, 300.0):
        found = run(path(8.7, h0_start=start))
        assert list(found.curve["h0"][[0, -1]]) == pytest.approx([start, -2.0], rel=1e-14)
        for key in ("max_tension", "max_tension_h0", "folds_h0", "folds_load", "energy_lost"):
            assert found.summary[key] == pytest.approx(whole[key], rel=1e-6), key


# --- Stability


@pytest.mark.parametrize("sigma", [0.3, 0.87, 8.7, 100.0])
def test_the_first_and_last_fold_bound_exactly_the_unstable_stretch(run, sigma):
    result = run(path(sigma))
    curve, folds = result.curve, np.array(result.summary["folds_h0"])
    at_fold = [int(np.argmin(abs(curve["h0"] - fold))) for fold in (folds[0], folds[-1])]
    # The folds are on the curve, and neither side of them is taken for the other.
    np.testing.assert_allclose(curve["h0"][at_fold], folds[[0, -1]], rtol=1e-12)
    first, last = at_fold
    before_contact = curve["h_centre"] > 1.3
    assert 10 <= first < last < len(curve) - 10 and before_contact.sum() > 10
    assert (curve["stable"][:first] == 1).all()
    assert (curve["stable"][first : last + 1] == 0).all()
    assert (curve["stable"][last + 1 :] == 1).all()
    # h0 falls before the first fold and after the last, and rises overall in between.
    assert (np.diff(curve["h0"][: first + 1]) < 0).all()
    assert (np.diff(curve["h0"][last:]) < 0).all()
    # Along the whole path the gap on the axis only falls until contact.
    assert (np.diff(curve["h_centre"][before_contact]) < 0).all()


# --- The summary


def test_energy_lost_is_that_of_the_whole_cycle_or_is_not_given(run):
    lost = run(path(0.87)).summary["energy_lost"]
    # The jumps are at 3.0886872 and 3.4834324.
    deeper = run(path(0.87, h0_end=3.0)).summary
    assert deeper["energy_lost"] == pytest.approx(lost, rel=1e-5)
    for end in (3.1, 3.3):
        summary = run(path(0.87, h0_end=end)).summary
        assert summary["jump_out_h0"] == pytest.approx(3.4834324, rel=1e-6)
        assert "energy_lost" not in summary
        assert "energy_lost_uncertainty" not in summary


def test_the_largest_tension_is_an_extremum_where_meshes_change_beside_it(run):
    # At this sigma and 1e-2 the path passes to another mesh three digits from the extremum, and
    # what the meshes err by made the state there the lower one, with no error of its h0.
    summary = run(path(0.039763566775, 1e-2, h0_end=-20.0)).summary
    assert summary["max_tension_h0"] == summary["load_folds_h0"]
    assert summary["max_tension"] == -summary["load_folds_load"]
    exact = run(path(0.039763566775, 1e-8, h0_end=-20.0)).summary["max_tension_h0"]
    assert abs(summary["max_tension_h0"] - exact) < summary["max_tension_h0_error"]


# --- Beside the h0-stepped experiment


@pytest.mark.parametrize("sigma", [0.1, 0.87, 8.7])
def test_path_agrees_with_the_h0_stepped_states(run, sigma):
    steps = run(lennard_jones(sigma, loading=loading(12, -2, 0.5), unloading={})).curve
    asked = steps.rows("loading")["h0"]
    scene = lennard_jones(
        sigma, equilibrium_path={"h0_start": 12.5, "h0_end": -2.5},
        profiles={"h0": [float(h0) for h0 in asked]})
    curve = run(scene).curve
    for branch in ("loading", "unloading_1"):
        rows = steps.rows(branch)
        for h0, load, centre in zip(rows["h0"], rows["load"], rows["h_centre"]):
            here = (abs(curve["h0"] - h0) < 1e-9) & (curve["stable"] == 1)
            nearest = np.argmin(abs(curve["load"][here] - load))
            assert curve["load"][here][nearest] == pytest.approx(load, rel=1e-6, abs=1e-6 * sigma)
            assert curve["h_centre"][here][nearest] == pytest.approx(centre, abs=1e-6)


def test_path_and_loading_in_one_scene_report_the_folds_of_the_path(run):
    both = run(
        lennard_jones(
            0.87, loading=loading(6, -2, 0.5), unloading={}, equilibrium_path={},
            numerics={"accuracy": 1e-10})
    )
    assert set(both.curve["branch"]) == {"path", "loading", "unloading_1"}
    _, _, jump_in, _, jump_out, _ = BY_SIGMA[0.87]
    assert both.summary["jump_in_h0"] == pytest.approx(jump_in, abs=1.05e-7)
    assert several(both.summary["unload_jump_out_h0"])[0] == pytest.approx(jump_out, abs=1.05e-7)


def test_profiles_of_a_path_are_given_on_every_stretch(run):
    """Between the folds there are three equilibria at one h0."""
    result = run(path(0.87) + "&profiles h0 = 3.3, 0.0 /\n")
    profiles, curve = result.table("profiles.csv"), result.curve
    assert (curve["h0"] == 3.3).sum() == 3
    assert sorted(curve["stable"][curve["h0"] == 3.3]) == [0, 1, 1]
    on_axis = profiles["r"] == 0
    assert (on_axis & (profiles["h0"] == 3.3)).sum() == 3
    assert (on_axis & (profiles["h0"] == 0.0)).sum() == 1


@pytest.mark.parametrize("part", ["full", "repulsive"])
def test_a_path_without_a_start_begins_at_its_farthest_profile(run, part):
    """Profiles beyond the usual start were left out without a word."""
    result = run(lennard_jones(0.87, part=part, equilibrium_path={"h0_end": -2.0},
                               profiles={"h0": [100.0, 0.0]}))
    profiles, curve = result.table("profiles.csv"), result.curve
    assert list(profiles["h0"][profiles["r"] == 0]) == [100.0, 0.0]
    assert curve["h0"][0] == 100.0


# --- Other laws


@pytest.mark.parametrize("sigma", [0.01, 1.0, 8.7, 1000.0])
def test_attraction_alone_has_its_fold_and_ends(run, sigma):
    result = run(path(sigma, part="attractive"))
    summary, curve = result.summary, result.curve
    assert curve["residual"].max() <= 1e-8
    assert np.isfinite(curve["h0"]).all()
    fold = int(np.argmin(abs(curve["h0"] - summary["jump_in_h0"])))
    assert (curve["stable"][:fold] == 1).all()
    assert (curve["stable"][fold:] == 0).all()
    assert (np.diff(curve["h_centre"]) < 0).all()
    assert len(curve) < 200
    assert "jump_out_h0" not in summary


@pytest.mark.parametrize("sigma", [8.7, 1000.0])
def test_far_from_contact_repulsion_does_not_matter(run, sigma):
    """The jump starts from gaps of several z0, where the ninth power is nothing."""
    whole, attraction = (run(path(sigma, part=part)).summary for part in ("full", "attractive"))
    # (z0/h)^6 at the jump.
    assert attraction["jump_in_h0"] == pytest.approx(whole["jump_in_h0"], rel=1e-4)
    assert attraction["jump_in_load"] == pytest.approx(whole["jump_in_load"], rel=1e-3)


@pytest.mark.parametrize(
    "scene",
    [
        lambda **groups: exponential(1, **groups),
        lambda **groups: lennard_jones(1.0, part="repulsive", **groups)],
    ids=["exponential", "repulsive"],
)
def test_path_of_a_law_without_attraction_is_the_h0_stepped_one(run, scene):
    result = run(scene(equilibrium_path={"h0_start": 4.0, "h0_end": -2.0}, profiles={"h0": [1.0]}))
    curve = result.curve
    assert curve["h0"][0] == 4
    assert curve["h0"][-1] == -2
    assert (np.diff(curve["h0"]) < 0).all()
    assert len(curve) >= 50
    assert (curve["stable"] == 1).all()
    stepped = run(scene(loading=loading(4, -2, 0.5))).curve
    for h0, load in zip(stepped["h0"], stepped["load"]):
        if h0 in (4, 1, -2):
            mine = curve["load"][abs(curve["h0"] - h0) < 1e-9]
            assert mine[0] == pytest.approx(load, rel=1e-6)
    for key in ("max_tension", "jump_in_h0", "folds_h0", "spacing_over_neck", "resolved"):
        assert key not in result.summary


def test_a_path_that_leaves_its_first_mesh_at_once_has_its_jump_in(run):
    """The first step passed to the next mesh; no piece of the path began at the first state."""
    agreeing(run, lambda accuracy: path_of(15907436.582095267, 1.36e-10, accuracy), (9e-6, 1e-7),
             ("jump_in_h0", "jump_in_load", "energy_lost"), lambda _: 1e-6)


def test_a_path_that_starts_in_contact_begins_there_and_has_no_jump_in(run):
    # The first state at h0 = 1 on the way inward is one in contact, behind both folds.
    result = run(path(0.87, h0_start=1.0, h0_end=-2.0))
    whole = run(path(0.87, h0_end=-2.0))
    assert list(result.curve["h0"][[0, -1]]) == pytest.approx([1.0, -2.0], rel=1e-14)
    assert (np.diff(result.curve["h0"]) < 0).all()
    assert "jump_in_h0" not in result.summary
    assert "energy_lost" not in result.summary
    assert result.summary["end_load"] == pytest.approx(whole.summary["end_load"], rel=1e-6)


# --- What a path costs


@pytest.mark.parametrize("numerics", [{"accuracy": 1e-4}, {"residual_tolerance": 1e-8}])
def test_points_of_a_smooth_curve_are_few_with_any_tolerance(run, numerics):
    """With residuals of a hundredth of the wanted distance from the curve steps became ever
    shorter, since extrapolation multiplies residuals, and the path was lost."""
    found = run(path_of(2.894e13, -2.32e-10, fixed_load={"load": [0.0, 0.01]}, numerics=numerics))
    assert not found.warnings
    assert found.cost["states"] < 200


def test_a_path_stops_where_its_mesh_misses_a_large_part_of_the_load(run):
    """It went on for thousands of states that mean nothing, until the mesh was refined."""
    found = run(path_of(4.276e8, -2.2345e-9, 1e-5,
                        steric={"brush_thickness": 3.38e-9, "grafting_density": 1e16},
                        device={"stiffness": [3.866e4, 1.021e7]}))
    assert found.cost["factorisations"] < 1000


def test_the_summary_names_the_numerics_of_the_path_and_not_those_of_a_cycle(run):
    """A path is solved by neither mixing nor a grid fixed in space, whatever the deck asks for."""
    found = run(lennard_jones(0.87, equilibrium_path={"h0_end": -2.0},
                              numerics={"method": "mixing"})).summary
    assert (found["grid"], found["method"]) == ("edge_locked", "anderson")
