"""The sphere under the Lennard-Jones law at values of Tabor's parameter that others tabulate: its
power 3/2 is twice sigma, equation (40)."""

import math

import pytest
import snapin
from support.known import BY_TABOR, ERRORS

# Loads are over pi, as the pull-off.
UNITS = (math.pi, 1, 1, math.pi, 1, math.pi, 1)
KEYS = ("max_tension", "max_tension_h0", "jump_in_h0", "jump_in_load", "jump_out_h0",
        "jump_out_load", "energy_lost")
# Maugis-Dugdale theory at the same largest tension.
MAUGIS = {0.01: 1.997871, 0.1: 1.939859, 0.5: 1.690481, 1: 1.582271, 2: 1.526835, 5: 1.504780}


@pytest.mark.parametrize("tabor", BY_TABOR)
def test_the_sphere_is_that_of_another_program_at_every_tabor_parameter(tabor):
    """Work of adhesion, radius and z0 are 1; the modulus follows from Tabor's parameter."""
    found = snapin.run({
        "bodies": {"radius": 1.0, "stiffness": 2 * tabor**-1.5},
        "force": {"law": "lennard_jones", "surface_energy": 1.0, "z0": 1.0},
        "equilibrium_path": {"h0_end": -1.0}, "classical": {},
        "numerics": {"accuracy": 1e-7}}).summary
    assert found["tabor"] == pytest.approx(tabor, rel=1e-12)
    for key, value, unit, error in zip(KEYS, BY_TABOR[tabor], UNITS, ERRORS):
        assert found[key] / unit == pytest.approx(value, abs=error), key
    assert ("jump_in_h0" in found) == (len(BY_TABOR[tabor]) > 2)
    if tabor in MAUGIS:
        assert found["maugis_pull_off"] / math.pi == pytest.approx(MAUGIS[tabor], abs=1e-6)
