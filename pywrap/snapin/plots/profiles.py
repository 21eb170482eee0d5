"""Separation and pressure against r, one line for each h0, from a folder of results.

    snapin-plot profiles results/first
"""

import matplotlib
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.figure import Figure

from ..results import ResultFiles, ResultsError
from .drawing import Picture, dress, entitle, scale, states_of, title_of

# The profiles are shown up to the last place with this share of the largest pressure.
_FAINT = 0.02
# Up to this number of lines the colour bar names each.
_FEW = 12


def draw_profiles(folder, branch=None):
    """Return a figure of the profiles of one branch in `folder`; default: loading, or the first."""
    files = ResultFiles(folder)
    summary, table = files.summary(), files.table("profiles.csv")
    names = list(dict.fromkeys(table["branch"]))
    if not names:
        raise ResultsError(f"{folder}/profiles.csv has no rows")
    if branch is None:
        branch = "loading" if "loading" in names else names[0]
    if branch not in names:
        raise ResultsError(f"no branch {branch!r} in {folder}/profiles.csv; there are "
                           f"{', '.join(names)}")
    states = states_of({x: values[table["branch"] == branch] for x, values in table.items()})
    unstable = any(state["stable"][0] == 0 for state in states)

    seen = max(state["r"][abs(state["pressure"]) >= _FAINT * _largest(state)].max()
               for state in states) * 1.15
    for state in states:
        state["seen"] = state["r"] <= seen
    radii = scale(seen, "m")
    gaps = scale(np.concatenate([state["separation"][state["seen"]] for state in states]), "m")
    pressures = scale(table["pressure"], "Pa")
    h0 = np.array([state["h0"][0] for state in states])
    lengths = scale(h0, "m")
    values = np.unique(h0 / lengths[0])
    # Viridis without its palest colours, which are hard to see on white.
    colors = ListedColormap(matplotlib.colormaps["viridis"](np.linspace(0, 0.9, 256)))
    span = max(values[-1] - values[0], 1e-9 * abs(values[0]), 1e-12)
    norm = Normalize(values[0], values[0] + span)

    figure = Figure(figsize=(9, 4.2), layout="constrained")
    panels = figure.subplots(1, 2)
    for panel, y, name, (factor, unit) in (
            (panels[0], "separation", "separation $h$", gaps),
            (panels[1], "pressure", "pressure $p$", pressures)):
        dress(panel, f"distance from the axis $r$ [{radii[1]}]", f"{name} [{unit}]")
        for state in states:
            # One more point, so that lines end at the frame.
            n = np.count_nonzero(state["seen"]) + 1
            panel.plot(state["r"][:n] / radii[0], state[y][:n] / factor, linewidth=1.4,
                       color=colors(norm(state["h0"][0] / lengths[0])),
                       linestyle=(0, (3, 1.5)) if state["stable"][0] == 0 else "-")
        panel.set_xlim(0, seen / radii[0])
    low = min(0, min(state["separation"].min() for state in states)) / gaps[0]
    high = max(state["separation"][state["seen"]].max() for state in states) / gaps[0]
    panels[0].set_ylim(low - 0.02 * (high - low), high)
    bar = figure.colorbar(ScalarMappable(norm, colors), ax=panels, pad=0.02,
                          label=f"approach $h_0$ [{lengths[1]}]")
    if values.size <= _FEW:
        # Steps of h0 that end at 0 leave a rounding error.
        shown = np.where(abs(values) < 1e-9 * span, 0, values)
        bar.set_ticks(values, labels=[f"{value:.4g}".replace("-", "\N{MINUS SIGN}")
                                      for value in shown])
    dashed = "; dashed: unstable" if unstable else ""
    entitle(figure, f"{title_of(folder, summary)} ({branch.replace('_', ' ')}{dashed})")
    return figure


def _largest(state):
    return abs(state["pressure"]).max()


def _add_options(parser):
    parser.add_argument("--branch", help="branch to draw, as in profiles.csv; default: loading, "
                        "or the first branch")


PICTURE = Picture(
    "profiles", draw_profiles, "profiles.png",
    "Draw separation and pressure against r, from a folder of results.",
    lambda files: "profiles.csv" in files.texts, _add_options)
