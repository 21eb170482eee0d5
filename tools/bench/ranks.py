#!/usr/bin/env python3
"""Measures sweeps on threads and on processes, and renews the tables of docs/records/clusters.md.

    tools/bench/ranks.py [--build build-openmpi] [--mpirun "mpirun.openmpi --oversubscribe"]

Needs a build with MPI (`tools/verify/verify.sh mpi` makes two) and about ten minutes; computations
are run several times, and the shortest time counts.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import f90nml

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "tools"))

import pages  # noqa: E402 (found through the line above)

PAGE = ROOT / "docs/records/clusters.md"
DECK = """&bodies radius = 1e-6, stiffness = 1e10 /
&force law = 'lennard_jones', hamaker = 1e-19, z0 = 3e-10 /
&equilibrium_path h0_end = -1e-9 /
&sweep key = 'bodies.stiffness', 'force.hamaker', from = 1e8, 1e-20, to = 1e11, 1e-19,
       count = 40, 30, scale = 'log' /
"""
CASES = 1200
ROUNDS = 5
# Milliseconds of a case, and numbers of processes that sleep.
DURATIONS = 1, 10, 1000
SLEEPERS = 1, 4, 16, 64
# Seconds of a measurement with sleepers, and numbers of processes of the plan.
SPAN = 6
PLANNED = 1, 4, 16, 64, 256, 1024, 4096
# Seconds of work in a message, as in src/app/dispatch.f90.
BATCH = 0.05


class Bench:
    """The programs of a build, started by mpirun in a scratch folder."""

    def __init__(self, build, mpirun, scratch):
        self.build, self.mpirun, self.scratch = build.resolve(), mpirun.split(), Path(scratch)
        (self.scratch / "map.nml").write_text(DECK)
        for target in ("snapin", "dispatcher"):
            subprocess.run(["ninja", "-C", self.build, target], check=True, capture_output=True)

    def run(self, workers, command, threads=1):
        """Run on `workers` workers, 0: without mpirun; return standard output and seconds."""
        start = [*self.mpirun, "-n", str(workers + 1)] if workers else []
        env = dict(os.environ, OMP_NUM_THREADS=str(threads), OMPI_ALLOW_RUN_AS_ROOT="1",
                   OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
        began = time.monotonic()
        done = subprocess.run([*start, *map(str, command)], cwd=self.scratch, env=env, check=True,
                              capture_output=True, text=True)
        return done.stdout, time.monotonic() - began

    def sweep(self, workers, threads):
        """Seconds of the program's sweep from its own summary, and processor seconds."""
        before = sum(os.times()[2:4])
        self.run(workers, [self.build / "snapin", "--quiet", "map.nml"], threads)
        cost = f90nml.read(self.scratch / "results/map/summary.nml")["cost"]
        return cost["wall_seconds"], sum(os.times()[2:4]) - before

    def dispatch(self, workers, cases, milliseconds, *folder):
        """(cases, seconds, messages) of the dispatcher."""
        said, _ = self.run(workers, [self.build / "dispatcher", cases, milliseconds, *folder])
        _, cases, _, seconds, messages = said.split()
        return int(cases), float(seconds), int(messages)


def computed(bench):
    """Real cases: threads of one process, then processes of one thread."""
    ways = {"1 thread": (0, 1), "2 threads": (0, 2), "1 + 1 processes": (1, 1),
            "1 + 2 processes": (2, 1)}
    took = {name: [] for name in ways}
    for _ in range(ROUNDS):
        for name, way in ways.items():
            took[name].append(bench.sweep(*way))
    least = {name: [min(column) for column in zip(*times)] for name, times in took.items()}
    return [(name, f"{seconds:.2f}", f"{CASES / seconds:.0f}",
             f"{least['1 thread'][0] / seconds:.2f}", f"{of_processors:.2f}")
            for name, (seconds, of_processors) in least.items()]


def limits(bench):
    """Empty cases of one dispatcher: (kind, cases, seconds, messages) of each kind."""
    ways = (("no rows, long batches", 2, 10**6, 0),
            ("no rows, one case a message", 8, 10**5, -1000),
            ("rows and journal, long batches", 2, 10**6, 0, "rows"))
    return {what: min((bench.dispatch(*way) for _ in range(3)), key=lambda found: found[1])
            for what, *way in ways}


def slept(bench):
    """Efficiency of processes that sleep, with rows and journal: {(ms, workers): share}."""
    found = {}
    for milliseconds in DURATIONS:
        for workers in SLEEPERS:
            wanted = workers * max(2, round(1000 * SPAN / milliseconds))
            cases, seconds, _ = bench.dispatch(workers, min(wanted, 10**6), milliseconds, "slept")
            found[milliseconds, workers] = cases * milliseconds / 1000 / (seconds * workers)
    return found


def planned(rows_a_second, messages_a_second):
    """[(ms, workers at which one dispatcher has no more time, {workers: efficiency})]: work is lost
    where there are more, and the core of the dispatcher always."""
    plan = []
    for milliseconds in DURATIONS:
        case = milliseconds / 1000
        a_message = max(1, BATCH / case)
        most = a_message * case / (a_message / rows_a_second + 1 / messages_a_second)
        plan.append((milliseconds, most, {
            workers: min(1, most / workers) * workers / (workers + 1) for workers in PLANNED}))
    return plan


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=Path, default=ROOT / "build-openmpi")
    parser.add_argument("--mpirun", default="mpirun.openmpi --oversubscribe --bind-to none")
    parser.add_argument("--only", nargs="+", choices=("computed", "dispatcher", "slept"),
                        default=("computed", "dispatcher", "slept"))
    options = parser.parse_args()
    if not (options.build / "build.ninja").exists():
        sys.exit(f"no build in {options.build}: tools/verify/verify.sh mpi")
    with tempfile.TemporaryDirectory() as scratch:
        bench = Bench(options.build, options.mpirun, scratch)
        if "computed" in options.only:
            renew("computed", ("", "seconds", "cases a second", "over one thread",
                               "seconds of processors"), computed(bench))
        if "dispatcher" in options.only:
            show_limits(limits(bench))
        if "slept" in options.only:
            shares = slept(bench)
            renew("slept", ("a case takes", *(f"{n} processes" for n in SLEEPERS)),
                  [(f"{ms} ms", *(f"{100 * shares[ms, n]:.1f} %" for n in SLEEPERS))
                   for ms in DURATIONS])


def renew(name, columns, rows):
    pages.insert(PAGE, name, pages.table(columns, rows), "tools/bench/ranks.py")


def show_limits(found):
    """Write the dispatcher's limits and the plan that follows from them."""
    renew("dispatcher", ("", "cases", "seconds", "messages a second", "rows a second"),
          [(what, f"{cases:,}", f"{seconds:.2f}",
            f"{messages / seconds:,.0f}" if messages else "", f"{cases / seconds:,.0f}")
           for what, (cases, seconds, messages) in found.items()])
    _, messages_took, messages = found["no rows, one case a message"]
    cases, rows_took, _ = found["rows and journal, long batches"]
    renew("planned", ("a case takes", "saturated at", *(f"{n:,}" for n in PLANNED)),
          [(f"{ms} ms", f"{most:,.0f} processes",
            *(f"{100 * share:.0f} %" for share in row.values()))
           for ms, most, row in planned(cases / rows_took, messages / messages_took)])


if __name__ == "__main__":
    main()
