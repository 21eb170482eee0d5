"""Every deck that is shown to users does what it says."""

from pathlib import Path

import f90nml
import pytest
from support.processes import HANG

# A map is many such paths, and the fit has a test of its own.
EXAMPLES = [path for path in sorted((Path(__file__).parents[2] / "inputs/examples").glob("*.nml"))
            if path.stem not in ("fit", "map")]


@pytest.mark.parametrize("deck", EXAMPLES, ids=lambda deck: deck.stem)
def test_an_example_runs_to_its_end(snapin, deck, tmp_path):
    done = snapin(deck, "--into", tmp_path / "results", timeout=HANG)
    assert done.returncode == 0, done.stderr
    assert "above the accuracy" not in done.stderr
    assert f90nml.read(tmp_path / "results/summary.nml")["summary"]["converged"]
