"""Compares the program with the independent reference of tests/support: studies with tables.

    .venv/bin/python tools/verify/judge.py [STUDY ...] [--count N] [--seed N]

    estimates   true error over estimated error of every number of the summary
    cycles      random cycles with any steps: jumps, tensions, ends, rows
    cusp        the same near the onset of jumps, sigma 0.28 to 0.45
    folds       states just before and just beyond the folds
    energy      the same as estimates at strengths with dissipation, and close to the cusp
    laws        true error over estimated error under every law; the reference is the program
                itself at a higher accuracy
    layers      the same for bodies with layers
    experiments the same for springs and fixed loads under every law
    shapes      the same for springs, fixed loads and cycles of every shape, layers among them
    starts      fits of strongly adhering bodies from starts that are up to ten times off
    fits        fits of curves with several kinds of noise and baseline
    untold      the same without the keys for the baseline: wrong without a warning
    separations fits of forces over the radius against separation, with and without a spring

The program is $SNAPIN, else build/snapin. Ends with status 1 if a study finds an error.
"""

import argparse
import functools
import os
import pathlib
import sys
import tempfile

# Before NumPy is imported: one thread in each process.
os.environ["OMP_NUM_THREADS"] = os.environ["OPENBLAS_NUM_THREADS"] = "1"
ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tests"))

from snapin.command import as_command  # noqa: E402
from support import study_bodies, study_cycles, study_estimates, study_fits  # noqa: E402
from support import study_folds, study_laws, study_separations  # noqa: E402
from support.comparison import is_bad  # noqa: E402
from support.decks_in_units import program_path  # noqa: E402
from support.spread import spread  # noqa: E402

# Near and above the cusp.
cusp_jobs = functools.partial(study_cycles.jobs, low=0.28, high=0.45)

# Module, jobs, number of them (decks for cycles, scenes for laws, else strengths), and the test for
# a bad finding.
STUDIES = {
    "estimates": (study_estimates, study_estimates.jobs, 40, is_bad),
    "cycles": (study_cycles, study_cycles.jobs, 1000, lambda finding: finding.wrong),
    "cusp": (study_cycles, cusp_jobs, 1000, lambda finding: finding.wrong),
    "folds": (study_folds, study_folds.jobs, 10, lambda finding: finding.wrong),
    "laws": (study_laws, study_laws.jobs, 1000, is_bad),
    "layers": (study_bodies, study_bodies.layers, 200, is_bad),
    "experiments": (study_bodies, study_bodies.experiments, 500, is_bad),
    "shapes": (study_bodies, study_bodies.shapes, 500, is_bad),
    "energy": (study_estimates, study_estimates.energy_jobs, 40, is_bad),
    "starts": (study_fits, study_fits.clean_jobs, 200, lambda finding: finding.wrong),
    "fits": (study_fits, study_fits.noisy_jobs, 150, lambda finding: finding.wrong),
    "untold": (study_fits, study_fits.untold_jobs, 150, lambda finding: finding.wrong),
    "separations": (study_separations, study_separations.separation_jobs, 120,
                    lambda finding: finding.wrong),
}
SEEDED = ("starts", "fits", "untold", "separations", "cycles", "cusp", "laws", "layers",
          "experiments", "shapes")


def study(name, arguments, folder):
    """Runs a study; returns its table, and the number of bad findings."""
    module, make, count, bad = STUDIES[name]
    seeded = {"seed": arguments.seed} if name in SEEDED else {}
    jobs = make(arguments.count or count, folder / name, **seeded)
    parts = spread(module.examine, jobs, workers=arguments.workers, name=name)
    findings = [finding for part in parts for finding in part]
    return module.table(findings), sum(bool(bad(finding)) for finding in findings)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("studies", nargs="*", default=list(STUDIES), metavar="STUDY")
    parser.add_argument("--count", type=int, help="decks, scenes or strengths")
    parser.add_argument("--seed", type=int, default=1, help="of the random decks")
    parser.add_argument("--workers", type=int, default=2)
    arguments = parser.parse_args()
    unknown = [name for name in arguments.studies if name not in STUDIES]
    if unknown:
        parser.error(f"no study called {unknown[0]}; there are: {', '.join(STUDIES)}")
    if not program_path().is_file():
        parser.error("no executable: build the program first, or set SNAPIN")
    total = 0
    with tempfile.TemporaryDirectory() as folder:
        for name in arguments.studies:
            table, bad = study(name, arguments, pathlib.Path(folder))
            print("\n".join([f"{name}: {bad} findings", *table, ""]), flush=True)
            total += bad
    return 1 if total else 0


if __name__ == "__main__":
    sys.exit(as_command(main)())
