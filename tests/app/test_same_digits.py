"""Claims about the same digits from the same deck."""

import re

import numpy as np
import pytest
from conftest import ROOT
from support.scenes import exponential, lennard_jones, loading, runner, several

CYCLE = {"loading": loading(6, -2, 0.5), "unloading": {}}


SCENES = {
    "cycle and path": lennard_jones(
        8.7, loading=loading(13, -4, 0.5), unloading={}, equilibrium_path={}),
    "uniform": lennard_jones(0.87, **CYCLE, numerics={"grid": "uniform", "nodes": 200}),
    "newton": lennard_jones(1.7, **CYCLE, numerics={"method": "newton"}),
    "mixing": lennard_jones(
        0.17, loading=loading(6, 0, 1), numerics={"method": "mixing", "nodes": 100}),
    "repulsion": exponential(100, loading=loading(6, -20, 1)),
    "stability": lennard_jones(0.87, loading=loading(6, -1, 0.5), stability={}),
}


@pytest.mark.parametrize("text", SCENES.values(), ids=SCENES.keys())
def test_the_same_deck_gives_the_same_bytes_on_any_number_of_threads(snapin, tmp_path, text):
    """Matrices below 2500 nodes are kept on one thread; kernels are computed entry by entry."""
    one, *others = (runner(snapin, tmp_path / name)(text, threads=threads)
                    for name, threads in (("a", 1), ("b", 1), ("c", 2), ("d", 4))
                    if (tmp_path / name).mkdir() is None)
    assert one.cost["nodes"] < shared_from()
    for other in others:
        tables = [(run.folder / "curve.csv").read_bytes() for run in (one, other)]
        assert tables[0] == tables[1]
        for key in ("max_tension", "jump_in_h0", "jump_out_h0", "folds_h0"):
            assert several(other.summary.get(key)) == several(one.summary.get(key))


def shared_from():
    """Nodes from which on products and factors are shared between threads."""
    text = (ROOT / "src" / "system" / "machine.f90").read_text()
    return int(re.search(r":: worthwhile = (\d+)", text)[1])


@pytest.mark.long
@pytest.mark.parametrize(
    "scene", [lambda **groups: exponential(1.0, **groups),
              lambda **groups: lennard_jones(0.2, **groups)], ids=["repulsion", "adhesion"])
def test_threads_that_share_a_matrix_leave_eleven_digits(run, scene):
    """They add in another order. Solved to 1e-12, so that it is not the iteration that decides."""
    numerics = {
        "grid": "uniform", "nodes": shared_from(), "r_max": 20.0, "residual_tolerance": 1e-12}
    text = scene(loading=loading(3, 2, 1), numerics=numerics)
    one, two = (run(text, threads=threads) for threads in (1, 2))
    assert [one.cost["threads"], two.cost["threads"]] == [1, 2]
    for name in ("h0", "h_centre", "displacement", "load"):
        scale = abs(one.curve[name]).max()
        np.testing.assert_allclose(two.curve[name], one.curve[name], rtol=0, atol=1e-11 * scale)


def test_the_summary_records_what_made_it(run, snapin):
    summary = run(SCENES["repulsion"]).summary
    told = snapin("--version").stdout.splitlines()
    assert told[0] == f"snapin {summary['version']}"
    assert told[1:] == [
        f"compiler: {summary['compiler']}", f"blas: {summary['blas']}",
        f"options: {summary['build_options']}"]
    assert several(run(SCENES["repulsion"]).cost["threads"]) == [1]
