"""The converter of instruments' files: which rows are the approach and the retract, which column is
the position of the base, and what is said where something is missing."""

import re
import subprocess
import sys
import zipfile

import numpy as np
import pytest
from conftest import ROOT
from snapin.convert import ConvertError, segments_of, table_of
from support.processes import HANG

# A base that goes in by 3 um and back, in 31 rows each way; contact at 0; a spring of 0.05 N/m.
IN = np.linspace(2e-6, -1e-6, 31)
BASE = np.r_[IN, IN[::-1]]
SPRING = 0.05
FORCE = SPRING * 0.4 * np.maximum(-BASE, 0)
WAYS = np.repeat([0, 1], 31)


def rows(text):
    """Position, force and segment of a table's text."""
    return np.loadtxt(text.splitlines(), delimiter=",", skiprows=3, unpack=True)


def curve(**columns):
    return {"height (measured)": BASE, "force": FORCE, "segment": WAYS, **columns}


def test_a_table_has_the_rows_of_the_curve():
    text, told = table_of(curve(), "a.jpk-force", SPRING)
    assert text.splitlines()[1:3] == ["# spring_constant = 0.05", "z,force,segment"]
    z, force, segment = rows(text)
    np.testing.assert_allclose(z, BASE, rtol=1e-9, atol=1e-18)
    np.testing.assert_allclose(force, FORCE, rtol=1e-9)
    assert (segment == WAYS).all()
    assert told == "31 rows of the approach, 31 of the retract; position: height (measured)"


def with_pauses(x, at_rest):
    """The curve's values with ten rows of rest before, between and after the ways."""
    return np.r_[at_rest[0] * np.ones(10), x[:31], at_rest[1] * np.ones(10), x[31:],
                 at_rest[2] * np.ones(10)]


@pytest.mark.parametrize("numbers", [(0, 1, 2, 3, 4), (0, 5, 0, 6, 0), (1, 2, 1, 2, 1)])
def test_pauses_are_left_out_whatever_the_numbers_of_segments(numbers):
    """During the second pause the force relaxes and the base creeps."""
    base = with_pauses(BASE, (BASE[0], BASE[30], BASE[-1]))
    base[41:51] -= np.linspace(0, 1e-7, 10)
    segment = np.repeat(numbers, (10, 31, 10, 31, 10))
    text, told = table_of({"height (measured)": base, "segment": segment,
                           "force": with_pauses(FORCE, (0, FORCE[30], 0))}, "a", SPRING)
    z, _, found = rows(text)
    np.testing.assert_allclose(z, BASE, rtol=1e-9, atol=1e-18)
    assert (found == WAYS).all()
    assert told.endswith("; 30 rows of pauses left out")


@pytest.mark.parametrize("facing", [1, -1])
def test_one_segment_is_divided_where_the_base_turns(facing):
    kind = segments_of(facing * BASE, np.zeros(62))
    assert (np.count_nonzero(kind == 0), np.count_nonzero(kind == 1)) == (31, 31)
    assert (np.diff(kind) >= 0).all()


def test_an_approach_alone_is_an_approach():
    assert (segments_of(IN, np.zeros(31)) == 0).all()
    assert (segments_of(IN[::-1], np.ones(31)) == 0).all()


def test_a_retract_after_an_approach_that_ended_at_once_is_a_retract():
    """It was called an approach."""
    labels = np.r_[0, np.ones(31)]
    kind = segments_of(np.r_[IN[-1], IN[::-1]], labels)
    assert (kind == np.r_[-1, np.ones(31)]).all()


@pytest.mark.parametrize("facing", [1, -1])
def test_a_height_of_the_tip_is_not_the_position_of_the_base(facing):
    """Of two heights the one that moves before contact counts; to one the deflection is added."""
    base = facing * BASE
    tip = base + facing * FORCE / SPRING
    tip[facing * base > 0] = 0
    both = {"height (measured)": tip, "height (piezo)": base}
    text, told = table_of(curve(**both), "a", SPRING)
    np.testing.assert_allclose(rows(text)[0], base, rtol=1e-9, atol=1e-18)
    assert told.endswith("position: height (piezo)")
    with pytest.raises(ConvertError, match="position of the tip; .* needs --spring-constant"):
        table_of(curve(**{"height (measured)": tip}), "a")


def test_rows_without_a_value_are_counted():
    force = FORCE.copy()
    force[[3, 40]] = np.nan
    text, told = table_of(curve(force=force), "a", SPRING)
    assert len(rows(text)[0]) == 60
    assert told.endswith("; 2 rows without a value left out")


@pytest.mark.parametrize(("columns", "told"), [
    ({"height (measured)": BASE}, "no force"),
    ({"force": FORCE, "time": BASE}, "no height .measured. or height .piezo.; the file has force"),
    ({"force": FORCE, "height (measured)": 0 * BASE}, "the base does not move"),
    ({"force": np.tile(FORCE, 2), "height (measured)": np.tile(BASE, 2),
      "segment": np.repeat([0, 1, 2, 3], 31)}, "to and fro in 4 segments"),
])
def test_a_curve_that_lacks_something_is_refused(columns, told):
    with pytest.raises(ConvertError, match=told):
        table_of(columns)


# What afmformats hands over: the columns of a curve by name, with what is known of it.
FAKE_AFMFORMATS = f"""
import numpy as np


class Curve(dict):
    columns = property(lambda self: list(self))
    metadata = {{"spring constant": 0.5}}


def load_data(path, meta_override):
    path = str(path)
    base = np.array({BASE.tolist()})
    curve = Curve({{"height (piezo)": base, "force": 0 * base, "segment": np.repeat([0, 1], 31)}})
    if "other" in path or path.endswith(".zip"):
        raise BaseException("no recipe")
    if "bare" in path and "spring constant" not in meta_override:
        raise ValueError("Please specify sensitivity and spring constant!")
    if "volts" in path:
        del curve["force"]
    return [curve] * (3 if "map" in path else 1)
"""
FILES = ("some.jpk-force", "volts.jpk-force", "other.xyz", "a.map", "bare.csv")


@pytest.fixture
def call(tmp_path):
    """Runs the converter on a file with the fake afmformats."""
    (tmp_path / "afmformats.py").write_text(FAKE_AFMFORMATS)
    for name in FILES:
        (tmp_path / name).touch()

    def run(*args, script=("-m", "snapin.convert")):
        path = f"{tmp_path}:{ROOT}/pywrap:{ROOT}/build/pywrap"
        return subprocess.run(
            [sys.executable, *map(str, script), *args], capture_output=True, text=True,
            timeout=HANG, check=False, cwd=tmp_path, env={"PYTHONPATH": path})

    return run


def test_a_file_of_an_instrument_becomes_a_table(call, tmp_path):
    done = call("some.jpk-force", "-o", "tables")
    assert (done.returncode, done.stderr) == (0, "")
    assert len(rows((tmp_path / "tables/some.csv").read_text())[0]) == 62
    assert "&measurement file = 'some.csv', columns = 'z', 'force', 'segment', spring_constant " \
        "= 0.5 /" in done.stdout


def test_every_curve_of_a_map_is_written_or_one_of_them(call, tmp_path):
    done = call("a.map", "-o", "all")
    assert sorted(file.name for file in (tmp_path / "all").iterdir()) == [
        "a_0.csv", "a_1.csv", "a_2.csv"]
    assert "3 of 3 curves" in done.stdout
    call("a.map", "-o", "one", "--number", "1")
    assert [file.name for file in (tmp_path / "one").iterdir()] == ["a_1.csv"]


def test_what_the_file_lacks_can_be_given(call):
    done = call("bare.csv", "-o", "tables")
    assert done.returncode == 1
    assert done.stderr.endswith("give --spring-constant and --sensitivity\n")
    assert call("bare.csv", "-o", "tables", "--spring-constant", "0.1", "--sensitivity",
                "5e-8").returncode == 0


def test_an_archive_of_curves_is_read_as_far_as_its_members_are_curves(call, tmp_path):
    with zipfile.ZipFile(tmp_path / "all.zip", "w") as archive:
        for name in ("notes.xyz-other", "a.jpk-force", "b.jpk-force"):
            archive.writestr(name, "")
    done = call("all.zip", "-o", "tables")
    assert done.returncode == 0, done.stderr
    assert "2 of 2 curves" in done.stdout


def test_another_file_is_not_replaced(call, tmp_path):
    (tmp_path / "some.csv").write_text("mine")
    done = call("some.jpk-force")
    assert done.returncode == 1
    assert "is not from this file" in done.stderr
    assert (tmp_path / "some.csv").read_text() == "mine"
    assert call("some.jpk-force", "-o", "new").returncode == 0
    assert call("some.jpk-force", "-o", "new").returncode == 0


@pytest.mark.parametrize(("args", "phrase"), [
    (["nowhere.jpk-force"], "no such file"),
    (["some.jpk-force", "--number", "1"], "--number 1: the file has 1 curves"),
    (["other.xyz"], "no recipe"),
    (["volts.jpk-force"], "no force; the file has height .piezo., segment"),
])
@pytest.mark.parametrize("script", [("-m", "snapin.convert"),
                                    (ROOT / "pywrap/scripts/afm_to_table.py",)])
def test_a_file_without_such_a_curve_is_refused_in_one_line(call, args, phrase, script):
    done = call(*args, script=script)
    assert (done.returncode, done.stdout) == (1, "")
    assert re.fullmatch(rf"[a-z_.-]+: {args[0]}: .*{phrase}.*\n", done.stderr), done.stderr
