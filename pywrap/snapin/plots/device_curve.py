"""Load against the position of the base, behind each spring, from a deck with &device.

    snapin-plot device results/device
"""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ..results import ResultFiles, ResultsError
from .drawing import (
    COLOURS, GREY, Picture, arrow, dress, entitle, scale, smooth, title_of)

# Largest number of panels in a row.
_A_ROW = 3


def draw_device_curve(folder):
    """Return a figure with a panel for each spring, or dead load, in `folder`."""
    files = ResultFiles(folder)
    summary, curve = files.summary(), files.table("device.csv")
    jumps = files.table("device_jumps.csv")
    springs = list(dict.fromkeys(curve["stiffness"]))
    if not springs:
        raise ResultsError(f"{folder}/device.csv has no rows")
    rows = -(-len(springs) // _A_ROW)
    columns = min(len(springs), _A_ROW)
    figure = Figure(figsize=(max(6.0, 4.4 * columns), 3.9 * rows + 0.5), layout="constrained")
    panels = figure.subplots(rows, columns, squeeze=False, sharey=True).ravel()
    driven = curve["load"][curve["direction"] != "path"]
    load, load_unit = scale(driven, "N")
    for panel, stiffness, colour in zip(panels, springs, COLOURS * len(springs)):
        _draw_spring(panel, stiffness, colour, curve, jumps, load, load_unit)
        if not panel.get_subplotspec().is_first_col():
            panel.set_ylabel("")
    for panel in panels[len(springs):]:
        panel.remove()
    # All panels share this axis.
    deepest = driven.min() / load
    if deepest < 0:
        highest = min(driven.max() / load, -1.5 * deepest)
        panels[0].set_ylim(1.15 * deepest, highest - 0.05 * deepest)
    entitle(figure, title_of(folder, summary))
    figure.legend(handles=[
        Line2D([], [], color=GREY, linewidth=2.6, alpha=0.55, label="retract"),
        Line2D([], [], color=GREY, linewidth=1.4, label="approach"),
        Line2D([], [], color=GREY, linewidth=0.7, linestyle=(0, (3, 2)), label="unstable"),
        Line2D([], [], color=GREY, linewidth=1.0, linestyle=(0, (1, 1)), marker=">",
               label="snap-in, snap-off"),
    ], loc="outside lower center", ncols=4, frameon=False)
    return figure


def _draw_spring(panel, stiffness, colour, curve, jumps, load, load_unit):
    """Draw approach and retract behind one spring, and the path that the jumps leave out."""
    own = curve["stiffness"] == stiffness
    # A dead load has no position: the load is driven.
    x = "h0" if stiffness == 0 else "z"
    driven = own & (curve["direction"] != "path")
    length, length_unit = scale(curve[x][driven], "m")
    name = "approach $h_0$" if stiffness == 0 else "position of the base $z$"
    dress(panel, f"{name} [{length_unit}]", f"load [{load_unit}]")
    panel.set_title(_name_of(stiffness), color=colour, fontsize="medium")
    path = own & (curve["direction"] == "path")
    points = smooth(np.column_stack([curve[x][path] / length, curve["load"][path] / load]))
    panel.plot(*points.T, color=colour, linewidth=0.7, linestyle=(0, (3, 2)), zorder=2)
    for direction, style in (("retreat", {"linewidth": 2.6, "alpha": 0.55, "zorder": 3}),
                             ("approach", {"linewidth": 1.4, "zorder": 4})):
        rows = own & (curve["direction"] == direction)
        ends = np.flatnonzero((curve["stable"][rows] == 0)) + 1
        for at, forces in zip(np.split(curve[x][rows], ends), np.split(curve["load"][rows], ends)):
            points = smooth(np.column_stack([at / length, forces / load]))
            panel.plot(*points.T, color=colour, **style)
    here = jumps["stiffness"] == stiffness
    after = "h0_after" if stiffness == 0 else "z"
    for start, begin, end, finish in zip(jumps[x][here], jumps["load"][here], jumps[after][here],
                                         jumps["load_after"][here]):
        if not np.isfinite(finish):
            continue
        arrow(panel, (start / length, begin / load), (end / length, finish / load), colour, 1.0,
              dashes=(0, (1, 1)), scale=13, zorder=6)
    low, high = curve[x][driven].min() / length, curve[x][driven].max() / length
    # Show the jumps, not all of the drive beyond them.
    if here.any():
        places = np.concatenate([jumps[x][here], jumps[after][here]]) / length
        places = places[np.isfinite(places)]
        span = max(np.ptp(places), 0.2 * (high - low))
        low, high = max(low, places.min() - span), min(high, places.max() + span)
    margin = 0.05 * (high - low)
    panel.set_xlim(low - margin, high + margin)


def _name_of(stiffness):
    if stiffness == 0:
        return "dead load"
    if not np.isfinite(stiffness):
        return "prescribed $h_0$"
    factor, unit = scale([stiffness], "N/m")
    return f"spring of {stiffness / factor:.3g} {unit}"


PICTURE = Picture(
    "device", draw_device_curve, "device_curve.png",
    "Draw load against the position of the base, from a folder of results with &device.",
    lambda files: "device.csv" in files.texts)
