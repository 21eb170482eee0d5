"""Runs decks on a program that stops where something is wrong, and names those that stop.

    run_decks.py PROGRAM FOLDER [DECK ...]

FOLDER gets the results. Without decks: those of inputs/ and of tools/verify/decks. A deck may end
with status 1, which says that a state was not found, and a wrong one with 2; any other status, or a
report of a sanitizer, is a failure. As many decks run at a time as there are cores. Status 1 if one
failed.
"""

import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import time

from snapin.command import as_command

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
ALL = ("inputs/**/*.nml", "tools/verify/decks/*.nml")
REPORT = re.compile(r"SUMMARY: \w+Sanitizer|runtime error|Fortran runtime error|received signal")


def run(program, folder, deck):
    """The deck's seconds, and what is wrong with its run."""
    began = time.monotonic()
    done = subprocess.run(
        [program, "--quiet", "--out", folder / deck.parent.name, deck], cwd=deck.parent,
        capture_output=True, text=True, errors="replace", check=False)
    wrong = None
    if done.returncode not in (0, 1, 2) or REPORT.search(done.stderr):
        wrong = f"status {done.returncode}\n{done.stderr[-3000:]}"
    return time.monotonic() - began, wrong


def main(program, folder, *patterns):
    program, folder = pathlib.Path(program).resolve(), pathlib.Path(folder).resolve()
    decks = sorted({path for pattern in patterns or ALL for path in ROOT.glob(pattern)})
    if not decks:
        return "no decks"
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        runs = {deck: pool.submit(run, program, folder, deck) for deck in decks}
        for deck, job in runs.items():
            seconds, wrong = job.result()
            failed += wrong is not None
            print(f"{deck.relative_to(ROOT)}: {wrong or 'clean'} ({seconds:.1f} s)", flush=True)
    print(f"{len(decks) - failed} of {len(decks)} decks are clean")
    return min(failed, 1)


if __name__ == "__main__":
    sys.exit(as_command(main)(*sys.argv[1:]))
