"""Fits of many curves over the places of the curves: work of adhesion, modulus, contact height,
Tabor's parameter, verdict.

    snapin-plot curves results/map
    snapin-plot curves results/map --value fitted_reduced_modulus
    snapin-plot curves results/map --worst 5

Places are measurement.x and measurement.y of the sweep, or with `--columns` the order of the
curves. Outliers, and fits that do not describe their curve, are grey. `--worst` prints the curves
whose fits are worst, with what is said of them.
"""

import re

import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap, LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from ..arguments import SnapinError
from ..many_curves import grid_of, worst_of
from ..results import ResultsError, read_results
from .drawing import (
    BLACK, GREEN, ORANGE, SKY, VERMILION, Picture, entitle, has_fits, scale, title_of)

# The verdicts, from good to bad, with colours that colour-blind readers can distinguish.
VERDICTS = {"described": GREEN, "warned": SKY, "not_described": ORANGE, "refused": VERMILION,
            "unreadable": BLACK}
_PALE = "#BBBBBB"
# What is drawn without being asked for, as far as a sweep has it.
USUAL = ("fitted_work_of_adhesion", "fitted_reduced_modulus", "contact_height", "tabor", "verdict")
# Values farther from the median of their neighbours than this many times the distance between the
# quartiles of all are outliers, of a normal distribution one in a hundred thousand. Positive values
# whose quartiles are as far apart as this factor are compared by their logarithms, and drawn so.
_FAR, _WIDE = 3.3, 1.5
# Colours cover these parts of the values that are no outliers.
_ENDS = (0.01, 0.99)


def draw_maps(table, units=None, values=None, places=None, columns=None):
    """Return a figure with a map of each of `values`, columns of the rows of sweep.csv.

    places: x and y of each curve [m], else those in the table, else, with `columns`, the order of
    the curves, so many in a row of the map. Fits that do not describe their curve, and outliers,
    are grey.
    """
    names = list(values or [name for name in USUAL if name in table.dtype.names])
    missing = [name for name in names if name not in table.dtype.names]
    if missing:
        raise SnapinError(f"there is no column {missing[0]!r}; there are "
                          + ", ".join(table.dtype.names))
    x, y, unit = _places(table, places, columns)
    cells = _cells(x, y)
    across = min(3, len(names))
    down = -(-len(names) // across)
    figure = Figure(figsize=(3.9 * across, 3.5 * down), layout="constrained")
    panels = figure.subplots(down, across, squeeze=False).ravel()
    for panel in panels[len(names):]:
        panel.remove()
    for panel, name in zip(panels, names):
        if table[name].dtype.kind == "U":
            _draw_words(panel, cells, table[name])
        else:
            _draw_numbers(figure, panel, cells, table, name, (units or {}).get(name))
        panel.set(title=_words(name), xlabel=f"x{unit}", ylabel=f"y{unit}")
        panel.set_aspect("equal")
    return figure


def colours_of(table, name, cells=(None, None)):
    """Return which curves are in colour: those that are described, without outliers; and whether
    the values are compared by their logarithms. A hill is no outlier: where the cells are those of
    a grid, a value is compared with the eight about it."""
    values = table[name]
    good = np.isfinite(values) & np.isin(table["verdict"], ("described", "warned"))
    if not good.any():
        return good, False
    low, high = np.quantile(values[good], [0.25, 0.75])
    logarithmic = bool(values[good].min() > 0 and high > _WIDE * low)
    x = np.log(np.where(good, values, 1)) if logarithmic else values
    low, middle, high = np.quantile(x[good], [0.25, 0.5, 0.75])
    middle = _about(np.where(good, x, np.nan), cells, middle)
    with np.errstate(invalid="ignore"):
        return good & (np.abs(x - middle) <= _FAR * max(high - low, 1e-300)), logarithmic


def _about(values, cells, otherwise):
    """Return for each curve the median of the values about it on a grid."""
    if cells[0] is None:
        return np.full(len(values), otherwise)
    shape, order = cells[1]
    wide = np.pad(values[order].reshape(shape), 1, constant_values=np.nan)
    near = np.stack([wide[1 + j:1 + j + shape[0], 1 + i:1 + i + shape[1]]
                     for j in (-1, 0, 1) for i in (-1, 0, 1) if i or j])
    near = np.where(np.isfinite(near).any(axis=0), near, otherwise)
    found = np.empty(len(values))
    found[order] = np.nanmedian(near, axis=0).ravel()
    return found


def _places(table, places, columns):
    """Return x, y of the curves and the unit of the axes."""
    if places is not None:
        x, y = np.asarray(places, float).T
    elif {"measurement.x", "measurement.y"} <= set(table.dtype.names):
        x, y = table["measurement.x"], table["measurement.y"]
    elif columns:
        number = np.arange(len(table))
        return number % columns, number // columns, ""
    else:
        raise SnapinError("the curves have no places: sweep measurement.x and measurement.y too, "
                          "or say how many curves are in a row of the map")
    span = max(np.ptp(x), np.ptp(y))
    prefix, name = (1e-6, "µm") if span > 2e-7 else (1e-9, "nm")
    return x / prefix, y / prefix, f" [{name}]"


def _cells(x, y):
    """Return the corners of the cells and the place of each curve in them, or its own place if the
    places are not those of a grid."""
    shape, order = grid_of((x, y))
    if not shape:
        return None, (x, y)
    return (_edges(np.unique(x)), _edges(np.unique(y))), (shape, order)


def _edges(centres):
    """Return the ends of the cells about their centres."""
    if len(centres) < 2:
        return np.array([centres[0] - 0.5, centres[0] + 0.5])
    inner = (centres[1:] + centres[:-1]) / 2
    return np.concatenate([[2 * centres[0] - inner[0]], inner, [2 * centres[-1] - inner[-1]]])


def _show(panel, cells, values, **colours):
    """Draw values, where they are not NaN, as cells or as points."""
    edges, where = cells
    if edges is None:
        there = np.isfinite(values)
        size = max(4, 4000 / len(values))
        return panel.scatter(where[0][there], where[1][there], c=values[there], s=size, marker="s",
                             **colours)
    shape, order = where
    return panel.pcolormesh(*edges, np.ma.masked_invalid(values[order].reshape(shape)),
                            rasterized=True, **colours)


def _draw_numbers(figure, panel, cells, table, name, unit):
    good, logarithmic = colours_of(table, name, cells)
    grey = np.where(good, np.nan, 0.0)
    if not good.all():
        _show(panel, cells, grey, cmap=ListedColormap([_PALE]), vmin=0, vmax=1)
    if not good.any():
        return
    low, high = np.quantile(table[name][good], _ENDS)
    factor, unit = _scale(max(abs(low), abs(high)), unit)
    norm = (LogNorm if logarithmic else Normalize)(low / factor, high / factor)
    shown = _show(panel, cells, np.where(good, table[name] / factor, np.nan), norm=norm,
                  cmap="viridis")
    bar = figure.colorbar(shown, ax=panel, extend="both")
    if unit:
        bar.set_label(unit)
    if not good.all():
        panel.annotate(f"grey: {np.count_nonzero(~good)} of {len(good)}", (0, -0.02),
                       xycoords="axes fraction", va="top", fontsize="x-small",
                       annotation_clip=False, textcoords="offset points", xytext=(0, -22))


def _scale(largest, unit):
    """Return the factor and the name of a prefixed unit in which a number is short."""
    if not unit or not re.fullmatch(r"(J/m\^2|Pa|m|N|J)", unit):
        return 1.0, unit
    factor, name = scale([largest], unit)
    return factor, name.replace("^2", "²")


def _draw_words(panel, cells, words):
    """Draw the verdicts with a legend that counts them."""
    names = [name for name in VERDICTS if name in words] + sorted(set(words) - set(VERDICTS))
    colours = [VERDICTS.get(name, _PALE) for name in names]
    number = np.array([float(names.index(word)) for word in words])
    _show(panel, cells, number, cmap=ListedColormap(colours),
          norm=BoundaryNorm(np.arange(len(names) + 1) - 0.5, len(names)))
    panel.legend(handles=[
        Patch(color=colour, label=f"{_words(name)}: {np.count_nonzero(words == name)}")
        for name, colour in zip(names, colours)], fontsize="x-small", loc="upper center",
        bbox_to_anchor=(0.5, -0.2), frameon=False, ncols=2)


def _words(name):
    return "Tabor's parameter" if name == "tabor" else name.replace("fitted_", "").replace("_", " ")


def draw_curve_map(folder, value=(), columns=None, worst=0):
    """Return a figure of maps of the sweep in `folder`; print the `worst` curves."""
    result = read_results(folder)
    table = result.tables.get("sweep")
    if table is None or "verdict" not in table.dtype.names:
        raise ResultsError(f"{folder} has no fits of many curves; map.py draws other sweeps")
    for i in worst_of(table, worst):
        row = dict(zip(table.dtype.names, table[i].tolist()))
        keys = ", ".join(f"{name} = {row[name]}" for name in row
                         if name in ("measurement.file", "measurement.curve"))
        print(f"curve {i + 1}: {keys}: {row['verdict']}; {row['failure'] or row['warning']}")
    try:
        figure = draw_maps(table, result.units["sweep"], list(value) or None, columns=columns)
    except SnapinError as problem:
        raise ResultsError(f"{folder}: {problem}") from problem
    entitle(figure, title_of(folder, {**result.summary, "converged": True}))
    return figure


def _options(parser):
    parser.add_argument("--value", nargs="+", default=(), help="columns of sweep.csv")
    parser.add_argument("--columns", type=int, help="number of curves in a row of the map")
    parser.add_argument("--worst", type=int, default=0, help="number of worst curves to print")


PICTURE = Picture(
    "curves", draw_curve_map, "curve_map.png", "Draw the fits of many curves over their places.",
    has_fits, _options)
