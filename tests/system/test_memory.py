"""Claims about memory: what a run needs is set by its mesh, not by how long it lasts."""

import os
import subprocess

import pytest
from support import scenes
from support.processes import status_and_memory

LAWS = {
    "exponential": {"law": "exponential", "p0": 2.5e8, "decay_length": 0.2e-9},
    "lennard_jones": {"law": "lennard_jones", "hamaker": 1e-20, "z0": 0.5e-9}}


def peak_memory(snapin_path, folder, law, step):
    """Peak of the resident memory [bytes] of a cycle in steps of `step` [m], and its states."""
    folder.mkdir()
    (folder / "cycle.nml").write_text(
        scenes.deck(
            bodies={"radius": 1.5e-2, "stiffness": 1e10}, force=LAWS[law],
            loading={"h0_start": 2e-9, "h0_end": -4e-9, "h0_step": step}, unloading={})
    )
    status, used = status_and_memory(snapin_path, "--quiet", "cycle.nml", cwd=folder)
    assert status == 0
    with (folder / "results" / "cycle" / "curve.csv").open() as file:
        return used, sum(1 for line in file)


@pytest.mark.alone
@pytest.mark.parametrize("law", LAWS)
def test_memory_does_not_grow_with_the_number_of_states(law, snapin_path, tmp_path):
    few, short = peak_memory(snapin_path, tmp_path / "few", law, 4e-11)
    many, long = peak_memory(snapin_path, tmp_path / "many", law, 1e-12)
    assert long > 35 * short
    # A leak of one state's gaps and pressures, 1 kB, for each of the further 11700 states would be
    # 12 MB; what is gathered for the journal, 0.8 MB, and what the system rounds a process to are
    # well below this.
    assert many - few < 4e6


# --- Where there is too little

SMALL = scenes.lennard_jones(0.5, loading=scenes.loading(4, -1, 1))


@pytest.mark.parametrize("threads", [1, 2, 8])
def test_any_limit_of_address_space_ends_in_results_or_in_status_1(snapin_path, tmp_path, threads):
    (tmp_path / "d.nml").write_text(SMALL)
    env = dict(os.environ, OMP_NUM_THREADS=str(threads))
    env.pop("OPENBLAS_NUM_THREADS", None)
    statuses = []
    for megabytes in (60, 80, 100, 150, 190, 210, 240, 300, 400, 700, 1500):
        done = subprocess.run(
            ["sh", "-c", f'ulimit -v {megabytes}000; exec "$0" d.nml', snapin_path],
            cwd=tmp_path, env=env, capture_output=True, text=True, timeout=60, check=False)
        assert done.returncode in (0, 1), (megabytes, done.stderr)
        if done.returncode == 1:
            assert "memory" in done.stderr, megabytes
        statuses.append(done.returncode)
    # Once it is enough, more is enough too.
    assert statuses == sorted(statuses, reverse=True)
    # OpenBLAS's buffers alone are larger than the least; the reference LAPACK has none.
    made_of = subprocess.run([snapin_path, "--version"], capture_output=True, text=True, check=True)
    if "OpenBLAS" in made_of.stdout:
        assert statuses[0] == 1
    assert statuses[-1] == 0
