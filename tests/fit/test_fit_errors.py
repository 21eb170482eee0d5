"""Claims about standard errors and intervals where the model is far from linear over a few of them:
shallow curves of stiff bodies, and jumps that a noisy sample hides; about what no error shows."""

import re

import numpy as np
import pytest
import snapin
from support.measured import (  # noqa: F401 (`branches` is a fixture)
    LENNARD_JONES, POINT, SPRING, STIFFNESS, STRENGTH, Branches, branches, fitted)
from support.scenes import changed

# Pressed with a quarter of the pull-off only, and stiff: beyond some modulus the curve no longer
# depends on it.
STIFF = changed(LENNARD_JONES, {STIFFNESS: 5e10, STRENGTH: 5e-20})
TRUTH = {STRENGTH: 5e-20, STIFFNESS: 5e10, POINT: 0.0}
SOFT_SPRING = 0.5
# A tenth of the pull-off.
NOISE = 3.4e-10
HIDES_JUMP = 2.9


@pytest.fixture(scope="module")
def shallow():
    return Branches(STIFF, SOFT_SPRING, far=20e-9, h0_end=2e-10)


def fit_of(tmp_path, curve, groups, keys=tuple(TRUTH), spring=SOFT_SPRING):
    return fitted(tmp_path, curve, groups, keys, {"noise": NOISE},
                  measurement={"spring_constant": spring}).fitted["fit"]


@pytest.mark.parametrize("seed, modulus", [(5, 1.0), (8, 2.0), (40, 0.5)])
def test_a_modulus_that_hardly_shows_is_within_its_errors(shallow, tmp_path, seed, modulus):
    """By chance the noise of these curves is best explained by bodies ten times softer."""
    start = changed(STIFF, {STIFFNESS: 5e10 * modulus})
    fit = fit_of(tmp_path, shallow.measure(300, NOISE, seed), start)
    ratio = fit["estimate"][1] / TRUTH[STIFFNESS]
    assert ratio < 0.1
    # Positive numbers have errors of their logarithms.
    assert abs(np.log(ratio)) < 4 * fit["standard_error"][1] / fit["estimate"][1]
    strength = fit["estimate"][0] / TRUTH[STRENGTH]
    assert abs(np.log(strength)) < 4 * fit["standard_error"][0] / fit["estimate"][0]
    assert abs(fit["estimate"][2]) < 4 * fit["standard_error"][2]


def test_errors_grow_where_the_farthest_trial_is_nearer_than_three_of_them(shallow, tmp_path):
    """Where the search may go no farther than two errors, nothing was examined."""
    start = changed(STIFF, {STIFFNESS: TRUTH[STIFFNESS] / 100})
    fit = fit_of(tmp_path, shallow.measure(300, NOISE, 8), start)
    assert fit["upper_95"][1] > TRUTH[STIFFNESS]


@pytest.mark.slow
def test_the_ends_of_intervals_are_less_likely_than_the_estimate(shallow, tmp_path):
    """With the modulus held at either end of its 95 % interval and the others found again, chi
    squared is larger by nearly four at least, also where its rise ends soon."""
    curve = shallow.measure(300, NOISE, 40)
    free = fit_of(tmp_path, curve, STIFF)
    # The soft side is steep and its interval short; on the stiff side all moduli look alike.
    low, high = (free[f"{end}_95"][1] / free["estimate"][1] for end in ("lower", "upper"))
    assert high * low > 2
    for end in "lower_95", "upper_95":
        held = fit_of(tmp_path, curve, changed(STIFF, {STIFFNESS: free[end][1]}), [STRENGTH, POINT])
        rise = held["chi_squared"][0] - free["chi_squared"][0]
        assert rise > 0.75 * 1.96**2, end


def test_a_number_without_effect_is_named_with_the_value_where_it_has_none(shallow, tmp_path):
    """Softer bodies would show: their modulus is not without effect everywhere."""
    with pytest.raises(snapin.SnapinError, match="bodies.stiffness has no effect .* near the best "
                       "value found, .*give a prior") as refused:
        fit_of(tmp_path, shallow.measure(300, NOISE, 2), STIFF)
    assert float(re.search(r"found, (\S+);", str(refused.value))[1]) > TRUTH[STIFFNESS]


@pytest.mark.parametrize("seed", [2, 3])
def test_a_sample_that_hides_a_jump_widens_its_uncertainty(branches, tmp_path, seed):
    """The first sample after the jump seems to be before it. The jump then is off by no more of its
    uncertainties than the sample is off by standard deviations of the noise."""
    z, force, segment = branches.measure(1500, NOISE, seed)
    jump = branches.outer[0][0]
    first = np.argmax((segment == 0) & (z < jump))
    force[first] = branches.force(z[first : first + 1], True)[0] + HIDES_JUMP * NOISE
    fit = fit_of(tmp_path, (z, force, segment), LENNARD_JONES, spring=SPRING)
    assert fit["jump_in_z"][0] < jump
    assert abs(fit["jump_in_z"][0] - jump) < HIDES_JUMP * fit["jump_in_z_uncertainty"][0]
    assert abs(fit["estimate"][2]) < HIDES_JUMP * fit["standard_error"][2]


def test_a_wrong_spring_constant_cannot_be_seen_in_a_deflection(branches, tmp_path):
    """Forces, strength and modulus are proportional to it, with the same residuals."""
    z, force, segment = branches.measure(300, 2e-11, seed=1)
    found = []
    for factor in 1.0, 3.0:
        start = changed(LENNARD_JONES, {STRENGTH: 1e-19 * factor, STIFFNESS: 1e10 * factor})
        found.append(fitted(
            tmp_path, (z, force / SPRING, segment), start, TRUTH, {"noise": 2e-11 / SPRING},
            measurement={"spring_constant": SPRING * factor, "sensitivity": 1.0}).fitted["fit"])
    right, wrong = found
    assert wrong["estimate"][:2] == pytest.approx(3 * np.array(right["estimate"][:2]), rel=1e-3)
    assert wrong["chi_squared"][0] == pytest.approx(right["chi_squared"][0], abs=0.01)


@pytest.mark.slow
def test_a_saturated_detector_has_a_warning_and_its_samples_can_be_left_out(branches, tmp_path):
    """The pull-off was too small by five errors, and no warning said so."""
    z, force, segment = branches.measure(1500, NOISE / 5, seed=4)
    force = np.maximum(force, 0.8 * branches.inner[1].min())
    fit = fit_of(tmp_path, (z, force, segment), LENNARD_JONES, spring=SPRING)
    found = re.search(r"samples in a row.* skip = (\S+), ([^\s']+)", str(fit["warnings"]))
    fit = fitted(tmp_path, (z, force, segment), LENNARD_JONES, TRUTH, {"noise": NOISE / 5},
                 measurement={"skip": [float(found[1]), float(found[2])]}).fitted["fit"]
    assert "in a row" not in str(fit.get("warnings"))
    true = [1e-19, 1e10, 0.0]
    assert np.all(np.abs(np.array(fit["estimate"]) - true) < 4 * np.array(fit["standard_error"]))


@pytest.mark.parametrize("step", [0.02, 0.1])
def test_the_noise_of_a_signal_of_few_digits_is_that_of_rounding_at_least(branches, tmp_path, step):
    """Neighbours that are alike seemed to have no noise."""
    z, force, segment = branches.measure(1500, 0.0, seed=3)
    step = step * -branches.inner[1].min()
    curve = z, step * np.round(force / step), segment
    fit = fitted(tmp_path, curve, LENNARD_JONES, TRUTH).fitted["fit"]
    assert fit["noise"][0] == pytest.approx(step / np.sqrt(12), rel=1e-6)
    true = [1e-19, 1e10, 0.0]
    assert np.all(np.abs(np.array(fit["estimate"]) - true) < 4 * np.array(fit["standard_error"]))
    # A bow that chance explains in one fit of fifty is named, if it would move a number far.
    assert all("may be chance" in text for text in fit.get("warnings", []))


@pytest.mark.slow
def test_a_number_at_the_end_of_its_range_does_not_keep_others_from_their_best_values(tmp_path):
    """The search could not step beyond a regulation of 1, and ended with another contact point."""
    groups = {"bodies": {"radius": 5e-6, "stiffness": 1e10}, "van_der_waals": {"hamaker": 2e-20},
              "born": {"z0": 3e-10},
              "double_layer": {"potential": -0.05, "salt": 1.0, "regulation": 1.0}}
    curve = Branches(groups, 20.0, far=100e-9, h0_end=-3e-9, step=5e-11).measure(400, 8e-10, seed=3)
    found = []
    for start in 1.0, 0.5:
        begun = changed(groups, {"double_layer.regulation": start})
        found.append(fitted(tmp_path, curve, begun, ["double_layer.regulation", POINT],
                            measurement={"spring_constant": 20.0}).fitted["fit"])
    assert found[0]["estimate"][0] == pytest.approx(1, rel=1e-3)
    for key in "estimate", "standard_error":
        assert found[0][key] == pytest.approx(found[1][key], rel=0.01, abs=1e-13)
    assert all("touches upper = 1" in str(fit["warnings"]) for fit in found)
    # No interval goes beyond what the key allows.
    assert all(fit["upper_95"][0] == 1 for fit in found)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 8])
def test_a_number_has_the_error_that_another_brings_along_a_curved_valley(tmp_path, seed):
    """The spring is so soft that stiff bodies look like soft ones which adhere more. The modulus
    had an error of a factor of 75, the strength one of a hundredth, fifteen of which it was off."""
    spring = 0.01
    curves = Branches(LENNARD_JONES, spring)
    z, load = curves.outer
    # Far out, the attraction of a rigid sphere; the pull-off is at 0.64 um.
    far = np.linspace(1.02 * z[-1], 1.3e-6, 400)
    curves.outer = np.append(z, far), np.append(load, load[-1] * (z[-1] / far) ** 2)
    fit = fitted(tmp_path, curves.measure(300, 6e-11, seed), LENNARD_JONES, TRUTH,
                 measurement={"spring_constant": spring}).fitted["fit"]
    for number, true in enumerate([1e-19, 1e10]):
        estimate, error = fit["estimate"][number], fit["standard_error"][number]
        assert abs(np.log(estimate / true)) < 4 * error / estimate


@pytest.mark.slow
def test_a_sample_at_the_turn_of_its_branch_makes_no_error_small(tmp_path):
    """A small jump cannot be located, and a sample close to it had a derivative without limit. Two
    numbers that cannot be told apart had errors of a thousandth, with one 700 of them off."""
    truth = {"capillary.humidity": 0.5, "capillary.surface_tension": 0.0728}
    groups = {"bodies": {"radius": 50e-9, "stiffness": 1e10},
              "born": {"hamaker": 1e-19, "z0": 2e-10},
              "capillary": {"humidity": 0.5, "surface_tension": 0.0728}}
    curve = Branches(groups, SPRING, far=40e-9, h0_end=-3e-10).measure(300, 3e-10, seed=9)
    start = changed(groups, {"capillary.humidity": 0.6, "capillary.surface_tension": 0.051})
    result = fitted(tmp_path, curve, start, [*truth, POINT], numerics={"accuracy": 1e-2})
    fit = result.fitted["fit"]
    for number, true in enumerate(truth.values()):
        estimate, error = fit["estimate"][number], fit["standard_error"][number]
        assert abs(np.log(estimate / true)) < 4 * error / estimate
    assert any("cannot be told apart" in text for text in result.summary["warnings"])
