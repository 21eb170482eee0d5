"""Claims about shapes of the gap: rigid bodies of any shape, derivatives, limits, and refusals."""

import math

import numpy as np
import pytest
from support.scenes import agreeing, deck, lennard_jones, loading


def scene(shape, sigma=1.0, **groups):
    """A deck in units of z0 and of E/(1-nu^2), or of rigid bodies where sigma is 0."""
    bodies = {"stiffness": 1.0} if sigma else {"rigid": True}
    return lennard_jones(sigma or 1.0, bodies=bodies, shape=shape, **groups)


def write_profile(folder, r, f):
    path = folder / "profile.txt"
    np.savetxt(path, np.column_stack([r, f]), fmt="%.17e", header="r [m], f [m]")
    return {"kind": "profile", "file": str(path)}


# --- Derivatives

SHAPES = [
    {"kind": "parabola", "radius": 1.0},
    {"kind": "cone", "half_angle": math.atan(2.0)},
    {"kind": "power", "exponent": 1.5, "coefficient": 0.5},
    {"kind": "power", "exponent": 3.0, "coefficient": 0.5},
    {"kind": "sphere", "radius": 50.0},
    {"kind": "spheroid", "radius": 20.0, "semi_axis": 60.0},
    {"kind": "rounded_punch", "radius": 1.0, "flat_radius": 0.3},
    {"kind": "profile"},
]


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: "-".join(map(str, shape.values())))
def test_the_derivative_along_the_path_is_that_of_loads_at_stepped_h0(run, tmp_path, shape):
    if shape["kind"] == "profile":
        r = np.linspace(0, 6, 80)
        shape = write_profile(tmp_path, r, r**2 / 2 + r**3 / 9)
    # Bodies that end so near are refused at a smaller accuracy.
    ends = shape["kind"] in ("sphere", "spheroid")
    numerics = {"accuracy": 1e-3 if ends else 1e-6}
    path = scene(shape, 0.3, equilibrium_path={"h0_end": -1.0}, table={}, numerics=numerics)
    rows = run(path).table("table.csv").rows("retreat")
    row, step = np.argmin(abs(rows["indentation"])), 1e-2
    h0, stiffness = -rows["indentation"][row], rows["stiffness"][row]
    steps = {"h0_start": h0 + 2 * step, "h0_end": h0 - 2 * step, "h0_step": step}
    load = run(scene(shape, 0.3, loading=steps, numerics=numerics)).curve["load"]
    difference = (8 * (load[3] - load[1]) - (load[4] - load[0])) / (12 * step)
    # Path and steps have meshes of their own, which agree as well as the accuracy lets them. A
    # punch's kink moves across the panels as the contact grows, and takes digits; where the
    # accuracy is 1e-3, a third of it is left.
    digits = 1e-5 if shape["kind"] == "rounded_punch" else 1e-7
    assert difference == pytest.approx(stiffness, rel=3e-4 if ends else digits)


# --- Limits


def test_a_large_sphere_is_the_parabola(run):
    found = [
        # The lateral unit is 1e5: sigma is 1, and the largest contact 1e-5 of the radius.
        run(scene(shape, 1e-5, equilibrium_path={"h0_end": -2.0})).summary
        for shape in (
                {"kind": "sphere", "radius": 1e10},
                {"kind": "spheroid", "radius": 1e10, "semi_axis": 1e12},
                {"kind": "parabola", "radius": 1e10})
    ]
    for key in ("max_tension", "max_tension_h0", "jump_in_h0", "jump_out_load", "end_load"):
        for summary in found[:2]:
            assert summary[key] == pytest.approx(found[2][key], rel=1e-7), key


def test_a_power_of_two_is_the_parabola_to_the_last_digit(run):
    path = {"h0_end": -2.0}
    first = run(scene({"kind": "power", "exponent": 2.0, "coefficient": 0.5},
                      equilibrium_path=path))
    plain = run(scene({"kind": "parabola", "radius": 1.0}, equilibrium_path=path))
    for name in first.curve.names[1:]:
        assert (first.curve[name] == plain.curve[name]).all(), name


@pytest.mark.parametrize("exponent, accuracy", [
    # A parabola is its own spline.
    (2.0, 1e-8), (4.0, 2e-4)])
def test_a_profile_is_the_shape_that_it_was_taken_from(run, tmp_path, exponent, accuracy):
    r = np.linspace(0, 12, 121)
    shapes = (write_profile(tmp_path, r, r**exponent / 2 + 7),
              {"kind": "power", "exponent": exponent, "coefficient": 0.5})
    near, exact = (run(scene(shape, equilibrium_path={"h0_end": -2.0})).summary for shape in shapes)
    for key in ("max_tension", "jump_in_h0", "jump_out_h0", "end_load", "jkr_pull_off"):
        assert near[key] == pytest.approx(exact[key], rel=accuracy), key


# --- The mesh


@pytest.mark.parametrize("shape", [
    {"kind": "power", "exponent": 1.5, "coefficient": 0.5},
    {"kind": "power", "exponent": 3.0, "coefficient": 0.5},
    {"kind": "power", "exponent": 4.0, "coefficient": 0.5},
    {"kind": "cone", "half_angle": math.atan(2.0)},
], ids=["1.5", "3", "4", "cone"])
def test_the_path_has_the_accuracy_that_was_asked_for(run, shape):
    agreeing(
        run, lambda accuracy: scene(shape, 5.0, equilibrium_path={"h0_end": -5.0},
                                    numerics={"accuracy": accuracy}), (1e-4, 1e-7),
        ("max_tension", "jump_in_h0", "jump_in_load", "jump_out_h0", "jump_out_load", "end_load"),
        lambda _: 1e-5)


# --- Read from the path


@pytest.mark.parametrize("shape", [
    {"kind": "cone", "half_angle": math.atan(2.0)},
    {"kind": "power", "exponent": 3.0, "coefficient": 0.5},
    {"kind": "rounded_punch", "radius": 1.0, "flat_radius": 0.5}], ids=["cone", "cube", "punch"])
def test_far_away_a_device_finds_the_load_of_rigid_bodies(run, shape):
    far = 1e5
    rigid = run(scene(shape, 0.0, loading=loading(2 * far, far, far))).curve
    done = run(scene(shape, 1.0, equilibrium_path={"h0_end": -1.0}, numerics={"accuracy": 1e-5},
                     device={"z_start": far}))
    curve = done.table("device.csv")
    outermost = curve["h0"].argmax()
    assert curve["h0"][outermost] == pytest.approx(far)
    assert curve["load"][outermost] == pytest.approx(rigid["load"][-1], rel=1e-6)


@pytest.mark.parametrize("shape", [
    {"kind": "cone", "half_angle": math.atan(2.0)},
    {"kind": "power", "exponent": 1.3, "coefficient": 0.5},
    {"kind": "power", "exponent": 3.0, "coefficient": 0.5}], ids=["cone", "1.3", "cube"])
def test_what_jumps_of_a_device_lose_is_the_area_of_its_cycle(run, shape):
    summary = run(scene(shape, 1.0, equilibrium_path={"h0_end": -1.0},
                        device={"stiffness": [5.0, 0.5]})).summary
    assert summary["device_energy_lost"] == pytest.approx(summary["device_cycle_energy"], rel=1e-5)


@pytest.mark.parametrize("exponent", [2.2, 2.6])
def test_energies_under_a_force_that_falls_slowly_are_areas_too(run, tmp_path, exponent):
    """Far away, energies of all states are infinite or nearly; their differences are not."""
    gap = np.geomspace(0.3, 30.0, 200)
    np.savetxt(tmp_path / "law.txt", np.column_stack([gap, gap**-9.0 - gap**-exponent]))
    summary = run(deck(
        bodies={"radius": 1.0, "stiffness": 1.0},
        tabulated={"file": str(tmp_path / "law.txt"), "tail_exponent": exponent},
        equilibrium_path={"h0_end": -1.0}, device={"stiffness": [5.0, 0.5]})).summary
    assert (np.array(summary["device_energy_lost"]) > 0).all()
    assert summary["device_energy_lost"] == pytest.approx(summary["device_cycle_energy"], rel=1e-5)


# --- Refusals


def refused(run, shape, **groups):
    text = scene(shape, **{"equilibrium_path": {"h0_end": -1.0}, **groups})
    return run(text, status=2).stderr


@pytest.mark.parametrize("shape, key, phrase", [
    ({"kind": "power"}, "exponent", "kind 'power' needs it"),
    ({"kind": "power", "exponent": 3.0}, "radius", "missing"),
    ({"kind": "power", "exponent": 3.0, "coefficient": 1.0, "radius": 1.0}, "radius",
     "the coefficient replaces it"),
    ({"kind": "cone"}, "half_angle", "kind 'cone' needs it"),
    ({"kind": "cone", "half_angle": 1.0, "radius": 1.0}, "radius", "a cone has none"),
    ({"kind": "cone", "half_angle": 1.0, "exponent": 2.0}, "exponent",
     "belongs to kind 'power', not to 'cone'"),
    ({"kind": "sphere"}, "radius", "missing"),
    ({"kind": "sphere", "radius": 2.0}, "radius", "it would end where forces act"),
    ({"kind": "sphere", "radius": 200.0}, "kind", "ends where the force still acts"),
    ({"kind": "spheroid", "radius": 1.0}, "semi_axis", "kind 'spheroid' needs it"),
    ({"kind": "rounded_punch", "radius": 1.0}, "flat_radius", "needs it"),
    ({"kind": "profile"}, "file", "needs it"),
    ({"kind": "profile", "file": "nowhere.txt"}, "file", "no such file"),
])
def test_a_shape_that_is_none_is_refused(run, shape, key, phrase):
    stderr = refused(run, shape)
    assert f'key "{key}"' in stderr and phrase in stderr


def test_a_contact_that_reaches_the_end_of_the_body_is_refused(run):
    stderr = refused(run, {"kind": "sphere", "radius": 1e3}, equilibrium_path={"h0_end": -1.2e3})
    assert "reach the end of the body" in stderr


def test_a_radius_given_twice_is_refused(run):
    text = scene({"kind": "sphere", "radius": 1e3}, equilibrium_path={"h0_end": -1.0})
    stderr = run(text.replace("stiffness", "radius = 1.0, stiffness"), status=2).stderr
    assert "given in &bodies too" in stderr


@pytest.mark.parametrize("groups", [
    {"approximations": {"h0_start": 5.0, "h0_end": 3.0}}, {"regime": {}}])
def test_formulas_of_the_parabola_are_refused_for_other_shapes(run, groups):
    assert "those of the parabola" in refused(run, {"kind": "cone", "half_angle": 1.0}, **groups)


R = np.linspace(0, 5, 21)


@pytest.mark.parametrize("r, f, phrase", [
    (R, R**2 + 0.3 * np.sin(4 * R) ** 2, "is not convex here"),
    (R, np.sqrt(R), "is not convex here"),
    (R + 1, R**2, "the first position is not 0"),
    (R, R * (4 - R), "do not both grow"),
    (R[::-1], R[::-1] ** 2, "the first position is not 0"),
    (R[:4], R[:4] ** 2, "fewer than 5 points"),
])
def test_a_profile_that_is_no_convex_body_is_refused(run, tmp_path, r, f, phrase):
    assert phrase in refused(run, write_profile(tmp_path, r, f))


def blunted_cone(slope, cap, r):
    """A parabola up to r = `cap`, then a cone that continues it."""
    return np.where(r < cap, slope * r**2 / (2 * cap), slope * (r - cap / 2))


def blunted_cone_contact(slope, cap, a):
    """Indentation, and load over E*, of a contact of radius a > cap (Briscoe, Sebastian & Adams,
    J. Phys. D 27, 1156 (1994); here Galin's integrals)."""
    angle, root = np.arccos(cap / a), np.sqrt(a**2 - cap**2)
    depth = slope / cap * a * (a - root) + slope * a * angle
    inner = (2 * a**3 - root * (2 * a**2 + cap**2)) / (3 * cap)
    return depth, 2 * slope * (inner + (a**2 * angle + cap * root) / 2)


@pytest.mark.parametrize("points", [41, 100])
@pytest.mark.parametrize(("slope", "cap"), [(1.4281, 2.8563e-8), (0.3, 5e-8)])
def test_points_of_a_blunted_cone_are_a_blunted_cone(run, tmp_path, slope, cap, points):
    """The flank is straight; the spline waved there, and the body was refused as not convex."""
    r = cap * np.linspace(0, 10, points)
    write = write_profile(tmp_path, r, blunted_cone(slope, cap, r))
    depths = [1.2 * slope * cap, 4 * slope * cap]
    found = run(deck(
        bodies={"stiffness": 2e6}, shape=write, force={"law": "exponential", "p0": 1e7,
                                                       "decay_length": 1e-12},
        loading={"h0_start": 1e-9, "h0_end": -depths[1], "h0_step": 0.1 * depths[1]},
        numerics={"accuracy": 1e-4}))
    wide = np.linspace(1.001 * cap, 9 * cap, 4000)
    depth, load = blunted_cone_contact(slope, cap, wide)
    curve = found.curve
    pressed = -curve["h0"] > 1.2 * slope * cap
    # The cap has a kink in its curvature, which points do not show.
    expected = 1e6 * np.interp(-curve["h0"][pressed], depth, load)
    np.testing.assert_allclose(curve["load"][pressed], expected, rtol=0.01)
    assert pressed.sum() > 5
