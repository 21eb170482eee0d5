"""Claims about the measured curve that comes with the program, and its picture."""

import pytest
from conftest import ROOT
from snapin import read_results

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
    assert found["force.work_of_adhesion"] == pytest.approx(0.26, abs=0.01)
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
