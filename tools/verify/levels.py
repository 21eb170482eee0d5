"""How far results depend on compiler options, on the number of threads and on OpenBLAS's kernels.

    levels.py REFERENCE NAME=PROGRAM ...

runs the decks below with the program REFERENCE on one thread, then with every other PROGRAM on one
thread, with REFERENCE on 1, 2 and 4, twice, and with the kernels for other processors that this one
can run. It prints a table: the largest difference of a column over the column's largest value, that
of loads and displacements over the value itself, that of the summary's numbers, and rows whose
iterations are not as many. Ends with status 1 where loads or displacements differ by more than the
deck's limit, where a run repeated gives other bytes, or where threads change a byte of a deck whose
matrices are too small to be shared between them. Counts of iterations, and values near zero
relative to themselves, are shown and not judged.
"""

import argparse
import os
import pathlib
import subprocess
import sys
import tempfile
from typing import NamedTuple

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tests"))

from support.scenes import Run, exponential, lennard_jones, loading, several  # noqa: E402

# Of loads and displacements, over the largest value of the column. EXACT is what is promised of
# Newton's method and of a residual_tolerance of 1e-12. Anderson acceleration stops anywhere below
# its tolerance, 1e-10 by default, and rounding decides where: then the states agree to WITHIN
# (between OpenBLAS's kernels they differ by 1.1e-12 at sigma 0.87 already). Mixing stops where its
# last change of the ratio leaves it, perhaps an iteration sooner or later: to a part of the
# tolerance.
EXACT, WITHIN, STOPPED = 1e-12, 1e-11, 1e-8
PROMISED = ("load", "displacement")
SHOWN = ("h_centre", "displacement", "load", "contact_radius")
NUMBERS = ("max_tension", "jump_in_h0", "jump_in_load", "jump_out_h0", "jump_out_load", "folds_h0")
THREADS = (1, 2, 4)
# Kernels of OpenBLAS and what a processor needs for them.
KERNELS = {
    "Prescott": {"pni"},
    "Haswell": {"avx2", "fma"},
    "SkylakeX": {"avx512f", "avx512dq", "avx512bw", "avx512vl"},
    "Zen": {"avx2", "fma"},
}

CYCLE = {"loading": loading(6, -2, 0.25), "unloading": {}}
CLOSE = {"residual_tolerance": 1e-12}
# On uniform grids the default is 1e-8: of states that stop there no twelve digits can be promised.
FIXED = {"grid": "uniform", "nodes": 300, **CLOSE}
# Matrices from so many nodes on are given to more than one thread (src/system/blas_threads.f90).
SHARED = 2500
THREADED = {"grid": "uniform", "nodes": 2600, "r_max": 20.0, **CLOSE}
STRONG = {"loading": loading(13, -4, 0.25), "unloading": {"from_": [2.0, -4.0]}}
STRONGER = {"loading": loading(80, -4, 2), "unloading": {"from_": [2.0, -4.0]}}

# Deck, and what is promised of it.
DECKS = {
    "cycle, sigma 0.17": (lennard_jones(0.17, **CYCLE), WITHIN),
    "cycle, sigma 0.87": (lennard_jones(0.87, **CYCLE, stability={}), WITHIN),
    "cycle, sigma 8.7": (lennard_jones(8.7, **STRONG), WITHIN),
    "cycle, sigma 8.7, closer": (lennard_jones(8.7, **STRONG, numerics=CLOSE), EXACT),
    "cycle, sigma 8.7, Newton": (
        lennard_jones(8.7, **STRONG, numerics={"method": "newton"}),
        EXACT,
    ),
    "cycle, sigma 100": (lennard_jones(100.0, **STRONGER), WITHIN),
    "cycle, sigma 100, closer": (lennard_jones(100.0, **STRONGER, numerics=CLOSE), EXACT),
    "path, sigma 8.7": (lennard_jones(8.7, equilibrium_path={"h0_end": -4.0}), WITHIN),
    "path, sigma 1000": (lennard_jones(1000.0, equilibrium_path={"h0_end": -4.0}), WITHIN),
    "repulsion": (
        exponential(100, loading=loading(6, -20, 0.5), unloading={}, numerics=CLOSE),
        EXACT,
    ),
    "uniform grid": (lennard_jones(0.87, **CYCLE, numerics=FIXED), EXACT),
    "uniform grid, Newton": (
        lennard_jones(0.87, **CYCLE, numerics={**FIXED, "method": "newton"}),
        EXACT,
    ),
    "2600 nodes": (lennard_jones(0.2, loading=loading(3, 1, 1), numerics=THREADED), EXACT),
    "mixing": (
        lennard_jones(
            0.17, loading=loading(6, 0, 0.5), numerics={"method": "mixing", "nodes": 100}
        ),
        STOPPED,
    ),
}


class Difference(NamedTuple):
    """Of two runs of a deck; see above."""

    columns: dict
    by_value: dict
    numbers: float
    iterations: int
    rows: int


def kernels():
    """The kernels that this processor can run."""
    try:
        features = set(pathlib.Path("/proc/cpuinfo").read_text().split())
    except OSError:
        features = set()
    return [name for name, needed in KERNELS.items() if needed <= features]


def run(program, name, text, threads, folder, kernel=None):
    """The results of a deck."""
    folder.mkdir(parents=True)
    (folder / "deck.nml").write_text(text)
    environment = dict(os.environ, OMP_NUM_THREADS=str(threads), OPENBLAS_NUM_THREADS=str(threads))
    if kernel is not None:
        environment["OPENBLAS_CORETYPE"] = kernel
    done = subprocess.run(
        [program, "--quiet", "deck.nml"],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode:
        sys.exit(f"{name}: status {done.returncode}\n{done.stderr}")
    return Run(done.returncode, done.stderr, folder / "results" / "deck")


def difference(one, other):
    """How far `other` is from `one`; None where they have not the same rows."""
    a, b = one.curve, other.curve
    if list(a["branch"]) != list(b["branch"]) or (a["converged"] != b["converged"]).any():
        return None
    columns, by_value = {}, {}
    for name in SHOWN:
        apart = abs(b[name] - a[name])
        columns[name] = float(apart.max() / max(abs(a[name]).max(), np.finfo(float).tiny))
        some = a[name] != 0
        by_value[name] = float((apart[some] / abs(a[name][some])).max(initial=0.0))
    numbers = 0.0
    for key in NUMBERS:
        if (key in one.summary) != (key in other.summary):
            return None
        if key in one.summary:
            mine, theirs = (np.array(several(r.summary[key])) for r in (one, other))
            if mine.shape != theirs.shape:
                return None
            numbers = max(numbers, float((abs(theirs - mine) / abs(mine).max()).max()))
    iterations = int((a["iterations"] != b["iterations"]).sum())
    return Difference(columns, by_value, numbers, iterations, len(a))


def table(result):
    """The bytes of a run's curve."""
    return (result.folder / "curve.csv").read_bytes()


def row(name, deck, found):
    """A row of the table."""
    if found is None:
        return f"| {name} | {deck} | other rows | | | | | |"
    cells = [f"{found.columns[column]:.0e}" for column in SHOWN]
    by_value = max(found.by_value[column] for column in PROMISED)
    return (
        f"| {name} | {deck} | "
        + " | ".join(cells)
        + f" | {by_value:.0e} | {found.numbers:.0e} | {found.iterations} of {found.rows} |"
    )


def compare(reference, programs, folder):
    """Runs all; prints the table; what is broken of the promises."""
    broken = []
    variants = [(name, program, 1, None) for name, program in programs.items()]
    variants += [(f"threads: {threads}", reference, threads, None) for threads in THREADS]
    variants += [(f"kernel: {kernel}", reference, 1, kernel) for kernel in kernels()]
    print(f"| build | deck | {' | '.join(SHOWN)} | by value | summary | other counts |")
    print("|---|---|" + "---|" * (len(SHOWN) + 3))
    worst = {}
    for number, (deck, (text, limit)) in enumerate(DECKS.items()):
        one = run(reference, deck, text, 1, folder / f"{number}")
        for index, (name, program, threads, kernel) in enumerate(variants):
            other = run(program, deck, text, threads, folder / f"{number}-{index}", kernel)
            found = difference(one, other)
            print(row(name, deck, found), flush=True)
            if program == reference and kernel is None:
                if one.cost["nodes"] < SHARED and table(one) != table(other):
                    broken.append(f"{deck}, {name}: other bytes than on one thread")
                again = run(reference, deck, text, threads, folder / f"{number}-{index}-again")
                if table(other) != table(again):
                    broken.append(f"{deck}, {name}: the same run twice gives other bytes")
            if found is None:
                broken.append(f"{deck}, {name}: other rows or other numbers of the summary")
                continue
            for column in PROMISED:
                size = found.columns[column]
                worst[name, limit] = max(worst.get((name, limit), 0.0), size)
                if not size <= limit:
                    broken.append(f"{deck}, {name}: {column} differs by {size:.1e}")
    print()
    for (name, limit), size in worst.items():
        print(f"largest difference, {name}, of decks held to {limit:.0e}: {size:.1e}")
    return broken


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("reference")
    parser.add_argument("programs", nargs="*", metavar="NAME=PROGRAM")
    arguments = parser.parse_args()
    programs = dict(pair.split("=", 1) for pair in arguments.programs)
    with tempfile.TemporaryDirectory() as folder:
        broken = compare(
            os.path.abspath(arguments.reference),
            {name: os.path.abspath(path) for name, path in programs.items()},
            pathlib.Path(folder),
        )
    for text in broken:
        print(f"broken: {text}")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
