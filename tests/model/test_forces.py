"""Claims about the forces that a deck may add up: each against its formula, and sums of them."""

import math

import numpy as np
import pytest
import snapin
from conftest import ROOT

Z0, HAMAKER = 0.5e-9, 1e-19
TABLE = ROOT / "inputs" / "examples" / "tabulated.txt"
GAP = np.geomspace(0.05e-9, 200e-9, 80)


def pressure(gap=GAP, **groups):
    """Return the pressure [Pa] of a deck's forces."""
    return snapin.force_law(groups, gap).pressure


def claim(found, exact, size=None):
    """Equal to rounding of the terms that they are made of."""
    assert (abs(found - exact) <= 1e-13 * (abs(exact) if size is None else size)).all()


# --- Powers


def test_van_der_waals_and_born_make_the_lennard_jones_law():
    sum_of = snapin.force_law({"van_der_waals": {"hamaker": HAMAKER}, "born": {"z0": Z0}}, GAP)
    whole = snapin.force_law(snapin.lennard_jones(hamaker=HAMAKER, z0=Z0), GAP)
    repulsion, attraction = (
        snapin.force_law(snapin.lennard_jones(hamaker=HAMAKER, z0=Z0, part=part), GAP)
        for part in ("repulsive", "attractive")
    )
    for found, exact, up, down in zip(sum_of, whole, repulsion, attraction):
        claim(found, exact, abs(up) + abs(down))


@pytest.mark.parametrize("z0", [1e-15, 1e-9, 1.0, 1e9])
def test_a_power_has_no_length_that_others_could_be_too_long_or_short_for(z0):
    groups = {"van_der_waals": {"hamaker": 1e-19 * z0**2}, "born": {"z0": z0}}
    numbers = snapin.law_numbers(groups)
    assert numbers.rest_gap == pytest.approx(z0, rel=1e-12)
    assert numbers.edge_gap == pytest.approx(3 ** (1 / 6) * z0, rel=1e-12)
    assert numbers.surface_energy == pytest.approx(1e-19 / (16 * math.pi), rel=1e-12)


def test_retardation_is_gregory_s_and_far_away_an_inverse_fourth_power():
    length = 1e-8
    c = 5.32 / length
    found = pressure(van_der_waals={"hamaker": HAMAKER, "retardation_length": length})
    plain = -HAMAKER / (6 * math.pi * GAP**3)
    claim(found, plain * (1 + 1.5 * c * GAP) / (1 + c * GAP) ** 2)
    far = np.array([1e-2])
    found = pressure(far, van_der_waals={"hamaker": HAMAKER, "retardation_length": length})
    assert found == pytest.approx(-HAMAKER * length / (4 * math.pi * 5.32 * far**4), rel=1e-5)


def test_exponents_of_lennard_jones():
    w = 0.01
    for n, m in ((9, 3), (10, 4), (11, 5), (12, 6), (6, 3)):
        groups = snapin.lennard_jones(surface_energy=w, z0=Z0, exponents=[n, m])
        factor = (n - 1) * (m - 1) / (n - m) * w / Z0
        up, down = factor * (Z0 / GAP) ** n, factor * (Z0 / GAP) ** m
        claim(pressure(**groups), up - down, up + down)
        numbers = snapin.law_numbers(groups)
        assert numbers.surface_energy == pytest.approx(w, rel=1e-14)
        assert numbers.edge_gap == pytest.approx(Z0 * (n / m) ** (1 / (n - m)), rel=1e-14)
    with_hamaker = snapin.lennard_jones(hamaker=HAMAKER, z0=Z0, exponents=[7, 3])
    far = np.array([1e-6])
    assert pressure(far, **with_hamaker) == pytest.approx(-HAMAKER / (6 * math.pi * far**3))


def test_surface_energy_in_place_of_the_hamaker_constant():
    w = HAMAKER / (16 * math.pi * Z0**2)
    found = pressure(force={"law": "lennard_jones", "surface_energy": w, "z0": Z0})
    claim(found, pressure(**snapin.lennard_jones(hamaker=HAMAKER, z0=Z0)),
          abs(pressure(**snapin.lennard_jones(hamaker=HAMAKER, z0=Z0, part="repulsive"))))


# --- Exponentials and steps


def test_hydration_and_hydrophobic_terms_add_up():
    energies, lengths = [5e-3, 2e-2], [1e-9, 0.2e-9]
    exact = sum(w / d * np.exp(-GAP / d) for w, d in zip(energies, lengths))
    groups = {"energy": energies, "decay_length": lengths}
    claim(pressure(hydration=groups), exact)
    claim(pressure(hydrophobic=groups), -exact)
    pressures = [w / d for w, d in zip(energies, lengths)]
    claim(pressure(hydration={"pressure": pressures, "decay_length": lengths}), exact)


def test_steric_force_is_that_of_brushes_and_ends_where_they_part():
    thickness, density, kt = 5e-9, 1e16, 1.380649e-23 * 300
    for sides in (1, 2):
        keys = {"brush_thickness": thickness, "grafting_density": density, "sides": sides,
                "temperature": 300.0}
        u = GAP / (sides * thickness)
        p0 = kt * density**1.5
        claim(pressure(steric=keys), np.where(u < 1, p0 * (u**-2.25 - u**0.75), 0), p0 * u**-2.25)
        parabolic = pressure(steric={**keys, "model": "milner_witten_cates"})
        claim(parabolic, np.where(u < 1, p0 * (0.5 / u**2 - u + 0.5 * u**4), 0), p0 / u**2)


def test_structural_force_oscillates():
    p0, d, xi, phase = 1e6, 0.9e-9, 1.5e-9, 0.4
    exact = p0 * np.cos(2 * np.pi * GAP / d + phase) * np.exp(-GAP / xi)
    keys = {"period": d, "decay_length": xi, "phase": phase}
    size = p0 * np.exp(-GAP / xi) * (1 + 2 * np.pi * GAP / d)
    claim(pressure(structural={"amplitude": p0, **keys}), -exact, size)
    claim(pressure(structural={"amplitude": -p0, **keys}), exact, size)


def test_steps_are_smoothed_error_functions_of_the_same_depth():
    stress, reach, s = 1e7, 2e-9, 0.1e-9
    exact = [-0.5 * stress * math.erfc((h - reach) / s) for h in GAP]
    claim(pressure(dugdale={"stress": stress, "range": reach, "smoothing": s}), np.array(exact),
          stress * np.ones_like(GAP))
    claim(pressure(depletion={"osmotic_pressure": stress, "diameter": reach, "smoothing": s}),
          np.array(exact), stress * np.ones_like(GAP))
    energy = snapin.force_law({"dugdale": {"stress": stress, "range": reach}}, [0.0]).energy[0]
    assert energy == pytest.approx(-stress * reach, rel=1e-12)


def test_a_capillary_bridge_has_the_energy_of_its_surface():
    tension, angle = 0.0728, 0.3
    groups = {"capillary": {"humidity": 0.5, "contact_angle": [angle, 0.0]}}
    radius = 1.807e-5 * tension / (8.31446261815324 * 293.15 * math.log(2))
    assert radius == pytest.approx(0.540e-9 / math.log(2), rel=2e-3)
    near = snapin.force_law(groups, [0.0])
    assert near.pressure[0] == pytest.approx(-tension / radius, rel=1e-12)
    assert near.energy[0] == pytest.approx(-tension * (1 + math.cos(angle)), rel=1e-12)


# --- What decks may not say


@pytest.mark.parametrize(("forces", "phrase"), [
    ("&born z0 = 1e-9 /", '&born: key "hamaker": missing'),
    ("&force law='lennard_jones', hamaker=1e-19, surface_energy=1e-3, z0=1e-9 /",
     '&force: key "surface_energy": follows from hamaker'),
    ("&force law='lennard_jones', z0=1e-9 /", '&force: key "hamaker": missing'),
    ("&force law='lennard_jones', hamaker=1e-19, z0=1e-9, exponents=3,9 /", 'key "exponents"'),
    ("&force law='lennard_jones', hamaker=1e-19, z0=1e-9, exponents=9 /", 'key "exponents"'),
    ("&force law='lennard_jones', hamaker=1e-19, z0=1e-9, exponents=10,4 /",
     'key "work_of_adhesion"'),
    ("&force law='exponential', p0=1, decay_length=1, exponents=9,3 /", 'key "exponents"'),
    ("&hydration decay_length = 1e-9 /", "give either energy or pressure"),
    ("&hydration energy = 1, pressure = 1, decay_length = 1e-9 /",
     "give either energy or pressure"),
    ("&hydration energy = 1, 2, 3, decay_length = 1e-9, 2e-9 /", "another number of values"),
    ("&capillary surface_tension = 0.07 /", "give either kelvin_radius or humidity"),
    ("&capillary humidity = 0.5, kelvin_radius = 1e-9 /", "give either kelvin_radius or humidity"),
    ("&dugdale stress = 1e7, range = 1e-9, smoothing = 0.8e-9 /", 'key "smoothing"'),
    ("&structural amplitude = 0, period = 1e-9, decay_length = 1e-9 /", 'key "amplitude"'),
    ("&morse surface_energy = 1, z0 = 1e-9 /", 'key "decay_length": missing'),
    ("&van_der_waals hamaker = 1e-300 /", "numbers have decimal orders"),
    ("&double_layer potential = 0.05, debye_length = 2e-9, salt = 1 /", "debye_length"),
    ("&double_layer potential = 0.05 /", "debye_length"),
    ("&double_layer potential = 0, debye_length = 2e-9 /", 'key "potential"'),
    ("&double_layer potential = 0.6, debye_length = 2e-9 /", "20 kT"),
    ("&double_layer potential = 3*0.1, debye_length = 2e-9 /", "too many values"),
    ("&double_layer debye_length = 2e-9 /", 'key "potential": missing'),
    (f"&tabulated file = '{TABLE}' /", "give tail_exponent or tail_decay_length"),
    (f"&tabulated file = '{TABLE}', tail_exponent = 3, tail_decay_length = 1e-9 /",
     "give tail_exponent or tail_decay_length"),
    (f"&tabulated file = '{TABLE}', tail_decay_length = 1e-11 /", "exp(-10)"),
    ("&tabulated file = 'nowhere/law.txt', tail_exponent = 3 /", "no such file"),
    ("&tabulated tail_exponent = 3 /", '&tabulated: key "file": missing'),
])
def test_forces_that_contradict_themselves_are_refused(check, forces, phrase):
    status, _, err = check(
        "&bodies radius = 1e-5, stiffness = 1e10 /\n"
        f"{forces}\n&equilibrium_path h0_end = -1e-9 /\n"
    )
    assert status == 2
    assert phrase in err, err


# --- What the scan of a sum finds


def test_layers_of_a_liquid_have_their_contact_at_a_positive_separation():
    """The formula goes on to negative ones with ever larger swings, which mean nothing."""
    layers = {"structural": {"amplitude": 3e6, "period": 0.9e-9, "decay_length": 1e-9}}
    numbers = snapin.law_numbers(layers)
    assert numbers.rest_gap == pytest.approx(0.75 * 0.9e-9, rel=1e-12)
    assert 0 < numbers.surface_energy < 3e6 * 0.9e-9


def test_what_is_left_of_repulsions_far_away_is_no_well():
    """The sum of a longer and a shorter exponential, whose signs rounding decides far away."""
    groups = {
        "structural": {"amplitude": 3e6, "period": 0.9e-9, "decay_length": 0.5e-9},
        "hydration": {"energy": 5e-3, "decay_length": 0.9e-9}}
    assert (pressure(GAP, **groups) >= 0).all()
    numbers = snapin.law_numbers(groups)
    assert numbers.surface_energy == 0
    assert math.isnan(numbers.rest_gap) and math.isnan(numbers.edge_gap)
