"""Fits of force against separation: with a spring that was subtracted, without one, and of forces
over the radius."""

import numpy as np
import pytest
import snapin
from support import study_separations
from support.measured import (
    BODIES, LENNARD_JONES, POINT, SPRING, STIFFNESS, STRENGTH, Branches, fit_deck, run, write)

PARAMETERS = [STRENGTH, STIFFNESS, POINT]
NOISE = 1e-11


@pytest.fixture(scope="module")
def branches():
    return Branches(LENNARD_JONES)


def estimates(file, measurement, parameters=PARAMETERS, **others):
    return run(fit_deck(LENNARD_JONES, file, parameters, None, measurement, **others)).fitted["fit"]


@pytest.mark.parametrize("sense", [1, -1])
def test_a_spring_in_separations_is_that_of_positions(branches, tmp_path, sense):
    """Separations that grow outward, and heights of the other sense."""
    z, force, segment = branches.measure(200, noise=NOISE, seed=3)
    of_base = estimates(write(tmp_path / "z.csv", sense * z, force, segment), {})
    of_bodies = estimates(write(tmp_path / "d.csv", sense * (z + force / SPRING), force, segment),
                          {"quantity": "separation"})
    for key in ("estimate", "standard_error", "chi_squared"):
        assert of_bodies[key] == pytest.approx(of_base[key], rel=1e-6, abs=1e-14)


def test_without_a_spring_h0_is_prescribed(tmp_path):
    """Jumps are those at the turning points of h0, and the truth comes back."""
    adhering = {**LENNARD_JONES, "bodies": {**BODIES, "stiffness": 2e9}}
    z, force, segment = Branches(adhering, spring=1e20, h0_end=-6e-9, step=2e-11).measure(300, noise=NOISE, seed=4)
    file = write(tmp_path / "d.csv", z, force, segment)
    deck = fit_deck(adhering, file, PARAMETERS, None, {"quantity": "separation"})
    del deck["measurement"]["spring_constant"]
    found = run(deck).fitted["fit"]
    off = (np.array(found["estimate"]) - [1e-19, 2e9, 0]) / found["standard_error"]
    assert np.abs(off).max() < 3
    assert found["standard_error"][0] < 1e-21
    assert abs(found["excess"][0]) < 3


def test_a_force_over_the_radius_is_that_force(branches, tmp_path):
    z, force, segment = branches.measure(200, noise=NOISE, seed=3)
    newtons = estimates(write(tmp_path / "f.csv", z, force, segment), {})
    over = write(tmp_path / "o.csv", z, 1e3 * force / BODIES["radius"], segment,
                 header="z,F/R (mN/m),segment")
    found = estimates(over, {"columns": ["z", "F/R", "segment"]})
    by_units = estimates(write(tmp_path / "u.csv", z, 1e3 * force / BODIES["radius"], segment),
                         {"units": ["m", "mN/m"]})
    for fit in (found, by_units):
        assert fit["estimate"] == pytest.approx(newtons["estimate"], rel=1e-6, abs=1e-14)
        assert fit["signal_unit"] == ["N/m"]
        assert fit["noise"][0] * BODIES["radius"] == pytest.approx(newtons["noise"][0], rel=1e-6)


REFUSED = {
    "a position without a spring": ({"spring_constant": None}, {}, '"spring_constant": missing'),
    "another word": ({"quantity": "distance"}, {}, "'distance' is not a quantity; allowed are "
                                                    "position, separation"),
    "a word too few": ({"quantity": ["separation", "load"]}, {},
                       "one quantity for each of columns"),
    "no load": ({"quantity": ["separation", "position", "segment"]}, {},
                "a position or a separation"),
    "a spring that is fitted": (
        {"quantity": "separation"},
        {"parameters": [STRENGTH, POINT, "measurement.spring_constant"]},
        "cannot be fitted to separations"),
    "a deflection without a spring": (
        {"quantity": "separation", "spring_constant": None, "sensitivity": 1e-8}, {},
        "a deflection is that of a spring"),
    "a deflection over the radius": (
        {"units": ["nm", "mN/m"], "sensitivity": 1e-8}, {}, "has no sensitivity"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_separations_do_not_have_is_refused(branches, tmp_path, case):
    keys, fit, told = REFUSED[case]
    file = write(tmp_path / "curve.csv", *branches.measure(30))
    deck = fit_deck(LENNARD_JONES, file, [STRENGTH, POINT], fit, keys)
    for key in [key for key, value in deck["measurement"].items() if value is None]:
        del deck["measurement"][key]
    with pytest.raises(snapin.DeckError, match=told):
        snapin.run(deck)


def test_a_force_over_a_radius_needs_one(branches, tmp_path):
    z, force, segment = branches.measure(30)
    cone = {"bodies": {"stiffness": 1e10}, "shape": {"kind": "cone", "half_angle": 1.4},
            "force": LENNARD_JONES["force"]}
    file = write(tmp_path / "curve.csv", z, force, segment, header="z,force (N/m),segment")
    with pytest.raises(snapin.SnapinError, match="needs radius in &bodies"):
        snapin.run(fit_deck(cone, file, [STRENGTH, POINT]))


@pytest.mark.slow
@pytest.mark.parametrize("number", range(4))
def test_separations_of_the_independent_solution_give_its_values(number):
    """Every other one without a spring."""
    job = study_separations.separation_jobs(number + 1, seed=40)[number]
    finding, = study_separations.examine(job)
    assert not finding.wrong
    assert np.abs(finding.off).max() < 4
