"""Judges random relatives of decks whose numbers were once wrong, by solutions of their own.

    .venv/bin/python tools/verify/relatives.py [KIND ...] [--count N] [--seed N]

A relative has the keys of such a deck, varied over wide ranges. Its numbers are within their
errors, outside but told by a warning, or wrong in silence. The judges:

    uniform_jump small_jump end_of_panels short_limit unconverged two_iterates ends
                    cycles on fixed grids, and cycles and paths that may end before their pull-off:
                    the independent path of the Lennard-Jones problem (tests/support/reference.py)
    noisy_table creep regime criterion_28
                    closed forms, and states of the same path
    step outer spring punch
                    the program at accuracy 1e-8; all but punches also on a mesh of the judge's own
                    (tests/support/second_mesh.py)
    start bow_left_out
                    the truth behind curves of the independent path

The program is $SNAPIN, else build/snapin. Ends with status 1 if a number is wrong in silence.
"""

import argparse
import collections
import importlib
import os
import pathlib
import sys
import tempfile

# Before NumPy is imported: one thread in each process.
os.environ["OMP_NUM_THREADS"] = os.environ["OPENBLAS_NUM_THREADS"] = "1"
ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT / folder) for folder in ("tests", "pywrap", "build/pywrap")]

from snapin.command import as_command  # noqa: E402
from support.decks_in_units import program_path  # noqa: E402
from support.relatives import Job  # noqa: E402
from support.spread import spread  # noqa: E402

FAMILIES = [importlib.import_module(f"support.relatives_{name}")
            for name in ("grids", "forces", "laws", "fits")]
FAMILY_OF = {kind: family for family in FAMILIES for kind in family.KINDS}
VERDICTS = ("within", "told", "silent", "undecided")


def examine(job):
    """The verdict on one relative, and a line about it if it is not within its errors."""
    judged = FAMILY_OF[job.kind].examine(job)
    if judged.verdict == "silent":
        print(f"{job.kind} {job.number}: {judged.text}: {'; '.join(judged.silent)}", flush=True)
    return judged


def table(verdicts):
    """Lines of a report: relatives and numbers of each kind."""
    lines = [f"{'kind':<14} {'relatives':>9}" + "".join(f"{name:>11}" for name in VERDICTS)
             + f"{'numbers':>9} {'within':>7} {'told':>5} {'silent':>7}"]
    kinds = {}
    for one in verdicts:
        kinds.setdefault(one.job.kind, []).append(one)
    for kind, ones in [*kinds.items(), ("all", verdicts)]:
        counts = collections.Counter(one.verdict for one in ones)
        numbers = [sum(one.within for one in ones), sum(len(one.told) for one in ones),
                   sum(len(one.silent) for one in ones)]
        lines.append(f"{kind:<14} {len(ones):9d}"
                     + "".join(f"{counts[name]:11d}" for name in VERDICTS)
                     + f"{sum(numbers):9d} {numbers[0]:7d} {numbers[1]:5d} {numbers[2]:7d}")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("kinds", nargs="*", default=list(FAMILY_OF), metavar="KIND")
    parser.add_argument("--count", type=int, default=15, help="relatives of each kind")
    parser.add_argument("--first", type=int, default=0, help="number of the first relative")
    parser.add_argument("--seed", type=int, default=1, help="of the random decks")
    parser.add_argument("--workers", type=int, default=2)
    arguments = parser.parse_args()
    unknown = [name for name in arguments.kinds if name not in FAMILY_OF]
    if unknown:
        parser.error(f"no kind called {unknown[0]}; there are: {', '.join(FAMILY_OF)}")
    if not program_path().is_file():
        parser.error("no executable: build the program first, or set SNAPIN")
    with tempfile.TemporaryDirectory() as folder:
        jobs = [Job(kind, number, arguments.seed, pathlib.Path(folder) / f"{kind}{number}")
                for kind in arguments.kinds
                for number in range(arguments.first, arguments.first + arguments.count)]
        verdicts = spread(examine, jobs, workers=arguments.workers, name="relatives")
    print("\n".join(table(verdicts)))
    return 1 if any(one.verdict == "silent" for one in verdicts) else 0


if __name__ == "__main__":
    sys.exit(as_command(main)())
