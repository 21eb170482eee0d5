"""Claims about the three iterations: one equilibrium, judged by its true residual.

All dimensionless (src/model/dimensionless_problem.f90), on one mesh fine enough for the zones that
occur here.
"""

import functools
import math

import numpy as np
import pytest
import snapin
from snapin.numerics import METHODS

# Panels of half a unit where contact edges may lie, a ninth of the narrowest neck between nodes,
# then growing to 27.
MESH = snapin.panel_mesh(
    np.concatenate([np.arange(0, 6, 0.5), 6 + 0.5 * np.cumsum(1.6 ** np.arange(7)) - 0.5]), 10)
MATRIX = MESH.matrix()

LAW = {
    "lennard_jones": snapin.lennard_jones(hamaker=1.0, z0=1.0),
    "exponential": snapin.exponential(p0=1.0, decay_length=1.0)}
PRESSURE = {"lennard_jones": lambda h: 8 / 3 * (h**-9 - h**-3), "exponential": lambda h: np.exp(-h)}
ENERGY = {"lennard_jones": lambda h: (h**-8 - 4 * h**-2) / 3, "exponential": lambda h: np.exp(-h)}

# Before, around and after contact; sigma = 0.87 has two jumps between 3.1 and 3.5.
STATES = [
    *(("lennard_jones", 0.0087, h0) for h0 in (5.0, 2.0, 1.0, 0.0, -2.0)),
    *(("lennard_jones", 0.17, h0) for h0 in (5.0, 2.0, 1.0, 0.0, -2.0)),
    *(("lennard_jones", 0.87, h0) for h0 in (5.0, 3.6, 2.0, 1.0, 0.0, -2.0)),
    *(("exponential", coupling, h0) for coupling in (0.01, 1.0, 100.0) for h0 in (1.0, -1.0))]
every_state = pytest.mark.parametrize(("law", "coupling", "h0"), STATES)
every_method = pytest.mark.parametrize("method", METHODS)

TOLERANCE = 1e-8


@functools.lru_cache(maxsize=None)
def neighbour(law, coupling, h0):
    """Return the gaps a tenth of a length before h0 is reached, roughly: where a step begins."""
    state = snapin.equilibrium(
        LAW[law], MESH, h0 + 0.1, coupling, method="mixing", tolerance=1e-5, most_iterations=20000)
    assert state.converged
    return state.gap


@functools.lru_cache(maxsize=None)
def solved(law, coupling, h0, method):
    """Return the state at h0, by `method` from the neighbour."""
    return snapin.equilibrium(
        LAW[law], MESH, h0, coupling, method=method, start=neighbour(law, coupling, h0),
        tolerance=TOLERANCE, most_iterations=20000 if "mixing" in method else 60)


def equations(law, coupling, h0, state, mesh=MESH, matrix=MATRIX):
    """Return residual, gap on the axis and load of a state's gaps, recomputed from scratch."""
    pressure = PRESSURE[law](state.gap)
    raised = 2 * coupling * matrix.nodes @ pressure
    residual = abs(state.gap - h0 - mesh.x**2 / 2 - raised).max()
    reach = mesh.centre + mesh.ends[-1]
    last = state.gap[-1] + (reach**2 - mesh.x[-1] ** 2) / 2
    load = 2 * math.pi * (mesh.weight @ pressure + ENERGY[law](last))
    return residual, h0 + 2 * coupling * matrix.axis @ pressure, load


def stiffest(law, coupling, state):
    """Return the norm of the inverse of the Jacobian: gaps err by this times the residual."""
    step = 1e-6
    slope = (PRESSURE[law](state.gap + step) - PRESSURE[law](state.gap - step)) / (2 * step)
    jacobian = np.eye(MESH.x.size) - 2 * coupling * MATRIX.nodes * slope
    return np.linalg.norm(np.linalg.inv(jacobian), np.inf)


# --- One equilibrium


@every_method
@every_state
def test_converged_states_satisfy_the_equations(law, coupling, h0, method):
    """Equations (14) and (16), (17) and (18); load (20) and central displacement (19)."""
    state = solved(law, coupling, h0, method)
    residual, axis_gap, load = equations(law, coupling, h0, state)
    assert state.converged
    assert state.residual <= TOLERANCE
    # Gaps of up to 400 and their rounding.
    assert residual == pytest.approx(state.residual, abs=1e-12)
    # The state's gap on the axis is extrapolated from the iterate's gaps at the nodes, to 1e-11 on
    # this mesh; that of the equation differs by the extrapolated residual too.
    assert axis_gap == pytest.approx(state.axis_gap, abs=2 * state.residual + 1e-11)
    assert load == pytest.approx(state.load, rel=1e-12)
    np.testing.assert_allclose(
        state.pressure, PRESSURE[law](state.gap), rtol=1e-12, atol=1e-12 * abs(state.pressure).max()
    )


@pytest.mark.parametrize("method", ["mixing", "anderson"])
@every_state
def test_methods_agree(law, coupling, h0, method):
    newton = solved(law, coupling, h0, "newton")
    other = solved(law, coupling, h0, method)
    error = 2 * stiffest(law, coupling, newton) * TOLERANCE
    assert error < 1e-5
    np.testing.assert_allclose(other.gap, newton.gap, atol=error, rtol=0)


@pytest.mark.parametrize(
    ("coupling", "h0"), [(c, h0) for law, c, h0 in STATES if law == "lennard_jones"])
def test_anderson_needs_a_fifth_of_the_operator_products_of_mixing(coupling, h0):
    mixing = solved("lennard_jones", coupling, h0, "mixing")
    anderson = solved("lennard_jones", coupling, h0, "anderson")
    assert mixing.converged and anderson.converged
    assert 5 * anderson.operator_products <= mixing.operator_products


@every_state
def test_newton_needs_few_factorisations_from_a_neighbouring_state(law, coupling, h0):
    state = solved(law, coupling, h0, "newton")
    # Quadratic convergence: 1e-1, 1e-2, 1e-4, 1e-8, with two to spare for stiff contacts.
    assert state.factorisations <= 6
    assert state.factorisations == state.operator_products - 1


def test_anderson_factorises_less_often_than_newton():
    def spent(method):
        return sum(solved(*state, method).factorisations for state in STATES)

    assert 2 * spent("anderson") < spent("newton")


def test_acceleration_saves_operator_products_where_the_factorisation_is_kept():
    def spent(depth):
        products = 0
        for law, coupling, h0 in STATES:
            start = neighbour(law, coupling, h0)
            state = snapin.equilibrium(
                LAW[law], MESH, h0, coupling, start=start, depth=depth, patience=60)
            assert state.converged or depth == 0
            products += state.operator_products
        return products

    assert 2 * spent(5) < spent(0)


@every_method
def test_an_equilibrium_is_recognised_at_once(method):
    start = solved("lennard_jones", 0.17, 0.0, "newton").gap
    state = snapin.equilibrium(LAW["lennard_jones"], MESH, 0.0, 0.17, method=method, start=start)
    assert state.converged and state.operator_products == 1 and state.factorisations == 0
    np.testing.assert_array_equal(state.gap, start)


# --- Known solutions


@every_method
@pytest.mark.parametrize(("law", "h0"), [("lennard_jones", 1.2), ("exponential", -3.0)])
def test_rigid_bodies_keep_their_shape_and_have_derjaguins_load(law, h0, method):
    state = snapin.equilibrium(LAW[law], MESH, h0, 0.0, method=method, most_iterations=200)
    assert state.converged
    np.testing.assert_allclose(state.gap, h0 + MESH.x**2 / 2, atol=TOLERANCE)
    # The load of any law between rigid bodies is 2 pi R times its energy, (23). The gap errs by no
    # more than the tolerance, and the pressure by that times its slope, below 20.
    assert state.load == pytest.approx(2 * math.pi * ENERGY[law](h0), rel=2e-7)
    assert state.axis_gap == pytest.approx(h0, abs=1e-15)


def test_a_scaled_mesh_is_a_larger_mesh():
    scale = 1.7
    large = snapin.panel_mesh(scale * MESH.ends, MESH.order)
    a = snapin.equilibrium(LAW["lennard_jones"], MESH, 0.5, 0.17, scale=scale, tolerance=1e-11)
    b = snapin.equilibrium(LAW["lennard_jones"], large, 0.5, 0.17, tolerance=1e-11)
    assert a.converged and b.converged
    np.testing.assert_allclose(a.gap, b.gap, atol=1e-9)
    assert a.load == pytest.approx(b.load, rel=1e-9)


def test_the_uniform_mesh_tends_to_the_same_state_at_second_order():
    exact = solved("lennard_jones", 0.17, 1.0, "newton")
    start = neighbour("lennard_jones", 0.17, 1.0)
    errors = []
    for nodes in (201, 401, 801):
        mesh = snapin.uniform_mesh(nodes, 20.0)
        gap = MESH.interpolate(start, mesh.x)
        state = snapin.equilibrium(LAW["lennard_jones"], mesh, 1.0, 0.17, start=gap)
        assert state.converged
        errors.append(abs(state.load - exact.load))
    assert (np.log2(np.divide(errors[:-1], errors[1:])) > 1.8).all()


@every_method
def test_exponential_law_depends_on_lambda_alone(method):
    # A shift of h0 is a factor on the pressure: only coupling exp(-h0) counts, as (38) and (39)
    # say.
    shifted = snapin.equilibrium(
        LAW["exponential"], MESH, 1.5, 10.0, method=method, tolerance=1e-11, most_iterations=5000)
    plain = snapin.equilibrium(
        LAW["exponential"], MESH, 0.0, 10.0 * math.exp(-1.5), method=method, tolerance=1e-11,
        most_iterations=5000)
    np.testing.assert_allclose(shifted.gap - 1.5, plain.gap, atol=1e-9)
    assert shifted.load == pytest.approx(plain.load * math.exp(-1.5), rel=1e-9)


@pytest.mark.parametrize("law", PRESSURE)
def test_soft_bodies_tend_to_rigid_ones_in_proportion_to_the_coupling(law):
    def load(coupling):
        return snapin.equilibrium(LAW[law], MESH, 1.5, coupling, tolerance=1e-12).load

    differences = np.array([load(c) - load(0.0) for c in (1e-3, 1e-4, 1e-5)])
    np.testing.assert_allclose(differences[:-1] / differences[1:], 10, rtol=0.05)
