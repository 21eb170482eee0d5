"""Claims about Hertz's and JKR theory of layered bodies (&classical with &layer)."""

import math

import numpy as np
import pytest
from support.known import PUNCH, PUNCH_ON_FILM, SPHERE_ON_FILM
from support.scenes import deck, lennard_jones

SIGMA = 25.0
# Contact radius of JKR theory without load, by which thicknesses are measured.
RADIUS = (9 * math.pi * SIGMA) ** (1 / 3)


def theory(thickness, nu, base=None, sigma=SIGMA, h0_end=-20.0, count=40, **groups):
    """Theories of a film whose half-space would have sigma, under something rigid; base: ratio of
    the shear moduli, film over base, and the base's Poisson's ratio."""
    young = (1 - nu**2) / 2
    bodies = {"radius": 1.0, "rigid": True}
    if base:
        bodies = {"radius": 1.0, "young": young / (1 + nu) * (1 + base[1]) / base[0],
                  "poisson": base[1]}
    return lennard_jones(
        sigma, bodies=bodies,
        layer={"thickness": thickness, "young": young, "poisson": nu, "partner": "rigid"},
        classical={"h0_start": 20.0, "h0_end": h0_end, "count": count}, **groups)


@pytest.mark.parametrize("chi, ratio", SPHERE_ON_FILM)
def test_a_sphere_on_an_incompressible_film(run, chi, ratio):
    found = run(theory(1 / chi, 0.5, sigma=1.0, h0_end=-1.0)).summary
    assert found["effective_modulus"] / found["top_modulus"] == pytest.approx(ratio, rel=2e-5)


@pytest.mark.parametrize("nu", PUNCH_ON_FILM)
def test_a_flat_punch_on_a_film(run, nu):
    """Bodies that do not adhere move on by a flat punch of the radius that they have."""
    rows = run(theory(1.0, nu, h0_end=-3.0, sigma=1.0, count=1000)).table("classical.csv")
    rows = rows.rows("hertz_layered")
    a = rows["contact_radius"]
    # Both are smooth in the radius, beside the power that they begin with.
    depth, load = (np.polynomial.Chebyshev.fit(a, rows[name] / a**power, 16)
                   for name, power in (("displacement", 2), ("load", 3)))
    at = np.array(PUNCH)
    slope = ((3 * at**2 * load(at) + at**3 * load.deriv()(at))
             / (2 * at * depth(at) + at**2 * depth.deriv()(at)))
    # E* is one half in these units; four digits are printed.
    assert slope / at == pytest.approx(PUNCH_ON_FILM[nu], rel=7e-5)


# Pull-off over pi R w, from the same solution: incompressible films on something rigid, and films
# of five times the shear modulus of their base, both of Poisson's ratio 0.3.
PULL_OFF = [(3, 0.5, None, 1.51029), (1, 0.5, None, 1.65416), (0.5, 0.5, None, 1.87629),
            (3, 0.3, (5, 0.3), 1.48906), (1, 0.3, (5, 0.3), 1.34493),
            (0.5, 0.3, (5, 0.3), 1.17724)]


@pytest.mark.parametrize("part, nu, base, pull_off", PULL_OFF)
def test_pull_off_of_jkr_theory(run, part, nu, base, pull_off):
    found = run(theory(part * RADIUS, nu, base)).summary
    assert found["jkr_pull_off"] / (math.pi * SIGMA) == pytest.approx(pull_off, abs=6e-6)


@pytest.mark.parametrize("part", [3, 1, 0.5])
@pytest.mark.parametrize("nu, base", [(0.5, None), (0.3, (5, 0.3)), (0.45, (0.2, 0.2))])
def test_lennard_jones_forces_pull_as_much_over_jkr_as_on_a_half_space(run, part, nu, base):
    found = run(theory(part * RADIUS, nu, base, equilibrium_path={"h0_end": -2.0})).summary
    half = run(lennard_jones(SIGMA, equilibrium_path={"h0_end": -2.0})).summary
    plain = half["max_tension"] / half["jkr_pull_off"]
    assert found["max_tension"] / found["jkr_pull_off"] == pytest.approx(plain, abs=3e-4)
    assert abs(plain - 1) > 3e-3


@pytest.mark.parametrize("shape", [None, {"kind": "cone", "half_angle": 1.0}])
def test_equal_moduli_are_hertz_and_jkr(run, shape):
    # The cone, of no radius, makes wide contacts in these units.
    scene = theory(100.0 if shape else 2.0, 0.3, base=(1.0, 0.3))
    plain = lennard_jones(SIGMA, classical={"h0_start": 20.0, "h0_end": -20.0, "count": 40})
    if shape:
        scene, plain = (text.replace("  radius = 1.0\n", "") + deck(shape=shape)
                        for text in (scene, plain))
    layered, half = (run(text).table("classical.csv") for text in (scene, plain))
    for name in ("hertz", "jkr"):
        mine, other = layered.rows(f"{name}_layered"), half.rows(name)
        here = mine["h0"] > -20  # In the first rows Hertz's contact is smaller than is tabulated.
        assert here.sum() > 5
        for column in ("load", "contact_radius"):
            expected = np.interp(-mine["h0"], -other["h0"], other[column])
            assert mine[column][here] == pytest.approx(expected[here], rel=1e-6, abs=1e-9)


def test_a_note_says_where_the_theories_of_layers_end(run):
    """At a contact radius of forty thicknesses."""
    def notes(summary):
        found = summary.get("notes", [])
        return " ".join([found] if isinstance(found, str) else found)

    within, beyond = (run(theory(0.5, 0.4, (0.1, 0.2), sigma=1.0, h0_end=h0)).summary
                      for h0 in (-1.0, -1000.0))
    assert "up to a contact radius of 20 m" in notes(beyond)
    assert "effective_modulus" in within and "effective_modulus" not in beyond
    assert "contact radius" not in notes(within)


def test_a_film_has_the_modulus_of_its_base_below_a_large_sphere(run):
    base = (0.1, 0.2)
    found = [run(theory(t, 0.4, base, sigma=1.0, h0_end=-1.0)).summary for t in (0.03, 100.0)]
    assert found[0]["effective_modulus"] == pytest.approx(found[0]["bottom_modulus"], rel=0.1)
    assert found[1]["effective_modulus"] == pytest.approx(found[1]["top_modulus"], rel=0.01)
