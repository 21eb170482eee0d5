"""Claims that no solver knows where contact is: a law moved outward moves path and cycle with it
and changes nothing else, and a law added by the recipe of CONTRIBUTING.md is computed like any
other."""

import os
import pathlib
import re
import shutil
import subprocess

import numpy as np
import pytest
from support.scenes import deck, runner

ROOT = pathlib.Path(__file__).resolve().parents[2]
BODIES = {"radius": 1.5e-2, "stiffness": 1e10}
DECAY = 0.3e-9


def scene(group, surface_energy, outward):
    """Cycle and path of a law whose well is at 0.5 nm plus `outward` [m]."""
    return deck(
        bodies=BODIES,
        **{group: {
            "surface_energy": surface_energy, "z0": 0.5e-9 + outward, "decay_length": DECAY}},
        loading={"h0_start": outward + 7e-9, "h0_end": outward - 2e-9, "h0_step": 2e-10},
        unloading={},
        equilibrium_path={},
        profiles={"h0": outward + 1e-9},
        classical={"count": 20},
    )


def claim_translated(at_home, away, outward):
    """Everything is where it was, `outward` farther; rounding of h0 at 20 nm is 3e-24 m."""
    for name, places in (("curve", {"h0", "h_centre"}), ("classical", {"h0"})):
        one, other = at_home.table(f"{name}.csv"), away.table(f"{name}.csv")
        for column in one.columns:
            here, there = one[column], other[column]
            if column in ("branch", "theory"):
                assert list(here) == list(there)
            elif column not in ("residual", "iterations"):
                moved = outward if column in places else 0.0
                size = np.nanmax(abs(here))
                np.testing.assert_allclose(there - moved, here, rtol=0, atol=1e-9 * size)
    for key, value in at_home.summary.items():
        if key in ("max_tension", "surface_energy", "sigma", "jump_out_load", "energy_lost"):
            assert away.summary[key] == pytest.approx(value, rel=1e-9), key
        if key in ("max_tension_h0", "jump_in_h0", "jump_out_h0"):
            assert away.summary[key] - outward == pytest.approx(value, abs=1e-9 * 1e-9), key


@pytest.mark.parametrize("outward", [2e-9, 4e-9, 20e-9])
@pytest.mark.parametrize("surface_energy", [1e-4, 1e-2])
def test_a_well_moved_outward_moves_path_and_cycle_with_it(run, surface_energy, outward):
    at_home = run(scene("morse", surface_energy, 0.0))
    away = run(scene("morse", surface_energy, outward))
    claim_translated(at_home, away, outward)


@pytest.mark.long
def test_the_recipe_adds_a_law_in_one_file_and_one_line(tmp_path):
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    module = re.search(r"```fortran\n(!> [^`]*?\nmodule rose\n.*?end module rose\n)", text, re.S)[1]
    tree = tmp_path / "snapin"
    left_out = shutil.ignore_patterns(".git", ".venv", "build", "build-*", "results")
    shutil.copytree(ROOT, tree, ignore=left_out)
    laws = tree / "src" / "model" / "laws"
    (laws / "rose.f90").write_text(module, encoding="utf-8")
    listed = (laws / "meson.build").read_text(encoding="utf-8")
    listed = listed.replace("law_names = [\n", "law_names = [\n  'rose',\n")
    (laws / "meson.build").write_text(listed)
    tools = ROOT / ".venv" / "bin"
    env = dict(os.environ, PATH=f"{tools}:{os.environ['PATH']}")
    for command in (
            ["meson", "setup", "build", "-Dpython=disabled"], ["meson", "compile", "-C", "build"]):
        subprocess.run(command, cwd=tree, env=env, check=True, capture_output=True, timeout=590)

    def added(*args, cwd=None, **kwargs):
        kwargs.setdefault("timeout", 300)
        return subprocess.run(
            [tree / "build" / "snapin", *args],
            cwd=cwd, capture_output=True, text=True, check=False,
            **kwargs)

    run = runner(added, tmp_path)
    assert "&rose" in added("--keys").stdout
    at_home = run(scene("rose", 1e-2, 0.0))
    assert at_home.summary["converged"]
    assert at_home.summary["max_tension"] == pytest.approx(
        1.5 * np.pi * BODIES["radius"] * 1e-2, rel=0.03)
    claim_translated(at_home, run(scene("rose", 1e-2, 20e-9)), 20e-9)
