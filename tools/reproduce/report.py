"""The two reports: pages with fields, paper.md and others.md, and the chapters with their values.

A page begins with an introduction. A chapter begins with a line `## NAME: TITLE`; its text and
the rows of its table, one on each line, have {fields}. Its module has

    DECKS           stems of its decks in inputs/, if it has any
    numbers(runs)   the values of the fields, a dict
    draw(runs)      the picture, a matplotlib Figure, if it has one
    rows(runs)      Comparisons, if its table is not on the page
"""

import csv
import datetime
import importlib
import io
import os
import pathlib
import re
from typing import NamedTuple, Union

import draws
import pages
from runs import path_name

Value = Union[float, str, None]


class Comparison(NamedTuple):
    """A published number beside the converged one.

    `kind` is "formula" if `published` was computed from a formula, with coefficients from `source`;
    "printed" if the number is in an available print; "theory" if it is exact in a limit.
    """

    item: str
    kind: str
    published: Value
    converged: Value
    unit: str = ""
    source: str = ""

    @property
    def error(self):
        """Relative excess of the published number [%]; None if one of the two is words."""
        if isinstance(self.published, (str, type(None))) or isinstance(self.converged, str):
            return None
        return 100 * (self.published / self.converged - 1)

    def cells(self):
        """Return the row as text; a row without the source of its number is refused."""
        if self.kind not in ("formula", "printed", "theory") or self.published is None:
            raise ValueError(f"{self.item}: {self.kind}, {self.published}")
        error = "" if self.error is None else f"{self.error:+.2f}"
        return [self.item, self.kind, shown(self.published), shown(self.converged), error,
                self.unit, self.source]


class Report(NamedTuple):
    """The stems of page and table, the columns of the table, and the package of the chapters."""

    page: str
    table: str
    columns: tuple
    package: str = ""


REPORTS = {
    "paper": Report("report", "published_vs_computed",
                    ("item", "published", "computed", "converged", "unit", "note")),
    "others": Report("others", "others", (
        "item", "kind", "published", "converged", "error %", "unit", "source"), "others."),
}


class Chapter(NamedTuple):
    """A chapter of a page: the key of its report, its title, and its text with fields."""

    report: str
    title: str
    text: str


def _read():
    """Return the beginning of each page and the chapters of all pages, by name."""
    starts, chapters = {}, {}
    for key in REPORTS:
        text = pathlib.Path(__file__).with_name(f"{key}.md").read_text(encoding="utf-8")
        starts[key], *parts = re.split(r"^## (\w+): (.*)\n", text, flags=re.MULTILINE)
        chapters |= {name: Chapter(key, title, body.strip())
                     for name, title, body in zip(parts[::3], parts[1::3], parts[2::3])}
    return starts, chapters


_STARTS, CHAPTERS = _read()


def names(which=tuple(REPORTS)):
    """Return the names of the chapters of some reports, by default of all."""
    return [name for name, chapter in CHAPTERS.items() if chapter.report in which]


def module(name):
    return importlib.import_module(REPORTS[CHAPTERS[name].report].package + name)


def filled(name, runs):
    chapter = module(name)
    fields = chapter.numbers(runs) if hasattr(chapter, "numbers") else {}
    lines = CHAPTERS[name].text.format(**fields).split("\n")
    # A table in the text has an empty line or a head before it; a row begins `| = `.
    rows = [line[4:].split(" |") for line in lines if line.startswith("| = ")]
    caption = "\n".join(line for line in lines if not line.startswith("| = ")).strip()
    if hasattr(chapter, "rows"):
        rows += [row.cells() for row in chapter.rows(runs)]
    return caption, [[cell.strip() for cell in row] for row in rows]


def shown(value):
    """Return a value as printed: six digits of a number, nothing for None."""
    return "" if value is None else value if isinstance(value, str) else f"{float(value):.6g}"


def escaped(cell):
    """Return a cell that Markdown does not change."""
    return re.sub(r"([\\|*_<])", r"\\\1", cell)


def write(folder, key, part, made, runs, version):
    """Write the page of a report and the table of its rows; `made` are dicts of chapters with
    name, title, caption, rows, whether they have a picture, and problem (None if there was
    none)."""
    book, table = REPORTS[key], f"{REPORTS[key].table}{part}.csv"
    text = io.StringIO()
    rows = [row for chapter in made for row in chapter["rows"]]
    csv.writer(text, lineterminator="\n").writerows([book.columns, *rows])
    write_whole(folder / table, text.getvalue())
    lines = [_STARTS[key].format(table=table, count=draws.COUNT,
                                 fewer=len(draws.names("history_c_paper")))]
    lines += [f"- [{each['title']}](#{_anchor(each['title'])})" for each in made]
    for each in made:
        lines += ["", f"## {each['title']}", ""]
        if each["problem"]:
            lines.append(f"**Failed:** {each['problem']}")
            continue
        if each["picture"]:
            lines += [f"![{each['title']}]({each['name']}.png)", ""]
        lines.append(each["caption"])
        if each["rows"]:
            lines += ["", *pages.table(book.columns, each["rows"], escaped)]
    write_whole(folder / f"{book.page}{part}.md",
                "\n".join([*lines, "", *_ending(made, runs, version)]) + "\n")
    return len(rows)


def _anchor(title):
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


def _ending(made, runs, version):
    """Return the conditions of the run: commands, versions, and the time of each deck."""
    decks = list(dict.fromkeys(deck for chapter in made for deck in chapter["decks"]))
    seconds = sum(runs.record(deck).get("seconds", 0) for deck in runs.with_draws(decks))
    example = " ".join(chapter["name"] for chapter in made[:2])
    lines = ["## How to run it", "",
             "    ./reproduce            # all of it, both reports",
             f"    ./reproduce {example}  # some of it",
             "    ./reproduce --publish  # and copy it to docs/reproduction/", "",
             "Decks that have not changed are not run again.", "",
             f"Computed on {datetime.date.today()} by", "",
             *(f"    {line}" for line in version.split("\n")), ""]
    if not decks:
        return lines
    lines += [f"{len(decks)} decks, {seconds:.0f} s of one core together:", "",
              "| deck | runs | seconds, the first | exit status |", "|---|---|---|---|"]
    for deck in decks:
        record, count = runs.record(deck), len(runs.with_draws([deck]))
        lines.append(f"| `{path_name(deck)}` | {count} | {record.get('seconds', '')} | "
                     f"{record.get('status', 'not run')} |")
    return [*lines, "", "Exit status 1 is what decks named `_paper` may end with: they stop on the "
            "paper's rule, and snapin does not call that converged."]


def write_whole(path, text):
    """Write a file that appears under its name only when it is complete."""
    partial = path.with_name(path.name + ".partial")
    partial.write_text(text, encoding="utf-8")
    os.replace(partial, path)
