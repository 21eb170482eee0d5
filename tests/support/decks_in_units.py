"""Lennard-Jones decks in units of z0 and gamma R, run by the program and read back in them."""

import os
import pathlib
import shutil
import subprocess
from typing import NamedTuple

import f90nml
from scenes import lennard_jones, read_table, several

# In a deck with R = z0 = E/(1-nu^2) = 1 a load in units of gamma R is to be multiplied by sigma.
LOADS = (
    "max_tension", "jump_in_load", "jump_out_load", "folds_load", "load_folds_load", "end_load",
    "unload_max_tension", "energy_lost",
)  # fmt: skip
LENGTHS = (
    "max_tension_h0", "jump_in_h0", "jump_out_h0", "folds_h0", "load_folds_h0", "end_h0",
    "end_displacement", "unload_max_tension_h0", "unload_jump_out_h0",
)  # fmt: skip


class Report(NamedTuple):
    """What a run reported. numbers: those of the summary; errors: how well it says it knows each,
    in the number's own unit where the summary has a key for it; estimate: the one for all."""

    status: int
    numbers: dict
    errors: dict
    estimate: float
    warnings: list
    stderr: str
    rows: object


def said(found):
    """The status of a run that failed, and why."""
    reasons = " | ".join([found.stderr.strip()[-120:], *found.warnings])
    return f"status {found.status}: {reasons[:200]}"


def program_path():
    """The executable that is judged: $SNAPIN, else build/snapin of this checkout."""
    root = pathlib.Path(__file__).resolve().parent.parent.parent
    return pathlib.Path(os.environ.get("SNAPIN", root / "build" / "snapin")).resolve()


def report(sigma, groups, folder, name="deck", *, rows=False, seconds=120, text=None):
    """Runs a deck of these groups (or the one given) in a folder and reads what it reports."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{name}.nml").write_text(text or lennard_jones(sigma, **groups))
    environment = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
    command = [str(program_path()), "--quiet", f"{name}.nml"]
    try:
        done = subprocess.run(
            command, cwd=folder, capture_output=True, text=True, errors="replace",
            timeout=seconds, check=False, env=environment,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return Report(-1, {}, {}, 0.0, [], f"more than {seconds} s", None)
    results = folder / "results" / name
    if not (results / "summary.nml").exists():
        return Report(done.returncode, {}, {}, 0.0, [], done.stderr, None)
    summary = f90nml.read(results / "summary.nml")["summary"]
    table = read_table(results / "curve.csv") if rows else None
    shutil.rmtree(results)
    numbers, errors = {}, {}
    for key in (*LOADS, *LENGTHS):
        unit = sigma if key in LOADS else 1.0
        names = [(numbers, key), (errors, f"{key}_uncertainty"), (errors, f"{key}_error")]
        for found, name_of in names:
            if name_of in summary:
                values = [value / unit for value in several(summary[name_of])]
                found[key] = values if isinstance(summary[name_of], list) else values[0]
    warnings = several(summary.get("warnings", []))
    estimate = summary.get("error_estimate", 0.0)
    return Report(done.returncode, numbers, errors, estimate, warnings, done.stderr, table)
