#!/usr/bin/env python3
"""Run the paper's decks, draw its figures, and compare the numbers of the paper, and of others,
with the computed ones.

    ./reproduce                 everything, into reproduction/: report.md and others.md
    ./reproduce paper           the paper alone
    ./reproduce others          the work of others alone
    ./reproduce fig03 fig07     these chapters alone, into report_part.md
    ./reproduce --publish       and copy reports, tables and pictures to docs/reproduction/

report.py describes a chapter. Decks with the paper's stopping rule are run several times with
changed rounding: draws.py.
"""

import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import time
import traceback

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))

import report  # noqa: E402
import style  # noqa: E402
from pages import ROOT  # noqa: E402
from runs import Runs  # noqa: E402
from snapin.command import as_command  # noqa: E402


def main():
    """Run, draw, write; exit status 1 if anything failed."""
    options = _options()
    folder = options.out.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    began = time.perf_counter()
    runs = Runs(folder / "runs", options.program)
    modules = {name: report.module(name) for name in options.only}
    decks = runs.with_draws(deck for module in modules.values()
                            for deck in getattr(module, "DECKS", ()))
    problems = runs.run_all(decks, options.jobs, _say)
    version = subprocess.run([str(runs.program), "--version"], check=False, capture_output=True,
                             text=True).stdout.strip()
    whole = []
    for key in report.REPORTS:
        chosen = [name for name in report.names([key]) if name in modules]
        if not chosen:
            continue
        made = [_chapter(name, modules[name], runs, folder) for name in chosen]
        problems |= {one["name"]: one["problem"] for one in made if one["problem"]}
        # A report of some chapters does not replace the whole report.
        part = "" if chosen == report.names([key]) else "_part"
        rows = report.write(folder, key, part, made, runs, version)
        whole += [key] if not part else []
        _say(f"{folder / report.REPORTS[key].page}{part}.md: {len(made)} chapters, {rows} numbers, "
             f"{time.perf_counter() - began:.0f} s")
    if options.publish and not problems:
        for key in whole:
            _publish(folder, ROOT / "docs" / "reproduction", key)
    for name, problem in problems.items():
        _say(f"failed: {name}: {problem}")
    sys.exit(1 if problems else 0)


def _chapter(name, module, runs, folder):
    chapter = {"name": name, "title": report.CHAPTERS[name].title, "caption": "", "rows": [],
               "decks": getattr(module, "DECKS", ()), "picture": hasattr(module, "draw"),
               "problem": None}
    try:
        chapter["caption"], chapter["rows"] = report.filled(name, runs)
        if chapter["picture"]:
            style.save(module.draw(runs), folder / f"{name}.png")
        _say(f"{name}: {folder.name}/{name}.png" if chapter["picture"] else f"{name}: done")
    except Exception as problem:  # whatever it is, the other figures are still wanted
        traceback.print_exc()
        chapter["problem"] = f"{type(problem).__name__}: {problem}"
    return chapter


def _publish(folder, to, key):
    to.mkdir(parents=True, exist_ok=True)
    book = report.REPORTS[key]
    pictures = [folder / f"{name}.png" for name in report.names([key])]
    for path in [folder / f"{book.page}.md", folder / f"{book.table}.csv",
                 *filter(pathlib.Path.is_file, pictures)]:
        shutil.copyfile(path, to / path.name)
    _say(f"published in {to}: {book.page}.md")


def _options():
    known = [*report.REPORTS, *report.names()]
    parser = argparse.ArgumentParser(
        prog="./reproduce", description="Run the decks of Attard and Parker (1992), draw the "
        "figures, and set the published numbers, and those of others, beside those computed.")
    parser.add_argument("only", nargs="*", metavar="CHAPTER",
                        help=f"what to reproduce: {', '.join(known)}; default: all")
    parser.add_argument("-j", "--jobs", type=int, default=len(os.sched_getaffinity(0)),
                        help="decks that run at a time; default: one a core")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "reproduction",
                        help="folder for all that is written; default: reproduction/")
    parser.add_argument("--program", type=pathlib.Path, help="default: build/snapin, or $SNAPIN")
    parser.add_argument("--publish", action="store_true",
                        help="copy report, table and pictures to docs/reproduction/")
    options = parser.parse_args()
    if options.jobs < 1:
        parser.error("-j takes a number of decks, 1 or more")
    if options.program and not options.program.is_file():
        parser.error(f"no program {options.program}")
    unknown = [name for name in options.only if name not in known]
    if unknown:
        parser.error(f"no such chapter: {', '.join(unknown)}; there are {', '.join(known)}")
    if options.publish and not set(options.only) <= set(report.REPORTS):
        parser.error("--publish takes whole reports, not some of their chapters")
    wanted = {name for each in options.only or report.REPORTS
              for name in (report.names([each]) if each in report.REPORTS else [each])}
    options.only = [name for name in report.names() if name in wanted]
    return options


def _say(text):
    print(f"reproduce: {text}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    try:
        sys.exit(as_command(main)())
    except KeyboardInterrupt:
        _say("interrupted; the runs that were done stay, ./reproduce goes on with the others")
        sys.exit(130)
