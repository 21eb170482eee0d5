"""Claims about every force law: its functions fit together, in SI, at any gap."""

import math

import numpy as np
import pytest
import snapin
from support.laws import LAWS

Z0, HAMAKER = 0.5e-9, 1e-19
every_law = pytest.mark.parametrize("law", LAWS)


def functions(law):
    """Return the law as a function of gaps [m]."""
    return lambda gap: snapin.force_law(LAWS[law], gap)


@every_law
def test_far_away_there_is_nothing(law):
    length = snapin.law_numbers(LAWS[law]).length
    for values in functions(law)(length * np.array([1e12, 1e30, 1e90])):
        assert np.isfinite(values).all()
        assert (abs(values) <= 1e-9).all()


@every_law
def test_numbers_say_where_the_pressure_vanishes_and_is_least(law):
    of, numbers = functions(law), snapin.law_numbers(LAWS[law])
    unit = numbers.pressure_unit
    if not math.isnan(numbers.rest_gap):
        assert abs(of([numbers.rest_gap]).pressure[0]) <= 1e-14 * unit
        assert of([numbers.rest_gap]).energy[0] == pytest.approx(-numbers.surface_energy)
    if not math.isnan(numbers.edge_gap):
        assert abs(of([numbers.edge_gap]).slope[0]) <= 1e-14 * unit / numbers.length
        near = numbers.edge_gap * np.array([0.99, 1, 1.01])
        assert of(near).pressure.argmin() == 1
    # Nothing is left of a repulsion beyond its range, compared with its unit.
    if law in ("repulsive", "exponential"):
        assert of([numbers.range]).pressure[0] <= 1e-15 * unit
        assert numbers.surface_energy == 0
        assert math.isnan(numbers.edge_gap) and math.isnan(numbers.rest_gap)


# --- Lennard-Jones


def test_lennard_jones_and_its_parts_are_equations_33_and_34():
    gap, unit = Z0 * np.geomspace(0.5, 40, 60), HAMAKER / (6 * math.pi)
    up = unit * Z0**6 * np.array([gap**-9, -9 * gap**-10, gap**-8 / 8])
    down = unit * np.array([-(gap**-3), 3 * gap**-4, -(gap**-2) / 2])
    for part, *terms in (("lennard_jones", up, down), ("repulsive", up), ("attractive", down)):
        found = np.array(functions(part)(gap))
        assert (abs(found - sum(terms)) <= 1e-14 * sum(map(abs, terms))).all()
    numbers, gamma = snapin.law_numbers(LAWS["lennard_jones"]), HAMAKER / (16 * math.pi * Z0**2)
    assert numbers.rest_gap == Z0 == numbers.length
    assert functions("lennard_jones")([Z0]).pressure == 0
    assert numbers.edge_gap == pytest.approx(3 ** (1 / 6) * Z0, rel=1e-15)
    assert numbers.surface_energy == pytest.approx(gamma, rel=1e-15)
    assert numbers.pressure_unit == pytest.approx(gamma / Z0, rel=1e-15)


# --- Exponential

UNIT = snapin.exponential(p0=1.0, decay_length=1.0)


def test_exponential_is_equation_30():
    p0, length = 2.5e8, 0.2e-9
    gap = length * np.linspace(-20, 40, 61)
    values = functions("exponential")(gap)
    pressure = p0 * np.exp(-gap / length)
    # The exponent, up to 40, carries its own rounding.
    np.testing.assert_allclose(values.pressure, pressure, rtol=1e-14)
    np.testing.assert_allclose(values.slope, -pressure / length, rtol=1e-14)
    np.testing.assert_allclose(values.energy, pressure * length, rtol=1e-14)


def test_exponential_is_finite_at_a_thousand_decay_lengths_and_vanishes_without_underflow():
    values = snapin.force_law(UNIT, [-1e3, -1e300])
    assert np.isfinite(values).all()
    assert values.pressure[0] > 1e300 and values.slope[0] < -1e300 and values.energy[0] > 1e300
    assert not np.any(snapin.force_law(UNIT, [1e3, 1e300]))
