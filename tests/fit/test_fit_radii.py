"""Fits of contact radii: under loads, and beside the load against the separation."""

import numpy as np
import pytest
import snapin
from support import study_radii
from support.measured import LENNARD_JONES, POINT, STIFFNESS, STRENGTH, fit_deck, run
from support.scenes import changed

TRUTH = {STRENGTH: 1e-19, STIFFNESS: 2e9}
SCENE = changed(LENNARD_JONES, TRUTH)
LOADS = {"columns": ["F", "a"], "quantity": ["load", "contact_radius"]}
ALL = {"columns": ["D", "F", "a"], "quantity": ["separation", "load", "contact_radius"],
       "segment": "retract"}


def written(folder, names, *columns):
    file = str(folder / "test.csv")
    np.savetxt(file, np.column_stack(columns), "%.16e", ",", header=names, comments="")
    return file


def deck_of(groups, file, parameters, measurement, **fit):
    deck = fit_deck(groups, file, parameters, fit, measurement, numerics={"accuracy": 1e-6})
    del deck["measurement"]["spring_constant"]
    return deck


@pytest.fixture(scope="module")
def contact():
    """The states of a retract, stable at prescribed h0."""
    steps = {"h0_start": 40e-9, "h0_end": -8e-9, "h0_step": 1e-10}
    curve = snapin.run({**SCENE, "loading": steps, "unloading": {
        "from": -8e-9, "h0_end": 40e-9, "h0_step": 5e-11}, "numerics": {"accuracy": 1e-8}}).curve
    return curve[curve["branch"] == "unloading_1"]


def test_exact_radii_under_loads_give_the_values_back(contact, tmp_path):
    """The radius of the fit is that of curve.csv."""
    pulled = contact["load"].argmin()
    rows = contact[:pulled - 1]
    file = written(tmp_path, "F,a", rows["load"], rows["contact_radius"])
    start = changed(SCENE, {key: 1.1 * value for key, value in TRUTH.items()})
    found = run(deck_of(start, file, [*TRUTH], LOADS, noise=1e-13)).fitted["fit"]
    assert found["estimate"] == pytest.approx(list(TRUTH.values()), rel=1e-5)


def test_exact_radii_beside_loads_give_the_values_back(contact, tmp_path):
    file = written(tmp_path, "D,F,a", contact["h0"], contact["load"], contact["contact_radius"])
    start = changed(SCENE, {key: 1.1 * value for key, value in TRUTH.items()})
    result = run(deck_of(start, file, [*TRUTH, POINT], ALL, noise=[1e-13, 1e-13]))
    found = result.fitted["fit"]
    assert found["estimate"][:2] == pytest.approx(list(TRUTH.values()), rel=1e-5)
    assert abs(found["estimate"][2]) < 1e-14
    assert (result.fit["radius"] == 1).sum() == (contact["contact_radius"] > 0).sum()


def test_errors_of_a_jkr_test_are_those_of_its_theory(tmp_path):
    """Radii under loads tell work of adhesion and modulus apart as the derivatives of JKR's radius
    do: the errors and their correlation are those of its information."""
    energy, modulus, samples = 0.04, 1e8, 200
    unit = (study_radii.RADIUS**2 * energy / modulus) ** (1 / 3)
    a = unit * np.linspace(1.6, 3.2, samples)
    load = study_radii.load_of(a, energy, modulus)
    noise = 0.02 * unit
    seen = a + noise * np.random.default_rng(1).standard_normal(samples)
    file = written(tmp_path, "F,a", load, seen)
    groups = {"bodies": {"radius": study_radii.RADIUS, "stiffness": 2 * modulus},
              "force": {"law": "lennard_jones", "z0": study_radii.Z0, "work_of_adhesion": energy}}
    names = [study_radii.ENERGY, study_radii.STIFFNESS]
    found = run(deck_of(groups, file, names, LOADS, noise=noise)).fitted["fit"]

    def by(argument):
        """Derivative of the radius at these loads by the logarithm of an argument."""
        step = 1e-5
        more, less = ([x * (1 + sign * step * (i == argument)) for i, x in
                       enumerate((energy, modulus))] for sign in (1, -1))
        change = (study_radii.load_of(a, *more) - study_radii.load_of(a, *less)) / (2 * step)
        slope = np.gradient(load, a, edge_order=2)
        return -change / slope

    jacobian = np.column_stack([by(0), by(1)]) / noise
    covariance = np.linalg.inv(jacobian.T @ jacobian)
    errors = np.array(found["standard_error"]) / found["estimate"]
    assert errors == pytest.approx(np.sqrt(np.diag(covariance)), rel=0.1)
    correlation = covariance[0, 1] / np.sqrt(covariance[0, 0] * covariance[1, 1])
    assert found["correlation"][1][0] == pytest.approx(correlation, abs=0.03)


def test_a_sweep_over_tests_has_no_contact_point(contact, tmp_path):
    rows = contact[:contact["load"].argmin() - 1]
    for i in range(2):
        np.savetxt(tmp_path / f"{i}.csv", np.column_stack([rows["load"], rows["contact_radius"]]),
                   "%.16e", ",", header="F,a", comments="")
    deck = deck_of(SCENE, "", [*TRUTH], LOADS, noise=1e-12)
    del deck["measurement"]["file"]
    deck["sweep"] = {"key": "measurement.file", "words": str(tmp_path / "*.csv")}
    table = run(deck).sweep
    assert len(table) == 2
    assert table[f"{STRENGTH}_estimate"] == pytest.approx(TRUTH[STRENGTH], rel=1e-4)
    assert np.isnan(table["contact_height"]).all()


REFUSED = {
    "no load": ({"columns": ["F", "a"], "quantity": ["separation", "contact_radius"]}, {},
                "needs a load: .*only the work of adhesion over the modulus"),
    "a load alone": ({"columns": ["F", "a"], "quantity": ["load", "segment"]}, {},
                     "a load needs a position"),
    "two radii": ({"columns": ["F", "a"], "quantity": ["contact_radius", "contact_radius"]}, {},
                  "each quantity once"),
    "a contact point": (LOADS, {"parameters": [STRENGTH, POINT]},
                        "contact_point' does not change contact radii under loads"),
    "a spring": ({**LOADS, "spring_constant": 1.0}, {}, "need no spring"),
    "two noises": (LOADS, {"noise": [1e-9, 1e-9]}, "one value"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_radii_that_cannot_be_fitted_are_refused(tmp_path, case):
    keys, fit, told = REFUSED[case]
    file = written(tmp_path, "F,a", np.linspace(1e-9, 2e-9, 30), np.linspace(1e-9, 2e-9, 30))
    deck = deck_of(SCENE, file, [STRENGTH], {})
    deck["measurement"].update(keys)
    deck["fit"].update(fit)
    with pytest.raises(snapin.DeckError, match=told):
        snapin.run(deck)


def test_bodies_that_only_repel_have_no_contact_radius(tmp_path):
    file = written(tmp_path, "F,a", np.linspace(1e-9, 2e-9, 30), np.linspace(1e-9, 2e-9, 30))
    groups = {"bodies": SCENE["bodies"],
              "force": {"law": "exponential", "p0": 1e6, "decay_length": 1e-10}}
    with pytest.raises(snapin.SnapinError, match="need a force that pulls and pushes"):
        snapin.run(deck_of(groups, file, [STIFFNESS], LOADS))


@pytest.mark.slow
@pytest.mark.parametrize("number", range(4))
def test_jkr_tests_give_the_values_of_their_theory(number):
    """Every other one with separations."""
    finding, = study_radii.examine(study_radii.radius_jobs(number + 1, seed=40)[number])
    assert not finding.wrong
    assert np.abs(finding.off).max() < 4
