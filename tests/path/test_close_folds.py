"""Claims about folds that a step could pass over."""

import numpy as np
import pytest
import snapin
from support.scenes import agreeing, deck, lennard_jones, path_of


# --- Folds that a step passes over


@pytest.mark.parametrize("sigma", [0.291085, 0.2911, 0.2912, 0.2918])
def test_folds_however_close_are_found(run, sigma):
    result = run(lennard_jones(sigma, equilibrium_path={"h0_end": -2.0}))
    first, second = result.summary["folds_h0"]
    # h0 at the folds parts as (sigma - 0.29108493)^(3/2), and the energy lost goes with the square
    # of that difference.
    beyond = sigma - 0.29108493
    assert second - first == pytest.approx(1.60 * beyond**1.5, rel=0.2)
    assert result.summary["folds_stable"] == [0, 1]
    assert result.summary["energy_lost"] == pytest.approx(
        2.57 * beyond**2, rel=0.2, abs=result.summary["energy_lost_uncertainty"])
    assert result.summary["energy_lost_uncertainty"] < 1e-11


LAYERS = {
    "force": {"law": "lennard_jones", "hamaker": 1.244e-20, "z0": 6.459e-10},
    "structural": {"amplitude": 4246900.0, "period": 1.8129e-9, "decay_length": 1.5087e-9},
    "van_der_waals": {"hamaker": 7.9044e-22, "retardation_length": 3.5266e-8}}


@pytest.mark.parametrize("accuracy", [1e-3, 1e-6])
@pytest.mark.parametrize("amplitude", [1e6, 4.2469e6, 2e7])
def test_loads_of_stiff_bodies_turn_where_the_pressure_vanishes(run, amplitude, accuracy):
    laws = {**LAYERS, "structural": {**LAYERS["structural"], "amplitude": amplitude}}
    found = run(deck(bodies={"radius": 4.6e-7, "stiffness": 1e14}, **laws,
                     equilibrium_path={"h0_start": 6e-9, "h0_end": 5.4e-10},
                     numerics={"accuracy": accuracy})).summary
    gap = np.linspace(5.4e-10, 6e-9, 200001)
    zeros = gap[1:][np.diff(np.sign(snapin.force_law(laws, gap).pressure)) != 0]
    assert np.sort(found["load_folds_h0"]) == pytest.approx(zeros, abs=2e-12)


# Scenes, lists of the summary, and their values from runs of many accuracies, to 1e-8 and beyond.
STEPPED_OVER = {
    "spheroid": (
        {"bodies": {"stiffness": 1e12},
         "shape": {"kind": "spheroid", "radius": 3.042432e-6, "semi_axis": 4.2564e-6},
         "van_der_waals": {"hamaker": 1.065e-19}, "born": {"hamaker": 1.065e-19, "z0": 1.152e-10},
         "dugdale": {"stress": 1.4339e9, "range": 3.1408e-10},
         "hydration": {"energy": [0.010454, 0.065234], "decay_length": [8.3359e-11, 1.4308e-10]}},
        "folds_h0", [3.33302e-10, 3.48254e-10, 3.42281e-10, 3.42916e-10]),
    "punch": (
        {"bodies": {"stiffness": 1.0924e10},
         "shape": {"kind": "rounded_punch", "radius": 4.564e-7, "flat_radius": 2.4123e-7},
         **LAYERS, "double_layer": {
             "potential": -0.0088055, "regulation": [0.68155, 0.18133],
             "debye_length": 3.9684e-9, "valence": 2, "model": "linear"}},
        "load_folds_h0", [3.57946e-9, 2.59521e-9, 1.83539e-9, 7.87204e-10, 6.24064e-10]),
}


@pytest.mark.parametrize("accuracy", [1e-5, 6e-5, 5e-5, 1e-6])
@pytest.mark.parametrize("name", STEPPED_OVER)
def test_a_step_whose_end_is_far_from_its_guess_is_repeated(run, name, accuracy):
    """Two folds were within such a step, and nothing said so."""
    scene, key, folds = STEPPED_OVER[name]
    summary = run(deck(**scene, equilibrium_path={"h0_end": -1.5e-9},
                       numerics={"accuracy": accuracy})).summary
    assert summary[key] == pytest.approx(folds, abs=1e-13)


@pytest.mark.parametrize("accuracy", [1e-4, 1e-6, 1e-7])
def test_two_folds_within_a_step_whose_slope_is_least_inside_are_found(run, accuracy):
    """The polynomial between the states did not turn there, although its slope was least inside.
    Dense independent states, by the gap on the axis, have these folds."""
    found = run(path_of(78722523.35448572, -3.52e-9, accuracy,
                        structural={"amplitude": 982565.7098164434, "period": 8.720519021717652e-10,
                                    "decay_length": 1e-9})).summary
    assert found["folds_h0"][:3] == pytest.approx([11.933793e-9, 11.933928e-9, 11.930680e-9],
                                                  abs=1e-14)
    assert found["jump_in_load"] == pytest.approx(-2.97126e-6, rel=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("stiffness, range_, h0_end, accuracies", [
    (2.047627728863176e9, 1.8378672890277213e-9, -8.066445348379321e-10, (2e-4,)),
    (3.2874751938112336e8, 1.8819993963801085e-9, -3.7388340973471256e-9, (3e-5,))])
def test_a_coarse_mesh_has_no_pairs_of_folds_of_its_own(run, stiffness, range_, h0_end, accuracies):
    """As the step of the tension passes the nodes, h0 has waves of the size of the mesh's error."""
    found = agreeing(run, lambda accuracy: path_of(
        stiffness, h0_end, accuracy, dugdale={"stress": 1e7, "range": range_}),
        (*accuracies, 1e-6), ["folds_h0"], lambda _: 1e-4)
    assert not any("warnings" in one.summary for one in found)


def test_an_extremum_beside_a_passage_between_meshes_stays_on_the_path(run):
    """Traced again on a finer mesh, it moved over the passage and was on neither mesh."""
    agreeing(run, lambda accuracy: path_of(
        36259225492.46833, -2.7455057304047334e-09, accuracy,
        structural={"amplitude": 2963782.395744549, "period": 1.0024841277431275e-09,
                    "decay_length": 1e-09}),
        (1e-3, 2e-4, 1e-4, 1e-6), ["load_folds_load"], lambda _: 1e-4)


def test_a_fold_where_the_path_passes_to_a_refined_mesh_later_is_reported(run):
    """The path seemed to be interrupted between the states with which it had first passed."""
    found, _ = agreeing(run, lambda accuracy: path_of(
        9867995842.805944, -2.0156122752850073e-09, accuracy,
        depletion={"osmotic_pressure": 1e5, "diameter": 2.0335697223412008e-09},
        double_layer={"potential": -0.09218970162280453, "regulation": 0.09738767408196936,
                      "salt": 0.673547496781325, "valence": 1},
        structural={"amplitude": 312505.9625710812, "period": 1.0229219159148328e-09,
                    "decay_length": 1e-09}), (3e-6, 1e-5), ["folds_load"], lambda _: 1e-4)
    assert len(found.summary["folds_h0"]) == 4


@pytest.mark.parametrize("sigma", [0.1, 0.28, 0.29, 0.29108])
def test_below_the_first_jump_there_is_no_fold(run, sigma):
    assert "folds_h0" not in run(lennard_jones(sigma, equilibrium_path={"h0_end": -2.0})).summary
