"""Every deck that is shown to users does what it says."""

from pathlib import Path

import f90nml
import pytest
from support.processes import HANG

# The fit has a test of its own.
EXAMPLES = [path for path in sorted((Path(__file__).parents[2] / "inputs/examples").glob("*.nml"))
            if path.stem != "fit"]


@pytest.mark.parametrize("deck", EXAMPLES, ids=lambda deck: deck.stem)
def test_an_example_runs_to_its_end(snapin, deck, tmp_path):
    # A map is many such paths.
    options = ["--check"] if deck.stem == "map" else []
    done = snapin(deck, "--into", tmp_path / "results", *options, timeout=HANG)
    assert done.returncode == 0, done.stderr
    if options:
        return
    assert "above the accuracy" not in done.stderr
    assert "beyond the model" not in done.stderr
    assert f90nml.read(tmp_path / "results/summary.nml")["summary"]["converged"]
