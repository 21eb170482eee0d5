"""Measure how results depend on compiler and options, on threads, and on OpenBLAS's kernels.

    levels.py [--builds] REFERENCE [NAME=PROGRAM ...]

runs decks with the program REFERENCE on one thread, and with every other PROGRAM: the decks below,
and those of inputs/ except LEFT_OUT. Without --builds the decks below are also run with REFERENCE
on 1, 2 and 4 threads, twice, and with the kernels for other processors that this one can run.
It compares all columns of all tables, relative to the largest value of the column, and all numbers
of the summary, except ROUNDED. Prints a table: the largest difference, its place, and the number of
rows with a different number of iterations, which is not judged. Ends with status 1 if a difference
exceeds the deck's limit, if a repeated run gives other bytes, or if threads change a byte of a deck
whose matrices are too small to be shared between threads.
"""

import argparse
import os
import pathlib
import subprocess
import sys
import tempfile
from typing import NamedTuple

import f90nml
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tests"))

from snapin.command import as_command  # noqa: E402
from support.processes import threaded  # noqa: E402
from support.scenes import Run, exponential, lennard_jones, loading, several  # noqa: E402

# Limits of differences. EXACT is promised for a residual_tolerance of 1e-12. Without it a state
# that the path predicts within the tolerance takes no step, by Newton's method either; rounding of
# the prediction remains: 1.8e-12 between compilers at sigma 8.7. Anderson acceleration stops
# anywhere below its tolerance, 1e-10 by default, at a residual that depends on rounding: then the
# states agree to WITHIN (between OpenBLAS's kernels they differ by 1.1e-12 at sigma 0.87 already,
# between compilers by 1.4e-11). Mixing stops after the last change of the ratio, perhaps an
# iteration sooner or later: to a part of the tolerance. A fit stops where a step hardly changes the
# sum of squares (`least_squares`), and rounding decides which step: between OpenBLAS's kernels the
# values differ by up to 0.03 of their standard errors. FITTED is a part of the largest relative
# standard error.
EXACT, WITHIN, STOPPED, FITTED = 1e-12, 3e-11, 1e-8, 0.1
# Rows of a traced path lie at the ends of its steps. Rounding moves them along the path, which is
# unchanged: 4.2e-7 at sigma 1000 between compilers.
PLACED = 1e-6
# Decks of inputs/ have tolerances of their own: their limit is the remaining residual times this
# factor, since states near a fold move by more than the residual.
OF_RESIDUAL = 10
# Decks of inputs/ that stop by the paper's rule, whose states depend on rounding (./reproduce gives
# their ranges), and those with grids so coarse that the edge of a contact is pinned until it slips:
# the last slip depends on rounding. Maps: thousands of paths such as others show alone. And drives,
# whose steps depend on differences of loads: rows are at other times.
LEFT_OUT = (
    "_paper", "history_", "fig10c_uniform", "fig10c_coarse", "map", "viscoelastic", "drainage")
# Not compared: the remaining residual; estimates, which are differences of numbers that agree to
# many digits; and the resolution, which depends on the node nearest to the edge.
ROUNDED = ("residual", "iterations", "_error", "_uncertainty", "_estimate", "spacing_over_neck")
THREADS = (1, 2, 4)
TINY = np.finfo(float).tiny
# Kernels of OpenBLAS and the processor features that they need.
KERNELS = {
    "Prescott": {"pni"}, "Haswell": {"avx2", "fma"},
    "SkylakeX": {"avx512f", "avx512dq", "avx512bw", "avx512vl"}, "Zen": {"avx2", "fma"}}

CYCLE = {"loading": loading(6, -2, 0.25), "unloading": {}}
CLOSE = {"residual_tolerance": 1e-12}
# On uniform grids the default is 1e-8: states at this tolerance do not agree to twelve digits.
FIXED = {"grid": "uniform", "nodes": 300, **CLOSE}
# Matrices with at least this number of nodes use more than one thread
# (src/system/machine.f90).
SHARED = 2500
THREADED = {"grid": "uniform", "nodes": 2600, "r_max": 20.0, **CLOSE}
STRONG = {"loading": loading(13, -4, 0.25), "unloading": {"from_": [2.0, -4.0]}}
STRONGER = {"loading": loading(80, -4, 2), "unloading": {"from_": [2.0, -4.0]}}

# Deck, and its promised agreement.
DECKS = {
    "cycle, sigma 0.17": (lennard_jones(0.17, **CYCLE), WITHIN),
    "cycle, sigma 0.87": (lennard_jones(0.87, **CYCLE, stability={}), WITHIN),
    "cycle, sigma 8.7": (lennard_jones(8.7, **STRONG), WITHIN),
    "cycle, sigma 8.7, closer": (lennard_jones(8.7, **STRONG, numerics=CLOSE), EXACT),
    "cycle, sigma 8.7, Newton": (
        lennard_jones(8.7, **STRONG, numerics={**CLOSE, "method": "newton"}), EXACT),
    "cycle, sigma 100": (lennard_jones(100.0, **STRONGER), WITHIN),
    "cycle, sigma 100, closer": (lennard_jones(100.0, **STRONGER, numerics=CLOSE), EXACT),
    "path, sigma 8.7": (lennard_jones(8.7, equilibrium_path={"h0_end": -4.0}), WITHIN),
    "path, sigma 1000": (lennard_jones(1000.0, equilibrium_path={"h0_end": -4.0}), WITHIN),
    "repulsion": (
        exponential(100, loading=loading(6, -20, 0.5), unloading={}, numerics=CLOSE), EXACT),
    "uniform grid": (lennard_jones(0.87, **CYCLE, numerics=FIXED), EXACT),
    "uniform grid, Newton": (
        lennard_jones(0.87, **CYCLE, numerics={**FIXED, "method": "newton"}), EXACT),
    "2600 nodes": (lennard_jones(0.2, loading=loading(3, 1, 1), numerics=THREADED), EXACT),
    "mixing": (lennard_jones(0.17, loading=loading(6, 0, 0.5),
                             numerics={"method": "mixing", "nodes": 100}), STOPPED),
}


class Difference(NamedTuple):
    """The largest difference of two runs of a deck, its limit and where it is; rows with other
    counts."""

    size: float
    limit: float
    place: str
    iterations: int
    rows: int


def kernels():
    """The kernels that this processor can run."""
    processor = pathlib.Path("/proc/cpuinfo")
    features = set(processor.read_text().split()) if processor.is_file() else set()
    return [name for name, needed in KERNELS.items() if needed <= features]


def input_decks():
    return {str(file.relative_to(ROOT)): file
            for file in sorted((ROOT / "inputs").rglob("*.nml"))
            if not any(word in file.stem for word in LEFT_OUT)}


def numbers_of(one):
    """The columns of all tables but that of costs, and the numbers of the summary, by name."""
    found = {f"{path.name}: {name}": column
             for path in sorted(one.folder.glob("*.csv")) if path.name != "costs.csv"
             for name, column in one.table(path.name).columns.items()}
    for key, value in one.summary.items():
        if not isinstance(several(value)[0], str):
            found[key] = np.array(several(value), float)
    return found


def apart(name, mine, theirs):
    """The difference of a column or entry, over its largest number; infinite if one is not a
    number. Differences of deformations are relative to the separations, since deformations are
    their small differences."""
    a, b = mine[name], theirs[name]
    if a.dtype.kind == "U":
        return 0.0 if np.array_equal(a, b) else np.inf
    finite = np.isfinite(a)
    if a.shape != b.shape or not np.array_equal(a[~finite], b[~finite], equal_nan=True):
        return np.inf
    of = abs(mine.get(name.replace(": deformation", ": separation"), a)[finite])
    return float(abs(b - a)[finite].max(initial=0.0) / max(of.max(initial=0.0), TINY))


def limit_for(name, one, limit):
    """The limit of a column or entry. On fixed grids the place of an extremum is found by a
    search in loads, and is known to the square root of their error."""
    if name.endswith("max_tension_h0") and one.summary.get("grid", "edge_locked") != "edge_locked":
        return limit**0.5
    traced = name.startswith("curve.csv") and "path" in one.curve["branch"]
    return max(limit, PLACED) if traced else limit


def difference(one, other, limit):
    """The difference of `other` from `one` at the place where it is largest relative to its
    limit; None if they do not have the same rows or entries."""
    mine, theirs = numbers_of(one), numbers_of(other)
    if mine.keys() != theirs.keys():
        return None
    sizes = {name: apart(name, mine, theirs) for name in mine if not name.endswith(ROUNDED)}
    place = max(sizes, key=lambda name: sizes[name] / limit_for(name, one, limit))
    if max(sizes.values()) == np.inf:
        return None
    counts = [name for name in mine if name.endswith("iterations")]
    changed = sum(int((mine[name] != theirs[name]).sum()) for name in counts)
    return Difference(sizes[place], limit_for(place, one, limit), place, changed,
                      sum(len(mine[name]) for name in counts))


def limit_of(one):
    """The largest permitted difference of a deck of inputs/."""
    file = one.folder / "fit.nml"
    if file.is_file():
        fit = f90nml.read(file)["fit"]
        # One parameter has numbers, several have lists.
        return FITTED * np.abs(np.divide(fit["standard_error"], fit["estimate"])).max()
    left = [value for name, value in numbers_of(one).items() if name.endswith("worst_residual")]
    return max([EXACT, *(OF_RESIDUAL * float(np.nanmax(value)) for value in left)])


def same_bytes(one, other):
    """Whether two runs of a deck have left the same tables."""
    return all(path.read_bytes() == (other.folder / path.name).read_bytes()
               for path in one.folder.glob("*.csv"))


class Comparison:
    """The table of differences, and the violated promises."""

    def __init__(self, reference, folder):
        self.reference, self.folder = reference, folder
        self.broken, self.worst = [], {}
        self.runs = 0
        print("| variant | deck | largest difference | limit | of | other counts |")
        print("|---|---|---|---|---|---|")

    def run(self, program, name, deck, threads=1, kernel=None):
        """Runs a deck, which is a text or a file, in a folder of its own; returns the results."""
        self.runs += 1
        folder = self.folder / str(self.runs)
        folder.mkdir()
        file = deck
        if isinstance(deck, str):
            file = folder / "deck.nml"
            file.write_text(deck)
        chosen = {"OPENBLAS_CORETYPE": kernel} if kernel else {}
        done = subprocess.run(
            [program, "--quiet", "--out", folder, file], env=threaded(threads, **chosen),
            capture_output=True, text=True, check=False)
        if done.returncode:
            sys.exit(f"{name}: status {done.returncode}\n{done.stderr}")
        return Run(done.returncode, done.stderr, folder / file.stem)

    def note(self, variant, deck_name, limit, one, other):
        found = difference(one, other, limit)
        if found is None:
            print(f"| {variant} | {deck_name} | other rows or entries | | | |", flush=True)
            self.broken.append(f"{deck_name}, {variant}: other rows or entries")
            return
        print(f"| {variant} | {deck_name} | {found.size:.0e} | {found.limit:.0e} | {found.place} "
              f"| {found.iterations} of {found.rows} |", flush=True)
        kind = variant, "of its own" if deck_name.startswith("inputs") else f"{limit:.0e}"
        self.worst[kind] = max(self.worst.get(kind, (0.0, "")), (found.size, deck_name))
        if not found.size <= found.limit:
            self.broken.append(f"{deck_name}, {variant}: {found.place} differs by {found.size:.1e}")

    def builds(self, programs, name, deck, limit=None):
        """Runs a deck on every other program; returns the run of the reference."""
        one = self.run(self.reference, name, deck)
        for build, program in programs.items():
            self.note(build, name, limit or limit_of(one), one, self.run(program, name, deck))
        return one

    def threads(self, name, deck, limit, one):
        """Runs a deck on several threads, twice."""
        for threads in THREADS:
            variant = f"threads: {threads}"
            other = self.run(self.reference, name, deck, threads)
            self.note(variant, name, limit, one, other)
            if one.cost["nodes"] < SHARED and not same_bytes(one, other):
                self.broken.append(f"{name}, {variant}: other bytes than on one thread")
            if not same_bytes(other, self.run(self.reference, name, deck, threads)):
                self.broken.append(f"{name}, {variant}: the same run twice gives other bytes")

    def kernels(self, name, deck, limit, one):
        """Runs a deck with OpenBLAS's kernels for other processors."""
        for kernel in kernels():
            self.note(f"kernel: {kernel}", name, limit, one,
                      self.run(self.reference, name, deck, kernel=kernel))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--builds", action="store_true", help="no threads and no kernels")
    parser.add_argument("reference")
    parser.add_argument("programs", nargs="*", metavar="NAME=PROGRAM")
    arguments = parser.parse_args()
    pairs = (pair.split("=", 1) for pair in arguments.programs)
    programs = {name: os.path.abspath(path) for name, path in pairs}
    with tempfile.TemporaryDirectory() as folder:
        compared = Comparison(os.path.abspath(arguments.reference), pathlib.Path(folder))
        for name, (deck, limit) in DECKS.items():
            one = compared.builds(programs, name, deck, limit)
            if not arguments.builds:
                compared.threads(name, deck, limit, one)
                compared.kernels(name, deck, limit, one)
        if programs:
            for name, deck in input_decks().items():
                compared.builds(programs, name, deck)
    print()
    for (variant, limit), (size, name) in compared.worst.items():
        print(f"largest difference, {variant}, of decks with limit {limit}: {size:.1e} ({name})")
    for text in compared.broken:
        print(f"broken: {text}")
    return 1 if compared.broken else 0


if __name__ == "__main__":
    sys.exit(as_command(main)())
