"""Claims about bodies that are not homogeneous: path, cycle, spring, stability and derivatives of a
half-space with a ring image, against dense states that share nothing with the program."""

import csv
import subprocess

import f90nml
import numpy as np
import pytest
from support.half_space import path_by_axis
from support.processes import HANG
from support.scenes import lennard_jones, loading

# Softer than a half-space, as on a soft base, and stiffer, as on a hard one.
SOFT, STIFF = (0.5, 1.8), (-0.35, 1.2)
# Gaps on the axis from far away into contact, and panels, narrow where the contact has its edge.
FAR = np.linspace(12, 3, 12)
AXIS = (*FAR, *np.linspace(2.8, 1.1, 18), *np.linspace(1.09, 0.98, 16))
ENDS = (*np.arange(0, 3.6, 0.15), 3.8, 4.4, *np.geomspace(6, 300, 8))
SIGMA, SOFTNESS = 1.0, 0.4


class Outcome:
    """The summary, the rows of the curve and the derivatives that the test's program prints."""

    def __init__(self, text):
        lines = [line for line in text.splitlines() if line.strip()]
        rows = [row[1:] for row in csv.reader(lines) if row[0] == "row"]
        self.branch = np.array([row[0] for row in rows])
        self.h0, self.centre, self.load, self.stable, self.eigenvalue = (
            np.array([float(row[k]) for row in rows]) for k in (1, 2, 4, 6, 10))
        others = [line for line in lines if not line.startswith(("row,", "place,"))]
        self.summary = f90nml.reads("\n".join(others) + "\n")["summary"]


@pytest.fixture(scope="module")
def run(snapin_path, tmp_path_factory):
    folder = tmp_path_factory.mktemp("body")

    def outcome(image, sigma=SIGMA, **groups):
        path = folder / f"{len(list(folder.iterdir()))}.nml"
        path.write_text(lennard_jones(sigma, **groups))
        done = subprocess.run([snapin_path.parent / "ring_image", path, *map(repr, image)],
                              capture_output=True, text=True, check=True, timeout=HANG)
        return Outcome(done.stdout)

    return outcome


PATH = {"h0_end": -1.0}


def dense(image=None):
    """H0 and loads at AXIS, of the folds, and where a drive behind the spring turns."""
    return path_by_axis(SIGMA, AXIS, ENDS, image=image, softness=(0.0, SOFTNESS))


def test_no_image_is_the_half_space(run):
    """So that what follows is about the image."""
    found = run((0.0, 1.0), equilibrium_path=PATH).summary
    h0, _ = dense()[1]
    assert [found["jump_in_h0"], found["jump_out_h0"]] == pytest.approx(h0, rel=1e-7)


@pytest.mark.parametrize("image", [SOFT, STIFF])
def test_folds_springs_and_cycles_are_those_of_independent_states(run, image):
    (h0, load), (fold_h0, fold_load), (turn_h0, turn_load) = dense(image)
    found = run(image, equilibrium_path=PATH, device={"stiffness": 1 / SOFTNESS},
                numerics={"accuracy": 1e-8}).summary
    folds = [found["jump_in_h0"], found["jump_out_h0"]]
    assert folds == pytest.approx(fold_h0, rel=1e-8)
    # Beside a fold the load goes with the root of an error in H0.
    assert [found["jump_in_load"], found["jump_out_load"]] == pytest.approx(fold_load, rel=1e-6)
    # The image matters: a half-space jumps elsewhere.
    plain = run((0.0, 1.0), equilibrium_path=PATH).summary
    assert min(abs(folds[0] - plain["jump_in_h0"]), abs(folds[1] - plain["jump_out_h0"])) > 0.02
    z = [found["device_jump_in_z"], found["device_jump_out_z"]]
    assert z == pytest.approx(turn_h0 - SOFTNESS * turn_load, rel=1e-7)
    for k in (len(FAR) - 1, -1):  # Before the jump, and in contact.
        cycle = run(image, loading=loading(6, h0[k], 0.5))
        assert cycle.h0[-1] == h0[k]
        assert cycle.centre[-1] == pytest.approx(AXIS[k], rel=1e-7)
        assert cycle.load[-1] == pytest.approx(load[k], rel=1e-6)


@pytest.mark.parametrize("image", [SOFT, STIFF])
def test_the_smallest_eigenvalue_passes_zero_at_the_folds(run, image):
    found = run(image, equilibrium_path=PATH, stability={})
    folds = np.flatnonzero(abs(found.eigenvalue) < 1e-6)
    assert found.h0[folds] == pytest.approx(
        [found.summary["jump_in_h0"], found.summary["jump_out_h0"]], rel=1e-9)
    inside = slice(folds[0] + 1, folds[1])
    assert (found.eigenvalue[inside] < 0).all()
    assert (np.delete(found.eigenvalue, np.r_[folds[0]:folds[1] + 1]) > 0).all()
    assert (found.stable[inside] == 0).all()
