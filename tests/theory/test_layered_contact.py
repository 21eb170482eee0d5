"""Claims about Hertz's and JKR theory of layered bodies (&classical with &layer)."""

import math

import numpy as np
import pytest
from support.scenes import deck, runner

SIGMA = 25.0
# Contact radius of JKR theory without load, by which thicknesses are measured.
RADIUS = (9 * math.pi * SIGMA) ** (1 / 3)


@pytest.fixture(scope="module")
def solve(snapin, tmp_path_factory):
    return runner(snapin, tmp_path_factory.mktemp("layered"))


def theory(thickness, nu, base=None, sigma=SIGMA, h0_end=-20.0, **groups):
    """Theories of a film whose half-space would have sigma, under something rigid; base: ratio of
    the shear moduli, film over base, and the base's Poisson's ratio."""
    young = (1 - nu**2) / 2
    bodies = {"radius": 1.0, "rigid": True}
    if base:
        bodies = {"radius": 1.0, "young": young / (1 + nu) * (1 + base[1]) / base[0],
                  "poisson": base[1]}
    return deck(bodies=bodies,
                layer={"thickness": thickness, "young": young, "poisson": nu, "partner": "rigid"},
                force={"law": "lennard_jones", "hamaker": 16 * math.pi * sigma, "z0": 1.0},
                classical={"h0_start": 20.0, "h0_end": h0_end, "count": 40}, **groups)


# F/F_Hertz against sqrt(R delta)/t of an incompressible film on something rigid, from a solution of
# the integral equation that shares nothing with the program.
SPHERE = [(0.18507, 1.26977), (0.41721, 1.85712), (0.62011, 2.68406), (0.74794, 3.37110),
          (1.05444, 5.56319), (1.34893, 8.46801)]


@pytest.mark.parametrize("chi, ratio", SPHERE)
def test_a_sphere_on_an_incompressible_film(solve, chi, ratio):
    found = solve(theory(1 / chi, 0.5, sigma=1.0, h0_end=-1.0)).summary
    assert found["effective_modulus"] / found["top_modulus"] == pytest.approx(ratio, rel=2e-5)


# Pull-off over pi R w, from the same solution: incompressible films on something rigid, and films
# of five times the shear modulus of their base, both of Poisson's ratio 0.3.
PULL_OFF = [(3, 0.5, None, 1.51029), (1, 0.5, None, 1.65416), (0.5, 0.5, None, 1.87629),
            (3, 0.3, (5, 0.3), 1.48906), (1, 0.3, (5, 0.3), 1.34493),
            (0.5, 0.3, (5, 0.3), 1.17724)]


@pytest.mark.parametrize("part, nu, base, pull_off", PULL_OFF)
def test_pull_off_of_jkr_theory(solve, part, nu, base, pull_off):
    found = solve(theory(part * RADIUS, nu, base)).summary
    assert found["jkr_pull_off"] / (math.pi * SIGMA) == pytest.approx(pull_off, abs=6e-6)


@pytest.mark.parametrize("part, nu, base", [(1, 0.5, None), (0.5, 0.3, (5, 0.3))])
def test_lennard_jones_forces_pull_as_much_over_jkr_as_on_a_half_space(solve, part, nu, base):
    found = solve(theory(part * RADIUS, nu, base, equilibrium_path={"h0_end": -2.0})).summary
    half = solve(deck(bodies={"radius": 1.0, "stiffness": 1.0}, force={
        "law": "lennard_jones", "hamaker": 16 * math.pi * SIGMA, "z0": 1.0},
        equilibrium_path={"h0_end": -2.0})).summary
    plain = half["max_tension"] / half["jkr_pull_off"]
    assert found["max_tension"] / found["jkr_pull_off"] == pytest.approx(plain, abs=3e-4)
    assert abs(plain - 1) > 3e-3


@pytest.mark.parametrize("shape", [None, {"kind": "cone", "half_angle": 1.0}])
def test_equal_moduli_are_hertz_and_jkr(solve, shape):
    # The cone, of no radius, makes wide contacts in these units.
    scene = theory(100.0 if shape else 2.0, 0.3, base=(1.0, 0.3))
    plain = deck(bodies={"radius": 1.0, "stiffness": 1.0},
                 force={"law": "lennard_jones", "hamaker": 16 * math.pi * SIGMA, "z0": 1.0},
                 classical={"h0_start": 20.0, "h0_end": -20.0, "count": 40})
    if shape:
        scene, plain = (text.replace("  radius = 1.0\n", "") + deck(shape=shape)
                        for text in (scene, plain))
    layered, half = (solve(text).table("classical.csv") for text in (scene, plain))
    for name in ("hertz", "jkr"):
        mine, other = layered.rows(f"{name}_layered"), half.rows(name)
        here = mine["h0"] > -20  # In the first rows Hertz's contact is smaller than is tabulated.
        assert here.sum() > 5
        for column in ("load", "contact_radius"):
            expected = np.interp(-mine["h0"], -other["h0"], other[column])
            assert mine[column][here] == pytest.approx(expected[here], rel=1e-6, abs=1e-9)


def test_a_film_has_the_modulus_of_its_base_below_a_large_sphere(solve):
    base = (0.1, 0.2)
    found = [solve(theory(t, 0.4, base, sigma=1.0, h0_end=-1.0)).summary for t in (0.03, 100.0)]
    assert found[0]["effective_modulus"] == pytest.approx(found[0]["bottom_modulus"], rel=0.1)
    assert found[1]["effective_modulus"] == pytest.approx(found[1]["top_modulus"], rel=0.01)
