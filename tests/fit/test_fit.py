"""Claims about fits of measured curves: what data without noise give back, what errors mean."""

import math
import re

import numpy as np
import pytest
from support.measured import (  # noqa: F401 (`branches` is a fixture)
    BODIES, CONTACT_POINT, LENNARD_JONES, POINT, SPRING, STIFFNESS, STRENGTH, Branches, branches,
    fit_deck, fitted, run, states_of_device, write)
from support.scenes import changed

# A noise that data without any are said to have, so that the sum of squares has a scale.
FINE = {"noise": 1e-13}
BASELINE, SLOPE = 2e-10, 1e-3

SCENES = {
    "lennard_jones": (LENNARD_JONES, {STRENGTH: 1.0e-19, STIFFNESS: 1e10}),
    "stronger": (
        {"bodies": {"radius": 50e-9, "stiffness": 2e9}, "force": LENNARD_JONES["force"]},
        {"force.z0": 3e-10, STRENGTH: 1.0e-19}),
    "morse": (
        {"bodies": BODIES, "morse": {"surface_energy": 0.03, "z0": 3e-10, "decay_length": 2e-10}},
        {"morse.surface_energy": 0.03, "morse.decay_length": 2e-10, STIFFNESS: 1e10}),
    "sum": (
        {"bodies": BODIES, "van_der_waals": {"hamaker": 1e-19}, "born": {"z0": 3e-10},
         "hydration": {"energy": 2e-3, "decay_length": 3e-10}},
        {"van_der_waals.hamaker": 1e-19, STIFFNESS: 1e10}),
    "double layer": (
        {"bodies": BODIES, "van_der_waals": {"hamaker": 1e-19}, "born": {"z0": 3e-10},
         "double_layer": {"potential": 0.05, "regulation": 0.4, "debye_length": 2e-9}},
        {"double_layer.potential": 0.05, "double_layer.debye_length": 2e-9}),
    "power": (
        {"bodies": {"stiffness": 1e10},
         "shape": {"kind": "power", "exponent": 3.0, "radius": 50e-9},
         "force": LENNARD_JONES["force"]},
        {STRENGTH: 1.0e-19, "shape.radius": 50e-9},
    ),
    "film on something rigid": (
        {"bodies": {"radius": 50e-9, "rigid": True},
         "layer": {"thickness": 6e-9, "young": 1e10, "poisson": 0.45, "partner": "rigid"},
         "force": LENNARD_JONES["force"]},
        {"layer.thickness": 6e-9, "layer.young": 1e10},
    ),
    "hard skin": (
        {"bodies": {"radius": 50e-9, "young": 5e9, "poisson": 0.5},
         "layer": {"thickness": [3e-9, 4e-9], "young": [4e10, 1e10], "poisson": [0.2, 0.3]},
         "force": LENNARD_JONES["force"]},
        {"layer.thickness(1)": 3e-9, "bodies.young": 5e9},
    ),
}


def values_of(result, group="fit"):
    found = result.fitted[group]
    return dict(zip(found["parameters"], found["estimate"]))


def errors_of(result):
    found = result.fitted["fit"]
    return dict(zip(found["parameters"], found["standard_error"]))


@pytest.fixture(scope="module")
def exact(tmp_path_factory):
    """exact(name) -> file of the states of a scene, with a baseline."""
    folder, files = tmp_path_factory.mktemp("exact"), {}

    def file_of(name):
        if name not in files:
            z, load, segment = states_of_device(SCENES[name][0])
            files[name] = write(folder / f"{name}.csv", z + CONTACT_POINT,
                                load + BASELINE + SLOPE * z, segment)
        return files[name]

    return file_of


@pytest.mark.parametrize("name", SCENES)
def test_data_without_noise_give_the_values_back(exact, name):
    groups, truth = SCENES[name]
    start = changed(groups, {key: 1.07 * value for key, value in truth.items()})
    result = run(fit_deck(start, exact(name), [*truth, POINT], FINE))
    found = values_of(result)
    assert result.converged
    # The jumps are known to the distance of samples only, and pull by half of that.
    for key, value in truth.items():
        assert found[key] == pytest.approx(value, rel=2e-6)
    # To a thousandth of a picometre.
    assert found[POINT] == pytest.approx(CONTACT_POINT, abs=1e-15)
    # Within a jump nothing counts; elsewhere the model is the data, to a fifth of the said noise.
    used = result.fit["used"] == 1
    assert np.abs(result.fit["residual"][used]).max() < 2e-14
    # The last sample before each of two jumps, and what lies within.
    assert (~used).sum() <= 6


@pytest.mark.slow
def test_errors_are_those_of_the_profile_of_the_sum_of_squares(branches, tmp_path):
    """With one value held a little off, the others found again, chi squared is the square of how
    many standard errors it is off: the Jacobian and what is made of it are right together."""
    truth = SCENES["lennard_jones"][1]
    curve, quiet = branches.measure(300), {"noise": 1e-11}
    accurate = {"numerics": {"accuracy": 1e-8}}
    free = fitted(tmp_path, curve, LENNARD_JONES, [*truth, POINT], quiet, **accurate)
    for key in truth:
        others = [name for name in (*truth, POINT) if name != key]
        gained = []
        # On either side: the model is not linear, which shows in the difference of the two.
        for off in (-0.5, 0.5):
            value = values_of(free)[key] + off * errors_of(free)[key]
            held = fitted(tmp_path, curve, changed(LENNARD_JONES, {key: value}), others, quiet,
                          **accurate).fitted["fit"]
            gained.append(held["chi_squared"][0] - free.fitted["fit"]["chi_squared"][0])
        assert np.mean(gained) == pytest.approx(0.25, rel=0.01)


@pytest.mark.slow
def test_errors_and_correlations_are_those_of_differences_between_curves(branches, tmp_path):
    """The Jacobian of the fit against forces and jumps of scenes on either side of the solution,
    interpolated from states at given h0: another way to the same curve."""
    truth = SCENES["lennard_jones"][1]
    noise = 1e-11
    z, force, segment = branches.measure(150)
    spring = "measurement.spring_constant"
    result = fitted(tmp_path, (z, force, segment), LENNARD_JONES, [*truth, POINT, spring],
                    {"noise": noise}, numerics={"accuracy": 1e-8})
    inward, used = segment == 0, result.fit["used"] == 1

    def model(groups, curve, shift=0.0, stiffness=None):
        """Samples and jumps over their errors; shift: of the contact point."""
        force = np.where(inward, curve.force(z - shift, True), curve.force(z - shift, False))
        summary = run({**groups, "equilibrium_path": {"h0_end": -2e-9},
                       "device": {"stiffness": stiffness or held},
                       "numerics": {"accuracy": 1e-9}}).summary
        jumps = [(summary[f"device_jump_{way}_z"] + shift) /
                 result.fitted["fit"][f"jump_{way}_z_uncertainty"] for way in ("in", "out")]
        return np.concatenate([force[used] / noise, *jumps])

    # A measured jump lies between samples, and so the solution is a little off the truth.
    found = values_of(result)
    solution = changed(LENNARD_JONES, {key: found[key] for key in truth})
    z, held = z - found[POINT], found[spring]
    columns = []
    for key in truth:
        value = found[key]
        off = 1e-3 * value
        near, far = (changed(solution, {key: value + side}) for side in (-off, off))
        columns.append((model(far, Branches(far, held)) - model(near, Branches(near, held)))
                       / (2 * off))
    off = 1e-12
    curve = Branches(solution, held)
    columns.append((model(solution, curve, off) - model(solution, curve, -off)) / (2 * off))
    off = 1e-3 * held
    stiffer, softer = (model(solution, Branches(solution, stiffness), stiffness=stiffness)
                       for stiffness in (held + off, held - off))
    columns.append((stiffer - softer) / (2 * off))
    for baseline in (np.ones_like(z), z):
        columns.append(np.append(baseline[used] / noise, [0, 0]))
    jacobian = np.array(columns).T
    scale = np.abs(jacobian).max(axis=0)
    covariance = np.linalg.inv(jacobian.T / scale[:, None] @ jacobian / scale)
    error = np.sqrt(np.diag(covariance))
    expected = dict(zip([*truth, POINT, spring], (error / scale)[:4]))
    # What the interpolation leaves of differences a thousandth wide; spring and modulus nearly have
    # the same effect, and a part of it three times as large.
    assert errors_of(result) == pytest.approx(expected, rel=1e-2)
    del expected[STIFFNESS], expected[spring]
    assert {key: errors_of(result)[key] for key in expected} == pytest.approx(expected, rel=2e-3)
    correlation = (covariance / np.outer(error, error))[:4, :4]
    assert np.reshape(result.fitted["fit"]["correlation"], (4, 4)) == pytest.approx(
        correlation, abs=5e-3)


def rows(between, point, *columns):
    """Text of a table, other than `write` makes it."""
    return "".join(between.join((f"{a:.12e}", f"{b:.12e}", str(c))).replace(".", point) + "\n"
                   for a, b, c in zip(*columns))


@pytest.mark.slow
def test_conventions_do_not_matter(branches, tmp_path):
    """z that grows or falls, force of either sign, volts, columns by number, other units, tables
    as numpy writes them and with commas in numbers: the same."""
    z, force, segment = branches.measure(300, noise=2e-12)
    plain = write(tmp_path / "a.csv", z, force, segment)
    keys = [STRENGTH, STIFFNESS, POINT]
    first = run(fit_deck(LENNARD_JONES, plain, keys))

    def table(name, text):
        (tmp_path / name).write_text(text)
        return str(tmp_path / name)

    others = {
        "grows in volts": (write(tmp_path / "b.csv", -z, force / (SPRING * 5e-8), segment),
                           {"sensitivity": 5e-8}),
        "minus": (write(tmp_path / "c.csv", z, -force, segment),
                  {"columns": ["z", "-force", "segment"]}),
        "numbers, no segments": (write(tmp_path / "e.csv", z, force), {"columns": ["1", "2"]}),
        "units": (write(tmp_path / "f.csv", z * 1e9, force * 1e9, segment),
                  {"units": ["nm", "nN"]}),
        "deflection": (write(tmp_path / "d.csv", z * 1e9, force * 1e9 / SPRING, segment),
                       {"units": ["nm", "nm"], "sensitivity": 1.0}),
        "numpy": (table("g.csv", "# z force segment\n" + rows(" ", ".", z, force, segment)), {}),
        "semicolons": (table("h.csv", "z;force;segment\n" + rows(";", ",", z, force, segment)), {}),
        "empty cells": (table("i.csv", ",z,spare,force,segment\n" + "".join(
            f"0,{row.replace(',', ',,', 1)}\n"
            for row in rows(",", ".", z, force, segment).splitlines())), {}),
    }
    for name, (file, measurement) in others.items():
        found = run(fit_deck(LENNARD_JONES, file, keys, measurement=measurement))
        # The same numbers in the same columns; of others rounding may go another way.
        same = ("units", "deflection", "numpy", "semicolons", "empty cells")
        rel = 1e-6 if name in same else 1e-5
        for key in (STRENGTH, STIFFNESS):
            assert values_of(found)[key] == pytest.approx(values_of(first)[key], rel=rel), name
        sign = -1 if name.startswith("grows") else 1
        # At most a hundredth of its standard error.
        assert values_of(found)[POINT] == pytest.approx(sign * values_of(first)[POINT],
                                                        abs=1e-9 * rel)


@pytest.mark.parametrize("segment", ["approach", "retract"])
def test_one_way_alone_can_be_fitted(branches, tmp_path, segment):
    result = fitted(tmp_path, branches.measure(400, noise=2e-12), LENNARD_JONES, [STRENGTH, POINT],
                    measurement={"segment": segment})
    # In tables the retract is named as the branch of a drive.
    assert set(result.fit["direction"]) == {"retreat" if segment == "retract" else segment}
    assert abs(values_of(result)[STRENGTH] - 1e-19) < 5 * errors_of(result)[STRENGTH]


@pytest.mark.slow
def test_intervals_hold_what_they_say(branches, tmp_path):
    """Of 6 curves the errors are as large as the standard errors say; tools/bench/coverage.py does
    hundreds."""
    off = []
    for seed in range(6):
        result = fitted(tmp_path, branches.measure(150, noise=2e-11, seed=seed), LENNARD_JONES,
                        [STRENGTH, STIFFNESS, POINT], numerics={"accuracy": 1e-5})
        for key, truth in ((STRENGTH, 1e-19), (STIFFNESS, 1e10), (POINT, 0.0)):
            off.append((values_of(result)[key] - truth) / errors_of(result)[key])
    # 18 numbers, in threes correlated: their square has mean 1 and a standard deviation below 0.5.
    assert 0.2 < np.mean(np.square(off)) < 2.2
    assert np.max(np.abs(off)) < 4.5


def test_correlated_noise_is_seen_and_makes_errors_larger(branches, tmp_path):
    z, force, segment = branches.measure(500)
    white = 1e-11 * np.random.default_rng(5).standard_normal(len(z))
    red = np.zeros_like(white)
    for i in range(1, len(z)):
        red[i] = 0.7 * red[i - 1] + math.sqrt(1 - 0.7**2) * white[i]
    results = [fitted(tmp_path, (z, force + noise, segment), LENNARD_JONES, [STRENGTH, POINT])
               for noise in (white, red)]
    fits = [result.fitted["fit"] for result in results]
    assert abs(fits[0]["noise_correlation"][0]) < 0.15
    assert fits[1]["noise_correlation"][0] == pytest.approx(0.7, abs=0.1)
    assert errors_of(results[1])[POINT] > 1.2 * errors_of(results[0])[POINT]
    for fit in fits:
        # The noise is that of some 300 samples; of red noise they are like 60 independent ones.
        assert fit["chi_squared"][0] == pytest.approx(fit["degrees_of_freedom"][0], rel=0.4)


def test_a_prescribed_noise_that_is_too_large_is_said(branches, tmp_path):
    curve = branches.measure(300, noise=2e-11)
    for noise, too_large in ((2e-11, False), (2e-10, True)):
        result = fitted(tmp_path, curve, LENNARD_JONES, [STRENGTH, POINT], {"noise": noise})
        said = [text for text in result.summary.get("warnings", []) if "noise is smaller" in text]
        assert bool(said) == too_large
        if said:
            assert 0.05 < float(re.search(r"is (\S+) times", said[0])[1]) < 0.15


@pytest.mark.slow
def test_sensitivity_and_spring_are_found_with_what_is_known_of_them(exact):
    """Both scale the signal: without a prior they cannot be told apart from the stiffness."""
    deck = fit_deck(LENNARD_JONES, exact("lennard_jones"),
                    [STRENGTH, STIFFNESS, POINT, "measurement.spring_constant"],
                    {**FINE, "prior": [0.0, 0.0, 0.0, 0.01]},
                    numerics={"accuracy": 1e-8})
    deck["measurement"]["spring_constant"] = 1.01 * SPRING
    found = run(deck).fitted["fit"]
    assert found["standard_error"][3] <= 0.01
    sensitivity = fit_deck(LENNARD_JONES, exact("lennard_jones"),
                           [STRENGTH, POINT, "measurement.sensitivity"], FINE,
                           {"sensitivity": 1.1 / SPRING, "units": ["m", "N"]},
                           numerics={"accuracy": 1e-8})
    found = run(sensitivity)
    assert values_of(found)["measurement.sensitivity"] == pytest.approx(1 / SPRING, rel=1e-6)
    # The signal is a force: the unit was m/V.
    assert found.fitted["fit"]["units"][2] == "m/N"


@pytest.mark.slow
def test_what_cannot_be_told_apart_is_said(branches, tmp_path):
    result = fitted(tmp_path, branches.measure(300, noise=2e-11), LENNARD_JONES,
                    [STRENGTH, "force.z0", "bodies.radius", STIFFNESS, POINT])
    assert any("cannot be told" in text for text in result.summary["warnings"])
    assert result.fitted["fit"]["identifiable"][0] < 0.05


def test_a_number_that_the_data_do_not_determine_is_named_without_a_factor(tmp_path):
    """Bodies too stiff to deform: the curve shows the product of strength and radius alone."""
    stiff = changed(LENNARD_JONES, {STIFFNESS: 1e13})
    curve = Branches(stiff, h0_end=2e-10).measure(300, noise=1e-10)
    keys = [STRENGTH, STIFFNESS, "bodies.radius"]
    result = fitted(tmp_path, curve, stiff, [*keys, POINT])
    told = result.summary["warnings"]
    for key in keys:
        assert f"fit: the data do not determine {key}; fix it, or give a prior" in told
    assert not any("by a factor of" in text for text in told), told


def test_a_bound_that_decides_is_said(branches, tmp_path):
    result = fitted(tmp_path, branches.measure(300, noise=2e-11),
                    changed(LENNARD_JONES, {STIFFNESS: 5e9}), [STIFFNESS, POINT],
                    {"lower": [1e9, -1e-8], "upper": [9e9, 1e-8]})
    assert values_of(result)[STIFFNESS] == pytest.approx(9e9, rel=1e-3)
    assert any("touches upper" in text for text in result.summary["warnings"])


def jkr_curve(work, stiffness, radius, spring, n):
    """Way out of a JKR contact behind a spring, evenly in the contact radius."""
    turn = (2.25 * math.pi * work * radius**2 / stiffness) ** (1 / 3)
    a = np.linspace(2.0, 0.3, 4000) * turn
    load = 2 * stiffness * a**3 / (3 * radius) - np.sqrt(4 * math.pi * work * stiffness * a) * a
    h0 = -(a**2 / radius - np.sqrt(4 * math.pi * work * a / stiffness))
    z = h0 - load / spring
    last = np.argmax(z)
    return z[:last][:: last // n], load[:last][:: last // n]


@pytest.mark.slow
def test_jkr_data_give_the_values_of_jkr_back_and_the_path_agrees(tmp_path):
    """The path of a short range of force is JKR's, but for the part 1/sigma or so."""
    work, stiffness, radius = 0.05, 1e8, 100e-9
    z, load = jkr_curve(work, stiffness, radius, SPRING, 150)
    far = np.linspace(z[-1] + 1e-9, z[-1] + 60e-9, 100)
    groups = {
        "bodies": {"radius": radius, "stiffness": 1.2e8},
        "force": {"law": "lennard_jones", "surface_energy": 0.06, "z0": 2e-10}}
    result = fitted(tmp_path, (np.append(z, far), np.append(load, 0 * far)), groups,
                    ["force.surface_energy", STIFFNESS, POINT], {"noise": 1e-12},
                    measurement={"columns": ["z", "force"], "segment": "retreat"})
    jkr = values_of(result, "jkr")
    assert jkr["work_of_adhesion"] == pytest.approx(work, rel=1e-6)
    assert jkr["stiffness"] == pytest.approx(stiffness, rel=1e-6)
    found = values_of(result)
    assert found["force.surface_energy"] == pytest.approx(work, rel=0.02)
    assert found[STIFFNESS] == pytest.approx(stiffness, rel=0.02)
    left = {name: group["chi_squared"][0] for name, group in result.fitted.items()}
    assert left["jkr"] < left["fit"] < left["dmt"]


def test_rows_that_repeat_tell_nothing_new(branches, tmp_path):
    """Each row written several times once gave smaller errors."""
    z, force, segment = branches.measure(300, noise=6e-11, seed=2)
    keys = [STRENGTH, STIFFNESS, POINT]
    fits = [run(fit_deck(LENNARD_JONES, write(tmp_path / f"{n}.csv", *(
        np.repeat(column, n) for column in (z, force, segment))), keys)).fitted["fit"]
        for n in (1, 5)]
    assert fits[1]["standard_error"] == pytest.approx(fits[0]["standard_error"], rel=1e-6)
