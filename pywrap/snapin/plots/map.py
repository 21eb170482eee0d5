"""A result of a sweep: over two keys as colours with contours, over one key as curves.

    snapin-plot map results/map --value max_tension
    snapin-plot map results/map --over bodies.stiffness
    snapin-plot map results/map --over big_lambda jkr_pull_off

Without `--over` the axes are the keys of the sweep. Any column of sweep.csv may be an axis, the
value, or the divisor of the value (`--per`). Over one key there is a curve for every value of the
other keys. `--where KEY=VALUE` keeps the cases nearest to a value of a key. Failed cases are
crosses; cases without the value are dots. Where a largest tension is that of the first or last row
of a branch, it is no pull-off: such cases are open circles, outside colours and curves.
"""

import re

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator
from matplotlib.tri import Triangulation

from ..result_text import units_of
from ..results import ResultFiles, ResultsError
from .drawing import COLOURS, GREY, VERMILION, Picture, entitle, has_fits, title_of

# The field's words for columns.
_TERMS = {
    "max_tension": "pull-off force", "jkr_pull_off": "JKR's pull-off force",
    "dmt_pull_off": "DMT's pull-off force", "maugis_pull_off": "Maugis-Dugdale pull-off force",
    "tabor": r"Tabor's parameter $\mu$", "sigma": r"strength of adhesion $\sigma$",
    "regime_maugis_lambda": r"Maugis' parameter $\lambda$",
    "maugis_lambda": r"Maugis' parameter $\lambda$",
    "regime_load_number": r"load number $F/\pi w R$",
    "regime_worst_hertz": "largest error of Hertz theory",
    "regime_worst_jkr": "largest error of JKR theory",
    "regime_worst_dmt": "largest error of DMT theory",
    "regime_worst_maugis": "largest error of Maugis-Dugdale theory",
    "jump_in_h0": "approach $h_0$ at snap-in", "jump_out_h0": "approach $h_0$ at snap-off",
    "jump_in_load": "load at snap-in", "jump_out_load": "load at snap-off",
    "energy_lost": "energy lost in a cycle", "rest_gap": "equilibrium separation",
    "layer.thickness": "thickness of the layer", "double_layer.debye_length": "Debye length",
    "bodies.radius": "radius $R$", "bodies.reduced_modulus": "reduced modulus $E^*$",
    "bodies.stiffness": "plane-strain modulus $E'$", "force.hamaker": "Hamaker constant",
    "force.work_of_adhesion": "work of adhesion $w$"}
# Cases whose largest tension is that of an end of a branch.
_NO_PULL_OFF = {"color": GREY, "marker": "o", "markersize": 4, "fillstyle": "none",
                "linestyle": "none",
                "label": "tension largest in the first or last row: no pull-off"}
# Values with a larger ratio of the largest to the smallest are shown on a logarithmic scale.
_DECADES = 30.0
# With more values of the second column a map is drawn, not curves; as many curves have labels.
_MOST_CURVES = 7
# The share of the positive values of a column that may be below the begin of its logarithmic axis,
# if others are not positive: a few values near zero must not take decades of the picture.
_BELOW = 0.02
# A triangle with less than this, twice its area over that of the picture, is flat.
_FLAT = 1e-12


def draw_map(folder, value="max_tension", per=None, over=None, where=()):
    """Return a figure of the column `value` of the sweep in `folder`, over one or two others."""
    files = ResultFiles(folder)
    columns = files.table("sweep.csv")
    # Keys with words come last, since words cannot be an axis.
    keys = sorted((name for name in columns if "." in name),
                  key=lambda name: _has_words(columns[name]))
    over = list(over or keys[:2])
    for name in [value, *([per] if per else []), *over]:
        if name not in columns:
            raise ResultsError(f"{folder}/sweep.csv has no column {name!r}; it has "
                               + ", ".join(columns))
        if _has_words(columns[name]) and over[1:] != [name]:
            raise ResultsError(f"{name} has words and cannot be drawn")
    if len(over) > 2:
        raise ResultsError("--over takes one or two columns")
    columns = _chosen(columns, keys, where)
    shown = columns[value] / (columns[per] if per else 1)
    units = units_of(files.text("sweep.csv"))
    label = _label(value, units) if not per else f"{_words(value)} over {_words(per)}"
    failed = columns["converged"] != 1
    at_end = np.isfinite(shown) & ~failed & _at_end(columns, [value, per, *over])
    good = np.isfinite(shown) & ~failed & ~at_end
    if not good.any():
        names = " and ".join(f"the column {name!r}" for name in (value, per) if name)
        why = "; tensions are largest in first or last rows, and no pull-offs" * int(at_end.any())
        raise ResultsError(f"{folder}/sweep.csv: no case has {names}{why}")
    others = [name for name in keys
              if {*over} <= {*keys} and name not in over and len(np.unique(columns[name])) > 1]
    if len(over) == 2 and (_has_words(columns[over[1]])
                           or len(np.unique(columns[over[1]])) <= _MOST_CURVES):
        others.insert(0, over.pop())
    figure = Figure(figsize=(6.4, 4.6), layout="constrained")
    axes = figure.subplots()
    if len(over) == 1:
        _draw_curves(axes, columns[over[0]], shown, good, [columns[name] for name in others],
                     joined=over[0] in keys, at_end=at_end)
        if others or at_end.any():
            axes.legend(title=", ".join(_label(name, units) for name in others) or None,
                        frameon=False, fontsize="small")
    elif others:
        raise ResultsError(f"{', '.join(others)} was swept too: choose with --where "
                           f"{others[0]}=VALUE")
    else:
        varied = [columns[name] for name in keys if len(np.unique(columns[name])) > 1]
        _draw_colours(figure, axes, [columns[name] for name in over], varied, shown, good, failed,
                      at_end, label)
        label = _label(over[1], units)
    axes.set(xlabel=_label(over[0], units), ylabel=label)
    entitle(figure, title_of(folder, files.summary()))
    return figure


def _at_end(columns, names):
    """Return in which cases one of the columns `names` is a largest tension, or its h0, that is of
    the first or last row of a branch."""
    found = np.zeros(len(columns["converged"]), bool)
    for name in filter(None, names):
        said = re.sub(r"^((?:unload_)?max_tension)(?:_h0)?(_\d+)?$", r"\1_at_end\2", name)
        if said != name and said in columns:
            found |= columns[said] == 1
    return found


def _has_words(column):
    return column.dtype.kind == "U"


def _chosen(columns, keys, where):
    """Return the columns with the cases nearest to the value of each "KEY=VALUE"."""
    for condition in where:
        key, _, wanted = condition.partition("=")
        if key not in keys:
            raise ResultsError(f"{condition!r} is not KEY=VALUE; keys are {', '.join(keys)}")
        of_key = columns[key]
        if _has_words(of_key):
            chosen = of_key == wanted
        else:
            try:
                distance = np.abs(of_key - float(wanted))
            except ValueError as problem:
                raise ResultsError(f"{condition!r}: {problem}") from problem
            chosen = distance == distance.min()
        if not chosen.any():
            raise ResultsError(f"{condition!r}: the sweep has " + ", ".join(np.unique(of_key)))
        columns = {name: column[chosen] for name, column in columns.items()}
    return columns


def _draw_colours(figure, axes, places, keys, values, good, failed, at_end, label):
    """Draw values over two columns: colours, contours, and marks of cases without a value."""
    lowest = [_lowest(place) for place in places]
    x, y = map(_as_drawn, places, lowest)
    for begin, axis in zip(lowest, (axes.xaxis, axes.yaxis)):
        if begin is not None:
            axis.set_major_locator(MaxNLocator(integer=True))
            axis.set_major_formatter(lambda power, _: f"$10^{{{power:.0f}}}$")
    there = np.isfinite(x) & np.isfinite(y)
    x, y = (np.where(there, of, of[there].mean()) for of in (x, y))
    triangles = _triangles(x / (np.ptp(x) or 1.0), y / (np.ptp(y) or 1.0), there, keys)
    # A triangle with a corner without value or place is left out.
    placed = good & np.isfinite(places).all(axis=0)
    triangles = triangles[placed[triangles].all(axis=1)]
    points = np.where(placed, np.stack([*places, values]), np.stack([*places, values])[
        :, placed].mean(axis=1, keepdims=True)).T
    for column, begin in enumerate(lowest):
        if begin is not None:
            triangles, points = _cut(triangles, points, column, begin)
    if not len(triangles):
        triangles = np.full((1, 3), np.flatnonzero(placed)[0])
    used, triangles = np.unique(triangles, return_inverse=True)
    points, triangles = points[used], triangles.reshape(-1, 3)
    mesh = Triangulation(*(_as_drawn(np.maximum(of, begin or -np.inf), begin)
                           for of, begin in zip(points.T, lowest)), triangles)
    filled = points[:, 2]
    good, failed, at_end = good & there, failed & there, at_end & there
    nothing = there & ~good & ~failed & ~at_end
    low, high = values[good].min(), values[good].max()
    norm = LogNorm(low, high) if _wide(values[good]) else Normalize(low, high)
    colours = axes.tripcolor(mesh, filled, shading="gouraud", cmap="viridis", norm=norm,
                             rasterized=True)
    bar = figure.colorbar(colours, ax=axes, label=label)
    if high > low:
        levels = LogLocator(subs=(1, 2, 5)) if _wide(values[good]) else MaxNLocator(8)
        levels = levels.tick_values(low, high)
        bar.add_lines(axes.tricontour(mesh, filled, levels=levels, colors="white", linewidths=0.7))
    axes.plot(x[failed], y[failed], "x", color=VERMILION, markersize=4)
    axes.plot(x[nothing], y[nothing], ".", color=GREY, markersize=2)
    if at_end.any():
        axes.plot(x[at_end], y[at_end], **_NO_PULL_OFF)
        figure.legend(loc="outside lower center", frameon=False, fontsize="small")


def _triangles(x, y, there, keys):
    """Return the corners of triangles between neighbours: cases with neighbouring values, in a
    sweep of all combinations of two keys, or else cases that are neighbours in the picture."""
    sizes = [len(np.unique(key)) for key in keys]
    if len(keys) == 2 and sizes[0] * sizes[1] == len(x) == len(set(zip(*keys))):
        at = np.lexsort(keys[::-1]).reshape(sizes)
        a, b, c, d = at[:-1, :-1], at[1:, :-1], at[:-1, 1:], at[1:, 1:]
        found = np.concatenate([np.stack(corners, -1).reshape(-1, 3)
                                for corners in ((a, b, c), (d, c, b))])
    else:
        try:
            found = np.flatnonzero(there)[Triangulation(x[there], y[there]).triangles]
        except (RuntimeError, ValueError):
            found = np.zeros((1, 3), int)
    sides = [of[found[:, 1:]] - of[found[:, :1]] for of in (x, y)]
    if not (abs(sides[0][:, 0] * sides[1][:, 1] - sides[0][:, 1] * sides[1][:, 0]) > _FLAT).any():
        raise ResultsError("the cases lie on one line of these columns; give one to --over")
    return found


def _cut(triangles, points, column, begin):
    """Return triangles without their parts below the begin of an axis, and points with those where
    their sides pass it, interpolated between two neighbours."""
    above = points[:, column] >= begin
    count = above[triangles].sum(axis=1)
    kept, new = [triangles[count == 3]], []
    for corners in triangles[(count == 1) | (count == 2)]:
        polygon = []
        for one, other in zip(corners, np.roll(corners, -1)):
            if above[one]:
                polygon.append(one)
            if above[one] != above[other]:
                step = points[other] - points[one]
                polygon.append(len(points) + len(new))
                new.append(points[one] + (begin - points[one, column]) / step[column] * step)
        kept.append(np.array([[polygon[0], *pair] for pair in zip(polygon[1:], polygon[2:])]))
    return np.concatenate(kept), np.vstack([points, *new])


def _lowest(place):
    """Return where the logarithmic axis of a column begins that spans decades; None: the axis is
    linear."""
    positive = place[place > 0]
    if 2 * len(positive) < len(place) or not _wide(positive):
        return None
    if len(positive) == len(place):
        return positive.min()
    return 10 ** np.floor(np.log10(np.quantile(positive, _BELOW, method="lower")))


def _as_drawn(place, begin):
    """Return a column as it is drawn: the logarithm if its axis begins at a positive value."""
    return place if begin is None else np.log10(np.where(place >= begin, place, np.nan))


def _draw_curves(axes, x, values, good, others, *, joined, at_end):
    """Draw values over one column, one curve for each combination of values of the others; if not
    `joined`, only the cases."""
    of_each = sorted(set(zip(*others))) or [()]
    few = len(of_each) <= _MOST_CURVES
    named = np.unique(np.linspace(0, len(of_each) - 1, _MOST_CURVES).astype(int))
    for i, one in enumerate(of_each):
        mine = good.copy()
        for column, wanted in zip(others, one):
            mine &= column == wanted
        order = np.argsort(x[mine])
        axes.plot(x[mine][order], values[mine][order],
                  "." if not joined else ".-" if few else "-",
                  color=COLOURS[i] if few else colormaps["viridis"](i / (len(of_each) - 1)),
                  label=", ".join(word if isinstance(word, str) else f"{word:.3g}" for word in one)
                  if i in named else None)
    if at_end.any():
        axes.plot(x[at_end], values[at_end], **_NO_PULL_OFF)
    for place in np.unique(x[~good & ~at_end]):
        axes.axvline(place, color=GREY, linewidth=0.5, linestyle=":")
    axes.set(xscale="log" if _wide(x) else "linear",
             yscale="log" if _wide(values[good]) else "linear")
    axes.spines[["top", "right"]].set_visible(False)


def _wide(values):
    """Return whether values are positive and span decades."""
    values = values[np.isfinite(values)]
    return len(values) > 0 and values.min() > 0 and values.max() > _DECADES * values.min()


def _label(name, units):
    unit = units.get(name)
    return _words(name) + (f" [{unit}]" if unit else "")


def _words(name):
    return _TERMS.get(name, name if "." in name else name.replace("_", " "))


def _options(parser):
    parser.add_argument("--value", default="max_tension", help="column; default: max_tension")
    parser.add_argument("--per", help="column by which the value is divided")
    parser.add_argument("--over", nargs="+", help="one or two columns; default: the swept keys")
    parser.add_argument("--where", nargs="+", default=(), metavar="KEY=VALUE",
                        help="draw only the cases nearest to this value of a key")


PICTURE = Picture(
    "map", draw_map, "map.png", "Draw a result of a sweep over the keys that were swept.",
    lambda files: "sweep.csv" in files.texts and "costs.csv" not in files.texts
    and not has_fits(files), _options)
