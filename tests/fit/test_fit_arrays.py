"""Fits of curves in memory: the numbers of a file, and what is said of wrong arguments."""

import numpy as np
import pytest
import snapin
from support import study_radii
from support.measured import (  # noqa: F401 (`branches` is a fixture)
    LENNARD_JONES, POINT, SPRING, STIFFNESS, STRENGTH, branches, fitted)

PARAMETERS = [STRENGTH, POINT]


@pytest.fixture(scope="module")
def curve(branches):  # noqa: F811
    return branches.measure(100, noise=1e-11, seed=5)


def fit(curve, **changed):
    z, force, segment = curve
    return snapin.fit(z, force, **{
        "segment": segment, "spring_constant": SPRING, "deck": LENNARD_JONES,
        "parameters": PARAMETERS, **changed})


def test_arrays_give_the_numbers_of_their_file(curve, tmp_path):
    found = fit(curve)
    from_file = fitted(tmp_path, curve, LENNARD_JONES, PARAMETERS).fitted["fit"]
    assert list(found.estimate) == PARAMETERS
    for i, name in enumerate(PARAMETERS):
        assert found.estimate[name] == from_file["estimate"][i]
        assert found.standard_error[name] == from_file["standard_error"][i]
        low, high = found.interval_95[name]
        assert low < found.estimate[name] < high
    assert found.correlation.shape == (2, 2)
    assert found.chi_squared / found.degrees_of_freedom == pytest.approx(1, abs=0.3)
    assert abs(found.estimate[STRENGTH] - 1e-19) < 4 * found.standard_error[STRENGTH]
    np.testing.assert_array_equal(found.samples["measured"], curve[1])


def test_the_scene_may_be_a_text_and_the_segment_left_out(curve):
    by_text = fit(curve, deck=snapin.deck_text(LENNARD_JONES))
    assert by_text.estimate == fit(curve).estimate
    without = fit(curve, segment=None)
    assert without.estimate[STRENGTH] == pytest.approx(by_text.estimate[STRENGTH], rel=1e-2)


def test_samples_without_a_value_do_not_count(curve):
    z, force = (np.insert(x, 30, np.nan) for x in curve[:2])
    assert fit((z, force, np.insert(curve[2], 30, 0))).estimate == fit(curve).estimate


@pytest.mark.parametrize(("changed", "error", "told"), [
    ({"deck": {**LENNARD_JONES, "fit": {"parameters": POINT}}}, snapin.DeckError,
     "&fit is made of the arguments"),
    ({"parameters": ["force.strength", POINT]}, snapin.DeckError, "force.strength"),
    ({"segment": [0, 1]}, ValueError, "the numbers must be equal"),
    ({"spring_constant": -1.0}, snapin.DeckError, "spring_constant"),
    ({"lower": [1e-21]}, snapin.DeckError, "one value for each"),
    ({"branches": "none"}, snapin.DeckError, "segment"),
])
def test_wrong_arguments_are_refused(curve, changed, error, told):
    with pytest.raises(error, match=told):
        fit(curve, **changed)


def test_a_curve_without_contact_is_refused_with_the_reason(curve):
    noise = 1e-11 * np.random.default_rng(1).standard_normal(len(curve[0]))
    with pytest.raises(snapin.SnapinError, match="no contact in the data"):
        fit((curve[0], noise, curve[2]))


@pytest.mark.slow
def test_what_limits_a_fit_is_in_its_warnings(curve):
    z, force, segment = curve
    found = fit((z, force * (1 + 0.2 * np.sin(z / 3e-9)), segment), parameters=[
        STRENGTH, STIFFNESS, POINT])
    assert any("does not describe" in text for text in found.warnings)


def test_separations_and_forces_over_the_radius_are_those_of_their_positions(curve):
    """A spring whose deflection was subtracted, and the force over the radius of the deck."""
    z, force, segment = curve
    found = fit(curve)
    over = fit((z + force / SPRING, force / LENNARD_JONES["bodies"]["radius"], segment),
               quantity="separation", over_radius=True)
    for name in PARAMETERS:
        error = found.standard_error[name]
        assert over.estimate[name] == pytest.approx(found.estimate[name], abs=1e-3 * error)
        assert over.standard_error[name] == pytest.approx(error, rel=1e-3)


def test_positions_need_a_spring(curve):
    with pytest.raises(snapin.DeckError, match="the position of the base of a spring needs it"):
        fit(curve, spring_constant=None)


RUBBER = {"bodies": {"radius": study_radii.RADIUS, "stiffness": 2e8},
          "force": {"law": "lennard_jones", "z0": study_radii.Z0, "work_of_adhesion": 0.04}}


@pytest.fixture(scope="module")
def tests_of_jkr():
    """Loads and radii of JKR theory, with noise of the radius."""
    unit = (study_radii.RADIUS**2 * 0.04 / 1e8) ** (1 / 3)
    a = unit * np.linspace(1.6, 3.2, 60)
    rng = np.random.default_rng(2)
    return [(study_radii.load_of(a, 0.04, 1e8), a + 0.01 * unit * rng.standard_normal(60))
            for _ in range(2)]


def test_radii_under_loads_have_no_position(tests_of_jkr):
    first, seen = tests_of_jkr[0]
    names = [study_radii.ENERGY, study_radii.STIFFNESS]
    one = snapin.fit(None, first, contact_radius=seen, deck=RUBBER, parameters=names)
    many = snapin.fit_many([(None, load, None, radius) for load, radius in tests_of_jkr],
                           deck=RUBBER, parameters=names)
    both = snapin.fit_many([(None, load, None, radius) for load, radius in tests_of_jkr],
                           deck=RUBBER, shared=names)
    for name, true in zip(names, (0.04, 2e8)):
        error = one.standard_error[name]
        assert abs(one.estimate[name] - true) < 4 * error
        assert many.estimate[name][0] == pytest.approx(one.estimate[name], abs=0.02 * error)
        assert both.shared.standard_error[name] == pytest.approx(error / 2**0.5, rel=0.3)


def test_radii_without_loads_are_refused_with_the_reason(tests_of_jkr):
    with pytest.raises(TypeError, match="force"):
        snapin.fit(None, None, contact_radius=tests_of_jkr[0][1], deck=RUBBER,
                   parameters=study_radii.ENERGY)
