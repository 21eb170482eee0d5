"""The calls of the system have a POSIX half and a Windows half: both have every function that
Fortran calls, and are what they say."""

import re
import shutil
import subprocess

import pytest
from conftest import ROOT

SYSTEM = ROOT / "src" / "system"
SHARED = ("any_system.c", "build_id.c", "heartbeat.c")
HALVES = {"posix": ("posix.c", "beyond_posix.c", "file_names.c", "forks.c", *SHARED),
          "windows": ("windows.c", "windows_forks.c", "windows_names.c", *SHARED)}
# Of the program alone.
BEFORE = {"posix": ("environment.c", "processor.c"),
          "windows": ("windows_environment.c", "processor.c")}
STRICT = ("-std=c11", "-D_POSIX_C_SOURCE=200809L", "-DPLAIN_POSIX", "-pedantic")


@pytest.mark.parametrize("half", HALVES)
def test_each_half_has_every_function_that_fortran_calls(half):
    called = set(re.findall(r"name='(snapin_\w+)'", "".join(
        path.read_text(encoding="utf-8") for path in SYSTEM.glob("*.f90"))))
    defined = set(re.findall(r"^\w[\w ]*[ *](snapin_\w+)\(", "".join(
        (SYSTEM / name).read_text(encoding="utf-8") for name in HALVES[half]), re.MULTILINE))
    assert len(called) > 25
    assert called - defined == set()


def compiled(compiler, half, *flags):
    if not shutil.which(compiler):
        pytest.skip(f"needs {compiler}")
    files = [SYSTEM / name for name in HALVES[half] + BEFORE[half]]
    command = [compiler, "-Wall", "-Wextra", "-Werror", "-fsyntax-only", *flags, *files]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_plain_posix_is_c11_and_posix_2008():
    compiled("gcc", "posix", *STRICT)


def test_what_is_beyond_posix_has_no_warning():
    compiled("gcc", "posix")


def test_the_other_half_is_that_of_windows():
    compiled("x86_64-w64-mingw32-gcc", "windows")
