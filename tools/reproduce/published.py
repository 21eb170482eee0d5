"""What the paper prints beside what the program finds: one row a statement."""

import csv
import dataclasses
import io
import os
import pathlib
from typing import Union

Value = Union[float, str, None]

COLUMNS = ("item", "published", "computed", "converged", "unit", "note")


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

    def cells(self):
        """Return the row as text, numbers with the digits that a reader can use."""
        return [shown(getattr(self, column)) for column in COLUMNS]


def shown(value):
    """Return a value as it is printed: six digits of a number, nothing for None."""
    if value is None:
        return ""
    if isinstance(value, str):
        return value
    return f"{float(value):.6g}"


def write_csv(path, rows):
    """Write the rows under one header line; the file appears whole."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    writer.writerows(row.cells() for row in rows)
    write_whole(path, text.getvalue())


def write_whole(path, text):
    """Write a file that appears under its name only when it is complete."""
    path = pathlib.Path(path)
    partial = path.with_name(path.name + ".partial")
    partial.write_text(text, encoding="utf-8")
    os.replace(partial, path)
