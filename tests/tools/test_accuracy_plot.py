"""Claims about the picture of what accuracy costs."""

import numpy as np
import pytest
import snapin
from conftest import ROOT
from support.pictures import BODIES, CYCLE, FORCE, SWEEP, size_of

pytest.importorskip("matplotlib")
from snapin.plots.accuracy import draw_accuracy  # noqa: E402 (needs matplotlib)

SCRIPT = ROOT / "pywrap" / "plots" / "accuracy.py"
# The error of the second case is well above what the last one can know.
ACCURACY = {
    "accuracy": BODIES + FORCE + CYCLE
    + "&sweep key = 'numerics.accuracy', values = 1e-3, 1e-4, 1e-9 /\n",
    "methods": BODIES + FORCE + CYCLE + "&sweep key = 'numerics.method', 'numerics.accuracy', "
    "words = 'newton', 'anderson', values = 1e-3, 1e-6 /\n",
    "nodes": BODIES + FORCE + CYCLE + "&numerics grid = 'uniform' /\n"
    "&sweep key = 'numerics.nodes', values = 60, 120 /\n",
    # These have no costs.
    "sweep": SWEEP,
    "cycle": BODIES + FORCE + CYCLE,
}


@pytest.fixture(scope="module")
def costs(snapin, tmp_path_factory):
    folder = tmp_path_factory.mktemp("costs")
    for name, text in ACCURACY.items():
        (folder / f"{name}.nml").write_text(text)
    snapin("--quiet", "--out", folder, *(folder / f"{name}.nml" for name in ACCURACY))
    return folder


@pytest.mark.slow
@pytest.mark.parametrize("args", [
    ("accuracy",), ("methods",), ("accuracy", "--beside", "{folder}/nodes"),
    ("accuracy", "--reference", "{folder}/true.csv"), ("accuracy", "--numbers", "end_load"),
])
def test_what_accuracy_costs_is_drawn(called, costs, tmp_path, args):
    (costs / "true.csv").write_text("# title\nmax_tension,6.07178524e-5\njump_in_h0,1.5452279e-9\n")
    args = [word.format(folder=costs) for word in args]
    done = called(SCRIPT, costs / args[0], *args[1:], "-o", "here.png")
    assert (done.returncode, done.stderr) == (0, ""), done.stderr
    assert size_of(tmp_path / "here.png") == (960, 660)


def test_errors_are_drawn_against_the_reference_and_none_below_what_is_known(costs):
    """The run that is the reference had an error of zero, drawn at 1e-15."""
    (costs / "true.csv").write_text("max_tension,6e-5\n")
    times, lines = snapin.read_results(costs / "accuracy").costs["seconds"], {}
    tension = snapin.read_results(costs / "accuracy").sweep["max_tension"]
    for reference in (None, costs / "true.csv"):
        (axes,) = draw_accuracy(
            costs / "accuracy", reference=reference, numbers=["max_tension"]).axes
        lines[reference is None] = next(line for line in axes.lines if len(line.get_xdata()) > 1)
    assert len(lines[True].get_xdata()) == 2  # All but the finest.
    assert np.allclose(lines[False].get_xdata(), 1e3 * times)
    assert np.allclose(lines[False].get_ydata(), abs(tension - 6e-5) / 6e-5)


@pytest.mark.parametrize("args, phrase", [
    (("{costs}/sweep",), "no costs.csv; sweep a key of &numerics, or give costs = .true."),
    (("{costs}/accuracy", "--numbers", "sigma"), "no estimated error of 'sigma'; there are"),
    (("{costs}/accuracy", "--beside", "{costs}/cycle"), "sweep.csv"),
    (("{costs}/accuracy", "--reference", "{costs}/nothing.csv"), "nothing.csv"),
    (("{costs}/accuracy", "--reference", "{costs}/words.csv"), "not lines of number,value"),
    (("{costs}/accuracy", "--reference", "{costs}/other.csv"), "none of these numbers"),
])
def test_what_cannot_be_drawn_of_accuracy_is_said(called, costs, args, phrase):
    (costs / "words.csv").write_text("max_tension = 1\n")
    (costs / "other.csv").write_text("pull_off,1\n")
    done = called(SCRIPT, *(word.format(costs=costs) for word in args))
    assert done.returncode == 1 and phrase in done.stderr, done.stderr
    assert "Traceback" not in done.stderr
