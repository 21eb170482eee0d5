"""The forces of a deck: pressure and energy against separation, with extrema.

    snapin-plot forces results/hydration
    snapin-plot forces inputs/examples/hydration.nml

The picture of a deck goes into results/<name of the deck>, with the results of the deck; a folder
of results has its deck.
"""

import argparse
import math
import pathlib
import sys

import f90nml
import numpy as np
from matplotlib.figure import Figure

import snapin
from .drawing import (
    BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, add_dots, dress, entitle, save,
    scale)

SAMPLES = 1500
# Values above this multiple of the largest shown are left out; pressures of a barrier are at least
# this part of the largest tension.
_BEYOND, _SEEN = 5, 1e-4
# The energy of an outer well is at least this part of the largest energy; with a larger ratio of
# separations their axis is logarithmic.
_DEEP, _WIDE = 1e-6, 30
_NAMES = {"van_der_waals": "van der Waals", "born": "Born", "force": "Lennard-Jones",
          "dugdale": "Dugdale"}
_COLOURS = (VERMILION, SKY, GREY, BLACK)
_DASHES = ((5, 2), (2, 1.5), (5, 1.5, 1, 1.5), (1, 1.5))
UNITS = {"pressure": "Pa", "energy": "J/m²"}
# Groups of a deck that are not forces.
OTHERS = {
    "scene", "bodies", "layer", "shape", "loading", "unloading", "equilibrium_path", "profiles",
    "classical", "approximations", "stability", "sweep", "numerics", "summary", "cost", "device",
    "fixed_load", "regime", "table", "sensitivity", "drive", "viscoelastic", "fluid", "measurement",
    "fit"}


def deck_in(place):
    """Return the path of a deck, which a folder of results has behind its summary."""
    place = pathlib.Path(place)
    return place / "summary.nml" if place.is_dir() else place


def forces_of(file):
    """Return the groups of forces in a deck's file."""
    deck = f90nml.read(file).todict()
    forces = {group: dict(keys) for group, keys in deck.items() if group not in OTHERS}
    for keys in forces.values():
        if "file" in keys:
            keys["file"] = str(pathlib.Path(file).resolve().parent / keys["file"])
    return forces


def title_of(file):
    """Return the title in a deck's file, or the file's name."""
    return f90nml.read(file).get("scene", {}).get("title") or pathlib.Path(file).stem


def parts_of(groups):
    """Return each force of a deck by its name in the legend; none if there is only one force."""
    if len(groups) == 1:
        return {}
    if "born" in groups:
        # Without its own constant, the repulsion has that of the attraction.
        attraction = groups.get("van_der_waals", {})
        groups = {**groups, "born": {"hamaker": attraction.get("hamaker"), **groups["born"]}}
    return {_NAMES.get(name, name.replace("_", " ")): {name: keys}
            for name, keys in groups.items()}


def styled(parts):
    """Return label, line style and groups of each part of a law."""
    styles = ({"color": colour, "linestyle": (0, dashes), "linewidth": 1.2}
              for colour, dashes in zip(_COLOURS, _DASHES))
    return [(label, style, keys) for style, (label, keys) in zip(styles, parts.items())]


def draw_force_law(deck, title=""):
    """Return a figure of the law of the groups `deck`, and of its parts."""
    law = Law(deck)
    figure = Figure(figsize=(9, 4.2), layout="constrained")
    for panel, quantity in zip(figure.subplots(1, 2), UNITS):
        law.draw(panel, quantity, styled(parts_of(deck)))
    handles, labels = figure.axes[0].get_legend_handles_labels()
    if handles:
        figure.legend(handles, labels, loc="outside lower center", ncols=5, frameon=False)
    entitle(figure, title)
    return figure


class Law:
    """The law of the groups of a deck, at the separations where it matters."""

    def __init__(self, deck):
        numbers = snapin.law_numbers(deck)
        self.gap = _separations(deck, numbers)
        self.values = snapin.force_law(deck, self.gap)
        self.marks = _marks(deck, numbers, self.gap, self.values)
        self.lengths = scale(self.gap, "m")

    def draw(self, panel, quantity, others=()):
        """Draw pressure or energy with its marks, and `others`, each with a label, a line style
        and the groups of a law. Marks have the labels of the panel's legend."""
        values = getattr(self.values, quantity)
        sizes = [abs(getattr(mark, quantity)) for mark in self.marks]
        deepest = abs(values.min()) or abs(values).max()
        highest = max([deepest, *sizes])
        factor, short = scale([highest], UNITS[quantity])
        dress(panel, f"separation $h$ [{self.lengths[1]}]", f"{quantity} [{short}]")
        for label, style, deck in others:
            gap, alone = _values(deck, quantity, self.gap)
            alone = np.where(abs(alone) < _BEYOND * highest, alone, np.nan)
            panel.plot(gap / self.lengths[0], alone / factor, label=label, **style)
        panel.plot(self.gap / self.lengths[0], values / factor, color=BLUE, linewidth=1.6,
                   label="sum" if others else None)
        if self.gap[0] > 0 and self.gap[-1] > _WIDE * self.gap[0]:
            panel.set_xscale("log")
        lowest = -1.15 * deepest / factor if values.min() < 0 else None
        panel.set_ylim(lowest, 1.3 * highest / factor)
        for mark in self.marks:
            panel.plot(mark.gap / self.lengths[0], getattr(mark, quantity) / factor, "o",
                       color=mark.colour, markersize=6, label=mark.name, zorder=5)


def _values(deck, quantity, gap):
    """Return separations at which a law has values, and these: laws of powers have none at 0."""
    try:
        return gap, getattr(snapin.force_law(deck, gap), quantity)
    except ValueError:
        return gap[gap > 0], getattr(snapin.force_law(deck, gap[gap > 0]), quantity)


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
    # An outer well is shown, with as large a range outside it.
    energy = snapin.force_law(deck, far).energy
    wells = np.flatnonzero((energy[1:-1] < energy[:-2]) & (energy[1:-1] <= energy[2:])
                           & (far[1:-1] > end))
    if wells.size and energy[wells + 1].min() < -_DEEP * abs(energy).max():
        end = 2 * far[wells[np.argmin(energy[wells + 1])] + 1]
    end = max(end, near + 2 * numbers.length)
    if near > 0 and end > _WIDE * near:
        return np.geomspace(near, end, SAMPLES)
    return np.linspace(near, end, SAMPLES)


class _Mark:
    def __init__(self, name, colour, gap, deck):
        self.name, self.colour, self.gap = name, colour, gap
        values = snapin.force_law(deck, [gap])
        self.pressure, self.energy = values.pressure[0], values.energy[0]


def _marks(deck, numbers, gap, values):
    """Return the marks: equilibrium, largest tension, and outside them barrier and outer well."""
    marks = [
        _Mark(name, colour, at, deck)
        for name, colour, at in (("equilibrium", BLACK, numbers.rest_gap),
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
        marks.append(_Mark("secondary minimum", GREEN, gap[well], deck))
    return marks


def results_of(deck, out="results"):
    """Return the folder of the results that ./run --out OUT writes for a deck's file."""
    return pathlib.Path(out) / deck.stem


def main(arguments=None, program=None):
    """Carry out a command: the forces of decks, or of the decks of folders of results."""
    parser = argparse.ArgumentParser(prog=program, description=__doc__.splitlines()[0])
    parser.add_argument("deck", nargs="+", type=pathlib.Path, help="deck or folder of results")
    parser.add_argument("--out", default="results",
                        help="pictures of decks are OUT/DECK/force_law.png; default: results")
    add_dots(parser)
    options = parser.parse_args(arguments)
    for place in options.deck:
        folder = place if place.is_dir() else results_of(place, options.out)
        try:
            print(write_forces(place, folder, options.dpi))
        except (snapin.SnapinError, OSError, ValueError) as trouble:
            sys.exit(f"{parser.prog}: {place}: {trouble}")


def write_forces(place, folder, dpi):
    """Draw the forces of a deck, or of a folder of results, into a folder; return the picture."""
    deck = deck_in(place)
    figure = draw_force_law(forces_of(deck), title_of(deck))
    folder.mkdir(parents=True, exist_ok=True)
    save(figure, folder / "force_law.png", dpi)
    return folder / "force_law.png"
