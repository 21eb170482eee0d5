"""Maugis-Dugdale theory beside the curve: the rows of classical.csv and the keys of the summary."""

import math

import numpy as np
import pytest
import snapin
from support.scenes import deck, exponential, lennard_jones

# In units of z0 and E/(1-nu^2), with R = 1: gamma is sigma.
# Largest tension of the Lennard-Jones law in units of gamma/z0, at h = 3^(1/6).
PEAK = 8 / 3 * (3**-0.5 - 3**-1.5)
RANGE = {"h0_start": 8.0, "h0_end": -12.0, "count": 101}
SIGMAS = [0.01, 0.2, 0.87, 8.7, 100.0]


def unit_of(sigma):
    """Maugis' unit of contact radius; its square is that of displacement."""
    return (1.5 * math.pi * sigma) ** (1 / 3)


def range_of(sigma):
    """A range of h0 that begins where no theory has a state."""
    return {**RANGE, "h0_start": 8 + 3 * unit_of(sigma) ** 2}


def classical(sigma, **keys):
    """A deck with the classical theories and nothing else."""
    return lennard_jones(sigma, classical={**range_of(sigma), **keys})


def material(sigma):
    return {"radius": 1.0, "stiffness": 1.0, "surface_energy": sigma, "strength": PEAK * sigma}


@pytest.mark.parametrize("sigma", SIGMAS)
def test_rows_are_on_the_curve_that_the_contact_radius_parametrises(run, sigma):
    rows = run(classical(sigma)).table("classical.csv").rows("maugis_dugdale")
    load, displacement = snapin.contact_curve("maugis", rows["contact_radius"], **material(sigma))
    np.testing.assert_array_equal(rows["displacement"], -rows["h0"])
    size = rows["contact_radius"] ** 2
    assert (abs(displacement - rows["displacement"]) <= 1e-13 * (size + 1)).all()
    np.testing.assert_allclose(load, rows["load"], rtol=1e-12, atol=1e-12 * sigma)


@pytest.mark.parametrize("sigma", SIGMAS)
def test_rows_are_the_stable_states_and_reach_to_the_least_displacement(run, sigma):
    """At each displacement the largest contact, which grows with it; and no state is left out."""
    rows = run(classical(sigma)).table("classical.csv").rows("maugis_dugdale")
    a = np.geomspace(1e-4, 30, 200001) * unit_of(sigma)
    _, displacement = snapin.contact_curve("maugis", a, **material(sigma))
    assert (np.diff(rows["contact_radius"]) > 0).all()
    # h0 falls, so that the first row is the one nearest to the least displacement.
    step = (range_of(sigma)["h0_start"] - RANGE["h0_end"]) / (RANGE["count"] - 1)
    least = displacement.min()
    assert least - 1e-6 <= rows["displacement"][0] < least + 1.001 * step
    np.testing.assert_allclose(np.diff(rows["h0"]), -step, rtol=1e-9)
    assert rows["h0"][-1] == pytest.approx(RANGE["h0_end"], rel=1e-14)
    beyond = a > 1.0001 * rows["contact_radius"][0]
    assert (displacement[beyond] > rows["displacement"][0]).all()


@pytest.mark.parametrize("sigma", SIGMAS)
def test_summary_has_maugis_parameter_and_pull_off(run, sigma):
    summary = run(classical(sigma)).summary
    assert summary["maugis_lambda"] / summary["tabor"] == pytest.approx(1.157, abs=5e-4)
    pull_off = snapin.pull_off("maugis", **material(sigma))
    assert summary["maugis_pull_off"] == pytest.approx(-pull_off, rel=1e-12)
    assert summary["jkr_pull_off"] < summary["maugis_pull_off"] < summary["dmt_pull_off"]


@pytest.mark.parametrize(
    "text",
    [
        lennard_jones(0.87, part="attractive", classical=RANGE),
        lennard_jones(0.87, part="repulsive", classical=RANGE), exponential(1, classical=RANGE)],
    ids=["attractive", "repulsive", "exponential"],
)
def test_a_law_without_a_largest_tension_has_no_maugis_rows(run, text):
    result = run(text)
    table = result.table("classical.csv")
    assert "hertz" in table["theory"] and "maugis_dugdale" not in table["theory"]
    assert [key for key in result.summary if key.startswith("maugis")] == []


@pytest.mark.parametrize(("groups", "why"), [
    ({"bodies": {"radius": 1.0, "rigid": True}}, "rigid bodies"),
    ({"force": {"law": "exponential", "p0": 1.0, "decay_length": 1.0},
      "classical": {**RANGE, "theories": "jkr"}}, "does not attract"),
    ({"classical": {"h0_start": 8.0, "h0_end": 5.0, "theories": "hertz"}}, "range of h0"),
])
def test_a_table_without_rows_has_a_note(run, groups, why):
    bodies = {"radius": 1.0, "stiffness": 1.0}
    result = run(deck(**{"bodies": bodies, "classical": RANGE, "force": {
        "law": "lennard_jones", "surface_energy": 1.0, "z0": 1.0}, **groups}))
    assert why in result.summary["notes"]
    assert len(result.table("classical.csv")["theory"]) == 0
