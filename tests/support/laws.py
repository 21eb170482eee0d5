"""The groups of every force law, in SI, and of sums of them."""

from conftest import ROOT

WALL = {"van_der_waals": {"hamaker": 1e-20}, "born": {"z0": 0.3e-9}}
TABLE = str(ROOT / "inputs" / "examples" / "tabulated.txt")
LAWS = {
    "lennard_jones": {"force": {"law": "lennard_jones", "hamaker": 1e-19, "z0": 0.5e-9}},
    "repulsive": {"force": {
        "law": "lennard_jones", "hamaker": 1e-19, "z0": 0.5e-9, "part": "repulsive"}},
    "attractive": {"force": {
        "law": "lennard_jones", "hamaker": 1e-19, "z0": 0.5e-9, "part": "attractive"}},
    "exponential": {"force": {"law": "exponential", "p0": 2.5e8, "decay_length": 0.2e-9}},
    "morse": {"morse": {"surface_energy": 0.05, "z0": 3e-9, "decay_length": 0.2e-9}},
    "van_der_waals": {"van_der_waals": {"hamaker": 1e-19, "retardation_length": 5e-9}},
    "born": {"born": {"hamaker": 1e-19, "z0": 0.3e-9}},
    "hydration": {"hydration": {"energy": 5e-3, "decay_length": 0.5e-9}},
    "hydrophobic": {**WALL, "hydrophobic": {"energy": 5e-2, "decay_length": 1e-9}},
    "steric": {"steric": {"brush_thickness": 5e-9, "grafting_density": 1e16}},
    "structural": {"structural": {"amplitude": 1e6, "period": 2e-9, "decay_length": 1e-9}},
    "depletion": {**WALL, "depletion": {"osmotic_pressure": 1e6, "diameter": 5e-9}},
    "capillary": {**WALL, "capillary": {"humidity": 0.5}},
    "dugdale": {**WALL, "dugdale": {"stress": 1e7, "range": 1.7e-9}},
    "double_layer": {
        **WALL, "double_layer": {"potential": 0.05, "debye_length": 2e-9, "model": "nonlinear"}},
    "tabulated": {"tabulated": {"file": TABLE, "tail_exponent": 3}},
    # Steps of no width that rounding knows of, alone, in a sum, and two of them.
    "sharp": {"dugdale": {"stress": 1e7, "range": 1.7e-9, "smoothing": 1e-24}},
    "sharp sum": {**WALL, "dugdale": {"stress": 1e7, "range": 1.7e-9, "smoothing": 1e-20}},
    # A step so wide that it begins at contact.
    "wide step": {
        "van_der_waals": {"hamaker": 1e-20}, "born": {"z0": 1.84e-9},
        "depletion": {"osmotic_pressure": 1e4, "diameter": 12e-9, "smoothing": 3e-9}},
    "two steps": {
        **WALL, "dugdale": {"stress": 1e7, "range": 1.7e-9, "smoothing": 1e-13},
        "depletion": {"osmotic_pressure": 1e6, "diameter": 5e-9, "smoothing": 1e-11}},
}
