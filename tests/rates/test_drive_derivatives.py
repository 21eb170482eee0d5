"""Claims about derivatives of the numbers of a drive."""

import pytest
from support.scenes import lennard_jones


@pytest.mark.slow
def test_derivatives_of_a_drive_keep_its_invariances(run):
    names = ("force.hamaker", "bodies.stiffness", "viscoelastic.stiffness_relaxed",
             "drive.velocity", "viscoelastic.retardation_time")
    found = run(lennard_jones(
        0.2, drive={"velocity": 8.0, "z_start": 20.0, "z_turn": -4.0}, numerics={"accuracy": 1e-3},
        viscoelastic={"stiffness_relaxed": 0.25, "retardation_time": 1.0},
        sensitivity={"parameters": list(names)}))
    table = found.table("sensitivity.csv")
    for key in ("max_tension", "energy_dissipated"):
        of_key = table["quantity"] == key
        rate = dict(zip(table["parameter"][of_key], table["logarithmic"][of_key]))
        assert set(rate) == set(names)
        # Strength and moduli in proportion change pressures alone, velocity and time only together.
        assert sum(rate[name] for name in names[:3]) == pytest.approx(1, abs=5e-3)
        assert rate["drive.velocity"] == pytest.approx(rate["viscoelastic.retardation_time"],
                                                       abs=1e-6)


def test_the_radius_in_the_definition_of_an_effective_work_is_differentiated(run):
    found = run(lennard_jones(
        0.2, drive={"velocity": 8.0, "z_start": 20.0, "z_turn": -4.0}, numerics={"accuracy": 1e-3},
        sensitivity={"parameters": "bodies.radius"}))
    table = found.table("sensitivity.csv")
    rate = dict(zip(table["quantity"], table["logarithmic"]))
    assert rate["effective_work_of_adhesion"] == pytest.approx(rate["max_tension"] - 1, abs=0.01)


def test_a_number_at_the_end_of_its_range_is_varied_to_one_side(run):
    found = run(lennard_jones(
        0.2, bodies={"radius": 1.0, "young": 0.75, "poisson": 0.5},
        drive={"velocity": 8.0, "z_start": 20.0, "z_turn": -4.0}, numerics={"accuracy": 1e-4},
        sensitivity={"parameters": ["bodies.young", "bodies.poisson"]}))
    table = found.table("sensitivity.csv")
    tension = table["quantity"] == "max_tension"
    rate = dict(zip(table["parameter"][tension], table["logarithmic"][tension]))
    # The stiffness is E/(1-nu^2), whose logarithmic derivative by nu is 2/3 at 1/2.
    assert rate["bodies.poisson"] == pytest.approx(2 / 3 * rate["bodies.young"], rel=1e-2)


@pytest.mark.parametrize("name, message", [
    ("numerics.accuracy", "is not a number on which results depend"),
    ("drive.dwell", "is 0"),
    ("drive.stiffness", "the deck gives no"),
    ("bodies.young", "is a list; name an element of it, as 'bodies.young(1)'"),
    ("bodies.weight", "not a key"),
])
def test_what_a_drive_cannot_be_differentiated_by_is_named(run, name, message):
    found = run(lennard_jones(
        0.1, bodies={"radius": 1.0, "young": [1.0, 2.0], "poisson": 0.3},
        drive={"velocity": 8.0, "z_start": 20.0, "z_turn": 0.0, "dwell": 0.0},
        sensitivity={"parameters": name}), status=2)
    assert message in found.stderr
