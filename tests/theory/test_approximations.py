"""Claims about slowly varying deformation, (21)-(36): its forms agree, and rigid bodies."""

import math

import numpy as np
import pytest
import snapin
from support.calculus import derivative, gauss

RADIUS, STIFFNESS = 1.5e-2, 1e10
BODIES = {"radius": RADIUS, "stiffness": STIFFNESS}
Z0, HAMAKER = 0.5e-9, 1e-19
P0, DECAY = 2.5e8, 1e-9
FULL = snapin.lennard_jones(hamaker=HAMAKER, z0=Z0)
PARTS = ("full", "repulsive", "attractive")


def lennard_jones(sigma, part="full"):
    """The law in units of z0 that has this sigma between bodies with R = E/(1-nu^2) = 1."""
    return snapin.lennard_jones(hamaker=16 * math.pi * sigma, z0=1.0, part=part)


UNITS = {"radius": 1.0, "stiffness": 1.0}


def cosine_integral(m):
    """I_m of (35)."""
    return math.pi * math.factorial(2 * m) / (2 * (2**m * math.factorial(m)) ** 2)


def closed_forms(part, h, radius=RADIUS, stiffness=STIFFNESS):
    """Terms of (35a) and (36a), repulsive and attractive, as the paper writes them, in SI."""
    use = [part in ("full", "repulsive"), part in ("full", "attractive")]
    delta = math.sqrt(2 * radius) * 2 * HAMAKER / (3 * math.pi) / stiffness * h**-2.5
    load = 2 * math.pi * radius * HAMAKER / (12 * math.pi * h**2)
    ratio = (Z0 / h) ** 6
    return (
        [use[0] * delta * ratio * cosine_integral(8), -use[1] * delta * cosine_integral(2)],
        [use[0] * load * ratio / 4, -use[1] * load])


# --- Forms


@pytest.mark.parametrize("stiffness", [1e3, STIFFNESS, 1e18])
@pytest.mark.parametrize("form", ["quadrature", "closed_form"])
@pytest.mark.parametrize("part", PARTS)
def test_lennard_jones_is_35a_and_36a_in_every_form(part, form, stiffness):
    law = snapin.lennard_jones(hamaker=HAMAKER, z0=Z0, part=part)
    gap = Z0 * np.geomspace(1e-6, 1e6, 500)
    found = snapin.slow_deformation(gap, radius=RADIUS, stiffness=stiffness, law=law, form=form)
    for value, terms in zip(
            (found.displacement, found.load), closed_forms(part, gap, stiffness=stiffness)):
        # Where the parts cancel, their sizes set the rounding.
        assert (abs(value - sum(terms)) <= 1e-14 * sum(map(abs, terms))).all()
    np.testing.assert_array_equal(found.h0, gap - found.displacement)


@pytest.mark.parametrize("form", ["quadrature", "closed_form"])
@pytest.mark.parametrize("stiffness", [1e3, STIFFNESS, 1e18])
def test_exponential_is_31_and_32_in_every_form(form, stiffness):
    gap = DECAY * np.concatenate([np.linspace(-40, 40, 161), np.geomspace(1e-12, 500, 60)])
    found = snapin.slow_deformation(
        gap, radius=RADIUS, stiffness=stiffness, law=snapin.exponential(p0=P0, decay_length=DECAY),
        form=form)
    pressure = P0 * np.exp(-gap / DECAY)
    # The exponent, up to 500, carries its own rounding.
    delta = 2 / stiffness * math.sqrt(2 * math.pi * RADIUS * DECAY) * pressure
    np.testing.assert_allclose(found.displacement, delta, rtol=2e-13)
    np.testing.assert_allclose(found.load, 2 * math.pi * RADIUS * DECAY * pressure, rtol=2e-13)
    np.testing.assert_allclose(found.slope, -delta / DECAY, rtol=2e-13)


def test_attraction_alone_is_35b_and_36b():
    gap = Z0 * np.geomspace(0.1, 100, 50)
    found = snapin.slow_deformation(gap, **BODIES, law=FULL, form="attraction_only")
    delta = -math.sqrt(2 * RADIUS) * HAMAKER / 8 / STIFFNESS * gap**-2.5
    np.testing.assert_allclose(found.displacement, delta, rtol=1e-14)
    np.testing.assert_allclose(found.load, -RADIUS * HAMAKER / (6 * gap**2), rtol=1e-14)
    part = snapin.lennard_jones(hamaker=HAMAKER, z0=Z0, part="attractive")
    for form in ("quadrature", "closed_form"):
        for one, other in zip(snapin.slow_deformation(gap, **BODIES, law=part, form=form), found):
            np.testing.assert_allclose(one, other, rtol=1e-13)


@pytest.mark.parametrize("form", ["quadrature", "closed_form", "attraction_only"])
def test_slope_is_the_derivative_of_the_displacement(form):
    gap = Z0 * np.geomspace(0.5, 40, 60)
    step = 1e-2 * gap

    def at(h):
        return snapin.slow_deformation(h, **BODIES, law=FULL, form=form)

    slope = derivative(lambda h: at(h).displacement, gap, step)
    size = sum(map(abs, closed_forms("full", gap)[0])) / gap
    assert (abs(at(gap).slope - slope) <= 1e-8 * size).all()


def test_displacement_is_the_integral_of_the_pressure_over_the_plane():
    """Equation (22)."""
    # (13) at the centre of bodies that keep their shape, for the law as the program has it:
    # delta = 4 (1-nu^2)/E times the integral of p(h + t^2/(2R)) over t.
    h = 1.3 * Z0
    angle, weight = gauss(200, 0, math.pi / 2)
    t = math.sqrt(2 * RADIUS * h) * np.tan(angle)
    pressure = snapin.force_law(FULL, h + t**2 / (2 * RADIUS)).pressure
    integral = weight @ (pressure * math.sqrt(2 * RADIUS * h) / np.cos(angle) ** 2)
    found = snapin.slow_deformation([h], **BODIES, law=FULL)
    assert found.displacement[0] == pytest.approx(4 / STIFFNESS * integral, rel=1e-12)


@pytest.mark.parametrize("law", [
    {"dugdale": {"stress": 1e7, "range": 1e-9, "smoothing": 1e-15}},
    {"dugdale": {"stress": 1e7, "range": 1e-9, "smoothing": 1e-17}},
    {"steric": {"brush_thickness": 0.5e-9, "grafting_density": 1e17}},
], ids=["sharp_step", "sharper_step", "kink"])
def test_a_step_or_a_kink_costs_no_digits(law):
    # The same integral in two pieces that end at the step or kink, where h is 1 nm.
    end = 1e-9
    x, w = np.polynomial.legendre.leggauss(80)
    for gap in (0.1e-9, 0.5e-9, 0.95e-9):
        t = math.sqrt(2 * RADIUS * (end - gap)) * (x + 1) / 2
        pressure = snapin.force_law(law, gap + t**2 / (2 * RADIUS)).pressure
        integral = w @ pressure * math.sqrt(2 * RADIUS * (end - gap)) / 2
        found = snapin.slow_deformation([gap], **BODIES, law=law)
        assert found.displacement[0] == pytest.approx(4 / STIFFNESS * integral, rel=1e-8)


# --- Rigid bodies


@pytest.mark.parametrize("part", PARTS)
def test_rigid_bodies_have_derjaguins_load_and_no_displacement(part):
    law = snapin.lennard_jones(hamaker=HAMAKER, z0=Z0, part=part)
    gap = Z0 * np.geomspace(0.5, 40, 20)
    energy = snapin.force_law(law, gap).energy
    for form in ("quadrature", "closed_form"):
        found = snapin.slow_deformation(gap, radius=RADIUS, rigid=True, law=law, form=form)
        np.testing.assert_array_equal(found.h0, gap)
        assert not found.displacement.any() and not found.slope.any()
        size = sum(map(abs, closed_forms(part, gap)[1]))
        assert (abs(found.load - 2 * math.pi * RADIUS * energy) <= 1e-14 * size).all()
