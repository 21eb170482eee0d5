"""Fig. 10 once more: readings of what the paper says in words of its mixing ratio, one table."""

import concurrent.futures
import dataclasses
import functools
import math
import os

import curves
import draws
import mixing
import numpy as np
import style
from matplotlib.lines import Line2D
from published import Row

DECKS = ("fig10a_converged", "fig10b_converged", "fig10c_converged")
TITLE = "Fig. 10's smooth loops: readings of the mixing rule"
CAPTION = """The cycles of Fig. 10 are smooth, and larger from deeper turning points; by the rule as read for the
figure above they scatter. What the paper leaves open is tried here, in an iteration of its own
(`tools/reproduce/mixing.py`), for σ = 8.7, nodes 100 nm apart and steps of 0.25 nm unless the reading says
otherwise. Each reading is run {runs} times, σ changed in its twelfth digit; what differs is a range. *Loading* and *unloading* are the largest tensions over JKR's, the latter from h0 = {turns} nm;
*scatter* is how far a load is from the mean of its neighbours, root mean square on the worst branch, over JKR's
pull-off; *left* is the median of the largest residual in contact. Five statements of the paper are counted:
curves are smooth (scatter at most {smooth:g}); pull-off grows with each penetration; the loading's largest tension is
much less than any unloading's (by {much:g}); JKR theory lies between loading and unloading; 50 to 1000
iterations (median).

{table}

**Nearest are readings that keep the mixing ratio from one h0 to the next**, and stop after a number of
iterations or when the change of the central displacement before it is mixed is small. They are smooth and have
loops that grow with the penetration; so has a ratio that is small from the start, against the paper's 0.2. The picture has the one with {passes} iterations a step: loading and unloading
differ, unloading runs on a line of its own for each penetration, and JKR theory lies between, at {between:.2f} of the way
from loading to unloading. As in the paper the pull-off grows with the penetration for σ = 8.7 ({c}) and 4.4 ({b}),
and not, within the noise, for σ = 1.7 ({a}).

**What that says:** in contact the ratio is small, about {ratio:.0e} in the median, and one number of iterations
relaxes the edge of the contact only a part of the way before h0 goes on. The state lags behind h0 on the way in and
on the way out, as if the contact were viscous; started at the limit of 0.2 in each step, as read before,
the iteration overshoots instead, and scatters. The loops are states {left} z0 from equilibrium: with more
iterations, at σ = 1.7 for which {passes} nearly do, they close (largest tension {true_a:.4f} converged). So a ratio that is adjusted
all through a run, which is one reading of the paper's words, gives loops like those it prints, on a grid that it used.
All five statements hold where the number of iterations is fixed, which the paper does not say; with a stop at its 1e-4
nm loops are smooth and grow, but iterations are too few. That either is the authors' own program is not shown by that."""

# Turning points [nm] of the table and of the picture, by letter of Fig. 10; sigma.
_TURNS = (1.0, -2.0, -4.0)
_CASES = {"a": (0.0, -2.0, -5.0), "b": (0.0, -2.0, -5.0), "c": (1.0, -2.0, -4.0, -10.0)}
_NAMED = {"a": "1.7", "b": "4.4", "c": "8.7"}
_Z0, _RADIUS, _STIFFNESS, _EXTENT = 0.5, 1.5e-2, 1e10, 20e3
_LATERAL = 1e9 * math.sqrt(_RADIUS * _Z0 * 1e-9)
_RUNS = 2
_SMOOTH, _MUCH = 0.02, 0.7
_BASE = mixing.Reading("as read for Fig. 10", spacing=100.0)
_KEPT = dataclasses.replace(_BASE, carried=True)
_NEAREST = dataclasses.replace(_KEPT, name="ratio kept, 500 iterations a step", passes=500)


def _readings():
    """Return the readings of the table."""
    def base(name, **changes):
        return dataclasses.replace(_BASE, name=name, **changes)

    def kept(name, **changes):
        return dataclasses.replace(_KEPT, name=f"ratio kept, {name}", **changes)

    return (
        _BASE,
        base("nodes 200 nm apart", spacing=200.0),
        base("pressure constant about nodes", interpolated=False),
        base("steps of 0.5 nm", step=0.5),
        base("ratio falls at any growth", growth=1.0),
        base("ratio falls to a tenth", fall=0.1),
        base("ratio at most 0.005", limit=0.005),
        base("change below 1e-5 nm", tolerance=1e-5),
        base("change before mixing below 1e-4 nm", unmixed=True),
        base("200 iterations a step", passes=200),
        kept("rule as read"),
        kept("change before mixing below 1e-4 nm", unmixed=True),
        kept("the same, steps of 0.1 nm", unmixed=True, step=0.1),
        kept("change before mixing below 1e-5 nm", unmixed=True, tolerance=1e-5),
        kept("50 iterations a step", passes=50),
        kept("200 iterations a step", passes=200),
        kept("the same, nodes 50 nm apart", passes=200, spacing=50.0),
        _NEAREST,
    )


def _sigma(letter, draw=0):
    """Return sigma of a cycle of Fig. 10, in one of its runs."""
    hamaker = {"a": 2e-20, "b": 5e-20, "c": 1e-19}[letter] * (1 + draw * 1e-12)
    energy = hamaker / (16 * math.pi * (_Z0 * 1e-9) ** 2)
    return energy / _STIFFNESS * math.sqrt(_RADIUS / (_Z0 * 1e-9) ** 3)


def _cycle(job):
    """Return the branches of (reading, letter, turning points [nm], draw)."""
    reading, letter, turns, draw = job
    scene = mixing.Scene(_sigma(letter, draw), reading.spacing / _LATERAL, _EXTENT / _LATERAL,
                         reading.interpolated)
    return mixing.cycle(scene, reading, [turn / _Z0 for turn in turns], 6.0 / _Z0, 16.0 / _Z0,
                        _Z0)


@functools.lru_cache(maxsize=None)
def _all():
    """Return all cycles by job, some at a time."""
    jobs = [(reading, "c", _TURNS, draw) for reading in _readings() for draw in range(_RUNS)]
    jobs += [(_NEAREST, letter, turns, 0) for letter, turns in _CASES.items()]
    jobs.append((_BASE, "c", _CASES["c"], 0))
    with concurrent.futures.ProcessPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        return dict(zip(jobs, pool.map(_cycle, jobs)))


def tensions(branches):
    """Return the largest tensions of the branches over JKR's pull-off."""
    return [-branch.load.min() / (1.5 * math.pi) for branch in branches]


def _contact(branch):
    """Return the rows that are surely in contact."""
    return np.flatnonzero(branch.displacement > -1.0)


def scatter(branches):
    """Return the root mean square of loads less the mean of their neighbours, the worst branch's."""
    worst = 0.0
    for branch in branches:
        rows = _contact(branch)
        rows = rows[(rows > 0) & (rows < branch.load.size - 1)]
        if rows.size > 2:
            between = (branch.load[rows - 1] + branch.load[rows + 1]) / 2
            worst = max(worst, float(np.sqrt(np.mean((branch.load[rows] - between) ** 2))))
    return worst / (1.5 * math.pi)


def between(branches, sigma):
    """Return where JKR theory lies between loading (0) and the deepest unloading (1) in load at one
    displacement, on average from -1 to 1 nm; NaN where these cross."""
    at = np.linspace(-1, 1, 41) / _Z0
    _, displacement, load = curves.jkr_curve(1.0, 1.0, sigma, 40 * sigma)
    theory = np.interp(at, displacement, load / sigma)
    low, high = (_load_at(branch, at) for branch in (branches[0], branches[-1]))
    # Unloading is under more tension.
    return float(np.mean(low - theory) / np.mean(low - high)) if np.mean(low - high) > 0.1 else np.nan


def _load_at(branch, displacement):
    rows = np.flatnonzero(branch.displacement > -4.0)
    rows = rows[np.argsort(branch.displacement[rows])]
    return np.interp(displacement, branch.displacement[rows], branch.load[rows])


def statements(branches, sigma):
    """Return which of the five statements of the paper hold of a cycle."""
    loading, *pulls = tensions(branches)
    place = between(branches, sigma)
    steps = np.median(np.concatenate([branch.iterations for branch in branches]))
    return (scatter(branches) <= _SMOOTH, bool((np.diff(pulls) > _SMOOTH).all()),
            loading < _MUCH * min(pulls), bool(0 < place < 1), bool(50 <= steps <= 1000))


def _line(reading):
    """Return a line of the table."""
    runs = [_all()[reading, "c", _TURNS, draw] for draw in range(_RUNS)]
    columns = list(zip(*map(tensions, runs)))
    left = [np.median(np.concatenate([branch.residual[_contact(branch)] for branch in run]))
            for run in runs]
    steps = [np.median(np.concatenate([branch.iterations for branch in run])) for run in runs]
    held = [sum(statements(run, _sigma("c"))) for run in runs]
    cells = (reading.name, draws.ranged(columns[0]), draws.several(columns[1:]),
             draws.ranged([scatter(run) for run in runs], 3), draws.ranged(left, 1),
             draws.ranged(steps, 0), draws.ranged(held, 0))
    return "| " + " | ".join(cells) + " |"


def _table():
    head = ("reading", "loading", "unloading", "scatter", "left [z0]", "iterations", "of 5")
    return "\n".join(["| " + " | ".join(head) + " |", "|" + "---|" * len(head),
                      *map(_line, _readings())])


def _pulls(letter):
    return tensions(_all()[_NEAREST, letter, _CASES[letter], 0])


def _listed(values, digits=2):
    return ", ".join(f"{value:.{digits}f}" for value in values)


def numbers(runs):
    """Return what the caption quotes."""
    nearest = _all()[_NEAREST, "c", _CASES["c"], 0]
    left = [np.median(branch.residual[rows]) for branch in nearest
            if (rows := _contact(branch)).size]
    summary = runs["fig10a_converged"].summary
    return {"runs": _RUNS, "turns": ", ".join(f"{turn:g}" for turn in _TURNS), "smooth": _SMOOTH,
            "much": 1 - _MUCH, "table": _table(), "passes": _NEAREST.passes,
            "between": between(nearest, _sigma("c")),
            **{letter: _listed(_pulls(letter)[1:]) for letter in _CASES},
            "ratio": float(np.median(np.concatenate([branch.ratio[_contact(branch)]
                                                     for branch in nearest]))),
            "left": draws.ranged(left, 1),
            "true_a": np.max(summary["unload_max_tension"]) / summary["jkr_pull_off"]}


_COLORS = (style.ORANGE, style.GREEN, style.PURPLE, style.SKY)
_MARKERS = ("s", "^", "D", "v")


def draw(_):
    """Return the picture: the nearest reading for the three sigma, and the old one for the last."""
    page, panels = style.figure(2, 2, height=7.2)
    jobs = [(_NEAREST, letter) for letter in _CASES] + [(_BASE, "c")]
    for panel, (reading, letter) in zip(panels.ravel(), jobs):
        branches = _all()[reading, letter, _CASES[letter], 0]
        sigma = _sigma(letter)
        # gamma R in uN.
        unit = sigma * _STIFFNESS / math.sqrt(_RADIUS / (_Z0 * 1e-9) ** 3) * _RADIUS * 1e6
        _, displacement, load = curves.jkr_curve(1.0, 1.0, sigma, 60 * sigma)
        panel.plot(load / sigma * unit, displacement * _Z0, color=style.BLACK, dashes=(5, 2),
                   linewidth=1.2, zorder=6)
        kinds = [(style.BLUE, "o")] + list(zip(_COLORS, _MARKERS))
        for branch, (color, marker) in zip(branches, kinds):
            panel.plot(branch.load * unit, branch.displacement * _Z0, color=color, marker=marker,
                       markersize=2.4, linewidth=0.6, markeredgewidth=0)
        pull = 1.5 * math.pi * unit
        panel.set_xlim({"a": -2, "b": -2.3, "c": -3}[letter] * pull, 2 * pull)
        panel.set_ylim({"a": -3, "b": -7, "c": -13}[letter], {"a": 6, "b": 6.5, "c": 11}[letter])
        style.letter(panel, "d" if reading is _BASE else letter)
        panel.set_title(f"$\\sigma$ = {_NAMED[letter]}, "
                        + ("as read for Fig. 10" if reading is _BASE else "ratio kept"), fontsize=9.5)
        style.label(panel, "load [µN]", "central displacement [nm]", "xy")
        handles = [Line2D([], [], color=style.BLUE, marker="o", markersize=3.5, linewidth=0.6)]
        handles += [Line2D([], [], color=color, marker=marker, markersize=3.5, linewidth=0.6)
                    for (color, marker), _ in zip(kinds[1:], _CASES[letter])]
        panel.legend(handles, ["loading", *(f"from {turn:g} nm".replace("-", "\N{MINUS SIGN}")
                                            for turn in _CASES[letter])],
                     loc="lower right", handlelength=1.4, labelspacing=0.3)
    return page


def rows(runs):
    """Return the paper's words beside the nearest reading and what is converged."""
    found = []
    words = {"a": "independent of penetration, within the noise", "b": "depends on penetration",
             "c": "greater for larger penetrations"}
    for letter, turns in _CASES.items():
        summary = runs[f"fig10{letter}_converged"].summary
        true = np.ravel(summary["unload_max_tension"]) / summary["jkr_pull_off"]
        found.append(Row(
            f"Fig. 10({letter}) with the mixing ratio kept, largest tension over JKR, sigma = "
            f"{_NAMED[letter]}", words[letter], _listed(_pulls(letter)[1:]), _listed(true, 4), "",
            f"unloading from h0 = {', '.join(f'{turn:g}' for turn in turns)} nm; computed: "
            f"{_NEAREST.passes} iterations a step, nodes 100 nm apart"))
    nearest = _all()[_NEAREST, "c", _CASES["c"], 0]
    found += [
        Row("Fig. 10(c) with the mixing ratio kept, loading over unloading, largest tension",
            "much less than 1", tensions(nearest)[0] / min(tensions(nearest)[1:]), "0.999", "",
            "the smallest of the unloadings"),
        Row("Fig. 10(c) with the mixing ratio kept, JKR theory between loading (0) and unloading (1)",
            "approximately bisects, somewhat closer to loading", between(nearest, _sigma("c")),
            "loading and unloading coincide", "", "in load, at displacements from -1 to 1 nm")]
    return found
