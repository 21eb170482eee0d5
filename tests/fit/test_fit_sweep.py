"""Fits of many curves: a row for each, whatever their files and however many are made at once."""

import os
import signal
import subprocess
import time

import numpy as np
import pytest
import snapin
from support.measured import (  # noqa: F401 (`branches` is a fixture)
    LENNARD_JONES, POINT, SPRING, STRENGTH, branches, fitted, write)

COUNT = 7
PARAMETERS = [STRENGTH, POINT]
NOISE = 1e-11


@pytest.fixture(scope="module")
def folder(branches, tmp_path_factory):  # noqa: F811
    """Curves in files of their own, all in one file, and what has no curve."""
    folder = tmp_path_factory.mktemp("curves")
    rows = ["number,z,force,segment"]
    for i in range(COUNT):
        curve = branches.measure(100, noise=NOISE, seed=i)
        write(folder / f"curve_{i}.csv", *curve)
        # The rows of one file, in which each curve has a number.
        rows += [f"{5 * i}," + ",".join(f"{x:.17g}" for x in sample) for sample in zip(*curve)]
    (folder / "all.csv").write_text("\n".join(rows) + "\n")
    (folder / "curve_broken.csv").write_text("z,force,segment\n1e-9,2e-9,here\n")
    flat = branches.measure(100, noise=NOISE, seed=99)
    noise = NOISE * np.random.default_rng(3).standard_normal(len(flat[0]))
    write(folder / "curve_flat.csv", flat[0], noise, flat[2])
    return folder


def deck(folder, sweep, **measurement):
    return {**LENNARD_JONES,
            "measurement": {"columns": ["z", "force", "segment"], "spring_constant": SPRING,
                            **measurement},
            "fit": {"parameters": PARAMETERS}, "sweep": sweep}


def run(groups, folder, out=None, *options, threads=1):
    """The rows of a sweep, whose deck is in the folder of the curves."""
    file = folder / f"{out or 'deck'}.nml"
    file.write_text(snapin.deck_text(groups))
    subprocess.run(
        [snapin.experiment._program(), "--quiet", "--into", folder / (out or "results"), *options,
         file], env=dict(os.environ, OMP_NUM_THREADS=str(threads)), check=False, timeout=300)
    return (folder / (out or "results") / "sweep.csv").read_bytes()


def table(folder, out):
    return snapin.read_results(folder / out).sweep


FILES = {"key": "measurement.file", "words": ["curve_*.csv"]}


@pytest.fixture(scope="module")
def swept(folder):
    run(deck(folder, FILES), folder, "files")
    return table(folder, "files")


def test_each_curve_has_a_row_with_the_numbers_of_its_own_fit(swept, folder):
    assert list(swept["measurement.file"]) == sorted(
        path.name for path in folder.glob("curve_*.csv"))
    for i in (0, COUNT - 1):
        alone = snapin.run(deck(folder, None, file=os.fspath(folder / f"curve_{i}.csv")))
        found, row = alone.fitted["fit"], swept[i]
        for k, name in enumerate(PARAMETERS):
            # The search may begin elsewhere; it ends at the same minimum.
            error = found["standard_error"][k]
            assert row[f"{name}_estimate"] == pytest.approx(found["estimate"][k], abs=0.02 * error)
            assert row[f"{name}_standard_error"] == pytest.approx(error, rel=0.02)
            for end in ("lower_95", "upper_95"):
                assert row[f"{name}_{end}"] == pytest.approx(found[end][k], abs=0.05 * error)
        assert row["chi_squared"] == pytest.approx(found["chi_squared"][0], rel=1e-3)
        assert row["fitted_work_of_adhesion"] == pytest.approx(
            found["work_of_adhesion"][0], rel=1e-3)
        assert row["verdict"] == "described" and row["failure"] == ""


def test_what_cannot_be_read_or_fitted_is_a_row_with_the_reason(swept):
    broken, flat = (swept[swept["measurement.file"] == f"curve_{name}.csv"][0]
                    for name in ("broken", "flat"))
    assert broken["verdict"] == "unreadable" and "curve_broken.csv" in broken["failure"]
    assert flat["verdict"] == "refused" and "no contact in the data" in flat["failure"]
    for row in (broken, flat):
        assert row["converged"] == 0 and np.isnan(row[f"{STRENGTH}_estimate"])
    assert (swept["converged"][:COUNT] == 1).all()


def test_the_first_warning_of_a_fit_is_in_its_row(folder):
    """The same curve with the deck's spring constant and with one a tenth larger."""
    (folder / "springs.csv").write_text(
        "measurement.file,measurement.spring_constant\n"
        f'"curve_0.csv",{SPRING}\n"curve_0.csv",{1.1 * SPRING}\n')
    run(deck(folder, {"file": "springs.csv"}), folder, "springs")
    right, wrong = table(folder, "springs")
    assert right["verdict"] == "described" and right["warning"] == ""
    assert wrong["verdict"] == "not_described"
    # That a value ends at the edge of the search comes before what the residuals say.
    assert f"{STRENGTH} ends at" in wrong["warning"]


@pytest.mark.parametrize("threads", [2, 4])
def test_the_bytes_do_not_depend_on_how_many_are_made_at_once(folder, swept, threads):
    one = (folder / "files/sweep.csv").read_bytes()
    assert run(deck(folder, FILES), folder, f"threads_{threads}", threads=threads) == one


def test_one_file_has_many_curves(folder, swept):
    sweep = {"key": "measurement.curve"}
    run(deck(folder, sweep, file="all.csv", curves="number"), folder, "one")
    rows = table(folder, "one")
    assert list(rows["measurement.curve"]) == [5 * i for i in range(COUNT)]
    for name in rows.dtype.names[1:-3]:
        np.testing.assert_allclose(rows[name], swept[name][:COUNT], rtol=1e-6, err_msg=name)
    alone = snapin.run(deck(folder, None, file=os.fspath(folder / "all.csv"), curves="number",
                            curve=15)).fitted["fit"]
    assert alone["estimate"][0] == pytest.approx(rows[f"{STRENGTH}_estimate"][3], rel=1e-3)


def test_a_table_of_cases_has_files_and_other_keys(folder):
    lines = ["measurement.file, bodies.radius, measurement.x",
             '"curve_1.csv", 50e-9, 0', "curve_2.csv, 55e-9, 1e-6", "missing.csv, 50e-9, 2e-6"]
    (folder / "cases.csv").write_text("\n".join(lines) + "\n")
    run(deck(folder, {"file": "cases.csv"}), folder, "table")
    rows = table(folder, "table")
    assert list(rows["measurement.file"]) == ["curve_1.csv", "curve_2.csv", "missing.csv"]
    assert list(rows["measurement.x"]) == [0, 1e-6, 2e-6]
    assert list(rows["verdict"][[0, 2]]) == ["described", "unreadable"]
    assert "no such file" in rows["failure"][2]
    larger = {**LENNARD_JONES, "bodies": {**LENNARD_JONES["bodies"], "radius": 55e-9}}
    alone = snapin.run({**deck(folder, None, file=os.fspath(folder / "curve_2.csv")), **larger})
    found = alone.fitted["fit"]
    assert rows[f"{STRENGTH}_estimate"][1] == pytest.approx(found["estimate"][0], rel=1e-3)
    assert found["estimate"][0] < 0.95 * rows[f"{STRENGTH}_estimate"][0]


def test_a_killed_sweep_goes_on_with_the_curves_that_are_left(folder, swept):
    groups = deck(folder, FILES)
    file = folder / "killed.nml"
    file.write_text(snapin.deck_text(groups))
    command = [snapin.experiment._program(), "--quiet", "--into", folder / "killed", file]
    with subprocess.Popen(command, env=dict(os.environ, OMP_NUM_THREADS="2")) as process:
        rows = folder / "killed/unfinished/sweep.csv"
        while process.poll() is None and not (
                rows.is_file() and rows.read_text().count("\ncurve_") >= 2):
            time.sleep(0.005)
        process.send_signal(signal.SIGKILL)
    # On a machine that pauses here it may have ended first.
    if process.returncode == -signal.SIGKILL:
        assert not (folder / "killed/sweep.csv").exists()
    one = (folder / "files/sweep.csv").read_bytes()
    assert run(groups, folder, "killed", "--resume", threads=2) == one


@pytest.mark.parametrize(("changed", "told"), [
    ({"sweep": {"key": "measurement.file", "words": ["none_*.csv"]}}, "no file is like"),
    ({"sweep": {"key": "measurement.file"}}, "holds a text"),
    ({"sweep": {"key": "force.z0", "values": [3e-10]}}, "the file of the curve"),
    ({"sweep": {"key": "measurement.curve"}}, "give file and curves"),
    ({"sweep": {"key": "measurement.file", "words": ["a.csv", "b.csv"], "costs": True}},
     "not of fits"),
])
def test_a_sweep_that_cannot_be_made_is_refused(folder, changed, told):
    with pytest.raises(snapin.DeckError, match=told):
        snapin.run({**deck(folder, None), **changed})


def test_a_check_counts_the_curves(folder):
    file = folder / "check.nml"
    file.write_text(snapin.deck_text(deck(folder, FILES)))
    done = subprocess.run([snapin.experiment._program(), "--check", file], capture_output=True,
                          text=True, check=True, timeout=60)
    assert f"{COUNT + 2} curves" in done.stderr


def test_no_curve_starts_before_the_first_that_is_described(folder, swept):
    """Where the first are refused, the bytes do not depend on the number of processes either."""
    names = ["curve_broken.csv", *["curve_flat.csv"] * 3, *(f"curve_{i}.csv" for i in range(4))]
    groups = deck(folder, {"key": "measurement.file", "words": names})
    one = run(groups, folder, "late_1")
    assert run(groups, folder, "late_4", threads=4) == one
    rows = table(folder, "late_1")
    assert list(rows["verdict"][3:]) == ["refused", *["described"] * 4]


def test_rows_of_a_curve_that_are_not_together_are_refused(folder):
    lines = (folder / "all.csv").read_text().splitlines()
    (folder / "mixed.csv").write_text("\n".join([*lines, lines[1]]) + "\n")
    with pytest.raises(snapin.DeckError, match="rows of curve 0 are not together"):
        snapin.run(deck(folder, {"key": "measurement.curve"}, file=os.fspath(folder / "mixed.csv"),
                        curves="number"))


def test_a_process_that_is_killed_ends_the_sweep_which_can_go_on(folder, swept):
    file = folder / "lost.nml"
    file.write_text(snapin.deck_text(deck(folder, FILES)))
    command = [snapin.experiment._program(), "--into", folder / "lost", file]
    with subprocess.Popen(command, env=dict(os.environ, OMP_NUM_THREADS="2"),
                          stderr=subprocess.PIPE, text=True) as process:
        children = []
        while process.poll() is None and len(children) < 2:
            listed = f"/proc/{process.pid}/task/{process.pid}/children"
            with open(listed, encoding="ascii") as of_process:
                children = of_process.read().split()
        os.kill(int(children[0]), signal.SIGKILL)
        said = process.communicate(timeout=300)[1]
    assert process.returncode == 1
    assert "a process that fitted curves has been ended" in said and "--resume" in said
    one = (folder / "files/sweep.csv").read_bytes()
    assert run(deck(folder, FILES), folder, "lost", "--resume", threads=2) == one
