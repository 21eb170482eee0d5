"""The common style of all figures: colours, sizes, panels and labels.

A figure is 6.4 in wide and saved at 120 dots per inch, which is legible in a README. Colours are
distinguishable for the colour-blind; markers and line styles give the same information.
"""

import io

import matplotlib
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from snapin.plots.drawing import (  # noqa: F401
    BLACK, BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION, arrow)
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator
from PIL import Image

GREY = "#8C8C8C"
WIDTH, DPI = 6.4, 120
# Colours and markers of the unloadings from the turning points of a cycle.
RETREATS = ((ORANGE, "s"), (GREEN, "^"), (PURPLE, "D"), (SKY, "v"))
DASHED = {"dashes": (5, 2)}

_SETTINGS = {
    "font.size": 9.5, "axes.labelsize": 10, "axes.titlesize": 10, "xtick.labelsize": 9,
    "ytick.labelsize": 9, "legend.fontsize": 8.5, "legend.frameon": False,
    "legend.handlelength": 2.2, "lines.linewidth": 1.5, "lines.markersize": 5,
    "axes.spines.top": False, "axes.spines.right": False, "axes.linewidth": 0.8,
    "axes.unicode_minus": True}


def figure(rows=1, columns=1, height=4.2, width=WIDTH, mosaic=None, **kwargs):
    """Return a figure and its panels: one Axes, an array, or the dict of a mosaic."""
    # Settings take effect when objects are made and when they are drawn.
    matplotlib.rcParams.update(_SETTINGS)
    page = Figure(figsize=(width, height), layout="constrained")
    if mosaic:
        return page, page.subplot_mosaic(mosaic, **kwargs)
    return page, page.subplots(rows, columns, **kwargs)


def label(panel, x, y, zero_lines="", letter="", log="", ticks=None, **limits):
    """Name the axes and set their limits.

    `zero_lines` ("x", "y", "xy") draws thin lines where these are zero, `log` makes axes
    logarithmic, `letter` is placed above the upper left corner, `ticks` are the ticks of x and y,
    written out.
    """
    panel.set_xlabel(x)
    panel.set_ylabel(y)
    kind = {"color": GREY, "linewidth": 0.6, "zorder": 0}
    if "x" in zero_lines:
        panel.axvline(0, **kind)
    if "y" in zero_lines:
        panel.axhline(0, **kind)
    if letter:
        panel.set_title(f"({letter})", loc="left", fontweight="bold")
    panel.set(**{f"{axis}scale": "log" for axis in log}, **limits)
    for axis, values in zip((panel.xaxis, panel.yaxis), ticks or ()):
        axis.set_major_locator(FixedLocator(values))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_locator(NullLocator())


def heading(panel, text, **kwargs):
    """Put a few words above a panel."""
    panel.set_title(text, **{"loc": "left", **kwargs})


def legend(page, columns, panel=None):
    """Put the legend of a panel, by default the first, below the picture, outside the data."""
    handles, names = (panel or page.axes[0]).get_legend_handles_labels()
    page.legend(handles, names, loc="outside lower center", ncols=columns, columnspacing=1.6)


def explain(panel, entries, **kwargs):
    """Put a legend into a panel: pairs of a look of lines and what it means."""
    panel.legend(handles=[Line2D([], [], **look, label=name) for look, name in entries], **kwargs)


def statement(panel, text, x, y, align="left"):
    """Write the paper's statement in a box at fractions `x`, `y` of the panel."""
    panel.text(x, y, text, transform=panel.transAxes, ha=align, va="top", fontsize=8.5, zorder=10,
               bbox={"boxstyle": "round,pad=0.35", "facecolor": "#F7F4E8", "edgecolor": "#C9BFA0",
                     "linewidth": 0.7})


def word(panel, x, y, text, color="#555555", **kwargs):
    """Write a few small words at a point of the data."""
    panel.text(x, y, text, color=color, **{"fontsize": 8.5, "ha": "left", "va": "top", **kwargs})


def note(panel, text, at, to, align="left", color=BLACK):
    """Write `text` at `to` (data) with a thin line to `at` (data)."""
    panel.annotate(text, at, to, ha=align, va="center", fontsize=8.5, color=color, zorder=9,
                   arrowprops={"arrowstyle": "-", "color": color, "linewidth": 0.7, "shrinkA": 2,
                               "shrinkB": 2})


def spread(panel, x, values, marker, color, name=None, line=0.0, **kwargs):
    """Draw the medians of several runs, rows of `values`, with bars from least to largest."""
    panel.vlines(x, np.nanmin(values, axis=0), np.nanmax(values, axis=0), color=color,
                 linewidth=1.1, zorder=4.5)
    panel.plot(x, np.nanmedian(values, axis=0), marker, color=color, label=name, linewidth=line,
               **{"linestyle": "-" if line else "none", "zorder": 5, **kwargs})


def profiles(panel, states, column, unit):
    """Draw a column of profiles, in `unit`, against r; return colours and h0 for the bar."""
    # Viridis without its palest end, which is not visible on white.
    palette = matplotlib.colormaps["viridis"](np.linspace(0, 0.88, len(states)))
    for color, state in zip(palette, states):
        panel.plot(state["r"] * 1e6, state[column] / unit, color=color, linewidth=1.3)
    return palette, [state["h0"][0] * 1e9 for state in states]


def bar(page, panels, colors):
    """Explain the colours of profiles in a bar beside the panels."""
    palette, h0 = colors
    order = np.argsort(h0)
    edges = np.arange(len(h0) + 1)
    drawn = ScalarMappable(BoundaryNorm(edges, len(h0)), ListedColormap(palette[order]))
    scale = page.colorbar(drawn, ax=list(panels), pad=0.02, aspect=30)
    scale.set_ticks(edges[:-1] + 0.5, labels=[signed(f"{h0[i]:.1f}") for i in order])
    scale.ax.tick_params(length=0, labelsize=8.5)
    scale.ax.set_title("$h_0$ [nm]", fontsize=9)
    scale.outline.set_color(GREY)


def signed(text):
    return text.replace("-", "\N{MINUS SIGN}")


def save(page, path):
    """Write the picture; a palette of 200 colours makes it a third of the size."""
    full = io.BytesIO()
    page.savefig(full, format="png", dpi=DPI)
    picture = Image.open(full).convert("RGB")
    # Without dithering lines keep their colour and white stays white.
    picture.quantize(200, dither=Image.Dither.NONE).save(path, optimize=True)
