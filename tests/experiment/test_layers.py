"""Claims about bodies with layers: what a half-space has they have too, and it agrees with dense
states that share nothing with the program, with limits, and with layers put differently."""

import math

import numpy as np
import pytest
from support.calculus import hermite
from support.half_space import path_by_axis
from support.scenes import agreeing, changed, deck, lennard_jones, loading, value_in

AXIS = (*np.linspace(12, 3, 12), *np.linspace(2.8, 1.1, 18), *np.linspace(1.09, 0.98, 16))
ENDS = (*np.arange(0, 3.6, 0.15), 3.8, 4.4, *np.geomspace(6, 150, 7))

# Thickness, shear modulus over that of the base (0: rigid), Poisson's ratios, part in the yield.
FILM = (2.5, 0.0, 0.5, 0.0, 1.0)
COAT = (0.8, 2.0, 0.3, 0.45, 1.0)
SOFT = (1.0, 0.2, 0.45, 0.2, 0.5)
SCENES = {"film": FILM, "coat": COAT, "soft": SOFT}


def layered(layer, sigma=1.0, pieces=1, accuracy=1e-8, **groups):
    """A deck in units of z0 and of the stiffness that the bodies have by their top layers."""
    thickness, ratio, nu, base, part = layer
    # E/(1-nu^2) such that the mean compliance is one; the bodies that are alike have half each.
    young = part * (1 - nu**2) / 2 if part == 1 else 1 - nu**2
    keys = {"thickness": [thickness / pieces] * pieces, "young": [young] * pieces,
            "poisson": [nu] * pieces, "body": "1"}
    bodies = {"radius": 1.0}
    if ratio:
        bodies |= {"young": young / (1 + nu) * (1 + base) / ratio, "poisson": base}
        if part == 1:
            keys["partner"] = "rigid"
        else:
            # The other body has the compliance of this one's layer.
            bodies["young"] = [bodies["young"], 1 - base**2]
    else:
        bodies["rigid"] = True
    return lennard_jones(
        sigma, bodies=bodies, layer=keys, numerics={"accuracy": accuracy}, **groups)


PATH = {"h0_end": -1.0}


@pytest.mark.slow
@pytest.mark.parametrize("scene", SCENES)
def test_folds_and_states_are_those_of_independent_states(run, scene):
    layer = SCENES[scene]
    (all_h0, loads), (h0, load) = path_by_axis(1.0, AXIS, ENDS, layer=layer)
    found = run(layered(layer, equilibrium_path={"h0_end": float(all_h0[-1])})).summary
    assert found["end_load"] == pytest.approx(loads[-1], rel=1e-8)
    assert [found["jump_in_h0"], found["jump_out_h0"]] == pytest.approx(h0, rel=1e-8)
    assert [found["jump_in_load"], found["jump_out_load"]] == pytest.approx(load, rel=2e-8)


def test_a_film_thirty_times_thinner_than_the_contact_has_independent_states(run):
    """The one that yields least beside what its half-space does: it cannot be compressed."""
    layer = (0.1, 0.0, 0.5, 0.0, 1.0)
    # Its pressures are felt no farther than the film is thick, so the panels may end early.
    near = (*[end for end in ENDS if end < 6], 6, 9, 12)
    ((h0, load),) = path_by_axis(1.0, (*AXIS[::4], AXIS[-1]), near, layer=layer, softness=())
    run = run(layered(layer, equilibrium_path={"h0_end": float(h0[-1])}))
    assert run.summary["end_load"] == pytest.approx(load[-1], rel=1e-7)


@pytest.mark.parametrize("sigma", [0.1, 25])
@pytest.mark.parametrize("ratio, nu", [(0.0, 0.5), (0.0, 0.3), (0.2, 0.3), (5.0, 0.3)])
def test_paths_over_coats_thirty_times_thinner_are_as_exact_as_asked_for(run, sigma, ratio, nu):
    """Where what layers yield beside a half-space nearly cancels that."""
    layer = (0.03 * (9 * math.pi * sigma) ** (1 / 3), ratio, nu, nu, 1.0)
    path = {"h0_end": -1.6 if sigma < 1 else -6.0}
    asked, finer = (run(layered(layer, sigma, accuracy=accuracy, equilibrium_path=path)).summary
                    for accuracy in (1e-6, 1e-9))
    assert asked["error_estimate"] < 1e-6
    for key in ("max_tension", "end_load"):
        assert asked[key] == pytest.approx(finer[key], rel=1e-6, abs=1e-6 * finer["max_tension"])
    assert ("bottom_modulus" in asked) == (ratio > 0)


@pytest.mark.parametrize("sigma", [1, 25])
def test_errors_of_a_thin_coat_a_hundred_times_as_stiff_hold(run, sigma):
    layer = (0.03 * (9 * math.pi * sigma) ** (1 / 3), 100.0, 0.3, 0.3, 1.0)
    asked, finer = (run(layered(layer, sigma, accuracy=accuracy,
                                  equilibrium_path={"h0_end": -2.0})).summary
                    for accuracy in (1e-6, 1e-9))
    for key in ("max_tension", "jump_out_load", "end_load"):
        assert abs(asked[key] - finer[key]) < 3 * asked[f"{key}_error"] + 1e-8 * abs(finer[key])


def test_a_cone_over_a_layer_has_the_load_that_is_asked_for(run):
    """Its pressures fall so slowly far out that waves left out there were a part of the load."""
    asked, _ = agreeing(run, lambda accuracy: deck(
        bodies={"young": 70e9, "poisson": 0.2}, layer={"thickness": 2e-5, "young": 3e6,
                                                       "poisson": 0.45},
        shape={"kind": "cone", "half_angle": 1.2}, numerics={"accuracy": accuracy},
        force={"law": "lennard_jones", "surface_energy": 0.02, "z0": 20e-9},
        equilibrium_path={"h0_end": -100e-9}), (1e-6, 1e-8), ["end_load"])
    assert asked.summary["error_estimate"] < 1e-6


@pytest.mark.parametrize("pieces", [1, 3])
def test_equal_moduli_are_a_half_space(run, pieces):
    bodies = {"radius": 1.0, "young": 0.91, "poisson": 0.3}
    layers = {"thickness": [1.0] * pieces, "young": [0.91] * pieces, "poisson": [0.3] * pieces,
              "body": "both"}
    plain, same = (
        run(lennard_jones(1.0, bodies=bodies, layer=layer, equilibrium_path=PATH)).summary
        for layer in (None, layers))
    for key in ("max_tension", "jump_in_h0", "jump_out_load", "end_load"):
        assert same[key] == plain[key]
    assert same["top_modulus"] == pytest.approx(same["bottom_modulus"], rel=1e-14)


def test_a_thick_layer_is_its_half_space_and_a_thin_one_nothing(run):
    half = run(lennard_jones(1.0, equilibrium_path=PATH)).summary
    apart = []
    for thickness in (300.0, 3000.0):
        thick = run(layered((thickness, *COAT[1:]), accuracy=1e-6, equilibrium_path=PATH)).summary
        apart.append(abs(thick["max_tension"] / half["max_tension"] - 1))
    # The base moves as one under the load, which shifts h0 and not the pull-off; the rest falls as
    # the cube of contact radius over thickness.
    assert apart[0] < 1e-4 and apart[1] < 1e-6


def test_a_cycle_and_a_spring_are_read_from_the_same_states(run):
    run = run(layered(COAT, accuracy=1e-6, loading=loading(6, -1, 0.25), unloading={},
                         equilibrium_path=PATH, device={"stiffness": [0.0, 5.0]},
                         fixed_load={"load": [-3.0]}, stability={}))
    found = run.summary
    assert run.status == 0 and found["converged"]
    cycle, path = run.table("curve.csv").rows("unloading_1"), run.table("curve.csv").rows("path")
    assert found["unload_max_tension"] == pytest.approx(found["max_tension"], rel=1e-9)
    # Under a dead load the bodies part at the largest tension.
    assert found["device_jump_out_load"][0] == pytest.approx(-found["max_tension"], rel=1e-7)
    deepest = path["h0"].argmin()
    assert cycle["load"][0] == pytest.approx(path["load"][deepest], rel=1e-7)


COATED = {
    "bodies": {"radius": 1.0, "young": 0.3, "poisson": 0.4},
    "layer": {"thickness": [1.0, 1.5], "young": [2.0, 0.8], "poisson": [0.3, 0.5], "body": "1"},
    "force": {"law": "lennard_jones", "hamaker": 16 * math.pi, "z0": 1.0},
    "equilibrium_path": PATH,
}
NUMBERS = ["layer.thickness(1)", "layer.thickness(2)", "layer.young(1)", "layer.young(2)",
           "layer.poisson(1)", "bodies.young"]


def coated(key=None, factor=1.0, **groups):
    groups = COATED | groups
    return deck(**changed(groups, {key: factor * value_in(groups, key)} if key else {}))


@pytest.mark.parametrize("key", NUMBERS)
def test_derivatives_are_differences_of_runs(run, key):
    step, accurate = 2e-4, {"numerics": {"accuracy": 1e-9}}
    near, far = (run(coated(key, factor, **accurate)).summary for factor in (1 - step, 1 + step))
    rates = run(coated(sensitivity={"parameters": NUMBERS}, **accurate)).table("sensitivity.csv")
    for quantity in ("max_tension", "max_tension_h0", "jump_in_h0", "jump_out_h0", "end_load"):
        row = (rates["parameter"] == key) & (rates["quantity"] == quantity)
        difference = (far[quantity] - near[quantity]) / (2 * step)
        assert rates["logarithmic"][row][0] * far[quantity] == pytest.approx(
            difference, rel=1e-4, abs=1e-6)


def test_cases_of_a_sweep_are_runs_of_their_own(run):
    thickness = [0.4, 1.6]
    rows = run(coated(sweep={"key": "layer.thickness(2)", "values": thickness})).table("sweep.csv")
    for i, value in enumerate(thickness):
        alone = run(coated("layer.thickness(2)", value / 1.5)).summary
        for key in ("max_tension", "jump_out_h0", "top_modulus", "bottom_modulus"):
            assert rows[key][i] == pytest.approx(alone[key], rel=1e-7)


def test_a_table_has_the_loads_of_a_cycle_and_their_slopes(run):
    run = run(coated(table={}, loading=loading(6, -1, 0.25)))
    table, cycle = run.table("table.csv").rows("approach"), run.table("curve.csv").rows("loading")
    here = (cycle["h0"] < run.summary["jump_in_h0"] - 0.2) & (cycle["h0"] > -1 + 1e-9)
    found = hermite(-cycle["h0"][here],
                    *(table[name] for name in ("indentation", "load", "stiffness")))
    apart = abs(found - cycle["load"][here]).max()
    assert 0 < apart < 1e-4 * run.summary["max_tension"]


def test_deformations_of_both_surfaces_add_up(run):
    run = run(layered(SOFT, accuracy=1e-6, equilibrium_path=PATH, profiles={"h0": -0.5}))
    rows = run.table("profiles.csv")
    total = rows["deformation_1"] + rows["deformation_2"]
    assert total == pytest.approx(2 * rows["deformation"], rel=1e-9, abs=1e-10)
    # Far from the contact the layer on its stiffer base moves by less than the half-space.
    far = rows["r"] > 20
    assert (abs(rows["deformation_1"][far]) < abs(rows["deformation_2"][far])).all()
    # There each is a point load's, 2 F/(2 pi E' r) with E' of the base and of the half-space.
    base = 0.2 * (1 - 0.2) / (1 - 0.45)  # E'(layer)/E'(base)
    ratio = rows["deformation_1"][far] / rows["deformation_2"][far]
    assert ratio[rows["r"][far] > 60] == pytest.approx(base, rel=0.02)


def test_what_is_beyond_the_model_is_said(run):
    thin = run(layered((0.5, *FILM[1:]), accuracy=1e-4, equilibrium_path=PATH))
    assert "thinner than the range of the force" in str(thin.summary["warnings"])
    thick = run(layered((50.0, *COAT[1:]), accuracy=1e-4, equilibrium_path=PATH))
    assert "layer" not in str(thick.summary.get("warnings"))
    # A thousandth of the load's stress is small for the skin and not for what is below.
    skin = deck(bodies={"radius": 1e-4, "young": [1e5, 1e12], "poisson": [0.5, 0.3]},
                layer={"thickness": 2e-6, "young": 1e9, "poisson": 0.3},
                force={"law": "lennard_jones", "surface_energy": 0.05, "z0": 1e-9},
                equilibrium_path={"h0_end": -3e-6})
    assert "strain below the top layer is about" in str(run(skin).summary["warnings"])


def test_a_profile_does_not_spoil_the_estimate_of_a_stiff_layer_on_a_soft_base(run):
    """Far out the deformation changes over the plate's length, which the few nodes of the outermost
    panel cannot interpolate."""
    found = run(deck(
        bodies={"radius": 8.55e-3, "young": 1.73e5, "poisson": 0.5},
        layer={"thickness": 2.6e-4, "young": 1.89e8, "poisson": 0.09, "partner": "rigid"},
        force={"law": "lennard_jones", "surface_energy": 3.25e-3, "z0": 8.4e-9},
        equilibrium_path={"h0_end": -2.4e-7}, profiles={"h0": -7.9e-8})).summary
    assert found["error_estimate"] < 1e-6 and found["profiles_error"] < 1e-6


@pytest.mark.parametrize("young", ([1e4, 1e8], [1e8, 1e4]))
def test_a_large_strain_is_said_of_either_body(run, young):
    skins = deck(bodies={"radius": 1e-3, "young": young, "poisson": 0.3},
                 layer={"thickness": 1e-5, "young": 1e9, "poisson": 0.3, "body": "both"},
                 force={"law": "lennard_jones", "surface_energy": 0.05, "z0": 2e-9},
                 equilibrium_path={"h0_end": -3e-6}, numerics={"accuracy": 1e-4})
    assert "strain below the top layer is about" in str(run(skins).summary["warnings"])


@pytest.mark.parametrize("times", (1e-3, 1e3))
def test_the_unit_of_length_does_not_matter(run, times):
    """Two layers of unlike materials: all lengths in another unit, and pressures as they are."""
    def tension(unit):
        return run(deck(
            bodies={"radius": 1e-4 * unit, "young": 1e8, "poisson": 0.3},
            layer={"thickness": [1e-6 * unit, 3e-6 * unit], "young": [1e9, 2e7],
                   "poisson": [0.3, 0.45]},
            force={"law": "lennard_jones", "surface_energy": 0.05 * unit, "z0": 1e-8 * unit},
            equilibrium_path={"h0_end": -1e-7 * unit},
            numerics={"accuracy": 1e-6})).summary["max_tension"]

    assert tension(times) == pytest.approx(times**2 * tension(1.0), rel=1e-6)


# Young's moduli of the bodies; a layer on the first; what is read.
DEEP = {
    "film": ([1e11, 1e11], {"thickness": 3e-6, "young": 1e10, "poisson": 0.3, "base": "rigid"},
             {"fixed_load": {"load": [0.0]}}),
    "pressed film": ([2.65e12, 6.44e12], {"thickness": 1.29e-6, "young": 3.22e10, "poisson": 0.5,
                                          "base": "rigid"}, {"fixed_load": {"load": [3.375e-3]}}),
    "spring": ([4.32e10, 9.15e12], {"thickness": 8.81e-7, "young": 2.95e10, "poisson": 0.3,
                                    "base": "rigid"},
               {"device": {"stiffness": [1.7e5], "z_end": -5e-9}}),
}


@pytest.mark.parametrize("name", DEEP)
def test_a_path_goes_on_until_what_is_read_from_it_is_reached(run, name):
    """Where the path had to end was taken from the theory of half-spaces, and contacts of films
    under a load were beyond its end."""
    young, layer, read = DEEP[name]
    shallow, deep = (run(deck(
        bodies={"radius": 1.5e-2, "young": young, "poisson": [0.3, 0.3]},
        layer={**layer, "body": "1"}, force={"law": "lennard_jones", "hamaker": 1e-19, "z0": 5e-10},
        equilibrium_path={"h0_end": h0_end}, numerics={"accuracy": 1e-5}, **read))
        for h0_end in (2e-10, -1e-8))
    if name == "spring":
        assert shallow.table("device.csv")["z"].min() <= -5e-9
        return
    for key in ("h0", "displacement"):
        assert shallow.table("fixed_load.csv")[key] == pytest.approx(
            deep.table("fixed_load.csv")[key], rel=1e-5)
    assert (shallow.table("fixed_load.csv")["stable"] == 1).any()


def test_pressures_that_vanish_everywhere_do_not_move_layers(run):
    """A product of no columns left what was in memory: no state was found far from contact."""
    found = run(deck(
        bodies={"radius": 0.015, "young": [9.6e9, 1.2e9], "poisson": 0.0},
        layer={"thickness": 6e-6, "young": 7.5e9, "poisson": 0.46, "body": "2"},
        morse={"surface_energy": 0.05, "z0": 4.4e-10, "decay_length": 1.4e-10},
        equilibrium_path={"h0_start": 1e-7, "h0_end": 0.0}))
    assert not found.warnings
    assert (abs(found.curve["load"][:2]) < 1e-100).all()
    assert (abs(found.curve["displacement"][:2]) < 1e-20).all()
