"""A deck's force law beside the force curve; the deck is run.

    python -m snapin.plots.law_and_curve inputs/examples/hydration.nml -o hydration.png
"""

import argparse
import pathlib
import sys
import tempfile

import numpy as np
from matplotlib.figure import Figure

import snapin
from .drawing import add_dots, save, scale
from .force_curve import Curve
from .force_law import Law, forces_of, parts_of, results_of, styled

# Largest and smallest load shown, over the largest tension.
_HIGHEST, _FAINT = 2.0, 0.02


def draw_law_and_curve(deck, results, terms=None, quantity="pressure"):
    """Return a figure of the law of a deck's file and the curve in the folder `results`.

    quantity: pressure or energy of the law; terms: label -> groups of a law that is drawn beside
    the deck's law; default: the deck's own terms, if there are several.
    """
    groups = forces_of(deck)
    if terms is None:
        terms = parts_of(groups)
    figure = Figure(figsize=(9, 3.9), layout="constrained")
    left, right = figure.subplots(1, 2)
    law = Law(groups)
    law.draw(left, quantity, styled(terms))
    curve = Curve(results)
    curve.theories = None
    load, stable = curve.table["load"], curve.table["stable"] != 0
    if stable.all() and len(curve.branches) > 1:
        # The path shows nothing more, and has fewer points.
        curve.branches = [branch for branch in curve.branches if branch.name != "path"]
    if load.min() < 0:
        curve.loads = scale([_HIGHEST * load.min()], "N")
    curve.draw(right, "h0")
    _look_at_contact(right, curve)
    for panel in (left, right):
        panel.legend(frameon=False, fontsize="small")
    figure.draw_without_rendering()
    curve.draw_arrows(right, "h0")
    return figure


def _look_at_contact(panel, curve):
    """Show the range of adhesion, without high loads and the level part of the curve."""
    h0, load = curve.table["h0"] / curve.lengths["h0"][0], curve.table["load"] / curve.loads[0]
    deepest = abs(load.min())
    if load.min() < 0:
        seen = h0[(load <= _HIGHEST * deepest) & (abs(load) >= _FAINT * deepest)]
        span = np.ptp(seen)
        panel.set_xlim(seen.min() - 0.05 * span, min(h0.max(), seen.max() + 0.2 * span))
        panel.set_ylim(-1.2 * deepest, min(1.05 * load.max(), _HIGHEST * deepest))


def main(arguments=None):
    """Carry out a command: run a deck, and draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("deck", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path,
                        help="picture to write; default: results/DECK/law_and_curve.png")
    add_dots(parser)
    options = parser.parse_args(arguments)
    picture = options.output or results_of(options.deck) / "law_and_curve.png"
    picture.parent.mkdir(parents=True, exist_ok=True)
    try:
        with tempfile.TemporaryDirectory() as folder:
            snapin.run(options.deck, out=folder)
            save(draw_law_and_curve(options.deck, folder), picture, options.dpi)
    except (snapin.SnapinError, OSError) as trouble:
        sys.exit(f"{parser.prog}: {trouble}")
    print(picture)
