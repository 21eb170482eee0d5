"""What all figures have in common: colours, sizes, panel letters, boxes with statements.

A figure is 6.4 in wide and saved at 120 dots per inch, so that it can be read as it stands in a
README. Colours are Okabe and Ito's, which stay apart for the colour-blind; markers and line styles
repeat what they say.
"""

import io

import matplotlib
from matplotlib.figure import Figure
from PIL import Image

BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
BLUE, VERMILION, PURPLE, GREY = "#0072B2", "#D55E00", "#CC79A7", "#8C8C8C"

WIDTH, DPI = 6.4, 120

_SETTINGS = {
    "font.size": 9.5,
    "axes.labelsize": 10,
    "axes.titlesize": 10,
    "xtick.labelsize": 9,
    "ytick.labelsize": 9,
    "legend.fontsize": 8.5,
    "legend.frameon": False,
    "legend.handlelength": 2.2,
    "lines.linewidth": 1.5,
    "lines.markersize": 5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.8,
    "axes.unicode_minus": True,
}


def figure(rows=1, columns=1, height=4.2, width=WIDTH, **kwargs):
    """Return a figure and its panels: one Axes, or an array of them."""
    # Settings are taken up when things are made and when they are drawn.
    matplotlib.rcParams.update(_SETTINGS)
    page = Figure(figsize=(width, height), layout="constrained")
    return page, page.subplots(rows, columns, **kwargs)


def mosaic(layout, height, width=WIDTH, **kwargs):
    """Return a figure and its panels, a dict, laid out as the rows of names say."""
    matplotlib.rcParams.update(_SETTINGS)
    page = Figure(figsize=(width, height), layout="constrained")
    return page, page.subplot_mosaic(layout, **kwargs)


def label(panel, x, y, zero_lines=""):
    """Name the axes; `zero_lines` ("x", "y", "xy") draws thin lines where these are zero."""
    panel.set_xlabel(x)
    panel.set_ylabel(y)
    if "x" in zero_lines:
        panel.axvline(0, color=GREY, linewidth=0.6, zorder=0)
    if "y" in zero_lines:
        panel.axhline(0, color=GREY, linewidth=0.6, zorder=0)


def letter(panel, text):
    """Put a panel's letter above its upper left corner."""
    panel.set_title(f"({text})", loc="left", fontweight="bold")


def heading(panel, text):
    """Put a few words above a panel."""
    panel.set_title(text, loc="left")


def legend(page, columns, panel=None):
    """Put the legend of a panel, by default the first, below the picture, clear of all data."""
    handles, names = (panel or page.axes[0]).get_legend_handles_labels()
    page.legend(handles, names, loc="outside lower center", ncols=columns, columnspacing=1.6)


def statement(panel, text, x, y, align="left", color=BLACK, **kwargs):
    """Say in a box, at fractions `x`, `y` of the panel, what the paper says."""
    return panel.text(
        x, y, text, transform=panel.transAxes, ha=align, va="top", fontsize=8.5, color=color,
        zorder=10, bbox={"boxstyle": "round,pad=0.35", "facecolor": "#F7F4E8",
                         "edgecolor": "#C9BFA0", "linewidth": 0.7}, **kwargs)


def arrow(panel, tail, head, color=BLACK, dashed=False, linewidth=1.2):
    """Draw an arrow between two points of the data, a jump for instance."""
    panel.annotate(
        "", head, tail, zorder=8, annotation_clip=False,
        arrowprops={"arrowstyle": "-|>", "color": color, "linewidth": linewidth, "shrinkA": 0,
                    "shrinkB": 0, "mutation_scale": 11,
                    "linestyle": (0, (3, 2)) if dashed else "-"})


def note(panel, text, at, to, align="left", color=BLACK, **kwargs):
    """Write `text` at `to` (data) with a thin line to `at` (data)."""
    panel.annotate(
        text, at, to, ha=align, va="center", fontsize=8.5, color=color, zorder=9,
        arrowprops={"arrowstyle": "-", "color": color, "linewidth": 0.7, "shrinkA": 2,
                    "shrinkB": 2}, **kwargs)


def save(page, path):
    """Write the picture; a palette of 200 colours makes it a third of the size."""
    full = io.BytesIO()
    page.savefig(full, format="png", dpi=DPI)
    picture = Image.open(full).convert("RGB")
    # Without dithering lines keep their colour and white stays white.
    picture.quantize(200, dither=Image.Dither.NONE).save(path, optimize=True)
