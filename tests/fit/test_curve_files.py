"""How the file of a measured curve is read: the spellings of one curve, its segments, units and
gaps. What was understood is told in one line by --check."""

import re

import numpy as np
import pytest
from support.measured import (  # noqa: F401 (`branches` is a fixture)
    LENNARD_JONES, POINT, STRENGTH, branches, fit_deck, run)
from support.scenes import deck

ROWS = 40


@pytest.fixture(scope="module")
def curve(branches):  # noqa: F811
    """A curve of 40 rows on each way: base [m], force [N], segment."""
    return branches.measure(ROWS, noise=1e-11, seed=3)


def lines(curve, row, *before):
    """The text of a file: some lines, then one for each sample."""
    return "\n".join([*before, *(row.format(z, f, s) for z, f, s in zip(*curve))]) + "\n"


def scaled(curve, z=1e9, force=1e9):
    return curve[0] * z, curve[1] * force, curve[2]


def side_by_side(curve, turned=False, short=0):
    z, force, _ = curve
    back = slice(None, None, -1) if turned else slice(None)
    pairs = zip(z[:ROWS], force[:ROWS], z[ROWS:][back], force[ROWS:][back])
    rows = [f"{a:.16e},{b:.16e},{c:.16e},{d:.16e}" for a, b, c, d in pairs]
    rows = [row if i < ROWS - short else ",".join(row.split(",")[:2]) + ",," for i, row in
            enumerate(rows)]
    return "\n".join(["Extend Z,Extend F,Retract Z,Retract F", *rows]) + "\n"


PLAIN = "{:.16e},{:.16e},{}"
NAMED = ["z", "force", "segment"]
WAYS = "40 samples of the approach, 40 samples of the retract"
# The file's text, the columns and other keys of &measurement, and what is told.
SPELLINGS = {
    "plain": (lambda c: lines(c, PLAIN, "z,force,segment"), NAMED, {}, "position 'z' in m"),
    "preamble": (
        lambda c: lines(c, PLAIN, "Force-Distance Curve", "Mode:\tSingle", "k: 0.03", "",
                        "X, um:\t0.0", "512 200", "z,force,segment"), NAMED, {}, WAYS),
    "lines skipped": (
        lambda c: lines(c, PLAIN, "1.0,2.0,0", "2.0,3.0,0", "3.0,3.0,0", "z,force,segment"),
        NAMED, {"skip_lines": 3}, WAYS),
    "names with blanks and brackets": (
        lambda c: lines(c, PLAIN, "height (measured) [m],Force (N),segment"),
        ["height (measured) [m]", "Force (N)", "segment"], {},
        re.escape("position 'height (measured) [m]' in m, signal 'Force (N)' in N")),
    "names without their units": (
        lambda c: lines(c, PLAIN, "height (measured) [m],Force (N),segment"),
        ["height (measured)", "force", "segment"], {}, WAYS),
    "names in quotes": (
        lambda c: lines(c, PLAIN, '"z","Force, filtered (N)","segment"'),
        ["z", "Force, filtered (N)", "segment"], {}, WAYS),
    "blanks between cells, units beside names": (
        lambda c: lines(c, "{:.16e} {:.16e} {}", "z [m] force [N] segment"), NAMED, {}, WAYS),
    "units in names": (
        lambda c: lines(scaled(c), PLAIN, "z (nm),Force (nN),segment"),
        ["z", "Force", "segment"], {}, "in 1e-9 m, signal 'Force .nN.' in 1e-9 N"),
    "a row of units": (
        lambda c: lines(scaled(c, z=1e6), PLAIN, "z,force,segment", "(um),(nN),"), NAMED, {},
        "in 1e-6 m, signal 'force' in 1e-9 N"),
    "a row of bare units": (
        lambda c: lines(scaled(c, z=1e6), PLAIN, "z,force,segment", "um,nN,"), NAMED, {},
        "in 1e-6 m"),
    "a row of units with other quantities": (
        lambda c: lines(scaled(c, z=1e6), "0.1,{:.16e},{:.16e},{}", "t,z,force,segment",
                        "s,[um],nN,-"), NAMED, {}, "in 1e-6 m, signal 'force' in 1e-9 N"),
    "units behind a stroke": (
        lambda c: lines(scaled(c, z=1e6), PLAIN, "z / µm,Force / nN,segment"), NAMED, {},
        "in 1e-6 m, signal 'Force / nN' in 1e-9 N"),
    "a line before names that have units": (
        lambda c: lines(scaled(c)[:2] + ([0] * 2 * ROWS,), "{:.16e},{:.16e}", "k,soft",
                        "z (nm),force (nN)"), NAMED[:2], {}, "in 1e-9 m"),
    "Angstrom": (
        lambda c: lines(scaled(c, z=1e10), PLAIN, "z (Å),force (nN),segment"), NAMED, {},
        "in 1e-10 m"),
    "single quotes": (
        lambda c: lines(c, PLAIN, "'z','force','segment'"), NAMED, {}, "position 'z' in m"),
    "signs of typesetters": (
        lambda c: lines(scaled(c), PLAIN, "z\u00a0(nm),force (nN),segment").replace(
            "-", "\u2212"), ["z (nm)", *NAMED[1:]], {}, "in 1e-9 m"),
    "errors of a spreadsheet": (
        lambda c: lines(c, PLAIN, "z,force,segment", "1.0,#N/A,0", "#DIV/0!,1.0,0"), NAMED, {},
        WAYS + "; left out: 2 rows with an empty cell or NaN"),
    "micro sign": (
        lambda c: lines(scaled(c, z=1e6), PLAIN, "z (µm),force,segment"), ["z (um)", *NAMED[1:]],
        {}, "in 1e-6 m"),
    "units of the deck before those of the file": (
        lambda c: lines(scaled(c), PLAIN, "z (um),Force (uN),segment"),
        ["z", "Force", "segment"], {"units": ["nm", "nN"]}, "in 1e-9 m"),
    "words as segments": (
        lambda c: lines(c, PLAIN, "z,force,segment").replace(",0\n", ",Approach\n").replace(
            ",1\n", ",Retract\n"), NAMED, {}, WAYS),
    "true and false as segments": (
        lambda c: lines(c, PLAIN, "z,force,segment").replace(",0\n", ",False\n").replace(
            ",1\n", ",True\n"), NAMED, {}, WAYS),
    "other numbers as segments": (
        lambda c: lines((c[0], c[1], 2 + 3 * c[2]), PLAIN, "z,force,segment"), NAMED, {}, WAYS),
    "numbers that the deck names": (
        lambda c: lines((c[0], c[1], 7 + c[2]), PLAIN, "z,force,segment"), NAMED,
        {"approach": "7", "retreat": ["8"]}, WAYS),
    "one segment": (
        lambda c: lines((c[0], c[1], 0 * c[2]), PLAIN, "z,force,segment"), NAMED, {},
        "41 samples of the approach, 39 samples of the retract"),
    "decimal commas between blanks": (
        lambda c: lines(c, "{:.16e} {:.16e} {}", "z force segment").replace(".", ","), NAMED, {},
        WAYS),
    "UTF-16": (lambda c: lines(c, PLAIN, "z,force,segment").encode("utf-16"), NAMED, {}, WAYS),
    "UTF-16 without a mark": (
        lambda c: lines(c, PLAIN, "z,force,segment").encode("utf-16-be"), NAMED, {}, WAYS),
    "side by side": (side_by_side, ["Extend Z", "Extend F", "Retract Z", "Retract F"], {}, WAYS),
    "side by side in the order of the position": (
        lambda c: side_by_side(c, turned=True), ["1", "2", "3", "4"], {}, WAYS),
    "missing values": (
        lambda c: lines(c, PLAIN, "z,force,segment", "1.0,,0", "nan,1.0,0", "1.0,--,0"), NAMED, {},
        WAYS + "; left out: 3 rows with an empty cell or NaN"),
}


def write(tmp_path, text):
    (tmp_path / "curve.csv").write_bytes(text if isinstance(text, bytes) else text.encode())
    return str(tmp_path / "curve.csv")


def checked(snapin, tmp_path, text, columns, keys):
    groups = fit_deck(LENNARD_JONES, write(tmp_path, text), [STRENGTH, POINT],
                      measurement={"columns": columns, **keys})
    (tmp_path / "d.nml").write_text(deck(**groups))
    done = snapin("--check", "d.nml", cwd=tmp_path)
    return done.returncode, done.stderr


@pytest.mark.parametrize("case", SPELLINGS)
def test_every_spelling_of_a_curve_is_read(snapin, tmp_path, curve, case):
    spell, columns, keys, told = SPELLINGS[case]
    status, said = checked(snapin, tmp_path, spell(curve), columns, keys)
    assert status == 0, said
    assert re.search(told, said), said
    # The sample at the turn may belong to either way.
    if case not in ("one segment", "a line before names that have units"):
        assert WAYS in said, said


@pytest.mark.parametrize("case", [
    "preamble", "a row of units", "words as segments", "other numbers as segments", "UTF-16",
    "side by side in the order of the position", "decimal commas between blanks"])
def test_every_spelling_has_the_same_samples(tmp_path, curve, case):
    """fit.csv has the samples of the file, in SI units."""
    spell, columns, keys, _ = SPELLINGS[case]
    deck = fit_deck(LENNARD_JONES, write(tmp_path, spell(curve)), [STRENGTH, POINT],
                    measurement={"columns": columns, **keys})
    samples = run(deck).tables["fit"]
    assert len(samples) == 2 * ROWS
    np.testing.assert_allclose(samples["z"], curve[0], rtol=1e-9, atol=1e-20)
    np.testing.assert_allclose(samples["measured"], curve[1], rtol=1e-9, atol=1e-20)


def test_rows_in_which_the_base_rests_are_left_out(snapin, tmp_path, curve):
    """A pause before, between and after the two ways, with segments numbered from 0."""
    z, force, segment = curve

    def rest(at, number):
        return np.full(30, z[at]), force[at] + 1e-12 * np.arange(30), np.full(30, number)

    parts = [rest(0, 0), (z[:ROWS], force[:ROWS], np.full(ROWS, 1)), rest(ROWS - 1, 2),
             (z[ROWS:], force[ROWS:], np.full(ROWS, 3)), rest(-1, 4)]
    text = lines([np.concatenate(x) for x in zip(*parts)], PLAIN, "z,force,segment")
    status, said = checked(snapin, tmp_path, text, NAMED, {})
    assert status == 0, said
    assert WAYS + "; left out: 90 rows of pauses" in said


REFUSED = {
    "a mistake in the first row": (
        lambda c: lines(c, PLAIN, "1.0x,2.0,0"), ["1", "2", "3"], {}, r":1: 1.0x is not a number"),
    "a mistake in the first row of two columns": (
        lambda c: lines(c, "{:.16e},{:.16e}", "1.0x,2.0"), ["1", "2"], {},
        r":1: 1.0x is not a number"),
    "a broken row": (
        lambda c: lines(c, PLAIN, "z,force,segment", "1.0,2.0,0", "1.0,2.0"), NAMED, {},
        ":3: 2 columns where 3 columns are expected"),
    "a word among the numbers": (
        lambda c: lines(c, PLAIN, "z,force,segment", "1.0,two,0"), NAMED, {},
        ":2: two is not a number"),
    "no such column": (
        lambda c: lines(c, PLAIN, "z (m),load (N),segment"), NAMED, {},
        r"no column 'force'; the file has 'z \(m\)', 'load \(N\)', 'segment'"),
    "no such column among many": (
        lambda c: lines(c, PLAIN + 11 * ",0", "z,load,segment," + ",".join("abcdefghijk")), NAMED,
        {}, "no column 'force'; the file has 'z', 'load', 'segment', 'a', .*'i' and 2 more"),
    "volts": (
        lambda c: lines(c, PLAIN, "z (nm),Deflection (V),segment"), ["z", "deflection", "segment"],
        {}, r"'Deflection \(V\)' is no force; sensitivity is the deflection"),
    "a position in newtons": (
        lambda c: lines(c, PLAIN, "z (nN),force (nm),segment"), NAMED, {}, "columns exchanged"),
    "a segment that is not there": (
        lambda c: lines(c, PLAIN, "z,force,segment"), NAMED, {"approach": "Extend"},
        "no row has the segment 'extend'; those of the file are '0', '1'"),
    "several curves": (
        lambda c: lines([np.tile(x, 2) for x in c[:2]] + [np.repeat([0, 1, 2, 3], ROWS)], PLAIN,
                        "z,force,segment"), NAMED, {},
        "goes back and forth in 4 segments, where one approach and one retract"),
    "labels without a column": (
        lambda c: lines(c, PLAIN, "z,force,segment"), NAMED[:2], {"approach": "0"},
        '"approach": needs a column of segments'),
    "too few": (
        lambda c: lines([x[:5] for x in c], PLAIN, "z,force,segment", "1.0,,0"), NAMED, {},
        "20 samples or more; the file has 5 rows, and 1 row with an empty cell or NaN"),
    "no numbers": (lambda c: "z,force\nnothing\n", NAMED[:2], {}, "no row of numbers"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_a_file_that_cannot_be_understood_is_refused_with_the_reason(
        snapin, tmp_path, curve, case):
    spell, columns, keys, told = REFUSED[case]
    status, said = checked(snapin, tmp_path, spell(curve), columns, keys)
    assert status == 2, said
    assert re.search(told, said), said
