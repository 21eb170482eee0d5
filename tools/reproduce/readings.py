"""Fig. 10 again: readings of the paper's words about its mixing ratio, in one table."""

import concurrent.futures
import dataclasses
import functools
import math
import os

import curves
import draws
import mixing
import numpy as np
import pages
import penetrations
import report
import style

DECKS = ("fig10a_converged", "fig10b_converged", "fig10c_converged")
# Turning points [nm] of the table and of the picture, by letter of Fig. 10; sigma.
_TURNS = (1.0, -2.0, -4.0)
_CASES = {"a": (0.0, -2.0, -5.0), "b": (0.0, -2.0, -5.0), "c": (1.0, -2.0, -4.0, -10.0)}
_Z0, _RADIUS, _STIFFNESS, _EXTENT = 0.5, 1.5e-2, 1e10, 20e3
_LATERAL = 1e9 * math.sqrt(_RADIUS * _Z0 * 1e-9)
_RUNS = 2
_SMOOTH, _MUCH = 0.02, 0.7
BASE = mixing.Reading("as read for Fig. 10", spacing=100.0)
KEPT = dataclasses.replace(BASE, carried=True)
NEAREST = dataclasses.replace(KEPT, name="ratio kept, 500 iterations a step", passes=500)


def _readings():
    def base(name, **changes):
        return dataclasses.replace(BASE, name=name, **changes)

    def kept(name, **changes):
        return dataclasses.replace(KEPT, name=f"ratio kept, {name}", **changes)

    return (
        BASE, base("nodes 200 nm apart", spacing=200.0),
        base("pressure constant about nodes", interpolated=False),
        base("steps of 0.5 nm", step=0.5), base("ratio falls at any growth", growth=1.0),
        base("ratio falls to a tenth", fall=0.1), base("ratio at most 0.005", limit=0.005),
        base("change below 1e-5 nm", tolerance=1e-5),
        base("change before mixing below 1e-4 nm", unmixed=True),
        base("200 iterations a step", passes=200), kept("rule as read"),
        kept("change before mixing below 1e-4 nm", unmixed=True),
        kept("the same, steps of 0.1 nm", unmixed=True, step=0.1),
        kept("change before mixing below 1e-5 nm", unmixed=True, tolerance=1e-5),
        kept("50 iterations a step", passes=50), kept("200 iterations a step", passes=200),
        kept("the same, nodes 50 nm apart", passes=200, spacing=50.0), NEAREST)


def sigma_of(letter, draw=0):
    """Return sigma of a cycle of Fig. 10, in one of its runs."""
    hamaker = {"a": 2e-20, "b": 5e-20, "c": 1e-19}[letter] * (1 + draw * 1e-12)
    energy = hamaker / (16 * math.pi * (_Z0 * 1e-9) ** 2)
    return energy / _STIFFNESS * math.sqrt(_RADIUS / (_Z0 * 1e-9) ** 3)


def cycle(job):
    """Return the branches of (reading, letter, turning points [nm], draw)."""
    reading, letter, turns, draw = job
    scene = mixing.Scene(sigma_of(letter, draw), reading.spacing / _LATERAL, _EXTENT / _LATERAL,
                         reading.interpolated)
    return mixing.cycle(scene, reading, [turn / _Z0 for turn in turns], 6.0 / _Z0, 16.0 / _Z0, _Z0)


@functools.lru_cache(maxsize=None)
def _all():
    """Return all cycles by job, several at a time."""
    jobs = [(reading, "c", _TURNS, draw) for reading in _readings() for draw in range(_RUNS)]
    jobs += [(NEAREST, letter, turns, 0) for letter, turns in _CASES.items()]
    jobs.append((BASE, "c", _CASES["c"], 0))
    with concurrent.futures.ProcessPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        return dict(zip(jobs, pool.map(cycle, jobs)))


def tensions(branches):
    """Return the largest tensions of the branches over JKR's pull-off."""
    return [-branch.load.min() / (1.5 * math.pi) for branch in branches]


def _contact(branch):
    """Return the rows that are certainly in contact."""
    return branch[branch.displacement > -1.0]


def scatter(branches):
    """Return the root mean square of loads minus the mean of their neighbours, for the worst
    branch."""
    worst = 0.0
    for branch in branches:
        away = branch.load[1:-1] - (branch.load[:-2] + branch.load[2:]) / 2
        away = away[branch.displacement[1:-1] > -1.0]
        if away.size > 2:
            worst = max(worst, float(np.sqrt(np.mean(away**2))))
    return worst / (1.5 * math.pi)


def between(branches, sigma):
    """Return the position of JKR theory between loading (0) and the deepest unloading (1) in
    load at one displacement, on average from -1 to 1 nm; NaN if these cross."""
    at = np.linspace(-1, 1, 41) / _Z0
    _, displacement, load = curves.jkr_curve(1.0, 1.0, sigma, 40 * sigma)
    theory = np.interp(at, displacement, load / sigma)
    low, high = (curves.at(at, branch[branch.displacement > -4.0], "load", "displacement")
                 for branch in (branches[0], branches[-1]))
    # Unloading is under more tension.
    loop = np.mean(low - high)
    return float(np.mean(low - theory) / loop) if loop > 0.1 else np.nan


def statements(branches, sigma):
    """Return the statements of the paper, of five, that are true for a cycle."""
    loading, *pulls = tensions(branches)
    place = between(branches, sigma)
    steps = np.median(np.concatenate([branch.iterations for branch in branches]))
    return (scatter(branches) <= _SMOOTH, bool((np.diff(pulls) > _SMOOTH).all()),
            loading < _MUCH * min(pulls), bool(0 < place < 1), bool(50 <= steps <= 1000))


def _line(reading):
    runs = [_all()[reading, "c", _TURNS, draw] for draw in range(_RUNS)]
    columns = list(zip(*map(tensions, runs)))
    left = [np.median(np.concatenate([_contact(branch).residual for branch in run]))
            for run in runs]
    steps = [np.median(np.concatenate([branch.iterations for branch in run])) for run in runs]
    held = [sum(statements(run, sigma_of("c"))) for run in runs]
    return (reading.name, draws.ranged(columns[0]), draws.several(columns[1:]),
            draws.ranged([scatter(run) for run in runs], 3), draws.ranged(left, 1),
            draws.ranged(steps, 0), draws.ranged(held, 0))


def numbers(runs):
    nearest = {letter: _all()[NEAREST, letter, turns, 0] for letter, turns in _CASES.items()}
    contact = [*map(_contact, nearest["c"])]
    table = pages.table(("reading", "loading", "unloading", "scatter", "left [z0]", "iterations",
                         "of 5"), map(_line, _readings()), report.escaped)
    found = {"runs": _RUNS, "turns": penetrations.listed(_TURNS, 0), "smooth": _SMOOTH,
             "much": 1 - _MUCH, "table": "\n".join(table), "passes": NEAREST.passes,
             "between": between(nearest["c"], sigma_of("c")),
             "ratio": float(np.median(np.concatenate([rows.ratio for rows in contact]))),
             "left": draws.ranged([np.median(rows.residual) for rows in contact if rows.size], 1)}
    for letter, branches in nearest.items():
        loading, *pulls = tensions(branches)
        true = penetrations.over_jkr(runs[f"fig10{letter}_converged"])
        found |= {letter: penetrations.listed(pulls),
                  f"{letter}_true": penetrations.listed(true, 4),
                  f"true_{letter}": max(true), "loading": loading / min(pulls),
                  f"{letter}_turns": penetrations.listed(_CASES[letter], 0)}
    return found


def draw(_):
    """Return the picture: the nearest reading for the three sigma, and the old one for the last
    sigma."""
    page, panels = style.figure(2, 2, height=7.2)
    # Limits are in units of JKR's pull-off and in nm.
    looks = {"a": (-2, (-3, 6)), "b": (-2.3, (-7, 6.5)), "c": (-3, (-13, 11))}
    jobs = [(NEAREST, letter) for letter in _CASES] + [(BASE, "c")]
    for panel, (reading, letter) in zip(panels.ravel(), jobs):
        sigma, (least, y_range) = sigma_of(letter), looks[letter]
        # gamma R in uN.
        unit = sigma * _STIFFNESS / math.sqrt(_RADIUS / (_Z0 * 1e-9) ** 3) * _RADIUS * 1e6
        pull = 1.5 * math.pi * unit
        _, displacement, load = curves.jkr_curve(1.0, 1.0, sigma, 60 * sigma)
        panel.plot(load / sigma * unit, displacement * _Z0, color=style.BLACK, **style.DASHED,
                   linewidth=1.2, zorder=6)
        names = ["loading", *(style.signed(f"from {turn:g} nm") for turn in _CASES[letter])]
        lines = [{"color": color, "marker": marker, "linewidth": 0.6}
                 for color, marker in ((style.BLUE, "o"), *style.RETREATS)]
        for branch, line in zip(_all()[reading, letter, _CASES[letter], 0], lines):
            panel.plot(branch.load * unit, branch.displacement * _Z0, **line, markersize=2.4,
                       markeredgewidth=0)
        style.label(panel, "load [µN]", "central displacement [nm]", "xy",
                    "d" if reading is BASE else letter, xlim=(least * pull, 2 * pull), ylim=y_range)
        style.heading(panel, f"$\\sigma$ = {penetrations.FIG10[letter]}, "
                      + ("as read for Fig. 10" if reading is BASE else "ratio kept"), loc="center",
                      fontsize=9.5)
        style.explain(panel, [({**line, "markersize": 3.5}, name)
                              for line, name in zip(lines, names)],
                      loc="lower right", handlelength=1.4, labelspacing=0.3)
    return page
