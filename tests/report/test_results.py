"""Claims about the files of results: names, columns, contents, and what a failure leaves."""

import math
import random
import re
import sys

import f90nml
import numpy as np
import pytest
from conftest import ROOT
from support.processes import limited
from support.scenes import deck, exponential, lennard_jones, loading, path_of, runner

sys.path.append(str(ROOT / "tools"))

from reference_tables import sections_of  # noqa: E402 (found through the line above)

CURVE = [
    ("branch", ""),
    ("h0", "m"),
    ("h_centre", "m"),
    ("displacement", "m"),
    ("load", "N"),
    ("contact_radius", "m"),
    ("stable", ""),
    ("residual", ""),
    ("iterations", ""),
    ("converged", ""),
]
PROFILES = [
    ("branch", ""), ("h0", "m"), ("r", "m"), ("separation", "m"), ("deformation", "m"),
    ("pressure", "Pa"), ("energy", "J/m^2"), ("state", ""), ("stable", "")]
# Every key that users' scripts may depend on.
SUMMARY = """title version sigma tabor surface_energy jkr_pull_off dmt_pull_off max_tension
    max_tension_h0 jump_in_h0 jump_in_load jump_out_h0 jump_out_load unload_from unload_max_tension
    unload_jump_out_h0 worst_residual spacing_over_neck resolved error_estimate""".split()
COST = """wall_seconds kernel_seconds solve_seconds nodes states iterations kernel_entries
    pressure_evaluations operator_products factorisations""".split()


@pytest.fixture(scope="module")
def full(run):
    """A scene with every group that gives a file."""
    scene = lennard_jones(
        0.87, scene={"title": "It's \"all\", 100 %"}, loading=loading(6, -2, 0.5),
        unloading={"from_": [-2.0, 1.0]}, profiles={"h0": [2.0]}, classical={}, stability={})
    return run(scene)


# --- Tables


def check_table(table, columns):
    """Title, version and one '#' line a column with its unit, in order; then the header."""
    assert table.names == [name for name, _ in columns]
    title, version, *lines = table.comments
    assert title == "# title: It's \"all\", 100 %"
    assert re.fullmatch(r"# version: snapin \d+\.\d+\.\d+\S*", version)
    assert len(lines) == len(columns)
    for line, (name, unit) in zip(lines, columns):
        assert line.startswith(f"# {name} [{unit}]"), line


def test_curve_has_the_columns_of_the_contract(run):
    scene = lennard_jones(0.87, scene={"title": "It's \"all\", 100 %"}, loading=loading(6, 5, 0.5))
    check_table(run(scene).curve, CURVE)


def test_profiles_and_theories_have_the_columns_of_the_contract(full):
    check_table(full.table("profiles.csv"), PROFILES)
    classical = full.table("classical.csv")
    assert classical.names[0] == "theory"
    assert {"h0", "displacement", "load"} <= set(classical.names)
    assert len(classical.comments) == 2 + len(classical.names)


def test_profiles_tell_states_of_one_h0_apart(run):
    """Three states of a path at one h0 were rows of one branch, h0 and order; r began anew."""
    path = {"h0_end": -2.0}
    folds = run(lennard_jones(2.0, equilibrium_path=path)).summary
    between = 0.5 * (folds["jump_in_h0"] + folds["jump_out_h0"])
    found = run(lennard_jones(2.0, equilibrium_path=path, profiles={"h0": [between, 0.0]}))
    curve, table = found.curve, found.table("profiles.csv")
    states = np.unique(table["state"])
    assert len(states) == 4
    assert [int(np.unique(table["stable"][table["state"] == state])[0]) for state in states
            if curve["h0"][int(state) - 1] > 0] == [1, 0, 1]
    for state in states.astype(int):
        mine = table["state"] == state
        assert (np.diff(table["r"][mine]) > 0).all()
        # The number is that of the row of the curve, counted from 1.
        for name, own in (("h0", "h0"), ("h_centre", "separation"), ("stable", "stable")):
            assert curve[name][state - 1] == table[own][mine][0]


def test_profiles_of_unlike_bodies_have_the_deformation_of_each(run):
    # Compliances (1 - nu^2)/E of 0.5 and 1.5: their mean is that of the unit problem.
    scene = {"loading": loading(6, 0, 1.0), "profiles": {"h0": [1.0]}}
    alike = run(lennard_jones(0.87, **scene)).table("profiles.csv")
    unlike = run(
        lennard_jones(0.87, **scene).replace(
            "stiffness = 1.0", "young = 2.0, 0.5, poisson = 0.0, 0.5")
    ).table("profiles.csv")
    assert unlike.names == [*alike.names, "deformation_1", "deformation_2"]
    assert unlike["deformation"] == pytest.approx(alike["deformation"], rel=1e-9)
    assert unlike["deformation_1"] == pytest.approx(0.5 * unlike["deformation"], rel=1e-12)
    assert unlike["deformation_2"] == pytest.approx(1.5 * unlike["deformation"], rel=1e-12)


def test_branches_are_named_and_in_order(full):
    branches = list(dict.fromkeys(full.curve["branch"]))
    assert branches == ["loading", "unloading_1", "unloading_2"]


def test_numbers_of_any_size_are_written_to_the_last_digit(snapin, tmp_path):
    rng = random.Random(1)
    values = [rng.uniform(1, 10) * 10.0**order for order in range(-45, 25) for _ in range(8)]
    ends = 0.0, math.inf
    values += [math.nextafter(10.0**order, end) for order in range(-30, 20) for end in ends]
    # Exactly between two numbers of seventeen digits.
    values += [10.0**15 + k + 0.25 * (2 * k + 1) % 1 for k in range(20)]
    values += [(2**53 - 1 - 2 * k) / 8 for k in range(20)] + [2.0**k for k in range(-140, 80)]
    values = sorted(set(values))
    text = deck(bodies={"radius": 1e-6, "stiffness": 1e10},
                force={"law": "lennard_jones", "hamaker": 1e-19, "z0": 5e-10},
                classical={"h0_start": 1e-9, "h0_end": -1e-9, "count": 2},
                sweep={"key": "bodies.stiffness", "values": values})
    done = runner(snapin, tmp_path)(text)
    lines = (done.folder / "sweep.csv").read_text().splitlines()
    rows = [line.split(",") for line in lines if not line.startswith("#")][1:]
    for value, row in zip(values, rows):
        assert float(row[0]) == value
        for cell in row[:-1]:
            mantissa, exponent = f"{float(cell):.16e}".upper().split("E") if cell != "NaN" else "NN"
            assert cell == "NaN" or cell == f"{mantissa}E{int(exponent):+04d}"


def test_iterations_and_stable_are_what_they_are_called(full):
    curve = full.curve
    assert set(curve["stable"]) <= {-1, 0, 1}
    assert (curve["iterations"] >= 1).all()
    assert (curve["iterations"] == curve["iterations"].round()).all()
    assert (curve["residual"] >= 0).all()


# --- Summary


def test_summary_has_every_key_of_the_contract(full):
    assert [key for key in SUMMARY if key not in full.summary] == []
    assert [key for key in COST if key not in full.cost] == []
    assert full.summary["title"] == "It's \"all\", 100 %"
    assert full.cost["states"] == len(full.curve)
    assert full.cost["wall_seconds"] >= full.cost["kernel_seconds"] + full.cost["solve_seconds"]
    # One value a turning point, NaN where there is none.
    for key in ("unload_from", "unload_max_tension", "unload_jump_out_h0"):
        assert len(full.summary[key]) == 2


def test_the_listing_names_every_column_and_entry_of_a_run(full, snapin):
    sections = sections_of(snapin("--results").stdout)
    listed = {s.name: [line.split(";")[0].split(" ")[0] for line, _ in s.items] for s in sections}
    assert listed["curve.csv"][: len(full.curve.names)] == full.curve.names
    assert listed["profiles.csv"][: len(PROFILES)] == full.table("profiles.csv").names
    assert listed["classical.csv"] == full.table("classical.csv").names
    for group in ("summary", "cost"):
        keys = list(full.groups[group])
        assert [key for key in listed[f"&{group}"] if key in keys] == keys


def test_f90nml_reads_the_summary_and_writes_it_back(full, tmp_path):
    groups = f90nml.read(full.folder / "summary.nml")
    # All other tests read summaries with the package's reader.
    assert {name: dict(group) for name, group in groups.items()} == full.groups
    f90nml.write(groups, tmp_path / "again.nml")
    again = f90nml.read(tmp_path / "again.nml")
    assert list(again) == list(groups)
    assert again["bodies"] == groups["bodies"]
    assert list(groups)[:2] == ["summary", "cost"]


def test_what_does_not_exist_is_absent(run):
    repulsion = run(exponential(1, loading=loading(6, 4, 1)).replace(
        "radius = 1.0", "radius = 100.0").replace("p0 = 1.0", "p0 = 0.1")).summary
    for key in ("sigma", "tabor", "surface_energy", "jkr_pull_off", "dmt_pull_off", "max_tension",
                "max_tension_h0", "jump_in_h0", "jump_out_h0", "unload_from", "folds_h0",
                "spacing_over_neck", "resolved", "warnings"):
        assert key not in repulsion, key
    assert repulsion["big_lambda"] == pytest.approx(1)
    attraction = run(lennard_jones(0.1, loading=loading(6, -1, 0.5), unloading={})).summary
    for key in ("big_lambda", "jump_in_h0", "jump_in_load", "jump_out_h0", "jump_out_load"):
        assert key not in attraction, key
    assert attraction["max_tension"] > 0
    # Lists with a value for each turning point or load, but no value.
    for key in ("unload_jump_out_h0", "unload_jump_out_h0_error"):
        assert key not in attraction, key
    torn = run(lennard_jones(1, equilibrium_path={"h0_end": -1.0}, fixed_load={"load": -100.0}))
    assert torn.summary["fixed_load_equilibria"] == 0 and "fixed_load_h0" not in torn.summary


def test_classical_pull_offs_are_those_of_the_textbook(full):
    assert full.summary["sigma"] == pytest.approx(0.87, rel=1e-14)
    assert full.summary["surface_energy"] == pytest.approx(0.87, rel=1e-14)
    assert full.summary["jkr_pull_off"] == pytest.approx(1.5 * 3.141592653589793 * 0.87, rel=1e-14)
    assert full.summary["dmt_pull_off"] == pytest.approx(2 * 3.141592653589793 * 0.87, rel=1e-14)
    assert full.summary["tabor"] == pytest.approx((4 * 0.87**2) ** (1 / 3), rel=1e-14)


# --- Failures


def test_one_failure_does_not_stop_the_other_decks(snapin, tmp_path):
    numerics = {"method": "mixing", "max_iterations": 3, "nodes": 200}
    (tmp_path / "bad.nml").write_text(
        lennard_jones(0.87, loading=loading(5, 3, 1), numerics=numerics))
    (tmp_path / "good.nml").write_text(exponential(1, loading=loading(6, 4, 1)))
    done = snapin("bad.nml", "good.nml", cwd=tmp_path)
    assert done.returncode == 1
    for name in ("bad", "good"):
        assert (tmp_path / "results" / name / "summary.nml").is_file()
    assert not list(tmp_path.rglob("unfinished"))


@pytest.mark.parametrize("count", [8, 1000], ids=["lost in closing", "lost in writing"])
def test_a_table_that_cannot_be_written_leaves_no_results(snapin, tmp_path, count):
    """A deck of theories alone has no states for a journal, and a summary of 1500 bytes."""
    classical = {"h0_start": 1.0, "h0_end": -1.0, "count": count}
    (tmp_path / "d.nml").write_text(lennard_jones(1.0, classical=classical))
    done = snapin("d.nml", cwd=tmp_path, preexec_fn=limited("FSIZE", 2200))
    assert done.returncode == 1
    assert "unfinished/classical.csv: File too large" in done.stderr
    assert [p.name for p in (tmp_path / "results/d").iterdir()] == ["unfinished"]


def test_contact_ends_a_tenth_of_the_length_of_the_law_above_the_gap_at_rest(run):
    """For Morse's law this is far from 1.1 times the equilibrium gap."""
    found = run(path_of(1e9, -2e-9, 1e-8, radius=1e-6, force=None,
                        morse={"surface_energy": 0.02, "z0": 0.2e-9, "decay_length": 1e-9},
                        profiles={"h0": [-2e-9]}))
    profile = found.table("profiles.csv")
    radius = np.interp(0.2e-9 + 0.2e-9, profile["separation"], profile["r"])
    assert found.curve["contact_radius"][-1] == pytest.approx(radius, rel=1e-3)
    assert any("contact_radius [m]" in line and "plus a tenth of the law's length" in line
               for line in found.curve.comments)


FOLLOWERS = {
    "hamaker": {"bodies": {"radius": 1e-6, "stiffness": 1e10}, "van_der_waals": {"hamaker": 1e-20},
                "born": {"z0": 0.3e-9}, "dugdale": {"stress": 1e6, "range": 1e-9},
                "equilibrium_path": {"h0_end": -1e-9},
                "sweep": {"key": "van_der_waals.hamaker", "values": [1e-20, 2e-20]}},
    "partner": {"bodies": {"radius": 1e-6, "young": [1e9, 2e9], "poisson": 0.3},
                "layer": {"thickness": 1e-7, "young": 1e8, "poisson": 0.4, "body": "both"},
                "force": {"law": "lennard_jones", "hamaker": 1e-20, "z0": 0.3e-9},
                "equilibrium_path": {"h0_end": -1e-9}}}


@pytest.mark.parametrize("case", FOLLOWERS)
def test_a_default_that_follows_other_keys_follows_when_the_summary_runs_again(run, case):
    first = run(deck(**FOLLOWERS[case]))
    again = run((first.folder / "summary.nml").read_text())
    table = "sweep.csv" if "sweep" in FOLLOWERS[case] else "curve.csv"
    assert (again.folder / table).read_bytes() == (first.folder / table).read_bytes()


@pytest.mark.parametrize("numerics, noted", [
    ({"nodes": 50}, True), ({"grid": "panels", "r_max": 3.0}, True), ({"accuracy": 1e-5}, False),
    ({"grid": "uniform", "nodes": 300}, False)])
def test_nodes_that_have_no_effect_are_noted(run, numerics, noted):
    """Without a note a study over the number of nodes looks converged at once."""
    found = run(lennard_jones(0.1, loading=loading(4, 2, 1), numerics=numerics))
    assert ("no effect" in str(found.summary.get("notes", ""))) == noted


@pytest.mark.parametrize("groups", [
    {"equilibrium_path": {"h0_end": -1e-9}, "device": {"stiffness": 0.0}},
    {"equilibrium_path": {"h0_end": -1e-9}, "classical": {"theories": "pietrement_troyon"}},
    {"loading": {"h0_start": 4e-9, "h0_end": 0.6e-9, "h0_step": 2e-10}, "unloading": {},
     "numerics": {"grid": "uniform", "nodes": 120, "r_max": 1e-7}}])
def test_numbers_that_do_not_exist_are_not_compared(run, groups):
    """The claim is that of a build with -Dtraps=true, where a comparison with NaN ends the program:
    energies of bodies that part for good, loads below a pull-off, the rest of a jump's state."""
    numerics = {"accuracy": 1e-3, **groups.get("numerics", {})}
    run(deck(bodies={"radius": 1e-6, "stiffness": 1e10},
             force={"law": "lennard_jones", "hamaker": 1e-19, "z0": 3e-10},
             **{**groups, "numerics": numerics}))
