"""error_estimate is honest: between the true error and a hundred times it."""

import numpy as np
import pytest
from support import study_estimates
from support.scenes import exponential, lennard_jones

ACCURACIES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-8)
# Below this the reference is no better than the run.
KNOWN = 3e-11


@pytest.mark.slow
@pytest.mark.parametrize("sigma", [0.01, 0.14251, 0.2914, 0.35, 0.87, 30.7029, 1000.0])
def test_the_estimate_of_path_and_cycle_bounds_the_error_within_a_hundred(tmp_path, sigma):
    """Against the independent solution; each number has an estimate of its own besides."""
    job = study_estimates.Job(sigma, study_estimates.ACCURACIES, tmp_path)
    for found in study_estimates.examine(job):
        assert not found.wrong
        for one in found.deviations:
            assert one.ratio <= 1, (found.kind, found.accuracy, one)
        # Near the cusp the energy lost, which has an estimate of its own, vanishes.
        lost = [one for one in found.deviations if one.key == "energy_lost"]
        assert all(one.allowed < 0.01 * one.value for one in lost)
        others = [one for one in found.deviations if one not in lost]
        assert len(others) >= (8 if sigma > 0.2911 else 2), found.deviations
        assert max(found.estimate, *(one.relative for one in others)) <= found.accuracy
        errors = [one.relative for one in others if one.known]
        # At finer accuracies every error may be below that of the independent solution.
        assert errors or found.accuracy < 1e-5
        if errors:
            assert max(errors) <= found.estimate <= 100 * max(errors), found


@pytest.mark.parametrize("big_lambda", [1.0, 216.0])
def test_the_estimate_of_a_repulsion_bounds_the_error_within_a_hundred(run, big_lambda):
    loading = {"h0_start": 10.0, "h0_end": -75.0, "h0_step": 0.5}
    exact, *found = (run(exponential(big_lambda, loading=loading, numerics={"accuracy": accuracy}))
                     for accuracy in (1e-10, *ACCURACIES))
    load, displacement = exact.curve["load"], exact.curve["displacement"]
    judged = 0
    for one, accuracy in zip(found, ACCURACIES):
        off = abs(one.curve["displacement"] - displacement)
        error = max(off[-1] / displacement[-1], *abs(one.curve["load"] / load - 1)[[0, -1]])
        # Displacements at some rows are part of the estimate, here at all of them.
        widest = max(error, (off / np.maximum(displacement, 1.0)).max())
        assert error <= accuracy
        judged += error > KNOWN
        assert error <= KNOWN or error <= one.summary["error_estimate"] <= 100 * widest
    assert judged >= 2


def test_the_energy_lost_is_known_where_the_bodies_land_under_the_largest_tension(run):
    """A landing is judged behind the fold that its jump starts from, whichever is found first."""
    deck = lennard_jones(8.7, loading={"h0_start": 24.0, "h0_end": -20.0, "h0_step": 0.5},
                         unloading={"from": [2.0, -20.0], "h0_end": 24.0, "h0_step": 0.5})
    summary = run(deck).summary
    assert summary["energy_lost_uncertainty"] < 1e-3 * summary["energy_lost"]
