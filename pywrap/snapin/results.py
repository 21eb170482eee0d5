"""The reader of the results of a run."""

import contextlib
import os
import pathlib
import stat
import time
from typing import Any, Optional

import numpy as np

from .arguments import Path, folder_path
from .result_text import (
    Entries, ResultsError, columns_in, fitted_groups, reading, structured, summary_groups, units_of)

# How the program's tables and its fits begin.
_HEAD, _FIT_HEAD = b"# title:", b"! A fit by snapin"
# Where a run that has not ended keeps its files.
_UNFINISHED = "unfinished"
# Longest time [s] for which a set of results that is being replaced is waited for, and a pause.
_PATIENCE, _PAUSE = 5.0, 0.005


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
            with reading(self.folder / name):
                self.texts[name] = found.pop(name).decode()
        return whole

    def text(self, name: str) -> str:
        """Return the text of a file."""
        if name not in self.texts:
            raise ResultsError(_absence(self.folder, name))
        return self.texts[name]

    def table(self, name: str) -> Entries:
        """Return the columns of a table as `Entries` of arrays, text or numbers."""
        return columns_in(self.text(name), self.folder / name)

    def summary(self) -> Entries:
        """Return the group &summary of summary.nml as `Entries`."""
        return summary_groups(self.text("summary.nml"), self.folder / "summary.nml",
                               self.texts.get("sweep.csv", ""))["summary"]

    def fit(self) -> dict[str, Any]:
        """Return the group &fit of fit.nml, lists and arrays, as `Entries`."""
        return fitted_groups(self.text("fit.nml"), self.folder / "fit.nml")["fit"]


def _tables_in(folder):
    """Return the contents of tables and of a fit; other files may be there, such as a curve."""
    found = {path.name: path.read_bytes() for path in sorted(folder.glob("*.*"))
             if path.is_file() and (path.suffix == ".csv" or path.name == "fit.nml")}
    return {name: text for name, text in found.items()
            if text.startswith(_HEAD if name.endswith(".csv") else _FIT_HEAD)}


def result_of(files: dict[str, str], place: Path) -> Result:
    """Return the `Result` in texts of files by name, which is emptied; `place` names them in
    messages."""
    groups = summary_groups(files["summary.nml"], f"{place}/summary.nml",
                             files.get("sweep.csv", ""))
    units = {name.removesuffix(".csv"): units_of(text) for name, text in files.items()
             if name.endswith(".csv")}
    tables = {
        name.removesuffix(".csv"): structured(columns_in(files.pop(name), f"{place}/{name}"))
        for name in sorted(files)
        if name.endswith(".csv")
    }
    return Result(tables, groups["summary"], groups["cost"],
                  fitted_groups(files.get("fit.nml", ""), f"{place}/fit.nml"), units)


def read_table(folder: Path, name: str) -> dict[str, np.ndarray]:
    """Return the columns of one table of a folder as a dict of arrays."""
    path = pathlib.Path(folder) / name
    if not path.is_file():
        raise ResultsError(_absence(path.parent, name))
    with reading(path):
        text = path.read_text(encoding="utf-8")
    return columns_in(text, path)


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
