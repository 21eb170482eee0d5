"""error_estimate is honest: between the true error and a hundred times it."""

import pytest
from support.scenes import exponential, lennard_jones, several

# Below this the reference is no better than the run.
KNOWN = 3e-11


def measured(result):
    """What a run reports, the end of its curve included, and its error estimate."""
    summary, curve = result.summary, result.curve
    found = {
        key: summary[key]
        for key in ("max_tension", "jump_in_h0", "jump_out_h0")
        if key in summary
    }
    rows = [k for k, branch in enumerate(curve["branch"]) if branch.startswith(("loading", "path"))]
    found["displacement at the end"] = curve["displacement"][rows[-1]]
    found["load at the end"] = curve["load"][rows[-1]]
    if curve["branch"][rows[0]] == "loading":
        found["load at the start"] = curve["load"][rows[0]]
    # What the estimate sees too: folds and extrema of a path, and displacements there; of a cycle
    # displacements at some rows, here at all of them.
    beside = {}
    same = range(len(curve["h0"]))
    if curve["branch"][rows[0]] == "path":
        keys = ("folds_h0", "load_folds_h0")
        points = [h0 for key in keys for h0 in several(summary.get(key, []))]
        same = [int(abs(curve["h0"] - h0).argmin()) for h0 in points]
        for key in ("folds_h0", "folds_load", "load_folds_h0", "load_folds_load"):
            beside.update({f"{key} {k}": x for k, x in enumerate(several(summary.get(key, [])))})
    for k, row in enumerate(same):
        beside[f"displacement {k}"] = curve["displacement"][row]
    return found, beside, summary["error_estimate"]


def difference(found, reference):
    """Of two numbers, relative; of displacements, to the law's length where that is larger."""
    worst = 0.0
    for key, exact in reference.items():
        scale = max(abs(exact), 1.0) if key.startswith("displacement ") else abs(exact)
        worst = max(worst, abs(found[key] - exact) / scale)
    return worst


def scene(kind, strength, accuracy):
    """A path, a cycle or a repulsive loading at a strength (sigma or Lambda) and an accuracy."""
    numerics = {"accuracy": accuracy}
    if kind == "exponential":
        loading = {"h0_start": 10.0, "h0_end": -75.0, "h0_step": 0.5}
        return exponential(strength, loading=loading, numerics=numerics)
    if kind == "path":
        return lennard_jones(strength, equilibrium_path={"h0_end": -4.0}, numerics=numerics)
    high = max(12.0, 13 * (strength / 8.7) ** (2 / 3))
    loading = {"h0_start": high, "h0_end": -4.0, "h0_step": (high + 4) / 100}
    return lennard_jones(strength, loading=loading, unloading={"h0_end": high}, numerics=numerics)


@pytest.mark.parametrize(
    "kind, strength",
    [
        ("path", 0.01), ("path", 0.87), ("path", 8.7), ("path", 1000.0), ("cycle", 0.1),
        ("cycle", 0.87), ("cycle", 8.7), ("exponential", 1.0), ("exponential", 216.0)],
)
def test_the_estimate_bounds_the_error_within_a_hundred(run, kind, strength):
    exact, exact_beside, _ = measured(run(scene(kind, strength, 1e-10)))
    for accuracy in (1e-3, 1e-4, 1e-6, 1e-8):
        found, beside, estimate = measured(run(scene(kind, strength, accuracy)))
        error = difference(found, exact)
        widest = max(error, difference(beside, exact_beside))
        assert error <= accuracy
        if error > KNOWN:
            assert error <= estimate <= 100 * widest, (accuracy, error, widest, estimate)


def test_the_energy_lost_is_known_where_the_bodies_land_under_the_largest_tension(run):
    """A landing is judged behind the fold that its jump starts from, whichever is found first."""
    deck = lennard_jones(8.7, loading={"h0_start": 24.0, "h0_end": -20.0, "h0_step": 0.5},
                         unloading={"from": [2.0, -20.0], "h0_end": 24.0, "h0_step": 0.5})
    summary = run(deck).summary
    assert summary["energy_lost_uncertainty"] < 1e-3 * summary["energy_lost"]
