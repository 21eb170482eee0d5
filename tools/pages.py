"""Tables of measured figures in pages, with the day and the command of their measurement.

Computes on one thread: to be imported before a module that loads OpenMP.
"""

import datetime
import os
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parent.parent
os.environ.setdefault("OMP_NUM_THREADS", "1")

_VERSION = re.compile(r"version: '([^']+)'")


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


def insert(page, name, lines, command=None):
    """Put lines between the marks of a page; with a command, the day on which it measured them."""
    if command:
        lines = [*lines, "", measured(datetime.date.today(), command)]
    page.write_text(replaced(page.read_text(encoding="utf-8"), name, lines), encoding="utf-8")


def measured(day, command):
    """Return the line below figures that a command measured on a day."""
    version = _VERSION.search((ROOT / "meson.build").read_text(encoding="utf-8"))[1]
    return f"Measured on {day} with snapin {version}, by `{command}`."
