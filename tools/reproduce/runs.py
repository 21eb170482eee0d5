"""Runs decks and returns their results; a deck that has not changed is not run again."""

import concurrent.futures
import hashlib
import json
import os
import pathlib
import subprocess
import threading
import time

import draws
import f90nml
import numpy as np
from pages import ROOT
from snapin.results import Result, read_results

INPUTS = ROOT / "inputs"
# After this number of seconds without a message, the running decks are named.
_HEARTBEAT = 10.0


class RunError(Exception):
    """A deck could not be run, or left no results; the message gives the reason."""


class Results(Result):
    """The results of a run: its tables are structured arrays, and have branches."""

    def __init__(self, folder):
        found = read_results(folder)
        super().__init__(found.tables, found.summary, found.cost)

    def last(self, key):
        """Return a number of the summary; for an array, the value of the last turning point."""
        return float(np.ravel(self.summary[key])[-1])

    def branch(self, name, table="curve"):
        """Return the rows of one branch, or of one theory."""
        rows = getattr(self, table)
        return rows[rows["branch" if "branch" in rows.dtype.names else "theory"] == name]


def path_name(deck):
    """Return the stem of a deck given by its stem or its path."""
    return pathlib.Path(deck).name.removesuffix(".nml")


class Runs:
    """The runs of many decks, each in `root`/<stem of the deck>/.

    Beside the folder is <stem>.json: a digest of deck and program, the exit status, and the time.
    It is written last and removed first, so that an interrupted run is continued.
    """

    def __init__(self, root, program=None, count=None, change=None):
        """`count` is the number of runs of decks with the paper's rule, draws.COUNT by default;
        `change(groups)` changes every deck first, for example to make it quicker."""
        self._count, self._change = count, change
        self.root = pathlib.Path(root)
        self.program = pathlib.Path(program or os.environ.get("SNAPIN", ROOT / "build" / "snapin"))
        self._results, self._written, self._writing = {}, {}, threading.Lock()
        self._program_digest = None

    def run(self, deck):
        """Run a deck, given by its stem or path, unless its results are valid; return the
        results."""
        path = self.path_of(deck)
        if path.stem not in self._results:
            if not self.is_done(path):
                self.execute(path)
            self._results[path.stem] = Results(self.root / path.stem)
        return self._results[path.stem]

    __getitem__ = run

    def draws(self, stem):
        """Return the results of a deck with the paper's rule, one for each of its runs."""
        return [self.run(name) for name in draws.names(stem, self._count)]

    def with_draws(self, decks):
        """Return the names of all runs of decks."""
        return [name for deck in dict.fromkeys(decks) for name in draws.names(deck, self._count)]

    def path_of(self, deck):
        """Return the path of a deck given by its stem, the name of a run or its path."""
        path = pathlib.Path(deck)
        if path.suffix == ".nml":
            return path
        stem, number = draws.parts(str(deck))
        path = INPUTS / f"{stem}.nml"
        if not path.is_file() or number == 0 and self._change is None:
            return path
        return self._changed_deck(path, str(deck), number)

    def _changed_deck(self, path, name, number):
        with self._writing:
            if name not in self._written:
                groups = draws.changed(f90nml.read(path), number)
                if self._change is not None:
                    self._change(groups)
                self._written[name] = self.root / "decks" / f"{name}.nml"
                self._written[name].parent.mkdir(parents=True, exist_ok=True)
                groups.write(self._written[name], force=True)
        return self._written[name]

    def digest(self, path):
        if self._program_digest is None:
            self._program_digest = hashlib.sha256(self.program.read_bytes()).hexdigest()
        deck = hashlib.sha256(self.path_of(path).read_bytes()).hexdigest()
        return f"deck {deck} program {self._program_digest}"

    def record(self, deck):
        """Return the record of the deck's last complete run, an empty dict if there is none."""
        try:
            return json.loads(self._record_path(self.path_of(deck)).read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return {}

    def is_done(self, deck):
        """Whether this deck has a complete and successful run with this program."""
        record = self.record(deck)
        return (record.get("digest") == self.digest(deck) and record.get("problem") is None
                and (self.root / self.path_of(deck).stem / "summary.nml").is_file())

    def execute(self, deck):
        """Run a deck now; raise RunError unless it leaves the results it should.

        Decks that stop by the paper's rule end with exit status 1; they only have to report where
        they stopped.
        """
        path = self.path_of(deck)
        if not path.is_file():
            raise RunError(f"no deck {path}")
        self.root.mkdir(parents=True, exist_ok=True)
        self._record_path(path).unlink(missing_ok=True)
        # The results of an earlier run must not be taken for those of this run.
        (self.root / path.stem / "summary.nml").unlink(missing_ok=True)
        self._results.pop(path.stem, None)
        digest, began = self.digest(path), time.perf_counter()
        interrupted = (self.root / path.stem / "unfinished/journal").is_file()
        done = self._call(path, *(["--resume"] if interrupted else []))
        if interrupted and not (self.root / path.stem / "summary.nml").is_file():
            # The remaining files belong to another deck or program.
            done = self._call(path)
        seconds = time.perf_counter() - began
        problem = self._problem_of(path, done)
        self._record_path(path).write_text(json.dumps(
            {"digest": digest, "status": done.returncode, "problem": problem,
             "seconds": round(seconds, 2), "messages": done.stderr}, indent=1) + "\n",
            encoding="utf-8")
        if problem is not None:
            raise RunError(problem)

    def _call(self, path, *options):
        return subprocess.run(
            [str(self.program), "--quiet", *options, "--out", str(self.root), str(path)],
            env={**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
            stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace",
            check=False)

    def run_all(self, decks, jobs, say):
        """Run decks, `jobs` at a time, also after a failure; return {stem: problem}.

        `say(text)` is called for each deck that ends.
        """
        decks = list(dict.fromkeys(decks))
        waiting = [deck for deck in decks
                   if not (self.path_of(deck).is_file() and self.is_done(deck))]
        if len(waiting) < len(decks):
            say(f"{len(decks) - len(waiting)} of {len(decks)} runs are there already")
        # Long decks first, so that none runs alone at the end.
        waiting.sort(key=lambda deck: -self._likely_seconds(deck))
        problems, ended, began = {}, 0, time.perf_counter()
        pool = concurrent.futures.ThreadPoolExecutor(max(jobs, 1))
        futures = {pool.submit(self.execute, deck): deck for deck in waiting}
        try:
            while futures:
                done, _ = concurrent.futures.wait(
                    futures, _HEARTBEAT, concurrent.futures.FIRST_COMPLETED)
                if not done:
                    running = [path_name(deck) for future, deck in futures.items()
                               if future.running()]
                    say(f"{ended} of {len(waiting)} runs done after "
                        f"{time.perf_counter() - began:.0f} s; running: {', '.join(running)}")
                for future in done:
                    deck, ended = futures.pop(future), ended + 1
                    word = self._outcome(future, deck, problems)
                    say(f"run {ended} of {len(waiting)}: {path_name(deck)}: {word}")
        finally:
            pool.shutdown(cancel_futures=True)
        return problems

    def _outcome(self, future, deck, problems):
        try:
            future.result()
        except (RunError, OSError) as problem:
            problems[path_name(deck)] = str(problem)
            return f"FAILED: {problem}"
        return f"{self.record(deck)['seconds']:.1f} s"

    def _likely_seconds(self, deck):
        known = self.record(deck).get("seconds")
        if known is not None or not self.path_of(deck).is_file():
            return known or 0.0
        # The paper's iteration is slow; solving the equations on its grids is slower still.
        text = self.path_of(deck).read_text(encoding="utf-8")
        if "&sweep" in text and "'uniform'" in text:
            return 2e3
        return 1e3 if "'mixing'" in text else 1.0

    def _record_path(self, path):
        return self.root / f"{path.stem}.json"

    def _problem_of(self, path, done):
        by_rule = "_paper" in path.stem and (self.root / path.stem / "summary.nml").is_file()
        if done.returncode == 0 or done.returncode == 1 and by_rule:
            return None
        # The first line is the error; the line of the deck may follow.
        messages = [line for line in done.stderr.splitlines() if line and ": warning: " not in line]
        message = messages[0] if messages else "no message"
        return f"snapin ended with status {done.returncode}: {message}"
