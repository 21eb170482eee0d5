"""The dependence of pull-off on the penetration: the effects of grid and stopping rule,
separately."""

import draws
import numpy as np
import penetrations
import style

# Letter of Fig. 10 and turning points [m].
_CASES = {"a": (0.0, -2e-9, -5e-9), "b": (0.0, -2e-9, -5e-9), "c": (1e-9, -2e-9, -4e-9, -10e-9)}
_RULES = ("paper", "residual")
# The decks that take longest come first.
DECKS = (*(f"history_{letter}_{rule}" for letter in "cba" for rule in _RULES),
         *(f"fig10{letter}_converged" for letter in _CASES))
_LOOKS = (*style.RETREATS[:3], (style.BLUE, "o"))
# Spacing over the width of the cohesive zone up to which the program calls a grid resolved.
_RESOLVED = 0.2


def _pulls(results, turns):
    """Return spacings over the zone, finest first, largest residuals, and pull-offs over JKR's,
    one row for each turning point."""
    cases = np.sort(results.sweep, order="spacing_over_neck")
    pulls = penetrations.of_sweep(cases, len(turns))
    return cases["spacing_over_neck"], cases["worst_residual"], pulls


def _by_rule(runs, letter):
    """Return these for all runs by the paper's rule, residuals and pull-offs by run first."""
    spacings, left, pulls = zip(*(_pulls(results, _CASES[letter])
                                  for results in runs.draws(f"history_{letter}_paper")))
    return spacings[0], np.array(left), np.array(pulls)


def _true(runs, letter):
    return penetrations.over_jkr(runs[f"fig10{letter}_converged"])[-1]


def _at(spacing, wanted):
    return int(np.argmin(abs(np.log(spacing / wanted))))


def _shown(percent):
    """Return per cent as text; a difference due to rounding has no significant digit."""
    return f"{percent:.1g}" if percent >= 1e-7 else "less than 1e-7"


def numbers(runs):
    found, apart = {}, {"coarse": [], "two": [], "one": [], "fine": []}
    factors, scatter = [], []
    for letter, turns in _CASES.items():
        spacing, _, solved = _pulls(runs[f"history_{letter}_residual"], turns)
        percent = 100 * np.ptp(solved, axis=0) / np.min(solved, axis=0)
        for name, width in (("coarse", 4), ("two", 2), ("one", 1)):
            apart[name].append(percent[_at(spacing, width)])
        apart["fine"].append(percent[spacing < 1.05 * _RESOLVED].max())
        grids, left, pulls = _by_rule(runs, letter)
        factors.extend(np.ravel(pulls[:, -1] / pulls[:, 0]))
        scatter.extend(np.ravel(pulls.max(axis=0) / pulls.min(axis=0)))
        # The finest grid of both methods, for comparison.
        both, one = _at(spacing, grids[0]), _at(spacing, 1)
        for key, value in (
                ("turns", penetrations.turns(turns)), ("coarse", solved[-1, _at(spacing, 4)]),
                ("one", solved[-1, one]), ("fine", solved[-1, 0]), ("finest", spacing[0]),
                ("true", _true(runs, letter)), ("rule_finest", grids[0]),
                ("left", draws.ranged(left[:, 0], 0)), ("runs", len(pulls)),
                ("rule", draws.several(pulls[:, :, 0].T)), ("both", spacing[both]),
                ("solved", penetrations.listed(solved[:, both], 4)), ("width", spacing[one]),
                ("rule_one", draws.several(pulls[:, :, _at(grids, 1)].T)),
                ("solved_one", penetrations.listed(solved[:, one], 4))):
            found[f"{key}_{letter}"] = value
    return {**found, "spread_coarse": max(apart["coarse"]),
            **{f"spread_{key}": _shown(max(apart[key])) for key in ("two", "one", "fine")},
            "grows": sum(factor > 1 for factor in factors),
            "cases": len(factors), "factor": np.median(factors), "scatter": np.median(scatter),
            "scatter_most": max(scatter)}


def draw(runs):
    """Return the picture: the paper's rule above, the equations solved below."""
    page, panels = style.figure(2, 3, height=5.6, sharex=True, sharey="row")
    for row, rule, y_ticks, limits in zip(panels, _RULES, ([0.5, 1, 2, 5], [1, 1.5, 2, 3, 4]),
                                          ((0.3, 12), (0.95, 4.6))):
        for panel, (letter, turns) in zip(row, _CASES.items()):
            panel.axhline(_true(runs, letter), color=style.BLACK, **style.DASHED, linewidth=1.2,
                          zorder=6, label="converged")
            panel.axvline(_RESOLVED, color=style.GREY, linewidth=0.6, zorder=0)
            spacing, _, pulls = (_by_rule(runs, letter) if rule == "paper" else
                                 _pulls(runs[f"history_{letter}_residual"], turns))
            for number, (turn, (color, marker)) in enumerate(zip(turns, _LOOKS)):
                if rule == "paper":
                    # Side by side, so that the bars do not hide each other.
                    style.spread(panel, spacing * 1.06 ** (number - 1), pulls[:, number], marker,
                                 color, line=0.7, markersize=4, zorder=2 + number)
                else:
                    # The first markers are larger, since the lines of the solved equations
                    # coincide.
                    panel.plot(spacing, pulls[number], color=color, marker=marker,
                               markersize=6.5 - 1.3 * number, linewidth=2.6 - 0.6 * number,
                               zorder=2 + number,
                               label=style.signed(f"from {penetrations.turns([turn])} nm"))
            style.label(panel, "", "", log="xy", ticks=([0.1, 0.3, 1, 3], y_ticks),
                        xlim=(0.085, 5), ylim=limits, letter=letter if rule == "paper" else "")
            if rule == "paper":
                style.heading(panel, f"$\\sigma$ = {penetrations.FIG10[letter]}", loc="center")
            else:
                panel.legend(loc="upper left", handlelength=1.4, labelspacing=0.3,
                             borderaxespad=0.1, frameon=True, facecolor="white",
                             edgecolor="none", framealpha=1)
    panels[0, 0].set_ylabel("pull-off / JKR,\npaper's stopping rule")
    panels[1, 0].set_ylabel("pull-off / JKR,\nequations solved")
    panels[1, 1].set_xlabel("distance between nodes / width of the neck")
    return page
