"""Claims about what a run says at its end: the main results, with the numbers of the summary."""

import re

import numpy as np
import pytest
from support.scenes import deck, loading, read_groups

PREFIX = {"f": 1e-15, "p": 1e-12, "n": 1e-9, "u": 1e-6, "m": 1e-3, "": 1.0, "k": 1e3}
VALUE = r"(-?[\d.e+-]+?)(?: \+- ([\d.e+-]+))? ([fpnumk]?)"
SCENE = {"bodies": {"radius": 1.5e-2, "stiffness": 1e10},
         "force": {"law": "lennard_jones", "hamaker": 1e-20, "z0": 0.5e-9}}
CYCLE = {"loading": loading(4e-9, -2e-9, 1e-10), "unloading": {"from": -2e-9, "h0_end": 4e-9}}


def said(snapin, tmp_path, groups, *options):
    (tmp_path / "d.nml").write_text(deck(**groups))
    done = snapin("--out", ".", *options, "d.nml", cwd=tmp_path)
    assert done.returncode == 0
    return done.stderr, read_groups(tmp_path / "d/summary.nml")["summary"]


def check(text, name, unit, summary, key):
    """The text has the value of a key, and its error to three digits."""
    value, error, prefix = re.search(f"{name}{VALUE}{unit}\\b", text).groups()
    stated = summary[f"{key}_error"]
    assert float(value)*PREFIX[prefix] == pytest.approx(summary[key], abs=max(
        stated, 1e-15*abs(summary[key])))
    assert float(error)*PREFIX[prefix] == pytest.approx(stated, rel=5e-3)


def test_a_cycle_says_pull_off_and_jumps_with_their_errors(snapin, tmp_path):
    text, summary = said(snapin, tmp_path, {**SCENE, **CYCLE})
    check(text, "pull-off force ", "N", summary, "max_tension")
    check(text, " at h0 = ", "m", summary, "max_tension_h0")
    check(text, "snap-in at h0 = ", "m", summary, "jump_in_h0")
    check(text, "snap-off at h0 = ", "m", summary, "jump_out_h0")
    jkr, dmt = (100*(summary[f"{name}_pull_off"]/summary["max_tension"] - 1)
                for name in ("jkr", "dmt"))
    assert -10 < jkr < 0 < dmt < 30
    # Without &classical that of Maugis and Dugdale, which is nearer, is not known.
    assert (f"pull-off force by JKR theory {-jkr:.3g} % smaller, by DMT theory {dmt:.3g} % larger"
            in text)
    assert "grid edge_locked" not in text and "nearest" not in text


def test_the_nearest_theory_is_named_where_all_are_known(snapin, tmp_path):
    text, summary = said(snapin, tmp_path, {**SCENE, **CYCLE, "classical": {}})
    off = 100*(summary["maugis_pull_off"]/summary["max_tension"] - 1)
    assert -5 < off < 0
    assert f"nearest theory, Maugis-Dugdale, has a pull-off force {-off:.3g} % smaller" in text


def test_a_tension_in_the_last_row_is_no_pull_off(snapin, tmp_path):
    text, _ = said(snapin, tmp_path, {**SCENE, "loading": loading(4e-9, 1.6e-9, 1e-10)})
    assert re.search("largest tension .*N, in the first or last row: no pull-off force", text)
    assert "pull-off force " not in text.replace("no pull-off force", "").replace(
        "max_tension is no pull-off", "") and " theory" not in text


@pytest.mark.slow
def test_the_pull_off_of_a_noisy_table_has_the_error_of_its_points(snapin, tmp_path):
    """The line had the error of the calculation alone, ten million times smaller."""
    gap = np.geomspace(0.4e-9, 5e-9, 200)
    noise = np.random.default_rng(3).standard_normal(200)
    pressure = 1e-20/(6*np.pi*gap**3)*((0.5e-9/gap)**6 - 1)*(1 + 3e-3*noise)
    np.savetxt(tmp_path / "law.csv", np.transpose([gap, pressure]), delimiter=",")
    text, summary = said(snapin, tmp_path, {
        "bodies": SCENE["bodies"], "tabulated": {"file": "law.csv", "tail_exponent": 3},
        "equilibrium_path": {"h0_end": 0.0}})
    value, error, prefix = re.search(f"pull-off force {VALUE}N", text).groups()
    of_points = summary["table_error"]*summary["max_tension"]
    assert of_points > 100*summary["max_tension_error"] > 0
    assert float(error)*PREFIX[prefix] == pytest.approx(of_points, rel=0.02)


def test_numerics_are_told_if_asked_for(snapin, tmp_path):
    text, summary = said(snapin, tmp_path, {**SCENE, **CYCLE}, "--verbose")
    assert f"grid {summary['grid']}, method {summary['method']}: " in text


def test_a_repulsive_force_has_no_pull_off(snapin, tmp_path):
    text, _ = said(snapin, tmp_path, {
        "bodies": SCENE["bodies"], "loading": loading(4e-9, -2e-9, 1e-10),
        "force": {"law": "exponential", "p0": 2.5e8, "decay_length": 2e-10}})
    assert "pull-off" not in text and "snap" not in text and "states in" in text


def test_theories_are_not_compared_with_a_drive(snapin, tmp_path):
    drive = {"velocity": 1.0, "z_start": 5.0, "z_turn": 0.0}
    text, _ = said(snapin, tmp_path, {
        "bodies": {"radius": 1.0, "stiffness": 1.0}, "drive": drive,
        "force": {"law": "lennard_jones", "work_of_adhesion": 0.1, "z0": 1.0},
        "viscoelastic": {"stiffness_relaxed": 0.5, "retardation_time": 1.0}})
    assert "pull-off force" in text and "theory" not in text


def test_no_theory_is_the_nearest_to_states_that_did_not_converge(snapin, tmp_path):
    (tmp_path / "d.nml").write_text(deck(**SCENE, **CYCLE, numerics={
        "method": "mixing", "nodes": 100, "max_iterations": 3}))
    done = snapin("--out", ".", "d.nml", cwd=tmp_path)
    assert done.returncode == 1
    assert "theory" not in done.stderr and "states in" in done.stderr


@pytest.mark.parametrize("ratio, note, warning", [
    (0.095, False, False), (0.105, True, False), (0.32, True, False), (0.35, False, True)])
def test_lengths_above_a_tenth_and_a_third_of_the_radius_are_said(
        snapin, tmp_path, ratio, note, warning):
    """docs/limits.md. The range of the force does not depend on the radius."""
    def summary_of(radius):
        return said(snapin, tmp_path, {**SCENE, "bodies": {"radius": radius, "rigid": True},
                                       "loading": loading(3e-9, 2e-9, 1e-9)})[1]

    summary = summary_of(summary_of(1.0)["range_over_radius"]/ratio)
    assert summary["range_over_radius"] == pytest.approx(ratio)
    assert ("which is not small" in str(summary.get("notes", ""))) == note
    assert ("beyond the model: the range" in str(summary.get("warnings", ""))) == warning
