"""Claims about sweeps over several keys: every combination, or the cases of a table."""

import contextlib
import itertools
import os
import pty
import re
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from support.interrupted import Bench, frames
from support.processes import status_and_memory
from support.scenes import deck, loading, runner

BODIES = {"radius": 1e-6, "stiffness": 1e10}
FORCE = {"law": "lennard_jones", "hamaker": 1e-19, "z0": 3e-10}
PATH = {"h0_end": -1e-9}
GRID = {"key": ["bodies.stiffness", "force.hamaker"], "from": [1e9, 1e-20], "to": [1e11, 1e-19],
        "count": [3, 4], "scale": ["log", "linear"]}
CASES = list(itertools.product([1e9, 1e10, 1e11], [1e-20, 4e-20, 7e-20, 1e-19]))


# Quick.
RIGID = {"bodies": {"radius": 1e-6, "rigid": True}, "equilibrium_path": None,
         "loading": loading(3e-9, 2e-9, 1e-9)}


def scene(sweep=None, **groups):
    return deck(**{"bodies": BODIES, "force": FORCE, "equilibrium_path": PATH, "sweep": sweep,
                   **groups})


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("maps")


@pytest.fixture(scope="module")
def run(snapin, folder):
    return runner(snapin, folder)


def rows_of(result):
    """The table's text without its comments."""
    lines = (result.folder / "sweep.csv").read_text().splitlines()
    return [line for line in lines if not line.startswith("#")]


def test_every_combination_is_a_case_and_the_last_key_is_the_fastest(run):
    table = run(scene(GRID)).table("sweep.csv")
    assert table.names[:2] == GRID["key"]
    for i, name in enumerate(GRID["key"]):
        np.testing.assert_allclose(table[name], [case[i] for case in CASES], rtol=1e-14)
    for row in (0, 6, 11):
        stiffness, hamaker = (table[name][row] for name in GRID["key"])
        alone = run(scene(bodies={**BODIES, "stiffness": stiffness},
                          force={**FORCE, "hamaker": hamaker})).summary
        for name in ("max_tension", "jump_in_h0", "end_load", "sigma"):
            assert table[name][row] == pytest.approx(alone.get(name, np.nan), rel=1e-8, nan_ok=True)
    assert set(table["failure"]) == {""}


def test_one_scale_serves_all_keys(run):
    both = run(scene({**GRID, "scale": ["log", "log"]}))
    assert rows_of(both) == rows_of(run(scene({**GRID, "scale": "log"})))


def test_a_table_of_the_same_cases_gives_the_same_rows(run, folder):
    grid = run(scene(GRID))
    keys = [row.split(",")[:2] for row in rows_of(grid)]
    (folder / "cases.csv").write_text("# cases\n" + "\n".join(map(", ".join, keys)) + "\n")
    assert rows_of(run(scene({"file": "cases.csv"}))) == rows_of(grid)


def test_cells_may_stand_in_quotes(run, folder):
    """As spreadsheets write them; they were refused with a guess at the same name."""
    keys = ["bodies.radius,force.hamaker", "1e-6,1e-19", "2e-6,2e-19"]
    plain = "\n".join(keys)
    quoted = re.sub("([^,\n]+)", r'"\1"', plain)
    tables = {}
    for name, text in (("plain", plain), ("quoted", quoted), ("decimal commas", quoted.replace(
            ",", ";").replace("1e-6", "1,0e-6")), ("comment", "# " + quoted)):
        (folder / "cells.csv").write_text(text + "\n")
        tables[name] = rows_of(run(scene({"file": "cells.csv"}, **RIGID)))
    assert len(set(map(tuple, tables.values()))) == 1 and len(tables["plain"]) == 3


def test_only_what_stands_between_cells_makes_decimal_commas(run, folder):
    """The comma between two cells was taken for a decimal comma."""
    rows = ["1e-6,1e-19 # a; b", "1e-6,1e-19\t", "\t1e-6,1e-19", "\t # c", "1,0e-6;\t1e-19"]
    (folder / "commas.csv").write_text("\n".join(["bodies.radius,force.hamaker", *rows]))
    table = run(scene({"file": "commas.csv"}, **RIGID)).table("sweep.csv")
    np.testing.assert_array_equal(table["bodies.radius"], 4 * [1e-6])
    np.testing.assert_array_equal(table["force.hamaker"], 4 * [1e-19])


def test_a_file_is_read_in_pieces_whatever_its_line_ends(run, folder):
    """The pieces have 64 kB: rows lie across their ends."""
    count = 4000
    rows = [f"{1e-6 * (1 + i / count)!r},\t{1e-20 * (i + 1)!r} # {i}" for i in range(count)]
    tables = []
    for ends in ("\n", "\r\n", "\r"):
        (folder / "many.csv").write_bytes(
            ends.join(["\ufeff# all", "Bodies.Radius, force.hamaker", "", *rows]).encode())
        tables.append(run(scene({"file": "many.csv"}, **RIGID)).table("sweep.csv"))
    for table in tables:
        np.testing.assert_array_equal(table["bodies.radius"],
                                      [1e-6 * (1 + i / count) for i in range(count)])
        np.testing.assert_array_equal(table["force.hamaker"], [1e-20 * (i + 1)
                                                               for i in range(count)])
    for table in tables:
        np.testing.assert_array_equal(tables[0]["end_load"], table["end_load"])
    assert len(set(tables[0]["end_load"])) == count


@pytest.mark.parametrize("ends", ["\n", "\r\n", "\r"])
def test_a_mistake_in_a_file_is_named_by_its_line_whatever_the_line_ends(run, folder, ends):
    (folder / "wrong.csv").write_bytes(
        ends.join(["bodies.radius,force.hamaker", "1e-6,1e-19", "", "1e-6,x"]).encode())
    said = run(scene({"file": "wrong.csv"}, **RIGID), status=2).stderr
    assert "wrong.csv:4: x is not a number" in said


def test_a_single_case_is_a_case(run, folder):
    (folder / "single.csv").write_text("bodies.radius,force.hamaker\n1e-6,1e-19\n")
    assert ": 1 case, " in run(scene({"file": "single.csv"}, **RIGID)).stderr


@pytest.mark.parametrize("sweep", [GRID, {"file": "cases.csv"}], ids=["keys", "file"])
def test_an_interrupted_map_goes_on_to_the_same_bytes(snapin, snapin_path, tmp_path, sweep):
    rows = "".join(f"{stiffness!r}, {hamaker!r}\n" for stiffness, hamaker in CASES)
    (tmp_path / "cases.csv").write_text("bodies.stiffness, force.hamaker\n" + rows)
    bench = Bench(snapin, snapin_path, tmp_path, scene(sweep), threads=2)
    first, *parts = frames(bench.journal)
    assert len(parts) == len(CASES)
    for some in ([], parts, parts[:5], parts[::2], parts[6:]):
        bench.check(first + b"".join(some))


@pytest.mark.slow
@pytest.mark.parametrize("change", ["shorter", "last row", "no number"])
def test_a_file_that_changes_meanwhile_stops_the_sweep(snapin_path, tmp_path, change):
    """A row that was another when it was read again became a case. No run goes on from these."""
    rows = "".join(f"{1e-20 * (i + 1)!r:<24}# a line of some bytes\n" for i in range(12000))
    table = tmp_path / "cases.csv"
    table.write_text("force.hamaker\n" + rows)
    (tmp_path / "d.nml").write_text(scene({"file": "cases.csv"}, **RIGID))
    with subprocess.Popen([snapin_path, "d.nml"], cwd=tmp_path, stderr=subprocess.PIPE,
                          text=True) as run:
        while not (tmp_path / "results/d/unfinished/sweep.csv").exists():
            time.sleep(0.001)
            assert run.poll() is None
        with table.open("r+b") as file:
            if change == "shorter":
                file.truncate(1000)
            else:
                file.seek(-len(rows) // 12000, os.SEEK_END)
                file.write(b"2" if change == "last row" else b"?")
        said = run.communicate(timeout=60)[1]
    assert run.returncode == 1
    assert re.search("^results/d: cases.csv has changed since .*; start again$", said, re.MULTILINE)
    assert (tmp_path / "results/d/unfinished/journal").stat().st_size == 0


@pytest.mark.long
@pytest.mark.alone
def test_two_threads_hardly_wait_for_each_other(snapin_path, tmp_path):
    """1,200 cases are done nearly twice as fast where there are two cores: what counts is the time
    that threads compute or ask for a core, however many others there are."""
    (tmp_path / "d.nml").write_text(scene({**GRID, "from": [1e8, 1e-20], "count": [40, 30]}))
    began, busy = time.monotonic(), {}
    with subprocess.Popen([snapin_path, "--quiet", "d.nml"], cwd=tmp_path,
                          env=dict(os.environ, OMP_NUM_THREADS="2")) as run:
        while run.poll() is None:
            for thread in Path(f"/proc/{run.pid}/task").glob("*"):
                with contextlib.suppress(OSError):
                    runs, waits, _ = (thread / "schedstat").read_text().split()
                    busy[thread.name] = 1e-9 * (int(runs) + int(waits))
            took = time.monotonic() - began
            time.sleep(0.02)
    assert run.returncode == 0
    assert sum(sorted(busy.values())[-2:]) > 0.95 * 2 * took


def test_a_case_that_fails_is_a_row_that_says_why(run):
    """Least and greatest of both keys make scenes, the others do not."""
    sweep = {"key": ["loading.h0_start", "loading.h0_end"], "from": [2e-9, 1e-9],
             "to": [5e-9, 4e-9], "count": [2, 2]}
    result = run(scene(sweep, loading=loading(2e-9, 1e-9, 1e-9), equilibrium_path=None), status=1)
    table = result.table("sweep.csv")
    np.testing.assert_array_equal(table["converged"], [1, 0, 1, 1])
    assert "h0_end" in table["failure"][1] and "below" in table["failure"][1]
    assert [bool(text) for text in table["failure"]] == [False, True, False, False]
    assert np.isnan(table["end_load"][1])
    assert any("1 of 4 cases failed: rows of" in text for text in result.warnings)


def on_a_terminal(program, folder, *arguments):
    """The status of a run, and the lines that a terminal shows."""
    ours, theirs = pty.openpty()
    with subprocess.Popen([program, *arguments], cwd=folder, stderr=theirs,
                          env={**os.environ, "OMP_NUM_THREADS": "1"}) as run:
        os.close(theirs)
        said = b""
        with contextlib.suppress(OSError):  # the other end is closed
            while part := os.read(ours, 65536):
                said += part
    os.close(ours)
    return [run.returncode, *re.split("[\r\n]+", said.decode())]


@pytest.mark.slow
def test_a_terminal_shows_the_case_that_takes_long(snapin_path, tmp_path):
    drive = (ROOT / "inputs" / "examples" / "drainage.nml").read_text()
    (tmp_path / "d.nml").write_text(
        drive + "\n&sweep key = 'numerics.accuracy', values = 2e-4, 2.2e-4 /\n")
    _, *lines = on_a_terminal(snapin_path, tmp_path, "d.nml")
    cases = [found[1] for line in lines if (found := re.match(r"d: case (\d+): drive, ", line))]
    assert cases == sorted(cases) and set(cases) == {"1", "2"}


@pytest.mark.slow
def test_a_terminal_shows_how_far_a_sweep_is(snapin_path, tmp_path):
    """In half of the cases the loading would go the wrong way."""
    sweep = {"key": ["loading.h0_start", "loading.h0_end"], "from": [2e-9, 1e-9],
             "to": [5e-9, 4e-9], "count": [120, 120]}
    (tmp_path / "d.nml").write_text(scene(sweep, **RIGID))
    status, *lines, last, _ = on_a_terminal(snapin_path, tmp_path, "d.nml")
    assert status == 1
    line = r"d: case, \d+ %, \d+ failed, \d+ a second, \d+ (s|min) left, \d+ (s|min) so far *"
    assert any(re.fullmatch(line, text) for text in lines), lines
    command = re.fullmatch(r"results/d: 14400 cases, \d+ a second: results/d/sweep.csv; "
                           r"to draw it: (\S+) (\S+/map.py) results/d", last)
    assert command and all(map(os.path.exists, command.groups())), last


@pytest.mark.slow
def test_the_time_left_is_estimated_from_the_cases_of_this_run(
        snapin, snapin_path, tmp_path, monkeypatch):
    """An interrupted run has completed many cases, each much quicker than the others, which take
    some seconds of one thread. The first estimate comes after a second."""
    monkeypatch.setenv("OMP_NUM_THREADS", "1")
    given, others = 3000, 60
    (tmp_path / "cases.csv").write_text("loading.h0_step\n" + given*"1e-9\n" + others*"3e-15\n")
    bench = Bench(snapin, snapin_path, tmp_path, scene({"file": "cases.csv"}, **RIGID))
    bench.emptied(b"".join(frames(bench.journal)[:1 + given]))
    status, *lines = on_a_terminal(snapin_path, tmp_path, "--out", "cut", "--resume", "deck.nml")
    assert status == 0
    rate = next(found for line in lines if (
        found := re.search(r", (\S+) (a second|s each), \d+ (s|min) left", line)))
    assert rate[2] == "s each" or float(rate[1]) <= others


# A sweep, or the text of its file of cases; what is said of it.
WRONG = {
    "count": ({**GRID, "count": [3]}, "1 for 2 keys"),
    "fraction": ({**GRID, "count": [3, 2.5]}, "not a whole number"),
    "scale": ({**GRID, "scale": ["log", "cubic"]}, "neither linear nor log"),
    "values": ({"key": GRID["key"], "values": [1e-19]}, "values are those of one key"),
    "nothing": ({"from": [1.0]}, "give key, or file"),
    "name": ({**GRID, "key": ["bodies.stiffness", "force.strength"]}, "force.strength"),
    "bounds": ({**GRID, "from": [-1e9, 1e-20], "scale": "linear"}, "out of range"),
    "too many": ({**GRID, "count": [10000, 10000]}, "more than 10000000 cases"),
    "no file": ({"file": "nowhere.csv"}, "no such file"),
    "both": ({"file": "nowhere.csv", "key": "force.hamaker"}, "not together with file"),
    "no names": ("1e9\n", "no line of names"),
    "cell": ("bodies.stiffness\nsoft\n", "cases.csv:2"),
    "value": ("bodies.stiffness\n1\n-1\n", "case 2: -1"),
    "empty": ("bodies.stiffness\n", "has no cases"),
    "void": ("", "has no cases"),
    "late": ("bodies.stiffness\n" + "1e9\n" * 20000 + "1e\n",
             "cases.csv:20002: 1e is not a number"),
    "columns": ("bodies.stiffness\n1e9, 2\n", "2 columns where 1 column is expected"),
    "last cell": ("bodies.stiffness,force.hamaker\n1e9,\n", "cases.csv:2: 1 column where 2 columns "
                                                            "are expected; the last cell is empty"),
    "quoted last cell": ('bodies.stiffness,force.hamaker\n1e9,""\n', "the last cell is empty"),
    "blank": ('"bodies.stiffness force.hamaker"\n1e9\n', "cases.csv:1: a name with a blank"),
    "open quote": ('bodies.stiffness\n"1e9\n', 'cases.csv:2: "1e9 is not a number'),
    "whole": ("numerics.nodes\n100\n200\n2.5\n", "case 3: 2.5"),
    "folder": ({"file": "."}, "cannot be"),
    "twice": ({**GRID, "key": ["force.hamaker", "Force.Hamaker"]}, "is there twice"),
    "column twice": ("bodies.stiffness, bodies.stiffness\n1e9, 2e9\n",
                     "'bodies.stiffness' is there twice"),
    "nul": ("bodies.stiffness\n1e9\n2e9\0\n", "cases.csv:3: a NUL byte, which plain text does"),
    "unknown": ({"key": "force.law", "words": ["lennard_jones", "exponentail"]},
                'did you mean "exponential"'),
    "no words": ({"key": "force.law"}, "missing"),
    "both kinds": ({"key": "force.law", "words": "exponential", "values": [1.0]}, "give words"),
    "number": ({"key": "force.hamaker", "words": ["linear"]}, "does not hold a word"),
    "several": ({"key": ["force.law", "numerics.method"], "words": ["lennard_jones"]},
                "only one of the keys may hold a word"),
    "no range": ({"key": ["force.law", "force.hamaker"], "words": ["lennard_jones"]},
                 "missing; give from"),
    "word in a cell": ("force.law\nlennard_jones\nnewton\n", "cases.csv:3"),
    "with file": ({"file": "cases.csv", "words": ["exponential"]}, "not together with file"),
    "deck": ({"key": "force.law", "words": ["exponential"]}, "with force.law = exponential"),
}


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_sweep_is_refused(snapin, tmp_path, case):
    sweep, said = WRONG[case]
    if isinstance(sweep, str):
        (tmp_path / "cases.csv").write_text(sweep)
        sweep = {"file": "cases.csv"}
    (tmp_path / "d.nml").write_text(scene(sweep))
    result = snapin("d.nml", cwd=tmp_path)
    assert result.returncode == 2
    assert said in result.stderr
    assert not (tmp_path / "results").exists()


@pytest.mark.parametrize("size, rank", [
    ("OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"), ("PMI_SIZE", "PMI_RANK"),
    ("SLURM_STEP_NUM_TASKS", "SLURM_PROCID")])
def test_several_at_once_are_refused_without_mpi(snapin, tmp_path, size, rank, monkeypatch):
    """All of them end; the first says why."""
    monkeypatch.setenv(size, "3")
    (tmp_path / "d.nml").write_text(scene())
    for number in "01":
        monkeypatch.setenv(rank, number)
        result = snapin("d.nml", cwd=tmp_path)
        assert result.returncode == 2
        assert ("this build has no MPI" in result.stderr) == (number == "0")
    assert not (tmp_path / "results").exists()


@pytest.mark.slow
@pytest.mark.alone
@pytest.mark.parametrize("counts", [(2000, 26000),
                                    pytest.param((1000, 1000000), marks=pytest.mark.long)])
def test_memory_does_not_grow_with_the_number_of_cases(snapin, snapin_path, tmp_path, monkeypatch,
                                                       counts):
    # What threads have of memory varies by a megabyte.
    monkeypatch.setenv("OMP_NUM_THREADS", "1")
    # Less than the two numbers that each case has in the file, of which none stays. What flang 22
    # makes of the same sources loses half a kB.
    most = 1000 if "flang" in snapin("--version").stdout else 16
    used = []
    for count in counts:
        (tmp_path / "cases.csv").write_text("bodies.radius, force.hamaker\n" + "".join(
            f"{1e-6 + 1e-12 * i!r}, {1e-20 + 1e-25 * i!r}\n" for i in range(count)))
        (tmp_path / "d.nml").write_text(scene({"file": "cases.csv"}, **RIGID))
        status, memory = status_and_memory(snapin_path, "--quiet", "d.nml", cwd=tmp_path)
        assert status == 0
        used.append(memory)
    assert used[1] - used[0] < most * (counts[1] - counts[0])


MODELS = ["linear", "superposition", "nonlinear"]
COLLOID = {"bodies": BODIES, "force": None, "equilibrium_path": {"h0_end": -1e-9},
           "van_der_waals": {"hamaker": 1e-20}, "born": {"z0": 3e-10}}
LAYER = {"potential": -0.03, "salt": 1.0}


@pytest.fixture(scope="module")
def models(run):
    sweep = {"key": "double_layer.model", "words": MODELS}
    return run(scene(sweep, **COLLOID, double_layer=LAYER))


@pytest.mark.slow
def test_words_are_swept(run, models):
    table = models.table("sweep.csv")
    assert list(table["double_layer.model"]) == MODELS
    for i, model in enumerate(MODELS):
        alone = run(scene(**COLLOID, double_layer={**LAYER, "model": model})).summary
        assert table["end_load"][i] == pytest.approx(alone["end_load"], rel=1e-8)
    assert len(set(table["end_load"])) == 3


def test_every_word_is_combined_with_every_number(run, models):
    sweep = {"key": ["double_layer.salt", "double_layer.model"], "words": MODELS,
             "from": [1.0], "to": [10.0], "count": [2]}
    result = run(scene(sweep, **COLLOID, double_layer=LAYER))
    table = result.table("sweep.csv")
    assert list(table["double_layer.model"]) == 2 * MODELS
    np.testing.assert_array_equal(table["double_layer.salt"], 3 * [1] + 3 * [10])
    np.testing.assert_array_equal(table["end_load"][:3], models.table("sweep.csv")["end_load"])
    assert len(set(table["end_load"])) == 6
    text = (result.folder / "sweep.csv").read_text()
    assert "# double_layer.salt [mol/m^3] " in text and "# double_layer.model [] " in text


def test_a_table_has_words_in_columns_of_words(run, folder, models):
    salts = {"Nonlinear": 10, "linear": 1, "superposition": 1}
    (folder / "models.csv").write_text("double_layer.salt, double_layer.model\n" + "".join(
        f"{salt}, {model}\n" for model, salt in salts.items()))
    table = run(scene({"file": "models.csv"}, **COLLOID, double_layer=LAYER)).table("sweep.csv")
    assert list(table["double_layer.model"]) == ["nonlinear", "linear", "superposition"]
    np.testing.assert_array_equal(table["double_layer.salt"], [10, 1, 1])
    np.testing.assert_array_equal(table["end_load"][1:], models.table("sweep.csv")["end_load"][:2])


def test_two_threads_leave_the_same_bytes(run):
    one, two = (run(scene(GRID), threads=threads) for threads in (1, 2))
    assert rows_of(one) == rows_of(two)
