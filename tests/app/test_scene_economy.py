"""Claims about cost, by the counters of &cost: what a scene leaves out costs nothing."""

import math

import pytest
from support.scenes import deck, exponential, lennard_jones, loading

COUNTERS = [
    "states", "iterations", "kernel_entries", "pressure_evaluations", "operator_products",
    "operator_columns", "factorisations", "rejected_steps"]
PLAIN = {"loading": loading(8, -2, 0.25)}


def counts(result):
    return {name: result.cost[name] for name in COUNTERS}


# --- Laws


def test_short_ranged_repulsion_multiplies_by_few_columns(run):
    """Beyond the contact there is no pressure, and the operator is not applied to it."""
    for numerics, most in (({}, 0.85), ({"grid": "uniform", "nodes": 300}, 0.75)):
        cost = run(exponential(200, loading=loading(10, -20, 0.5), numerics=numerics)).cost
        assert cost["operator_columns"] < most * cost["operator_products"] * cost["nodes"]
    # Attraction reaches everywhere. Two of the three runs that are counted, those that judge the
    # grid, have two thirds and five sixths of its nodes.
    cost = run(lennard_jones(0.1, loading=loading(8, -2, 0.5), numerics=numerics)).cost
    assert cost["operator_columns"] >= 0.95 * 5 / 6 * cost["operator_products"] * cost["nodes"]


def test_forces_that_are_absent_are_not_evaluated(run):
    """Two groups that make the Lennard-Jones law take its iterations, and two evaluations for one;
    each further force that hardly acts adds one."""
    bodies, numerics = {"radius": 1.0, "stiffness": 1.0}, {"grid": "uniform", "nodes": 300}
    forces = {
        "van_der_waals": {"hamaker": 10.0},
        "born": {"z0": 1.0},
        "hydration": {"energy": 1e-12, "decay_length": 2.0},
        "structural": {"amplitude": 1e-12, "period": 2.0, "decay_length": 1.0},
    }
    one = run(lennard_jones(10 / (16 * math.pi), **PLAIN, numerics=numerics)).cost
    for count in (2, 3, 4):
        present = dict(list(forces.items())[:count])
        cost = run(deck(bodies=bodies, **present, **PLAIN, numerics=numerics)).cost
        # Rounding makes some iterations more or fewer; a force more would be a quarter.
        assert cost["iterations"] == pytest.approx(one["iterations"], rel=0.12)
        assert cost["pressure_evaluations"] == pytest.approx(
            count * one["pressure_evaluations"], rel=0.12)


def test_one_force_alone_runs_without_a_sum(run):
    """The paper's law and the group that is the same law: the same work, to the last digit."""
    bodies, numerics = {"radius": 1.0, "stiffness": 1.0}, {"grid": "uniform", "nodes": 300}
    paper, group = (
        run(deck(bodies=bodies, **law, loading=loading(8, -6, 0.5), numerics=numerics)) for law in (
            {"force": {"law": "exponential", "p0": 3.0, "decay_length": 1.0}},
            {"hydration": {"pressure": 3.0, "decay_length": 1.0}})
    )
    assert counts(group) == counts(paper)
    for name in ("h0", "load", "h_centre", "residual"):
        assert list(group.curve[name]) == list(paper.curve[name]), name


def test_a_law_without_attraction_meshes_the_contact_alone(run):
    attraction = run(lennard_jones(1.0, **PLAIN)).cost
    repulsion = run(lennard_jones(1.0, part="repulsive", **PLAIN)).cost
    assert repulsion["nodes"] < attraction["nodes"]
    assert repulsion["kernel_entries"] < attraction["kernel_entries"]


# --- Groups


def test_an_absent_group_leaves_no_file_and_no_column(run):
    result = run(lennard_jones(1.0, **PLAIN))
    assert result.files == ["curve.csv", "summary.nml"]
    assert set(result.curve["branch"]) == {"loading"}
    assert not any("eigenvalue" in name or "criterion" in name for name in result.curve.names)
    assert not any(key.startswith(("unload", "folds", "load_folds")) for key in result.summary)
    assert result.cost["states"] == len(result.curve) == 41
    groups = ["summary", "cost", "bodies", "force", "loading", "numerics"]
    assert list(result.groups) == groups


def test_theories_cost_no_equilibrium(run):
    plain, more = run(lennard_jones(1.0, **PLAIN)), run(lennard_jones(1.0, **PLAIN, classical={}))
    assert more.files == sorted([*plain.files, "classical.csv"])
    assert counts(more) == counts(plain)
    plain_rows, rows = ((r.folder / "curve.csv").read_bytes() for r in (plain, more))
    assert rows == plain_rows


def test_profiles_on_the_steps_cost_finer_meshes_and_no_state(run):
    plain = run(lennard_jones(1.0, **PLAIN))
    more = run(lennard_jones(1.0, **PLAIN, profiles={"h0": [1.0, -2.0]}))
    assert more.files == sorted([*plain.files, "profiles.csv"])
    assert more.cost["states"] == plain.cost["states"]
    # A profile feels errors of the edge's place that no load feels.
    assert plain.cost["nodes"] < more.cost["nodes"] <= 1.5 * plain.cost["nodes"]
    assert more.cost["operator_products"] <= 1.05 * plain.cost["operator_products"] + 2 * 12
    for column in ("load", "displacement"):
        size = abs(plain.curve[column]).max()
        assert abs(more.curve[column] - plain.curve[column]).max() <= 1e-6 * size


def test_a_profile_off_the_steps_costs_one_state(run):
    plain = run(lennard_jones(1.0, **PLAIN))
    more = run(lennard_jones(1.0, **PLAIN, profiles={"h0": [1.1]}))
    assert more.cost["states"] == plain.cost["states"] + 1
    # One state; by rounding the iterations of others may end a product sooner or later.
    assert more.cost["operator_products"] <= 1.05 * plain.cost["operator_products"] + 20


def test_unloading_does_not_change_the_loading(run):
    plain = run(lennard_jones(1.0, **PLAIN))
    more = run(lennard_jones(1.0, **PLAIN, unloading={"from_": [0.0, -2.0]}))
    assert more.cost["states"] == plain.cost["states"] + 33 + 41
    assert more.cost["kernel_entries"] == plain.cost["kernel_entries"]
    loading_rows = more.curve.rows("loading")
    assert list(loading_rows["load"]) == list(plain.curve["load"])


def test_stability_adds_columns_and_factorisations_and_nothing_else(run):
    plain = run(lennard_jones(1.0, **PLAIN))
    more = run(lennard_jones(1.0, **PLAIN, stability={}))
    assert more.curve.names[: len(plain.curve.names)] == plain.curve.names
    added = more.curve.names[len(plain.curve.names) :]
    assert added == ["smallest_eigenvalue", "criterion_28", "criterion_29"]
    assert list(more.curve["load"]) == list(plain.curve["load"])
    states = more.cost["states"]
    extra = more.cost["factorisations"] - plain.cost["factorisations"]
    assert states <= extra <= 3 * states
    for name in ("states", "operator_products", "kernel_entries"):
        assert more.cost[name] == plain.cost[name]


def test_classical_theory_alone_solves_nothing(run):
    result = run(lennard_jones(1.0, classical={"h0_start": 5.0, "h0_end": -5.0}))
    assert result.files == ["classical.csv", "summary.nml"]
    assert "nodes" not in result.cost
    for name, value in counts(result).items():
        assert value == 0, name


# --- The cost model


@pytest.mark.parametrize("sigma", [0.1, 0.87, 8.7])
def test_a_smooth_state_takes_few_products_and_rare_factorisations(run, sigma):
    """Six products a state (median) and a factorisation every six states, the jumps aside: with so
    few nodes it costs as much as three iterations, and is renewed when it has cost these. The
    factorisations of the two runs that estimate the errors are counted too: half as many."""
    scene = lennard_jones(sigma, loading=loading(4, -20, 0.05), unloading={"h0_end": 4.0})
    result = run(scene)
    iterations = sorted(result.curve["iterations"])
    assert iterations[len(iterations) // 2] <= 6
    smooth = exponential(100, loading=loading(0, -20, 0.05))
    result = run(smooth)
    assert result.cost["factorisations"] <= 1.5 * len(result.curve) / 6
    iterations = sorted(result.curve["iterations"])
    assert iterations[len(iterations) // 2] <= 6


@pytest.mark.parametrize("sigma", [0.87, 8.7])
def test_cost_of_a_cycle_grows_with_its_states_only(run, sigma):
    """Twice as many steps: the same kernel, and less than twice the products."""
    costs = [
        run(lennard_jones(sigma, loading=loading(13, -10, step), unloading={})).cost
        for step in (0.2, 0.1)
    ]
    assert costs[0]["kernel_entries"] == costs[1]["kernel_entries"]
    assert costs[1]["operator_products"] < 2 * costs[0]["operator_products"]


def test_path_costs_the_same_few_products_a_state_at_any_adhesion(run):
    for sigma in (0.1, 8.7, 1000.0):
        cost = run(lennard_jones(sigma, equilibrium_path={"h0_end": -2.0})).cost
        assert cost["operator_products"] < 15 * cost["states"]
        assert cost["states"] < 250
        assert cost["nodes"] < 1500
