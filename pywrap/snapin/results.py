"""Results of a run, read from its folder: the one reader of what the program writes."""

import csv
import pathlib

import _snapin
import f90nml
import numpy as np

from .arguments import SnapinError

_TEXT_COLUMNS = ("branch", "direction", "theory", "quantity", "parameter")


class ResultsError(SnapinError):
    """A file of results is missing or is not what it should be; the message says which."""


class Result:
    """What a run has found, SI.

    Each table is an attribute, a structured array: `curve`, `profiles`, `approximations`,
    `classical`, `sweep`, whatever the deck asked for. `summary` and `cost` are dictionaries of the
    groups of summary.nml; lists of numbers in them are arrays. `converged` says that every
    state was found.
    `fitted` has the groups of fit.nml by name, each a dictionary whose values are arrays; of a deck
    without &fit it is empty.
    """

    def __init__(self, tables, summary, cost, fitted=None):
        self.tables, self.summary, self.cost = tables, summary, cost
        self.fitted = fitted or {}

    @property
    def converged(self):
        """Whether every state was found."""
        return self.summary["converged"]

    def __getattr__(self, name):
        tables = self.__dict__.get("tables", {})
        if name not in tables:
            raise AttributeError(f"no table {name!r}; this run has {', '.join(tables) or 'none'}")
        return tables[name]

    def __dir__(self):
        return [*super().__dir__(), *self.tables]

    def __repr__(self):
        return f"<Result: {', '.join([*self.tables, 'summary', 'cost'])}>"


def read_results(folder):
    """Return the `Result` in a folder that the program has written."""
    groups = _read_groups(folder)
    tables = {
        path.stem: _structured(read_table(folder, path.name))
        for path in sorted(pathlib.Path(folder).glob("*.csv"))
        if path.read_bytes()[:1] == b"#"
    }
    return Result(
        tables, _with_lists(groups["summary"]), _with_lists(groups["cost"]), _read_fitted(folder)
    )


def _read_fitted(folder):
    """Return the groups of fit.nml, the correlations as matrices; none where there is no fit."""
    path = pathlib.Path(folder) / "fit.nml"
    if not path.is_file():
        return {}
    groups = {
        name: {key: _as_list(value) for key, value in group.items() if key != "title"}
        for name, group in f90nml.read(path).items()
    }
    for group in groups.values():
        group["correlation"] = group["correlation"].reshape(2 * (len(group["parameters"]),))
    return groups


def _structured(columns):
    """Return columns as one structured array."""
    kinds = [(name, column.dtype) for name, column in columns.items()]
    table = np.empty(len(next(iter(columns.values()))), kinds)
    for name, column in columns.items():
        table[name] = column
    return table


def _with_lists(group):
    """Return a group as a dict; f90nml has a list of one value bare."""
    return {
        key: _as_list(value) if _snapin.flat_deck.is_list(key) else value
        for key, value in group.items()
    }


def _as_list(value):
    """Return one value or several as an array of numbers, or as a list of texts."""
    values = value if isinstance(value, list) else [value]
    return values if isinstance(values[0], str) else np.array(values)


def read_table(folder, name):
    """Return the columns of a table as a dict of arrays, text for `_TEXT_COLUMNS`."""
    path = _path_of(folder, name)
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    if not rows:
        raise ResultsError(f"{path}: no header line")
    header, rows = rows[0], rows[1:]
    for row in rows:
        if len(row) != len(header):
            raise ResultsError(f"{path}: {len(row)} cells in a row, {len(header)} in the header")
    try:
        return {
            column: np.array([row[i] for row in rows], str if column in _TEXT_COLUMNS else float)
            for i, column in enumerate(header)
        }
    except ValueError as problem:
        raise ResultsError(f"{path}: {problem}") from problem


def read_summary(folder):
    """Return the group &summary of summary.nml as a dict, as f90nml reads it."""
    return _read_groups(folder)["summary"]


def _read_groups(folder):
    """Return the groups of summary.nml."""
    path = _path_of(folder, "summary.nml")
    groups = f90nml.read(path)
    if "summary" not in groups:
        raise ResultsError(f"{path}: no group &summary")
    return groups


def _path_of(folder, name):
    """Return the path of a file of complete results."""
    path = pathlib.Path(folder) / name
    if path.with_name("INCOMPLETE.txt").exists():
        raise ResultsError(f"files in {folder} may not belong together: see INCOMPLETE.txt there")
    if not path.is_file():
        raise ResultsError(f"no {name} in {folder}{_hint(path)}")
    return path


def _hint(path):
    if not path.parent.is_dir():
        return ": there is no such folder; ./run DECK writes results/<name of the deck>"
    if path.with_name(path.name + ".partial").is_file():
        return ": the run has not finished"
    if path.with_name("sweep.csv").is_file():
        return ": a &sweep keeps one row a case in sweep.csv, and no curves"
    if path.name == "profiles.csv":
        return ": the deck has no &profiles group"
    if path.name == "curve.csv":
        return ": the deck has neither &loading nor &equilibrium_path, or was not run"
    return ""
