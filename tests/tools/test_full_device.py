"""Claims about commands in Python whose output cannot be written: one line and status 1."""

import os
import re
import subprocess
import sys

import pytest
from conftest import ROOT
from support.processes import HANG
from support.scenes import lennard_jones

FOLDERS = ("pywrap/plots", "pywrap/scripts", "pywrap/snapin", "pywrap/snapin/plots", "tools",
           "tools/bench", "tools/reproduce", "tools/verify")
LINE = "standard output: No space left on device\n"


def into_full(*command, errors=subprocess.PIPE):
    """A command whose standard output is a full device."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    # Without this, argparse drops what it cannot write.
    environment.pop("PYTHONUNBUFFERED", None)
    with open("/dev/full", "w", encoding="utf-8") as full:
        return subprocess.run(
            [sys.executable, *map(str, command)], stdout=full, check=False, text=True,
            stderr=full if errors is None else errors, timeout=HANG, env=environment)


def test_every_command_that_prints_ends_through_one_procedure():
    others = []
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).glob("*.py")):
            text = path.read_text(encoding="utf-8")
            if '__name__ == "__main__"' in text and "print(" in text:
                through = re.search(r"as_command\(main\)\(|@as_command\ndef main", text)
                others += [] if through else [path.name]
    assert others == []


@pytest.mark.parametrize("name", [
    "pywrap/plots/map.py", "pywrap/plots/force_law.py", "pywrap/scripts/afm_to_table.py",
    "pywrap/snapin/convert.py", "tools/reproduce/reproduce.py"])
def test_a_full_device_is_one_line(name):
    """It was a traceback and status 120."""
    module = name.endswith("convert.py")
    done = into_full(*(("-m", "snapin.convert") if module else (ROOT / name,)), "--help")
    assert done.returncode == 1
    assert done.stderr == f"{os.path.basename(name)}: {LINE}"


def test_a_picture_whose_name_cannot_be_printed_is_there(run, tmp_path):
    folder = run(lennard_jones(0.5, equilibrium_path={"h0_end": -1.0})).folder
    picture = tmp_path / "a.png"
    for errors in (subprocess.PIPE, None):
        done = into_full(ROOT / "pywrap/plots/force_curve.py", folder, "-o", picture,
                         errors=errors)
        assert done.returncode == 1
        assert errors is None or done.stderr == f"force_curve.py: {LINE}"
        assert picture.stat().st_size > 1000
