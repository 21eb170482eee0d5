"""Claims about jumps on fixed grids: they are folds, wherever the steps and the iterations end.

The dense solution shares nothing with the program but the matrix of the uniform grid.
"""

import numpy as np
import pytest
import snapin as library
from support.scenes import deck, lennard_jones, loading

NODES, R_MAX = 120, 5.0
GRID = {"grid": "uniform", "nodes": NODES, "r_max": R_MAX}


def cycle(sigma, step, start=4.0, end=0.7, **numerics):
    return lennard_jones(
        sigma, loading=loading(start, end, step), unloading={"h0_end": start, "h0_step": step},
        numerics={**GRID, **numerics})


def dense_folds(sigma, start=4.0, end=0.7):
    """The folds of h0 of the discrete equations, by pseudo-arclength along all of their curve."""
    mesh = library.uniform_mesh(NODES, R_MAX)
    matrix, r = mesh.matrix().nodes, mesh.x

    def terms(gap):
        pressure = 8 / 3 * (gap**-9 - gap**-3)
        jacobian = np.eye(NODES) - 2 * sigma * matrix * (8 * (gap**-4 - 3 * gap**-10))
        return gap - r**2 / 2 - 2 * sigma * matrix @ pressure, jacobian

    def tangent(jacobian, before):
        rate = np.append(np.linalg.solve(jacobian, np.ones(NODES)), 1.0)
        rate /= abs(rate).max()
        return rate if rate @ before > 0 else -rate

    z = np.append(start + r**2 / 2, start)
    for _ in range(30):
        rest, jacobian = terms(z[:-1])
        z[:-1] -= np.linalg.solve(jacobian, rest - z[-1])
    direction = tangent(terms(z[:-1])[1], -np.ones(NODES + 1))
    folds, step = [], 0.01
    while z[-1] > end:
        moved = z + step * direction
        for _ in range(8):
            rest, jacobian = terms(moved[:-1])
            bordered = np.block([[jacobian, -np.ones((NODES, 1))], [direction[None, :]]])
            along = direction @ (moved - z - step * direction)
            off = np.append(rest - moved[-1], along)
            moved = moved - np.linalg.solve(bordered, off)
        ahead = tangent(jacobian, direction)
        if ahead[-1] * direction[-1] < 0:
            # Hermite's cubic through h0 has its extremum where the slope is zero.
            part = direction[-1] / (direction[-1] - ahead[-1])
            folds.append(z[-1] + step * direction[-1] * part / 2)
        z, direction = moved, ahead
    return folds


@pytest.mark.slow
@pytest.mark.parametrize("sigma", [0.296, 0.33])
def test_a_small_jump_is_found_at_every_step_and_is_the_dense_fold(run, sigma):
    """At sigma 0.3 some steps found the jump out and others did not; profiles changed which."""
    into, out = dense_folds(sigma)
    for step in (0.1, 0.2, 0.37):
        for method in ("anderson", "newton"):
            found = run(cycle(sigma, step, method=method)).summary
            assert found["jump_in_h0"] == pytest.approx(into, abs=2e-6)
            assert found["jump_out_h0"] == pytest.approx(out, abs=2e-6)


@pytest.mark.slow
def test_a_curve_that_is_steep_but_has_no_fold_has_no_jump(run):
    assert not dense_folds(0.285)
    for step in (0.05, 0.25, 0.5):
        found = run(cycle(0.285, step)).summary
        assert "jump_in_h0" not in found and "jump_out_h0" not in found


@pytest.mark.slow
def test_the_end_of_a_branch_far_from_the_row_before_is_found_on_many_nodes(run):
    """The edge passes sixty nodes between two rows. The search stopped before the fold, the number
    of its states was limited by the number of nodes; the row was then said not to converge."""
    groups = {"loading": loading(5.5, 3.0, 0.5), "unloading": {"h0_end": 8.5, "h0_step": 0.5}}
    found = run(lennard_jones(4.3586, **groups, numerics={
        "grid": "uniform", "nodes": 744, "r_max": 6.39, "accuracy": 0.02}))
    exact = run(lennard_jones(4.3586, equilibrium_path={"h0_end": 3.0})).summary
    assert found.curve["converged"].all()
    for key in ("jump_in_h0", "jump_out_h0"):
        assert found.summary[key] == pytest.approx(exact[key], abs=found.summary[f"{key}_error"])
        assert found.summary[f"{key}_error"] < 0.05


def right_or_missing(result, exact):
    """Compare the jumps that a run has found; a warning says if one is missing. Return how many."""
    found = [key for key in ("jump_in_h0", "jump_out_h0") if key in result.summary]
    for key in found:
        assert result.summary[key] == pytest.approx(exact[key], abs=1e-6)
    assert any("is not known" in text for text in result.warnings) == (len(found) < 2)
    return len(found)


@pytest.mark.parametrize("limit", [500, 4000])
def test_mixing_that_stops_short_of_a_fold_finds_the_same_fold(run, limit):
    """Near a fold mixing is slow. The state at which it did not converge was taken for the fold."""
    sigma = 0.7
    exact = run(cycle(sigma, 0.5)).summary
    found = run(cycle(sigma, 0.5, method="mixing", mixing_limit=0.1, max_iterations=limit),
                status=None)
    assert right_or_missing(found, exact) == (2 if limit == 4000 else 0)


@pytest.mark.slow
def test_rows_that_did_not_converge_are_no_jump(run):
    """A stiff contact does not converge by mixing: once a jump out of it, far from any fold."""
    grid = {"grid": "uniform", "nodes": 150, "r_max": 5.5}
    groups = {"loading": loading(6, -2.5, 1.0), "unloading": {}}
    exact = run(lennard_jones(2.0, **groups, numerics=grid)).summary
    result = run(lennard_jones(2.0, **groups, numerics={
        **grid, "method": "mixing", "mixing_limit": 0.54, "max_iterations": 3000}), status=1)
    assert (result.curve["converged"] == 0).any()
    right_or_missing(result, exact)


def test_values_of_a_row_are_those_of_one_iterate(run):
    """Under the paper's rule the gap on the axis was that of the next iterate."""
    h0 = [2.0, 1.0, 0.0, -0.5]
    result = run(deck(
        bodies={"radius": 1.0, "stiffness": 1.0},
        force={"law": "lennard_jones", "surface_energy": 1.1, "z0": 1.0},
        loading=loading(4.0, -0.5, 0.5), profiles={"h0": h0},
        numerics={"method": "mixing", "grid": "uniform", "nodes": 120, "r_max": 6.0,
                  "convergence": "displacement_change", "displacement_tolerance": 1e-3}), status=1)
    mesh = library.uniform_mesh(120, 6.0)
    matrix, shapes = mesh.matrix().nodes, result.table("profiles.csv")
    assert result.curve["residual"].max() > 0.1
    for value in h0:
        row = np.flatnonzero(result.curve["h0"] == value)[0]
        gap = shapes["separation"][shapes["h0"] == value]
        pressure = 8 * 1.1 / 3 * (gap**-9 - gap**-3)
        beyond = 2 * np.pi * 1.1 / 3 * (gap[-1]**-8 - 4 * gap[-1]**-2)
        assert result.curve["h_centre"][row] == gap[0]
        assert result.curve["load"][row] == pytest.approx(
            2 * np.pi * mesh.weight @ pressure + beyond, rel=1e-9)
        off = gap - value - mesh.x**2 / 2 - 2 * matrix @ pressure
        assert result.curve["residual"][row] == pytest.approx(abs(off).max(), rel=1e-6)


def test_numbers_of_a_branch_with_unsolved_states_are_said_to_be_those_of_the_others(run):
    """The largest tension was a sixth of the pull-off with an error of a thousandth, and the only
    word was that states did not converge."""
    groups = {"loading": loading(4.0, -3.0, 0.5), "unloading": {}}
    limited = run(lennard_jones(1.2, **groups, numerics={
        **GRID, "r_max": 9.0, "method": "mixing", "max_iterations": 400}), status=1)
    whole = run(lennard_jones(1.2, **groups))
    part = limited.summary["max_tension"]
    assert part + 3 * limited.summary["max_tension_error"] < 0.5 * whole.summary["max_tension"]
    told = [text for text in limited.warnings if "did not converge" in text]
    assert any("largest tensions" in text and "are those of the states that did" in text
               for text in told)


def test_a_largest_tension_beside_states_that_did_not_converge_is_said_to_be_no_pull_off(run):
    """It was said to be none of an end, and nothing named the place."""
    groups = {"loading": loading(4.0, -3.0, 0.5), "unloading": {}}
    limited = run(lennard_jones(1.2, **groups, numerics={
        **GRID, "r_max": 9.0, "method": "mixing", "max_iterations": 400}), status=1)
    lost = limited.curve["converged"] == 0
    beside = limited.curve["h0"][lost].max()
    assert beside < limited.summary["max_tension_h0"] < beside + 0.5
    assert limited.summary["max_tension_at_end"]
    assert any("the tension is largest beside states that did not converge, at h0 =" in text
               for text in limited.warnings)


@pytest.mark.parametrize("profiles", [False, True])
def test_a_largest_tension_under_the_papers_rule_is_known_to_within_rows(run, profiles):
    """Where a profile was read at the same row, its h0 was said to be exact."""
    step, end = 0.25, -0.5
    h0 = [end + step * k for k in range(26)]
    summary = run(lennard_jones(
        0.9577, loading=loading(6.0, end, step), unloading={},
        profiles={"h0": h0} if profiles else None,
        numerics={"method": "mixing", "grid": "uniform", "nodes": 200, "r_max": 8.0,
                  "convergence": "displacement_change", "displacement_tolerance": 4e-4}),
        status=1).summary
    assert summary["max_tension_h0"] in h0
    assert summary["max_tension_h0_error"] >= step


@pytest.mark.parametrize("sigma", [0.71, 0.94, 2.8])
def test_a_small_grid_hardly_changes_the_energy_lost(run, sigma):
    """Pressures beyond the grid shift both branches by the same h0: with their own energy at the
    deformation of the last node, which falls beyond it, the energy was 1.8e-3 too large."""
    groups = {"loading": loading(10, -6, 0.4), "unloading": {}}
    exact = run(lennard_jones(sigma, **groups)).summary["energy_lost"]
    for r_max in (5.7, 8.5):
        found = run(lennard_jones(sigma, **groups, numerics={
            "grid": "uniform", "nodes": int(45*r_max), "r_max": r_max, "accuracy": 0.1}),
            status=None).summary["energy_lost"]
        assert found == pytest.approx(exact, rel=6e-4)
