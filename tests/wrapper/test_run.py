"""Claims about decks run from Python: the program's own numbers, whatever a deck is given as, and
nothing left on the disk or said that was not asked for."""

import os
import tempfile

import f90nml
import numpy as np
import pytest
import snapin
from snapin import results
from support import faults
from support.interrupted import frames, linked_id, owner
from support.processes import answer
from support.scenes import lennard_jones, loading

CYCLE = {
    "scene": {"title": "a 'cycle' & more"},
    "bodies": {"radius": 1.5e-2, "young": [8e9, 2e11], "poisson": [0.3, 0.25]},
    "force": {"law": "lennard_jones", "hamaker": 1e-20, "z0": 0.5e-9, "part": None},
    "loading": {"h0_start": 4e-9, "h0_end": -1e-9, "h0_step": np.float64(2.5e-10)},
    "unloading": {"from": np.array([0.0, -1e-9])},
    "equilibrium_path": True,
    "profiles": {"h0": (2e-9, 0.0)},
    "approximations": {"count": 20},
    "classical": {},
    "sweep": None,
}

CURVE = lennard_jones(0.5, loading=loading(6, 2, 0.5))


@pytest.fixture(scope="module")
def result():
    return snapin.run(CYCLE)


def assert_same(table, other):
    """Every column is that of the program's table, to the bit."""
    assert list(table.dtype.names) == list(other)
    for name, column in other.items():
        np.testing.assert_array_equal(table[name], column, err_msg=name)


# --- The program's numbers


def test_every_table_is_that_of_the_program(run, result, monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "2")
    theirs = run(snapin.deck_text(CYCLE), threads=2)
    names = {name.removesuffix(".csv") for name in theirs.files if name.endswith(".csv")}
    assert set(result.tables) == names == {"curve", "profiles", "approximations", "classical"}
    for name in names:
        assert_same(getattr(result, name), theirs.table(f"{name}.csv").columns)


def test_summary_and_cost_are_those_of_the_program(run, result):
    theirs = run(snapin.deck_text(CYCLE), threads=2)
    seconds = {key for key in theirs.cost if key.endswith("_seconds")}
    for mine, other, but in (
        (result.summary, theirs.summary, set()), (result.cost, theirs.cost, {"threads", *seconds})
    ):
        assert mine.keys() == other.keys()
        for key in mine.keys() - but:
            np.testing.assert_array_equal(mine[key], other[key], err_msg=key)
    assert result.summary["title"] == CYCLE["scene"]["title"]
    assert result.converged is True


def test_every_list_of_a_summary_is_an_array_though_it_may_hold_one_value(result):
    """Two turning points, two folds, two profiles on each branch: nothing else is a list."""
    one = snapin.run({**CYCLE, "unloading": True, "profiles": {"h0": 2e-9}})
    lists = {key for key, value in result.summary.items() if isinstance(value, np.ndarray)}
    assert {"unload_from", "folds_load", "profiles_error", "load_folds_h0"} <= lists
    assert lists == {key for key, value in one.summary.items() if isinstance(value, np.ndarray)}
    assert not any(isinstance(value, list) for value in result.summary.values())
    assert one.summary["unload_from"].tolist() == [-1e-9]


def test_a_table_that_the_run_has_not_is_answered_with_those_it_has(result):
    with pytest.raises(AttributeError, match="^no table 'sweep'; this run has approximations, "):
        result.sweep
    assert "profiles" in dir(result)


# --- What a deck may be


def test_a_dictionary_a_text_and_a_path_give_the_same(result, tmp_path):
    text = snapin.deck_text(CYCLE)
    path = tmp_path / "cycle.nml"
    path.write_text(text)
    for given in text, path, str(path):
        assert snapin.run(given).curve.tobytes() == result.curve.tobytes()


def test_a_deck_of_the_program_is_written_and_read_to_all_digits():
    values = np.random.default_rng(1).uniform(-1, 1, 200) * 10.0 ** np.arange(-49, 51, 0.5)
    groups = {"profiles": {"h0": values}, "numerics": {"nodes": 300, "title": "it's"}}
    found = f90nml.reads(snapin.deck_text(groups))
    assert found["profiles"]["h0"] == values.tolist()
    assert found["numerics"] == {"nodes": 300, "title": "it's"}


def test_every_mistake_of_a_deck_is_told_with_line_group_and_key():
    with pytest.raises(snapin.DeckError) as told:
        snapin.run({**CYCLE, "bodies": {"radius": -1.0, "frog": 2}, "loading": {"h0_start": "far"}})
    for place in ('deck:5: &bodies: key "radius": ', 'deck:6: &bodies: key "frog": ',
                  '&loading: key "h0_start": '):
        assert place in str(told.value)
    assert isinstance(told.value, (snapin.SnapinError, ValueError))


def test_a_mistake_in_a_file_is_told_with_its_name(tmp_path):
    path = tmp_path / "wrong.nml"
    path.write_text("&bodies radius = 1 /\n&frog /\n")
    with pytest.raises(snapin.DeckError) as told:
        snapin.run(path)
    assert f'{path}:2: unknown group "&frog"' in str(told.value)


@pytest.mark.parametrize(
    ("given", "error"),
    [
        ("no/such/file.nml", FileNotFoundError),
        ("/", IsADirectoryError),
        (None, TypeError),
        (b"&bodies /", TypeError),
        ([CYCLE], TypeError),
        ("&bodies \ud800 /", ValueError),
        ("&bodies radius = 1\0 /", snapin.DeckError),
        (CURVE + "\0", snapin.DeckError),
        ("&" + " " * 2**21, snapin.DeckError),
        ({"bodies": None}, snapin.DeckError),
        ({"bodies": 3}, TypeError),
        ({"bodies / &force": {}}, ValueError),
        ({"bodies": {"radius = 1, young": 2.0}}, ValueError),
        ({"bodies": {"radius": []}}, ValueError),
        ({"scene": {"title": "two\nlines"}}, ValueError),
        ({"scene": {"title": "\0"}}, ValueError),
    ],
    ids=lambda value: repr(value)[:30],
)
def test_what_is_no_deck_is_refused(given, error):
    with pytest.raises(error):
        snapin.run(given)


# --- What is left behind


def test_nothing_is_left_on_the_disk(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    before = set(os.listdir("/proc/self/fd"))
    snapin.run(CURVE)
    with pytest.raises(snapin.DeckError):
        snapin.run({"frog": True})
    assert list(tmp_path.iterdir()) == []
    assert set(os.listdir("/proc/self/fd")) == before


def test_results_are_written_where_they_are_asked_for_and_read_again(tmp_path):
    mine = snapin.run(CURVE, out=tmp_path / "a" / "b ")
    assert sorted(os.listdir(tmp_path / "a")) == ["b "]
    again = snapin.read_results(tmp_path / "a" / "b ")
    assert again.curve.tobytes() == mine.curve.tobytes()
    assert again.summary == mine.summary and again.cost == mine.cost


def test_results_that_are_not_in_place_are_not_read(tmp_path, monkeypatch):
    """The run was stopped while it replaced results, of which some are in place."""
    snapin.run(CURVE, out=tmp_path)
    (tmp_path / "unfinished").mkdir()
    (tmp_path / "summary.nml").rename(tmp_path / "unfinished/summary.nml")
    monkeypatch.setattr(results, "_PATIENCE", 0.1)
    with pytest.raises(snapin.SnapinError, match="are not one set: a run was stopped"):
        snapin.read_results(tmp_path)
    assert len(snapin.run(CURVE, out=tmp_path).curve)
    assert sorted(os.listdir(tmp_path)) == ["curve.csv", "summary.nml"]


def test_a_finished_run_is_left_as_it_is_with_resume(tmp_path):
    first = snapin.run(CURVE, out=tmp_path, resume=True)
    written = (tmp_path / "curve.csv").stat().st_mtime_ns
    second = snapin.run(CURVE, out=tmp_path, resume=True)
    assert (tmp_path / "curve.csv").stat().st_mtime_ns == written
    assert second.cost == first.cost


def test_what_was_interrupted_belongs_to_the_program(tmp_path, snapin_path, monkeypatch):
    """Built of other sources, it would be refused."""
    for key, value in {"LD_PRELOAD": faults.library(tmp_path), "FAULT_CALL": "rename",
                       "FAULT_AT": "1", "FAULT_ERRNO": "5", "FAULT_UNDER": "here"}.items():
        monkeypatch.setenv(key, str(value))
    with pytest.raises(snapin.SnapinError, match="not all are in place"):
        snapin.run(CURVE, out=tmp_path / "here")
    heading, *_ = frames((tmp_path / "here/unfinished/journal").read_bytes())
    assert f"(build {linked_id(snapin_path)})\n" in owner(heading)


GROUPS = {
    "curve": {"loading": {"h0_start": 4e-9, "h0_end": 0.0, "h0_step": 1e-9}, "stability": {},
              "unloading": {"from": [0.0, 1e-9]}, "profiles": {"h0": [1e-9]}, "classical": {},
              "approximations": {"count": 5}},
    "path": {"equilibrium_path": {"h0_end": -1e-9}, "device": {"stiffness": [1e4, 1e5]},
             "fixed_load": {"load": [1e-5, -1e-5]}, "table": {}, "regime": {},
             "sensitivity": {"parameters": ["force.hamaker"]}},
    "sweep": {"equilibrium_path": {"h0_end": 0.0},
              "sweep": {"key": "force.z0", "values": [4e-10, 5e-10]}},
}


@pytest.mark.parametrize("name", GROUPS)
def test_what_is_handed_over_is_what_a_folder_would_hold(name, tmp_path, monkeypatch):
    deck = {"bodies": {"radius": 1.5e-2, "stiffness": 1e10},
            "force": {"law": "lennard_jones", "hamaker": 1e-20, "z0": 5e-10}, **GROUPS[name]}
    monkeypatch.chdir(tmp_path)
    handed = snapin.run(deck)
    assert list(tmp_path.iterdir()) == []
    kept = snapin.run(deck, out="kept")
    assert handed.tables.keys() == kept.tables.keys()
    for key, table in handed.tables.items():
        assert table.dtype == kept.tables[key].dtype
        assert table.tobytes() == kept.tables[key].tobytes()
    for key, value in handed.summary.items():
        np.testing.assert_equal(value, kept.summary[key])
    assert handed.summary.keys() == kept.summary.keys()
    assert handed.cost["states"] == kept.cost["states"]


def test_resume_needs_a_folder():
    with pytest.raises(ValueError, match="^resume: "):
        snapin.run(CURVE, resume=True)


@pytest.mark.parametrize(("out", "error"), [("a\0", ValueError), (3, TypeError), (b"a", TypeError)])
def test_what_is_no_folder_is_refused(out, error, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(error, match="^out: "):
        snapin.run(CURVE, out=out)
    assert list(tmp_path.iterdir()) == []
    if error is TypeError:
        with pytest.raises(error, match="^folder: "):
            snapin.read_results(out)


@pytest.mark.parametrize("notes", ["# mine\n# x\n1;2\n3;4\n", "# Höhe\nz,F\n1,2\n"])
def test_tables_of_others_in_the_folder_are_left_alone(notes, tmp_path):
    """A measured curve beside its deck may have any form, and any encoding."""
    (tmp_path / "notes.csv").write_text(notes, encoding="latin-1")
    (tmp_path / "notes.nml").write_text(notes, encoding="latin-1")
    assert list(snapin.run(CURVE, out=tmp_path).tables) == ["curve"]


def test_the_program_says_nothing_unless_it_is_asked_to(capfd):
    with pytest.raises(snapin.DeckError):
        snapin.run({"frog": True})
    with pytest.raises(snapin.SnapinError, match="cannot make the folder"):
        snapin.run(CURVE, out="/dev/null/folder")
    with pytest.warns(snapin.SnapinWarning, match="under-resolved"):
        snapin.run(lennard_jones(2.0, loading=loading(4, 2, 1), numerics={"nodes": 100,
                                                                          "grid": "uniform"}))
    assert capfd.readouterr() == ("", "")
    snapin.run(CURVE, quiet=False)
    assert "9 states in" in capfd.readouterr().err


def test_the_package_is_found_without_a_path_of_python_s():
    """What the set-up leaves in the virtual environment is enough."""
    script = """
import os, sys, subprocess
del os.environ["PYTHONPATH"]
print(subprocess.run([sys.executable, "-c", "import snapin; print(snapin.run.__name__)"],
                     cwd="/", capture_output=True, text=True).stdout)
"""
    assert answer(script).split() == ["run"]
