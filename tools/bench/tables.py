"""Tables of measurements: CSV files, and cells for the guide."""

import csv
import math
import os
import platform


def machine():
    return f"{platform.machine()}, {os.cpu_count()} cores, {platform.system()}"


def write(path, rows, notes):
    """Write rows (dicts with the same keys) after lines of notes."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", encoding="utf-8", newline="") as file:
        file.writelines(f"# {note}\n" for note in notes)
        table = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        table.writeheader()
        for row in rows:
            table.writerow({key: _cell(value) for key, value in row.items()})


def read(path):
    """Return the rows of a table, numbers as floats; an empty list if there is no such file."""
    lines = csv.DictReader(line for line in _lines(path) if not line.startswith("#"))
    return [{key: _value(cell) for key, cell in row.items()} for row in lines]


def notes(path):
    """Return the lines of notes of a table; none if there is no such file."""
    return [line[1:].strip() for line in _lines(path) if line.startswith("#")]


def chosen(rows, **values):
    return [row for row in rows if all(row[key] == value for key, value in values.items())]


def earlier(before, name, *keys):
    """Return a function of a row: the value of the row with the same keys in `before`, or NaN."""
    values = {tuple(row[key] for key in keys): row.get(name, math.nan) for row in before}
    return lambda row: values.get(tuple(row[key] for key in keys), math.nan)


def whole(row, *names):
    """Return counts of a row as text."""
    return [f"{row[name]:.0f}" for name in names]


def short(value):
    """Return a number in few characters, 'none' for NaN; text as it is."""
    if isinstance(value, str):
        return value
    if value != value:
        return "–"
    if value == 0:
        return "0"
    if 0.01 <= abs(value) < 1e5:
        return f"{value:.0f}" if abs(value) >= 100 else f"{value:.2g}"
    mantissa, exponent = f"{value:.1e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def _lines(path):
    return path.read_text(encoding="utf-8").splitlines() if path.is_file() else []


def _cell(value):
    return f"{value:.6g}" if isinstance(value, float) else value


def _value(cell):
    try:
        return float(cell)
    except ValueError:
        return cell
