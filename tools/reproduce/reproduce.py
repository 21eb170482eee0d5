#!/usr/bin/env python3
"""Run the paper's decks, draw its figures, and set its numbers beside those computed.

    ./reproduce                 everything, into reproduction/
    ./reproduce fig03 fig07     these figures alone, into report_part.md
    ./reproduce --publish       and copy report, table and pictures to docs/reproduction/

A figure is a module here with

    DECKS           stems of its decks in inputs/
    TITLE           of its chapter
    CAPTION         Markdown: what is drawn, what the paper reports, what is found; {fields} in it
    numbers(runs)   what these fields stand for, a dict
    draw(runs)      the picture, a matplotlib Figure
    rows(runs)      published.Row beside published.Row

and so is any other chapter; one without draw has no picture. Decks on the paper's stopping rule are
run several times, with rounding changed: draws.py.
"""

import argparse
import importlib
import os
import pathlib
import shutil
import subprocess
import sys
import time
import traceback

import published
import report
import style
from runs import ROOT, Runs

HERE = pathlib.Path(__file__).resolve().parent
sys.path.append(str(HERE.parent))

import pages  # noqa: E402 (found through the line above)


def main():
    """Run, draw, write; exit status 1 if anything failed."""
    names = chapter_names()
    options = _options(names)
    folder = options.out.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    began = time.perf_counter()
    runs = Runs(folder / "runs", options.program)
    modules = {name: importlib.import_module(name) for name in options.only or names}

    decks = runs.with_draws(deck for module in modules.values() for deck in module.DECKS)
    problems = runs.run_all(decks, options.jobs, _say)
    chapters = []
    for name, module in modules.items():
        chapters.append(_chapter(name, module, runs, folder))
        if chapters[-1]["problem"]:
            problems[name] = chapters[-1]["problem"]
    rows = [row for chapter in chapters for row in chapter["rows"]]
    # Some chapters do not take the place of the whole report.
    part = "_part" if options.only else ""
    csv_name, text = f"published_vs_computed{part}.csv", folder / f"report{part}.md"
    published.write_csv(folder / csv_name, rows)
    version = subprocess.run([str(runs.program), "--version"], check=False, capture_output=True,
                             text=True).stdout.strip()
    report.write(text, csv_name, chapters, runs, version,
                 sum(runs.record(deck).get("seconds", 0) for deck in dict.fromkeys(decks)))
    _say(f"{text}: {len(chapters)} chapters, {len(rows)} numbers, "
         f"{time.perf_counter() - began:.0f} s")
    if options.publish and not problems:
        _publish(folder, ROOT / "docs" / "reproduction")
        pages.mark(ROOT / "docs" / "reproduction" / "report.md")
    for name, problem in problems.items():
        _say(f"failed: {name}: {problem}")
    sys.exit(1 if problems else 0)


def chapter_names():
    """Return the modules of the report, in its order."""
    figures = [path.stem for path in sorted(HERE.glob("fig[0-9][0-9].py"))]
    others = ("history", "verdict", "misprints")
    return figures + [name for name in others if (HERE / f"{name}.py").is_file()]


def _chapter(name, module, runs, folder):
    """Return a chapter of the report, its picture drawn."""
    chapter = {"name": name, "title": module.TITLE, "decks": module.DECKS, "caption": "",
               "rows": [], "picture": hasattr(module, "draw"), "problem": None}
    try:
        chapter["rows"] = module.rows(runs)
        numbers = module.numbers(runs) if hasattr(module, "numbers") else {}
        chapter["caption"] = module.CAPTION.format(**numbers)
        if chapter["picture"]:
            style.save(module.draw(runs), folder / f"{name}.png")
        _say(f"{name}: {folder.name}/{name}.png" if chapter["picture"] else f"{name}: done")
    except Exception as problem:  # whatever it is, the other figures are still wanted
        traceback.print_exc()
        chapter["problem"] = f"{type(problem).__name__}: {problem}"
    return chapter


def _publish(folder, to):
    to.mkdir(parents=True, exist_ok=True)
    for path in [folder / "report.md", folder / "published_vs_computed.csv",
                 *sorted(folder.glob("*.png"))]:
        shutil.copyfile(path, to / path.name)
    _say(f"published in {to}")


def _options(names):
    parser = argparse.ArgumentParser(
        prog="./reproduce", description="Run the decks of Attard and Parker (1992), draw the "
        "figures, and set the published numbers beside those computed.")
    parser.add_argument("only", nargs="*", metavar="FIGURE",
                        help=f"what to reproduce: {', '.join(names)}; default: all")
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
    unknown = [name for name in options.only if name not in names]
    if unknown:
        parser.error(f"no such figure: {', '.join(unknown)}; there are {', '.join(names)}")
    if options.publish and options.only:
        parser.error("--publish takes the whole report, not some of its chapters")
    return options


def _say(text):
    print(f"reproduce: {text}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        _say("interrupted; the runs that were done stay, ./reproduce goes on with the others")
        sys.exit(130)
