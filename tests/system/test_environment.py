"""Claims about what the environment may hold: it changes no result and ends no run."""

import os
import subprocess

import pytest
from conftest import ROOT
from support.processes import limited

FIRST = ROOT / "inputs/first.nml"
SETTINGS = [{}, {"GFORTRAN_OPTIONAL_PLUS": "y"}, {"GFORTRAN_STDERR_UNIT": "6"},
            {"GFORTRAN_STDOUT_UNIT": "0"}, {"GFORTRAN_DEFAULT_RECL": "10"},
            {"OMP_STACKSIZE": "4k", "OMP_NUM_THREADS": "2"}]


def test_no_variable_of_the_compilers_library_changes_a_result(snapin_path, tmp_path):
    """A plus sign, numbers of units and a small stack of threads changed files or ended runs."""
    libraries = subprocess.run(["ldd", snapin_path], capture_output=True, text=True, check=True)
    if "libgfortran" in libraries.stdout:
        pytest.skip("the system's libgfortran reads its variables before the program begins")
    curves = []
    for settings in SETTINGS:
        env = {**os.environ, "OMP_NUM_THREADS": "1", **settings}
        done = subprocess.run([snapin_path, "--quiet", "--into", "r", FIRST], cwd=tmp_path, env=env,
                              capture_output=True, text=True, timeout=60, check=False)
        assert done.returncode == 0 and done.stderr == "", settings
        curves.append((tmp_path / "r/curve.csv").read_bytes())
    assert curves == curves[:1] * len(SETTINGS)


@pytest.mark.parametrize("kilobytes", [64, 256, 1024])
def test_a_small_stack_is_enough_or_is_said_to_be_small(snapin, tmp_path, kilobytes):
    done = snapin("--quiet", "--into", "r", FIRST, cwd=tmp_path,
                  preexec_fn=limited("STACK", kilobytes * 1024))
    if done.returncode == 0:
        assert kilobytes >= 1024 and (tmp_path / "r/summary.nml").exists()
    else:
        assert done.returncode == 1
        assert "the stack is too small; raise its limit (ulimit -s)" in done.stderr
        assert not (tmp_path / "r").exists()
