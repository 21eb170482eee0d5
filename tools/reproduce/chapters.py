"""The chapters of the two reports, in their order: the source paper, and what others published.

A chapter is a module of this folder, or of the folder of its report; reproduce.py says what is in it.
"""

import importlib
from typing import NamedTuple

import published
import report


class Report(NamedTuple):
    """A report: the stems of its page and of its table, its chapters, and what it says at first.

    `folder` is the package of its chapters, "" for modules beside this one; `row` the kind of its rows.
    """

    page: str
    table: str
    folder: str
    chapters: tuple
    row: type
    introduction: object


REPORTS = {
    "paper": Report(
        "report", "published_vs_computed", "",
        (*(f"fig{number:02}" for number in range(1, 12)), "readings", "history", "verdict", "misprints"),
        published.Row, report.of_paper),
    "others": Report(
        "others", "others", "others",
        ("greenwood_1997", "maugis_1992", "carpick_1999", "pietrement_troyon_2000",
         "johnson_greenwood_1997", "law_independence", "wu_2010", "ciavarella_2017",
         "zheng_yu_2007", "hayes_1972", "indentation_of_layers", "not_read"),
        published.Comparison, report.of_others),
}


def names(which=tuple(REPORTS)):
    """Return the names of the chapters of some reports, by default of all."""
    return [name for key in which for name in REPORTS[key].chapters]


def module(name):
    """Return the module of a chapter."""
    (folder,) = (found.folder for found in REPORTS.values() if name in found.chapters)
    return importlib.import_module(f"{folder}.{name}" if folder else name)
