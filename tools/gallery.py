#!/usr/bin/env python3
"""Renew the pictures of docs/gallery.md by the commands on the page: a minute.

    .venv/bin/python tools/gallery.py [NAME ...]

A picture is made by the commands in the block above it. Without names, all pictures are renewed.
"""

import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

from snapin.command import as_command

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/gallery.md"
DPI = "90"
_ENTRY = re.compile(r"((?:^    .*\n)+)\n!\[[^]]*\]\((\S+\.png)\)", re.M)


def entries():
    """Return (picture, its deck, the script with its arguments) of every picture on the page."""
    found = []
    for block, picture in _ENTRY.findall(PAGE.read_text(encoding="utf-8")):
        *runs, drawn = [shlex.split(line) for line in block.strip().splitlines()]
        deck = runs[0][1] if runs else drawn[2]
        found.append((picture, deck, drawn[1:]))
    return found


def draw(picture, deck, command):
    """Run the deck and the script of one picture."""
    script, source, *options = command
    with tempfile.TemporaryDirectory() as folder:
        if source.startswith("results/"):
            subprocess.run([ROOT / "build/snapin", "--quiet", "--into", folder, ROOT / deck],
                           check=True)
            source = folder
        output = ["-o", ROOT / "docs" / picture, "--dpi", DPI]
        if script.endswith("force_law.py"):
            # This script names its own picture.
            subprocess.run([sys.executable, ROOT / script, source, "--out", folder], check=True,
                           cwd=ROOT, stdout=subprocess.DEVNULL)
            made = pathlib.Path(folder) / pathlib.Path(deck).stem / "force_law.png"
            (ROOT / "docs" / picture).write_bytes(made.read_bytes())
            return
        subprocess.run([sys.executable, ROOT / script, source, *options, *output], check=True,
                       cwd=ROOT, stdout=subprocess.DEVNULL)


def main():
    names = sys.argv[1:]
    for picture, deck, command in entries():
        if not names or pathlib.Path(picture).stem in names:
            draw(picture, deck, command)
            print(picture)


if __name__ == "__main__":
    sys.exit(as_command(main)())
