"""The reader of the results of a run."""

import contextlib
import csv
import difflib
import itertools
import os
import pathlib
import re
import stat
import time
from typing import Any, Optional

import _snapin
import numpy as np

from .arguments import Path, SnapinError, folder_path

_TEXT_COLUMNS = ("branch", "direction", "theory", "quantity", "parameter", "verdict", "warning",
                 "failure")
# What numbers may look like that begin with a letter.
_NO_NUMBERS = ("NaN", "Infinity")
# How the program's tables and its fits begin.
_HEAD, _FIT_HEAD = b"# title:", b"! A fit by snapin"
# A text in quotes, with quotes inside doubled, or another value.
_WORD = re.compile(r"'((?:[^']|'')*)'|([^,\s]+)")
_TRUTHS = {".true.": True, ".false.": False}
# Where a run that has not ended keeps its files.
_UNFINISHED = "unfinished"
# Longest time [s] for which a set of results that is being replaced is waited for, and a pause.
_PATIENCE, _PAUSE = 5.0, 0.005
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
def _reading(place):
    """Whatever text of `place` cannot be understood is a ResultsError."""
    try:
        yield
    except SnapinError:
        raise
    except (ValueError, LookupError, TypeError, ArithmeticError) as problem:
        raise ResultsError(f"{place} is damaged ({problem}); run the deck again") from problem


class Result:
    """The results of a run, SI.

    Each table that the deck asked for is an attribute, a structured array: `curve`, `profiles`,
    `approximations`, `classical`, `sweep` and so on. `summary` and `cost` are dictionaries of the
    groups of summary.nml; lists of numbers in them are arrays. `converged`: whether all states were
    found. `fitted` has the groups of fit.nml by name, each a dictionary of arrays; it is empty for
    a deck without &fit.
    """

    tables: dict[str, np.ndarray]
    summary: dict[str, Any]
    cost: dict[str, Any]
    fitted: dict[str, dict[str, Any]]
    units: dict[str, dict[str, str]]

    def __init__(self, tables: dict[str, np.ndarray], summary: dict[str, Any],
                 cost: dict[str, Any], fitted: Optional[dict[str, dict[str, Any]]] = None,
                 units: Optional[dict[str, dict[str, str]]] = None) -> None:
        self.tables, self.summary, self.cost = tables, summary, cost
        #: The units of the columns of each table by its name.
        self.units = units or {}
        self.fitted = fitted or {}

    @property
    def converged(self) -> bool:
        """Return whether all states were found."""
        return self.summary["converged"]

    def __getattr__(self, name: str) -> np.ndarray:
        tables = self.__dict__.get("tables", {})
        if name not in tables:
            raise AttributeError(f"no table {name!r}; this run has {', '.join(tables) or 'none'}")
        return tables[name]

    def __dir__(self):
        return [*super().__dir__(), *self.tables]

    def __repr__(self):
        return f"<Result: {', '.join([*self.tables, 'summary', 'cost'])}>"


def read_results(folder: Path) -> Result:
    """Return the `Result` in a folder written by the program."""
    folder = folder_path("folder", folder)
    return result_of(ResultFiles(folder).texts, folder)


class ResultFiles:
    """The files of one run in a folder of results: `texts` has their texts by name.

    A run that replaces results removes the old summary first and puts the new one there last. So
    the files read while one summary is there are of one run. While it is open, no other file has
    its number.
    """

    texts: dict[str, str]

    def __init__(self, folder: Path) -> None:
        self.folder = pathlib.Path(folder)
        # One look, since a run may put its summary there or take it away meanwhile.
        with contextlib.suppress(OSError):
            if not stat.S_ISREG((self.folder / "summary.nml").stat().st_mode):
                raise ResultsError(f"{self.folder / 'summary.nml'} is no file")
        patience = time.monotonic() + _PATIENCE
        while not self._have_been_read():
            if time.monotonic() > patience:
                raise ResultsError(f"the results in {folder} are not one set: a run was stopped "
                                   "while it replaced them; run the deck again")
            time.sleep(_PAUSE)

    def _have_been_read(self):
        """Read the files; return whether they are of one run."""
        try:
            with (self.folder / "summary.nml").open("rb") as summary:
                found = _tables_in(self.folder)
                found["summary.nml"] = summary.read()
                whole = os.path.samestat(os.fstat(summary.fileno()), os.stat(summary.name))
        except (FileNotFoundError, NotADirectoryError):
            # Unless a run replaces the results: its summary is in one of these places.
            if any((self.folder / place / "summary.nml").is_file() for place in (_UNFINISHED, "")):
                return False
            raise ResultsError(_absence(self.folder, "summary.nml")) from None
        except OSError as problem:
            raise ResultsError(f"{self.folder}: cannot be read: {problem}") from problem
        self.texts = {}
        for name in list(found):
            with _reading(self.folder / name):
                self.texts[name] = found.pop(name).decode()
        return whole

    def text(self, name: str) -> str:
        """Return the text of a file."""
        if name not in self.texts:
            raise ResultsError(_absence(self.folder, name))
        return self.texts[name]

    def table(self, name: str) -> Entries:
        """Return the columns of a table as `Entries` of arrays, text for `_TEXT_COLUMNS`."""
        return _columns(self.text(name), self.folder / name)

    def summary(self) -> Entries:
        """Return the group &summary of summary.nml as `Entries`."""
        return _summary_groups(self.text("summary.nml"), self.folder / "summary.nml",
                               self.texts.get("sweep.csv", ""))["summary"]

    def fit(self) -> Entries:
        """Return the group &fit of fit.nml, lists and arrays, as `Entries`."""
        return _fitted(self.text("fit.nml"), self.folder / "fit.nml")["fit"]


def _tables_in(folder):
    """Return the contents of tables and of a fit; other files may be there, such as a curve."""
    found = {path.name: path.read_bytes() for path in sorted(folder.glob("*.*"))
             if path.is_file() and (path.suffix == ".csv" or path.name == "fit.nml")}
    return {name: text for name, text in found.items()
            if text.startswith(_HEAD if name.endswith(".csv") else _FIT_HEAD)}


def result_of(files: dict[str, str], place: Path) -> Result:
    """Return the `Result` in texts of files by name, which is emptied; `place` names them in
    messages."""
    groups = _summary_groups(files["summary.nml"], f"{place}/summary.nml",
                             files.get("sweep.csv", ""))
    units = {name.removesuffix(".csv"): units_of(text) for name, text in files.items()
             if name.endswith(".csv")}
    tables = {
        name.removesuffix(".csv"): _structured(_columns(files.pop(name), f"{place}/{name}"))
        for name in sorted(files)
        if name.endswith(".csv")
    }
    return Result(tables, groups["summary"], groups["cost"],
                  _fitted(files.get("fit.nml", ""), f"{place}/fit.nml"), units)


def units_of(text: str) -> dict[str, str]:
    """Return the units of the columns of a table by name."""
    return dict(re.findall(r"^# (\S+) \[(.*?)\]", text, re.MULTILINE))


def _fitted(text, place):
    """Return the groups of fit.nml, with correlations as matrices; none without a fit."""
    with _reading(place):
        groups = {
            name: Entries(((key, _as_list(values)) for key, values in group.items()
                           if key != "title"), f"&{name} of {place}")
            for name, group in _namelist(text).items()
        }
        for group in groups.values():
            group["correlation"] = group["correlation"].reshape(2 * (len(group["parameters"]),))
    return groups


def _structured(columns):
    """Return the columns, which are emptied, as a structured array."""
    kinds = [(name, column.dtype) for name, column in columns.items()]
    table = np.empty(len(next(iter(columns.values()))), kinds)
    for name in list(columns):
        table[name] = columns.pop(name)
    return table


def _as_list(values):
    """Return values as an array of numbers, or as a list of texts."""
    return values if isinstance(values[0], str) else np.array(values)


def _namelist(text):
    """Return the groups of a namelist that the program has written: lists of values by key.

    Each key begins a line; its further lines have a deeper indentation.
    """
    groups, group, values = {}, {}, []
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


def read_table(folder: Path, name: str) -> dict[str, np.ndarray]:
    """Return the columns of one table of a folder as a dict of arrays."""
    path = pathlib.Path(folder) / name
    if not path.is_file():
        raise ResultsError(_absence(path.parent, name))
    with _reading(path):
        text = path.read_text(encoding="utf-8")
    return _columns(text, path)


def _columns(text, place):
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
    with _reading(place):
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


def _summary_groups(text, place, sweep):
    """Return &summary and &cost; a list stays a list, also with one value. sweep: the text of the
    table with the numbers of a sweep's cases, or nothing."""
    # The deck follows these groups.
    results, found, _ = text.partition("\n&cost\n")
    if not found:
        raise ResultsError(f"{place}: no group &summary and &cost")
    header = next((line for line in _lines(sweep) if not line.startswith("#")), "")
    elsewhere = header.split(","), " of the table sweep, which has the numbers of all cases"
    with _reading(place):
        groups = _namelist(results + found + text[len(results + found):].partition("\n/\n")[0])
        if "summary" not in groups:
            raise ResultsError(f"{place}: no group &summary and &cost")
        return {
            name: Entries(
                ((key, _as_list(values) if _snapin.flat_deck.is_list(key) else values[0])
                 for key, values in groups[name].items()), f"&{name} of {place}", elsewhere)
            for name in ("summary", "cost")
        }


def _absence(folder, name):
    """Return what is to be said of a file that is not there."""
    return f"no {name} in {folder}{_hint(folder / name)}"


def _hint(path):
    if not path.parent.is_dir():
        return ": there is no such folder; ./run DECK writes results/<name of the deck>"
    if (path.parent / _UNFINISHED / path.name).is_file():
        return f": the run has not finished; its files are in {path.parent / _UNFINISHED}"
    if path.with_name("sweep.csv").is_file():
        return ": a &sweep writes one row for each case in sweep.csv, and no curves"
    if path.name == "sweep.csv":
        return ": the deck has no &sweep"
    if path.name == "profiles.csv":
        return ": the deck has no &profiles group"
    if path.name == "curve.csv":
        return ": the deck has neither &loading nor &equilibrium_path, or was not run"
    return ""
