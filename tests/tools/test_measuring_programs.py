"""The small programs that measure, most of which the usual builds do not make."""

import json
import re
import subprocess
from pathlib import Path

import pytest
from conftest import ROOT


@pytest.mark.parametrize("source", sorted((ROOT / "tools/bench").glob("*.f90")),
                         ids=lambda source: source.stem)
def test_a_measuring_program_fits_the_modules(snapin_path, tmp_path, source):
    """The dispatcher called a procedure with arguments of former times, and no build with MPI could
    be made."""
    build = Path(snapin_path).parent
    compilers = build / "meson-info" / "intro-compilers.json"
    if not compilers.is_file():
        pytest.skip("the program is in no build folder, beside its modules")
    compiler = json.loads(compilers.read_text())["host"]["fortran"]["exelist"]
    done = subprocess.run([*compiler, "-fsyntax-only", "-I", build / "libsnapin.a.p", "-J",
                           tmp_path, source], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(("args", "phrase"), [
    (["--build", "nowhere"], "no program in nowhere"),
    (["--draw", "--out", "nowhere"], "no measurements in .*nowhere"),
])
def test_what_bench_lacks_is_said_in_one_line(called, snapin_path, args, phrase):
    pytest.importorskip("matplotlib")
    done = called(ROOT / "tools/bench/bench.py", "--build", snapin_path.parent, *args)
    assert done.returncode == 2
    assert re.search(rf"^./bench: error: {phrase}$", done.stderr, re.MULTILINE), done.stderr
