"""Force curves in files of instruments (JPK, Asylum, NT-MDT, Optics11, AFM Workshop, HDF5 and
others) as tables for &measurement: position of the base [m], force [N], and segment (0 approach,
1 retract).

    snapin-convert CURVE.jpk-force [-o DIR] [--spring-constant 0.05] [--sensitivity 5e-8]

The package afmformats reads the files; only this module needs it: pip install afmformats. A map
gives a table for each of its curves.
"""

import argparse
import contextlib
import logging
import os
import pathlib
import sys
import tempfile
import warnings
import zipfile
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .arguments import Path
from .command import as_command

# Columns of afmformats that may be the position of the base, the better one first.
_HEIGHTS = ("height (measured)", "height (piezo)")
# A base rests where it travels less than this part of its range, as in a pause at constant force.
_RESTING = 0.1
# A base moves in every part of the approach; what moves in less than half of it, where the force
# changes, is the position of the tip.
_PARTS = 20
# Smallest number of rows of an approach or a retract, which is that of &measurement.
_FEWEST = 20
# An approach of so many rows has ended at once: what follows is the retract, and not the approach
# after a pause.
_AT_ONCE = 4
_MARK = "# snapin-convert: "


class ConvertError(ValueError):
    """What is missing in a file, in one line."""


def _rows(count):
    return f"{count} row" + ("" if count == 1 else "s")


def moves_throughout(height: np.ndarray) -> bool:
    """Whether a position moves in more than half of the parts of an approach."""
    ends = height[np.linspace(0, len(height) - 1, _PARTS + 1).astype(int)]
    return np.median(np.abs(np.diff(ends))) > 0.01 * np.ptp(height)


def segments_of(height: ArrayLike, labels: ArrayLike) -> NDArray[np.int_]:
    """Return for each row 0 (approach), 1 (retract) or -1 (pause), by what the base does.

    `labels` divide the rows into segments. If all are equal, the base turns where it is farthest
    from where it began. A base that moves one way only approaches, but in a segment that
    follows an approach that ended at once. Raises ConvertError for too few rows, and
    for a curve that goes to and fro more than once.
    """
    height, labels = np.asarray(height, float), np.asarray(labels)
    if len(height) < _FEWEST:
        raise ConvertError(f"{_rows(len(height))}: too few for a curve")
    if np.ptp(height) == 0:
        raise ConvertError("the base does not move")
    if (labels == labels[0]).all():
        labels = np.arange(len(height)) > np.argmax(np.abs(height - height[0]))
    ends = np.r_[0, np.flatnonzero(labels[1:] != labels[:-1]) + 1, len(labels)]
    kind = np.full(len(height), -1)
    found: list[int] = []
    direction = 0
    for first, last in zip(ends[:-1], ends[1:]):
        travel = height[last - 1] - height[first]
        if abs(travel) <= _RESTING * np.ptp(height):
            continue
        direction = direction or np.sign(travel)
        kind[first:last] = 0 if travel * direction > 0 else 1
        if found[-1:] != [kind[first]]:
            found.append(kind[first])
    if not found:
        raise ConvertError("the base rests in every segment")
    if found not in ([0], [0, 1]):
        raise ConvertError(f"the base goes to and fro in {len(found)} segments; a curve has one "
                           "approach and one retract")
    if found == [0] and 0 < np.argmax(kind == 0) <= _AT_ONCE:
        kind[kind == 0] = 1
    return kind


def base_of(columns, spring_constant):
    """Return the position of the base and where it comes from.

    A height that stands still until the bodies touch is that of the tip; the base is then the other
    height, or the sum of tip and deflection.
    """
    heights = [name for name in _HEIGHTS if name in columns]
    if not heights:
        raise ConvertError("no height (measured) or height (piezo); the file has "
                           + ", ".join(columns))
    for name in heights:
        height = np.asarray(columns[name], float)
        kind = segments_of(height, columns["segment"])
        if moves_throughout(height[kind == kind[kind >= 0].min()]):
            return height, name
    tip = np.asarray(columns[heights[0]], float)
    if not spring_constant:
        raise ConvertError(f"{heights[0]} stands still until the bodies touch, so it is the "
                           "position of the tip; that of the base needs --spring-constant")
    deflection = np.asarray(columns["force"], float) / spring_constant
    # The base is farther along than the tip.
    sign = 1 if np.polyfit(deflection, tip, 1)[0] > 0 else -1
    return tip + sign * deflection, f"{heights[0]} and the deflection together"


def table_of(columns: Mapping[str, Any], name: str = "curve",
             spring_constant: Optional[float] = None,
             sensitivity: Optional[float] = None) -> tuple[str, str]:
    """Return the text of a curve's table, and a line about it.

    columns: arrays by afmformats' names: "force" [N], "segment", and heights [m]. Rows of pauses
    and without a value are left out. Raises ConvertError where something is missing.
    """
    if "force" not in columns:
        raise ConvertError("no force; the file has " + ", ".join(columns))
    force = np.asarray(columns["force"], float)
    labels = np.asarray(columns["segment"]) if "segment" in columns else np.zeros(len(force))
    whole = np.isfinite(force)
    for height in _HEIGHTS:
        if height in columns:
            whole &= np.isfinite(np.asarray(columns[height], float))
    rows = {key: np.asarray(columns[key])[whole] for key in columns if key in (*_HEIGHTS, "force")}
    rows["segment"] = labels[whole]
    base, origin = base_of(rows, spring_constant)
    kind = segments_of(base, rows["segment"])
    counts = [np.count_nonzero(kind == way) for way in (0, 1, -1)]
    told = f"{_rows(counts[0])} of the approach, {counts[1]} of the retract; position: {origin}"
    if counts[2]:
        told += f"; {_rows(counts[2])} of pauses left out"
    if not whole.all():
        told += f"; {_rows(np.count_nonzero(~whole))} without a value left out"
    lines = [f"{_MARK}{name}; position of the base: {origin}",
             f"# spring_constant = {f'{spring_constant:.8g}' if spring_constant else 'unknown'}"]
    if sensitivity:
        lines.append(f"# sensitivity of the detector = {sensitivity} m/V")
    lines.append("z,force,segment")
    for way in (0, 1):
        lines += [f"{z:.9e},{f:.9e},{way}"
                  for z, f in zip(base[kind == way], rows["force"][kind == way])]
    return "\n".join(lines) + "\n", told


def load_curves(path: Path, spring_constant: Optional[float] = None,
                sensitivity: Optional[float] = None) -> list[tuple[dict[str, Any], dict[str, Any]]]:
    """Return the curves of an instrument's file as a list of (columns, metadata).

    spring_constant [N/m], sensitivity [m/V]: for files that have none. Raises ConvertError with one
    line that says what is wrong.
    """
    try:
        import afmformats
    except ImportError:
        raise ConvertError(f"afmformats is missing: {sys.executable} -m pip install afmformats"
                           ) from None
    if not os.path.exists(path):
        raise ConvertError("no such file")
    override = {"spring constant": spring_constant, "sensitivity": sensitivity}
    override = {key: value for key, value in override.items() if value is not None}
    with _quiet():
        try:
            return _read(path, afmformats, override)
        except ConvertError as problem:
            # What an archive lacks, its members lack.
            inside = [] if "give --" in str(problem) else _members(path, afmformats, override)
            if inside:
                return inside
            raise


def _read(path, afmformats, override):
    """The curves of one file."""
    # Errors of afmformats are of any kind, some of no other class than BaseException.
    try:
        return [_curve(item) for item in afmformats.load_data(path, meta_override=override)]
    except (KeyboardInterrupt, SystemExit):
        raise
    except BaseException as problem:
        raise ConvertError(_reason(problem)) from None


def _members(path, afmformats, override):
    """The curves of files in an archive that afmformats does not know as such."""
    if not zipfile.is_zipfile(path):
        return []
    found = []
    with tempfile.TemporaryDirectory() as folder, zipfile.ZipFile(path) as archive:
        for name in sorted(archive.namelist()):
            if name.endswith("/"):
                continue
            place = pathlib.Path(folder) / pathlib.PurePosixPath(name).name
            place.write_bytes(archive.read(name))
            with contextlib.suppress(ConvertError):
                found += _read(place, afmformats, override)
    return found


def _curve(item):
    return {name: np.asarray(item[name]) for name in item.columns}, dict(item.metadata)


@contextlib.contextmanager
def _quiet():
    """No warnings and tracebacks of the library, whose errors become one line."""
    logging.disable(logging.CRITICAL)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    finally:
        logging.disable(logging.NOTSET)


def _reason(problem):
    """An error of afmformats in words."""
    text = " ".join(str(problem).split()) or type(problem).__name__
    if isinstance(problem, UnicodeError):
        return "afmformats cannot read it: it is no text"
    missing = [f"--{word.replace(' ', '-')}" for word in ("spring constant", "sensitivity")
               if "pecify" in text + "pecify" * ("Missing meta" in text) and word in text]
    if missing:
        return f"the file has not everything; give {' and '.join(missing)}"
    return text


def convert(path: Path, folder: Path, number: Optional[int] = None,
            spring_constant: Optional[float] = None, sensitivity: Optional[float] = None,
            say: Callable[[str], object] = print) -> list[pathlib.Path]:
    """Write the tables of a file's curves into `folder`; return their paths.

    number: one curve of a map, counted from 0; else all. `say` gets a line about each file. Raises
    ConvertError if no curve can be written, or a file would be replaced that this did not write.
    """
    path = pathlib.Path(path)
    curves = load_curves(path, spring_constant, sensitivity)
    if not curves:
        raise ConvertError("no force curves")
    chosen = range(len(curves)) if number is None else [number]
    if number is not None and not 0 <= number < len(curves):
        raise ConvertError(f"--number {number}: the file has {len(curves)} curves, the first is 0")
    stem = path.stem
    folder = pathlib.Path(folder)
    written, refused = [], []
    for i in chosen:
        number_text = "" if len(curves) == 1 else f"_{i:0{len(str(len(curves) - 1))}d}"
        columns, metadata = curves[i]
        spring = spring_constant or metadata.get("spring constant")
        try:
            text, told = table_of(columns, path.name, spring, metadata.get("sensitivity"))
        except ConvertError as problem:
            refused.append(f"curve {i}: {problem}")
            continue
        target = folder / f"{stem}{number_text}.csv"
        mark = f"{_MARK}{path.name};".encode()
        if target.exists() and not target.read_bytes().startswith(mark):
            raise ConvertError(f"{target} is not from this file; move it, or choose a folder "
                               "with -o")
        folder.mkdir(parents=True, exist_ok=True)
        target.write_text(text, encoding="utf-8")
        written.append(target)
        say(f"{target}: {told}")
    if refused and not written:
        raise ConvertError(refused[0].split(": ", 1)[1] if len(curves) == 1 else refused[0])
    for line in refused:
        say(f"left out: {line}")
    if len(curves) > 1:
        say(f"{len(written)} of {len(curves)} curves")
    spring = spring_constant or curves[chosen[0]][1].get("spring constant")
    say(f"&measurement file = '{written[0].name}', columns = 'z', 'force', 'segment', "
        f"spring_constant = {f'{spring:.8g}' if spring else '?'} /")
    if not spring:
        say("the spring constant is not in the file: write it in place of the question mark")
    return written


@as_command
def main(arguments: Optional[Sequence[str]] = None) -> int:
    """The command snapin-convert; ends with 1 and one line where a file cannot be converted."""
    parser = argparse.ArgumentParser(
        prog="snapin-convert", description=__doc__.split("\n\n")[0].replace("\n", " "))
    parser.add_argument("file", nargs="+", help="files of an instrument")
    parser.add_argument("-o", "--out", default=".", metavar="DIR",
                        help="folder of the tables; default: this folder")
    parser.add_argument("--number", type=int, help="one curve of a map, counted from 0")
    parser.add_argument("--spring-constant", type=_positive, metavar="K",
                        help="of the cantilever [N/m], where the file has none")
    parser.add_argument("--sensitivity", type=_positive, metavar="S",
                        help="deflection for one volt [m/V], where the file has none")
    options = parser.parse_args(arguments)
    status = 0
    for file in options.file:
        try:
            convert(file, options.out, options.number, options.spring_constant,
                    options.sensitivity)
        except (ConvertError, OSError) as problem:
            print(f"snapin-convert: {file}: {problem}", file=sys.stderr)
            status = 1
    return status


def _positive(text):
    value = float(text)
    if not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text} is not positive")
    return value


if __name__ == "__main__":
    sys.exit(main())
