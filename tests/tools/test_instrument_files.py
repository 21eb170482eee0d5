"""Files of instruments, from their format to a fit: those with which others test their readers."""

import os
import re

import instrument_files
import pytest


@pytest.mark.long
@pytest.mark.skipif("SNAPIN_INSTRUMENT_FILES" not in os.environ,
                    reason="needs a network: SNAPIN_INSTRUMENT_FILES names a folder for downloads")
def test_every_file_is_fitted_or_told_in_one_line(tmp_path):
    """Nothing ends without a number or a reason, and no reason is that rows are in another order or
    separations: all files are in the order of time, and their positions those of the base."""
    pytest.importorskip("afmformats")
    folder = instrument_files.pathlib.Path(os.environ["SNAPIN_INSTRUMENT_FILES"])
    files = instrument_files.fetch(folder)
    assert len(files) > 30
    for path in files:
        told, _, *verdicts = instrument_files.examine(path, tmp_path)
        assert "\n" not in told
        for verdict in filter(None, verdicts):
            assert re.match(r"refused: .*\d|[0-9.e+-]+ ± ", verdict), (path.name, verdict)
            assert "reverse order" not in verdict, (path.name, verdict)


def test_a_closed_form_finds_the_stiffness_of_its_own_curve():
    z = instrument_files.np.linspace(3e-6, -3e-6, 500)
    depth = instrument_files.np.maximum(-z, 0)
    radius, stiffness, spring = 5e-6, 800.0, 1e3
    force = 2 / 3 * stiffness * radius**0.5 * depth**1.5
    noise = 1e-12 * instrument_files.np.random.default_rng(1).standard_normal(500)
    found, left = instrument_files.hertz(z, force + noise, spring, radius, "approach")
    assert found == pytest.approx(stiffness, rel=0.02)
    assert left < 20
