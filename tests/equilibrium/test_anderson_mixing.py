"""Claims about Anderson acceleration of the mixing: the equilibrium of the other methods, by
products alone, and safe where contacts are stiff."""

import _snapin
import numpy as np
import pytest
import snapin
from snapin.deck import problem_deck
from support import reference
from support.scenes import exponential, lennard_jones, loading
from test_solvers import LAW, MATRIX, MESH, STATES, TOLERANCE, equations, neighbour


def accelerated(law, coupling, h0, depth=10, ratio=0.2, **options):
    return snapin.equilibrium(
        LAW[law], MESH, h0, coupling, method="anderson_mixing", depth=depth, mixing_limit=ratio,
        start=neighbour(law, coupling, h0), tolerance=TOLERANCE,
        **{"most_iterations": 20000} | options)


@pytest.mark.parametrize("depth", [1, 2, 5, 10, 20])
@pytest.mark.parametrize(("law", "coupling", "h0"), STATES)
def test_every_depth_solves_the_equations_without_a_factorisation(law, coupling, h0, depth):
    state = accelerated(law, coupling, h0, depth)
    residual, *_ = equations(law, coupling, h0, state)
    assert state.converged and residual <= TOLERANCE + 1e-12
    assert state.factorisations == 0


@pytest.mark.parametrize("h0", [2.0, -2.0])
def test_depth_0_is_plain_mixing(h0):
    """Bit by bit, with as many products."""
    plain = snapin.equilibrium(
        LAW["lennard_jones"], MESH, h0, 0.17, method="mixing", most_iterations=20000,
        start=neighbour("lennard_jones", 0.17, h0))
    none = accelerated("lennard_jones", 0.17, h0, depth=0)
    np.testing.assert_array_equal(none.gap, plain.gap)
    assert none.operator_products == plain.operator_products > 100


def test_the_acceleration_saves_nine_of_ten_products():
    """Over all states; a run of mixing in contact takes hundreds or thousands of products."""
    spent = sum(accelerated(*where).operator_products for where in STATES)
    plain = sum(accelerated(*where, depth=0).operator_products for where in STATES)
    assert 10 * spent < plain


@pytest.mark.parametrize(("depth", "ratio"), [(2, 0.2), (10, 1.0), (20, 1.0)])
def test_rejected_steps_are_counted_and_the_iteration_restarts(depth, ratio):
    """A ratio of 1 leads away from a stiff contact at once: without rejections the gaps collapse or
    leave the law's domain."""
    state = accelerated("lennard_jones", 0.87, -2.0, depth, ratio)
    residual, *_ = equations("lennard_jones", 0.87, -2.0, state)
    assert state.rejected_steps > 0
    assert state.converged and residual <= TOLERANCE + 1e-12


def test_iterations_end_where_the_deck_says():
    state = accelerated("lennard_jones", 0.87, -2.0, most_iterations=12)
    assert not state.converged
    assert state.operator_products <= 13


# --- Stability by products


def test_stability_is_that_of_the_dense_eigenvalues():
    """Equations (24) and (25), of gaps that are no equilibria as well, so that the smallest
    eigenvalue has either sign; one of less than a tenth is not judged."""
    judged = {True: 0, False: 0}
    for seed in range(40):
        rng = np.random.default_rng(seed)
        sigma, flat = 10 ** rng.uniform(-1, 1.5), rng.uniform(0, 3)
        inside, neck = rng.uniform(0.9, 1.3), rng.uniform(0.1, 1.0)
        out = np.maximum(MESH.x - flat, 0)
        gap = inside + neck * out**1.5 + 0.5 * out**2
        slope = 8 / 3 * (3 * gap**-4 - 9 * gap**-10)
        least = np.linalg.eigvals(
            np.eye(gap.size) - 2 * sigma * MATRIX.nodes * slope).real.min()
        told, *_ = _snapin.flat_numerics.stable_state(
            problem_deck(LAW["lennard_jones"]), sigma, *MESH._description, gap)
        if abs(least) > 0.1:
            assert bool(told) == (least > 0), seed
            judged[bool(told)] += 1
    assert min(judged.values()) > 5


# --- Runs

SIGMAS = (0.0087, 0.3)
# Without folds both branches of the independent solution are the whole path.
PASSAGE_H0 = 1.0


@pytest.mark.slow
@pytest.mark.parametrize("sigma", SIGMAS)
def test_loads_on_panels_are_those_of_the_independent_solution(run, sigma):
    result = run(lennard_jones(
        sigma, loading=loading(4.0, -1.0, 1.0), unloading={"h0_end": 4.0},
        numerics={"method": "anderson_mixing", "grid": "panels", "accuracy": 1e-6, "r_max": 300.0}))
    assert result.summary["method"] == "anderson_mixing"
    assert result.curve["residual"].max() <= 1e-8
    path = reference.path(sigma)
    ends = {"loading": path.jump_in, "unloading_1": path.jump_out}
    for name, h0, load in zip(*(result.curve[key] for key in ("branch", "h0", "load"))):
        jump = ends[name]
        before = h0 > (jump.h0 if jump else PASSAGE_H0)
        exact = path.on(path.far_branch if before else path.contact_branch, h0)
        # The mesh ends where the attraction still deforms the bodies by as much.
        assert load / sigma == pytest.approx(exact.load, abs=2e-5)


def test_jumps_are_those_of_the_factorised_iteration(run):
    """On one uniform grid, at a depth too small for many of the steps as well."""
    def jumps(**numerics):
        summary = run(lennard_jones(
            0.87, loading=loading(4.0, 1.0, 0.2), unloading={"h0_end": 4.0},
            numerics={"grid": "uniform", "nodes": 200, **numerics})).summary
        return [summary[name] for name in ("jump_in_h0", "jump_out_h0", "max_tension")]

    exact = jumps(method="anderson")
    for depth in (2, 10):
        assert jumps(method="anderson_mixing", anderson_depth=depth) == pytest.approx(
            exact, rel=1e-4)


@pytest.mark.parametrize("grid", ["auto", "uniform"])
def test_the_frozen_jacobian_needs_no_acceleration(run, grid):
    """Depth 0 is an iteration of its own: the same numbers, a few more iterations."""
    def cycle(depth):
        return run(lennard_jones(
            0.87, loading=loading(4.0, 0.0, 0.2), unloading={"h0_end": 4.0},
            numerics={"method": "anderson", "grid": grid, "anderson_depth": depth, "nodes": 150}))

    plain, deep = cycle(0), cycle(20)
    np.testing.assert_allclose(plain.curve["load"], deep.curve["load"], rtol=1e-6, atol=1e-7)
    assert plain.cost["iterations"] >= deep.cost["iterations"]


def test_without_attraction_the_mesh_is_scaled_with_the_contact(run):
    """Lambda of 1e4 at h0 = 0, where displacement and load are known to 11 digits."""
    result = run(exponential(1e4, loading=loading(10.0, 0.0, 1.0),
                             numerics={"method": "anderson_mixing"}))
    assert result.summary["grid"] == "edge_locked"
    assert result.curve["displacement"][-1] == pytest.approx(9.3371461, abs=1e-6)
    assert result.curve["load"][-1] == pytest.approx(22.0407985, rel=1e-6)


@pytest.mark.parametrize(("key", "phrase"), [
    ("anderson_depth = -1", "-1 is out of range"), ("anderson_depth = 61", "61 is out of range"),
    ("anderson_depth = 2.5", "anderson_depth"), ("method = 'andersson_mixing'", "not known")])
def test_wrong_keys_are_named(snapin, tmp_path, key, phrase):
    deck = lennard_jones(0.3, loading=loading(3.0, 1.0, 0.5)) + f"&numerics {key} /\n"
    (tmp_path / "d.nml").write_text(deck)
    refused = snapin("--check", "d.nml", cwd=tmp_path)
    assert refused.returncode == 2 and phrase in refused.stderr
