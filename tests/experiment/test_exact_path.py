"""Claims about a path whose folds, extrema or end are not as exact as asked for: it is traced again
over their meshes, made finer, where finer meshes help."""

import pytest
from support.scenes import agreeing, lennard_jones, path_of


@pytest.mark.parametrize("sigma,accuracy", [(1.6607746, 1e-8), (1.6607746, 1e-7), (5.475, 1e-6)])
def test_extrema_that_have_just_come_to_be_are_as_exact_as_asked_for(run, sigma, accuracy):
    """Small errors move two extrema near each other far: their mesh is made finer."""
    found, _ = agreeing(run, lambda each: lennard_jones(
        sigma, equilibrium_path={"h0_end": -20.0}, numerics={"accuracy": each}), (accuracy, 1e-10),
        ("load_folds_h0", "load_folds_load", "folds_h0", "folds_load"))
    assert not found.warnings and found.summary["error_estimate"] < accuracy


def test_extrema_on_panels_that_were_too_long_are_as_exact_as_asked_for(run):
    """More nodes on panels that are too long do not help: their halving has to go with them."""
    depletion = {"osmotic_pressure": 1e5, "diameter": 1.16407163e-9}
    found, _ = agreeing(
        run, lambda each: path_of(6.18145667e11, 2.28571824e-10, each, depletion=depletion),
        (1e-4, 1e-8), ["load_folds_load"], lambda _: 1e-6)
    assert not found.warnings and found.summary["error_estimate"] < 1e-4


def test_a_path_whose_law_has_a_kink_is_not_made_worse(run):
    """About a kink errors go up and down with the nodes, so that a finer mesh may be worse."""
    steric = {"brush_thickness": 1.7417738643505404e-9, "grafting_density": 1e16}
    found = run(path_of(3.959643598120061e11, 2.105954964614361e-10, 1e-6, steric=steric))
    assert not found.warnings
    assert found.summary["error_estimate"] < 3e-6


def test_the_error_of_what_is_not_shown_is_no_part_of_the_estimate(run):
    """Two extrema that hardly exist have the largest errors; the path begins behind them."""
    numerics = {"accuracy": 1e-5}
    whole, part = (
        run(lennard_jones(1.6607746, equilibrium_path=shown, numerics=numerics)).summary
        for shown in ({"h0_end": -20.0}, {"h0_start": -5.0, "h0_end": -20.0})
    )
    assert part["error_estimate"] < 0.1 * whole["error_estimate"]
