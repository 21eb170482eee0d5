"""Claims about what is said of a run before it begins, and about runs that do not fit."""

import re
import shutil

import pytest
from conftest import ROOT
from support.processes import limited
from support.scenes import lennard_jones, loading

SMALL = lennard_jones(1.0, loading=loading(6, 4, 1), numerics={"grid": "uniform", "nodes": 100})
LARGE = SMALL.replace("nodes = 100", "nodes = 20000")
# Two gigabytes of addresses.
LITTLE = limited("AS", 2 * 1024**3)


def test_what_does_not_fit_leaves_older_results_and_can_be_resumed(snapin, tmp_path):
    deck = tmp_path / "d.nml"
    deck.write_text(SMALL)
    assert snapin("d.nml", cwd=tmp_path).returncode == 0
    before = {path: path.read_bytes() for path in (tmp_path / "results").rglob("*")
              if path.is_file()}
    deck.write_text(LARGE)
    for options in ((), ("--resume",)):
        refused = snapin(*options, "d.nml", cwd=tmp_path, preexec_fn=LITTLE)
        assert refused.returncode == 1
        assert "not computed: matrices for 20000 nodes need" in refused.stderr
        after = {path: path.read_bytes() for path in (tmp_path / "results").rglob("*")
                 if path.is_file()}
        assert after == before
    # With the room, which a smaller deck stands for, the run is made, not "complete".
    deck.write_text(SMALL.replace("nodes = 100", "nodes = 110"))
    done = snapin("--resume", "d.nml", cwd=tmp_path)
    assert done.returncode == 0 and "nothing to do" not in done.stderr


@pytest.mark.parametrize("deck", [
    LARGE, SMALL + "&sweep key = 'numerics.nodes', values = 100, 20000 /\n"],
    ids=["run", "last case of a sweep"])
def test_what_does_not_fit_makes_no_folder(snapin, tmp_path, deck):
    (tmp_path / "d.nml").write_text(deck)
    refused = snapin("d.nml", cwd=tmp_path, preexec_fn=LITTLE)
    assert refused.returncode == 1 and "20000 nodes need" in refused.stderr
    assert not (tmp_path / "results").exists()


def test_check_says_what_does_not_fit_and_what_fills_the_disk(snapin, tmp_path):
    (tmp_path / "large.nml").write_text(LARGE)
    (tmp_path / "long.nml").write_text(
        lennard_jones(0.87, loading=loading(4, -2, 1e-6), unloading={}))
    (tmp_path / "short.nml").write_text(SMALL)
    done = snapin("--check", "large.nml", "long.nml", "short.nml", cwd=tmp_path, preexec_fn=LITTLE)
    assert done.returncode == 0
    assert "large.nml: not computed: matrices for 20000 nodes" in done.stderr
    size = re.search(r"long\.nml: its results take about ([\d.]+) GB on the disk", done.stderr)
    # 12 million rows of some 250 bytes.
    assert 2 < float(size[1]) < 4
    assert "short.nml" not in done.stderr


@pytest.mark.long
def test_whatever_takes_long_says_so_and_goes_on_saying_so(snapin, tmp_path):
    """Each of hundreds of states needs factors of a matrix for 4000 nodes, which take seconds."""
    numerics = {"grid": "uniform", "nodes": 4000, "method": "newton"}
    (tmp_path / "d.nml").write_text(
        lennard_jones(0.87, loading=loading(8, -4, 0.02), numerics=numerics))
    with pytest.raises(Exception) as ended:
        snapin("d.nml", cwd=tmp_path, timeout=6)
    said = (ended.value.stderr or b"").decode()
    assert re.search(r"^d: .*, [56] s so far$", said, re.M)


@pytest.mark.parametrize("table", ["curve.csv", "deeper/sweep.csv"])
def test_a_run_does_not_replace_what_its_deck_reads(snapin, tmp_path, table):
    """With --into, or where a deck is in the folder of its results, the deck or its table of cases
    was lost."""
    swept = lennard_jones(1.0, equilibrium_path={"h0_end": 2}, sweep={"file": table})
    folder = tmp_path / "deeper"
    folder.mkdir()
    (tmp_path / table).write_text("force.hamaker\n1e-19\n")
    (tmp_path / "deeper.nml").write_text(swept)
    (folder / "fit.nml").write_text(SMALL)
    (folder / "summary.nml").write_text(SMALL)
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    into = (tmp_path / table).parent
    for args in (("--into", into, "deeper.nml"), ("--check", "--into", into, "deeper.nml"),
                 ("--into", folder, folder / "../deeper/fit.nml"),
                 ("--into", folder, folder / "summary.nml")):
        done = snapin(*args, cwd=tmp_path)
        assert done.returncode == 2
        assert re.search(r"nml: results would replace .*, which the deck reads", done.stderr)
    assert before == {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}


@pytest.mark.parametrize("name", ["profile", "tabulated", "fit"])
def test_every_file_that_a_deck_names_is_seen(snapin, tmp_path, name):
    deck = (ROOT / f"inputs/examples/{name}.nml").read_text()
    (file,) = re.findall("file = '(.*?)'", deck)
    shutil.copy(ROOT / "inputs/examples" / file, tmp_path / "curve.csv")
    (tmp_path / "d.nml").write_text(deck.replace(file, "curve.csv"))
    done = snapin("--check", "--into", tmp_path, "d.nml", cwd=tmp_path)
    assert done.returncode == 2
    assert re.search(r"results would replace \S*curve.csv, which the deck reads", done.stderr)


def test_a_summary_may_be_run_again_in_its_folder(snapin, tmp_path):
    (tmp_path / "d.nml").write_text(SMALL)
    for deck in ("d.nml", "d/summary.nml"):
        done = snapin("--into", "d", deck, cwd=tmp_path)
        assert done.returncode == 0, done.stderr
