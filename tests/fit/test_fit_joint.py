"""Fits of several curves together: parameters with one value for all of them, and with a value for
each."""

import numpy as np
import pytest
import snapin
from conftest import ROOT
from support.measured import (  # noqa: F401 (`branches` is a fixture)
    LENNARD_JONES, POINT, SPRING, STIFFNESS, STRENGTH, Branches, branches)
from support.scenes import changed

TRUE = LENNARD_JONES["force"]["hamaker"]
NOISE = 1e-11


@pytest.fixture(scope="module")
def curves(branches):  # noqa: F811
    """Curves of the same bodies, each with a contact point of its own."""
    made = [branches.measure(100, noise=NOISE, seed=i) for i in range(4)]
    return [(z + 1e-9 * i, force, segment) for i, (z, force, segment) in enumerate(made)]


def together(curves, **asked):
    return snapin.fit_many(curves, **{
        "shared": STRENGTH, "own": POINT, "spring_constant": SPRING, "deck": LENNARD_JONES,
        **asked})


@pytest.fixture(scope="module")
def found(curves):
    return together(curves)


def test_a_fit_of_one_curve_is_that_of_the_curve_alone(curves):
    z, force, segment = curves[0]
    alone = snapin.fit(z, force, segment=segment, spring_constant=SPRING, deck=LENNARD_JONES,
                       parameters=[STRENGTH, POINT])
    one = together(curves[:1])
    shared = one.shared
    assert shared.chi_squared == pytest.approx(alone.chi_squared, rel=1e-6)
    assert shared.degrees_of_freedom == alone.degrees_of_freedom
    assert (shared.curves, shared.warnings) == (1, [])
    error = alone.standard_error[STRENGTH]
    assert shared.estimate[STRENGTH] == pytest.approx(alone.estimate[STRENGTH], abs=0.01 * error)
    assert shared.standard_error[STRENGTH] == pytest.approx(error, rel=0.01)
    assert shared.interval_95[STRENGTH] == pytest.approx(
        alone.interval_95[STRENGTH], abs=0.02 * error)
    assert one.estimate[POINT][0] == pytest.approx(
        alone.estimate[POINT], abs=0.01 * alone.standard_error[POINT])


def test_the_error_of_what_is_shared_falls_as_the_root_of_the_number_of_curves(found, curves):
    one, four = together(curves[:1]).shared, found.shared
    assert four.standard_error[STRENGTH] == pytest.approx(
        one.standard_error[STRENGTH] / 2, rel=0.1)
    assert abs(four.estimate[STRENGTH] - TRUE) < 4 * four.standard_error[STRENGTH]
    # One value for all, and a contact point for each.
    assert len(set(found.estimate[STRENGTH])) == 1
    off = (found.estimate[POINT] - 1e-9 * np.arange(4)) / found.standard_error[POINT]
    assert np.abs(off).max() < 4


def test_chi_squared_of_all_is_the_sum_of_those_of_the_curves(found):
    assert found.shared.chi_squared == pytest.approx(found.table["chi_squared"].sum(), rel=1e-12)
    # That of each is rounded.
    assert found.shared.degrees_of_freedom == pytest.approx(
        found.table["degrees_of_freedom"].sum(), abs=2)
    assert found.shared.degrees_of_freedom < found.table["samples"].sum() - 5
    assert list(found.table["verdict"]) == ["described"] * 4


def test_the_order_of_curves_does_not_matter(found, curves):
    turned = together(curves[::-1])
    error = found.shared.standard_error[STRENGTH]
    assert turned.shared.estimate[STRENGTH] == pytest.approx(
        found.shared.estimate[STRENGTH], abs=0.01 * error)
    assert turned.shared.standard_error[STRENGTH] == pytest.approx(error, rel=0.01)
    np.testing.assert_allclose(
        turned.estimate[POINT][::-1], found.estimate[POINT],
        atol=0.01 * found.standard_error[POINT].min())


def test_what_cannot_be_fitted_is_a_row_with_the_reason(found, curves):
    """An unreadable curve, and one without contact, leave the fit of the others as it is."""
    z, _, segment = curves[0]
    noise = NOISE * np.random.default_rng(9).standard_normal(len(z))
    some = together([curves[0], "curve", (z, noise, segment), *curves[1:]])
    assert list(some.table["verdict"]) == [
        "described", "unreadable", "refused", "described", "described", "described"]
    assert "no contact in the data" in some[2]["failure"] and some[1]["failure"]
    assert some.shared.curves == 4
    assert some.shared.estimate[STRENGTH] == pytest.approx(
        found.shared.estimate[STRENGTH], abs=0.01 * found.shared.standard_error[STRENGTH])


def test_what_is_not_described_alone_takes_no_part(found, curves):
    z, force, segment = curves[0]
    wavy = force * (1 + 0.2 * np.sin(z / 3e-9))
    some = together([(z, wavy, segment), *curves[1:]])
    assert some.table["verdict"][0] == "not_described"
    assert some[0]["warning"].startswith("not fitted together with the others: the residual")
    assert some.shared.curves == 3
    assert abs(some.shared.estimate[STRENGTH] - TRUE) < 4 * some.shared.standard_error[STRENGTH]


@pytest.fixture(scope="module")
def sticky():
    """Curves of bodies that attract each other by a fifth more."""
    more = changed(LENNARD_JONES, {STRENGTH: 1.2 * TRUE})
    return Branches(more).measure(100, noise=NOISE, seed=7)


def test_curves_that_disagree_about_what_they_share_are_not_right_in_silence(curves, sticky):
    some = together([*curves[:2], sticky])
    assert len(some.shared.warnings) == 1
    assert "the curves disagree about the shared parameters" in some.shared.warnings[0]
    assert "described" not in list(some.table["verdict"])


def test_each_curve_may_have_its_own_strength_and_all_one_stiffness(curves, sticky):
    some = together([curves[0], sticky], shared=STIFFNESS, own=[STRENGTH, POINT])
    true = {STRENGTH: np.array([1, 1.2]) * TRUE, STIFFNESS: 1e10}
    for key, value in true.items():
        assert np.abs((some.estimate[key] - value) / some.standard_error[key]).max() < 4
    alone = snapin.fit_many([curves[0], sticky], parameters=[STIFFNESS, STRENGTH, POINT],
                            spring_constant=SPRING, deck=LENNARD_JONES)
    weights = alone.standard_error[STIFFNESS] ** -2.0
    assert some.shared.standard_error[STIFFNESS] == pytest.approx(sum(weights) ** -0.5, rel=0.15)
    assert some.shared.estimate[STIFFNESS] == pytest.approx(
        np.average(alone.estimate[STIFFNESS], weights=weights),
        abs=0.5 * some.shared.standard_error[STIFFNESS])


def test_keys_may_differ_from_curve_to_curve(found, curves):
    """Signals of other detectors, with the sensitivity of each, show the same strength."""
    detectors = [1e-8, 2e-8, 1e-8, 3e-8]
    volts = [(z, force / SPRING / detector, segment)
             for (z, force, segment), detector in zip(curves, detectors)]
    some = together(volts, sensitivity=1e-8, each={"measurement.sensitivity": detectors})
    assert some.shared.estimate[STRENGTH] == pytest.approx(
        found.shared.estimate[STRENGTH], abs=0.02 * found.shared.standard_error[STRENGTH])


def test_a_prior_of_what_is_shared_counts_once(found, curves):
    """As certain as the four curves together, it halves the square of the error."""
    error = found.shared.standard_error[STRENGTH]
    some = together(curves, prior=[error, 0])
    assert some.shared.standard_error[STRENGTH] == pytest.approx(error / 2**0.5, rel=0.02)


REFUSED = {
    "a name in both": ({"own": [STRENGTH, POINT]}, "'force.hamaker' is in shared too"),
    "a name twice": ({"shared": [STRENGTH, STRENGTH]}, "is there twice"),
    "own alone": ({"shared": None}, "own: needs shared|\"own\": needs shared"),
    "parameters too": ({"parameters": STRENGTH}, "not together with shared"),
    "nothing": ({"shared": None, "own": None}, "or shared and own"),
    "a value for each": ({"each": {"force.hamaker": 4 * [TRUE]}}, "is swept too"),
    "a bound too few": ({"lower": [1e-21]}, "one value for each of shared and own"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_makes_no_sense_is_refused(curves, case):
    asked, told = REFUSED[case]
    with pytest.raises(snapin.DeckError, match=told):
        together(curves, **asked)


@pytest.mark.parametrize("sweep", [None, {"key": "bodies.radius", "values": [5e-8, 6e-8]}])
def test_one_curve_shares_nothing(curves, tmp_path, sweep):
    file = tmp_path / "curve.csv"
    np.savetxt(file, np.column_stack(curves[0]), delimiter=",", header="z,force,segment",
               comments="")
    deck = {**LENNARD_JONES, "fit": {"shared": STRENGTH, "own": POINT}, "sweep": sweep,
            "measurement": {"file": str(file), "columns": ["z", "force", "segment"],
                            "spring_constant": SPRING}}
    with pytest.raises(snapin.DeckError, match="needs several curves"):
        snapin.run(deck)


def test_the_example_gives_what_its_page_says():
    result = snapin.run(ROOT / "inputs/examples/together.nml")
    found = result.fitted["fit"]
    assert list(found["parameters"]) == [STIFFNESS]
    assert found["estimate"] == pytest.approx([10.17e9], rel=1e-3)
    assert found["standard_error"] == pytest.approx([0.12e9], rel=0.02)
    works = result.sweep["force.work_of_adhesion_estimate"]
    assert works == pytest.approx([0.2354, 0.695, 2.306], rel=1e-3)
