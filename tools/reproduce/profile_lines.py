"""Profiles against the distance from the axis, one line an h0, as Figs. 4 and 6 show them."""

import matplotlib
import numpy as np
import style
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap


def states(results, branch="loading"):
    """Return the profiles of a branch, a dict of arrays each, in order; each begins at r = 0."""
    rows = results.branch(branch, "profiles")
    starts = np.flatnonzero(rows["r"] == 0)
    ends = np.append(starts[1:], rows["r"].size)
    return [{column: values[i:j] for column, values in rows.items()}
            for i, j in zip(starts, ends)]


def draw(panel, profiles, column, unit, mirrored=False, **kwargs):
    """Draw a column of all profiles, in `unit`; return colours and h0 for the bar."""
    # Viridis without its palest end, which vanishes on white.
    palette = matplotlib.colormaps["viridis"](np.linspace(0, 0.88, len(profiles)))
    for color, state in zip(palette, profiles):
        r, value = state["r"] * 1e6, state[column] / unit
        if mirrored:
            r, value = np.append(-r[::-1], r), np.append(value[::-1], value)
        panel.plot(r, value, **{"color": color, "linewidth": 1.3, **kwargs})
    return palette, [state["h0"][0] * 1e9 for state in profiles]


def bar(page, panels, colors):
    """Explain the colours in a bar beside the panels."""
    palette, h0 = colors
    order = np.argsort(h0)
    edges = np.arange(len(h0) + 1)
    drawn = ScalarMappable(BoundaryNorm(edges, len(h0)), ListedColormap(palette[order]))
    scale = page.colorbar(drawn, ax=list(panels), pad=0.02, aspect=30)
    scale.set_ticks(edges[:-1] + 0.5,
                    labels=[f"{h0[i]:.1f}".replace("-", "\N{MINUS SIGN}") for i in order])
    scale.ax.tick_params(length=0, labelsize=8.5)
    scale.ax.set_title("$h_0$ [nm]", fontsize=9)
    scale.outline.set_color(style.GREY)
