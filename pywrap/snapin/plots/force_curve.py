"""Load against displacement and against h0, from a folder of results.

    snapin-plot curve results/first
"""

import itertools

import numpy as np
from matplotlib.figure import Figure

from ..results import ResultFiles, ResultsError
from .drawing import (
    BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, Picture, arrow, dress, entitle, scale,
    smooth, title_of)

# Unloadings often coincide with each other and with the loading: later curves are thinner.
_LOADING = {"color": BLUE, "linewidth": 2.6, "zorder": 5}
_UNLOADING = (ORANGE, SKY, PURPLE, GREEN, VERMILION)
_WIDEST, _THINNEST = 6.5, 4.0
# A drive in time; its branches differ from each other.
_DRIVE = {"approach": ("approach", {"color": BLUE, "linewidth": 1.5, "zorder": 5}),
          "dwell": ("dwell", {"color": GREEN, "linewidth": 1.5, "zorder": 5}),
          "retreat": ("retract", {"color": ORANGE, "linewidth": 1.5, "zorder": 4})}
_PATH = {"color": BLACK, "linewidth": 0.9, "zorder": 6}
_THEORIES = {
    "hertz": ("Hertz", {"color": GREY, "linestyle": (0, (1, 1.5))}),
    "jkr": ("JKR", {"color": VERMILION, "linestyle": (0, (6, 2))}),
    "dmt": ("DMT", {"color": GREEN, "linestyle": (0, (6, 2, 1, 2))}),
    "maugis_dugdale": (
        "Maugis-Dugdale", {"color": PURPLE, "linestyle": (0, (6, 1.5, 1, 1.5, 1, 1.5))}),
    "hertz_layered": ("Hertz, layered", {"color": GREY, "linestyle": (0, (1, 1.5))}),
    "jkr_layered": ("JKR, layered", {"color": VERMILION, "linestyle": (0, (6, 2))}),
}
# The abscissas.
NAMES = {"displacement": "displacement $h(0) - h_0$", "h0": "approach $h_0$"}
# A drive whose separations on the axis span a larger ratio is drawn over their logarithm.
_DECADES = 300.0
_SEPARATION = "separation on the axis $h(0)$"
# A piece of curve shorter than this [points] gets no arrow for its direction.
_LONG_ENOUGH = 45
_MOST_COLUMNS = 6


def draw_force_curve(folder):
    """Return a figure of the curve in `folder`."""
    results = Curve(folder)
    figure = Figure(figsize=(9, 4.6), layout="constrained")
    panels = dict(zip(NAMES, figure.subplots(1, 2, sharey=True)))
    for x, panel in panels.items():
        results.draw(panel, x)
    panels["h0"].set_ylabel("")
    entitle(figure, title_of(folder, results.summary))
    handles, labels = panels["displacement"].get_legend_handles_labels()
    columns = -(-len(labels) // -(-len(labels) // _MOST_COLUMNS))
    figure.legend(handles, labels, loc="outside lower center", ncols=columns, frameon=False)
    # Arrows are placed by distances on the page, which are known after all else is drawn.
    figure.draw_without_rendering()
    for x, panel in panels.items():
        results.draw_arrows(panel, x)
    return figure


class Curve:
    """The curve in a folder of results, in short units, drawn against one of NAMES."""

    def __init__(self, folder):
        files = ResultFiles(folder)
        self.summary, self.table = files.summary(), files.table("curve.csv")
        if self.table["h0"].size == 0:
            raise ResultsError(f"{folder}/curve.csv has no rows")
        self.theories = None
        if "classical.csv" in files.texts:
            self.theories = files.table("classical.csv")
            # Bodies in contact have the equilibrium separation here; the rows count from elsewhere.
            rest = self.summary.get("rest_gap", 0.0)
            self.theories = dict(self.theories, h0=rest - self.theories["displacement"])
        gaps = self.table["h0"] + self.table["displacement"]
        self.logarithmic = (self.table["branch"][0] in _DRIVE and gaps.min() > 0
                            and gaps.max() > _DECADES*gaps.min())
        if self.logarithmic:
            self.table = dict(self.table, h0=gaps)
        self.lengths = {x: scale(self.table[x], "m") for x in NAMES}
        self.loads = scale(self.table["load"], "N")
        self.branches = [_Branch(name, self.table, self.summary)
                         for name in dict.fromkeys(self.table["branch"])]

    def draw(self, panel, x):
        """Draw the curve without arrows."""
        length, load = self.lengths[x][0], self.loads[0]
        name = _SEPARATION if x == "h0" and self.logarithmic else NAMES[x]
        dress(panel, f"{name} [{self.lengths[x][1]}]", f"load [{self.loads[1]}]")
        for branch in self.branches:
            branch.draw(panel, x, length, load)
        self._draw_open_end(panel, x, length, load)
        if self.theories:
            _draw_theories(panel, self.theories, x, length, load)
        _frame(panel, self.table, self.theories, x, length, load)
        if x == "h0" and self.logarithmic:
            panel.set(xscale="log", xlim=np.array([0.8, 1.25])*[
                self.table[x].min()/length, self.table[x].max()/length])

    def _draw_open_end(self, panel, x, length, load):
        """Mark the largest tension where it is that of a first or last row, and no pull-off."""
        if self.summary.get("max_tension_at_end"):
            row = np.argmin(self.table["load"])
            panel.plot(self.table[x][row] / length, self.table["load"][row] / load, "o",
                       color=GREY, markersize=9, fillstyle="none", zorder=8,
                       label="tension largest at an end: no pull-off")

    def draw_arrows(self, panel, x):
        """Draw the arrows of jumps and directions; the panel must have its final size."""
        for branch in self.branches:
            branch.draw_arrows(panel, x, self.lengths[x][0], self.loads[0])


class _Branch:
    """One branch of the curve: its smooth pieces, in order, and the jumps between them."""

    def __init__(self, name, curve, summary):
        rows = curve["branch"] == name
        self.name = name
        self.rows = {x: curve[x][rows] for x in ("displacement", "h0", "load", "stable")}
        self.number = int(name.split("_")[1]) if name.startswith("unloading_") else 0
        self.jumps = []
        self.pieces = [self.rows]
        if name in _DRIVE:
            self.label, self.style = _DRIVE[name]
        elif name != "path":
            self._split(*self._jump_of(summary))
            count = np.size(summary.get("unload_from", []))
            self.style, self.label = _style_of(name, self.number, count)

    def _jump_of(self, summary):
        """Return h0 before the branch's jump and the load there, or NaN."""
        if self.name == "loading":
            return summary.get("jump_in_h0", np.nan), summary.get("jump_in_load", np.nan)
        all_h0 = np.atleast_1d(summary.get("unload_jump_out_h0", np.nan))
        h0 = all_h0[self.number - 1] if self.number <= all_h0.size else np.nan
        # The summary has one load, which holds for all unloadings that jump from the same fold.
        same = abs(h0 - summary.get("jump_out_h0", np.nan)) <= 1e-6 * abs(h0)
        return h0, summary.get("jump_out_load", np.nan) if same else np.nan

    def _split(self, jump_h0, jump_load):
        """Split the rows at the jump of the branch, and extend both pieces to the jump."""
        h0 = self.rows["h0"]
        last = np.flatnonzero((h0 - jump_h0) * np.sign(h0[-1] - h0[0]) < 0)
        if not np.isfinite(jump_h0) or last.size in (0, h0.size):
            return
        at = last[-1] + 1
        before = {x: values[:at] for x, values in self.rows.items()}
        after = {x: values[at:] for x, values in self.rows.items()}
        start = _end_at_fold(before, jump_h0, jump_load)
        finish = _start_at(after, jump_h0)
        self.pieces = [_joined(before, start), _joined(finish, after)]
        self.jumps = [(start, finish)]

    def draw(self, panel, x, length, load):
        if self.name == "path":
            self._draw_path(panel, x, length, load)
            return
        for i, piece in enumerate(self.pieces):
            points = smooth(np.column_stack([piece[x] / length, piece["load"] / load]))
            panel.plot(*points.T, solid_capstyle="round",
                       label=self.label if i == 0 else None, **self.style)
        if self.number:
            panel.plot(self.rows[x][0] / length, self.rows["load"][0] / load, "o",
                       markersize=self.style["linewidth"] + 2, color=self.style["color"],
                       zorder=4)

    def _draw_path(self, panel, x, length, load):
        labelled = set()
        start = 0
        # A piece includes the first row of the next, a fold, so that the pieces join.
        for stable, group in itertools.groupby(self.rows["stable"] != 0):
            finish = start + len(list(group))
            label = "path, stable" if stable else "path, unstable"
            rows = slice(start, finish + 1)
            points = smooth(np.column_stack([self.rows[x][rows] / length,
                                             self.rows["load"][rows] / load]))
            panel.plot(*points.T, linestyle="-" if stable else (0, (3, 1.5)),
                       label=None if label in labelled else label, **_PATH)
            labelled.add(label)
            start = finish

    def draw_arrows(self, panel, x, length, load):
        if self.name == "path":
            return
        color = self.style["color"]
        for start, finish in self.jumps:
            _arrow(panel, *((end[x][0] / length, end["load"][0] / load)
                            for end in (start, finish)), color, linewidth=1.0)
        # Arrows of loading and unloading are apart, since the curves often coincide.
        if self.number:
            fractions = (0.4 + 0.1 * min(self.number, 4), 0.4)
        elif self.name == "retreat":
            fractions = (0.4,)
        else:
            fractions = (0.25 if self.jumps else 0.75, 0.75)
        for piece, fraction in zip(self.pieces, fractions):
            ends = _stretch(panel, piece[x] / length, piece["load"] / load, fraction)
            if ends:
                _arrow(panel, *ends, color, linewidth=0)


def _style_of(name, number, count):
    if name == "loading":
        return _LOADING, name
    width = _WIDEST - (_WIDEST - _THINNEST) * (number - 1) / max(count - 1, 1)
    style = {"color": _UNLOADING[(number - 1) % len(_UNLOADING)], "linewidth": width, "zorder": 3}
    return style, "unloading" if count == 1 else f"unloading {number}"


def _joined(first, second):
    return {x: np.concatenate([first[x], second[x]]) for x in first}


def _end_at_fold(piece, h0, load):
    """Return the state before a jump.

    Near a fold the displacement is a smooth function of the square root of the distance in h0. It
    is not one of the load, which may have an extremum or be level before the fold.
    """
    before = {x: values[-3:] for x, values in piece.items()}
    root = np.sqrt(abs(before["h0"] - h0))
    displacement = piece["displacement"][-1]
    if root.size == 3 and (np.diff(root) < 0).all():
        displacement = _parabola(root, before["displacement"], 0.0)
    if not np.isfinite(load):
        load = piece["load"][-1]
    return {x: np.array([value]) for x, value in
            (("displacement", displacement), ("h0", h0), ("load", load), ("stable", 1))}


def _start_at(piece, h0):
    """Return the state after a jump, extrapolated from the next three states if they are smooth."""
    first = {x: values[:1] for x, values in piece.items()}
    if piece["h0"].size < 3:
        return first
    of = {x: _parabola(piece["h0"][:3], piece[x][:3], h0) for x in ("displacement", "load")}
    if any(abs(of[x] - piece[x][0]) > 2 * abs(piece[x][1] - piece[x][0]) for x in of):
        return first
    return {x: np.array([value]) for x, value in dict(of, h0=h0, stable=1).items()}


def _parabola(x, y, at):
    return sum(
        y[i] * np.prod([(at - x[j]) / (x[i] - x[j]) for j in range(3) if j != i]) for i in range(3)
    )


def _draw_theories(panel, theories, x, length, load):
    for theory, (label, style) in _THEORIES.items():
        rows = theories["theory"] == theory
        if rows.any():
            panel.plot(theories[x][rows] / length, theories["load"][rows] / load,
                       linewidth=1.0, zorder=7, label=label, **style)


def _frame(panel, curve, theories, x, length, load):
    """Show the whole curve, and the theories only in its range."""
    low, high = curve[x].min() / length, curve[x].max() / length
    margin = 0.05 * (high - low) or 1.0
    panel.set_xlim(low - margin, high + margin)
    low, high = min(curve["load"].min(), 0) / load, max(curve["load"].max(), 0) / load
    if theories and theories["load"].size:
        low = min(low, max(theories["load"].min() / load, 2 * low))
    margin = 0.05 * (high - low) or 1.0
    panel.set_ylim(low - margin, high + margin)


def _stretch(panel, x, y, fraction):
    """Return two neighbouring points of a curve at a fraction of its length on the page."""
    points = panel.transData.transform(np.column_stack([x, y]))
    along = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    if along[-1] * 72 / panel.figure.dpi < _LONG_ENOUGH:
        return None
    at = fraction * along[-1] + np.array([-1.0, 1.0])
    return zip(np.interp(at, along, x), np.interp(at, along, y))


def _arrow(panel, tail, head, color, linewidth):
    """Draw an arrow; linewidth 0: only its head, somewhat larger."""
    length, width = (0.5, 0.28) if linewidth else (0.6, 0.36)
    style = f"-|>,head_length={length},head_width={width}"
    arrow(panel, tail, head, color, linewidth or 0.1, style,
          (0, (2, 1.5)) if linewidth else "-").set_in_layout(False)


PICTURE = Picture(
    "curve", draw_force_curve, "force_curve.png",
    "Draw load against displacement and against h0, from a folder of results.",
    lambda files: "curve.csv" in files.texts)
