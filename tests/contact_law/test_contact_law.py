"""Claims about the numbers of the contact law: they are those of solved paths, of theories in their
limits, and consistent with each other."""

import law_errors
import law_states
import numpy as np
import pytest
import snapin
from snapin.contact_law import ContactLaw, coefficients
from support.contact_header import bodies_at

LENNARD_JONES = {"force": {"law": "lennard_jones", "surface_energy": 0.05, "z0": 3e-10}}
# What docs/tables.md promises: in pull-off forces, and in z0.
PROMISED = 1e-4


def unit_of(law):
    return np.pi*law.work_of_adhesion*law.radius


@pytest.mark.slow
def test_random_states_of_solved_paths_are_those_of_the_law():
    """200 of the 10000 that the tool takes, with other seeds, bodies and parameters."""
    force = law_states.Force(LENNARD_JONES)
    worst = law_errors.largest_errors(coefficients(), force, 200, seed=7)
    assert set(worst) == set(law_errors.KINDS)
    for kind, (error, mu) in worst.items():
        assert error <= PROMISED, (kind, mu)


def test_a_wrong_law_has_large_errors():
    """The measure of errors sees a coefficient that is wrong by 1e-3 z0."""
    force = law_states.Force(LENNARD_JONES)
    table = dict(coefficients())
    table["rest"] += 1e-3
    near = [dict(panel) for panel in table["near"]]
    for panel in near:
        panel["contact"] = [[{**gap, "rows": [[gap["rows"][0][0] + 10_000, *gap["rows"][0][1:]],
                                              *gap["rows"][1:]]}, load]
                            for gap, load in panel["contact"]]
    table["near"] = near
    errors = law_errors.errors_at(table, force, 2.0, np.random.default_rng(1))
    assert max(np.max(error) for error in errors.values()) > 3*PROMISED


def test_the_law_is_what_a_deck_gives():
    """A deck as a user writes it: its jumps, pull-off, energy and table."""
    radius, modulus, work, z0 = 5e-6, 3.2e9, 0.05, 0.3e-9
    result = snapin.run({
        "bodies": {"radius": radius, "stiffness": 2*modulus},
        "force": {"law": "lennard_jones", "surface_energy": work, "z0": z0},
        "equilibrium_path": {"h0_end": -3e-9}, "table": True})
    law, summary = ContactLaw(radius, modulus, work, z0), result.summary
    assert law.tabor == pytest.approx(summary["tabor"])
    assert law.pull_off == pytest.approx(summary["max_tension"], rel=1e-6)
    assert law.pull_off_h0 == pytest.approx(summary["max_tension_h0"], abs=1e-4*z0)
    assert law.snap_in == pytest.approx(summary["jump_in_h0"], abs=1e-5*z0)
    assert law.snap_off == pytest.approx(summary["jump_out_h0"], abs=1e-5*z0)
    assert law.snap_in_load == pytest.approx(summary["jump_in_load"], rel=1e-4)
    assert law.snap_off_load == pytest.approx(summary["jump_out_load"], rel=1e-4)
    assert law.energy_lost == pytest.approx(summary["energy_lost"], rel=1e-5)
    table = result.table
    for branch, contact in (("approach", False), ("retreat", True)):
        rows = table[(table["branch"] == branch) & np.isfinite(table["stiffness"])]
        # Rows before and after a jump have the same h0.
        jump = law.snap_off if contact else law.snap_in
        rows = rows[np.abs(rows["indentation"] + jump) > 1e-3*z0]
        h0 = -rows["indentation"]
        assert len(rows) > 20
        assert law.contact_radius(h0, contact) == pytest.approx(rows["contact_radius"], abs=1e-11)
        slope = np.abs(rows["stiffness"])
        off = np.abs(law.load(h0, contact) - rows["load"])
        assert (off <= PROMISED*(law.pull_off + slope*z0)).all()
        # Away from the jumps, where a shift of h0 changes the stiffness without end.
        calm = slope < 10*law.pull_off/z0
        assert calm.sum() > 20
        assert law.stiffness(h0, contact)[calm] == pytest.approx(
            rows["stiffness"][calm], abs=1e-3*law.pull_off/z0)


def test_nearly_rigid_bodies_have_the_closed_form_of_rigid_ones():
    law = ContactLaw(*bodies_at(1e-7))
    assert not law.jumps and np.isnan(law.snap_in) and law.energy_lost == 0
    gap = np.linspace(0.85, 30, 300)
    rigid = -8/3*(gap**-2 - gap**-8/4)
    assert law.load(gap*law.z0)/unit_of(law) == pytest.approx(rigid, abs=2e-6)
    assert law.pull_off == pytest.approx(2*unit_of(law), rel=1e-6)
    energy = -8/3*(1/gap - gap**-7/28)
    assert law.energy(gap*law.z0)/(unit_of(law)*law.z0) == pytest.approx(energy, abs=1e-5)
    # Contact is where the gap is below 1.1 z0.
    radius = np.sqrt(2*np.maximum(1.1 - gap, 0))
    assert law.contact_radius(gap*law.z0)/np.sqrt(law.radius*law.z0) == pytest.approx(
        radius, abs=1e-5)


def test_soft_bodies_have_the_curve_of_jkr():
    """At Tabor's parameter 3000 the law is 15 times beyond its tables."""
    law = ContactLaw(*bodies_at(3000))
    modulus = 4/3*law.reduced_modulus
    gap = (np.pi**2*law.work_of_adhesion**2*law.radius/modulus**2)**(1/3)
    spread = (np.pi*law.work_of_adhesion*law.radius**2/modulus)**(1/3)
    a = np.linspace(0.6, 30, 200)
    h0 = law.z0 - gap*(a**2 - 2/3*np.sqrt(6*a))
    # Lengths in gaps of JKR theory, of which z0 is 2e-4.
    assert law.load(h0, True)/unit_of(law) == pytest.approx(
        a**3 - np.sqrt(6)*a**1.5, rel=1e-5, abs=1e-4)
    assert law.contact_radius(h0, True)/spread == pytest.approx(a, rel=1e-4)
    assert law.pull_off == pytest.approx(1.5*unit_of(law), rel=1e-5)
    assert -law.snap_off_load == pytest.approx(5/9*law.pull_off, rel=1e-4)


@pytest.mark.parametrize("mu", [0.01, 1.0, 50.0])
def test_contact_deeper_than_any_table_is_that_of_hertz(mu):
    law = ContactLaw(*bodies_at(mu))
    depth = law.z0*(1 + mu)*10**np.linspace(8, 16, 30)
    hertz = 4/3*law.reduced_modulus*np.sqrt(law.radius)*depth**1.5
    assert law.load(-depth, True) == pytest.approx(hertz, rel=1e-7)
    assert law.stiffness(-depth, True) == pytest.approx(
        2*law.reduced_modulus*np.sqrt(law.radius*depth), rel=1e-7)
    assert law.energy(-depth, True) == pytest.approx(0.4*hertz*depth, rel=1e-6)


@pytest.mark.parametrize("mu", [1e-5, 0.02, 0.5, 0.69, 0.698, 0.9, 1.2, 3, 30, 150, 500])
def test_load_and_stiffness_are_slopes_of_the_energy(mu):
    law = ContactLaw(*bodies_at(mu))
    generator = np.random.default_rng(3)
    top = law.snap_in if law.jumps else 2*law.z0
    h0 = np.concatenate([law.z0*generator.uniform(-8 - 8*mu, 0.5, 300) if law.jumps else
                         law.z0*generator.uniform(-4, 6, 300), top + law.z0*10**
                         generator.uniform(-1, 3, 100)])
    step = 1e-5*law.z0
    for contact in (False, True):
        # Both neighbours must be in the same state.
        kept = (law.in_contact(h0 - step, contact) == law.in_contact(h0 + step, contact))
        middle = h0[kept]
        assert middle.size >= 398
        energy = [law.energy(middle + sign*step, contact) for sign in (-1, 1)]
        load = law.load(middle, contact)
        stiffness = law.stiffness(middle, contact)
        # A difference over the step has errors of the load's curvature and of rounding.
        calm = np.abs(stiffness) < 100*law.pull_off/law.z0
        assert calm.sum() > 250
        largest = np.abs(energy[0]).max()*1e-15/step
        assert ((energy[0] - energy[1])/(2*step))[calm] == pytest.approx(
            load[calm], rel=1e-6, abs=1e-5*law.pull_off + 10*largest)
        loads = [law.load(middle + sign*step, contact) for sign in (-1, 1)]
        assert ((loads[0] - loads[1])/(2*step))[calm] == pytest.approx(
            stiffness[calm], rel=1e-4,
            abs=1e-4*law.pull_off/law.z0 + 1e-9*np.abs(loads[0]).max()/law.z0)


def test_panels_of_tabor_s_parameter_meet():
    """Each has fits of its own. Where the unstable states between snap-in and snap-off begin to be
    left out, the energy that they add is an integral over other states."""
    for below, above in zip(coefficients()["near"], coefficients()["near"][1:]):
        end = below["high"]
        mu = float(law_states.mu_of(end)) if below["variable"] == "sigma" else np.exp(end)
        laws = [ContactLaw(*bodies_at(mu*(1 + sign*1e-9))) for sign in (-1, 1)]
        assert not below["whole"] or above["whole"] or laws[0].jumps
        h0 = np.array([0.5, -1, -5])*laws[0].z0*(1 + mu)
        loads, energies = ([getattr(law, name)(h0, True) for law in laws]
                           for name in ("load", "energy"))
        scale = laws[0].pull_off + np.abs(laws[0].stiffness(h0, True))*laws[0].z0
        assert (np.abs(loads[0] - loads[1]) < 1e-5*scale).all()
        assert energies[0] == pytest.approx(
            energies[1], rel=1e-5, abs=2e-5*laws[0].pull_off*laws[0].z0)


def test_jumps_lose_energy_and_the_cycle_its_area():
    law = ContactLaw(*bodies_at(2.5))
    for place, before in ((law.snap_in, False), (law.snap_off, True)):
        assert law.energy(place, before)[0] > law.energy(place, not before)[0]
    # Towards the jumps the loads have roots: points crowd there.
    part = np.sin(np.linspace(0, np.pi/2, 4001))**2
    h0 = law.snap_in + (law.snap_off - law.snap_in)*part
    difference = law.load(h0, False) - law.load(h0, True)
    area = np.sum(np.diff(h0)*(difference[1:] + difference[:-1])/2)
    assert law.energy_lost == pytest.approx(area, rel=1e-6)


def test_jumps_begin_at_the_cusp():
    """sigma = 0.291085, of docs/asymptotics.md."""
    cusp = float(law_states.mu_of(0.29108493))
    assert not ContactLaw(*bodies_at(cusp*(1 - 2e-4))).jumps
    law = ContactLaw(*bodies_at(cusp*(1 + 2e-4)))
    assert law.jumps and 0 < law.snap_off - law.snap_in < 1e-4*law.z0


@pytest.mark.parametrize("mu", [0.05, 0.5, 0.695])
def test_without_jumps_contact_does_not_matter(mu):
    law = ContactLaw(*bodies_at(mu))
    h0 = np.linspace(-4, 10, 300)*law.z0
    assert (law.load(h0, False) == law.load(h0, True)).all()
    # Once in contact the load falls with h0, up to the largest tension.
    pressed = h0 < law.pull_off_h0
    assert pressed.sum() > 80
    assert (np.diff(law.load(h0[pressed])) < 0).all()


def test_states_exist_up_to_and_at_the_jumps():
    law = ContactLaw(*bodies_at(1.7))
    outside, contact = law.snap_in, law.snap_off
    assert law.load(outside, False)[0] == pytest.approx(law.snap_in_load, rel=1e-6)
    assert law.load(contact, True)[0] == pytest.approx(law.snap_off_load, rel=1e-6)
    assert law.in_contact([outside*(1 - 1e-9), outside], False).tolist() == [True, False]
    assert law.in_contact([contact, contact*(1 + 1e-9)], True).tolist() == [True, False]
    assert law.load(outside*(1 - 1e-9), False)[0] < 3*law.snap_in_load
    assert law.stiffness(outside, False)[0] < -1e4*law.pull_off/law.z0


@pytest.mark.parametrize("bodies", [(0, 1, 1, 1), (1, -1, 1, 1), (1, 1, np.nan, 1),
                                    (1, 1, 1, np.inf), (1e40, 1e-40, 1, 1e-40)])
def test_impossible_bodies_are_refused(bodies):
    with pytest.raises((ValueError, TypeError)):
        ContactLaw(*bodies)
