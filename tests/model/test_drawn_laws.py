"""Claims about every force law with keys drawn at random, and about sums of such laws."""

import numpy as np
import pytest
import snapin
from conftest import ROOT
from support.calculus import derivative, integrals

# Orders of magnitude of the keys of each group: drawn evenly by their logarithm; a third number is
# how many values a list has at most. Sums are evaluated at separations from 1e-10 m, where every
# law that is drawn needs finite values.
LOGARITHMIC = {
    "lennard_jones": {"surface_energy": (1e-4, 1), "z0": (1e-10, 1e-9)},
    "exponential": {"p0": (1e3, 1e10), "decay_length": (1e-11, 1e-8)},
    "morse": {"surface_energy": (1e-4, 1), "z0": (1e-10, 5e-9), "decay_length": (1e-11, 1e-9)},
    "van_der_waals": {"hamaker": (1e-22, 1e-18), "retardation_length": (1e-9, 1e-6)},
    "born": {"hamaker": (1e-22, 1e-18), "z0": (1e-10, 1e-9)},
    "hydration": {"energy": (1e-4, 1e-1, 4), "decay_length": (1e-10, 1e-8, 4)},
    "hydrophobic": {"energy": (1e-4, 1e-1, 4), "decay_length": (1e-10, 1e-8, 4)},
    "steric": {"brush_thickness": (1e-9, 1e-7), "grafting_density": (1e15, 1e18)},
    "structural": {"amplitude": (1e3, 1e9), "period": (3e-10, 1e-8), "decay_length": (3e-10, 1e-8)},
    "depletion": {"osmotic_pressure": (1e2, 1e6), "diameter": (1e-9, 1e-7)},
    "capillary": {"kelvin_radius": (2e-10, 1e-7)},
    "dugdale": {"stress": (1e4, 1e9), "range": (1e-10, 1e-7)},
    "double_layer": {"potential": (1e-3, 0.2, 2), "debye_length": (3e-10, 1e-6)},
}
# Keys between two numbers, drawn evenly.
EVEN = {
    "born": {"exponent": (3, 16)}, "structural": {"phase": (-3, 3)},
    "capillary": {"contact_angle": (0, 1.5, 2)}, "double_layer": {"regulation": (0, 1, 2)}}
CHOICES = {
    "steric": {"model": ("alexander_de_gennes", "milner_witten_cates"), "sides": (1, 2)},
    "double_layer": {"model": ("linear", "superposition", "nonlinear")}}
# Laws that end in a step: the smoothing is this part of the range at least, so that differences and
# quadrature can follow it, and the most that is allowed.
SMOOTHING = {"depletion": "diameter", "dugdale": "range"}
WIDE = (0.2, 0.45)
LEVEL = {"structural", "depletion", "dugdale", "capillary", "double_layer"}
SEEDS = range(6)


def claim_slope(of, gap, unit, size):
    """The slope is the derivative of the pressure, by central differences at separations `gap` [m];
    unit: the law's numbers; size: the parts of the slope, which set the rounding."""
    # The error is that of the sixth order in a step of 1 % of the gap or length, 1e-12 times the
    # ninth power's coefficients.
    step = 1e-2 * np.minimum(gap - unit.origin, unit.length)
    slope = derivative(lambda at: of(at).pressure, gap, step)
    assert (abs(of(gap).slope - slope) <= 1e-8 * size).all()


def claim_energy(of, gap, unit, size):
    """The energy is the integral of the pressure, by quadrature between neighbouring separations,
    and vanishes at large ones; size: its parts, which set the rounding; None: the integrand."""
    integral, of_size = integrals(lambda at: of(at).pressure, gap)
    energy = of(gap).energy
    if size is None:
        size = of_size + np.abs(energy[:-1])
    assert (abs(energy[:-1] - energy[1:] - integral) <= 1e-13 * size).all()
    far = of([unit.origin + 1e8 * unit.length]).energy
    assert abs(far[0]) <= 1e-15 * abs(energy).max()


def drawn(law, draw):
    keys = {}
    for name, (low, high, *most) in LOGARITHMIC[law].items():
        count = most[0] if most else None
        keys[name] = np.exp(draw.uniform(np.log(low), np.log(high), count)).tolist()
    for name, (low, high, *most) in EVEN.get(law, {}).items():
        keys[name] = draw.uniform(low, high, most[0] if most else None)
        keys[name] = keys[name].tolist() if most else float(keys[name])
    for name, values in CHOICES.get(law, {}).items():
        keys[name] = values[draw.integers(len(values))]
    if law in SMOOTHING:
        keys["smoothing"] = keys[SMOOTHING[law]] * draw.uniform(*WIDE)
    if law == "capillary":
        reach = keys["kelvin_radius"] * sum(np.cos(keys["contact_angle"]))
        keys["smoothing"] = reach * draw.uniform(*WIDE)
    if law == "lennard_jones":
        n, m = sorted(draw.uniform(1.5, 14, 2), reverse=True)
        keys["exponents"] = [n + 0.5, m]
    if law in ("lennard_jones", "exponential"):
        return {"force": {"law": law, **keys}}
    return {law: keys}


def separations(unit, groups):
    """Separations from deep within the law to far away, those at which it is not smooth too, no
    farther from each other than a period."""
    gap = unit.origin + unit.length * np.geomspace(0.5, 40, 60)
    if "steric" in groups:
        keys = groups["steric"]
        gap = np.union1d(gap, keys["sides"] * keys["brush_thickness"])
    if "structural" in groups:
        gap = np.union1d(gap, np.arange(gap[0], gap[-1], groups["structural"]["period"]))
    return gap


def parts_of(law, groups):
    """The repulsion and the attraction of a law that is their difference."""
    if law != "lennard_jones":
        return [groups]
    return [{"force": {**groups["force"], "part": part}} for part in ("repulsive", "attractive")]


def test_every_law_is_drawn():
    laws = {path.stem for path in (ROOT / "src" / "model" / "laws").glob("*.f90")}
    # Tables are smooth between their points only (test_tabulated.py).
    assert set(LOGARITHMIC) == laws - {"tabulated"}


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("law", LOGARITHMIC)
def test_slope_and_energy_are_derivative_and_integral(law, seed):
    groups = drawn(law, np.random.default_rng([seed, *law.encode()]))
    unit = snapin.law_numbers(groups)
    gap = separations(unit, groups)

    def of(at):
        return snapin.force_law(groups, at)

    smooth, keys = gap, groups.get(law, {})
    if law == "steric":
        kink = keys["sides"] * keys["brush_thickness"]
        smooth = gap[abs(gap - kink) > 0.02 * kink]
    # The shortest length over which the law changes.
    shortest = min(unit.length, keys.get("smoothing", np.inf), keys.get("period", np.inf) / 6)
    slope = sum(abs(snapin.force_law(part, smooth).slope) for part in parts_of(law, groups))
    energy = None
    if law in LEVEL:
        # Where they pass through zero, or end, their largest values say what digits they have.
        slope, energy = slope.max(), abs(of(gap).energy).max()
    if law == "steric":
        # Where brushes part three terms cancel.
        energy = abs(of(gap).energy[:-1]) + unit.pressure_unit * unit.length
    claim_slope(of, smooth, unit._replace(length=shortest), slope)
    claim_energy(of, gap, unit, energy)


@pytest.mark.parametrize("seed", range(20))
def test_a_sum_is_the_sum_of_its_laws(seed):
    draw = np.random.default_rng(seed)
    # Only one of the two that share a group.
    laws = [law for law in LOGARITHMIC if law not in ("lennard_jones", "exponential")]
    laws.append(draw.choice(["lennard_jones", "exponential"]))
    chosen = draw.choice(laws, draw.integers(2, 6), replace=False)
    alone = [drawn(law, draw) for law in chosen]
    whole = {name: keys for groups in alone for name, keys in groups.items()}
    gap = np.geomspace(1e-10, 1e-6, 80)
    found = snapin.force_law(whole, gap)
    parts = [part for law, groups in zip(chosen, alone) for part in parts_of(law, groups)]
    ending = [bool({*LEVEL, "steric"} & {*part}) for part in parts]
    # Every term's gap is rounded in units of the sum and from its origin, which may be far away:
    # exponents, phases and powers carry that on.
    moved = 1e-14 * gap + np.finfo(float).eps * abs(snapin.law_numbers(whole).origin)
    parts = [[snapin.force_law(part, at) for at in (gap, gap + moved)] for part in parts]
    for name in ("pressure", "slope", "energy"):
        terms, nearby = ([getattr(part, name) for part in at] for at in zip(*parts))
        allowed = np.finfo(float).tiny + sum(
            1e-12 * abs(term) + 2 * abs(term - other) + (1e-15 * abs(term).max() if ends else 0)
            for term, other, ends in zip(terms, nearby, ending))
        assert (abs(getattr(found, name) - sum(terms)) <= allowed).all(), name
