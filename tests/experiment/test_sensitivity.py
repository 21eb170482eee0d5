"""Claims about derivatives by the numbers of a deck: the dimensions of the problem, and differences
of whole runs."""

import math
import re

import numpy as np
import pytest
from support.scenes import changed, deck, lennard_jones, path_of, several, value_in

LAW = {"law": "lennard_jones", "hamaker": 1.0e-20, "z0": 0.5e-9}
PARABOLA = {"radius": 1.5e-2, "stiffness": 1.0e10}
READ = {
    "equilibrium_path": {"h0_end": -2e-9}, "device": {"stiffness": [1e6, 1e4]},
    "fixed_load": {"load": [-3e-5, 2e-5]}}


def derivatives(found, kind="logarithmic"):
    table = found.table("sensitivity.csv")
    by_quantity = {}
    for quantity, parameter, value in zip(table["quantity"], table["parameter"], table[kind]):
        by_quantity.setdefault(quantity, {})[parameter] = value
    return by_quantity


def value_of(found, quantity):
    """A number that sensitivity.csv names: of the summary, or of a column of a table."""
    if match := re.fullmatch(r"(\w+)\.(\w+)\((\d+)\)", quantity):
        return found.table(match[1] + ".csv")[match[2]][int(match[3]) - 1]
    name, number = re.fullmatch(r"(\w+)(?:\((\d+)\))?", quantity).groups()
    return several(found.summary[name])[int(number or 1) - 1]


@pytest.mark.parametrize("sigma", [0.01, 0.87, 8.7, 1000.0])
def test_derivatives_obey_the_dimensions_of_the_problem(run, sigma):
    """Loads are (A/z0^2) R times a function of sigma ~ A R^(1/2) / (E z0^(7/2)), lengths z0 times
    one: one derivative says the other three, within the errors of sensitivity.csv."""
    names = ["force.hamaker", "bodies.radius", "force.z0", "bodies.stiffness"]
    run_of = run(lennard_jones(
        sigma, equilibrium_path={"h0_end": -2.0}, sensitivity={"parameters": names}))
    found, derivative, error = (derivatives(run_of, kind) for kind in (
        "logarithmic", "derivative", "derivative_error"))
    powers = {"_load": (1, 1, -2), "_h0": (0, 0, 1), "tension": (1, 1, -2), "lost": (1, 1, -1)}
    tried = 0
    for quantity, rate in found.items():
        if not quantity.startswith(("max_tension", "jump", "folds", "energy")):
            continue
        kind = next(end for end in powers if quantity.split("(")[0].endswith(end))
        strength = -rate["bodies.stiffness"]
        expected = np.add(powers[kind], strength * np.array([1, 0.5, -3.5]))
        # A load at a fold and the place of the largest tension take second derivatives, which are
        # differences, and are as good as the place: of the narrow pair of folds at sigma = 8.7 that
        # is known to some 1e-6, of the tension at sigma = 1000 rounding leaves up to 5e-7.
        bound = 5e-6 if kind == "_load" or quantity == "max_tension_h0" else 1e-7
        np.testing.assert_allclose([rate[name] for name in names[:3]], expected, rtol=bound,
                                   atol=bound, err_msg=quantity)
        # The errors, logarithmic too; 1e-9: rounding in the runs.
        each = {name: abs(rate[name] * error[quantity][name] / derivative[quantity][name])
                for name in names}
        allowed = [each[name] + power * each["bodies.stiffness"] + 1e-9
                   for name, power in zip(names, (1, 0.5, 3.5))]
        assert (abs(np.subtract([rate[name] for name in names[:3]], expected)) <= allowed).all()
        tried += 1
    assert tried >= (2 if sigma < 0.1 else 11)


def test_rigid_and_jkr_limits_have_the_powers_of_their_theories(run):
    names = ["force.hamaker", "bodies.radius", "force.z0", "bodies.stiffness"]
    for sigma in (1e-4, 1e4):
        rate = derivatives(run(lennard_jones(
            sigma, equilibrium_path={"h0_end": -2.0},
            sensitivity={"parameters": names})))["max_tension"]
        # The pull-offs 2 pi w R and 3/2 pi w R, with w = A/(16 pi z0^2).
        assert [rate[name] for name in names] == pytest.approx([1, 1, -2, 0], abs=1e-3)


@pytest.mark.parametrize(("shape", "lengths"), [
    ({"kind": "sphere", "radius": 1e-7}, ["radius"]),
    pytest.param({"kind": "rounded_punch", "radius": 1e-6, "flat_radius": 6e-8},
                 ["radius", "flat_radius"], marks=pytest.mark.long),
])
def test_derivatives_for_other_shapes_obey_the_dimensions_too(run, shape, lengths):
    """Loads are w times a length, and what has no dimension depends on w/(E L)."""
    lengths = [f"shape.{name}" for name in lengths] + ["morse.z0", "morse.decay_length"]
    found = derivatives(run(path_of(
        5e7, -2e-9, 1e-4, radius=None, force=None, shape=shape,
        morse={"surface_energy": 0.05, "z0": 0.3e-9, "decay_length": 0.2e-9},
        sensitivity={"parameters": [*lengths, "bodies.stiffness", "morse.surface_energy"]})))
    for quantity in ("max_tension", "max_tension_h0", "jump_in_h0", "jump_out_h0"):
        rate = found[quantity]
        load = quantity == "max_tension"
        assert rate["bodies.stiffness"] + rate["morse.surface_energy"] == pytest.approx(
            1 if load else 0, abs=1e-6)
        # The place of an extremum is known to some 1e-5 at this accuracy beside a punch's rim.
        assert sum(rate[name] for name in lengths) - rate["bodies.stiffness"] == pytest.approx(
            1, abs=2e-5)


CASES = {
    "Lennard-Jones": ({"bodies": PARABOLA, "force": LAW, **READ},
                      ["force.hamaker", "force.z0", "bodies.radius", "bodies.stiffness"]),
    "van der Waals and a double layer": (
        {"bodies": {"radius": 5e-6, "stiffness": 2e9}, "van_der_waals": {"hamaker": 6.5e-20},
         "born": {"z0": 0.25e-9},
         "double_layer": {"model": "linear", "potential": -0.03, "salt": 1.0},
         "equilibrium_path": {"h0_end": -4e-9}, "device": {"stiffness": [50.0]}},
        ["van_der_waals.hamaker", "born.z0", "double_layer.potential", "double_layer.salt"]),
    "two hydrophobic terms": (
        {"bodies": {"radius": 5e-6, "stiffness": 2e9},
         "force": {"law": "lennard_jones", "hamaker": 3e-20, "z0": 0.4e-9},
         "hydrophobic": {"energy": [5e-3, 1e-3], "decay_length": [1e-9, 2e-9]},
         "equilibrium_path": {"h0_end": -4e-9}},
        ["hydrophobic.energy(1)", "hydrophobic.decay_length(2)"]),
    "powers of any exponent": (
        {"bodies": {"radius": 5e-6, "stiffness": 2e9},
         "force": {"law": "lennard_jones", "surface_energy": 0.03, "z0": 0.4e-9,
                   "exponents": [10.0, 4.0]},
         "equilibrium_path": {"h0_end": -4e-9}},
        ["force.exponents(1)", "force.exponents(2)", "force.surface_energy"]),
    "Morse law on a power of r": (
        {"bodies": {"stiffness": 1e9}, "shape": {"kind": "power", "exponent": 3.0, "radius": 1e-6},
         "morse": {"surface_energy": 0.05, "z0": 0.3e-9, "decay_length": 0.2e-9},
         "equilibrium_path": {"h0_end": -4e-9}, "fixed_load": {"load": [2e-8]}},
        ["shape.exponent", "shape.radius", "morse.decay_length", "bodies.stiffness"]),
    "Morse law on a sphere": (
        {"bodies": {"stiffness": 5e7}, "shape": {"kind": "sphere", "radius": 1e-7},
         "morse": {"surface_energy": 0.05, "z0": 0.3e-9, "decay_length": 0.2e-9},
         "equilibrium_path": {"h0_end": -10e-9}},
        ["shape.radius", "morse.surface_energy"]),
}


# On other shapes the meshes of accuracy 1e-9 are large.
LONG = ["Morse law on a power of r", "Morse law on a sphere"]


@pytest.mark.parametrize("case", [
    pytest.param(case, marks=[pytest.mark.long] if case in LONG else []) for case in CASES])
def test_derivatives_are_those_of_whole_runs(run, case):
    """Of fourth order in a direction in which all parameters change, by 4e-3 of themselves and
    less: what that leaves out is some 1e-8, and errors of runs of accuracy 1e-9 count 250 times."""
    groups, names = CASES[case]
    groups = {**groups, "numerics": {"accuracy": 1e-9}}
    found = run(deck(**groups, sensitivity={"parameters": names}))
    direction = dict(zip(names, np.cos(np.arange(len(names)) + 0.5)))
    step = 4e-3

    def moved(steps):
        return run(deck(**changed(groups, {
            name: value_in(groups, name) * (1 + steps * step * part)
            for name, part in direction.items()})))

    runs = [moved(steps) for steps in (-2, -1, 1, 2)]
    tried = 0
    for quantity, rate in derivatives(found, "derivative").items():
        expected = sum(rate[name] * value_in(groups, name) * part
                       for name, part in direction.items())
        values = [value_of(one, quantity) for one in runs]
        if not np.isfinite(values).all():
            continue
        difference = np.dot([1, -8, 8, -1], values) / (12 * step)
        # Loads at folds of the other variable change infinitely fast there, and runs have them to
        # fewer digits; sizes stand in where a derivative happens to be small.
        size = max(abs(difference), abs(value_of(found, quantity)))
        assert abs(expected - difference) <= 2e-6 * size, quantity
        tried += 1
    assert tried >= 8


STEEP = {
    "a front near saturation": (
        {"bodies": {"radius": 1e-6, "stiffness": 1e10}, "capillary": {"humidity": 0.95},
         "born": {"z0": 0.3e-9, "hamaker": 1e-20}, "equilibrium_path": {"h0_end": -1e-9},
         "device": {"stiffness": [1e-2, 1.0]}}, "capillary.humidity", 2e-6),
    "a step of a thousandth of the range": (
        {"bodies": {"radius": 1e-6, "stiffness": 1e10},
         "dugdale": {"stress": 2e7, "range": 1e-9, "smoothing": 1e-12},
         "force": {"law": "exponential", "p0": 1e9, "decay_length": 1e-10},
         "equilibrium_path": {"h0_end": -1e-9}}, "dugdale.range", 2e-5),
    "a flat cone": (
        {"bodies": {"stiffness": 1e9}, "shape": {"kind": "cone", "half_angle": 1.565},
         "force": {"law": "lennard_jones", "surface_energy": 0.05, "z0": 0.5e-9},
         "equilibrium_path": {"h0_end": -4e-9}, "classical": {}}, "shape.half_angle", 2e-5),
}


@pytest.mark.slow
@pytest.mark.parametrize("case", STEEP)
def test_derivatives_hold_where_the_problem_depends_steeply_on_the_parameter(run, case):
    """They were wrong by up to ten orders: the problems that are compared differed too much, or the
    states along the path did."""
    groups, name, step = STEEP[case]
    groups = {**groups, "numerics": {"accuracy": 1e-9}}
    found = run(deck(**groups, sensitivity={"parameters": [name]}))
    runs = [run(deck(**changed(groups, {name: value_in(groups, name) * (1 + steps * step)})))
            for steps in (-2, -1, 1, 2)]
    tried = 0
    for quantity, rate in derivatives(found, "derivative").items():
        values = np.array([value_of(one, quantity) for one in runs])
        if not (np.isfinite(values).all() and math.isfinite(rate[name])):
            continue
        difference = np.dot([1, -8, 8, -1], values) / (12 * step * value_in(groups, name))
        # What rounding of the runs leaves, and the error of the difference.
        left = 1e-9 * abs(values).max() / (step * value_in(groups, name))
        assert rate[name] == pytest.approx(difference, rel=2e-3, abs=left), quantity
        tried += 1
    assert tried >= 8


def test_a_default_follows_the_number_whatever_else_is_named(run):
    """The Hamaker constant of &born is that of &van_der_waals unless the deck has it."""
    rates = [derivatives(run(path_of(1e10, -3e-9, radius=1e-6, force=None,
                                     van_der_waals={"hamaker": 1e-20}, born={"z0": 0.3e-9},
                                     sensitivity={"parameters": ["van_der_waals.hamaker", *more]})))
        for more in ([], ["born.hamaker"])]
    for quantity in ("max_tension", "rest_gap"):
        alone, beside = (rate[quantity]["van_der_waals.hamaker"] for rate in rates)
        assert beside == pytest.approx(alone, abs=1e-9)
    assert rates[1]["rest_gap"]["born.hamaker"] == pytest.approx(1 / 6, abs=1e-6)


def test_curve_has_the_derivative_of_the_state_at_each_h0(run):
    groups = {"bodies": PARABOLA, "force": LAW, "device": {"stiffness": [1e5, 0.0]}}
    names = {"parameters": ["force.z0", "bodies.stiffness"]}
    table = run(deck(**groups, equilibrium_path={"h0_end": -2e-9}, sensitivity=names)).table(
        "curve_sensitivity.csv")
    for parameter in names["parameters"]:
        mine = {k: np.flatnonzero((table["parameter"] == parameter) & (table["stiffness"] == k))
                for k in (math.inf, 1e5, 0.0)}
        row = mine[math.inf][-4]
        one = run(deck(bodies=PARABOLA, force=LAW, sensitivity=names,
                       equilibrium_path={"h0_end": table["h0"][row]}))
        assert value_of(one, "end_load") == pytest.approx(table["load"][row], rel=1e-9)
        assert derivatives(one, "derivative")["end_load"][parameter] == pytest.approx(
            table["load_derivative"][row], rel=1e-6)
        # At fixed z, h0 = z + F/k: F_p = F_p|h0 + F' F_p/k, and at fixed load F_p|h0 = -F' h0_p.
        at_h0, of_h0 = table["load_derivative"][mine[math.inf]], table["h0_derivative"][mine[0.0]]
        at_z = table["load_derivative"][mine[1e5]]
        turns = ~np.isfinite(at_h0) | ~np.isfinite(of_h0) | ~np.isfinite(at_z)
        assert turns.sum() < 8
        np.testing.assert_allclose((at_z * (1 + at_h0 / of_h0 / 1e5))[~turns], at_h0[~turns],
                                   rtol=1e-6)


def test_a_parameter_at_the_end_of_its_range_is_varied_inward(run):
    """dE*/dnu is 2 nu/(1 - nu^2) E* for E* = E/(1 - nu^2), and nu = 1/2 is the largest there is."""
    for poisson in (0.5, 0.3, 0.0):
        rate = derivatives(run(deck(
            bodies={"radius": 1.5e-2, "young": 1e10, "poisson": poisson}, force=LAW,
            equilibrium_path={"h0_end": -2e-9},
            sensitivity={"parameters": ["bodies.young", "bodies.poisson"]})), "derivative")
        by_young, by_poisson = rate["max_tension"].values()
        expected = by_young * 1e10 * 2 * poisson / (1 - poisson**2)
        assert by_poisson == pytest.approx(expected, rel=1e-7, abs=1e-9 * by_young * 1e10)


def test_nothing_else_changes(run):
    groups = {"bodies": PARABOLA, "force": LAW, **READ}
    without = run(deck(**groups))
    beside = run(deck(**groups, sensitivity={"parameters": ["force.z0"]}))
    for name in ("curve.csv", "device.csv", "device_jumps.csv", "fixed_load.csv"):
        assert (beside.folder / name).read_bytes() == (without.folder / name).read_bytes()
    assert not (without.folder / "sensitivity.csv").exists()


@pytest.mark.parametrize("accuracy", [1e-5, 1e-8])
def test_the_curve_has_no_derivative_at_its_folds(run, accuracy):
    """Some rows of folds had the inverse of a rounding error."""
    found = run(path_of(4.04e9, -2.4e-9, accuracy, force=None,
                        van_der_waals={"hamaker": 1e-19, "retardation_length": 98e-9},
                        born={"hamaker": 1e-19, "z0": 4.63e-10},
                        sensitivity={"parameters": ["bodies.stiffness"]}))
    table, folds = found.table("curve_sensitivity.csv"), np.array(found.summary["folds_h0"])
    at_fold = abs(table["h0"][:, None] / folds - 1).min(axis=1) < 1e-14
    assert at_fold.sum() == folds.size
    assert np.isnan(table["load_derivative"][at_fold]).all()
    assert np.isnan(table["load_derivative"]).sum() < folds.size + 3


def test_a_power_of_a_force_that_falls_slowly_has_few_digits_and_a_warning(run):
    """Between cones the load far out is an integral of h^-2, that by its exponent of h^-2 ln h."""
    def law(exponent):
        return {"law": "lennard_jones", "surface_energy": 0.02, "z0": 1e-9,
                "exponents": [9.0, exponent]}

    def found(exponent, **groups):
        return run(deck(bodies={"stiffness": 1e8}, shape={"kind": "cone", "half_angle": 1.4},
                        force=law(exponent), equilibrium_path={"h0_end": -2e-9}, **groups))
    step = 1e-3
    above, below = (found(3 + change).summary["jump_in_load"] for change in (step, -step))
    known = found(3.0, sensitivity={"parameters": ["force.exponents(2)", "force.exponents(1)"]})
    rate = derivatives(known, "derivative")["jump_in_load"]["force.exponents(2)"]
    assert rate == pytest.approx((above - below) / (2 * step), rel=2e-2)
    assert [text for text in known.warnings if "sensitivity" in text] == [
        "sensitivity: force.exponents(2) changes the power of a force that falls slowly far away; "
        "derivatives by it have two to five digits"]
    parabola = path_of(1e10, -2e-9, radius=1e-6, force=law(3.0),
                       sensitivity={"parameters": "force.exponents(2)"})
    assert not any("sensitivity" in text for text in run(parabola).warnings)
    # An exponent at the end of its range is varied to one side.
    power = deck(bodies={"stiffness": 1e8}, force=law(3.0), equilibrium_path={"h0_end": -2e-9},
                 shape={"kind": "power", "exponent": 1.0, "coefficient": 0.17},
                 sensitivity={"parameters": "shape.exponent"})
    assert any("shape.exponent changes the power" in text for text in run(power).warnings)


def test_rigid_bodies_and_laws_without_attraction_have_derivatives_too(run):
    names = ["force.hamaker", "bodies.radius", "force.z0"]
    found = derivatives(run(deck(
        bodies={"radius": 1e-6, "rigid": True}, force=LAW, equilibrium_path={"h0_end": 0.3e-9},
        sensitivity={"parameters": names})))
    # 2 pi w R at z0.
    assert [found["max_tension"][name] for name in names] == pytest.approx([1, 1, -2], abs=1e-9)
    assert [found["max_tension_h0"][name] for name in names] == pytest.approx([0, 0, 1], abs=1e-8)
    pressures = ["force.p0", "bodies.stiffness"]
    found = derivatives(run(deck(
        bodies={"radius": 1e-6, "stiffness": 1e9},
        force={"law": "exponential", "p0": 1e7, "decay_length": 1e-9},
        equilibrium_path={"h0_end": -1e-9}, sensitivity={"parameters": pressures})))
    for key, power in (("end_load", 1), ("end_displacement", 0)):
        assert abs(found[key]["force.p0"]) > 0.01
        assert sum(found[key].values()) == pytest.approx(power, abs=1e-8)


def test_a_jump_that_is_about_to_vanish_has_no_derivative_and_this_is_said(run):
    """Of a path with its first two folds a little weaker adhesion has none; the largest tension has
    a derivative all the same."""
    def path(sigma, status=0, **groups):
        return run(lennard_jones(sigma, equilibrium_path={"h0_end": -2.0}, **groups),
                   status=status)

    smooth, jumps = 0.05, 0.87
    while jumps / smooth > 1.002:
        middle = math.sqrt(smooth * jumps)
        if "jump_in_h0" in path(middle).summary:
            jumps = middle
        else:
            smooth = middle
    found = path(jumps, status=1, sensitivity={"parameters": "force.hamaker"})
    rate = derivatives(found, "derivative")
    assert math.isnan(rate["jump_in_h0"]["force.hamaker"])
    assert math.isfinite(rate["max_tension"]["force.hamaker"])
    assert "sensitivity: not all derivatives were found" in found.warnings


def test_a_path_without_states_has_no_derivatives(run):
    """It ended by a segmentation fault."""
    found = run(lennard_jones(1.0, equilibrium_path={"h0_end": -1.0}, numerics={
        "max_iterations": 1}, sensitivity={"parameters": ["force.hamaker"]}), status=1)
    assert any("no equilibrium was found far from contact" in text for text in found.warnings)
    assert "path_traced_h0" not in found.summary
