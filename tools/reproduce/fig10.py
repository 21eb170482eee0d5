"""Fig. 10: cycles from several turning points, by the paper's rule, on its grid, and converged."""

import curves
import draws
import numpy as np
import penetrations
import style
from matplotlib.ticker import MaxNLocator

DECKS = ("fig10a_paper", "fig10b_paper", "fig10c_paper", "fig10a_converged", "fig10b_converged",
         "fig10c_converged", "fig10c_uniform", "fig10c_coarse", "fig07_converged")
# Limits of load [uN] and displacement [nm].
_LIMITS = {"a": ((-330, 520), (-2.6, 6.2)), "b": ((-720, 780), (-4.4, 6.4)),
           "c": ((-1500, 1900), (-6.6, 12.4))}


def _reached(converged):
    """Return which approaches pass through the largest tension, which lies below the jump in."""
    yes, no = ([sigma for letter, sigma in penetrations.FIG10.items()
                if (converged[letter].summary["max_tension_h0"]
                    < converged[letter].summary["jump_in_h0"]) == passes]
               for passes in (True, False))
    return ("The approach passes through the largest tension for sigma = "
            f"{' and '.join(yes)}, just after the jump, but not for {' and '.join(no)}")


def _common(results):
    """Return the largest tension over JKR's of each unloading for h0 that all pass."""
    summary = results.summary
    passed = np.max(summary["unload_from"]) - 1e-13
    return [-curve["load"][curve["h0"] > passed].min() / summary["jkr_pull_off"]
            for curve in map(results.branch, penetrations.branches(results))]


def _loading_over_unloading(results):
    return (-results.branch("loading")["load"].min()
            / np.max(results.summary["unload_max_tension"]))


def numbers(runs):
    rule, true = penetrations.of_rule(runs), penetrations.converged(runs)
    uniform, coarse = (penetrations.over_jkr(runs[f"fig10c_{kind}"])
                       for kind in ("uniform", "coarse"))
    some = {letter: runs.draws(f"fig10{letter}_paper") for letter in rule}
    converged = {letter: runs[f"fig10{letter}_converged"] for letter in rule}
    turns = {letter: penetrations.turns(one.summary["unload_from"])
             for letter, one in converged.items()}
    sweep = runs["fig07_converged"].sweep
    first = int(np.flatnonzero(np.isfinite(sweep["jump_in_h0"]))[0])
    left = {letter: [one.summary["worst_residual"] for one in each]
            for letter, each in some.items()}
    iterations = np.concatenate([one.curve["iterations"] for each in some.values() for one in each])
    products = np.concatenate([one.curve["iterations"] for one in converged.values()])
    apart = {letter: 100 * penetrations.jkr_apart(one) for letter, one in converged.items()}
    found = {
        "runs": len(some["c"]), "others": len(some["c"]) - 1, "turns": turns["c"],
        "deeper": (rule["c"][-1] > rule["c"][0]).sum(), "residual": draws.ranged(left["c"], 0),
        "agree": draws.within(max(map(np.ptp, true.values()))),
        "uniform": uniform[-1], "coarse": coarse[-1],
        "uniform_listed": penetrations.listed(uniform, 3),
        "coarse_listed": penetrations.listed(coarse, 3),
        "coarse_turns": penetrations.turns(runs["fig10c_coarse"].summary["unload_from"]),
        "fraction": penetrations.between(runs["fig10c_coarse"]),
        "fraction_100": penetrations.between(runs["fig10c_uniform"]),
        "neck": 100 / runs["fig10c_uniform"].summary["spacing_over_neck"],
        "none": sweep["sigma"][first - 1], "some": sweep["sigma"][first], "jkr": apart["c"],
        "jkr_a": apart["a"], "jkr_all": penetrations.listed(apart.values(), 1),
        "reached_here": _reached(converged), "reached": _reached(converged).replace("sigma", "σ"),
        "much_less": draws.several([_loading_over_unloading(one) for one in each]
                                   for each in some.values()),
        "much_less_true": penetrations.listed(map(_loading_over_unloading, converged.values()), 3),
        "left": draws.ranged([0.5 * max(worst) for worst in zip(*left.values())], 0),
        "left_true": draws.within(
            max(one.summary["worst_residual"] for one in converged.values()) * 0.5),
        "too_high": 100 * (uniform[0] / true["c"][0] - 1)}
    for key, values in (("iterations", iterations), ("products", products)):
        found[f"{key}_median"], found[f"{key}_most"] = np.percentile(values, (50, 95))
    for letter, ratios in true.items():
        found |= {letter: ratios[0], f"{letter}_each": draws.several(rule[letter]),
                  f"{letter}_true": penetrations.listed(ratios, 5),
                  f"{letter}_turns": turns[letter], f"{letter}_runs": len(some[letter]),
                  f"{letter}_common": draws.several(zip(*map(_common, some[letter]))),
                  f"{letter}_common_true": penetrations.listed(_common(converged[letter]))}
    return found


def draw(runs):
    page, panels = style.figure(4, 2, height=10.6, sharex="row", sharey="row")
    for pair, (letter, sigma) in zip(panels, penetrations.FIG10.items()):
        ranges = _LIMITS[letter]
        for panel, kind, name, how in zip(pair, ("paper", "converged"), (
                "paper's grid and rule", "converged"), (_draw_rule, _draw_converged)):
            if kind == "paper":
                for other in runs.draws(f"fig10{letter}_paper")[1:]:
                    panel.plot(*curves.drawn(other.curve), "o", color=style.GREY, markersize=1.5,
                               markeredgewidth=0, alpha=0.7, zorder=1)
            _dress(panel, runs[f"fig10{letter}_{kind}"], letter, f"{sigma}, {name}", how, *ranges)
            panel.xaxis.set_major_locator(MaxNLocator(4))
        _legend(pair[0], runs[f"fig10{letter}_paper"])
    for panel, kind, spacing in zip(panels[3], ("uniform", "coarse"), (100, 200)):
        _dress(panel, runs[f"fig10c_{kind}"], "d", f"8.7, {spacing} nm grid, solved", _draw_grid,
               (-850, 420), (-7, 5.2))
    for panel in panels[:, 1]:
        panel.set_ylabel("")
    _legend(panels[3, 0], runs["fig10c_uniform"])
    style.statement(panels[3, 1], "paper: unloading differs\nwith penetration, JKR\nlies between",
                    0.985, 0.32, align="right")
    style.explain(panels[0, 1], (
        ({"color": style.BLUE}, "loading"), ({"color": style.ORANGE}, "unloading: all"),
        ({"color": style.BLACK, **style.DASHED}, "JKR theory")), loc="lower right")
    return page


def _dress(panel, results, letter, title, how, x_range, y_range):
    """Draw JKR theory and a cycle, and label the panel; `how` describes the method."""
    displacement, load = penetrations.jkr(results, 1e-6 * x_range[1] if letter != "d" else 2e-4)
    panel.plot(load * 1e6, displacement * 1e9, color=style.BLACK, **style.DASHED, linewidth=1.2,
               zorder=6)
    how(panel, results, x_range, y_range)
    style.label(panel, "load [µN]", "central displacement [nm]", "xy", letter, xlim=x_range,
                ylim=y_range)
    style.heading(panel, f"$\\sigma$ = {title}", loc="center", fontsize=9.5)


def _legend(panel, results):
    names = ["loading", *(style.signed(f"from {penetrations.turns([turn])} nm")
                          for turn in results.summary["unload_from"])]
    style.explain(panel, [
        ({"color": color, "marker": marker, "markersize": 3.5, "linewidth": 0.5}, name)
        for (_, color, marker, _), name in zip(_kinds(results), names)],
        loc="lower right", bbox_to_anchor=(1.02, 0.05), handlelength=1.4, labelspacing=0.35)


def _kinds(results):
    """Return branches, colours, markers and the direction of the jump of each."""
    return [("loading", style.BLUE, "o", "contact"),
            *((branch, color, marker, "apart") for branch, (color, marker) in zip(
                penetrations.branches(results), style.RETREATS))]


def _draw_rule(panel, results, x_range, y_range):
    """Draw every state; lines join the states in the order of computation."""
    outside = 0
    for branch, color, marker, _ in _kinds(results):
        x, y = curves.drawn(results.branch(branch))
        panel.plot(x, y, marker=marker, color=color, linewidth=0, markersize=2.4,
                   markeredgewidth=0, zorder=3 if branch != "loading" else 4)
        panel.plot(x, y, color=color, linewidth=0.5, alpha=0.45, zorder=2)
        outside += int(((x < x_range[0]) | (x > x_range[1]) | (y < y_range[0])
                        | (y > y_range[1])).sum())
    if outside:
        style.word(panel, 0.985, 0.015, f"{outside} of the run's states outside", ha="right",
                   transform=panel.transAxes, va="bottom", fontsize=8)


def _draw_grid(panel, results, *_):
    """Draw the cycles as lines, broken at the jumps into contact and apart."""
    for branch, color, marker, way in _kinds(results):
        curve = results.branch(branch)
        panel.plot(*curves.drawn(curve, way), marker=marker, color=color, linewidth=0.9,
                   markersize=3, markeredgewidth=0, zorder=5 if branch == "loading" else 4)
        if branch in ("loading", penetrations.branches(results)[-1]):
            style.arrow(panel, *curves.jump_ends(curve, way), color)


def _draw_converged(panel, results, x_range, y_range):
    """Draw the cycles, which coincide, and their jumps."""
    for branch in penetrations.branches(results)[::-1]:
        panel.plot(*curves.drawn(results.branch(branch), "apart"), color=style.ORANGE,
                   linewidth=3.4, zorder=2)
    panel.plot(*curves.drawn(results.branch("loading"), "contact"), color=style.BLUE, linewidth=1.4,
               zorder=5)
    for branch, way, color in (("loading", "contact", style.BLUE),
                               (penetrations.branches(results)[-1], "apart", style.VERMILION)):
        style.arrow(panel, *curves.jump_ends(results.branch(branch), way), color)
    for branch, turn in zip(penetrations.branches(results), results.summary["unload_from"]):
        x, y = (values[0] for values in curves.drawn(results.branch(branch)))
        if x_range[0] < x < x_range[1] and y_range[0] < y < y_range[1]:
            panel.plot(x, y, "o", color=style.VERMILION, markersize=4.5, zorder=7)
            panel.annotate(style.signed(f"{penetrations.turns([turn])} nm"), (x, y), (-8, 0),
                           textcoords="offset points", fontsize=8.5, ha="right", va="center",
                           color=style.VERMILION)
