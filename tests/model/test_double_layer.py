"""Claims about electric double layers: closed forms, and the Poisson-Boltzmann equation itself."""

import math

import numpy as np
import pytest
import snapin
from support import boundary_value
from support.calculus import derivative, integrals

# Unit of potential [V], a Debye length [m], and the osmotic pressure 2 n kT [Pa] that they make.
THERMAL = 1.380649e-23 * 298.15 / 1.602176634e-19
LENGTH = 2e-9
OSMOTIC = 78.4 * 8.8541878128e-12 * (THERMAL / LENGTH) ** 2

# Reduced potentials, and regulation from 0, constant potential, to 1, constant charge.
SURFACES = [
    ((4, 4), (0, 0)),
    ((4, 4), (1, 1)),
    ((4, 4), (0.5, 0.5)),
    ((4, 1), (0, 0)),
    ((4, 1), (1, 1)),
    ((4, -1), (0, 0)),
    ((4, -4), (1, 1)),
    ((3, 2), (0, 1)),
    ((2, 0), (0.4, 0.7)),
    ((8, -3), (0.3, 0.6)),
    ((0.01, 0.004), (0.3, 0.8)),
]
every_pair = pytest.mark.parametrize(("y", "p"), SURFACES)
MODELS = ("linear", "superposition", "nonlinear")


def group(y, p=(1, 1), model="linear", **keys):
    """Return the group of two surfaces with reduced potentials y and regulation p."""
    given = {"debye_length": LENGTH, **keys}
    potential = [float(one) * THERMAL for one in y]
    return {"double_layer": {"potential": potential, "regulation": p, "model": model, **given}}


def values(gap, *args, **keys):
    """Return pressure, slope and energy without units at gaps in Debye lengths."""
    found = snapin.force_law(group(*args, **keys), np.asarray(gap) * LENGTH)
    units = OSMOTIC, OSMOTIC / LENGTH, OSMOTIC * LENGTH
    return [value / unit for value, unit in zip(found, units)]


@pytest.mark.parametrize("model", MODELS)
@every_pair
def test_slope_is_the_derivative_and_energy_the_integral(model, y, p):
    gap = np.geomspace(1e-5, 30, 200)
    pressure, slope, energy = values(gap, y, p, model)

    def of(at):
        return values(at, y, p, model)[0]

    differences = derivative(of, gap, 1e-2 * np.minimum(gap, 1))
    # Of a neutral surface, and where forces cancel, this much of what charges feel still counts.
    scale = max(abs(y[0]), abs(y[1])) ** 2 * np.exp(-gap)
    # Error of the sixth order, and rounding over the step.
    size = (abs(pressure) + scale) / np.minimum(gap, 1)
    assert (abs(slope - differences) <= 1e-9 * size).all()
    integral, size = integrals(of, gap)
    size += abs(energy[:-1]) + 1e-2 * scale[:-1]
    assert (abs(energy[:-1] - energy[1:] - integral) <= 1e-12 * size).all()


# --- Closed forms


@every_pair
def test_linear_model_is_that_of_carnie_and_chan(y, p):
    """Its limits of regulation are those of Hogg, Healy and Fuerstenau."""
    gap = np.geomspace(0.01, 30, 60)
    (a, b), x = 2 * np.array(p) - 1, np.exp(-gap)
    mixed = b * y[0] ** 2 + a * y[1] ** 2
    scale = 1 - a * b * x**2
    pressure = 2 * x * (y[0] * y[1] * (1 + a * b * x**2) + mixed * x) / scale**2
    energy = 2 * (y[0] * y[1] * x + mixed * x**2 / 2) / scale
    size = (y[0] ** 2 + y[1] ** 2) * x / scale**2
    found = values(gap, y, p)
    # The sums as written lose digits where terms cancel.
    assert (abs(found[0] - pressure) <= 1e-13 * size).all()
    assert (abs(found[2] - energy) <= 1e-13 * size).all()


def test_equal_constant_potentials_push_to_all_digits_down_to_contact():
    gap = np.geomspace(1e-5, 1, 30)
    pressure, _, energy = values(gap, (1, 1), (0, 0))
    np.testing.assert_allclose(pressure, 1 / (2 * np.cosh(gap / 2) ** 2), rtol=1e-13)
    np.testing.assert_allclose(energy, 2 / (1 + np.exp(gap)), rtol=1e-13)


def test_superposition_is_an_exponential():
    gap = np.linspace(-5, 30, 50)
    exact = 32 * math.tanh(1) * math.tanh(-0.5) * np.exp(-gap)
    for value, sign in zip(values(gap, (4, -2), model="superposition"), (1, -1, 1)):
        np.testing.assert_allclose(value, sign * exact, rtol=1e-13)


# --- The Poisson-Boltzmann equation


@every_pair
def test_nonlinear_pressure_is_that_of_a_boundary_value_problem(y, p):
    gap = np.array([0.1, 0.3, 1, 2, 4])
    found = values(gap, y, p, "nonlinear")[0]
    for one, at in zip(found, gap):
        exact, spread = boundary_value.pressure(y, p, at)
        assert spread <= 1e-10 * abs(exact)
        assert one == pytest.approx(exact, rel=1e-10)


@every_pair
def test_far_apart_layers_superpose(y, p):
    ends = [values([17.0], y, p, model)[0][0] for model in ("nonlinear", "superposition")]
    # The neutral surface has no first order: what is left is the second.
    assert ends[0] == pytest.approx(ends[1], rel=1e-4, abs=50 * math.exp(-2 * 17))


@pytest.mark.parametrize("p", [(0, 0), (1, 1), (0, 1), (0.3, 0.6)])
def test_small_potentials_are_those_of_the_linear_equation(p):
    gap = np.geomspace(0.1, 20, 30)
    y = (1e-3, -4e-4)
    linear, nonlinear = (values(gap, y, p, model)[0] for model in ("linear", "nonlinear"))
    # Of second order in the potential, which constant charge raises as the gap closes.
    assert (abs(nonlinear - linear) <= 1e-4 * abs(linear) + 1e-10 * np.exp(-gap)).all()


@pytest.mark.parametrize("model", ["linear", "nonlinear"])
def test_unlike_constant_potentials_attract_at_small_gaps(model):
    gap = np.array([1e-5])
    pressure = values(gap, (3, 1), (0, 0), model)[0]
    assert pressure[0] == pytest.approx(-((3 - 1) ** 2) / (2 * gap[0] ** 2), rel=1e-4)
    assert values([3.0], (3, 1), (0, 0), model)[0] > 0


def test_trapped_ions_push_as_an_ideal_gas():
    gap = np.array([1e-5])
    charge = 2 * math.sinh(2) + 2 * math.sinh(0.5)
    assert values(gap, (4, 1), model="nonlinear")[0] * gap == pytest.approx(charge, rel=1e-4)


def test_surfaces_may_change_places_and_signs():
    gap = np.geomspace(0.01, 20, 30)
    for model in MODELS:
        one = values(gap, (3, -1), (0.2, 0.9), model)
        np.testing.assert_allclose(values(gap, (-1, 3), (0.9, 0.2), model), one, rtol=1e-13)
        np.testing.assert_allclose(values(gap, (-3, 1), (0.2, 0.9), model), one, rtol=1e-13)


@pytest.mark.parametrize("seed", range(8))
def test_every_pair_of_surfaces_is_solved(seed):
    draw = np.random.default_rng(seed)
    for _ in range(3):
        y = draw.uniform(-19, 19, 2) * draw.choice([1, 0.3, 0.02])
        p = draw.choice([0, 1, draw.uniform()], 2)
        y[1] = draw.choice([y[0], -y[0], 0, y[1]])
        gap = draw.uniform(0.2, 3, 1)
        found = values(gap, y, p, "nonlinear")[0][0]
        exact, spread = boundary_value.pressure(y, p, gap[0], order=32, pieces=8)
        assert abs(found - exact) <= 1e-8 * abs(exact) + 10 * spread + 1e-12


# --- The deck


def test_salt_sets_the_debye_length():
    by_salt = {"potential": 0.02, "salt": 1.0, "valence": 2}
    density = 6.02214076e23 * 2 * (2 * 1.602176634e-19) ** 2
    length = math.sqrt(78.4 * 8.8541878128e-12 * 1.380649e-23 * 298.15 / density)
    assert snapin.law_numbers({"double_layer": by_salt}).length == pytest.approx(length, rel=1e-9)
    assert length == pytest.approx(4.8e-9, rel=0.01)
