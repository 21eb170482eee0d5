"""Run the program on a deck, and read the results."""

import dataclasses
import math
import os
import pathlib
import resource
import shutil
import subprocess
import sys

import truth
from gauge import Gauge
from snapin import read_results

ROOT = pathlib.Path(__file__).resolve().parents[2]

# The three numbers whose errors are drawn.
QUANTITIES = ("pull_off", "jump_in", "load")
# Messages of a run whose results can be measured. The paper's stopping rule never converges.
_TOLERATED = ("the iteration was stopped on a small change", "under-resolved")
# Small values of these are relative to the length of the force law.
_LENGTHS = ("jump_in", "jump_out", "displacement")


@dataclasses.dataclass
class Run:
    """One run: its results, its cost, and its failure.

    seconds: processor time, with start and files, so that other work on the machine does not count;
    wall: elapsed time, like the times of its parts, of which kernel, solutions and estimate are the
    calculation. unit: the seconds of G at that time (`gauge`); limit: the seconds of its linear
    algebra and rows alone.
    """

    unit: float = math.nan
    limit: float = math.nan
    seconds: float = math.nan
    wall: float = math.nan
    kernel_seconds: float = math.nan
    solve_seconds: float = math.nan
    estimate_seconds: float = math.nan
    calculation: float = math.nan
    nodes: int = 0
    states: int = 0
    products: int = 0
    columns: int = 0
    factorisations: int = 0
    estimate: float = math.nan
    failure: str = ""
    warning: str = ""
    values: dict = dataclasses.field(default_factory=dict)
    summary: dict = dataclasses.field(default_factory=dict)

    def cells(self, *names):
        """Return some of the numbers and texts by name, for a row of a table."""
        return {name: getattr(self, name) for name in names}

    @property
    def price(self):
        """Time in G."""
        return self.seconds / self.unit

    @property
    def price_of_run(self):
        """Time in G of the deck's request, without the error estimate."""
        return self.price * (1 - self.estimate_seconds / self.wall)

    @property
    def least_price(self):
        """The limit in G."""
        return self.limit / self.unit

    def errors(self, reference, length):
        """Return relative errors against a converged run, for a force law of some length."""
        errors = {}
        for key, exact in reference.values.items():
            scale = abs(exact)
            if key in _LENGTHS:
                scale = max(scale, length)
            elif key == "load":
                scale = max(scale, reference.values.get("pull_off", 0.0))
            errors[key] = abs(self.values.get(key, math.nan) - exact) / scale
        return errors


def independent(problem):
    """Return the numbers of a Lennard-Jones problem by the independent solution, as a `Run`."""
    found = truth.numbers(problem.sigma, problem.start, problem.turn, length=problem.length,
                          load=problem.load)
    names = {"pull_off": "max_tension", "jump_in": "jump_in_h0", "jump_in_load": "jump_in_load",
             "jump_out": "jump_out_h0", "jump_out_load": "jump_out_load", "load": "end_load",
             "displacement": "end_displacement"}
    return Run(estimate=0.0, values={name: found[key] for name, key in names.items()
                                     if key in found})


class Program:
    """The program of one build, run in its own folder."""

    def __init__(self, build, scratch):
        self.build = pathlib.Path(build)
        self.scratch = pathlib.Path(scratch)
        self.scratch.mkdir(parents=True, exist_ok=True)
        # A copy, so that all measurements use one program even if it is rebuilt meanwhile.
        self.snapin = pathlib.Path(shutil.copy2(self.build / "snapin", self.scratch))
        self._references = {}
        self.gauge = Gauge(self.environment())

    def environment(self, threads=1):
        return dict(os.environ, OMP_NUM_THREADS=str(threads), OPENBLAS_NUM_THREADS=str(threads))

    def run(self, deck, cap=60, threads=1, before=()):
        """Run a deck, given as text, for at most `cap` seconds; `before` precedes the command."""
        path = self.scratch / "deck.nml"
        path.write_text(deck, encoding="utf-8")
        command = [*before, str(self.snapin), "--quiet", "--out", str(self.scratch), str(path)]
        began = _processor_seconds()
        try:
            done = subprocess.run(command, env=self.environment(threads), capture_output=True,
                                  text=True, timeout=cap, check=False)
        except subprocess.TimeoutExpired:
            return Run(seconds=cap, wall=cap, failure=f"not finished in {cap:g} s")
        if done.returncode not in (0, 1):
            return Run(failure=(done.stderr.strip().splitlines() or ["no message"])[0])
        run = self._read(done.returncode)
        run.seconds = _processor_seconds() - began
        return run

    def best_of(self, rounds, decks, cap=60, enough=3.0, **options):
        """Run every deck of a dict in turn, `rounds` times over; keep each one's fastest run.

        A deck that takes longer than `enough` seconds, or fails, is run once. G is the least of the
        values measured between the runs.
        """
        best, unit, calculation = {}, math.inf, {}
        for _ in range(rounds):
            for key, deck in decks.items():
                unit = min(unit, self.gauge.unit())
                if key in best and not best[key].seconds < enough:
                    continue
                run = self.run(deck, cap, **options)
                parts = run.kernel_seconds + run.solve_seconds + run.estimate_seconds
                calculation[key] = min(calculation.get(key, math.inf), parts)
                if key not in best or run.seconds < best[key].seconds:
                    best[key] = run
        for key, run in best.items():
            run.unit, run.limit = unit, self.gauge.limit(run)
            run.calculation = calculation[key]
        return best

    def costs(self, deck):
        """Return the columns of costs.csv of a deck whose sweep has costs."""
        self.run(deck)
        found = read_results(self.scratch / "deck").costs
        return {name: found[name] for name in found.dtype.names}

    def start_up(self, rounds=10):
        """Return the price of a program that starts and prints its version."""
        least = math.inf
        for _ in range(rounds):
            began = _processor_seconds()
            subprocess.run([str(self.snapin), "--version"], env=self.environment(), check=True,
                           capture_output=True)
            least = min(least, _processor_seconds() - began)
        return least / self.gauge.unit()

    def from_python(self, deck, rounds=20):
        """Return the elapsed time in G of `snapin.run(deck)` in a running interpreter."""
        script = ("import sys, time, snapin\ndeck, least = sys.stdin.read(), float('inf')\n"
                  f"for _ in range({rounds}):\n"
                  "    began = time.perf_counter()\n"
                  "    snapin.run(deck)\n"
                  "    least = min(least, time.perf_counter() - began)\n"
                  "print(least)\n")
        paths = [str(ROOT / "pywrap"), str(self.build / "pywrap")]
        done = subprocess.run(
            [sys.executable, "-c", script], input=deck, capture_output=True, text=True, check=True,
            env={**self.environment(), "PYTHONPATH": os.pathsep.join(paths)})
        return float(done.stdout) / self.gauge.unit()

    def reference(self, problem):
        """Return the true numbers: those of the independent solution for a Lennard-Jones problem,
        otherwise a converged run, the path with the highest accuracy of the program."""
        key = problem.name
        if problem.sigma is not None:
            return independent(problem)
        if key not in self._references:
            self._references[key] = self.run(problem.path(
                "accuracy = 1e-10, residual_tolerance = 1e-12"))
            # A residual at its floor is the least that rounding allows; the numbers are valid.
            self._references[key].failure = ""
        return self._references[key]

    def _read(self, returncode):
        found = read_results(self.scratch / "deck")
        summary, cost = found.summary, found.cost
        warnings = summary.get("warnings", [])
        run = Run(
            wall=cost["wall_seconds"], kernel_seconds=cost["kernel_seconds"],
            solve_seconds=cost["solve_seconds"],
            estimate_seconds=cost.get("estimate_seconds", 0.0), nodes=cost.get("nodes", 0),
            states=cost["states"], products=cost["operator_products"],
            columns=cost["operator_columns"], factorisations=cost["factorisations"],
            estimate=float(summary.get("error_estimate", math.nan)),
            warning="; ".join(warnings), summary=summary)
        if returncode:
            run.failure = "; ".join(text for text in warnings if not text.startswith(_TOLERATED))
        if "max_tension" in summary and "jkr_pull_off" in summary:
            run.values["pull_off"] = summary["max_tension"]
        for key in ("jump_in", "jump_out"):
            if f"{key}_h0" in summary:
                run.values[key] = summary[f"{key}_h0"]
                run.values[f"{key}_load"] = summary[f"{key}_load"]
        # A sweep has no curve. Loading and path both end at the turning point.
        if "curve" in found.tables:
            end = found.curve[found.curve["branch"] == found.curve["branch"][0]][-1]
            run.values |= {key: float(end[key]) for key in ("load", "displacement")}
        return run


def _processor_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
