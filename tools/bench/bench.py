#!/usr/bin/env python3
"""Measure what accuracy costs: pictures in docs/bench/, tables in docs/accuracy.md and in
docs/records/costs.md.

    ./bench                          everything, five minutes
    ./bench --quick                  everything, coarser, in two minutes, into results/bench/
    ./bench --only work_precision    one part
    ./bench --resume                 the rest of an interrupted run
    ./bench --draw                   pictures and tables again, from the present measurements

Times are in G, one DGESV of 400 unknowns on one core in the same run. Beside them is the time of
the same linear algebra and rows alone. Measurements of earlier sources are kept as NAME_before.csv,
for the comparison in the table of costs.
"""

import argparse
import datetime
import hashlib
import pathlib
import subprocess
import sys
import tempfile
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))

import digits  # noqa: E402
import hard_cases  # noqa: E402
import hot_spots  # noqa: E402
import laws  # noqa: E402
import pages  # noqa: E402 (found through the line above)
import program  # noqa: E402
import ratios  # noqa: E402
import scaling  # noqa: E402
import tables  # noqa: E402
import work_precision  # noqa: E402
from pages import ROOT  # noqa: E402
from snapin.command import as_command  # noqa: E402

# Each has marks for some of the tables.
_GUIDES = (ROOT / "docs" / "accuracy.md", ROOT / "docs" / "records" / "costs.md")

# Functions that measure, that draw, and that make the guide's tables.
_PARTS = {
    "accuracy": (digits.measure, digits.draw, digits.tables),
    "hard_cases": (hard_cases.measure, hard_cases.draw, hard_cases.tables),
    "laws": (laws.measure, laws.draw, laws.tables),
    "experiments": (laws.measure_experiments, None, laws.tables_experiments),
    "error_law": (digits.measure_law, digits.draw_law, digits.tables_law),
    "ratios": (ratios.measure, None, ratios.tables),
    "sigma": (scaling.measure_sigma, scaling.draw_sigma, None),
    "nodes": (scaling.measure_nodes, scaling.draw_nodes, None),
    "threads": (scaling.measure_threads, scaling.draw_threads, scaling.tables_threads),
    "hot_spots": (hot_spots.measure, None, hot_spots.tables),
    "work_precision": (work_precision.measure, work_precision.draw, work_precision.tables),
}

# Parts whose tables compare with earlier sources.
_COMPARED = ("accuracy", "laws", "experiments", "ratios")


def main():
    options, folder = _options()
    build = options.build.resolve()
    with tempfile.TemporaryDirectory() as scratch:
        runner = program.Program(build, scratch)
        for name in () if options.draw else options.only or _PARTS:
            path = folder / f"{name}.csv"
            fresh = path.is_file() and path.stat().st_mtime > runner.snapin.stat().st_mtime
            if not (options.resume and fresh):
                _measure(name, path, runner, _digest(build.parent / "src"),
                         options.quick)
    in_guide = not options.quick and options.out is None
    _present(folder, in_guide)


def _measure(name, path, runner, sources, quick):
    """Measure a part and write its table; that of earlier sources is kept for comparison."""
    began = time.perf_counter()
    _say(name)
    rows = _PARTS[name][0](runner, quick, lambda text: _say(f"  {text}"))
    if name in _COMPARED and path.is_file() and not _sources(path).endswith(sources):
        path.replace(_before(path))
    version = subprocess.run([str(runner.snapin), "--version"], check=True, capture_output=True,
                             text=True).stdout.split("\n")[0]
    tables.write(path, rows, [f"./bench --only {name}{' --quick' if quick else ''}", version,
                              f"{datetime.date.today()}, sources {sources}", tables.machine()])
    _say(f"  {time.perf_counter() - began:.0f} s; {path}")


def _present(folder, in_guide):
    """Draw the available measurements; with `in_guide`, renew the tables of the guides."""
    found, measured = {}, {}
    for name, (_, draw, make_tables) in _PARTS.items():
        path = folder / f"{name}.csv"
        rows = tables.read(path)
        if rows:
            measured.setdefault((_sources(path), tables.notes(path)[-1]), []).append(name)
        if rows and draw:
            draw(rows, folder)
        if rows and make_tables:
            found |= make_tables(rows, tables.read(_before(path)))
    if (folder / "accuracy.csv").is_file():
        found |= digits.honesty(folder)
    if in_guide:
        _insert("version", [
            f"Measured on {sources} ({machine}): {', '.join(names)}."
            for (sources, machine), names in measured.items()])
    for name, (header, lines) in found.items():
        table = pages.table(header, lines, tables.short)
        if in_guide:
            _insert(name, table)
        else:
            print("\n".join(["", name, "", *table]))


def _insert(name, lines):
    """Put lines between the marks of the guides that have them."""
    for guide in _GUIDES:
        if f"<!-- {name} -->" in guide.read_text(encoding="utf-8"):
            pages.insert(guide, name, lines)


def _digest(folder):
    """Return twelve digits that tell sources apart."""
    found = hashlib.sha256()
    for path in sorted(folder.rglob("*.f90")):
        found.update(path.read_bytes())
    return found.hexdigest()[:12]


def _sources(path):
    """Return the note on the day of a measurement and its sources."""
    return next((note for note in tables.notes(path) if ", sources " in note), "")


def _before(path):
    """Return the file of the measurements of earlier sources."""
    return path.with_name(f"{path.stem}_before.csv")


def _options():
    parser = argparse.ArgumentParser(
        prog="./bench", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="coarser, in two minutes")
    parser.add_argument("--only", action="append", choices=_PARTS, metavar="PART",
                        help=f"one part (may be repeated): {', '.join(_PARTS)}")
    parser.add_argument("--resume", action="store_true",
                        help="leave out parts measured since the program was built")
    parser.add_argument("--draw", action="store_true", help="measure nothing, only draw")
    parser.add_argument("--out", type=pathlib.Path, help="folder for tables and pictures")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build",
                        help="build folder of the program; default: build")
    options = parser.parse_args()
    folder = (options.out or ROOT / ("results/bench" if options.quick else "docs/bench")).resolve()
    if not (options.build / "snapin").is_file():
        parser.error(f"no program in {options.build}")
    if options.draw and not any((folder / f"{name}.csv").is_file() for name in _PARTS):
        parser.error(f"no measurements in {folder}")
    return options, folder


def _say(text):
    print(text, file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(as_command(main)())
