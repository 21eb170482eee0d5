"""What is said where a fit cannot work: of the data, their file, the parameters and the deck."""

import numpy as np
import pytest
import snapin
from support.measured import (  # noqa: F401 (`branches` is a fixture)
    LENNARD_JONES, POINT, SPRING, STIFFNESS, STRENGTH, branches, fit_deck, fitted, run, write)
from support.scenes import deck


def flat(rng, z):
    return 1e-11 * rng.standard_normal(len(z))


BAD_DATA = {
    "no contact": (lambda z, f, s, rng: (z, flat(rng, z), s), "no contact in the data"),
    "wrong sign": (lambda z, f, s, rng: (z, -f, s), "repulsion must be positive"),
    "too few": (lambda z, f, s, rng: (z[:10], f[:10], s[:10]), "needs 20 samples or more"),
    "same way": (lambda z, f, s, rng: (np.append(z[:300], z[:300]), np.append(f[:300], f[:300]), s),
                 "z goes the same way"),
    "exchanged columns": (lambda z, f, s, rng: (f, z, s), "columns exchanged"),
    "exchanged segments": (lambda z, f, s, rng: (z, f, 1 - s),
                           "approach and retract are exchanged"),
    "reversed rows": (lambda z, f, s, rng: (z[::-1], f[::-1], s), "in reverse order"),
    "reversed rows, right segments": (lambda z, f, s, rng: (z[::-1], f[::-1], s[::-1]),
                                      "in reverse order"),
    "reversed rows, tilted": (
        lambda z, f, s, rng: (z[::-1], (f + 0.5 * z)[::-1], s[::-1]), "in reverse order"),
    "reversed retract": (lambda z, f, s, rng: (z[:299:-1], f[:299:-1], s[300:]),
                         "in reverse order"),
    "noisy columns": (lambda z, f, s, rng: (f, z + 1e-9 * rng.standard_normal(len(z)), s),
                      "columns exchanged"),
    "nanometres": (lambda z, f, s, rng: (1e9 * z, 1e9 * f, s), "give units"),
    "two curves": (lambda z, f, s, rng: (np.tile(z, 2), np.tile(f, 2), np.tile(s, 2)),
                   "back and forth within the approach"),
    "shuffled": (lambda z, f, s, rng: [x[np.random.default_rng(1).permutation(len(z))]
                                       for x in (z, f, s)], "back and forth"),
    "separations": (lambda z, f, s, rng: (z + f / SPRING, f, s), "a separation and not that of"),
    "all in contact": (lambda z, f, s, rng: (z[z < 1e-9], (f + 5 * flat(rng, z))[z < 1e-9],
                                             s[z < 1e-9]),
                       "no baseline in the data.*from a straight line by no more than the noise"),
    "picometres": (lambda z, f, s, rng: (1e-9 * z, f, s), "less than a picometre"),
    "heights": (lambda z, f, s, rng: (z, f, 1e6 * z), "more than 64 different values"),
}


@pytest.mark.parametrize("case", BAD_DATA)
def test_data_that_cannot_be_fitted_are_refused_with_the_reason(branches, tmp_path, case):
    change, message = BAD_DATA[case]
    curve = change(*branches.measure(300, noise=1e-11), np.random.default_rng(1))
    with pytest.raises(snapin.SnapinError, match=message):
        fitted(tmp_path, curve, LENNARD_JONES, [STRENGTH, POINT])


def test_a_steep_attraction_before_contact_can_be_fitted_without_its_end(branches, tmp_path):
    """It is like the contact of a signal with the opposite sign, whose fit would find nothing."""
    z, force, segment = branches.measure(3000, noise=1e-12, seed=2)
    near = branches.outer[0][0] + 2e-11
    apart = (segment == 0) & (z > near) & (z < near + 5e-9)
    curve = z[apart], force[apart], segment[apart]
    with pytest.raises(snapin.SnapinError, match="skip the nearest twentieth of the travel"):
        fitted(tmp_path, curve, LENNARD_JONES, [STRENGTH, POINT])
    twentieth = [near - 1e-9, near + 0.051 * 5e-9]
    fit = fitted(tmp_path, curve, LENNARD_JONES, [STRENGTH, POINT],
                 measurement={"skip": twentieth}).fitted["fit"]
    assert np.abs((fit["estimate"] - [1e-19, 0.0]) / fit["standard_error"]).max() < 4


@pytest.mark.parametrize("stiffness", [1e3, 1e4, 1e5])
def test_what_the_data_show_is_said_where_they_have_no_contact(tmp_path, stiffness):
    """A baseline that bends, far beyond the noise, and no contact. The message once said only that
    no path came close, and called a tenth of the deck's stiffness one that the data suggest."""
    z = np.linspace(3e-6, 5e-7, 400)
    force = -9e-11 * np.tanh((z - 1.75e-6) / 7e-7)
    noise = 1e-12 * np.random.default_rng(1).standard_normal(400)
    groups = {"bodies": {"radius": 5e-6, "stiffness": stiffness},
              "force": {"law": "exponential", "p0": 1e6, "decay_length": 1e-10}}
    with pytest.raises(snapin.SnapinError) as refused:
        fitted(tmp_path, (z, force + noise, np.zeros(400, int)), groups, [STIFFNESS, POINT],
               measurement={"spring_constant": 0.05})
    said = " ".join(str(refused.value).split())
    assert "no contact like that of the model in the data" in said
    assert "% of spring_constant" in said
    assert f"stiffness = {stiffness / 10:g}" not in said


VOLT = 1 / (SPRING * 5e-8)
# Unit of the signal over newtons, keys of &measurement, and what is said.
BAD_SIGNALS = {
    "volts": (VOLT, {}, "where the spring permits .* sensitivity if it is in volts"),
    "millivolts": (1e3 * VOLT, {"sensitivity": 5e-8}, "where the spring permits"),
    "nanonewtons": (1e9, {}, "where the spring permits .* check the unit of the signal"),
    "soft spring": (1.0, {"spring_constant": SPRING / 10}, "permits .* and spring_constant"),
    "piconewtons": (1e9, {"units": ["m", "pN"]},
                    "largest tension of the data is 6.[0-9]*e-12 N, .* deck 6.[0-9]*e-9 N"),
}


@pytest.mark.slow
@pytest.mark.parametrize("case", BAD_SIGNALS)
def test_a_signal_in_a_wrong_unit_is_refused_with_both_loads(branches, tmp_path, case):
    unit, keys, message = BAD_SIGNALS[case]
    z, force, segment = branches.measure(300, noise=1e-11)
    with pytest.raises(snapin.SnapinError, match=message):
        fitted(tmp_path, (z, unit * force, segment), LENNARD_JONES, [STRENGTH, STIFFNESS, POINT],
               measurement=keys)


BAD_FILES = {
    "no such column": ("z,load,segment\n1,2,0\n", "no column 'force'"),
    "cells": ("z,force,segment\n1,2,0\n1,2\n", "2 columns where 3 columns are expected"),
    "names of several words": ("base height,force,segment\n1 2 0\n1 2 0\n",
                               "no column 'z'; the file has 'base height', 'force', 'segment'"),
    "names that cannot be divided": ("z of base, force\n1 2 0\n1 2 0\n",
                                     "4 columns where 3 .*; number the columns if the line of"),
    "words": ("z,force,segment\n1,two,0\n", "two is not a number"),
    "nan": ("z,force,segment\n1,nan,0\n", "0 rows, and 1 row with an empty cell or NaN"),
    "empty cell": ("z,force,segment\n1,,0\n", "0 rows, and 1 row with an empty cell or NaN"),
    "empty last cell": ("z,force,segment\n1,2,0\n1,2,\n", "has 1 row, and 1 row with an empty"),
    "missing last cell": ("z force segment\n1 2 0\n1 2\n",
                          "2 columns where 3 columns are expected"),
    "two columns of a name": ("z,force,segment,force\n1,2,0,3\n", "more than one column 'force'"),
}


@pytest.mark.parametrize("case", BAD_FILES)
def test_files_that_cannot_be_read_are_refused_with_the_line(tmp_path, case):
    text, message = BAD_FILES[case]
    file = tmp_path / "a.csv"
    file.write_text(text)
    with pytest.raises(snapin.SnapinError, match=message):
        run(fit_deck(LENNARD_JONES, str(file), [STRENGTH, POINT]))


def test_a_file_that_cannot_be_read_does_not_pass_the_check(snapin, tmp_path):
    """`--check` reads the curve too; once a column that does not exist passed."""
    (tmp_path / "a.csv").write_text("z,load\n1,2\n")
    text = deck(**fit_deck(LENNARD_JONES, "a.csv", [STRENGTH, POINT]))
    (tmp_path / "d.nml").write_text(text)
    result = snapin("--check", "d.nml", cwd=tmp_path)
    assert result.returncode == 2
    assert "no column 'force'" in result.stderr


def test_a_parameter_without_effect_is_named(branches, tmp_path):
    """A repulsion that is nothing beside the force's own."""
    groups = {**LENNARD_JONES, "hydration": {"energy": 1e-12, "decay_length": 2e-10}}
    with pytest.raises(snapin.SnapinError, match="hydration.energy has no effect"):
        fitted(tmp_path, branches.measure(300, noise=1e-11), groups, ["hydration.energy", POINT],
               {"lower": [1e-13, -1e-8], "upper": [1e-11, 1e-8]})


BAD_DECKS = {
    "no file": ({"measurement": {"file": "nowhere.csv", "spring_constant": 1.0}}, "no such file"),
    "no measurement": ({"measurement": None}, "needs &measurement"),
    "no fit": ({"fit": None}, "needs &fit"),
    "name": ({"fit": {"parameters": ["force.strength", POINT]}}, "force.strength"),
    "numerics": ({"fit": {"parameters": ["numerics.accuracy", POINT]}}, "numerics.accuracy"),
    "twice": ({"fit": {"parameters": [STRENGTH, STRENGTH, POINT]}}, "is there twice"),
    "no contact point": ({"fit": {"parameters": [STRENGTH]}}, "the contact point is unknown"),
    "no volts": ({"fit": {"parameters": [POINT, "measurement.sensitivity"]}},
                 "the signal is a force"),
    "not to be fitted": ({"fit": {"parameters": [POINT, "measurement.file"]}}, "cannot be fitted"),
    "bounds": ({"fit": {"parameters": [STRENGTH, POINT], "lower": [1e-21]}}, "one value for each"),
    "below": ({"fit": {"parameters": [STRENGTH, POINT], "lower": [1e-18, -1.0]}}, "below this"),
    "above": ({"fit": {"parameters": [STRENGTH, POINT], "upper": [1e-20, 1.0]}}, "above this"),
    "rigid": ({"bodies": {"radius": 1.0, "rigid": True}}, "needs elastic bodies"),
}


@pytest.mark.parametrize("case", BAD_DECKS)
def test_a_wrong_deck_is_refused(case, tmp_path):
    change, message = BAD_DECKS[case]
    file = write(tmp_path / "a.csv", [0.0], [0.0], [0])
    deck = fit_deck(LENNARD_JONES, file, [STRENGTH, POINT])
    with pytest.raises(snapin.DeckError, match=message.replace("&", ".")):
        snapin.run({**deck, **change})
