"""Results that were damaged are results, or a ResultsError in one line, and never a traceback."""

import os
import shutil

import numpy as np
import pytest
import snapin
from conftest import ROOT
from snapin.results import ResultFiles, ResultsError
from test_plots import BODIES, DECKS, FORCE

SCRIPTS = ROOT / "pywrap" / "plots"
DEVICE = FORCE + "&equilibrium_path h0_end = -1e-9 /\n&device stiffness = 100 /\n"
DRAWN = {
    "cycle": (DECKS["cycle"], ("force_curve", "profiles")),
    "path": (DECKS["path"], ("force_curve",)),
    "map": (DECKS["map"], ("map",)),
    "regime": (DECKS["regime"], ("regime",)),
    "device": (BODIES + DEVICE, ("device_curve",))}
WORDS = (b"NaN", b"inf", b"-inf", b"1e308", b"1e999", b"", b"''", b"word", b"0", b"1.2.3", b"\xff",
         b"\0", b",", b"=", b"&cost", b"/", b"\n", b"&summary", b"h0", b".true.", b"1 2")


@pytest.fixture(scope="module")
def results(snapin, tmp_path_factory):
    folder = tmp_path_factory.mktemp("damaged")
    for name, (text, _) in DRAWN.items():
        (folder / f"{name}.nml").write_text(text)
    done = snapin("--quiet", "--out", folder, *(folder / f"{name}.nml" for name in DRAWN))
    assert done.returncode == 0, done.stderr
    # A fit's file, as the program writes it.
    (folder / "cycle/fit.nml").write_text(
        "! A fit by snapin, SI units.\n&fit\n  title = ''\n  parameters = 'force.z0'\n"
        "  units = 'm'\n  estimate = 1E-010\n  standard_error = 1E-012\n  correlation = 1.0\n/\n")
    return folder


def damage(rng, text):
    """A text with one mistake: a part lost, moved or doubled, or a word in place of another."""
    first, last = np.sort(rng.integers(0, len(text) + 1, 2))
    kind = rng.integers(6)
    if kind == 0:
        return text[:first]
    if kind == 1:
        return text[:first] + text[min(last, first + 40):]
    if kind == 2:
        return text[:last] + text[first:]
    # A word of a line, so that most of the file remains.
    starts = [i for i in range(1, len(text)) if text[i - 1:i] in b",=\n "]
    at = starts[rng.integers(len(starts))]
    end = next((i for i in range(at, len(text)) if text[i:i + 1] in b",\n"), len(text))
    return text[:at] + WORDS[rng.integers(len(WORDS))] + text[at if kind == 3 else end:]


def copies(results, name, folder, count):
    """Copies of a folder of results with one damaged file."""
    files = sorted(path.name for path in (results / name).iterdir()
                   if path.suffix in (".csv", ".nml"))
    rng = np.random.default_rng(len(name))
    for i in range(count):
        copy = folder / f"{name}{i}"
        shutil.copytree(results / name, copy)
        path = copy / files[i % len(files)]
        path.write_bytes(damage(rng, path.read_bytes()))
        yield copy


@pytest.mark.parametrize("name", DRAWN)
def test_damaged_results_are_read_or_refused(results, tmp_path, name):
    """A third of such folders gave a KeyError, an IndexError or the like."""
    refused = 0
    for folder in copies(results, name, tmp_path, 120):
        try:
            snapin.read_results(folder)
        except ResultsError as problem:
            refused += 1
            assert str(folder) in str(problem)
    assert refused > 10


@pytest.mark.parametrize("script, name", [(script, name) for name, (_, scripts) in DRAWN.items()
                                          for script in scripts])
def test_damaged_results_are_drawn_or_refused_in_a_line(called, results, tmp_path, script, name):
    refused = 0
    for folder in copies(results, name, tmp_path, 6):
        done = called(SCRIPTS / f"{script}.py", folder, "--dpi", 20)
        if done.returncode:
            refused += 1
            assert done.stderr.startswith(f"{script}.py: ") and done.stderr.count("\n") <= 2
            assert str(folder) in done.stderr
    assert refused > 0


def test_a_name_that_results_lack_is_named_with_a_similar_one(results):
    found = snapin.read_results(results / "path")
    with pytest.raises(KeyError, match="no 'max_tensoin' in .*did you mean 'max_tension'"):
        found.summary["max_tensoin"]
    with pytest.raises(KeyError, match="no 'xyz'"):
        found.cost["xyz"]
    assert found.summary.get("max_tensoin") is None and "max_tensoin" not in found.summary
    with pytest.raises(ResultsError, match="no 'lode' in .*curve.csv; did you mean 'load'"):
        ResultFiles(results / "path").table("curve.csv")["lode"]
    swept = snapin.read_results(results / "map").summary
    with pytest.raises(KeyError, match="it is of the table sweep, which has the numbers of all"):
        swept["max_tension"]


def test_results_that_are_no_files_are_refused(results, tmp_path):
    """A pipe was waited for."""
    os.mkfifo(tmp_path / "summary.nml")
    with pytest.raises(ResultsError, match="summary.nml is no file"):
        snapin.read_results(tmp_path)
