"""`snapin --price`: the deck at five accuracies, as a table."""

import re
import subprocess

import pytest
from conftest import ROOT
from support.processes import HANG
from support.scenes import deck, exponential, lennard_jones, loading

CYCLE = {"loading": loading(7, -2, 0.5), "unloading": {"from_": [-2.0], "h0_end": 7.0}}
WEAK = {"bodies": {"radius": 1.0, "stiffness": 1.0},
        "force": {"law": "exponential", "p0": 1.0, "decay_length": 1.0}}


@pytest.fixture
def priced(snapin, tmp_path):
    """priced(text, option, ...) -> the process, whose folder has nothing but the deck after it."""

    def run(text, *options):
        (tmp_path / "d.nml").write_text(text)
        done = snapin("--price", *options, "d.nml", cwd=tmp_path)
        assert [path.name for path in tmp_path.iterdir()] == ["d.nml"]
        return done

    return run


def rows_of(text):
    """The cells of the table by the names of its columns."""
    head, *lines = (re.split(r" {2,}", line.strip()) for line in text.splitlines()[1:])
    return [dict(zip(head, line)) for line in lines if re.match(r"[\de.-]+$", line[0])]


def sentences_of(text):
    return [line for line in text.splitlines() if " is enough for " in line]


def test_five_accuracies_of_a_cycle_with_the_estimates_of_runs(priced, run):
    """The error of a row is the error_estimate of the deck with this accuracy, and so on."""
    done = priced(lennard_jones(0.87, **CYCLE))
    assert (done.returncode, done.stderr) == (0, "")
    rows = rows_of(done.stdout)
    assert [float(row["accuracy"]) for row in rows] == [1e-3, 1e-4, 1e-6, 1e-8, 1e-10]
    for row in rows[::2]:
        alone = run(lennard_jones(
            0.87, numerics={"accuracy": float(row["accuracy"])}, **CYCLE))
        assert int(row["nodes"]) == alone.cost["nodes"]
        assert int(row["states"]) == alone.cost["states"]
        assert float(row["error"]) == pytest.approx(alone.summary["error_estimate"], rel=0.1)
        for name, key in (("pull-off", "max_tension"), ("jump in", "jump_in_h0"),
                          ("end load", "end_load")):
            scale = max(abs(alone.summary[key]), 1.0 if key.endswith("h0") else 0.0)
            assert float(row[name]) == pytest.approx(
                alone.summary[key + "_error"] / scale, rel=0.1)
    assert all(re.fullmatch(r"[\d.e-]+ m?s", row["time"]) for row in rows)


def test_a_sentence_names_the_cheapest_accuracy_that_is_enough(priced):
    done = priced(lennard_jones(0.87, **CYCLE))
    rows = {row["accuracy"]: row for row in rows_of(done.stdout)}
    found = [re.match(r"accuracy = (\S+) is enough for (.*): (.*)$", line).groups()
             for line in sentences_of(done.stdout)]
    assert [purpose for _, purpose, _ in found] == ["errors of 0.1 %", "six digits", "nine digits"]
    for (accuracy, _, time), aim in zip(found, (1e-3, 1e-6, 1e-9)):
        assert rows[accuracy]["time"] == time
        below = [row for row in rows.values() if float(row["error"]) <= aim]
        assert below[0]["accuracy"] == accuracy
    assert re.search(r"^each further digit costs \S+ m?s, a factor of \S+$", done.stdout, re.M)


def test_a_uniform_grid_has_rows_up_to_its_own_number_of_nodes(priced):
    done = priced(exponential(1.0, loading=loading(3, 0, 1.0), numerics={
        "grid": "uniform", "nodes": 80}))
    rows = rows_of(done.stdout)
    assert done.returncode == 0, done.stdout
    assert [[*row][0] for row in rows] == ["nodes"] * 5
    assert [int(float(row["nodes"])) for row in rows] == [20, 28, 40, 57, 80]
    assert float(rows[-1]["error"]) < float(rows[0]["error"]) / 4


def test_a_drive_has_rows_up_to_its_own_accuracy(priced):
    done = priced(deck(
        **WEAK, viscoelastic={"stiffness_relaxed": 0.5, "retardation_time": 1.0},
        drive={"velocity": 1.0, "z_start": 4.0, "z_turn": 1.0}, numerics={"accuracy": 1e-2}))
    rows = rows_of(done.stdout)
    assert done.returncode == 0, done.stdout
    accuracies = [float(row["accuracy"]) for row in rows]
    assert accuracies[0] == 0.1 and accuracies[-1] == 0.01
    assert accuracies == sorted(accuracies, reverse=True) and len({*accuracies}) == 5


def test_an_accuracy_that_fails_says_so_in_its_row(priced):
    """The others are shown all the same, and the exit status is that of a failed calculation."""
    # On the second of the grids the edge is caught between two nodes; the others converge. The
    # failure of a case was its first warning, whatever that was.
    done = priced(lennard_jones(0.87, loading=loading(8, 2, 1.0), numerics={
        "method": "mixing", "nodes": 150, "max_iterations": 2000}))
    assert done.returncode == 1
    lines = done.stdout.splitlines()
    failed = [i for i, line in enumerate(lines) if line.startswith("    failed: ")]
    assert len(rows_of(done.stdout)) == 5 and 0 < len(failed) < 5
    for i in failed:
        assert "did not converge" in lines[i] and re.match(r"\d", lines[i - 1])
        nodes = lines[i - 1].split()[0]
        assert not any(f"nodes = {nodes} is" in line for line in sentences_of(done.stdout))
    assert "no row has an estimated error below 1 %" in done.stdout


@pytest.mark.parametrize("groups, phrase", [
    ({"equilibrium_path": {"h0_end": 0.0}, "sweep": {"key": "force.z0", "values": [1.0, 1.1]}},
     "has &sweep; costs = .true. in &sweep measures each case"),
    ({"bodies": {"radius": 1.0, "rigid": True}, **CYCLE}, "the bodies are rigid"),
    ({"classical": {"h0_start": 3.0, "h0_end": 0.0}},
     "nothing in this deck depends on the accuracy"),
])
def test_decks_without_such_a_table_are_refused_as_wrong(priced, groups, phrase):
    done = priced(lennard_jones(0.87, **groups))
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("d.nml: ") and phrase in done.stderr


def test_a_fit_is_refused(snapin, tmp_path):
    done = snapin("--price", ROOT / "inputs/examples/fit.nml", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert "has &fit" in done.stderr and [*tmp_path.iterdir()] == []


def test_a_wrong_deck_is_refused_as_by_a_run(priced):
    done = priced(lennard_jones(0.87, **CYCLE).replace("h0_step", "h0_stepp"))
    assert (done.returncode, done.stdout) == (2, "")
    assert "h0_stepp" in done.stderr


def test_several_decks_and_standard_input_each_have_a_table(snapin, tmp_path):
    text = exponential(1.0, loading=loading(3, 0, 1.0))
    (tmp_path / "a.nml").write_text(text)
    (tmp_path / "a.txt").write_text(text)
    done = snapin("--price", "--quiet", "a.nml", "-", "a.txt", cwd=tmp_path, input=text)
    assert (done.returncode, done.stderr) == (0, "")
    # Two decks of one stem are no mistake where nothing is written.
    assert re.findall(r"^(\S+): processor time", done.stdout, re.M) == ["a.nml", "deck", "a.txt"]


def test_a_table_that_standard_output_does_not_take_is_a_failure(snapin_path, tmp_path):
    """A full disk behind a redirection ended with status 0, and a table that was cut."""
    (tmp_path / "d.nml").write_text(exponential(1.0, loading=loading(3, 0, 1.0)))
    with open("/dev/full", "w", encoding="utf-8") as full:
        done = subprocess.run([snapin_path, "--price", "--quiet", "d.nml"], cwd=tmp_path,
                              stdout=full, stderr=subprocess.PIPE, text=True, timeout=HANG,
                              check=False)
    assert done.returncode == 1
    assert done.stderr.startswith("d.nml: cannot write to standard output: ")


def test_a_pressed_repulsion_has_no_columns_of_jumps(priced):
    done = priced(exponential(1.0, loading=loading(3, 0, 1.0)))
    head = done.stdout.splitlines()[1]
    assert "end load" in head and "jump" not in head and "pull-off" not in head


def test_of_several_processes_the_first_makes_the_table(priced, monkeypatch):
    monkeypatch.setenv("OMPI_COMM_WORLD_SIZE", "2")
    monkeypatch.setenv("OMPI_COMM_WORLD_RANK", "1")
    done = priced(lennard_jones(0.87, **CYCLE))
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
