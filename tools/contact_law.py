#!/usr/bin/env python3
"""Make the contact law: its coefficients, the C header, the JavaScript, and the calculator.

    tools/contact_law.py                    the law of the project, of Lennard-Jones 9-3: minutes
    tools/contact_law.py --remake           the files again from its coefficients
    tools/contact_law.py --deck DECK --out FOLDER   the law of another force: that of a deck

The calculator contains the JavaScript, so that it is one file.
--tabor LOW HIGH restricts the range of Tabor's parameter. The deck's force needs a z0, one
attractive well without a barrier, and a decay as a power of the gap or exponential.
"""

import argparse
import json
import pathlib
import sys

import pages  # noqa: F401 - computes on one thread

sys.path.append(str(pathlib.Path(__file__).resolve().parent / "law"))

import law_calculator  # noqa: E402
import law_errors  # noqa: E402
import law_header  # noqa: E402
import law_states  # noqa: E402
import law_tables  # noqa: E402
from snapin.command import as_command  # noqa: E402

TABLE = pages.ROOT / "pywrap" / "snapin" / "contact_law.json"
SCRIPT = pages.ROOT / "contact_law" / "snapin_contact.js"
HEADER = pages.ROOT / "contact_law" / "snapin_contact.h"
CALCULATOR = pages.ROOT / "docs" / "calculator.html"
LENNARD_JONES = {"force": {"law": "lennard_jones", "surface_energy": 0.05, "z0": 3e-10}}
TITLE = "Lennard-Jones, exponents 9 and 3"
STATES, SEED = 10000, 59
WORST = 1e-2  # error of a law that is not written


def made(deck, title, least, largest, states):
    """Return the law of a deck with its measured errors."""
    force = law_states.Force(deck)
    law = law_tables.law_tables(force, title, least, largest)
    law["errors"] = measured(law, force, states)
    error = law["errors"]["within"]["largest"]["load"][0]
    if not error < WORST:
        raise law_states.Unsuitable(f"the law has errors of {error:.1e} pull-off forces: its path "
                                    "is not that of one attractive well")
    return law


def measured(law, force, states):
    """Return the largest errors within the range of Tabor's parameter and beyond it."""
    ranges = {"within": (law["least"], law["largest"], states)}
    if not law["highest"]:
        ranges["above"] = law["largest"], 5*law["largest"], states//20
    if not law["lowest"]:
        ranges["below"] = law["least"]/10, law["least"], states//20
    return {name: {"low": low, "high": high, "states": count,
                   "largest": law_errors.largest_errors(law, force, count, SEED, low, high)}
            for name, (low, high, count) in ranges.items()}


def write(law, folder=None):
    """Write the files of a law: those of the project, or into a folder."""
    text = json.dumps(law, separators=(",", ":"))
    files = {TABLE: text + "\n", HEADER: law_header.header_text(law),
             SCRIPT: law_calculator.script_text(law)}
    for place, content in files.items():
        place = place if folder is None else folder / place.name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(content, encoding="utf-8")
    if folder is None:
        CALCULATOR.write_text(law_calculator.page_text(law), encoding="utf-8")


def main():
    """Make what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--deck", type=pathlib.Path, help="a deck, of which the force counts")
    parser.add_argument("--out", type=pathlib.Path, help="folder of another force's files")
    parser.add_argument("--remake", action="store_true",
                        help="only header, JavaScript and calculator")
    parser.add_argument("--tabor", type=float, nargs=2, metavar=("LOW", "HIGH"),
                        default=(law_tables.LEAST, law_tables.LARGEST))
    parser.add_argument("--states", type=int, default=STATES, help="random states for the errors")
    options = parser.parse_args()
    if bool(options.deck) != bool(options.out):
        parser.error("--deck and --out go together")
    if options.remake:
        write(json.loads(TABLE.read_text(encoding="utf-8")))
        return
    try:
        law = made(options.deck or LENNARD_JONES, options.deck.stem if options.deck else TITLE,
                   *options.tabor, options.states)
    except law_states.Unsuitable as reason:
        sys.exit(f"{options.deck}: {reason}")
    write(law, options.out)
    for kind, (error, mu) in law["errors"]["within"]["largest"].items():
        print(f"{law_errors.KINDS[kind]}: {error:.1e}, at Tabor's parameter {mu:.3g}")


if __name__ == "__main__":
    sys.exit(as_command(main)())
