"""Claims about the measured curve that comes with the program, and its picture."""

import importlib

import pytest
from conftest import ROOT
from snapin import read_results, run


@pytest.fixture(scope="module")
def example(snapin, tmp_path_factory):
    folder = tmp_path_factory.mktemp("example")
    done = snapin("--out", folder, ROOT / "inputs/examples/fit.nml")
    assert done.returncode == 0, done.stderr
    return folder / "fit", done.stderr


@pytest.mark.slow
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


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::snapin.SnapinWarning")
@pytest.mark.parametrize(("head", "unit"), [("Deflection (nm)", "nm"), ("Signal (mV)", "mV"),
                                            ("signal", "V or m")])
def test_the_picture_has_the_unit_of_the_signal_and_all_of_the_tension(
        tmp_path, head, unit):
    """A deflection in metres was labelled as volts. Where the residuals of a wrong model are as
    large as the tension, the axis ended before it."""
    pytest.importorskip("matplotlib")
    table = ROOT / "inputs/tutorial/probe.txt"
    rows = [line.split("\t") for line in table.read_text(encoding="utf-8").splitlines()[6:]]
    lines = [f"Z (um),{head},Segment"]
    lines += [f"{z},{float(force) / 42},{way}" for z, force, way in rows]
    (tmp_path / "curve.csv").write_text("\n".join(lines))
    # Softer bodies than any that describe the data: the residuals are large.
    run({
        "bodies": {"radius": 5e-6, "stiffness": 1e6},
        "force": {"law": "lennard_jones", "surface_energy": 0.04, "z0": 5e-10},
        "measurement": {"file": str(tmp_path / "curve.csv"), "columns": ["Z", head, "Segment"],
                        "spring_constant": 42.0,
                        "sensitivity": {"nm": 1.0, "mV": 1e-6, "V or m": 1e-9}[unit]},
        "fit": {"parameters": ["bodies.stiffness", "measurement.contact_point"],
                "upper": [2e6, 1.0], "lower": [1e3, -1.0]}}, tmp_path / "out")
    fit = importlib.import_module("snapin.plots.fit")
    panel, below = fit.draw_fit(tmp_path / "out").axes
    assert panel.get_ylabel() == f"signal less baseline [{unit}]"
    left, right = panel.get_xlim()
    drawn = [line.get_xydata() for line in panel.lines if line.get_marker() == "."]
    lowest = min((points[points[:, 1].argmin()] for points in drawn), key=lambda point: point[1])
    assert left <= lowest[0] <= right
