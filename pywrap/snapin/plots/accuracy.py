"""What accuracy costs: errors against time, of a sweep whose costs were measured.

    snapin-plot accuracy results/accuracy
    snapin-plot accuracy results/accuracy --beside results/accuracy_paper
    snapin-plot accuracy results/accuracy --reference FILE_OR_FOLDER

Every case is a point: filled for its true error, open for the estimated one, a cross if it failed;
at the upper edge if a number is missing. The error is the largest of several numbers, each
relative to the largest of these numbers in the same unit. True errors are differences from
`--reference`, a folder of results or a file with lines `number,value`; without it from the case
with the least estimated error, and only those above that estimate are drawn. Cases with other
values of other keys than the last one are other lines.
"""

import itertools
import pathlib

import numpy as np
from matplotlib.figure import Figure

from ..result_text import units_of
from ..results import ResultFiles, ResultsError
from .drawing import (
    BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, Picture, entitle, title_of)

_LOOKS = tuple(zip((BLUE, VERMILION, GREEN, ORANGE, PURPLE, SKY, BLACK), "os^Dv<>"))
# The numbers whose errors are drawn, if the sweep has them.
_NUMBERS = ("max_tension", "jump_in_h0", "jump_in_load", "jump_out_h0", "jump_out_load",
            "energy_lost", "energy_dissipated", "end_load")
_ENDINGS = ("_error", "_uncertainty")
# Characters between the values of keys in a label.
_APART = ", "


class Sweep:
    """The cases of one folder."""

    def __init__(self, folder):
        self.folder = folder
        files = ResultFiles(folder)
        self.sweep = files.table("sweep.csv")
        self.summary = files.summary()
        if "costs.csv" not in files.texts:
            raise ResultsError(f"{folder} has no costs.csv; sweep a key of &numerics, or give "
                               "costs = .true. in &sweep")
        self.costs = files.table("costs.csv")
        self.keys = [name for name in self.sweep if "." in name]
        self.units = units_of(files.text("sweep.csv"))
        self.good = self.sweep["converged"] == 1

    def error_of(self, number):
        """Return the estimated errors of a number."""
        return next(self.costs[number + ending] for ending in _ENDINGS
                    if number + ending in self.costs)

    def numbers(self):
        """Return the numbers with an estimated error that at least one case has."""
        return [name for name in self.sweep
                if any(name + ending in self.costs for ending in _ENDINGS)
                and np.isfinite(self.sweep[name]).any()]

    def lines(self):
        """Return the label of each line, and which cases are on it."""
        others = [self.sweep[key] for key in self.keys[:-1]]
        values = list(zip(*others)) or [()] * len(self.good)
        for one in dict.fromkeys(values):
            yield _APART.join(f"{value}" for value in one), np.array([v == one for v in values])


def draw_accuracy(folder, beside=(), reference=None, numbers=None):
    """Return a figure of errors against time for the sweeps in `folder` and `beside`."""
    sweeps = [Sweep(one) for one in (folder, *beside)]
    known = set.intersection(*(set(one.numbers()) for one in sweeps))
    chosen = list(numbers or (name for name in _NUMBERS if name in known))
    for name in chosen:
        if name not in known:
            raise ResultsError(f"no estimated error of {name!r}; there are "
                               + (", ".join(sorted(known)) or "none"))
    true, floor, said = _reference(sweeps, chosen, reference)
    chosen = [name for name in chosen if np.isfinite(true.get(name, np.nan))]
    if not chosen:
        raise ResultsError(f"{reference or folder}: none of these numbers: "
                           + ", ".join(numbers or sorted(known) or _NUMBERS))
    scales = {name: max(abs(true[other]) for other in chosen
                        if sweeps[0].units[other] == sweeps[0].units[name]) for name in chosen}
    figure = Figure(figsize=(6.4, 4.4), layout="constrained")
    axes = figure.subplots()
    axes.set(xscale="log", yscale="log", xlabel="time [ms]",
             ylabel="largest relative error of " + ("one number" if len(chosen) == 1 else
                                                    f"{len(chosen)} numbers"))
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(color=GREY, linewidth=0.3, alpha=0.5)
    looks = itertools.cycle(_LOOKS)
    for one in sweeps:
        errors = _largest(abs(one.sweep[name] - true[name]) / scales[name] for name in chosen)
        errors = np.where(errors > floor, errors, np.where(np.isnan(errors), np.inf, np.nan))
        estimates = _largest(one.error_of(name) / scales[name] for name in chosen)
        for label, mine in one.lines():
            _draw_line(axes, one, mine, errors, estimates, label, next(looks))
    axes.plot([], [], "o", color=GREY, label=f"error, {said}")
    axes.plot([], [], "o:", color=GREY, markerfacecolor="none", label="estimated error")
    if not all(one.good.all() for one in sweeps):
        axes.plot([], [], "x", color=GREY, label="case failed")
    axes.legend(frameon=False, fontsize="small")
    entitle(figure, title_of(folder, {**sweeps[0].summary, "converged": True}))
    return figure


def _draw_line(axes, one, mine, errors, estimates, label, look):
    color, mark = look
    time = 1e3 * one.costs["seconds"]
    key = one.keys[-1]
    name = _APART.join(filter(None, (pathlib.Path(one.folder).resolve().name, label)))
    there = mine & np.isfinite(errors)
    axes.plot(time[there], errors[there], "-", color=color, linewidth=1)
    for marks, cases in ((mark, there & one.good), ("x", there & ~one.good)):
        axes.plot(time[cases], errors[cases], marks, color=color, markersize=5)
    axes.plot([], [], mark + "-", color=color, label=f"{name}: {key}")
    guessed = mine & (estimates > 0) & one.good
    axes.plot(time[guessed], estimates[guessed], mark + ":", color=color, linewidth=1,
              markerfacecolor="none", markersize=5)
    lost = mine & np.isinf(errors)
    axes.plot(time[lost], np.ones(lost.sum()), "x", color=color, clip_on=False,
              transform=axes.get_xaxis_transform())
    shown = np.flatnonzero(there if there.any() else guessed)
    for i in shown[:: max(1, len(shown) - 1)]:
        value = one.sweep[key][i]
        axes.annotate(value if isinstance(value, str) else f"{value:g}", (
            time[i], (errors if there[i] else estimates)[i]), textcoords="offset points",
            xytext=(6, 4), fontsize="small", color=color)


def _reference(sweeps, numbers, reference):
    """Return the true values by name, the error below which nothing is known, and their origin."""
    if reference is not None:
        path = pathlib.Path(reference)
        found = ResultFiles(path).summary() if path.is_dir() else _numbers_of(path)
        return ({name: found[name] for name in numbers if np.ndim(found.get(name, [])) == 0},
                0.0, f"against {path.resolve().name if path.is_dir() else path.stem}")
    best = None
    for one in sweeps:
        for i in np.flatnonzero(one.good & np.isfinite(one.costs["error_estimate"])):
            estimate = one.costs["error_estimate"][i]
            if best is None or estimate < best[0]:
                best = estimate, {name: one.sweep[name][i] for name in numbers}
    if best is None:
        raise ResultsError(f"{sweeps[0].folder}: no case has an error estimate; give --reference")
    return best[1], best[0], "against the finest case"


def _numbers_of(path):
    """Return the numbers in a file with lines `number,value`."""
    lines = path.read_text(encoding="utf-8").splitlines()
    try:
        return {name: float(value) for name, value in (
            line.split(",") for line in lines if line and not line.startswith("#"))}
    except ValueError as problem:
        raise ResultsError(f"{path}: not lines of number,value: {problem}") from problem


def _largest(errors):
    """Return the largest of the errors of each case; NaN if one is missing."""
    return np.max(np.stack(list(errors)), axis=0)


def _options(parser):
    parser.add_argument("--beside", nargs="+", default=(), metavar="FOLDER",
                        help="more sweeps for the same picture")
    parser.add_argument("--reference", metavar="FILE_OR_FOLDER",
                        help="the true numbers; default: those of the finest case")
    parser.add_argument("--numbers", nargs="+", metavar="NAME",
                        help=f"columns; default: those that there are of {', '.join(_NUMBERS)}")


PICTURE = Picture(
    "accuracy", draw_accuracy, "accuracy.png", "Draw what accuracy costs: errors against time.",
    lambda files: "costs.csv" in files.texts, _options)
