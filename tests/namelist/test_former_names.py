"""The claim that a key may have its former name, in a deck and wherever a deck names keys."""

import pathlib

import numpy as np
import pytest
import snapin

ROOT = pathlib.Path(__file__).resolve().parents[2]
BODIES = {"radius": 1e-2, "stiffness": 1e10}
PATH = {"equilibrium_path": {"h0_end": -1e-9}}


def scene(energy="work_of_adhesion", spring="spring_constant", bodies=BODIES, **groups):
    return {"bodies": bodies, "force": {"law": "lennard_jones", energy: 8e-4, "z0": 0.5e-9},
            "device": {spring: 1e4}, **PATH, **groups}


def test_present_and_former_names_mean_the_same():
    present, former = snapin.run(scene()), snapin.run(scene("surface_energy", "stiffness"))
    reduced = snapin.run(scene(bodies={"radius": 1e-2, "reduced_modulus": 5e9}))
    morse = [snapin.run({"bodies": BODIES, **PATH,
                         "morse": {key: 8e-4, "z0": 0.5e-9, "decay_length": 0.2e-9}})
             for key in ("surface_energy", "work_of_adhesion")]
    assert present.summary["device_jump_in_z"] == former.summary["device_jump_in_z"]
    assert reduced.summary["reduced_modulus"] == former.summary["reduced_modulus"] == 5e9
    assert reduced.summary["plane_strain_modulus"] == 1e10
    for a, b in ((present, former), (present, reduced), morse):
        assert np.array_equal(a.curve["load"], b.curve["load"])


@pytest.mark.parametrize("name", ["surface_energy", "work_of_adhesion"])
def test_a_sweep_and_derivatives_name_keys_as_the_deck_does(name):
    """Whichever of the two names the force itself has."""
    swept = snapin.run(scene(sweep={"key": f"force.{name}", "values": [7e-4, 9e-4]}))
    assert list(swept.tables["sweep"][f"force.{name}"]) == [7e-4, 9e-4]
    derived = snapin.run(scene("surface_energy", sensitivity={"parameters": [f"force.{name}"]}))
    # The pull-off of these stiff small bodies is nearly that of DMT theory.
    table = derived.tables["sensitivity"]
    row = table[table["quantity"] == "max_tension"]
    assert row["parameter"][0] == f"force.{name}" and 0.5 < row["logarithmic"][0] < 1.5


@pytest.mark.parametrize("name", ["stiffness", "spring_constant"])
def test_a_swept_spring_takes_the_place_of_the_list(name):
    deck = scene(sweep={"key": f"device.{name}", "values": [1e4, 2e4]})
    deck["device"]["spring_constant"] = [1e3, 1e5, 1e6]
    columns = snapin.run(deck).tables["sweep"].dtype.names
    assert "device_jump_in_z_1" in columns and "device_jump_in_z_2" not in columns


def test_a_fit_does_not_vary_a_number_beside_itself():
    """The parameter by its former name was tested as a number that the deck holds fixed."""
    fitted = {}
    for name in ("surface_energy", "work_of_adhesion"):
        deck = (ROOT / "inputs/tutorial/probe.nml").read_text(encoding="utf-8")
        deck = deck.replace("force.surface_energy", f"force.{name}").replace(
            "force.work_of_adhesion", f"force.{name}")
        fitted[name] = snapin.run(deck.replace("file = '", f"file = '{ROOT}/inputs/tutorial/"))
    a, b = fitted.values()
    assert np.array_equal(a.tables["fit"]["model"], b.tables["fit"]["model"])
    assert not [text for text in a.summary.get("warnings", []) if text.startswith("fit:")]


@pytest.mark.parametrize("first, second", [("surface_energy", "work_of_adhesion"),
                                           ("work_of_adhesion", "surface_energy")])
def test_both_names_together_are_refused(first, second):
    deck = scene(first)
    deck["force"][second] = 8e-4
    with pytest.raises(snapin.DeckError, match=f'"{second}": given twice.*as {first}'):
        snapin.run(deck)


def test_a_message_has_the_name_of_the_deck():
    deck = scene("surface_energy")
    deck["force"]["hamaker"] = 1e-20
    with pytest.raises(snapin.DeckError, match='"surface_energy": follows from hamaker'):
        snapin.run(deck)


@pytest.mark.parametrize("keys", [("reduced_modulus", "stiffness"), ("reduced_modulus", "young"),
                                  ("reduced_modulus", "rigid")])
def test_one_way_to_say_how_bodies_deform(keys):
    values = {"reduced_modulus": 1e9, "stiffness": 1e9, "young": 1e9, "rigid": True}
    bodies = {"radius": 1e-2, **{key: values[key] for key in keys}}
    with pytest.raises(snapin.DeckError, match="more than one way"):
        snapin.run(scene(bodies=bodies))
