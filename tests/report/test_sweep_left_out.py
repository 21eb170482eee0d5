"""Claims about what a sweep does not write: it is refused, or said."""

import re

import pytest
from support.scenes import lennard_jones

SWEPT = {"key": "force.hamaker", "values": [1.0, 2.0]}


@pytest.mark.parametrize("group, keys", [
    ("table", {}), ("profiles", {"h0": 0.0}), ("stability", {}),
    ("sensitivity", {"parameters": "force.z0"})])
@pytest.mark.parametrize("option", [(), ("--check",)])
def test_a_group_without_a_number_in_a_sweep_is_refused(snapin, tmp_path, group, keys, option):
    """Tables and states of the cases were left out, those of &table without a word."""
    (tmp_path / "d.nml").write_text(lennard_jones(
        0.5, equilibrium_path={"h0_end": -1.0}, **{group: keys}, sweep=SWEPT))
    done = snapin(*option, "d.nml", cwd=tmp_path)
    assert done.returncode == 2
    assert re.search(f"&{group}: not together with &sweep", done.stderr)
    assert not (tmp_path / "results").exists()


@pytest.mark.parametrize("group, keys, tables", [
    ("device", {"stiffness": 0.2}, ["device.csv", "device_jumps.csv"]),
    ("fixed_load", {"load": 0.0}, ["fixed_load.csv"]), ("classical", {}, ["classical.csv"]),
    ("approximations", {}, ["approximations.csv"]), ("regime", {}, [])])
def test_tables_that_a_sweep_leaves_out_are_said(snapin, run, tmp_path, group, keys, tables):
    """What a group writes alone is in a sweep too, or is named by the check and in the summary."""
    scene = {"equilibrium_path": {"h0_end": -1.0}, group: keys}
    text = lennard_jones(0.5, **scene, sweep=SWEPT)
    alone, swept = run(lennard_jones(0.5, **scene)), run(text)
    extra = {*alone.files} - {"curve.csv", "summary.nml"}
    assert extra == {*tables} and {*swept.files} == {"sweep.csv", "summary.nml"}
    (tmp_path / "d.nml").write_text(text)
    said = snapin("--check", "d.nml", cwd=tmp_path)
    assert said.returncode == 0 and "d.nml: ok" in said.stdout
    note = f"a sweep writes no {', '.join(tables)}; run a case alone"
    assert (note in said.stderr) == bool(tables)
    assert (note in str(swept.summary.get("notes", ""))) == bool(tables)
