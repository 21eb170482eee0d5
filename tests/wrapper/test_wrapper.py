"""Claims about whole experiments run from Python: the program's numbers."""

import math

import numpy as np
import pytest
import snapin
from support.extremes import tolerance_of
from support.scenes import deck, loading, several
from support.wrapper_registry import UNIT, law_of

# Fig. 1 of the paper.
BODIES = {"radius": 1.5e-2, "stiffness": 1e10}
FORCE = {"law": "lennard_jones", "hamaker": 1e-20, "z0": 0.5e-9}
LAW = snapin.lennard_jones(hamaker=1e-20, z0=0.5e-9)
DOWN = np.linspace(4e-9, -2e-9, 61)

# Kernels of the linear algebra round by where arrays lie in memory, and that differs between the
# program and this process: an iteration may end a product sooner, anywhere below its tolerance of
# 1e-10. In contact a residual of that size is 1.3e-10 of a load (seen with Haswell kernels).
SAME = 1e-8


def assert_same(result, table):
    """Every column is that of the program's table."""
    for name in ("h0", "h_centre", "displacement", "load", "contact_radius"):
        mine, theirs = getattr(result, name), table[name]
        np.testing.assert_allclose(
            mine, theirs, rtol=SAME, atol=SAME * abs(theirs).max(), err_msg=name)


@pytest.fixture(scope="module")
def there_and_back():
    """Fig. 1 down to -2 nm and up again."""
    return snapin.force_curve(np.r_[DOWN, DOWN[::-1]], **BODIES, law=LAW)


# --- The program's numbers


@pytest.mark.parametrize("ways, unloading", [(["in"], None), (["in", "out"], {})])
def test_h0_that_falls_or_turns_round_gives_the_program_s_curve(
        run, there_and_back, ways, unloading):
    curve = snapin.force_curve(DOWN, **BODIES, law=LAW) if unloading is None else there_and_back
    result = run(deck(bodies=BODIES, force=FORCE, loading=loading(4e-9, -2e-9, 1e-10),
                      unloading=unloading))
    assert_same(curve, result.curve)
    summary = result.summary
    # How far below the tolerance an iteration ends is rounding's affair.
    assert max(curve.residual.max(), summary["worst_residual"]) <= tolerance_of({})
    jumps = [(summary[f"jump_{way}_h0"], summary[f"jump_{way}_load"]) for way in ways]
    np.testing.assert_allclose(curve.jumps, jumps, rtol=SAME)
    assert curve.max_tension == pytest.approx(summary["max_tension"], rel=SAME)
    # At a smooth maximum the place is known to half the digits.
    assert curve.max_tension_h0 == pytest.approx(summary["max_tension_h0"], rel=1e-6)
    # What the estimate is far below the accuracy is rounding's affair too.
    assert curve.error_estimate == pytest.approx(summary["error_estimate"], rel=0.5, abs=1e-8)
    assert curve.converged


RIGID = {"radius": 1.0, "rigid": True}


@pytest.mark.parametrize("bodies, law, ends, options", [
    (UNIT, snapin.exponential(p0=3.0, decay_length=1.0), (6, -4), {}),
    (RIGID, law_of(1.0), (6, 0.5), {}),
    (UNIT, law_of(0.2), (6, 1), {"method": "newton"}),
    (UNIT, law_of(0.2), (6, 1), {"grid": "uniform", "nodes": 250, "r_max": 12.0}),
    (UNIT, law_of(0.2), (6, 1), {"method": "mixing", "grid": "panels"}),
    (UNIT, law_of(0.2), (6, 1), {"accuracy": 1e-9}),
])
def test_any_law_bodies_and_options_give_the_program_s_curve(run, bodies, law, ends, options):
    result = run(deck(bodies=bodies, **law, loading=loading(*ends, 0.5), numerics=options))
    h0 = np.arange(ends[0], ends[1] - 0.1, -0.5)
    curve = snapin.force_curve(h0, **bodies, law=law, **options)
    assert_same(curve, result.curve)
    # What the estimate is far below the accuracy is rounding's affair too.
    estimate = result.summary["error_estimate"]
    assert curve.error_estimate == pytest.approx(estimate, rel=0.5, abs=1e-8)
    tension = result.summary.get("max_tension", math.nan)
    assert curve.max_tension == pytest.approx(tension, rel=1e-6, nan_ok=True)
    assert bool(curve.jumps) == ("jump_in_h0" in result.summary)


@pytest.mark.parametrize("bodies, law, keys", [
    (BODIES, LAW, {"h0_end": -2e-9}), (UNIT, law_of(0.5), {"h0_end": -2.0, "h0_start": 40.0}),
    (UNIT, snapin.exponential(p0=1.0, decay_length=1.0), {"h0_end": -2.0})])
def test_path_is_that_of_the_program(run, bodies, law, keys):
    result = run(deck(bodies=bodies, **law, equilibrium_path=keys))
    path = snapin.equilibrium_path(**bodies, law=law, **keys)
    assert_same(path, result.curve)
    assert (path.stable == (result.curve["stable"] == 1)).all()
    assert path.stable.dtype == bool
    folds = zip(*(several(result.summary.get(f"folds_{name}", [])) for name in ("h0", "load")))
    np.testing.assert_allclose(path.folds, [*folds], rtol=SAME)
    tension = result.summary.get("max_tension", math.nan)
    assert path.max_tension == pytest.approx(tension, rel=SAME, nan_ok=True)
    assert path.error_estimate == pytest.approx(
        result.summary["error_estimate"], rel=1e-3, abs=SAME)
    assert path.converged


# --- What Python adds


def test_turning_value_may_be_repeated_or_not(there_and_back):
    once = snapin.force_curve(np.r_[DOWN, DOWN[-2::-1]], **BODIES, law=LAW)
    scale = abs(there_and_back.load).max()
    np.testing.assert_allclose(
        once.load, np.delete(there_and_back.load, 61), atol=1e-7 * scale, rtol=0)
    np.testing.assert_allclose(once.jumps, there_and_back.jumps, rtol=1e-6)


def test_the_second_of_two_calls_does_not_know_of_the_first(there_and_back):
    snapin.force_curve([3.0, -1.0], **UNIT, law=law_of(3.0), method="newton")
    again = snapin.force_curve(np.r_[DOWN, DOWN[::-1]], **BODIES, law=LAW)
    np.testing.assert_array_equal(again.load, there_and_back.load)
