#!/usr/bin/env python3
"""A result of a sweep: over two keys as colours with contours, over one key as a curve.

    .venv/bin/python pywrap/plots/map.py results/map --value max_tension
    .venv/bin/python pywrap/plots/map.py results/map --over big_lambda jkr_pull_off

Without `--over` the axes are the keys of the sweep. Any column of sweep.csv may be an axis, the
value, or what the value is divided by (`--per`). Cases that failed are crosses.
"""

import pathlib

import numpy as np
from drawing import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, run, title_of
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator
from matplotlib.tri import Triangulation
from snapin.results import ResultsError, read_summary, read_table

_COLOURS = (BLUE, VERMILION, GREEN, ORANGE, PURPLE, SKY, BLACK)
# Values whose largest is more than so many times the smallest are shown as logarithms.
_DECADES = 30.0
# More curves than this are a map.
_MOST_CURVES = 7


def draw_map(folder, value="max_tension", per=None, over=None):
    """Return a figure of the column `value` of the sweep in `folder`, over one or two others."""
    columns = read_table(folder, "sweep.csv")
    units = _units(folder)
    keys = [name for name in columns if "." in name]
    over = list(over or keys)
    for name in [value, *([per] if per else []), *over]:
        if name not in columns:
            raise ResultsError(f"{folder}/sweep.csv has no column {name!r}; it has "
                               + ", ".join(columns))
        if columns[name].dtype.kind == "U" and over[1:] != [name]:
            raise ResultsError(f"{name} has words, which cannot be drawn")
    shown = columns[value] / (columns[per] if per else 1)
    label = _label(value, units) if not per else f"{_words(value)} over {_words(per)}"
    good = np.isfinite(shown) & (columns["converged"] == 1)
    if not good.any():
        raise ResultsError(f"{folder}/sweep.csv: no case has the column {value!r}")
    figure = Figure(figsize=(6.4, 4.6), layout="constrained")
    axes = figure.subplots()
    if len(over) == 1:
        _draw_curves(axes, columns[over[0]], shown, good, [])
    elif len(over) == 2:
        x, y = (columns[name] for name in over)
        if y.dtype.kind == "U" or len(np.unique(y)) <= _MOST_CURVES:
            _draw_curves(axes, x, shown, good, y)
            axes.legend(title=_label(over[1], units), frameon=False, fontsize="small")
        else:
            _draw_colours(figure, axes, (x, y), shown, good, label)
            label = _label(over[1], units)
    else:
        raise ResultsError(f"this sweep has {len(over)} keys; say two of them with --over")
    axes.set(xlabel=_label(over[0], units), ylabel=label)
    figure.suptitle(title_of(folder, read_summary(folder)))
    return figure


def _draw_colours(figure, axes, places, values, good, label):
    """Draw values over two columns: a triangulation, contours, crosses where there is none."""
    x, y = (_as_drawn(place, axis) for place, axis in zip(places, (axes.xaxis, axes.yaxis)))
    good = good & np.isfinite(x) & np.isfinite(y)
    span = [np.ptp(of[good]) or 1.0 for of in (x, y)]
    # Triangles between neighbours on the picture, whatever the units.
    triangles = Triangulation(x[good] / span[0], y[good] / span[1]).triangles
    mesh = Triangulation(x[good], y[good], triangles)
    norm = LogNorm() if _wide(values[good]) else None
    colours = axes.tripcolor(mesh, values[good], shading="gouraud", cmap="viridis", norm=norm,
                             rasterized=True)
    low, high = values[good].min(), values[good].max()
    if high > low:
        levels = LogLocator(subs=(1, 2, 5)) if norm else MaxNLocator(8)
        levels = levels.tick_values(low, high)
        lines = axes.tricontour(mesh, values[good], levels=levels, colors="white", linewidths=0.7)
    axes.plot(x[~good], y[~good], "x", color=VERMILION, markersize=4)
    bar = figure.colorbar(colours, ax=axes, label=label)
    if high > low:
        bar.add_lines(lines)


def _as_drawn(place, axis):
    """Return a column as it is drawn: the logarithm of one over decades, of which negative values
    are left out, with powers of ten at the axis."""
    positive = place[place > 0]
    if 2 * len(positive) < len(place) or not _wide(positive):
        return place
    axis.set_major_locator(MaxNLocator(integer=True))
    axis.set_major_formatter(lambda power, _: f"$10^{{{power:.0f}}}$")
    return np.log10(np.where(place > 0, place, np.nan))


def _draw_curves(axes, x, values, good, parameter):
    """Draw values over one column, one curve for each value of `parameter`."""
    of_each = np.unique(parameter) if len(parameter) else [None]
    for colour, one in zip(_COLOURS, of_each):
        mine = good & (np.asarray(parameter) == one) if one is not None else good
        order = np.argsort(x[mine])
        axes.plot(x[mine][order], values[mine][order], ".-", color=colour,
                  label=None if one is None else one if isinstance(one, str) else f"{one:.3g}")
    for place in x[~good]:
        axes.axvline(place, color=GREY, linewidth=0.5, linestyle=":")
    axes.set(xscale="log" if _wide(x) else "linear",
             yscale="log" if _wide(values[good]) else "linear")
    axes.spines[["top", "right"]].set_visible(False)


def _wide(values):
    """Return whether values are positive and reach over decades."""
    return values.min() > 0 and values.max() > _DECADES * values.min()


def _units(folder):
    """Return the units of the columns by name; keys of the deck have none there."""
    text = (pathlib.Path(folder) / "sweep.csv").read_text(encoding="utf-8")
    lines = [line[2:] for line in text.splitlines() if line.startswith("# ") and " [" in line]
    return {line.split(" [")[0]: line.split(" [")[1].split("]")[0] for line in lines}


def _label(name, units):
    unit = units.get(name)
    return _words(name) + (f" [{unit}]" if unit else "")


def _words(name):
    return name if "." in name else name.replace("_", " ")


def _options(parser):
    parser.add_argument("--value", default="max_tension", help="column; default: max_tension")
    parser.add_argument("--per", help="column by which the value is divided")
    parser.add_argument("--over", nargs="+", help="one or two columns; default: the swept keys")


if __name__ == "__main__":
    run(draw_map, "map.png", "Draw a result of a sweep over the keys that were swept.", _options)
