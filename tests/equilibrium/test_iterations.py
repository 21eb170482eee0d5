"""Claims about iterations that end without an equilibrium: they say so, and never pass as one.

Dimensionless and on one mesh, as in test_solvers.py.
"""

import math

import _snapin
import numpy as np
import pytest
import snapin
from snapin.deck import problem_deck
from test_solvers import LAW, MESH, PRESSURE, TOLERANCE, equations, every_method, solved


@every_method
def test_a_state_that_did_not_converge_says_so_and_how_far_it_is(method):
    state = snapin.equilibrium(
        LAW["lennard_jones"], MESH, -2.0, 0.87, method=method, most_iterations=3)
    residual, *_ = equations("lennard_jones", 0.87, -2.0, state)
    assert not state.converged
    assert state.residual > TOLERANCE
    assert state.residual == pytest.approx(residual, rel=1e-9)


def flat_state(start, method, stop_on_change, law, coupling=0.87):
    """Return residual and converged from the flat layer, which takes any start."""
    mesh = snapin.panel_mesh([0.0, 1.0, 3.0], 4)
    deck = problem_deck(LAW[law])
    physics = (deck, coupling, *mesh._description, 1.0, 0.0)
    options = (method, 1e-8, 50, 5, 8, 0.2, stop_on_change, 1.0)
    values = _snapin.flat_numerics.equilibrium_state(*physics, start, *options)
    (_, _, residual), (converged, *_) = values[2:4]
    return residual, converged


def with_nan(where):
    """Gaps of which some are not numbers."""
    gaps = np.ones(8)
    gaps[where] = math.nan
    return gaps


@every_method
@pytest.mark.parametrize("stop_on_change", [0, 1])
@pytest.mark.parametrize(("law", "start", "coupling"), [
    *((law, with_nan(where), 0.87) for law in PRESSURE for where in (0, 5, slice(None))),
    *(("lennard_jones", np.full(8, gap), 0.87) for gap in (0.0, -1.0, 1e-200, math.inf)),
    ("exponential", np.full(8, -1e3), 1e8), ("exponential", np.full(8, math.inf), 0.87)])
def test_nan_and_infinity_never_pass_as_converged(law, start, coupling, method, stop_on_change):
    residual, converged = flat_state(start, method, stop_on_change, law, coupling)
    assert not converged
    assert not residual < 1e300


@every_method
def test_infinite_pressure_is_not_taken_for_none(method):
    # The undeformed gaps at h0 = 0 touch on the axis, where the pressure is then infinite; without
    # it they would be an equilibrium.
    mesh = snapin.uniform_mesh(5, 4.0)
    start = np.maximum(mesh.x**2 / 2, 1e-40)
    state = snapin.equilibrium(LAW["lennard_jones"], mesh, 0.0, 0.87, method=method, start=start)
    assert not state.converged


def by_the_papers_rule(coupling, h0, displacement_tolerance):
    """Return the state at which mixing stops on a small change of the displacement."""
    return snapin.equilibrium(
        LAW["lennard_jones"], MESH, h0, coupling, method="mixing",
        displacement_tolerance=displacement_tolerance, most_iterations=20000)


@pytest.mark.parametrize("coupling", [0.87, 8.7])
def test_the_papers_rule_stops_far_from_equilibrium_in_a_stiff_contact_and_says_so(coupling):
    # 1e-4 nm where z0 is 0.5 nm.
    state = by_the_papers_rule(coupling, -2.0, 2e-4)
    residual, *_ = equations("lennard_jones", coupling, -2.0, state)
    assert state.converged
    assert state.residual == pytest.approx(residual, rel=1e-9)
    # The change that was asked for says nothing: the equations are off by many times as much.
    assert state.residual > 10 * 2e-4


def test_the_papers_rule_is_harmless_before_contact():
    state = by_the_papers_rule(0.17, 5.0, 1e-9)
    exact = solved("lennard_jones", 0.17, 5.0, "newton")
    assert state.converged
    assert state.load == pytest.approx(exact.load, rel=1e-7)
