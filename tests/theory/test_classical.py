"""Claims about the classical theories: their limits, their inverses, their pull-off."""

import math

import numpy as np
import pytest
import snapin
from support.calculus import gauss
from support.scenes import deck

# Fig. 1 of the paper.
BODIES = {"radius": 1.5e-2, "stiffness": 1e10}
GAMMA = 1e-20 / (16 * math.pi * 0.5e-9**2)
ADHESIVE = {**BODIES, "surface_energy": GAMMA}

R, STIFFNESS = BODIES["radius"], BODIES["stiffness"]
K = 2 * STIFFNESS / 3
# Units in which the theories with adhesion have no parameter but Maugis' lambda.
UNIT_A = (math.pi * GAMMA * R**2 / K) ** (1 / 3)
UNIT_F = math.pi * GAMMA * R
UNIT_D = UNIT_A**2 / R

MATERIAL = {"hertz": BODIES, "jkr": ADHESIVE, "dmt": ADHESIVE}
# Far from folds too, where digits can be lost.
RADII = UNIT_A * np.geomspace(1.3, 1e6, 60)


def strength_of(lam):
    """Return the cohesive strength that gives these bodies the Maugis parameter `lam`."""
    return lam / 2 * (math.pi * GAMMA * K**2 / R) ** (1 / 3)


def maugis_state(a, lam):
    """Return load and displacement in the theory's units at contact radii `a` in its units."""
    load, displacement = snapin.contact_curve(
        "maugis", UNIT_A * np.asarray(a), **ADHESIVE, strength=strength_of(lam))
    return load / UNIT_F, displacement / UNIT_D


# --- Hertz, JKR, DMT


@pytest.mark.parametrize("theory", MATERIAL)
@pytest.mark.parametrize("control", ["load", "displacement"])
def test_contact_radius_comes_back_from_load_and_from_displacement(theory, control):
    """Equations (4), (5) and (11)."""
    load, displacement = snapin.contact_curve(theory, RADII, **MATERIAL[theory])
    values = load if control == "load" else displacement
    back = snapin.contact_radius(theory, control, values, **MATERIAL[theory])
    np.testing.assert_allclose(back, RADII, rtol=2e-13)


@pytest.mark.parametrize("theory", MATERIAL)
def test_load_at_displacement_is_the_curve(theory):
    load, displacement = snapin.contact_curve(theory, RADII, **MATERIAL[theory])
    direct = snapin.load_at_displacement(theory, displacement, **MATERIAL[theory])
    np.testing.assert_allclose(direct, load, rtol=1e-12, atol=1e-14 * UNIT_F)


def test_hertz_load_and_displacement_satisfy_equation_6():
    load, displacement = snapin.contact_curve("hertz", RADII, **BODIES)
    np.testing.assert_allclose(
        displacement, (1.5 * load / (STIFFNESS * math.sqrt(R))) ** (2 / 3), rtol=1e-14)


def test_hertz_has_no_load_apart_and_no_contact_under_tension():
    assert snapin.load_at_displacement("hertz", [-1e-9], **BODIES) == 0
    assert np.isnan(snapin.contact_radius("hertz", "load", [-1e-9], **BODIES))
    assert np.isnan(snapin.contact_radius("hertz", "displacement", [-1e-9], **BODIES))


def test_jkr_contact_radius_satisfies_equation_10():
    load = UNIT_F * np.linspace(-1.4, 30, 30)
    a = snapin.contact_radius("jkr", "load", load, **ADHESIVE)
    root = np.sqrt(6 * UNIT_F * load + 9 * UNIT_F**2)
    np.testing.assert_allclose(a**3, 1.5 * R / STIFFNESS * (load + 3 * UNIT_F + root), rtol=1e-14)


def test_jkr_pull_off_is_the_least_load_and_five_ninths_of_it_at_the_least_displacement():
    """Equations (1) and (12)."""
    a = UNIT_A * np.linspace(0.2, 3, 20001)
    load, displacement = snapin.contact_curve("jkr", a, **ADHESIVE)
    pull_off = snapin.pull_off("jkr", **ADHESIVE)
    assert pull_off == pytest.approx(-1.5 * UNIT_F, rel=1e-15)
    assert load.min() == pytest.approx(pull_off, rel=1e-7)
    # The load varies linearly through the least displacement: the step in `a` decides.
    fixed = snapin.pull_off("jkr", **ADHESIVE, control="displacement")
    assert fixed == pytest.approx(5 / 9 * pull_off, rel=1e-15)
    assert load[displacement.argmin()] == pytest.approx(fixed, rel=3e-4)


def test_jkr_states_exist_up_to_each_pull_off_and_not_beyond():
    pull_off = snapin.pull_off("jkr", **ADHESIVE)
    at = snapin.contact_radius("jkr", "load", pull_off * np.array([1, 1 + 1e-9]), **ADHESIVE)
    assert at[0] == pytest.approx(1.5 ** (1 / 3) * UNIT_A, rel=1e-7)
    assert np.isnan(at[1])

    fold = (math.pi * GAMMA * R**2 / (4 * STIFFNESS)) ** (1 / 3)
    least = -3 * fold**2 / R
    at = snapin.contact_radius("jkr", "displacement", least * np.array([1, 1 + 1e-9]), **ADHESIVE)
    assert at[0] == pytest.approx(fold, rel=1e-7)
    assert np.isnan(at[1])
    assert np.isnan(snapin.load_at_displacement("jkr", [2 * least], **ADHESIVE))


def test_jkr_without_adhesion_is_hertz():
    faint = {**BODIES, "surface_energy": 1e-30}
    np.testing.assert_allclose(
        snapin.contact_curve("jkr", RADII, **faint), snapin.contact_curve("hertz", RADII, **BODIES),
        rtol=1e-10)


def test_dmt_is_hertz_under_the_load_less_its_pull_off():
    """Equation (2)."""
    hertz, _ = snapin.contact_curve("hertz", RADII, **BODIES)
    load, _ = snapin.contact_curve("dmt", RADII, **ADHESIVE)
    pull_off = snapin.pull_off("dmt", **ADHESIVE)
    assert pull_off == pytest.approx(-2 * UNIT_F, rel=1e-15)
    np.testing.assert_allclose(load, hertz + pull_off, rtol=1e-15)
    assert np.isnan(snapin.load_at_displacement("dmt", [-1e-9], **ADHESIVE))


@pytest.mark.parametrize("theory", ["hertz", "jkr"])
def test_pressure_integrates_to_the_load(theory):
    """Equations (3), (7) and (9); the integral is (20)."""
    a = 2 * UNIT_A
    load, _ = snapin.contact_curve(theory, [a], **MATERIAL[theory])
    # r = a sin(t) takes the singularity at the edge away; Gauss is then exact for polynomials.
    t, w = gauss(20, 0, math.pi / 2)
    pressure, gap = snapin.profile(theory, a * np.sin(t), a, **MATERIAL[theory])
    integral = 2 * math.pi * a**2 * np.sum(w * pressure * np.sin(t) * np.cos(t))
    assert integral == pytest.approx(load[0], rel=1e-11)
    assert not gap.any()


@pytest.mark.parametrize("theory", ["hertz", "jkr"])
def test_gap_opens_from_the_edge_towards_the_undeformed_one(theory):
    a = 2 * UNIT_A
    load, displacement = snapin.contact_curve(theory, [a], **MATERIAL[theory])
    r = a * np.geomspace(1 + 1e-9, 1e3, 50)
    pressure, gap = snapin.profile(theory, r, a, **MATERIAL[theory])
    assert not pressure.any()
    assert (np.diff(gap) > 0).all() and 0 <= gap[0] < 1e-3 * displacement[0]
    # Far out the contact is a point force, -2u = 2 F/(pi stiffness r) by (13).
    undeformed = r[-1] ** 2 / (2 * R) - displacement[0]
    point_force = 2 * load[0] / (math.pi * STIFFNESS * r[-1])
    assert gap[-1] - undeformed == pytest.approx(point_force, rel=1e-5)


# --- Maugis-Dugdale


@pytest.mark.parametrize("lam", [1e-4, 0.1, 1.0, 5.0, 1e2, 1e4])
def test_maugis_contact_radius_comes_back_from_its_edge_ratio(lam):
    material = {**ADHESIVE, "strength": strength_of(lam)}
    m = 1 + np.geomspace(1e-6, 1e3, 40)
    a = snapin.contact_radius("maugis", "edge_ratio", m, **material)
    z0 = 16 * GAMMA / (9 * math.sqrt(3) * material["strength"])
    strength, found, back = snapin.cohesive_zone(a, **ADHESIVE, z0=z0)
    assert strength == pytest.approx(material["strength"], rel=1e-14)
    assert found == pytest.approx(lam, rel=1e-14)
    np.testing.assert_allclose(back - 1, m - 1, rtol=1e-9)


@pytest.mark.parametrize("lam", [1e-3, 0.3, 1.0, 4.0, 50.0])
def test_maugis_states_close_the_gap_at_the_outer_edge_to_the_range_of_the_tension(lam):
    material = {**ADHESIVE, "strength": strength_of(lam)}
    a = UNIT_A * np.geomspace(0.01, 10, 30)
    z0 = 16 * GAMMA / (9 * math.sqrt(3) * material["strength"])
    *_, m = snapin.cohesive_zone(a, **ADHESIVE, z0=z0)
    load, displacement = maugis_state(a / UNIT_A, lam)
    # Maugis' equations as he gives them, cancellation and all.
    scaled, t, angle = a / UNIT_A, np.sqrt(m**2 - 1), np.arccos(1 / m)
    one = lam * scaled**2 / 2 * (t + (m**2 - 2) * angle) + 4 * lam**2 * scaled / 3 * (
        t * angle - m + 1)
    np.testing.assert_allclose(one, 1, rtol=1e-7)
    np.testing.assert_allclose(
        load, scaled**3 - lam * scaled**2 * (t + m**2 * angle), rtol=1e-7, atol=1e-7)
    np.testing.assert_allclose(
        displacement, scaled**2 - 4 / 3 * lam * scaled * t, rtol=1e-7, atol=1e-7)


def test_maugis_tends_to_jkr_as_the_tension_grows():
    a = np.geomspace(0.3, 5, 20)
    exact = np.array([a**3 - np.sqrt(6 * a**3), a**2 - np.sqrt(8 / 3 * a)])
    errors = [np.abs(np.array(maugis_state(a, lam)) - exact).max() for lam in (1e2, 1e3, 1e4)]
    assert errors[-1] < 1e-6
    assert errors[0] / errors[1] > 50 and errors[1] / errors[2] > 50


def test_maugis_tends_to_dmt_as_the_tension_falls():
    a = np.geomspace(0.3, 5, 20)
    exact = np.array([a**3 - 2, a**2])
    errors = [np.abs(np.array(maugis_state(a, lam)) - exact).max() for lam in (1e-4, 1e-6, 1e-8)]
    assert errors[-1] < 1e-3 and errors[0] > errors[1] > errors[2]


@pytest.mark.parametrize("lam", [1e-8, 1e-3, 0.1, 0.5, 1.0, 3.0, 20.0, 1e4])
def test_maugis_pull_off_is_the_least_load_between_dmt_and_jkr(lam):
    pull_off = snapin.pull_off("maugis", **ADHESIVE, strength=strength_of(lam)) / UNIT_F
    load, _ = maugis_state(np.linspace(1e-4, 1.6, 16001), lam)
    assert -2 <= pull_off <= -1.5 * (1 - 1e-12)
    assert pull_off == pytest.approx(load.min(), rel=1e-7)
    assert pull_off <= load.min() * (1 - 1e-12)


def test_maugis_pull_off_falls_steadily_from_dmt_to_jkr():
    tension = [
        -snapin.pull_off("maugis", **ADHESIVE, strength=strength_of(lam)) / UNIT_F
        for lam in np.geomspace(1e-7, 1e5, 60)
    ]
    assert tension[0] == pytest.approx(2, rel=1e-4)
    assert tension[-1] == pytest.approx(1.5, rel=1e-9)
    assert (np.diff(tension) < 1e-12).all()


def test_strength_of_lennard_jones_makes_lambda_1_157_times_tabors_parameter():
    z0 = 0.5e-9
    strength, lam, _ = snapin.cohesive_zone([UNIT_A], **ADHESIVE, z0=z0)
    h = np.linspace(0.9, 2, 100001) * z0
    tension = 8 * GAMMA / (3 * z0) * ((z0 / h) ** 3 - (z0 / h) ** 9)
    assert strength == pytest.approx(tension.max(), rel=1e-9)
    tabor = (R * GAMMA**2 / ((STIFFNESS / 2) ** 2 * z0**3)) ** (1 / 3)
    assert lam / tabor == pytest.approx(1.157, abs=5e-4)


def test_figure_1_pull_offs_are_those_of_the_paper():
    assert snapin.pull_off("jkr", **ADHESIVE) == pytest.approx(-56e-6, abs=0.5e-6)
    assert snapin.pull_off("dmt", **ADHESIVE) == pytest.approx(-75e-6, abs=0.5e-6)


@pytest.mark.parametrize("shape, slope", [
    (None, lambda r: r), ({"kind": "sphere"}, lambda r: r / np.sqrt(1 - r**2)),
    ({"kind": "power", "exponent": 4.0}, lambda r: 2 * r**3)])
@pytest.mark.parametrize("depth", [1e-3, 0.04, 0.3, 0.6])
def test_theories_of_contacts_as_wide_as_the_body_are_said(run, shape, slope, depth):
    """Rows went on to contacts wider than the body, without a word. Above a tenth of the radius, or
    of a slope, there is a note, above a third a warning."""
    found = run(deck(bodies={"radius": 1.0, "stiffness": 1.0}, shape=shape,
                     force={"law": "lennard_jones", "surface_energy": 1e-9, "z0": 1e-4},
                     classical={"h0_start": 1e-3, "h0_end": -depth, "theories": "hertz"}))
    widest = slope(found.table("classical.csv")["contact_radius"].max())
    assert found.summary["classical_over_radius"] == pytest.approx(widest, rel=1e-6)
    words = "the slope at the edge of the widest contact in classical.csv"
    said = [words in str(found.summary.get(key, "")) for key in ("notes", "warnings")]
    assert said == [0.1 < widest <= 1 / 3, widest > 1 / 3]


def test_theories_beyond_the_points_of_a_profile_are_said(run, tmp_path):
    r = np.linspace(0, 0.02, 50)
    np.savetxt(tmp_path / "profile.txt", np.column_stack([r, r**2 / 2]))
    for depth, beyond in ((1e-4, False), (1e-3, True)):
        found = run(deck(bodies={"stiffness": 1.0},
                         shape={"kind": "profile", "file": str(tmp_path / "profile.txt")},
                         force={"law": "lennard_jones", "surface_energy": 1e-12, "z0": 1e-6},
                         classical={"h0_start": 1e-5, "h0_end": -depth}))
        said = str(found.summary.get("warnings", ""))
        assert ("contacts in classical.csv reach" in said) == beyond
