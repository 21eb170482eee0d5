"""Claims about fits of curves as instruments give them: much noise, outliers, starts that are far
off, little baseline, models that are wrong."""

import resource

import numpy as np
import pytest
import snapin
from support.measured import (  # noqa: F401 (`branches` is a fixture)
    LENNARD_JONES, POINT, SPRING, STIFFNESS, STRENGTH, Branches, branches, fitted, run)
from support.scenes import changed

TRUTH = {STRENGTH: 1e-19, STIFFNESS: 1e10, POINT: 0.0}
# Three hundredths of the pull-off; the spring changes by a fifth of it from sample to sample.
NOISE, SAMPLES = 2e-10, 1500


def started(strength=1.0, stiffness=1.0, **force):
    return {"bodies": {"radius": 50e-9, "stiffness": 1e10 * stiffness},
            "force": {**LENNARD_JONES["force"], "hamaker": 1e-19 * strength, **force}}


def errors_off(result):
    fit = result.fitted["fit"]
    return (fit["estimate"] - list(TRUTH.values())) / fit["standard_error"]


def jumps_off(result, branches):
    """How many of their uncertainties the measured jumps are from those of the curve."""
    fit = result.fitted["fit"]
    true = branches.outer[0][0], branches.inner[0][-1]
    return [(fit[f"jump_{way}_z"][0] - z) / fit[f"jump_{way}_z_uncertainty"][0]
            for way, z in zip(("in", "out"), true)]


@pytest.mark.parametrize("start", [(1.0, 1.0), (8.0, 0.15), (0.12, 5.0)])
def test_a_noisy_oversampled_curve_gives_truth_and_jumps_from_any_start(branches, tmp_path, start):
    result = fitted(tmp_path, branches.measure(SAMPLES, NOISE, seed=3), started(*start), TRUTH)
    assert np.abs(errors_off(result)).max() < 4
    assert np.abs(jumps_off(result, branches)).max() < 4
    assert result.fitted["fit"]["noise"][0] == pytest.approx(NOISE, rel=0.1)
    assert not any("does not describe" in text for text in result.summary.get("warnings", []))


def test_outliers_are_left_out_and_marked(branches, tmp_path):
    z, force, segment = branches.measure(SAMPLES, NOISE, seed=5)
    rng = np.random.default_rng(6)
    spoilt = rng.random(len(z)) < 0.05
    force = force + spoilt * rng.choice([-1, 1], len(z)) * rng.uniform(10, 40, len(z)) * NOISE
    result = fitted(tmp_path, (z, force, segment), started(2.0), TRUTH)
    assert np.abs(errors_off(result)).max() < 4
    assert np.abs(jumps_off(result, branches)).max() < 4
    assert result.fitted["fit"]["noise"][0] == pytest.approx(NOISE, rel=0.1)
    marked = result.fit["outlier"] == 1
    assert result.fitted["fit"]["outliers"][0] == marked.sum() >= 0.9 * spoilt.sum()
    assert (result.fit["used"][marked] == 0).all()
    # All that count are good, and next to no good sample is marked.
    assert not (spoilt & (result.fit["used"] == 1)).any()
    assert (marked & ~spoilt).sum() <= 2


@pytest.mark.slow
def test_a_wrong_range_of_force_is_said(branches, tmp_path):
    """z0 held at twice the truth: what is left exceeds the noise by little, but for long."""
    curve = branches.measure(SAMPLES, NOISE, seed=3)
    result = fitted(tmp_path, curve, started(4.0, z0=6e-10), TRUTH)
    fit = result.fitted["fit"]
    assert np.abs(errors_off(result)).max() > 5
    assert fit["chi_squared"][0] < 1.5 * fit["degrees_of_freedom"][0]
    assert any("does not describe" in text for text in result.summary["warnings"])


@pytest.mark.parametrize("off", [1e-3, 1e3])
def test_a_start_a_thousand_times_off_is_enough(branches, tmp_path, off):
    """The search once ended 148 times from the deck's value, whatever the data suggested."""
    result = fitted(tmp_path, branches.measure(400, NOISE, seed=3), started(stiffness=off), TRUTH)
    assert np.abs(errors_off(result)).max() < 4
    assert not result.summary.get("warnings")


@pytest.mark.slow
@pytest.mark.parametrize("off", [pytest.param(1e-7, marks=pytest.mark.long), 1e7])
def test_starts_that_lead_nowhere_end_with_what_the_data_suggest(branches, tmp_path, off):
    """The model is right, and would be found from a start that is nearer; there is a contact."""
    curve = branches.measure(400, NOISE, seed=3)
    with pytest.raises(snapin.SnapinError, match="the data suggest force.hamaker = ") as refused:
        fitted(tmp_path, curve, started(stiffness=off), TRUTH)
    assert "no contact" not in str(refused.value)
    assert float(str(refused.value).split("hamaker = ")[1].split(",")[0]) == pytest.approx(
        1e-19, rel=0.5)


# Keys without a value follow a fitted one: born.hamaker, capillary.smoothing.
@pytest.mark.slow
def test_what_the_data_ask_for_does_not_depend_on_the_start(tmp_path):
    """Of a number that is held, when the default of another key follows a fitted number: the
    smoothing of a bridge follows its radius."""
    truth = {"bodies": {"radius": 50e-9, "stiffness": 1e10},
             "born": {"hamaker": 1e-19, "z0": 2e-10},
             "capillary": {"surface_tension": 0.05, "kelvin_radius": 1e-9}}
    start = {"capillary.kelvin_radius": 1.4e-9}
    curve = Branches(truth, SPRING, far=40e-9, h0_end=-3e-10).measure(500, 1.3e-10, seed=1)
    asked = []
    for groups in truth, changed(truth, start):
        result = fitted(tmp_path, curve, groups, [*start, POINT])
        fit = result.fitted["fit"]
        asked.append(dict(zip(fit["held"], fit["held_asked"])))
        told = result.summary.get("warnings", [])
        assert not any("does not describe" in text for text in told), told
    assert asked[0] == pytest.approx(asked[1], abs=0.01)


def test_little_baseline_is_enough(branches, tmp_path):
    z, force, segment = branches.measure(SAMPLES, NOISE, seed=3)
    near = z < branches.inner[0][-1] + 5 * 5.5e-11
    result = fitted(tmp_path, (z[near], force[near], segment[near]), started(), TRUTH)
    assert np.abs(errors_off(result)).max() < 4


@pytest.mark.slow
def test_skipped_samples_do_not_count(branches, tmp_path):
    z, force, segment = branches.measure(SAMPLES, NOISE, seed=3)
    spoilt = (z > 20e-9) & (z < 25e-9)
    clean = fitted(tmp_path, (z[~spoilt], force[~spoilt], segment[~spoilt]), started(), TRUTH)
    skipped = fitted(tmp_path, (z, force + 1e-8 * spoilt, segment), started(), TRUTH,
                     measurement={"skip": [20e-9, 25e-9]})
    assert skipped.fitted["fit"]["estimate"] == pytest.approx(
        clean.fitted["fit"]["estimate"], rel=1e-3, abs=1e-12)
    assert not (skipped.fit["used"][spoilt] == 1).any()


def test_the_summary_speaks_of_the_answer_and_intervals_are_wider_at_95(branches, tmp_path):
    result = fitted(tmp_path, branches.measure(SAMPLES, NOISE, seed=3), started(3.0), TRUTH)
    fit = result.fitted["fit"]
    right = run({**LENNARD_JONES, "equilibrium_path": {"h0_end": -1e-9}}).summary
    assert fit["sigma"][0] == pytest.approx(right["sigma"], rel=0.1)
    for key in ("sigma", "tabor"):
        assert result.summary[key] == fit[key][0]
    wide, narrow = ((np.array(fit[f"upper_{p}"]) - fit[f"lower_{p}"])[2] for p in (95, 68))
    assert wide == pytest.approx(1.96 * narrow, rel=1e-3)


def test_a_baseline_as_steep_as_the_contact_is_no_exchange(branches, tmp_path):
    """The near end then is flat, and the far one as steep as a contact."""
    z, force, segment = branches.measure(SAMPLES, NOISE, seed=4)
    near = z < z.min() + 0.05 * np.ptp(z)
    tilted = force - np.polyfit(z[near], force[near], 1)[0] * z
    assert np.polyfit(z[near], tilted[near], 1)[0] == pytest.approx(0, abs=1e-3)
    result = fitted(tmp_path, (z, tilted, segment), started(), TRUTH)
    assert np.abs(errors_off(result)).max() < 4
    with pytest.raises(snapin.SnapinError, match="approach and retract are exchanged"):
        fitted(tmp_path, (z, tilted, 1 - segment), started(), TRUTH)


def test_units_and_skip_are_checked(tmp_path):
    for keys, said in (
            ({"units": ["N", "nN"]}, "not a unit of position"),
            ({"units": ["nm", "nm"]}, "needs sensitivity"), ({"skip": [1e-9]}, "pairs")):
        with pytest.raises(snapin.DeckError, match=said):
            fitted(tmp_path, ([0.0], [0.0], [0]), started(), TRUTH, measurement=keys)


@pytest.mark.parametrize("rise", [-5e-8, 5e-8])
def test_a_steep_baseline_does_not_hide_the_pull_off(branches, tmp_path, rise):
    z, force, segment = branches.measure(SAMPLES, NOISE, seed=8)
    tilted = force + rise * (z - z.min()) / np.ptp(z)
    result = fitted(tmp_path, (z, tilted, segment), started(4.0, 0.3), TRUTH)
    assert np.abs(errors_off(result)).max() < 4


@pytest.mark.slow
def test_a_retract_that_ends_before_the_bodies_part_is_named(branches, tmp_path):
    """The end of the retract counts as baseline, and the answer is wrong."""
    z, force, segment = branches.measure(300, NOISE, seed=7)
    jump_in, jump_out = branches.outer[0][0], branches.inner[0][-1]
    near = z < jump_out - 0.2 * (jump_out - jump_in)
    for kept, named in ((near, True), (z < z.max(), False)):
        result = fitted(tmp_path, (z[kept], force[kept], segment[kept]), started(), TRUTH)
        told = [text for text in result.summary.get("warnings", []) if "retract ends below" in text]
        assert bool(told) == named, result.summary.get("warnings")
        if not named:
            assert np.abs(errors_off(result)).max() < 4


def test_gaps_between_samples_are_no_gain_of_energy(branches, tmp_path):
    """The parts without samples once lay between the baselines of both ways."""
    z, force, segment = branches.measure(SAMPLES, NOISE, seed=3)
    part = np.floor(20 * (z - z.min()) / np.ptp(z))
    kept = ~np.isin(part, [6, 10, 13, 16])
    force = force + 50 * NOISE * (segment == 0)
    result = fitted(tmp_path, (z[kept], force[kept], segment[kept]), started(), TRUTH)
    assert np.abs(errors_off(result)).max() < 4
    assert not result.summary.get("warnings")


@pytest.mark.parametrize("start, gap", [(0.2, 1e-10), (1.0, 1e-10), (1.0, 2e-9), (5.0, 2e-9)])
def test_a_curve_that_ends_before_the_jump_is_on_the_outer_branch(branches, tmp_path, start, gap):
    """The last sample once was said to be after a jump, and the nearest one to be in contact."""
    z, force, segment = branches.measure(SAMPLES, NOISE / 100, seed=9)
    apart = (segment == 0) & (z > branches.outer[0][0] + gap)
    result = fitted(tmp_path, (z[apart], force[apart], segment[apart]), started(start),
                    [STRENGTH, POINT], measurement={"segment": "approach"})
    fit = result.fitted["fit"]
    assert np.abs((fit["estimate"] - [1e-19, 0.0]) / fit["standard_error"]).max() < 4
    assert "jump_in_z" not in fit
    told = result.summary["warnings"]
    assert not any("jump" in text or "does not describe" in text for text in told), told


def test_a_number_that_does_not_show_before_the_jump_is_named(branches, tmp_path):
    """The tension of the model is that in contact, which is not in the data."""
    z, force, segment = branches.measure(SAMPLES, NOISE / 100, seed=9)
    apart = (segment == 0) & (z > branches.outer[0][0] + 2e-9)
    with pytest.raises(snapin.SnapinError, match="bodies.stiffness has no effect"):
        fitted(tmp_path, (z[apart], force[apart], segment[apart]), started(),
               [STRENGTH, STIFFNESS], measurement={"segment": "approach", "contact_point": 0.0})


@pytest.mark.slow
def test_the_time_of_a_fit_is_proportional_to_the_samples(branches, tmp_path):
    """Ten times the samples took thirty times as long."""
    taken = []
    for n in 1500, 15000:
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        fitted(tmp_path, branches.measure(n, NOISE, seed=2), started(), TRUTH)
        taken.append(resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before)
    assert taken[1] < 15 * taken[0]
