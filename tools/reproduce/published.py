"""What the paper prints beside what the program finds: one row a statement."""

import csv
import dataclasses
import io
import os
import pathlib
from typing import Union

Value = Union[float, str, None]

@dataclasses.dataclass(frozen=True)
class Row:
    """One statement of the paper.

    `published` is the paper's number or words. `computed` is found with the paper's own grid and
    stopping rule, None where there is no such run; `converged` is what the equations give.
    """

    item: str
    published: Value
    computed: Value
    converged: Value
    unit: str = ""
    note: str = ""

    COLUMNS = ("item", "published", "computed", "converged", "unit", "note")

    def cells(self):
        """Return the row as text, numbers with the digits that a reader can use."""
        return [shown(getattr(self, column)) for column in self.COLUMNS]


@dataclasses.dataclass(frozen=True)
class Comparison:
    """A number of somebody else's beside the converged one.

    `kind` is "formula" where `published` was computed from a formula, whose coefficients `source`
    names; "printed" where it stands in a print at hand; "theory" where it is exact in a limit;
    "not read" where nothing of theirs was at hand, and `published` is None then.
    """

    item: str
    kind: str
    published: Value
    converged: Value
    unit: str = ""
    source: str = ""

    KINDS = ("formula", "printed", "theory", "not read")
    COLUMNS = ("item", "kind", "published", "converged", "error %", "unit", "source")

    def __post_init__(self):
        if self.kind not in self.KINDS or (self.kind == "not read") != (self.published is None):
            raise ValueError(f"{self.item}: {self.kind}, {self.published}")

    @property
    def error(self):
        """By how much what was published is too large [%]; None where one of them is words."""
        if isinstance(self.published, (str, type(None))) or isinstance(self.converged, str):
            return None
        return 100 * (self.published / self.converged - 1)

    def cells(self):
        """Return the row as text."""
        error = "" if self.error is None else f"{self.error:+.2f}"
        return [shown(self.item), self.kind, shown(self.published), shown(self.converged), error,
                self.unit, self.source]



def shown(value):
    """Return a value as it is printed: six digits of a number, nothing for None."""
    if value is None:
        return ""
    if isinstance(value, str):
        return value
    return f"{float(value):.6g}"


def write_csv(path, rows, kind=Row):
    """Write the rows, all of one kind, under one header line; the file appears whole."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(kind.COLUMNS)
    writer.writerows(row.cells() for row in rows)
    write_whole(path, text.getvalue())


def write_whole(path, text):
    """Write a file that appears under its name only when it is complete."""
    path = pathlib.Path(path)
    partial = path.with_name(path.name + ".partial")
    partial.write_text(text, encoding="utf-8")
    os.replace(partial, path)
