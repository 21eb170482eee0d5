"""Claims about largest tensions that are those of a first or last row, and so no pull-offs."""

import pytest
from support.scenes import deck, exponential, lennard_jones, loading, several

BODIES = {"radius": 1e-6, "stiffness": 1e9}
STIFF = {"radius": 1e-6, "stiffness": 1e10}  # These never jump.
FORCE = {"law": "lennard_jones", "surface_energy": 0.02, "z0": 0.5e-9}
NO_PULL_OFF = "max_tension is no pull-off"
CYCLE = {"h0_start": 7e-9, "h0_step": 0.1e-9}

# The groups of a deck, and the beginning of the warning.
ENDED = {
    "a loading before contact": (
        {"loading": {**CYCLE, "h0_end": 3e-9}}, "loading: the tension is largest in its last row"),
    "a turn before the largest tension": (
        {"bodies": STIFF, "loading": {**CYCLE, "h0_end": 1e-9}, "unloading": {}}, "loading: the"),
    "an unloading that ends in contact": (
        {"bodies": STIFF, "loading": {"h0_start": 0.3e-9, "h0_end": -1e-9, "h0_step": 0.1e-9},
         "unloading": {"h0_end": 0.4e-9}},
        "unloading_1: the tension is largest in its last row"),
    "a path that begins in contact": (
        {"equilibrium_path": {"h0_start": 1e-9, "h0_end": -3e-9}},
        "path: the tension is largest in its first row, at h0 = 1e-9 m"),
    "a path before contact": (
        {"equilibrium_path": {"h0_end": 3e-9}},
        "path: the tension is largest in its last row, at h0 = 3e-9 m"),
    "a fixed grid": (
        {"loading": {**CYCLE, "h0_end": 3e-9}, "numerics": {"grid": "uniform", "nodes": 200}},
        "loading: the tension is largest in its last row"),
    "rigid bodies": (
        {"bodies": {"radius": 1e-6, "rigid": True}, "loading": {**CYCLE, "h0_end": 2e-9}},
        "loading: the tension is largest in its last row"),
    "rigid bodies without repulsion, apart": (
        {"bodies": {"radius": 1e-6, "rigid": True}, "loading": {**CYCLE, "h0_end": 2e-9},
         "force": {**FORCE, "part": "attractive"}},
        "loading: the tension is largest in its last row"),
}
WHOLE = {
    "a cycle": {"loading": {**CYCLE, "h0_end": -2e-9}, "unloading": {}},
    "a loading alone, whose largest tension is in contact": {"loading": {**CYCLE, "h0_end": -2e-9}},
    "a path": {"equilibrium_path": {"h0_end": -3e-9}},
    "a fixed grid": {"loading": {**CYCLE, "h0_end": -2e-9}, "unloading": {},
                     "bodies": {**BODIES, "stiffness": 3e10},
                     "numerics": {"grid": "uniform", "nodes": 400}},
    "rigid bodies": {"bodies": {"radius": 1e-6, "rigid": True},
                     "loading": {**CYCLE, "h0_end": 0.4e-9}},
    "rigid bodies that end at the largest tension": {
        "bodies": {"radius": 1e-6, "rigid": True}, "loading": {**CYCLE, "h0_end": 0.5e-9}},
    "rigid bodies that touch without a repulsion": {
        "bodies": {"radius": 1e-6, "rigid": True}, "loading": {**CYCLE, "h0_end": 0.0},
        "force": None, "hydrophobic": {"energy": 0.02, "decay_length": 1e-9}},
}


def scene(groups):
    return deck(**{"bodies": BODIES, "force": FORCE, **groups})


@pytest.mark.parametrize("name", ENDED)
def test_a_largest_tension_at_an_end_is_no_pull_off(run, name):
    groups, said = ENDED[name]
    found = run(scene(groups))
    assert found.summary["max_tension_at_end"]
    (warning,) = [one for one in found.warnings if NO_PULL_OFF in one]
    assert warning.startswith(said)


@pytest.mark.parametrize("name", WHOLE)
def test_a_pull_off_is_not_doubted(run, name):
    found = run(scene(WHOLE[name]))
    assert found.summary["max_tension_at_end"] is False
    assert not any(NO_PULL_OFF in one for one in found.warnings)


def test_the_first_scene_ended_early_has_less_than_its_pull_off(run):
    """At 1.3 nm the bodies are in contact, and the tension is two per cent below the pull-off."""
    bodies = {"radius": 1.5e-2, "stiffness": 1e10}
    force = {"law": "lennard_jones", "hamaker": 1e-20, "z0": 0.5e-9}
    short, whole = (run(deck(bodies=bodies, force=force, unloading={}, loading={
        "h0_start": 4e-9, "h0_end": end, "h0_step": 0.1e-9})) for end in (1.3e-9, -2e-9))
    assert 0.98 < short.summary["max_tension"] / whole.summary["max_tension"] < 0.99
    assert [one.summary["max_tension_at_end"] for one in (short, whole)] == [True, False]


def test_steps_within_rounding_have_no_pull_off_between_them(run):
    """Loads of neighbouring rows differ by rounding, which must make none of them an extremum."""
    z0 = 0.0007010033371579751
    found = run(deck(bodies={"radius": 7.182906070956518e-05, "stiffness": 1997295291.7220807},
                     force={"law": "lennard_jones", "hamaker": 2.5335824919975316, "z0": z0},
                     loading={"h0_start": z0, "h0_end": 0.0007010033371579745,
                              "h0_step": 2.168404344971009e-20},
                     numerics={"method": "newton"}))
    assert found.summary["max_tension_at_end"]


def test_each_unloading_tells_of_its_own_tension(run):
    summary = run(scene({"loading": {**CYCLE, "h0_end": -2e-9},
                         "unloading": {"from_": [3e-9, -2e-9]}})).summary
    assert several(summary["unload_max_tension_at_end"]) == [1, 0]
    assert summary["max_tension_at_end"] is False


def test_a_sweep_has_a_column(run):
    found = run(scene({"bodies": STIFF, "loading": {**CYCLE, "h0_end": 1e-9}, "unloading": {},
                       "sweep": {"key": "loading.h0_end", "values": [3e-9, 1e-9, -2e-9]}}))
    table = found.table("sweep.csv")
    assert list(table["max_tension_at_end"]) == [1, 1, 0]
    assert list(table["unload_max_tension_at_end_1"]) == [1, 1, 0]


def test_repulsion_alone_has_no_tension_to_doubt(run):
    found = run(exponential(1, loading=loading(6, -4, 1)))
    assert "max_tension_at_end" not in found.summary and not found.warnings


@pytest.mark.parametrize(("sigma", "at_end"), [(0.1, True), (0.87, True), (8.7, False)])
def test_an_accuracy_does_not_decide(run, sigma, at_end):
    """At 2.9 z0; under strong adhesion the pull-off is farther out."""
    for h0_end, expected in ((2.9, at_end), (-3.0, False)):
        for accuracy in (1e-2, 1e-8):
            found = run(lennard_jones(sigma, loading=loading(12, h0_end, 0.5),
                                      numerics={"accuracy": accuracy}))
            assert found.summary["max_tension_at_end"] is expected
