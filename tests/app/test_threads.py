"""Claims about threads: those that wait, and cases of a sweep computed at the same time."""

import os
import pathlib
import re
import shutil
import subprocess
import time

import pytest
from conftest import ROOT

PATHS = {path.stem: path.relative_to(ROOT) for path in (ROOT / "src").rglob("*.f90")}
SOURCES = {name: (ROOT / path).read_text() for name, path in PATHS.items()}


def uses(name):
    """The modules of this project that a module uses, directly or not, and itself."""
    found, left = set(), [name]
    while left:
        module = left.pop()
        if module in found or module not in SOURCES:
            continue
        found.add(module)
        left += re.findall(r"^ *use (\w+)", SOURCES[module], re.MULTILINE)
    return found


def test_what_cases_do_at_the_same_time_keeps_no_string_length_in_static_storage(snapin_path):
    # gfortran keeps the length of a string that a function returns in a static variable, slen.N,
    # of whoever asks for it. Threads that get there at once take each other's length.
    if shutil.which("nm") is None:
        pytest.skip("nm is missing")
    objects = pathlib.Path(snapin_path).parent / "libsnapin.a.p"
    if not objects.is_dir():
        pytest.skip("no object files beside the program")
    # Decks are read before the cases begin, and only one at a time is varied. Cases have no files.
    together = uses("experiment") - {
        name
        for name in SOURCES
        if name.startswith(("deck", "scene")) or name in ("c_library", "text")
    }
    assert {"stepped_branch", "path", "anderson", "reported_numbers"} <= together
    files = [objects / ("_".join(PATHS[module].parts) + ".o") for module in sorted(together)]
    listing = subprocess.run(["nm", "-A", *files], capture_output=True, text=True, check=True)
    guilty = {line.split(":")[0] for line in listing.stdout.splitlines()
              if re.search(r"\bslen\.", line)}
    assert not guilty


def test_no_thread_waits_for_work_that_small_matrices_do_not_give(snapin_path, tmp_path):
    """OpenBLAS starts its threads as it is loaded, and they look for work at full speed."""
    env = dict(os.environ, OMP_NUM_THREADS="2", OPENBLAS_NUM_THREADS="2")
    with subprocess.Popen([snapin_path, "--check", "missing.nml", "/dev/stdin"], cwd=tmp_path,
                          env=env, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        # Having missed the first deck it waits for the second.
        assert b"missing.nml" in process.stderr.readline()
        # What has ended may be listed for a moment.
        for _ in range(1000):
            left = len(os.listdir(f"/proc/{process.pid}/task"))
            if left == 1:
                break
            time.sleep(0.01)
        assert left == 1
        process.communicate()
