"""The common parts of the pictures."""

import program  # noqa: F401 (makes drawing importable)
from drawing import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

COLOURS = (BLUE, VERMILION, GREEN, ORANGE, PURPLE, SKY, BLACK, GREY)
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "h")


def figure(rows, columns, size=None, **options):
    """Return a figure of a README's width, and its panels."""
    page = Figure(figsize=size or (9.0, 3.6 * rows), layout="constrained")
    return page, page.subplots(rows, columns, squeeze=False, **options)


def dress(panel, title="", x="", y="", log="xy"):
    """Set the names and the scales of a panel."""
    panel.set_title(title, fontsize=11)
    panel.set_xlabel(x)
    panel.set_ylabel(y)
    if "x" in log:
        panel.set_xscale("log")
    if "y" in log:
        panel.set_yscale("log")
    panel.grid(True, color="#dddddd", linewidth=0.6)
    panel.spines[["top", "right"]].set_visible(False)


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
    values = [y * (value / x[0]) ** power for value in x]
    panel.plot(x, values, color=GREY, linewidth=1.0, linestyle=(0, (4, 2)), zorder=0)
    panel.annotate(text, (x[0], values[0]), (6, 4), textcoords="offset points", color="#555555",
                   fontsize=10, ha="left", va="bottom")


def plain_ticks(panel, values, axis="x"):
    """Put ticks at the given values of a logarithmic axis, written out."""
    axis = getattr(panel, f"{axis}axis")
    axis.set_ticks(values, [f"{value:g}" for value in values])
    axis.set_minor_locator(NullLocator())


def save(page, path):
    """Write a picture."""
    path.parent.mkdir(parents=True, exist_ok=True)
    page.savefig(path, dpi=110)
