"""Claims about files in a folder of results that no run has written: they are never touched."""

import os
import shutil
import subprocess
import time

import pytest
from support.scenes import deck, loading

RIGID = deck(bodies={"radius": 1.0, "rigid": True},
             force={"law": "lennard_jones", "hamaker": 50.0, "z0": 1.0},
             loading=loading(5, 1, 0.5))
# Every name that a run may write or remove.
NAMES = ["curve.csv", "profiles.csv", "approximations.csv", "classical.csv", "device.csv",
         "device_jumps.csv", "fixed_load.csv", "table.csv", "sensitivity.csv",
         "curve_sensitivity.csv", "fit.csv", "fit.nml", "sweep.csv", "costs.csv", "summary.nml"]
MINE = "z,force\n1,2\n"


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "d.nml").write_text(RIGID)
    (tmp_path / "mine").mkdir()
    return tmp_path


def contents(folder):
    """Everything below a folder: links as links, files with contents and time."""
    return {str(path.relative_to(folder)): os.readlink(path) if path.is_symlink() else
            (path.read_bytes(), path.stat().st_mtime_ns) if path.is_file() else "no file"
            for path in folder.rglob("*")}


def refused(snapin, folder, name, *words):
    """The run ends before it begins, says what is in the way, and leaves everything alone."""
    before = contents(folder / "mine")
    for option in [(), ("--resume",), ("--check",)]:
        done = snapin("--into", "mine", *option, "d.nml", cwd=folder)
        assert done.returncode == 2, (option, done.stderr)
        assert f"d.nml: mine/{name} " in done.stderr
        assert all(word in done.stderr for word in (*words, "move it away"))
        assert contents(folder / "mine") == before


@pytest.mark.parametrize("name", NAMES)
def test_a_file_of_one_s_own_is_never_replaced_or_removed(snapin, folder, name):
    """Measured data called table.csv or curve.csv were deleted, with status 0."""
    (folder / "mine" / name).write_text(MINE)
    refused(snapin, folder, name, "was not written by this program")


@pytest.mark.parametrize("name", [*NAMES, "journal"])
def test_a_file_of_one_s_own_among_unfinished_ones_is_not_touched(snapin, folder, name):
    (folder / "mine/unfinished").mkdir()
    (folder / "mine/unfinished" / name).write_text(MINE)
    refused(snapin, folder, f"unfinished/{name}", "was not written by this program")


@pytest.mark.parametrize("name", ["summary.nml", "fit.nml"])
def test_a_deck_with_the_name_of_a_result_is_not_replaced(snapin, folder, name):
    """A deck of a fit has the group &fit, as fit.nml has."""
    (folder / "mine" / name).write_text(RIGID + "&fit parameters = 'force.z0' /\n")
    refused(snapin, folder, name, "was not written by this program")


@pytest.mark.parametrize("name", ["curve.csv", "fit.nml", "summary.nml", "unfinished"])
@pytest.mark.parametrize("kind", ["folder", "empty", "link", "lost link", "pipe"])
def test_whatever_has_the_name_of_a_result_stays(snapin, folder, name, kind):
    place = folder / "mine" / name
    words = {"folder": "is a folder", "empty": "was not written by this program"}.get(
        kind, "is not a file but a link")
    if (name, kind) == ("unfinished", "folder"):
        pytest.skip("this is the folder itself")
    (folder / "elsewhere.csv").write_text("# title: a result elsewhere\n")
    if kind == "folder":
        place.mkdir()
    elif kind == "empty":
        place.touch()
    elif kind == "pipe":
        os.mkfifo(place)
    else:
        place.symlink_to(folder / ("elsewhere.csv" if kind == "link" else "nowhere"))
    refused(snapin, folder, name, words)
    assert (folder / "elsewhere.csv").read_text() == "# title: a result elsewhere\n"


def test_a_file_that_cannot_be_read_stays(snapin, folder):
    if os.geteuid() == 0:
        pytest.skip("this user may read everything")
    (folder / "mine/curve.csv").write_text(MINE)
    (folder / "mine/curve.csv").chmod(0)
    done = snapin("--into", "mine", "d.nml", cwd=folder)
    assert done.returncode == 2 and "mine/curve.csv cannot be read" in done.stderr


@pytest.mark.parametrize("name", ["summary.nml.partial", "curve.csv.partial", "journal.partial",
                                  "INCOMPLETE.txt", "unfinished.nml", "journal", "notes.csv"])
def test_files_of_other_names_stay_beside_the_results(snapin, folder, name):
    """A deck called summary.nml.partial was destroyed by its own run."""
    shutil.copy(folder / "d.nml", folder / "mine" / name)
    done = snapin("--into", "mine", f"mine/{name}", cwd=folder)
    assert done.returncode == 0, done.stderr
    assert (folder / "mine" / name).read_text() == RIGID
    assert sorted(os.listdir(folder / "mine")) == sorted(["curve.csv", "summary.nml", name])


def test_a_file_among_the_unfinished_ones_of_a_killed_run_stays(snapin, folder):
    (folder / "mine/unfinished").mkdir()
    (folder / "mine/unfinished/curve.csv").write_text("# tit")
    (folder / "mine/unfinished/notes.txt").write_text(MINE)
    assert snapin("--into", "mine", "d.nml", cwd=folder).returncode == 0
    assert contents(folder / "mine").keys() == {
        "curve.csv", "summary.nml", "unfinished", "unfinished/notes.txt"}


@pytest.mark.parametrize("version", ["0.0.1", "0.1.0"])
def test_results_of_an_older_version_are_replaced(snapin, folder, version):
    (folder / "mine/summary.nml").write_text(f"&summary\n  version = '{version}'\n/\n&cost\n/\n")
    for name in ("curve.csv", "sweep.csv"):
        (folder / "mine" / name).write_text(f"# title: x\n# version: snapin {version}\na\n1\n")
    (folder / "mine/fit.nml").write_text("! A fit by snapin, SI units.\n&fit\n/\n")
    done = snapin("--into", "mine", "d.nml", cwd=folder)
    assert done.returncode == 0, done.stderr
    assert sorted(os.listdir(folder / "mine")) == ["curve.csv", "summary.nml"]


@pytest.mark.slow
def test_a_file_that_appears_during_the_run_stays(snapin_path, snapin, folder):
    """The results then stay among the unfinished ones, and are there when the file is away."""
    name = "mine/profiles.csv"
    (folder / "d.nml").write_text(RIGID.replace("h0_step = 0.5", "h0_step = 2e-6"))
    with subprocess.Popen([snapin_path, "--into", "mine", "d.nml"], cwd=folder,
                          stderr=subprocess.PIPE, text=True) as run:
        while not (folder / "mine/unfinished/curve.csv").exists():
            assert run.poll() is None
            time.sleep(0.001)
        (folder / name).write_text(MINE)
        said = run.communicate()[1]
    assert run.returncode == 1
    assert f"no results were replaced: {name} was not written by this program" in said
    assert (folder / name).read_text() == MINE
    assert sorted(os.listdir(folder / "mine")) == ["profiles.csv", "unfinished"]
    (folder / name).unlink()
    assert snapin("--resume", "--into", "mine", "d.nml", cwd=folder).returncode == 0
    assert sorted(os.listdir(folder / "mine")) == ["curve.csv", "summary.nml"]


def test_several_decks_are_refused_before_the_first_is_computed(snapin, folder):
    shutil.copy(folder / "d.nml", folder / "e.nml")
    (folder / "results/e").mkdir(parents=True)
    (folder / "results/e/fit.csv").write_text(MINE)
    done = snapin("d.nml", "e.nml", cwd=folder)
    assert done.returncode == 2 and "e.nml: results/e/fit.csv was not" in done.stderr
    assert not (folder / "results/d").exists()
