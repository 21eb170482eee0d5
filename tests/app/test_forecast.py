"""Claims about warnings before a run: choices that fail or take long are named, others are not."""

import random
import re

import numpy as np
import pytest
import snapin as package
from support.scenes import deck, exponential, lennard_jones, loading


@pytest.fixture
def said(snapin, tmp_path):
    """What --check says of a deck."""
    def of(deck):
        (tmp_path / "d.nml").write_text(deck)
        done = snapin("--check", "d.nml", cwd=tmp_path)
        assert done.returncode == 0
        return done.stderr

    return of


def cycle(sigma, end, step=0.2, **numerics):
    return lennard_jones(sigma, loading=loading(20.0, end, step), numerics=numerics)


def test_mixing_that_cannot_converge_is_named(said):
    text = said(cycle(8.7, -2.0, method="mixing", grid="uniform", nodes=600))
    assert re.search(r"mixing needs about \d{6} iterations", text)
    assert "states will not converge" in text and "method = 'auto'" in text


def test_the_run_warns_before_it_begins(snapin, tmp_path):
    (tmp_path / "d.nml").write_text(
        cycle(8.7, 4.0, 4.0, method="mixing", nodes=50, max_iterations=100))
    done = snapin("d.nml", cwd=tmp_path)
    (first,) = [i for i, line in enumerate(done.stderr.splitlines())
                if "warning: in contact mixing needs about" in line]
    assert first < 2
    quiet = snapin("--quiet", "d.nml", cwd=tmp_path)
    assert "mixing needs" not in quiet.stderr


# Lengths in micrometres, moduli in GPa, and both as they are: 1 um, 70 GPa.
@pytest.mark.parametrize(("radius", "stiffness", "early", "late"), [
    (1e-6, 70.0, "with a stiffness of 70 Pa", ""), (1.0, 70e9, "", "units: a radius of 1 m"),
    (1e-6, 70e9, "", "")])
def test_slips_of_units_are_named(said, snapin, tmp_path, radius, stiffness, early, late):
    """They passed without a word, and the soft contact takes minutes."""
    end = 1e-6 if early else 1e-9
    text = said(deck(
        bodies={"radius": radius, "stiffness": stiffness}, loading=loading(2*end, end, end),
        force={"law": "lennard_jones", "hamaker": 1e-19, "z0": 3e-10}))
    assert bool(text) == bool(early) and early in text
    done = snapin("d.nml", cwd=tmp_path)
    warnings = re.findall(r"warning: (.*)", done.stderr)
    # Two states far apart have no pull-off.
    assert sum("no pull-off" in said for said in warnings) == 1
    named = [said for said in warnings if "no pull-off" not in said]
    assert len(named) == bool(early or late)
    assert all((early or late) in said for said in named)


@pytest.mark.parametrize("seed", range(8))
def test_uniform_grids_are_judged_by_the_neck(said, seed):
    """0.375/sigma wide, in lateral units; at most a fifth of it between nodes resolves it."""
    rng = random.Random(seed)
    sigma, reach = 10 ** rng.uniform(0.3, 1.6), rng.uniform(8.0, 20.0)
    enough = reach / (0.2 * 0.375 / sigma)
    for factor, coarse in ((0.8, True), (1.3, False)):
        nodes = round(factor * enough) + 1
        assert nodes <= 20000
        text = said(cycle(sigma, -1.0, grid="uniform", nodes=nodes, r_max=reach))
        assert ("will be pinned" in text) == coarse
        if coarse:
            advised = int(re.search(r"about (\d+) nodes resolve it", text)[1])
            assert advised == pytest.approx(enough, rel=0.02)


@pytest.mark.parametrize("seed", range(8))
def test_good_choices_are_not_warned_of(said, seed):
    rng = random.Random(seed)
    sigma = 10 ** rng.uniform(-3, 3)
    for numerics in ({}, {"method": "newton"}, {"method": "anderson", "accuracy": 1e-4}):
        assert said(cycle(sigma, -rng.uniform(0, 5), **numerics)) == ""
    # Soft contacts, contacts without attraction, and bodies that do not touch.
    weak = 10 ** rng.uniform(-3, -1)
    for method in ("mixing", "anderson_mixing"):
        assert said(cycle(weak, -rng.uniform(0, 1), 0.5, method=method, nodes=200)) == ""
        assert said(cycle(sigma, 18.0 + 20 * sigma ** (2 / 3), method=method, nodes=200).replace(
            "h0_start = 20.0", f"h0_start = {30 + 30 * sigma ** (2 / 3)}")) == ""
        assert said(exponential(10 ** rng.uniform(0, 4), loading=loading(10.0, 0.0, 0.5),
                                numerics={"method": method, "nodes": 200})) == ""


@pytest.mark.parametrize("sigma", [0.0087, 0.087, 0.3, 0.87])
def test_the_estimated_spectrum_is_that_of_the_operator(said, sigma):
    """Dense eigenvalues of 1 - W p' on a uniform grid in contact, within a factor of two and a
    half: the number of iterations is meant to the order of magnitude."""
    h0 = -1.0
    text = said(cycle(sigma, h0, 1e-3, method="mixing", max_iterations=50, nodes=300))
    least, largest = map(float, re.search(r"from ([\d.e+-]+) to ([\d.e+-]+)\)", text).groups())
    law = package.lennard_jones(hamaker=1.0, z0=1.0)
    mesh = package.uniform_mesh(300, 8.0)
    gap = np.maximum(h0 + mesh.x**2 / 2, 1.0)
    for part in np.geomspace(1e-3, 1, 30):
        state = package.equilibrium(law, mesh, h0, part * sigma, method="newton", start=gap,
                                    most_iterations=100)
        assert state.converged
        gap = state.gap
    slope = 8 / 3 * (3 * gap**-4 - 9 * gap**-10)
    values = np.linalg.eigvals(np.eye(300) - 2 * sigma * mesh.matrix().nodes * slope).real
    assert values.min() / 2.5 < least < 2.5 * values.min()
    assert values.max() / 2.5 < largest < 2.5 * values.max()
