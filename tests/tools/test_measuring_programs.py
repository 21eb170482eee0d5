"""The small programs that measure, most of which the usual builds do not make."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT


@pytest.mark.parametrize("source", sorted((ROOT / "tools/bench").glob("*.f90")),
                         ids=lambda source: source.stem)
def test_a_measuring_program_fits_the_modules(snapin_path, tmp_path, source):
    """The dispatcher called a procedure with arguments of former times, and no build with MPI could
    be made."""
    modules = Path(snapin_path).parent / "libsnapin.a.p"
    compiler = shutil.which("gfortran")
    if not compiler or not (modules / "sweeps.mod").is_file():
        pytest.skip("no gfortran, or no modules of it beside the program")
    done = subprocess.run([compiler, "-std=f2008", "-fsyntax-only", "-I", modules, "-J", tmp_path,
                           source], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(("args", "phrase"), [
    (["--build", "nowhere"], "no program in nowhere"),
    (["--draw", "--out", "nowhere"], "no measurements in .*nowhere"),
])
def test_what_bench_lacks_is_said_in_one_line(snapin_path, tmp_path, args, phrase):
    pytest.importorskip("matplotlib")
    done = subprocess.run([sys.executable, ROOT / "tools/bench/bench.py", "--build",
                           snapin_path.parent, *args], cwd=tmp_path, capture_output=True,
                          text=True, check=False)
    assert done.returncode == 2
    assert re.search(rf"^./bench: error: {phrase}$", done.stderr, re.MULTILINE), done.stderr
