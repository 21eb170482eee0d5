#!/usr/bin/env python3
"""The forces of a deck: pressure and energy against separation, and what the program found there.

    .venv/bin/python pywrap/plots/force_law.py inputs/examples/hydration.nml
"""

import argparse
import math
import pathlib
import sys

import f90nml
import numpy as np
import snapin
from drawing import BLACK, BLUE, GREEN, ORANGE, PURPLE, dress, scale
from matplotlib.figure import Figure

SAMPLES = 1500
# Times what is shown: nothing is drawn beyond; part of the largest tension: no barrier below.
_BEYOND, _SEEN = 5, 1e-4
UNITS = {"pressure": "Pa", "energy": "J/m²"}
# Groups of a deck that are no forces.
OTHERS = {
    "scene", "bodies", "shape", "loading", "unloading", "equilibrium_path", "profiles", "classical",
    "approximations", "stability", "sweep", "numerics", "summary", "cost", "device", "fixed_load",
    "regime", "table", "sensitivity", "measurement", "fit",
}


def forces_of(file):
    """Return the groups of forces in a deck's file."""
    deck = f90nml.read(file).todict()
    forces = {group: dict(keys) for group, keys in deck.items() if group not in OTHERS}
    for keys in forces.values():
        if "file" in keys:
            keys["file"] = str(pathlib.Path(file).resolve().parent / keys["file"])
    return forces


def draw_force_law(deck, title=""):
    """Return a figure of the law that the groups `deck` make."""
    law = Law(deck)
    figure = Figure(figsize=(9, 4.2), layout="constrained")
    for panel, quantity in zip(figure.subplots(1, 2), UNITS, strict=True):
        law.draw(panel, quantity)
    handles, labels = figure.axes[0].get_legend_handles_labels()
    if handles:
        figure.legend(handles, labels, loc="outside lower center", ncols=5, frameon=False)
    figure.suptitle(title)
    return figure


class Law:
    """The law that the groups of a deck make, where there is something to see of it."""

    def __init__(self, deck):
        numbers = snapin.law_numbers(deck)
        self.gap = _separations(deck, numbers)
        self.values = snapin.force_law(deck, self.gap)
        self.marks = _marks(deck, numbers, self.gap, self.values)
        self.lengths = scale(self.gap, "m")

    def draw(self, panel, quantity, others=()):
        """Draw pressure or energy with its marks, and `others`: a label, a line style, and the
        groups of a law each. Marks have the labels of the panel's legend."""
        values = getattr(self.values, quantity)
        sizes = [abs(getattr(mark, quantity)) for mark in self.marks]
        deepest = abs(values.min()) or abs(values).max()
        highest = max([deepest, *sizes])
        factor, short = scale([highest], UNITS[quantity])
        dress(panel, f"separation $h$ [{self.lengths[1]}]", f"{quantity} [{short}]")
        for label, style, deck in others:
            alone = getattr(snapin.force_law(deck, self.gap), quantity)
            alone = np.where(abs(alone) < _BEYOND * highest, alone, np.nan)
            panel.plot(self.gap / self.lengths[0], alone / factor, label=label, **style)
        panel.plot(self.gap / self.lengths[0], values / factor, color=BLUE, linewidth=1.6)
        lowest = -1.15 * deepest / factor if values.min() < 0 else None
        panel.set_ylim(lowest, 1.3 * highest / factor)
        for mark in self.marks:
            panel.plot(mark.gap / self.lengths[0], getattr(mark, quantity) / factor, "o",
                       color=mark.colour, markersize=6, label=mark.name, zorder=5)


def _separations(deck, numbers):
    """Return separations from the repulsion of contact to a thousandth of the largest tension."""
    low = numbers.origin + numbers.length * np.linspace(0.01, 1, 400)
    pressure = snapin.force_law(deck, low).pressure
    near = numbers.origin + numbers.length * np.linspace(1, 3, 200)
    unit = np.max(abs(snapin.force_law(deck, near).pressure))
    near = low[np.argmax(pressure < 20 * unit)]
    far = numbers.origin + numbers.length * np.geomspace(1, 1e4, 400)
    left = np.flatnonzero(abs(snapin.force_law(deck, far).pressure) > 3e-3 * unit)
    end = far[left[-1]] if left.size else far[0]
    return np.linspace(near, max(end, near + 2 * numbers.length), SAMPLES)


class _Mark:
    def __init__(self, name, colour, gap, deck):
        self.name, self.colour, self.gap = name, colour, gap
        values = snapin.force_law(deck, [gap])
        self.pressure, self.energy = values.pressure[0], values.energy[0]


def _marks(deck, numbers, gap, values):
    """Return what the scan found: rest, edge, and outside them the barrier and the outer well."""
    marks = [
        _Mark(name, colour, at, deck)
        for name, colour, at in (("rest", BLACK, numbers.rest_gap),
                                 ("largest tension", ORANGE, numbers.edge_gap))
        if math.isfinite(at)
    ]
    if not marks:
        return marks
    outside = np.flatnonzero(gap > marks[-1].gap)
    seen = _SEEN * abs(marks[-1].pressure)
    tops = [i for i in outside[1:-1]
            if values.energy[i - 1] < values.energy[i] >= values.energy[i + 1]
            and values.pressure[i:].max() > seen]
    wells = [i for i in outside[1:-1]
             if values.energy[i - 1] > values.energy[i] <= values.energy[i + 1]]
    if tops:
        top = max(tops, key=lambda i: values.energy[i])
        marks.append(_Mark("barrier", PURPLE, gap[top], deck))
    if wells:
        well = min(wells, key=lambda i: values.energy[i])
        marks.append(_Mark("outer well", GREEN, gap[well], deck))
    return marks


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("deck", nargs="+", type=pathlib.Path)
    parser.add_argument(
        "--out", type=pathlib.Path, help="folder for the pictures; the deck's if left out"
    )
    options = parser.parse_args()
    for deck in options.deck:
        try:
            figure = draw_force_law(forces_of(deck), deck.stem)
        except (snapin.SnapinError, OSError) as trouble:
            sys.exit(str(trouble))
        file = (options.out or deck.parent) / f"{deck.stem}_law.png"
        figure.savefig(file, dpi=150)
        print(file)


if __name__ == "__main__":
    main()
