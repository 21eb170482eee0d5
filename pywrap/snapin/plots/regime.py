"""The scene as a point on the map of theories of Johnson and Greenwood, from a deck with &regime.

    snapin-plot regime results/regime
"""

import pathlib

import numpy as np
from matplotlib.figure import Figure

from ..results import ResultFiles, ResultsError
from .drawing import GREY, VERMILION, Picture, entitle, title_of

# Limits of K. L. Johnson and J. A. Greenwood, J. Colloid Interface Sci. 192, 326 (1997): elastic
# deformation over the length of the law, share of adhesion in the load, and Maugis' parameter.
_RIGID, _SHARE, _DMT, _JKR = 0.05, 0.05, 0.1, 5.0
# lambda over Tabor's parameter, for Lennard-Jones.
_OF_TABOR = 1.157
_NAMES = {"Hertz": (0.6, 2e4), "JKR": (22, 1), "Maugis\N{EN DASH}Dugdale": (0.7, 0.08),
          "DMT": (0.045, 1), "rigid": (4e-3, 1)}
# Ends of the axes, unless the scene is outside them.
_LAMBDA, _LOAD = (1e-3, 1e2), (1e-2, 1e5)


def draw_regime(folder):
    """Return a figure of the map with the scene in `folder` on it."""
    summary = ResultFiles(folder).summary()
    if "regime_recommended" not in summary:
        if (pathlib.Path(folder) / "sweep.csv").is_file():
            raise ResultsError(f"{folder} has results of a &sweep: see regime_... in sweep.csv")
        raise ResultsError(f"{folder}/summary.nml has no regime; the deck needs &regime")
    x, load = summary["regime_maugis_lambda"], summary["regime_load_number"]
    wide = np.array([min(_LAMBDA[0], x / 3), max(_LAMBDA[1], 3 * x)])
    high = np.array([_LOAD[0], max(_LOAD[1], 3 * load)])

    figure = Figure(figsize=(6.2, 4.6), layout="constrained")
    axes = figure.subplots()
    axes.set(xscale="log", yscale="log", xlim=wide, ylim=high,
             xlabel=r"Maugis' parameter $\lambda$", ylabel=r"load number $F/\pi w R$")
    axes.spines[["top", "right"]].set_visible(False)
    line = {"color": GREY, "linewidth": 1.0}
    hertz = [_hertz_load(_SHARE, jkr=False), _hertz_load(_SHARE, jkr=True)]
    axes.plot([wide[0], _DMT, _JKR, wide[1]], [hertz[0], *hertz, hertz[1]], **line)
    axes.vlines([_DMT, _JKR], high[0], hertz, **line)
    at = np.geomspace(*wide, 200)
    axes.plot(at, _rigid_load(at / _OF_TABOR), **line)
    for text, place in _NAMES.items():
        axes.annotate(text, place, color=GREY, ha="center", va="center", fontsize=11)
    # A scene with a tension lies below the map.
    shown = max(load, high[0] * 1.2)
    axes.plot(x, shown, marker="o" if load > high[0] else "v", color=VERMILION, markersize=9)
    axes.annotate(_advice(summary), (x, shown), (0, 12), textcoords="offset points", ha="center",
                  color=VERMILION, weight="bold")
    entitle(figure, title_of(folder, summary))
    return figure


def _advice(summary):
    """Return the name of the theory that the program recommends."""
    name = summary["regime_recommended"]
    names = {"none": "no theory", "maugis": "Maugis-Dugdale", "hertz": "Hertz"}
    return "this scene: " + names.get(name, name.upper())


def _hertz_load(share, jkr):
    """Return the load number at which adhesion is this share of the compressive load."""
    if not jkr:
        return 2 / share - 2
    # The compressive load is F + s with the adhesion s = 3 + sqrt(6 F + 9); F = s (1/share - 1)
    # gives s = 6/share.
    return 6 / share * (1 / share - 1)


def _rigid_load(tabor):
    """Return the load number that deforms bodies by the limit of rigid bodies, or NaN.

    In Hertz theory under load and adhesion, F + 2 pi w R, the deformation over the length of the
    law is 1.7707 mu (load number + 2)^(2/3).
    """
    load = (_RIGID / (1.7707 * tabor)) ** 1.5 - 2
    return np.where(load > 0, load, np.nan)


PICTURE = Picture(
    "regime", draw_regime, "regime.png", "Draw the scene on the map of theories of contact.",
    lambda files: "regime_recommended" in files.summary())
