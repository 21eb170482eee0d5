"""The sphere under the Lennard-Jones law at values of Tabor's parameter that others tabulate."""

import math

import pytest
import snapin

# From another program, to 2e-9, by Tabor's parameter: pull-off over pi w R and where it is; jumps
# in and out, h0 and load each, and energy lost in a cycle, in units of w R and z0.
TABLE = {
    0.01: (1.998969, 1.0019),
    0.1: (1.968956, 1.0586),
    0.5: (1.787483, 1.4470),
    0.8: (1.706360, 1.7087, 2.37954, -0.85003, 2.40423, -1.08670, 0.0336),
    1: (1.670665, 1.8734, 2.62922, -0.68109, 2.74343, -1.03243, 0.2507),
    2: (1.583595, 2.6581, 3.55191, -0.36778, 4.38170, -0.90971, 2.8983),
    5: (1.525718, 4.9594, 5.26358, -0.16712, 9.18977, -0.85177, 16.2459),
}
# Their loads are over pi, as the pull-off.
UNITS = (math.pi, 1, 1, math.pi, 1, math.pi, 1)
DIGITS = (6, 4, 5, 5, 5, 5, 4)
KEYS = ("max_tension", "max_tension_h0", "jump_in_h0", "jump_in_load", "jump_out_h0",
        "jump_out_load", "energy_lost")
# Maugis-Dugdale theory at the same largest tension.
MAUGIS = {0.01: 1.997871, 0.1: 1.939859, 0.5: 1.690481, 1: 1.582271, 2: 1.526835, 5: 1.504780}


@pytest.mark.parametrize("tabor", TABLE)
def test_the_sphere_is_that_of_another_program_at_every_tabor_parameter(tabor):
    """Work of adhesion, radius and z0 are 1; the modulus follows from Tabor's parameter."""
    found = snapin.run({
        "bodies": {"radius": 1.0, "stiffness": 2 * tabor**-1.5},
        "force": {"law": "lennard_jones", "surface_energy": 1.0, "z0": 1.0},
        "equilibrium_path": {"h0_end": -1.0}, "classical": {},
        "numerics": {"accuracy": 1e-7}}).summary
    assert found["tabor"] == pytest.approx(tabor, rel=1e-12)
    for key, value, unit, digits in zip(KEYS, TABLE[tabor], UNITS, DIGITS):
        # A unit of its last digit: some are cut off, not rounded.
        assert found[key] / unit == pytest.approx(value, abs=1.01 * 10.0**-digits), key
    assert ("jump_in_h0" in found) == (len(TABLE[tabor]) > 2)
    if tabor in MAUGIS:
        assert found["maugis_pull_off"] / math.pi == pytest.approx(MAUGIS[tabor], abs=1e-6)
