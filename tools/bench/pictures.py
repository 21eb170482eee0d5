"""The common parts of the pictures."""

import math

from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator
from snapin.plots.drawing import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION

DARK = "#555555"
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "h")
# Colours and markers of problems, methods and kinds, in their order.
LOOKS = tuple({"color": colour, "marker": marker} for colour, marker in zip(
    (BLUE, VERMILION, GREEN, ORANGE, PURPLE, SKY, BLACK, GREY), MARKERS))
OPEN = {"markerfacecolor": "white"}
THIN = {"color": GREY, "linewidth": 1, "linestyle": (0, (4, 2))}


def figure(rows, columns, size, **options):
    """Return a figure, and its panels like those of matplotlib's `subplots`."""
    page = Figure(figsize=size, layout="constrained")
    return page, page.subplots(rows, columns, **options)


def dress(panel, title="", x="", y="", log="xy"):
    """Set the names and the scales of a panel."""
    panel.set_title(title, fontsize=11)
    panel.set(xlabel=x, ylabel=y, **{f"{axis}scale": "log" for axis in log})
    panel.grid(True, color="#dddddd", linewidth=0.6)
    panel.spines[["top", "right"]].set_visible(False)


def plain_ticks(axis, *values):
    """Put ticks at values of a logarithmic axis of a panel with data, written out."""
    axis.set_ticks(values, [f"{value:g}" for value in values])
    axis.set_minor_locator(NullLocator())


def line(panel, rows, x, y, least=-math.inf, **look):
    """Draw a column of rows against another; values below `least` are drawn there."""
    panel.plot([row[x] for row in rows], [max(row[y], least) for row in rows], **look)


def marks(panel, rows, x, y, look, least=-math.inf, **options):
    """Draw the marks of rows without a line; those of runs with a warning are open."""
    for row in rows:
        line(panel, [row], x, y, least, **look, **options, linestyle="none",
             markerfacecolor="white" if row["warning"] else look["color"])


def explain(panel, name, marker="o", **look):
    """Put a grey mark or line with a meaning of its own into the legend."""
    panel.plot([], [], marker, **{"color": DARK, "label": name, **look})


def legend(page, columns=3):
    """Draw one legend for all panels, below them, with each name once."""
    names = {}
    for axes in page.axes:
        for handle, name in zip(*axes.get_legend_handles_labels()):
            names.setdefault(name, handle)
    page.legend(names.values(), names.keys(), loc="outside lower center", ncols=columns,
                frameon=False, fontsize=9)


def guide(panel, x, y, power, text):
    """Draw a thin line of a power law through the first point, with its name there."""
    panel.plot(x, [y * (value / x[0]) ** power for value in x], **THIN, zorder=0)
    panel.annotate(text, (x[0], y), (6, 4), textcoords="offset points", color=DARK,
                   fontsize=10, ha="left", va="bottom")


def save(page, path):
    path.parent.mkdir(parents=True, exist_ok=True)
    page.savefig(path, dpi=110)
