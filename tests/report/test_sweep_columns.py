"""What a sweep leaves of each case: the scalars of its summary, in columns that follow the deck."""

import math
import re

import numpy as np
import pytest
from support.scenes import deck, exponential, lennard_jones, loading, several

JUMPS = ["jump_criterion_29", "jump_equation_37", "fold_closed_form", "fold_attractive_only"]
OF_UNLOADINGS = ("unload_max_tension", "unload_max_tension_at_end", "unload_jump_out_h0")
OF_APPROXIMATIONS = [f"{name}_{what}" for name in JUMPS for what in ("h0", "load")]
OF_APPROXIMATIONS.insert(4, "jump_equation_37_gap")
END = ["end_h0", "end_displacement", "end_load"]
TURNING = [-2.0, 2.5]


def adhesive(sigma=0.87, **groups):
    """A cycle with two turning points."""
    return lennard_jones(
        sigma, loading=loading(7, -2, 0.5), unloading={"from_": TURNING, "h0_end": 7.0}, **groups)


def hamaker(sigma):
    return 16 * math.pi * sigma


SIGMAS = [0.02, 0.3, 0.87]


@pytest.fixture(scope="module")
def table(run):
    """A sweep over sigma with everything that has columns of its own."""
    values = [hamaker(sigma) for sigma in SIGMAS]
    sweep = {"key": "force.hamaker", "values": values}
    return run(adhesive(approximations={}, classical={}, sweep=sweep)).table("sweep.csv")


def test_every_number_of_a_row_is_that_of_the_same_deck_alone(run, table):
    # A case differs from the deck alone in nothing but the threads.
    for row, sigma in enumerate(SIGMAS):
        summary = run(adhesive(sigma, approximations={}, classical={})).summary
        for name in table.names[1:-1]:
            value = table[name][row]
            key, _, turn = name.rpartition("_")
            if key in OF_UNLOADINGS:
                values = several(summary.get(key, math.nan))
                expected = values[min(int(turn), len(values)) - 1]
            elif name in ("resolved", "converged", "max_tension_at_end"):
                expected = 1.0 if summary[name] else 0.0
            else:
                expected = summary.get(name, math.nan)
            if name in ("worst_residual", "error_estimate"):
                assert value < 1e-5
            else:
                assert value == pytest.approx(expected, rel=1e-8, nan_ok=True), name


def test_every_column_is_described_with_its_unit(table):
    described = [line[2:].split(" [")[0] for line in table.comments[3:]]
    assert described == table.names[1:]
    units = {"h0": "m", "gap": "m", "displacement": "m", "load": "N"}
    for line in table.comments[3:]:
        name, unit = line[2:].split("]")[0].split(" [")
        if name in OF_APPROXIMATIONS + END:
            assert unit == units[name.rpartition("_")[2]], line


def test_a_group_that_is_absent_costs_no_column(run, table):
    sweep = {"key": "force.hamaker", "values": [hamaker(0.1), hamaker(0.2)]}
    bare = run(lennard_jones(0.1, loading=loading(7, 3, 1), sweep=sweep)).table("sweep.csv")
    extra = ["maugis_lambda", "maugis_pull_off", *OF_APPROXIMATIONS] + [
        f"{name}_{k}" for k in (1, 2) for name in OF_UNLOADINGS]
    assert table.names == [*bare.names[:-1], *extra, "failure"] and bare.names[-1] == "failure"
    assert set(END) <= set(bare.names)


@pytest.mark.parametrize("groups, names", [
    ({"classical": {"theories": ["carpick"]}}, ["carpick_pull_off", "carpick_radius"]),
    ({"classical": {"theories": ["jkr", "pietrement_troyon"]}},
     ["pietrement_troyon_pull_off", "pietrement_troyon_radius"]),
    ({"regime": {}, "layer": {"thickness": 5.0, "young": 1.0, "poisson": 0.3}},
     ["regime_worst_hertz_layered", "regime_worst_jkr_layered"])],
    ids=["carpick", "troyon", "layers"])
def test_theories_that_not_every_deck_has_are_columns_where_it_has_them(run, groups, names):
    """Numbers of these theories were in no column."""
    bodies = {"radius": 1.0, "young": [2.0, 2.0], "poisson": [0.3, 0.3]}
    scene = {"bodies": bodies, "equilibrium_path": {"h0_end": -2.0}, **groups}
    sweep = {"key": "bodies.radius", "values": [1.0, 2.0]}
    table = run(lennard_jones(0.5, **scene, sweep=sweep)).table("sweep.csv")
    alone = run(lennard_jones(0.5, **scene)).summary
    found = [name for name in table.names if re.search("carpick|troyon|layered", name)]
    assert found == names
    for name in names:
        assert table[name][0] == pytest.approx(alone[name], rel=1e-6)


def test_jumps_of_the_summary_are_rows_of_the_approximations(run):
    result = run(adhesive(approximations={}))
    rows, summary = result.table("approximations.csv"), result.summary
    for name in JUMPS:
        row = rows.rows(name)
        assert len(row) == 1
        assert summary[f"{name}_h0"] == row["h0"][0]
        assert summary[f"{name}_load"] == row["load"][0]
    row = rows.rows("jump_equation_37")
    assert summary["jump_equation_37_gap"] == pytest.approx(row["h0"][0] + row["displacement"][0])


def test_jumps_that_do_not_exist_are_absent_or_nan(run, table):
    assert np.isnan(table["fold_closed_form_h0"][0]) and np.isnan(table["jump_in_h0"][0])
    assert not np.isnan(table["fold_closed_form_h0"][-1])
    repulsion = run(exponential(1, loading=loading(6, 4, 1), approximations={})).summary
    without = run(adhesive()).summary
    for summary in (repulsion, without):
        assert [key for key in OF_APPROXIMATIONS if key in summary] == []


def test_a_sweep_of_approximations_alone_has_their_jumps(run):
    sweep = {"key": "force.hamaker", "values": [hamaker(sigma) for sigma in SIGMAS]}
    groups = {"approximations": {"h0_start": 8.0, "h0_end": 0.0}, "sweep": sweep}
    alone = run(lennard_jones(0.87, **groups)).table("sweep.csv")
    cycle = run(adhesive(**groups)).table("sweep.csv")
    for name in OF_APPROXIMATIONS:
        np.testing.assert_array_equal(alone[name], cycle[name])
    assert np.isnan(alone["end_load"]).all()


def end_of(curve, branch):
    rows = curve.rows(branch)
    return [rows[name][-1] for name in ("h0", "displacement", "load")]


@pytest.mark.parametrize("deck, branch", [
    (adhesive(), "loading"), (adhesive(equilibrium_path={"h0_end": -3.0}), "loading"),
    (adhesive(numerics={"grid": "uniform", "nodes": 150}), "loading"),
    (exponential(3, loading=loading(6, -1, 1)), "loading"),
    (lennard_jones(0.87, equilibrium_path={"h0_end": -3.0}), "path"),
    (exponential(3, equilibrium_path={"h0_end": -1.0}), "path")],
    ids=["cycle", "cycle and path", "uniform grid", "repulsion", "path", "path of repulsion"])
def test_end_is_the_last_row_of_the_loading_or_without_one_of_the_path(run, deck, branch):
    result = run(deck)
    assert [result.summary[key] for key in END] == end_of(result.curve, branch)


def test_a_path_into_collapse_has_no_end(run):
    """Without repulsion the last states of the path are unstable: nobody can be there."""
    scene = lennard_jones(1.0, part="attractive", equilibrium_path={"h0_end": 0.0})
    assert [key for key in END if key in run(scene).summary] == []


def test_loading_that_is_cut_short_ends_where_it_did(run):
    scene = lennard_jones(1.0, part="attractive", loading=loading(8, 0, 0.5))
    result = run(scene, status=1)
    assert [result.summary[key] for key in END] == end_of(result.curve, "loading")
    assert result.summary["end_h0"] > result.summary["jump_in_h0"]


def test_a_sweep_at_fixed_h0_gives_load_against_the_swept_key(run):
    """Pressed far beyond the range of the repulsion, Hertz's load at the displacement."""
    sweep = {"key": "bodies.stiffness", "values": [1.0, 4.0, 16.0]}
    rows = run(exponential(1e5, loading=loading(20, -5000, 5020), sweep=sweep)).table("sweep.csv")
    assert (rows["end_h0"] == -5000).all()
    hertz = 2 / 3 * rows["bodies.stiffness"] * rows["end_displacement"] ** 1.5
    np.testing.assert_allclose(rows["end_load"], hertz, rtol=0.01)


def test_a_case_that_fails_has_its_end_and_nan_for_what_it_did_not_reach(run):
    """Without repulsion the larger sigma has no state at the turning point."""
    sweep = {"key": "force.hamaker", "values": [hamaker(1e-3), hamaker(1.0)]}
    scene = lennard_jones(
        1.0, part="attractive", loading=loading(8, 2, 0.5), unloading={"from_": [2.0]}, sweep=sweep)
    rows = run(scene, status=1).table("sweep.csv")
    assert list(rows["converged"]) == [1, 0]
    assert rows["end_h0"][0] == 2 and rows["end_h0"][1] > rows["jump_in_h0"][1] > 2
    assert rows["unload_max_tension_1"][0] > 0
    assert np.isnan(rows["unload_max_tension_1"][1])
    assert np.isnan(rows["unload_jump_out_h0_1"]).all()


def test_a_sweep_of_a_list_gives_each_case_the_one_value(run):
    # Where the deck has two turning points the case has one, and so has the table.
    sweep = {"key": "unloading.from", "values": [2.5, -2.0]}
    swept = run(adhesive(sweep=sweep)).table("sweep.csv")
    single = run(adhesive()).summary
    np.testing.assert_allclose(
        swept["unload_max_tension_1"], several(single["unload_max_tension"])[::-1], rtol=1e-6)
    assert not {"unload_max_tension_2", "unload_jump_out_h0_2"} & set(swept.names)


DRIVEN = [f"device_{name}" for name in (
    "jump_in_z", "jump_in_load", "jump_in_load_after",
    "jump_out_z", "jump_out_load", "jump_out_load_after", "energy_lost")]
LOADED = [f"fixed_load_{name}" for name in (
    "equilibria", "stable", "h0", "displacement", "contact_radius")]


def held(sigma=0.87, stiffness=(0.5, 0.1), load=(0.0, -1.0, 0.5), **groups):
    """Springs and fixed loads of one path."""
    springs = {} if stiffness is None else {"stiffness": [sigma * k for k in stiffness]}
    return lennard_jones(
        sigma, equilibrium_path={"h0_end": -3.0}, device=springs,
        fixed_load={"load": [sigma * one for one in load]}, **groups)


def as_alone(swept, row, summary):
    """Compares the lists in a row of a sweep with those of a case alone; a list without any value
    is absent."""
    for key in DRIVEN + LOADED:
        for k, value in enumerate(several(summary.get(key, math.nan)), 1):
            assert swept[f"{key}_{k}"][row] == pytest.approx(value, rel=1e-8, nan_ok=True), (key, k)


def test_springs_and_loads_have_a_column_each(run):
    """A sweep over scenes with springs or fixed loads had no number of them."""
    sweep = {"key": "numerics.accuracy", "values": [1e-6, 1e-4]}
    swept = run(held(sweep=sweep)).table("sweep.csv")
    for row, accuracy in enumerate(sweep["values"]):
        as_alone(swept, row, run(held(numerics={"accuracy": accuracy})).summary)
    lists = [f"{key}_{k}" for keys, count in ((DRIVEN, 2), (LOADED, 3))
             for k in range(1, count + 1) for key in keys]
    assert swept.names[-1 - len(lists):-1] == lists


@pytest.mark.parametrize("key, values", [
    ("device.stiffness", [0.5, 0.0]), ("fixed_load.load", [-1.0, 0.5])])
def test_a_swept_spring_or_load_has_one_column(run, key, values):
    name = key.partition(".")[2]
    swept = run(held(sweep={"key": key.upper(), "values": [0.87 * value for value in values]}))
    table = swept.table("sweep.csv")
    for row, value in enumerate(values):
        as_alone(table, row, run(held(**{name: [value]})).summary)
    names = DRIVEN if name == "stiffness" else LOADED
    assert not {f"{each}_2" for each in names} & set(table.names)


def test_a_swept_term_of_a_list_leaves_the_other_terms(run):
    sweep = {"key": "device.stiffness(2)", "values": [0.2, 0.1]}
    swept = run(held(0.87, sweep=sweep)).table("sweep.csv")
    first, second = (swept[f"device_jump_in_z_{k}"] for k in (1, 2))
    assert first[0] == pytest.approx(first[1], rel=1e-12)
    assert second[0] < 0.9 * second[1]


def test_a_prescribed_h0_is_one_drive(run):
    sweep = {"key": "device.z_end", "values": [-1.0, -2.0]}
    swept = run(held(stiffness=None, sweep=sweep)).table("sweep.csv")
    np.testing.assert_allclose(swept["device_jump_in_z_1"], swept["jump_in_h0"], rtol=1e-9)
    assert "device_jump_in_z_2" not in swept.names


def test_bodies_that_yield_have_their_relaxed_strength_of_adhesion(run):
    scene = lennard_jones(
        0.5, viscoelastic={"stiffness_relaxed": 0.5, "retardation_time": 1.0},
        drive={"velocity": 1.0, "z_start": 5.0, "z_turn": 2.0, "z_end": 5.0},
        numerics={"accuracy": 1e-3}, sweep={"key": "drive.velocity", "values": [1.0, 2.0]})
    table = run(scene).table("sweep.csv")
    np.testing.assert_allclose(table["sigma_relaxed"], 2 * table["sigma"], rtol=1e-6)


@pytest.mark.slow
def test_warnings_of_cases_are_counted_and_the_first_is_shown(run):
    """A sweep said nothing of cases that missed the accuracy asked for."""
    groups = {"bodies": {"radius": 1e-6, "stiffness": 1e9},
              "force": {"law": "lennard_jones", "surface_energy": 0.02, "z0": 0.5e-9},
              "equilibrium_path": {"h0_end": -3e-9}}
    punch = {**groups, "bodies": {"radius": 1e-6, "stiffness": 1e8},
             "shape": {"kind": "rounded_punch", "flat_radius": 3e-8}}
    alone = run(deck(**punch)).summary["warnings"]
    found = run(deck(**punch, sweep={
        "key": "bodies.stiffness", "values": [1e9, 1e8, 3e8]})).summary
    assert several(found["warnings"]) == [
        f"2 of 3 cases gave a warning; the first, case 2: {several(alone)[0]}"]
    assert "warnings" not in run(deck(
        **groups, sweep={"key": "bodies.stiffness", "values": [1e9, 2e9]})).summary


def test_a_case_that_stopped_on_a_small_change_says_so(run):
    """It had its first warning, on another matter, as the reason why it failed."""
    table = run(lennard_jones(
        0.87, loading=loading(4, 0, 0.5),
        sweep={"key": "force.hamaker", "values": [hamaker(0.5), hamaker(0.87)]},
        numerics={"method": "mixing", "nodes": 60, "r_max": 6.0, "grid": "uniform",
                  "convergence": "displacement_change", "displacement_tolerance": 1e-2}),
        status=1).table("sweep.csv")
    assert not table["converged"].any()
    assert all("stopped on a small change" in text for text in table["failure"])
