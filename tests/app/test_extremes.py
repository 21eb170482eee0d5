"""Claims about what no deck may do, and about what is said where there is nothing to compute.

`tests/support/extremes.py` draws the decks and has the claims; as a command it tries many more of
them, and with a build of -Dtraps=true behind $SNAPIN it shows that nothing overflows on the way.
"""

import re
import resource

import numpy as np
import pytest
from conftest import ROOT
from support.extremes import Broken, check_run, extreme_deck, run_deck
from support.scenes import deck, exponential, lennard_jones, loading, runner, several

# Of the processor, with traps. The slowest deck, eigenvalues of 376 states on 1494 nodes at
# sigma = 1e8, takes a tenth of this.
SECONDS = 1000
# Decks of which one takes as long as fifty others: thousands of factorisations, 1500 nodes.
SLOWEST = (8, 28)

CYCLE = {"loading": loading(6, -2, 0.5), "unloading": {}}


@pytest.fixture(scope="module")
def run(snapin, tmp_path_factory):
    return runner(snapin, tmp_path_factory.mktemp("extremes"))


# --- Decks drawn at random


@pytest.mark.parametrize("tens", range(8))
def test_no_extreme_deck_crashes_hangs_or_hides_a_residual(snapin_path, tmp_path, tens):
    """Exit status 0, 1 or 2; no infinity, NaN or asterisk in a table; residuals as asked for."""
    for number in range(10 * tens, 10 * tens + 10):
        if number not in SLOWEST:
            check_extreme(snapin_path, tmp_path, number)


@pytest.mark.long
@pytest.mark.parametrize("number", SLOWEST)
def test_no_slow_extreme_deck_crashes_hangs_or_hides_a_residual(snapin_path, tmp_path, number):
    check_extreme(snapin_path, tmp_path, number)


def check_extreme(snapin_path, folder, number):
    """The claims of tests/support/extremes.py about a deck."""
    name = f"deck{number}"
    try:
        status, stderr, _ = run_deck(snapin_path, extreme_deck(number), folder, name, SECONDS)
        check_run(status, stderr, folder / "results" / name)
    except Broken as broken:
        pytest.fail(f"{name}: {broken}\n{extreme_deck(number)}")


# --- Numbers out of range


@pytest.mark.parametrize(
    ("key", "value"),
    [("radius", 1e-200), ("stiffness", 1e200), ("hamaker", 1e-150), ("z0", 1e150)],
)
def test_numbers_whose_powers_would_overflow_are_refused(run, key, value):
    groups = {
        "bodies": {"radius": 1.0, "stiffness": 1.0},
        "force": {"law": "lennard_jones", "hamaker": 1.0, "z0": 1.0},
    }
    for keys in groups.values():
        if key in keys:
            keys[key] = value
    result = run(deck(**groups, loading=loading(3, 1, 1)), status=2)
    assert f'key "{key}"' in result.stderr
    assert not result.folder.exists()


def test_units_that_would_overflow_together_are_refused(run):
    """Each number is moderate; the pressure A/(16 pi z0^3) is not."""
    scene = deck(
        bodies={"radius": 1.0, "stiffness": 1.0},
        force={"law": "lennard_jones", "hamaker": 1.0, "z0": 1e-50},
        loading={"h0_start": 3e-50, "h0_end": 1e-50, "h0_step": 1e-50},
    )
    assert "a pressure of 1e" in run(scene, status=2).stderr


def test_h0_of_more_lengths_than_digits_is_refused(run):
    scene = lennard_jones(1.0, loading=loading(1e16, 1, 1e16))
    assert "lost in rounding" in run(scene, status=2).stderr


@pytest.mark.parametrize("sigma", [1e-12, 1e-9, 1e9, 1e12])
def test_sigma_out_of_any_range_is_solved_or_said_to_be_beyond_rounding(run, sigma):
    scene = lennard_jones(sigma, equilibrium_path={"h0_end": -2.0})
    if sigma < 1:
        result = run(scene)
        # DMT, which no such bodies can leave.
        assert result.summary["max_tension"] / sigma == pytest.approx(2 * np.pi, rel=1e-6)
    else:
        assert "rounding hides the force law" in run(scene, status=1).warnings[0]


@pytest.mark.parametrize("method", ["anderson", "newton"])
def test_adhesion_beyond_rounding_is_refused_at_once_on_a_fixed_grid_too(run, method):
    """Before, every step of the approach was tried, a hundred products and more each."""
    numerics = {"grid": "uniform", "nodes": 120, "method": method}
    scene = lennard_jones(1e13, loading=loading(1.5, -98, 10), numerics=numerics)
    result = run(scene, status=1)
    assert "rounding hides the force law" in result.warnings[0]
    # It is one state that shows it, of hundreds of steps and halvings.
    assert result.cost["states"] <= 1
    assert result.cost["operator_products"] < 1000 and result.cost["factorisations"] < 1000


def test_no_residual_above_a_thousandth_is_put_down_to_rounding(run):
    """At depths of a million million lengths rounding leaves a hundredth, too much for a state."""
    for scene in (
        lennard_jones(1, loading=loading(6, -1e12, 1e12)),
        exponential(1, loading=loading(0, -1e13, 1e13)),
    ):
        result = run(scene, status=1)
        assert (result.curve["residual"][result.curve["converged"] == 1] <= 1e-3).all()
        assert any("ended early" in text for text in result.warnings)


@pytest.mark.parametrize("nodes", [2, 3])
@pytest.mark.parametrize("method", ["anderson", "newton", "mixing"])
def test_two_nodes_are_a_grid_and_told_to_be_a_bad_one(run, method, nodes):
    numerics = {"method": method, "grid": "uniform", "nodes": nodes}
    text = lennard_jones(0.1, loading=loading(4, 2, 1), numerics=numerics)
    assert any("error" in warning for warning in run(text).warnings)


@pytest.mark.parametrize("rigid_grid", ["auto", "uniform"])
def test_rigid_bodies_keep_what_came_before_they_touch(run, rigid_grid):
    text = lennard_jones(1.0, loading=loading(3, -2, 0.5), numerics={"grid": rigid_grid})
    result = run(text.replace("stiffness = 1.0", "rigid = .true."), status=1)
    assert list(result.curve["h0"]) == [3.0, 2.5, 2.0, 1.5, 1.0, 0.5]
    assert (result.curve["converged"] == 1).all()
    assert "touch" in result.warnings[0]


# --- Too large, too long


def big(nodes, step):
    return lennard_jones(
        0.87, loading=loading(4, 2, step), numerics={"grid": "uniform", "nodes": nodes}
    )


def test_matrices_larger_than_the_memory_are_refused_with_the_size_needed(snapin, tmp_path):
    (tmp_path / "d.nml").write_text(big(20000, 1.0))
    limit = 2 * 1024**3

    def lower():
        resource.setrlimit(resource.RLIMIT_AS, (limit, limit))

    done = snapin("d.nml", cwd=tmp_path, preexec_fn=lower)
    assert done.returncode == 1
    assert "20000 nodes need" in done.stderr and "GB of memory" in done.stderr
    summary = (tmp_path / "results" / "d" / "summary.nml").read_text()
    assert "20000 nodes need" in summary
    check = snapin("--check", "d.nml", cwd=tmp_path, preexec_fn=lower)
    assert check.returncode == 0 and "20000 nodes need" in check.stderr


def test_a_long_run_is_announced_and_a_short_one_is_not(snapin, tmp_path):
    (tmp_path / "long.nml").write_text(
        lennard_jones(0.87, loading=loading(4, -2, 1e-6), unloading={})
    )
    (tmp_path / "short.nml").write_text(big(100, 1.0))
    done = snapin("--check", "long.nml", "short.nml", cwd=tmp_path)
    assert done.returncode == 0
    assert "long.nml: 12000002 states" in done.stderr and "may take" in done.stderr
    assert "short" not in done.stderr


# --- Iterations that do not converge

STARVED = {
    "anderson": {"max_iterations": 1},
    "newton": {"method": "newton", "max_iterations": 1},
    "anderson, uniform": {"max_iterations": 1, "grid": "uniform", "nodes": 100},
    "newton, uniform": {
        "method": "newton",
        "max_iterations": 1,
        "grid": "uniform",
        "nodes": 100,
    },
    "mixing": {"method": "mixing", "max_iterations": 3, "nodes": 100},
    "mixing, panels": {"method": "mixing", "max_iterations": 3, "grid": "panels"},
    "mixing limit": {
        "method": "mixing",
        "mixing_limit": 1e-9,
        "max_iterations": 100,
        "nodes": 100,
    },
    "mixing, tolerance": {
        "method": "mixing",
        "residual_tolerance": 1e-13,
        "max_iterations": 50,
        "nodes": 100,
    },
    "paper's rule": {
        "method": "mixing",
        "convergence": "displacement_change",
        "displacement_tolerance": 1e-30,
        "max_iterations": 5,
        "nodes": 100,
    },
}


@pytest.mark.parametrize("numerics", STARVED.values(), ids=STARVED.keys())
@pytest.mark.parametrize("scene", ["cycle", "path"])
def test_what_does_not_converge_says_so_and_invents_nothing(run, scene, numerics):
    if scene == "path":
        if "max_iterations" not in numerics or numerics.get("method") == "mixing":
            pytest.skip("the path has no use for mixing")
        text = lennard_jones(0.87, equilibrium_path={"h0_end": -2.0}, numerics=numerics)
    else:
        text = lennard_jones(0.87, **CYCLE, numerics=numerics)
    result = run(text, status=1)
    summary, curve = result.summary, result.curve
    assert not summary["converged"]
    assert any("converge" in text or "residual" in text for text in result.warnings)
    assert "jump_in_h0" not in summary and "jump_out_h0" not in summary
    # The table alone tells which rows are equilibria.
    assert ((curve["residual"] <= 1e-8) >= (curve["converged"] == 1)).all()
    equilibria = curve["converged"] == 1
    if "max_tension" in summary:
        assert summary["max_tension"] <= 1.01 * max(0, *-curve["load"][equilibria])
    else:
        assert not (curve["load"][equilibria] < 0).any()


@pytest.mark.parametrize("name", ["anderson, uniform", "mixing"])
def test_a_row_that_is_no_equilibrium_is_neither_stable_nor_unstable(run, name):
    curve = run(
        lennard_jones(0.87, **CYCLE, stability={}, numerics=STARVED[name]), status=1
    ).curve
    assert (curve["converged"] == 0).any()
    assert (curve["stable"][curve["converged"] == 0] == -1).all()


def test_what_came_before_the_fall_is_kept(run):
    """Nothing keeps bodies apart that only attract."""
    for numerics in ({}, {"grid": "uniform", "nodes": 60}, {"method": "mixing", "nodes": 60}):
        result = run(
            lennard_jones(0.87, part="attractive", **CYCLE, numerics=numerics), status=1
        )
        assert "no stable equilibrium exists" in result.warnings[0]
        assert len(result.curve) >= 5 and (result.curve["converged"] == 1).all()
        assert result.summary["jump_in_h0"] > 2 and "jump_out_h0" not in result.summary


def test_a_path_without_repulsion_says_how_it_ends(run):
    result = run(lennard_jones(0.87, part="attractive", equilibrium_path={"h0_end": -2.0}))
    assert "fall onto each other" in result.warnings[0]
    assert result.curve["h_centre"].min() > 0


def test_repulsion_alone_that_does_not_converge_says_so(run):
    result = run(exponential(10, loading=loading(6, -6, 1), numerics={"max_iterations": 1}), status=1)
    assert len(result.curve) == 0 and "after 1 iterations" in result.warnings[0]


# --- Folds that a step passes over


@pytest.mark.parametrize("sigma", [0.291085, 0.2911, 0.2912, 0.2918])
def test_folds_however_close_are_found(run, sigma):
    result = run(lennard_jones(sigma, equilibrium_path={"h0_end": -2.0}))
    first, second = result.summary["folds_h0"]
    # h0 at the folds parts as (sigma - 0.29108493)^(3/2).
    assert second - first == pytest.approx(1.60 * (sigma - 0.29108493) ** 1.5, rel=0.2)
    assert result.summary["folds_stable"] == [0, 1]
    assert result.summary["energy_lost"] > 0


@pytest.mark.parametrize("sigma", [0.1, 0.28, 0.29, 0.29108])
def test_below_the_first_jump_there_is_no_fold(run, sigma):
    assert "folds_h0" not in run(lennard_jones(sigma, equilibrium_path={"h0_end": -2.0})).summary


@pytest.mark.parametrize("sigma", [0.2914, 0.3, 0.87, 8.7, 100.0])
def test_uncertainty_of_the_energy_lost_covers_its_error(run, sigma):
    def energy(accuracy):
        numerics = {"accuracy": accuracy}
        return run(
            lennard_jones(sigma, equilibrium_path={"h0_end": -2.0}, numerics=numerics)
        ).summary

    fine = energy(1e-9)
    for accuracy in (1e-3, 1e-4, 1e-6):
        coarse = energy(accuracy)
        uncertainty = coarse["energy_lost_uncertainty"]
        assert abs(coarse["energy_lost"] - fine["energy_lost"]) <= uncertainty
        assert uncertainty < 0.01 * coarse["energy_lost"]


# --- The error estimate


@pytest.mark.parametrize("sigma", [0.0087, 0.1, 0.87])
@pytest.mark.parametrize("accuracy", [1e-4, 1e-5])
def test_the_estimate_includes_what_the_iteration_leaves(run, sigma, accuracy):
    """Meshes are so good there that the tolerance of the iteration is the larger part."""
    fields = {"equilibrium_path": {"h0_end": -4.0}}
    coarse = run(lennard_jones(sigma, **fields, numerics={"accuracy": accuracy}))
    fine = run(lennard_jones(sigma, **fields, numerics={"accuracy": 1e-10}))
    error = abs(coarse.curve["load"][-1] / fine.curve["load"][-1] - 1)
    assert error <= coarse.summary["error_estimate"] <= accuracy


# --- The same digits

SCENES = {
    "cycle and path": lennard_jones(8.7, loading=loading(13, -4, 0.5), unloading={}, equilibrium_path={}),
    "uniform": lennard_jones(0.87, **CYCLE, numerics={"grid": "uniform", "nodes": 200}),
    "newton": lennard_jones(1.7, **CYCLE, numerics={"method": "newton"}),
    "mixing": lennard_jones(0.17, loading=loading(6, 0, 1), numerics={"method": "mixing", "nodes": 100}),
    "repulsion": exponential(100, loading=loading(6, -20, 1)),
    "stability": lennard_jones(0.87, loading=loading(6, -1, 0.5), stability={}),
}


@pytest.mark.parametrize("text", SCENES.values(), ids=SCENES.keys())
def test_the_same_deck_gives_the_same_bytes(snapin, tmp_path, text):
    tables = []
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "d.nml").write_text(text)
        assert snapin("d.nml", cwd=tmp_path / name).returncode == 0
        tables.append((tmp_path / name / "results" / "d" / "curve.csv").read_bytes())
    assert tables[0] == tables[1]


def shared_from():
    """Nodes from which on products and factors are shared between threads."""
    text = (ROOT / "src" / "system" / "blas_threads.f90").read_text()
    return int(re.search(r":: worthwhile = (\d+)", text)[1])


@pytest.mark.slow
@pytest.mark.parametrize(
    "scene",
    [
        lambda **groups: exponential(1.0, **groups),
        pytest.param(lambda **groups: lennard_jones(0.2, **groups), marks=pytest.mark.long),
    ],
    ids=["repulsion", "adhesion"],
)
def test_threads_that_share_a_matrix_leave_eleven_digits(run, scene):
    """They add in another order. Solved to 1e-12, so that it is not the iteration that decides."""
    numerics = {
        "grid": "uniform",
        "nodes": shared_from(),
        "r_max": 20.0,
        "residual_tolerance": 1e-12,
    }
    text = scene(loading=loading(3, 2, 1), numerics=numerics)
    one, two = (run(text, threads=threads) for threads in (1, 2))
    assert [one.cost["threads"], two.cost["threads"]] == [1, 2]
    for name in ("h0", "h_centre", "displacement", "load"):
        scale = abs(one.curve[name]).max()
        np.testing.assert_allclose(two.curve[name], one.curve[name], rtol=0, atol=1e-11 * scale)


def test_the_summary_records_what_made_it(run, snapin):
    summary = run(SCENES["repulsion"]).summary
    told = snapin("--version").stdout.splitlines()
    assert told[0] == f"snapin {summary['version']}"
    assert told[1:] == [
        f"compiler: {summary['compiler']}",
        f"blas: {summary['blas']}",
        f"options: {summary['build_options']}",
    ]
    assert several(run(SCENES["repulsion"]).cost["threads"]) == [1]
