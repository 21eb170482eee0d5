"""The unit of time, and the least time of a task.

G is one DGESV of 400 unknowns on one core, measured between the runs that are counted in G: both
vary with the load of the machine.
"""

import bisect
import csv
import math
import os
import pathlib
import subprocess
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Numbers of unknowns whose linear algebra is timed; between them times are powers of the number.
_SIZES = (16, 32, 64, 128, 256, 512)
_UNIT = 400
# Seconds after which G is measured again.
_STALE = 5.0
# Approximate number of bytes of a row of the curve and of the journal.
_ROW = (230, 900)


class Gauge:
    """Times of the linear algebra of this checkout, for all measured builds."""

    def __init__(self, environment):
        self.build, self.environment = ROOT / "build", environment
        self._unit, self._measured, self._pieces, self._row = None, -math.inf, None, None
        subprocess.run([str(ROOT / ".venv/bin/ninja"), "-C", str(self.build), "linear_limits"],
                       check=True, capture_output=True)

    def unit(self):
        """Return G [s], not older than some seconds."""
        if time.monotonic() - self._measured > _STALE:
            self._unit = self.pieces((_UNIT,), ("dgesv",))[0]["dgesv"]
            self._measured = time.monotonic()
        return self._unit

    def pieces(self, nodes, names=()):
        """Return a dict of seconds for each number of nodes, of all pieces or of the given ones."""
        output = subprocess.run(
            [str(self.build / "linear_limits"), *names, *map(str, nodes)],
            env=self.environment, check=True, capture_output=True, text=True).stdout
        return [{name: float(cell) for name, cell in row.items()}
                for row in csv.DictReader(output.splitlines())]

    def limit(self, run):
        """Return the seconds of a run's products, solutions, factorisations and rows alone.

        Each is timed separately on matrices of the run's mean size. Every product of a state except
        the last one is followed by a solution with factors.
        """
        if not run.products:
            return float("nan")
        if self._pieces is None:
            self._pieces = self.pieces(_SIZES, ("dgemv", "dgetrs", "dgesv"))
            self._row = _seconds_of_row()
        size = run.columns / run.products
        dgemv, dgetrs, dgesv = (self._at(size, name) for name in ("dgemv", "dgetrs", "dgesv"))
        return (run.products * dgemv + max(run.products - run.states, 0) * dgetrs
                + run.factorisations * (dgesv - dgetrs) + run.states * self._row)

    def _at(self, size, name):
        """Return the seconds of a piece at a size, by a power law between measured sizes; beyond
        them by that of the nearest two."""
        i = min(max(bisect.bisect(_SIZES, size) - 1, 0), len(_SIZES) - 2)
        low, high = (self._pieces[j][name] for j in (i, i + 1))
        # The sizes are powers of two.
        return low * (high / low) ** math.log2(max(size, 1) / _SIZES[i])


def _seconds_of_row():
    """Return the time for writing a row and its record."""
    blocks = [bytes(size) for size in _ROW]
    with open(os.devnull, "wb", buffering=0) as file:
        began = time.perf_counter()
        for _ in range(2000):
            for block in blocks:
                file.write(block)
        return (time.perf_counter() - began) / 2000
