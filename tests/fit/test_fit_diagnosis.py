"""What a fit finds out about its data: rests at the turn, weak contacts, baselines that are bent or
ripple, a wrong spring constant, ways that disagree; and fits of bodies without attraction."""

import math
import re

import numpy as np
import pytest
import snapin
from support import study_fits
from support.measured import (  # noqa: F401 (`branches` is a fixture)
    BODIES, LENNARD_JONES, POINT, SPRING, STIFFNESS, STRENGTH, branches, fit_deck, fitted, run,
    write)
from support.scenes import changed

RADIUS, SOFT, SPRING_OF_GELS = 5e-6, 800.0, 0.03
REPULSION = {"bodies": {"radius": RADIUS, "stiffness": SOFT},
             "force": {"law": "exponential", "p0": 1e6, "decay_length": 1e-10}}


def told(result):
    return [text for text in result.summary.get("warnings", []) if text.startswith("fit:")]


def estimates(result):
    fit = result.fitted["fit"]
    return dict(zip(fit["parameters"], zip(fit["estimate"], fit["standard_error"])))


def hertz_curve(n=60, noise=3e-12, seed=0, depth=2e-6, exponent=1.5, prefactor=None):
    """Hertz' contact behind a spring: z, force, segment, at equal steps of the base; the load is
    prefactor times a power of the depth."""
    prefactor = prefactor or 2 / 3 * SOFT * math.sqrt(RADIUS)
    delta = np.linspace(0, 1.5 * depth, 4000)
    load = prefactor * delta**exponent
    base = delta + load / SPRING_OF_GELS
    z = np.linspace(2 * depth, -(depth + prefactor * depth**exponent / SPRING_OF_GELS), n)
    force = np.interp(-z, base, load, left=0)
    z, force = np.append(z, z[::-1]), np.append(force, force[::-1])
    noisy = force + noise * np.random.default_rng(seed).standard_normal(len(z))
    return z, noisy, np.repeat([0, 1], n)


def fit_of_gel(folder, curve, groups=REPULSION, parameters=(STIFFNESS, POINT), **measurement):
    return fitted(folder, curve, groups, parameters,
                  measurement={"spring_constant": SPRING_OF_GELS, **measurement})


@pytest.mark.parametrize("start", [1.0, 10.0, 0.02])
def test_bodies_that_only_repel_are_fitted_as_they_are(tmp_path, start):
    """The weak attraction that was needed beside the repulsion moved the contact of soft bodies by
    0.2 um. The curve is Hertz' closed form."""
    groups = changed(REPULSION, {STIFFNESS: SOFT * start})
    result = fit_of_gel(tmp_path, hertz_curve(), groups)
    (stiffness, error), (point, place) = estimates(result).values()
    assert stiffness == pytest.approx(SOFT, rel=0.01)
    assert abs(stiffness - SOFT) < 4 * error
    # The repulsion keeps the bodies a few decay lengths apart.
    assert abs(point) < 4 * place + 3e-9
    assert result.fitted["hertz"]["estimate"][0] == pytest.approx(stiffness, rel=0.01)
    assert not told(result)


def test_a_cone_that_only_repels_is_fitted(tmp_path):
    """Sneddon's closed form, F = 2/pi E* tan(half angle) depth^2, with E* half of the stiffness."""
    half_angle = 70.0
    prefactor = SOFT / math.pi * math.tan(math.radians(half_angle))
    groups = {"bodies": {"stiffness": 3 * SOFT},
              "shape": {"kind": "cone", "half_angle": math.radians(half_angle)},
              "force": REPULSION["force"]}
    result = fit_of_gel(tmp_path, hertz_curve(exponent=2.0, prefactor=prefactor), groups)
    assert estimates(result)[STIFFNESS][0] == pytest.approx(SOFT, rel=0.01)


def test_errors_without_attraction_are_those_of_the_closed_form(tmp_path):
    """The derivatives are differences of solved curves; Hertz' are exact."""
    result = fitted(tmp_path, hertz_curve(noise=1e-11, seed=3), REPULSION, [STIFFNESS, POINT],
                    {"noise": 1e-11}, measurement={"spring_constant": SPRING_OF_GELS})
    assert result.fitted["fit"]["standard_error"] == pytest.approx(
        result.fitted["hertz"]["standard_error"], rel=0.02)


@pytest.mark.parametrize("way", [0, 1])
def test_a_fall_of_the_load_while_the_base_rests_at_the_turn_is_left_out(tmp_path, way):
    """It once counted as a jump, and the rows were said to be in reverse order."""
    z, force, segment = hertz_curve()
    n = len(z) // 2
    rest = z[n - 1] + np.abs(np.arange(12)) * 3e-11
    falling = force[n - 1] * (1 - 0.05 * np.linspace(0, 1, 12) ** 0.5)
    curve = (np.insert(z, n, rest), np.insert(force, n, falling), np.insert(segment, n, 12 * [way]))
    result = fit_of_gel(tmp_path, curve)
    assert estimates(result)[STIFFNESS][0] == pytest.approx(SOFT, rel=0.01)
    assert result.fitted["fit"]["rested"][0] >= 10
    assert not told(result)


def test_a_contact_of_few_weak_samples_is_no_absence_of_contact(tmp_path):
    """Each sample is within eight deviations of the noise; their mean is not."""
    curve = hertz_curve(46, seed=2)
    z, force, segment = (column[:46] for column in curve)
    kept = z > -6e-7
    noise = 0.2 * force[kept].max()
    weak = force[kept] + noise * np.random.default_rng(5).standard_normal(kept.sum())
    result = fit_of_gel(tmp_path, (z[kept], weak, segment[kept]), segment="approach")
    fit = result.fitted["fit"]
    assert fit["lower_95"][0] < SOFT < fit["upper_95"][0]


def test_the_fewest_samples_are_twenty_on_a_way_and_two_for_each_number_with_four_more(tmp_path):
    with pytest.raises(snapin.DeckError, match="fewer than 20 samples of the approach"):
        fit_of_gel(tmp_path, hertz_curve(19))
    fit_of_gel(tmp_path, hertz_curve(20))
    z, force, segment = (column[:30] for column in hertz_curve(30))
    half = (z[0] - z[1]) / 2

    def left(near):
        """The fit of the four farthest samples and of some nearest ones."""
        return fit_of_gel(tmp_path, (z, force, segment), segment="approach",
                          skip=[z[29 - near] - half, z[4] + half])

    assert (left(4).fit["used"] == 1).sum() == 8
    with pytest.raises(snapin.SnapinError, match="too few samples for so many parameters"):
        left(3)


@pytest.mark.parametrize("seed", [2, 3, 4])
def test_a_contact_at_the_end_alone_is_no_absence_of_contact(tmp_path, seed):
    """Three weak samples at the end of a line: means over neighbours anywhere did not show them."""
    noise, n = 1e-12, 200
    z = np.linspace(1e-6, 0, n)
    force = noise * np.random.default_rng(seed).standard_normal(n)
    force[-3:] += noise * np.array([1.5, 3, 5])
    result = fit_of_gel(tmp_path, (z, force, 0 * z), segment="approach")
    assert result.fitted["fit"]["estimate"][0] > 0


@pytest.mark.slow
def test_a_fall_of_the_load_between_two_samples_at_the_turn_is_no_reversed_order(tmp_path):
    """A sample that loses load as the base turns: it was said to jump in reverse order."""
    z, force, segment = hertz_curve(60)
    z[61], force[61:] = z[60] + 6e-12, 0.95 * force[61:]
    assert fit_of_gel(tmp_path, (z, force, segment)).fitted


@pytest.mark.parametrize("seed", [0, 1])
def test_a_load_that_relaxes_in_a_sample_at_the_turn_is_left_out(tmp_path, seed):
    """The halves of the rest hardly differed, and the right model was said not to describe it."""
    z, force, segment = hertz_curve(60, seed=seed)
    noise = 3e-12 * np.random.default_rng(seed).standard_normal(10)
    rest = force[59] * (1 - 0.01 * (1 - np.exp(-np.arange(10) / 0.4))) + noise
    curve = (np.insert(z, 60, np.full(10, z[59])), np.insert(force, 60, rest),
             np.repeat([0, 1], [60, 70]))
    result = fit_of_gel(tmp_path, curve)
    stiffness, error = estimates(result)[STIFFNESS]
    assert abs(stiffness - SOFT) < 4 * error
    assert not any("does not describe" in text for text in told(result))


def test_a_curve_that_is_nearly_all_contact_is_fitted(tmp_path):
    """A far third of the travel that is in contact was once the noise, and there was no contact."""
    z, force, segment = hertz_curve(200, noise=3e-11)
    kept = z < 1.5e-7
    result = fit_of_gel(tmp_path, (z[kept], force[kept], segment[kept]))
    stiffness, error = estimates(result)[STIFFNESS]
    assert abs(stiffness - SOFT) < max(4 * error, 0.02 * SOFT)
    assert not any("does not describe" in text for text in told(result))


def test_samples_in_hard_contact_alone_are_no_absence_of_contact(branches, tmp_path):
    """They lie on a straight line with the slope of the spring."""
    z, force, segment = branches.measure(300, noise=1e-11)
    near = z < 1e-9
    rng = np.random.default_rng(1)
    force = force + 5e-11 * rng.standard_normal(len(z))
    with pytest.raises(snapin.SnapinError, match=r"no baseline in the data.* % of the slope"):
        fitted(tmp_path, (z[near], force[near], segment[near]), LENNARD_JONES, [STRENGTH, POINT])


@pytest.mark.slow
def test_an_approach_alone_is_not_refused_for_a_tension_of_the_retract(tmp_path):
    """The largest tension of the model, that of the retract, was compared with an approach."""
    z, force, segment = hertz_curve(60)
    kept = segment == 0
    groups = {"bodies": {"radius": RADIUS, "stiffness": 4e3},
              "force": {"law": "lennard_jones", "surface_energy": 1e-6, "z0": 5e-9}}
    found = []
    for energy in (1e-6, 1e-5):
        result = fit_of_gel(tmp_path, (z[kept], force[kept] * (1 + 0.1 * np.sin(3e6 * z[kept])),
                                       segment[kept]),
                            changed(groups, {"force.surface_energy": energy}),
                            ["force.surface_energy", STIFFNESS, POINT], segment="approach")
        found.append((result.fitted["fit"]["estimate"][1],
                      [re.sub(r"[-+0-9.e]+", "#", text) for text in told(result)]))
    assert found[0][0] == pytest.approx(found[1][0], rel=0.01)
    assert found[0][1] == found[1][1]


@pytest.mark.slow
@pytest.mark.parametrize("number", [1010, 1081, 1136])
def test_strongly_adhering_bodies_find_their_optimum(number):
    """From starts up to ten times off these fits of curves of the independent solution once ended
    in another optimum: the misfit of a wrong contact point counted as correlated noise."""
    [finding] = study_fits.examine(study_fits.Job("clean", number))
    assert not finding.wrong
    assert not any("does not describe" in text for text in finding.warned)


@pytest.mark.slow
@pytest.mark.parametrize("kind, number", [("filtered", 30), ("digits", 3), ("outliers", 1)])
def test_fits_find_the_truth_in_several_kinds_of_noise(kind, number):
    """A sample of the study that tools/verify/judge.py makes of 150 curves (`fits`)."""
    [finding] = study_fits.examine(study_fits.Job(kind, number))
    assert not finding.wrong
    assert max(abs(distance) for distance in finding.off) < 4
    assert not finding.warned


@pytest.mark.slow
@pytest.mark.parametrize("number", [5044, 6009, 6051])
def test_noise_of_a_filter_is_found_without_many_far_samples(number):
    """These curves have few samples beyond both jumps. Their correlated noise was taken for white:
    errors were up to three times too small, and the right model was called wrong."""
    [finding] = study_fits.examine(study_fits.Job("filtered", number))
    assert max(abs(distance) for distance in finding.off) < 3.5
    assert not any("does not describe" in text for text in finding.warned)


BASELINES = {"bow": "baseline = 'quadratic'", "drift": "slope_each_way = .true.",
             "interference": "ripple = .true."}


@pytest.mark.slow
@pytest.mark.parametrize("kind", [
    "bow", "drift", pytest.param("interference", marks=pytest.mark.long)])
def test_what_a_baseline_lacks_is_named_and_can_be_given(tmp_path, kind):
    """A bow of a few deviations of the noise once made a stiffness 69 % too large in silence."""
    job = study_fits.Job(kind, 4)
    true, curve, start, keys = study_fits.made(job)
    plain = run(study_fits.deck_of(true, write(tmp_path / "a.csv", *curve), start, {}))
    named = [text for text in told(plain) if BASELINES[kind] in text]
    assert named, told(plain)
    assert re.search(r"would lower chi squared by \S+ and move \S+ by", named[0])
    [finding] = study_fits.examine(job)
    assert not finding.wrong
    assert not any(name in text for text in finding.warned for name in BASELINES.values())


def test_a_bow_that_noise_hides_is_told_with_what_it_would_do(tmp_path):
    """A bow that lowers chi squared by 3 of 542 moves the stiffness by seven standard errors. No
    test finds it, so that a note says what such a bow would do; the bow costs no warning."""
    job = study_fits.Job("bow", 75, told=False)
    true, curve, start, _ = study_fits.made(job)
    result = run(study_fits.deck_of(true, write(tmp_path / "a.csv", *curve, digits=8), start, {}))
    fit = result.fitted["fit"]
    off = (fit["estimate"][1] - true.stiffness) / fit["standard_error"][1]
    hidden = dict(zip(fit["baseline_tested"], fit["baseline_hidden"]))
    assert not told(result)
    assert abs(off) > 6
    assert hidden["baseline = 'quadratic'"] == pytest.approx(abs(off), rel=0.3)
    given = run(study_fits.deck_of(true, str(tmp_path / "a.csv"), start, {"baseline": "quadratic"}))
    wide = given.fitted["fit"]
    assert abs(wide["estimate"][1] - true.stiffness) < 3 * wide["standard_error"][1]


def test_a_baseline_without_slopes_has_none_on_each_way(tmp_path):
    curve = hertz_curve()
    with pytest.raises(snapin.DeckError, match="slope_each_way.* has no slope"):
        fit_of_gel(tmp_path, curve, baseline="constant", slope_each_way=True)
    tilted = (curve[0], curve[1] + 1e-6 * curve[0], curve[2])
    assert any("baseline = 'linear'" in text
               for text in told(fit_of_gel(tmp_path, tilted, baseline="constant")))


@pytest.mark.slow
def test_no_part_of_a_baseline_is_named_without_reason(branches, tmp_path):
    for seed in range(4):
        result = fitted(tmp_path, branches.measure(600, 1e-10, seed=seed), LENNARD_JONES,
                        [STRENGTH, STIFFNESS, POINT])
        assert not any("the baseline" in text for text in told(result)), told(result)


@pytest.mark.slow
@pytest.mark.parametrize("factor", [pytest.param(2.0, marks=pytest.mark.long), 10.0])
def test_a_wrong_spring_constant_is_named(branches, tmp_path, factor):
    """The slope in contact cannot be that of a spring ten times as stiff."""
    result = fitted(tmp_path, branches.measure(200, 2e-11, seed=1), LENNARD_JONES,
                    [STRENGTH, STIFFNESS, POINT], measurement={"spring_constant": factor * SPRING})
    named = [text for text in told(result) if "with spring_constant = " in text]
    assert named, told(result)
    found = float(re.search(r"spring_constant = (\S+)", named[0])[1])
    assert found == pytest.approx(SPRING, rel=0.1)


@pytest.mark.parametrize("factor, asked", [(1.02, "smaller"), (0.98, "larger")])
def test_a_number_that_the_data_contradict_is_named(branches, tmp_path, factor, asked):
    """The score test of the numbers that a fit holds finds a spring constant that is 2 % off."""
    result = fitted(tmp_path, branches.measure(200, 5e-11, seed=1), LENNARD_JONES,
                    [STRENGTH, STIFFNESS, POINT], measurement={"spring_constant": factor * SPRING})
    assert any(f"the data ask for a {asked} measurement.spring_constant than the deck has" in text
               for text in told(result)), told(result)


@pytest.mark.slow
def test_the_retract_is_proposed_where_it_alone_is_described(branches, tmp_path):
    """Hysteresis of a sample: the approach needs a larger force at the same depth."""
    z, force, segment = branches.measure(400, 2e-11, seed=1)
    softer = np.where((segment == 0) & (force > 0), 0.8 * force, force)
    result = fitted(tmp_path, (z, softer, segment), LENNARD_JONES, [STRENGTH, STIFFNESS, POINT])
    assert any("fit segment = 'retract'" in text for text in told(result)), told(result)
    assert not any("larger measurement" in text for text in told(result))


def test_rigid_bodies_are_offered_a_stiffness_that_is_as_good(tmp_path):
    curve = write(tmp_path / "a.csv", [0.0], [0.0], [0])
    rigid = {**LENNARD_JONES, "bodies": {"radius": 50e-9, "rigid": True}}
    with pytest.raises(snapin.DeckError, match="stiffness = .* as good as rigid") as refused:
        snapin.run(fit_deck(rigid, curve, [STRENGTH, POINT]))
    stiffness = float(re.search(r"stiffness = (\S+)", str(refused.value))[1])
    range_of = {"loading": {"h0_start": 3e-9, "h0_end": 2.4e-10, "h0_step": 2e-12}}
    pull_off = [snapin.run({**LENNARD_JONES, "bodies": bodies, **range_of}).summary["max_tension"]
                for bodies in (rigid["bodies"], {"radius": 50e-9, "stiffness": stiffness})]
    assert pull_off[1] == pytest.approx(pull_off[0], rel=0.01)


def test_numbers_have_units_and_the_sample_its_modulus(snapin, tmp_path):  # noqa: F811
    """Young's modulus of the fitted body, and the reduced modulus with the other one."""
    import f90nml
    from support.scenes import deck
    write(tmp_path / "a.csv", *hertz_curve())
    nu = 0.3
    groups = changed(REPULSION, {})
    groups["bodies"] = {"radius": RADIUS, "young": [500.0, 1e11], "poisson": [nu, 0.2]}
    text = deck(**fit_deck(groups, "a.csv", ["bodies.young(1)", POINT],
                           measurement={"spring_constant": SPRING_OF_GELS}))
    (tmp_path / "d.nml").write_text(text)
    result = snapin("--out", tmp_path, "d.nml", cwd=tmp_path)
    fit = f90nml.read(tmp_path / "d" / "fit.nml")["fit"]
    # The same E* as of two identical bodies with the stiffness SOFT.
    assert fit["reduced_modulus"] == pytest.approx(SOFT / 2, rel=0.01)
    assert fit["young_of_sample"] == pytest.approx(SOFT / 2 * (1 - nu**2), rel=0.01)
    assert fit["young_of_sample_poisson"] == nu
    assert fit["reduced_modulus_error"] == pytest.approx(
        fit["reduced_modulus"] * fit["standard_error"][0] / fit["estimate"][0], rel=0.01)
    assert fit["units"] == ["Pa", "m"]
    assert re.search(r"reduced modulus (39|40)\d(\.\d+)? \+- \S+ Pa", result.stderr), result.stderr
    assert re.search(r"Young's modulus of the sample 36\d(\.\d+)? \+- \S+ Pa \(nu = 0.3",
                     result.stderr)
    assert re.search(r"contact_point = \S+ \+- \S+ [pnu]m", result.stderr)


def test_a_force_with_a_spring_that_is_fitted_is_the_force(branches, tmp_path):
    """The page said that the sensitivity of a signal that is the force is 1/k; once it was that of
    the deck's k, and the fit tens of standard errors off. With a sensitivity the signal is a
    deflection, and a force that was computed with a wrong k is proportional to it."""
    z, force, segment = branches.measure(400, 2e-11, seed=4)
    keys = [STRENGTH, STIFFNESS, POINT, "measurement.spring_constant"]
    wrong = 1.1 * SPRING
    given = {"prior": [0.0, 0.0, 0.0, 0.15 * SPRING]}
    for signal, more in ((force, {}), (wrong / SPRING * force, {"sensitivity": 1 / wrong})):
        result = fitted(tmp_path, (z, signal, segment), LENNARD_JONES, keys, given,
                        measurement={"spring_constant": wrong, **more})
        for (value, error), truth in zip(estimates(result).values(), (1e-19, 1e10, 0.0, SPRING)):
            assert abs(value - truth) < 4 * error, (more, value, truth, error)
        # Only a force shows the spring.
        narrow = estimates(result)["measurement.spring_constant"][1] < 0.05 * SPRING
        assert narrow == (not more)
