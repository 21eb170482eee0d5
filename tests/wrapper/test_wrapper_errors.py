"""Claims about experiments run from Python that cannot be what was asked for: warnings, NaN,
exceptions that begin with the argument's name."""

import warnings

import numpy as np
import pytest
import snapin
from support.wrapper_registry import UNIT, law_of


# --- What did not converge


def test_states_that_do_not_converge_are_returned_and_warned_of():
    """Mixing stalls in a stiff contact."""
    numerics = {"method": "mixing", "nodes": 60, "r_max": 9.0}
    with pytest.warns(snapin.SnapinWarning) as caught:
        curve = snapin.force_curve([9.0, 4.5, 0.0], **UNIT, law=law_of(8.7), **numerics)
    text = "loading: 2 of 3 states did not converge, the first at h0 = 4.5 m; "
    assert any(str(warning.message).startswith(text) for warning in caught)
    assert not curve.converged
    assert np.isfinite(curve.load).all()
    assert curve.residual[0] < 1e-8 < curve.residual[1]
    assert all(warning.filename == __file__ for warning in caught)


def test_an_early_end_keeps_what_was_found_and_is_warned_of():
    """A law without repulsion has no state after the jump."""
    h0 = np.linspace(8, 0, 33)
    with pytest.warns(snapin.SnapinWarning, match="loading ended early: no stable equilibrium"):
        curve = snapin.force_curve(h0, **UNIT, law=law_of(1.0, "attractive"))
    assert not curve.converged
    np.testing.assert_array_equal(curve.h0, h0[h0 > 3])
    assert np.isfinite(curve.load).all()


def test_rigid_bodies_that_would_touch_have_no_state():
    with pytest.raises(snapin.SnapinError, match="rigid bodies would touch"):
        snapin.force_curve([-1.0, -2.0], radius=1.0, rigid=True, law=law_of(1.0))


def test_nothing_is_warned_of_where_all_is_well():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        law = snapin.lennard_jones(hamaker=1e-20, z0=0.5e-9)
        bodies = {"radius": 1.5e-2, "stiffness": 1e10}
        snapin.force_curve([4e-9, 0.0, 4e-9], **bodies, law=law)
        snapin.equilibrium_path(-2e-9, **bodies, law=law)


# --- Arguments


def curve_with(**changes):
    """A call of force_curve that is right but for these arguments."""
    arguments = {"h0": [4.0, 2.0], **UNIT, "law": law_of(0.1), **changes}
    return lambda: snapin.force_curve(arguments.pop("h0"), **arguments)


def path_with(**changes):
    """The same for equilibrium_path."""
    arguments = {"h0_end": -2.0, **UNIT, "law": law_of(0.1), **changes}
    return lambda: snapin.equilibrium_path(**arguments)


LAW, PANEL, EDGE = law_of(1.0), snapin.panel_mesh([0.0, 1.0], 8), {**UNIT, "surface_energy": 1.0}
STATE = {"law": LAW, "mesh": PANEL, "h0": 2.0, "coupling": 0.1}


@pytest.mark.parametrize(("call", "name"), [
    (curve_with(h0=[1.0]), "h0"),
    (curve_with(h0=[]), "h0"),
    (curve_with(h0=3.0), "h0"),
    (curve_with(h0=[2.0, 4.0]), "h0"),
    (curve_with(h0=[4.0, 3.0, 2.5]), "h0"),
    (curve_with(h0=[4.0, 3.0, 5.0, 2.0]), "h0"),
    (curve_with(h0=[4.0, 3.0, 3.5, 5.0]), "h0"),
    (curve_with(h0=[4.0, 4.0]), "h0"),
    (curve_with(rigid=True), "rigid"),
    (path_with(h0_start=-3.0), "h0_start"),
    # Beyond all physical sense, or beyond float64.
    (curve_with(law=law_of(1e99)), "hamaker"),
    (lambda: snapin.force_law(law_of(1.0), 1e-60), "gap"),
    # Beyond the pole, where its formulas go on.
    (lambda: snapin.force_law(law_of(1.0), [1.0, -1.0]), "gap"),
    (lambda: snapin.slow_deformation([1.0, -1.0], radius=1.0, stiffness=1.0, law=law_of(1.0)),
     "gap"),
    (lambda: snapin.panel_mesh(np.arange(400.0), 64), "ends"),
    (lambda: snapin.numerics.Mesh("uniform", 1.0, [0.0, 2.0], 5), "ends"),
    (lambda: snapin.uniform_mesh(1, 1.0), "nodes"),
    (lambda: snapin.panel_mesh([0.0], 8), "ends"),
    (lambda: snapin.panel_mesh([0.0, 1.0, 1.0], 8), "ends"),
    (lambda: snapin.panel_mesh([-2.0, 1.0], 8, centre=1.0), "ends"),
    (lambda: snapin.panel_mesh([0.0, 1.0], 0), "order"),
    (lambda: PANEL.interpolate(np.ones(8), [1.5]), "at"),
    (lambda: snapin.panel_weights([0.0, 2.0], [0.5], 0.0, 1.0), "node"),
    (lambda: snapin.panel_weights([0.0, 1.0], [-0.5], 0.0, 1.0), "target"),
    (lambda: snapin.panel_weights([0.0, 1.0], [0.5], 1.0, 1.0), "right"),
    (lambda: snapin.panel_weights([0.0, 1.0], [0.5], -1.0, 1.0), "left"),
    (lambda: snapin.kernel([1.0], [0.0]), "distance"),
    (lambda: snapin.kernel([1.0], [1.5]), "distance"),
    (lambda: snapin.gauss_rule(10**6), "points"),
    (lambda: snapin.force_law(snapin.exponential(p0=1.0), [1e-9]), "decay_length"),
    (lambda: snapin.force_law(snapin.exponential(p0=1.0, decay_length=1.0, z0=1.0), [1.0]), "z0"),
    (lambda: snapin.force_law(LAW, [0.0]), "gap"),
    (lambda: snapin.force_law({}, [1.0]), "deck:1: &force"),
    (lambda: snapin.equilibrium(**STATE, most_iterations=0), "most_iterations"),
    (lambda: snapin.equilibrium(**STATE, patience=0), "patience"),
    (lambda: snapin.equilibrium(**STATE, displacement_tolerance=1e-4), "displacement_tolerance"),
    (lambda: snapin.contact_curve("jkr", [1.0], **UNIT), "surface_energy"),
    (lambda: snapin.contact_curve("maugis", [1.0], **EDGE), "strength"),
    (lambda: snapin.contact_curve("bradley", [1.0], **UNIT), "theory"),
    (lambda: snapin.contact_radius("jkr", "speed", [1.0], **EDGE),
     "control: must be one of load, displacement, edge_ratio, not 'speed'"),
    (lambda: snapin.profile("hertz", [-1.0], 1.0, **UNIT), "r"),
    (lambda: snapin.profile("dmt", [1.0], 1.0, **EDGE), "theory: 'dmt' has no pressure"),
    (lambda: snapin.pull_off("hertz", **UNIT), "theory: 'hertz' has no pull off at load"),
    (lambda: snapin.slow_deformation([0.0], **UNIT, law=LAW), "gap"),
    (lambda: snapin.slow_deformation(
        [1.0], **UNIT, law=snapin.exponential(p0=1.0, decay_length=1.0), form="attraction_only"),
     "form"),
    (lambda: snapin.approximation_rows(1.0, 2.0, **UNIT, law=LAW), "h0_end"),
    (lambda: snapin.approximation_rows(1.0, 0.0, **UNIT, law=LAW, count=1), "count"),
])
def test_what_cannot_be_is_a_value_error_that_begins_with_its_name(call, name):
    with pytest.raises(ValueError, match=rf'^{name}(: |$)|: key "{name}'):
        call()


def test_a_mesh_keeps_its_own_ends_and_lets_nobody_change_them():
    ends = np.array([0.0, 1.0, 3.0])
    mesh = snapin.panel_mesh(ends, 4)
    before = mesh.matrix().nodes
    ends[:] = 7.0
    np.testing.assert_array_equal(mesh.matrix().nodes, before)
    for array in mesh.ends, mesh.x, mesh.weight:
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0
