"""Lennard-Jones decks in units of z0 and gamma R, run by the program and read back in them."""

import math
import os
import pathlib
import resource
import shutil
import signal
import subprocess
from typing import NamedTuple

from support.processes import HANG, threaded
from support.scenes import deck, read_groups, read_table, several

LOADS = (
    "max_tension", "jump_in_load", "jump_out_load", "folds_load", "load_folds_load", "end_load",
    "unload_max_tension",
)  # fmt: skip
LENGTHS = (
    "max_tension_h0", "jump_in_h0", "jump_out_h0", "folds_h0", "load_folds_h0", "end_h0",
    "end_displacement", "unload_max_tension_h0", "unload_jump_out_h0",
)  # fmt: skip
# Groups whose keys are all lengths.
RANGES = ("loading", "unloading", "equilibrium_path", "profiles")


class Units(NamedTuple):
    """Radius [m], E/(1-nu^2) [Pa] and z0 [m] of a deck."""

    radius: float
    stiffness: float
    z0: float

    def load(self, sigma):
        """gamma R [N]."""
        return sigma * self.stiffness * math.sqrt(self.radius * self.z0**3)

    def deck(self, sigma, groups):
        """The deck whose groups are given in units of z0."""
        gamma = self.load(sigma) / self.radius
        hamaker = 16 * math.pi * gamma * self.z0**2
        force = {"law": "lennard_jones", "hamaker": hamaker, "z0": self.z0}
        bodies = {"radius": self.radius, "stiffness": self.stiffness}
        scaled = dict(groups)
        for name in RANGES:
            if name in groups:
                scaled[name] = {key: self.metres(value) for key, value in groups[name].items()}
        return deck(bodies=bodies, force=force, **scaled)

    def metres(self, value):
        """One or several lengths in metres."""
        return [x * self.z0 for x in value] if isinstance(value, list) else value * self.z0


# Units in which h0 is in z0 and loads are in sigma; and crossed cylinders in air.
PLAIN = Units(1.0, 1.0, 1.0)
REAL = Units(1.5e-2, 1.0e10, 0.5e-9)


class Report(NamedTuple):
    """The results of a run. numbers: those of the summary; errors: estimates for each number,
    in the number's own unit where the summary has a key for it; estimate: the one for all."""

    status: int
    numbers: dict
    errors: dict
    estimate: float
    warnings: list
    stderr: str
    rows: object


def said(found):
    """The status of a run that failed, and the reason."""
    reasons = " | ".join([found.stderr.strip()[-120:], *found.warnings])
    return f"status {found.status}: {reasons[:200]}"


def program_path():
    """The executable that is judged: $SNAPIN, else build/snapin of this checkout."""
    root = pathlib.Path(__file__).resolve().parent.parent.parent
    return pathlib.Path(os.environ.get("SNAPIN", root / "build" / "snapin")).resolve()


def run_deck(folder, name, text, seconds):
    """Runs a deck in a folder on one thread: its status, its standard error, and the folder of its
    results; status None if it takes more seconds of the processor, whatever the load of the
    machine."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{name}.nml").write_text(text)
    limits = (resource.RLIMIT_CPU, (math.ceil(seconds), math.ceil(seconds) + 5))
    try:
        done = subprocess.run(
            [str(program_path()), f"{name}.nml"], cwd=folder, capture_output=True, text=True,
            errors="replace", timeout=HANG, check=False, env=threaded(),
            preexec_fn=lambda: resource.setrlimit(*limits))
    except subprocess.TimeoutExpired:
        return None, "hangs", None
    if done.returncode == -signal.SIGXCPU:
        return None, f"more than {seconds} s", None
    return done.returncode, done.stderr, folder / "results" / name


def report(sigma, groups, folder, name="deck", *, rows=False, seconds=120, units=PLAIN):
    """Runs a deck of these groups in a folder and reads its results, in z0 and gamma R."""
    status, stderr, results = run_deck(folder, name, units.deck(sigma, groups), seconds)
    if status is None or not (results / "summary.nml").exists():
        return Report(-1 if status is None else status, {}, {}, 0.0, [], stderr, None)
    summary = read_groups(results / "summary.nml")["summary"]
    table = read_table(results / "curve.csv") if rows else None
    if rows:
        table.columns["h0"] /= units.z0
        table.columns["load"] /= units.load(sigma)
    shutil.rmtree(results)
    numbers, errors = {}, {}
    for key in (*LOADS, *LENGTHS, "energy_lost"):
        unit = units.load(sigma) if key in LOADS else units.z0
        unit = units.load(sigma) * units.z0 if key == "energy_lost" else unit
        names = [(numbers, key), (errors, f"{key}_uncertainty"), (errors, f"{key}_error")]
        for found, name_of in names:
            if name_of in summary:
                values = [value / unit for value in several(summary[name_of])]
                found[key] = values if isinstance(summary[name_of], list) else values[0]
    warnings = several(summary.get("warnings", []))
    estimate = summary.get("error_estimate", 0.0)
    return Report(status, numbers, errors, estimate, warnings, stderr, table)
