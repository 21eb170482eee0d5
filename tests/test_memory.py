"""Claims about memory: what a run needs is set by its mesh, not by how long it lasts."""

import pytest
import scenes
from processes import status_and_memory

LAWS = {
    "exponential": {"law": "exponential", "p0": 2.5e8, "decay_length": 0.2e-9},
    "lennard_jones": {"law": "lennard_jones", "hamaker": 1e-20, "z0": 0.5e-9},
}


def peak_memory(snapin_path, folder, law, step):
    """Peak of the resident memory [bytes] of a cycle in steps of `step` [m], and its states."""
    folder.mkdir()
    (folder / "cycle.nml").write_text(
        scenes.deck(
            bodies={"radius": 1.5e-2, "stiffness": 1e10},
            force=LAWS[law],
            loading={"h0_start": 2e-9, "h0_end": -4e-9, "h0_step": step},
            unloading={},
        )
    )
    status, used = status_and_memory(snapin_path, "--quiet", "cycle.nml", cwd=folder)
    assert status == 0
    with (folder / "results" / "cycle" / "curve.csv").open() as file:
        return used, sum(1 for line in file)


@pytest.mark.alone
@pytest.mark.parametrize("law", LAWS)
def test_memory_does_not_grow_with_the_number_of_states(law, snapin_path, tmp_path):
    few, short = peak_memory(snapin_path, tmp_path / "few", law, 2e-10)
    many, long = peak_memory(snapin_path, tmp_path / "many", law, 4e-12)
    assert long > 40 * short
    # A leak of one state's gaps and pressures, 4 kB, for each of the further 2900 states would be
    # 12 MB; what the system rounds a process to is well below this.
    assert many - few < 2e6
