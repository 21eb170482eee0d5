"""costs.csv: what each case of a sweep costs."""

import numpy as np
import pytest
from conftest import ROOT
from support.decks import RUNTIME_ERROR
from support.interrupted import Bench, frames, rows
from support.scenes import lennard_jones, loading, read_table, several

CYCLE = {"loading": loading(7, -2, 0.5), "unloading": {"from_": [-2.0, 2.5], "h0_end": 7.0}}
ACCURACIES = [1e-3, 1e-6, 1e-9]
WORK = ["nodes", "states", "iterations", "operator_products", "factorisations"]


def swept(key="numerics.accuracy", values=ACCURACIES, **groups):
    sweep = {"key": key, "values": values, **groups.pop("sweep", {})}
    return lennard_jones(0.87, **CYCLE, sweep=sweep, **groups)


@pytest.fixture(scope="module")
def costs(run):
    """The costs of a cycle at three accuracies."""
    return run(swept()).table("costs.csv")


def test_time_and_work_of_each_case_are_those_of_the_deck_alone(run, costs):
    assert costs.names[:11] == ["numerics.accuracy", "seconds", "kernel_seconds", "solve_seconds",
                                "estimate_seconds", *WORK, "error_estimate"]
    for i, accuracy in enumerate(ACCURACIES):
        alone = run(lennard_jones(0.87, **CYCLE, numerics={"accuracy": accuracy}))
        assert costs["numerics.accuracy"][i] == accuracy
        for name in WORK:
            assert costs[name][i] == alone.cost[name], name
        assert costs["error_estimate"][i] == pytest.approx(
            alone.summary["error_estimate"], rel=0.01)
        assert 0 < costs["seconds"][i] < 10
        assert 0 < costs["kernel_seconds"][i] < 10


def test_the_error_of_each_number_is_that_of_the_deck_alone(run, costs):
    table = run(swept()).table("sweep.csv")
    errors = costs.names[11:]
    assert {"max_tension_error", "jump_in_h0_error", "energy_lost_uncertainty", "end_load_error",
            "unload_max_tension_1_error", "unload_max_tension_2_error"} <= {*errors}
    alone = run(lennard_jones(0.87, **CYCLE, numerics={"accuracy": 1e-3})).summary
    for name in errors:
        number = name.replace("_error", "").replace("_uncertainty", "")
        assert number in table.names
        stem, _, turn = number.rpartition("_")
        key = name if name in alone else name.replace(f"_{turn}_error", "_error")
        expected = np.nan
        if key in alone:
            expected = several(alone[key])[int(turn) - 1 if key != name else 0]
        assert costs[name][0] == pytest.approx(expected, rel=0.01, nan_ok=True), name


def test_sweep_csv_has_the_same_bytes_with_and_without_costs(run):
    """Measured cases have meshes of their own."""
    files = [(run(swept(sweep={"costs": wanted})).folder / "sweep.csv").read_bytes()
             for wanted in (True, False)]
    assert files[0] == files[1]


@pytest.mark.parametrize("key, values, costs, there", [
    ("force.z0", [1.0, 1.1], None, False), ("force.z0", [1.0, 1.1], True, True),
    ("numerics.anderson_depth", [3, 5], None, True),
    ("Numerics.Accuracy", [1e-3, 1e-6], False, False),
])
def test_costs_are_measured_where_numerics_vary_or_they_are_asked_for(
        run, key, values, costs, there):
    sweep = {} if costs is None else {"costs": costs}
    found = run(swept(key, values, sweep=sweep))
    assert (found.folder / "costs.csv").exists() == there
    assert (found.folder / "sweep.csv").exists()


def test_the_cases_of_a_file_and_words_have_costs_too(snapin, tmp_path):
    (tmp_path / "cases.csv").write_text("numerics.method,numerics.accuracy\nnewton,1e-3\n"
                                        "anderson,1e-6\n")
    (tmp_path / "d.nml").write_text(
        lennard_jones(0.87, **CYCLE, sweep={"file": "cases.csv"}))
    done = snapin("--quiet", "--out", ".", "d.nml", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    table = read_table(tmp_path / "d" / "costs.csv")
    assert list(table["numerics.method"]) == ["newton", "anderson"]
    assert table["factorisations"][0] > table["factorisations"][1]


def test_a_failed_case_has_a_row_without_errors(run):
    found = run(swept("numerics.max_iterations", [1, 20000]), status=1)
    table = found.table("costs.csv")
    assert len(table) == 2
    assert table["seconds"][0] > 0 and np.isfinite(table["max_tension_error"][1])


def test_costs_are_there_after_an_interruption(snapin, snapin_path, tmp_path):
    """Complete cases keep their measured times."""
    sweep = Bench(snapin, snapin_path, tmp_path, swept())
    assert sweep.resume(b"".join(frames(sweep.journal)[:3])).returncode == 0
    assert rows(sweep.files("cut")["sweep.csv"]) == rows(sweep.whole["sweep.csv"])
    measured = [line.split(b",") for line in rows(sweep.files("cut")["costs.csv"])]
    first = [line.split(b",") for line in rows(sweep.whole["costs.csv"])]
    assert [line[5:10] for line in measured] == [line[5:10] for line in first]


@pytest.mark.parametrize("value", ["1", "'yes'", "maybe", ""])
def test_a_wrong_word_for_costs_is_refused(check, value):
    status, _, said = check(swept(sweep={"costs": True}).replace(
        "costs = .true.", f"costs = {value}"))
    assert status == 2 and "d.nml:" in said and "costs" in said
    assert not RUNTIME_ERROR.search(said)


def test_an_accuracy_above_the_coarsest_is_told_to_cost_no_less(run):
    """Decks with 1e-2 were computed on the meshes of 1e-3 without a word."""
    def notes(accuracy, **groups):
        groups = groups or CYCLE
        found = run(lennard_jones(0.87, **groups, numerics={"accuracy": accuracy}))
        return [text for text in several(found.summary.get("notes", [])) if "costs no less" in text]

    assert len(notes(1e-2)) == 1 and "accuracy = 0.01" in notes(1e-2)[0]
    assert notes(1e-3) == []
    drive = {"drive": {"velocity": 1.0, "z_start": 6.0, "z_turn": 4.0},
             "viscoelastic": {"stiffness_relaxed": 0.5, "retardation_time": 1.0}}
    assert notes(1e-2, **drive) == []


@pytest.mark.parametrize("name", ["accuracy", "accuracy_paper"])
def test_the_decks_of_accuracy_are_valid(snapin, name):
    assert snapin("--check", ROOT / "inputs" / f"{name}.nml").returncode == 0
