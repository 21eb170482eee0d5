"""Claims about files that decks name: results say where they are and what was in them."""

import shutil

import numpy as np
import pytest
from support.interrupted import Bench
from support.scenes import deck, loading

R = np.linspace(0, 6, 40)
GAP = np.geomspace(0.4, 60, 90)
LENNARD_JONES = {"law": "lennard_jones", "hamaker": 10.0, "z0": 1.0}
PATH = {"h0_end": -1.0}
# A deck with a file, what is in it, and what may be there instead.
SCENES = {
    "table": (
        {"bodies": {"radius": 1.0, "stiffness": 1.0},
         "tabulated": {"file": "data/points.txt", "tail_exponent": 3}},
        (GAP, 0.5 * (GAP**-9 - GAP**-3)), (GAP, 0.6 * (GAP**-9 - GAP**-3)),
    ),
    "profile": (
        {"bodies": {"stiffness": 1.0}, "force": LENNARD_JONES,
         "shape": {"kind": "profile", "file": "data/points.txt"}},
        (R, R**2 / 2), (R, R**2 / 2.2),
    ),
}
every_scene = pytest.mark.parametrize("scene", SCENES)


def lay_out(folder, scene, **groups):
    """Write the file of a scene below `folder`; return the text of its deck."""
    keys, points, _ = SCENES[scene]
    (folder / "data").mkdir(parents=True, exist_ok=True)
    np.savetxt(folder / "data" / "points.txt", np.column_stack(points))
    return deck(**keys, **groups)


def change(folder, scene):
    np.savetxt(folder / "data" / "points.txt", np.column_stack(SCENES[scene][2]))


def load(folder):
    """The bytes of the curve."""
    return (folder / "curve.csv").read_bytes()


@every_scene
def test_a_summary_runs_again_wherever_it_is(snapin, tmp_path, scene):
    home, other = tmp_path / "home", tmp_path / "other"
    home.mkdir()
    (home / "deck.nml").write_text(lay_out(home, scene, equilibrium_path=PATH))
    other.mkdir()
    assert snapin("--out", "one", "home/deck.nml", cwd=tmp_path).returncode == 0
    shutil.copy(tmp_path / "one/deck/summary.nml", other / "deck.nml")
    for again, name in (("one/deck/summary.nml", "summary"), ("other/deck.nml", "deck")):
        done = snapin("--out", "two", again, cwd=tmp_path)
        assert done.returncode == 0, done.stderr
        assert load(tmp_path / "two" / name) == load(tmp_path / "one/deck")


@every_scene
def test_finished_results_of_another_file_are_not_taken_for_these(snapin, tmp_path, scene):
    (tmp_path / "deck.nml").write_text(lay_out(tmp_path, scene, equilibrium_path=PATH))
    results = tmp_path / "results/deck"
    assert snapin("deck.nml", cwd=tmp_path).returncode == 0
    before = load(results)
    lay_out(tmp_path, scene)
    assert "nothing to do" in snapin("--resume", "deck.nml", cwd=tmp_path).stderr
    change(tmp_path, scene)
    done = snapin("--resume", "deck.nml", cwd=tmp_path)
    assert done.returncode == 0 and "nothing to do" not in done.stderr
    changed = load(results)
    assert changed != before
    assert snapin("deck.nml", cwd=tmp_path).returncode == 0
    assert load(results) == changed


@every_scene
def test_an_interrupted_run_does_not_go_on_with_another_file(snapin, snapin_path, tmp_path, scene):
    text = lay_out(tmp_path, scene, loading=loading(5, -1, 0.5),
                   sweep={"key": "bodies.stiffness", "values": [1.0, 1.5, 2.0]})
    bench = Bench(snapin, snapin_path, tmp_path, text)
    bench.check(bench.journal)
    change(tmp_path, scene)
    done = bench.resume(bench.journal)
    assert done.returncode == 1
    assert "cannot continue" in done.stderr and "checksum" in done.stderr
    assert "points.txt" in done.stderr
    lay_out(tmp_path, scene)
    bench.check(bench.journal)
