#!/usr/bin/env python3
"""Compare the sources with those with which the figures of pages were measured.

    pages.py              lists every page that is older than the sources, with status 1
    pages.py --mark PAGE  records that all figures of PAGE were measured just now

A page has the line `<!-- measured at DIGEST -->`. The digest is that of the sources that
determine numbers. A command that renews a whole page marks the page; after a measurement by hand
use --mark.
"""

import argparse
import hashlib
import os
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Tools that make pages compute on one thread; to be set before a module loads OpenMP.
os.environ.setdefault("OMP_NUM_THREADS", "1")

# Page, and the command that renews its figures.
PAGES = {
    "README.md": "./run inputs/first.nml, and the commands below its second picture, compared by "
    "hand; then tools/pages.py --mark README.md",
    "docs/accuracy.md": "./bench",
    "docs/records/costs.md": "./bench",
    "docs/asymptotics.md": "tools/asymptotics.py",
    "docs/fitting.md": "inputs/examples/fit.nml, pywrap/plots/fit.py and tools/bench/coverage.py, "
    "by hand; then tools/pages.py --mark docs/fitting.md",
    "docs/formulas.md": "tools/formulas.py",
    "docs/forces.md": "tools/law_independence.py; tools/forces.py for its pictures",
    "docs/methods.md": "inputs/first.nml with &equilibrium_path, compared by hand; then "
    "tools/pages.py --mark docs/methods.md",
    "docs/reproduction/others.md": "./reproduce others --publish",
    "docs/reproduction/report.md": "./reproduce paper --publish",
    "docs/records/verification.md": "tools/verify/verify.sh, its tables by hand; then "
    "tools/pages.py --mark docs/records/verification.md",
    "docs/testing.md": "tools/verify/verify.sh, its tables by hand; then tools/pages.py --mark "
    "docs/testing.md",
}
# Files that read decks, write files or print messages change no number. A new file counts until it
# is listed here.
_NO_NUMBERS = (
    "byte_record", "c_library", "case_rows", "checksums", "clock", "command_line", "cost_columns",
    "decimal", "deck", "deck_characters", "deck_keys", "deck_number", "deck_numbers", "deck_scan",
    "deck_source", "deck_store", "deck_values", "dispatch", "failure", "files", "folder_lock",
    "journal", "journal_frame", "launch", "namelist_writer", "preflight", "price", "price_table",
    "progress", "publication", "ranks", "result_folder", "result_rows", "result_tables",
    "run_identity", "snapin",
    "text", "text_file",
)
_MARK = re.compile(r"<!-- measured at (\w+) -->")


def digest(folder=ROOT / "src"):
    """Return twelve digits that change with the code that determines numbers, not with its
    comments."""
    found = hashlib.sha256()
    for path in sorted(folder.rglob("*.f90")):
        if path.stem in _NO_NUMBERS:
            continue
        lines = (line.strip() for line in path.read_text(encoding="utf-8").splitlines())
        code = "\n".join(line for line in lines if line and not line.startswith("!"))
        found.update(f"{path.relative_to(folder).as_posix()}\n{code}\n".encode())
    return found.hexdigest()[:12]


def mark(page):
    """Write into a page that it was measured with the present sources."""
    text = page.read_text(encoding="utf-8")
    line = f"<!-- measured at {digest()} -->"
    if _MARK.search(text):
        text = _MARK.sub(line, text)
    else:
        title, rest = text.split("\n", 1)
        text = f"{title}\n\n{line}\n{rest}"
    page.write_text(text, encoding="utf-8")


def table(columns, rows, shown=str):
    """Return the lines of a Markdown table; `shown` makes the text of a cell."""
    return ["| " + " | ".join(columns) + " |", "|" + "---|" * len(columns),
            *("| " + " | ".join(map(shown, row)) + " |" for row in rows)]


def replaced(text, name, lines):
    """Return the text of a page with lines between its marks <!-- name --> and <!-- /name -->."""
    new, count = re.subn(rf"(<!-- {name} -->\n).*?(<!-- /{name} -->)", lambda match: "".join(
        [match[1], *(f"{line}\n" for line in lines), match[2]]), text, flags=re.S)
    if count != 1:
        raise ValueError(f"the page has no marks for {name}")
    return new


def insert(page, name, lines, measured=True):
    """Put lines between the marks of a page, and mark it measured."""
    page.write_text(replaced(page.read_text(encoding="utf-8"), name, lines), encoding="utf-8")
    if measured:
        mark(page)


def measured_at(page):
    """Return the digest in a page, None without one."""
    found = _MARK.search(page.read_text(encoding="utf-8"))
    return found and found[1]


def old_pages(root=ROOT):
    """Return (page, its digest or None) of the pages that were not measured with these sources."""
    now = digest(root / "src")
    pairs = [(page, measured_at(root / page)) for page in PAGES]
    return [(page, named) for page, named in pairs if named != now]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--mark", nargs="+", metavar="PAGE", choices=PAGES,
                        help="pages whose figures were measured just now")
    options = parser.parse_args()
    for page in options.mark or []:
        mark(ROOT / page)
    if options.mark:
        return 0
    old = old_pages()
    for page, named in old:
        was = f"measured at {named}" if named else "does not say at which numerics it was measured"
        print(f"{page}: {was}, the sources are at {digest()}; renew it with: {PAGES[page]}")
    return 1 if old else 0


if __name__ == "__main__":
    from snapin.command import as_command

    sys.exit(as_command(main)())
