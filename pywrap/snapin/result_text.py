"""The texts of results: tables and namelists that the program has written, as arrays and values."""

import contextlib
import csv
import difflib
import itertools
import re
from collections.abc import Iterator
from typing import Any

import _snapin
import numpy as np

from .arguments import Path, SnapinError

_TEXT_COLUMNS = ("branch", "direction", "theory", "quantity", "parameter", "verdict", "warning",
                 "failure")
# What numbers may look like that begin with a letter.
_NO_NUMBERS = ("NaN", "Infinity")
# A text in quotes, with quotes inside doubled, or another value.
_WORD = re.compile(r"'((?:[^']|'')*)'|([^,\s]+)")
_TRUTHS = {".true.": True, ".false.": False}
# Rows of a table whose cells are text at a time; as text they take several times their memory.
_AT_ONCE = 4096


class ResultsError(SnapinError):
    """A file of results is missing or wrong; the message says which."""


class MissingEntry(ResultsError, KeyError):
    """Results have no entry or column of this name; the message has similar names."""

    def __str__(self):
        return self.args[0]


class Entries(dict):
    """Entries of a summary, or columns of a table, by name: another name is a `MissingEntry`.

    `what` says in its message what the entries are; `elsewhere`: names that are there instead,
    and where.
    """

    def __init__(self, entries, what, elsewhere=((), "")):
        super().__init__(entries)
        self._what, self._elsewhere = what, elsewhere

    def __missing__(self, name):
        advice = ""
        names, place = self._elsewhere
        for known, where in ((self, ""), (names, place)):
            near = difflib.get_close_matches(str(name), known, 1)
            if near:
                advice = f"; did you mean {near[0]!r}{where}?"
                if near[0] == name:
                    advice = f"; it is{where}"
                    break
        raise MissingEntry(f"no {name!r} in {self._what}{advice}")


@contextlib.contextmanager
def reading(place: Path) -> Iterator[None]:
    """Whatever text of `place` cannot be understood is a ResultsError."""
    try:
        yield
    except SnapinError:
        raise
    except (ValueError, LookupError, TypeError, ArithmeticError) as problem:
        raise ResultsError(f"{place} is damaged ({problem}); run the deck again") from problem


def units_of(text: str) -> dict[str, str]:
    """Return the units of the columns of a table by name."""
    return dict(re.findall(r"^# (\S+) \[(.*?)\]", text, re.MULTILINE))


def columns_in(text: str, place: Path) -> Entries:
    """Return the columns of a table's text."""
    lines = (line for line in _lines(text) if not line.startswith("#"))
    # Only names of files with commas are in quotes.
    table = csv.reader(lines) if '"' in text else (line.split(",") for line in lines)
    header = next(table, [""])
    if header == [""]:
        raise ResultsError(f"{place}: no header line")
    if len(set(header)) < len(header):
        raise ResultsError(f"{place}: two columns have one name")
    pieces = [[np.array((), str if name in _TEXT_COLUMNS else float)] for name in header]
    with reading(place):
        while rows := list(itertools.islice(table, _AT_ONCE)):
            for row in rows:
                if len(row) != len(header):
                    raise ResultsError(
                        f"{place}: {len(row)} cells in a row, {len(header)} in the header")
            for name, piece, cells in zip(header, pieces, zip(*rows)):
                # A swept key may have words.
                has_text = name in _TEXT_COLUMNS or "." in name
                piece.append(np.array(cells, str if has_text else float))
        return Entries(((name, _joined(name, piece)) for name, piece in zip(header, pieces)),
                       place)


def _lines(text):
    """Yield the lines of a text, none of which is copied before its turn."""
    start = 0
    while start < len(text):
        end = text.find("\n", start)
        end = len(text) if end < 0 else end
        yield text[start:end].removesuffix("\r")
        start = end + 1


def _joined(name, pieces):
    """Return a column in one piece: of a swept key text if it has words or names files, otherwise
    numbers."""
    column = np.concatenate(pieces[1:] or pieces)
    pieces.clear()
    if "." in name and not name.endswith(".file") and not any(
            cell[:1].isalpha() and cell not in _NO_NUMBERS for cell in column):
        return column.astype(float)
    return column


def structured(columns: dict[str, np.ndarray]) -> np.ndarray:
    """Return the columns, which are emptied, as a structured array."""
    kinds = [(name, column.dtype) for name, column in columns.items()]
    table = np.empty(len(next(iter(columns.values()))), kinds)
    for name in list(columns):
        table[name] = columns.pop(name)
    return table


def namelist_groups(text: str) -> dict[str, dict[str, list[Any]]]:
    """Return the groups of a namelist that the program has written: lists of values by key.

    Each key begins a line; its further lines have a deeper indentation.
    """
    groups: dict[str, dict[str, list[Any]]] = {}
    group: dict[str, list[Any]] = {}
    values: list[Any] = []
    for line in text.splitlines():
        if line.startswith("&"):
            group = groups[line[1:]] = {}
        elif line.startswith("    "):
            values += _values(line)
        elif line.startswith("  "):
            key, _, rest = line.partition("=")
            values = group[key.strip()] = _values(rest)
    return groups


def _values(text):
    """Return the values in a part of a line."""
    return [
        _value(bare) if quoted is None else quoted.replace("''", "'")
        for quoted, bare in (match.groups() for match in _WORD.finditer(text))
    ]


def _value(word):
    if word in _TRUTHS:
        return _TRUTHS[word]
    return int(word) if word.lstrip("+-").isdigit() else float(word)


def _as_list(values):
    """Return values as an array of numbers, or as a list of texts."""
    return values if isinstance(values[0], str) else np.array(values)


def fitted_groups(text: str, place: Path) -> dict[str, dict[str, Any]]:
    """Return the groups of fit.nml, with correlations as matrices; none without a fit."""
    with reading(place):
        groups: dict[str, dict[str, Any]] = {
            name: Entries(((key, _as_list(values)) for key, values in group.items()
                           if key != "title"), f"&{name} of {place}")
            for name, group in namelist_groups(text).items()
        }
        for group in groups.values():
            group["correlation"] = group["correlation"].reshape(2 * (len(group["parameters"]),))
    return groups


def summary_groups(text: str, place: Path, sweep: str) -> dict[str, Entries]:
    """Return &summary and &cost; a list stays a list, also with one value. sweep: the text of the
    table with the numbers of a sweep's cases, or nothing."""
    # The deck follows these groups.
    results, found, _ = text.partition("\n&cost\n")
    if not found:
        raise ResultsError(f"{place}: no group &summary and &cost")
    header = next((line for line in _lines(sweep) if not line.startswith("#")), "")
    elsewhere = header.split(","), " of the table sweep, which has the numbers of all cases"
    cost = text[len(results + found):].partition("\n/\n")[0]
    with reading(place):
        groups = namelist_groups(results + found + cost)
        if "summary" not in groups:
            raise ResultsError(f"{place}: no group &summary and &cost")
        return {
            name: Entries(
                ((key, _as_list(values) if _snapin.flat_deck.is_list(key) else values[0])
                 for key, values in groups[name].items()), f"&{name} of {place}", elsewhere)
            for name in ("summary", "cost")
        }
