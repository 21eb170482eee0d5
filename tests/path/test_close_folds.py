"""Claims about folds that a step could pass over, and about errors of paths."""

import pytest
from support.scenes import lennard_jones


# --- Folds that a step passes over


@pytest.mark.parametrize("sigma", [0.291085, 0.2911, 0.2912, 0.2918])
def test_folds_however_close_are_found(run, sigma):
    result = run(lennard_jones(sigma, equilibrium_path={"h0_end": -2.0}))
    first, second = result.summary["folds_h0"]
    # h0 at the folds parts as (sigma - 0.29108493)^(3/2), and the energy lost goes with the square
    # of that difference.
    beyond = sigma - 0.29108493
    assert second - first == pytest.approx(1.60 * beyond**1.5, rel=0.2)
    assert result.summary["folds_stable"] == [0, 1]
    assert result.summary["energy_lost"] == pytest.approx(
        2.57 * beyond**2, rel=0.2, abs=result.summary["energy_lost_uncertainty"])
    assert result.summary["energy_lost_uncertainty"] < 1e-11


@pytest.mark.parametrize("sigma", [0.1, 0.28, 0.29, 0.29108])
def test_below_the_first_jump_there_is_no_fold(run, sigma):
    assert "folds_h0" not in run(lennard_jones(sigma, equilibrium_path={"h0_end": -2.0})).summary


@pytest.mark.parametrize("sigma", [0.2914, 0.3, 0.87, 8.7, 100.0])
def test_uncertainty_of_the_energy_lost_covers_its_error(run, sigma):
    def energy(accuracy):
        numerics = {"accuracy": accuracy}
        return run(
            lennard_jones(sigma, equilibrium_path={"h0_end": -2.0}, numerics=numerics)).summary

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
