"""Claims about cases of a sweep that are computed at the same time."""

import pathlib
import re
import shutil
import subprocess

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
    assert {"stepped_branch", "path", "anderson", "error_estimate"} <= together
    guilty = []
    for module in sorted(together):
        file = objects / ("_".join(PATHS[module].parts) + ".o")
        listing = subprocess.run(["nm", file], capture_output=True, text=True, check=True)
        if re.search(r"\bslen\.", listing.stdout):
            guilty.append(file.name)
    assert not guilty
