"""Claims about the measured curve that comes with the program, its picture, and the reader of
instruments' files."""

import re
import subprocess
import sys

import pytest
from conftest import ROOT
from snapin import read_results
from support.processes import HANG

# What afmformats hands over: the columns of a curve by name, with what is known of it.
FAKE_AFMFORMATS = '''
import pathlib


class Curve(dict):
    columns = property(lambda self: list(self))
    metadata = {"spring constant": 0.5}
    path = pathlib.Path("some.jpk-force")


def load_data(path):
    curve = Curve({"height (piezo)": [2e-6, 1e-6, 2e-6], "force": [0.0, 3e-9, -1e-9],
                   "segment": [0, 0, 1], "time": [0, 1, 2]})
    if path == "other.xyz":
        raise BaseException("no recipe")
    if path == "volts.jpk-force":
        del curve["force"]
    return [curve]
'''


@pytest.fixture(scope="module")
def example(snapin, tmp_path_factory):
    folder = tmp_path_factory.mktemp("example")
    done = snapin("--out", folder, ROOT / "inputs/examples/fit.nml")
    assert done.returncode == 0, done.stderr
    return folder / "fit", done.stderr


def test_the_example_gives_what_its_page_says(example):
    folder, said = example
    result = read_results(folder)
    fit = result.fitted["fit"]
    found = dict(zip(fit["parameters"], fit["estimate"]))
    assert found["measurement.sensitivity"] == pytest.approx(1.64, abs=0.01)
    assert found["force.surface_energy"] == pytest.approx(0.26, abs=0.01)
    assert fit["noise"][0] == pytest.approx(10e-12, rel=0.05)
    # Pull-off and jump into contact, less what the signal was before.
    assert abs(fit["jump_in_change"][0]) == pytest.approx(2.6e-9, rel=0.02)
    left = {name: (group["chi_squared"][0] / group["degrees_of_freedom"][0]) ** 0.5
            for name, group in result.fitted.items()}
    assert set(left) == {"fit", "jkr", "dmt", "maugis_dugdale"}
    assert all(4.3 < value < 4.6 for value in left.values())
    for phrase in ("2000 samples", "times the noise", "cannot be told apart",
                   "on the approach the data jump", "fit: done in "):
        assert phrase in said, phrase


def test_the_fit_is_drawn(example, called):
    pytest.importorskip("matplotlib")
    folder, _ = example
    done = called(ROOT / "pywrap/plots/fit.py", folder)
    assert (done.returncode, done.stderr) == (0, "")
    assert (folder / "fit.png").stat().st_size > 2e4


@pytest.fixture
def convert(tmp_path):
    """Runs the reader of instruments' files on a file with the fake afmformats."""
    (tmp_path / "afmformats.py").write_text(FAKE_AFMFORMATS)
    for name in ("some.jpk-force", "volts.jpk-force", "other.xyz"):
        (tmp_path / name).touch()

    def run(*args):
        script = ROOT / "pywrap/scripts/afm_to_table.py"
        return subprocess.run(
            [sys.executable, str(script), *args], capture_output=True, text=True, timeout=HANG,
            check=False, cwd=tmp_path, env={"PYTHONPATH": str(tmp_path)})

    return run


def test_a_file_of_an_instrument_becomes_a_table(convert):
    done = convert("some.jpk-force")
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert lines[1] == "# spring_constant = 0.5"
    assert lines[2:] == ["z,force,segment", "2.000000000e-06,0.000000000e+00,0",
                         "1.000000000e-06,3.000000000e-09,0", "2.000000000e-06,-1.000000000e-09,1"]


@pytest.mark.parametrize(("args", "phrase"), [
    (["nowhere.jpk-force"], "No such file"),
    (["some.jpk-force", "--number", "1"], "--number 1: the file has 1 curves"),
    (["other.xyz"], "no recipe"),
    (["volts.jpk-force"], "needs force, .* this one has height \\(piezo\\), segment, time"),
])
def test_a_file_without_such_a_curve_is_refused_in_one_line(convert, args, phrase):
    done = convert(*args)
    assert (done.returncode, done.stdout) == (1, "")
    assert re.fullmatch(rf"afm_to_table.py: {args[0]}: .*{phrase}.*\n", done.stderr), done.stderr
