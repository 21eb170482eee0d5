"""Fig. 10: cycles from several turning points, by the paper's rule, on its grid, and converged."""

import curves
import draws
import numpy as np
import penetrations
import style
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
from published import Row

DECKS = ("fig10a_paper", "fig10b_paper", "fig10c_paper", "fig10a_converged", "fig10b_converged",
         "fig10c_converged", "fig10c_uniform", "fig10c_coarse", "fig07_converged")
TITLE = "Fig. 10: hysteresis and the penetration"
CAPTION = """Central displacement against load for σ = 1.7 (a), 4.4 (b) and 8.7 (c); unloading from
several turning points, dashed line JKR theory. Left of (a) to (c): uniform grid, nodes 50 nm apart,
with the paper's stopping rule as read here, one run in colours, {others} others that differ in A's
twelfth digit behind it in grey; right: converged. (d): σ = 8.7 on uniform grids with
the equations solved, nodes 100 nm apart (left, the paper's coarsest) and 200 nm (right).

Converged there is one contact branch. Loading and unloading run through the same states in contact,
whatever the penetration; the largest tension of all turning points is **{a:.5f}**, **{b:.5f}** and
**{c:.5f}** of JKR's, equal to {agree}. Hysteresis is real: the bodies jump in at one h0 and
apart at another (arrows), and lose energy, for all σ above a value between {none:.2f} and
{some:.2f} rather than about 1. JKR theory follows the contact branch: loads under tension differ by
up to {jkr_a:.0f} % of the pull-off for σ = 1.7 and {jkr:.0f} % for σ = 8.7. {reached}.

What the paper describes arises here in two ways. **The grid** makes loops. The neck at σ = 8.7 is
{neck:.0f} nm wide; nodes about as far apart hold the contact edge, which then follows late, inwards
and outwards. The result (d) fits the paper's description, on 200 nm, twice its coarsest grid,
better than on 100 nm: unloading leaves the loading at once and on a line of its own for each
penetration, these lines meet later, JKR theory lies between loading and unloading and somewhat
nearer to the former (at {fraction:.2f} of the way from one to the other for 200 nm,
{fraction_100:.2f} for 100 nm), and pull-off is too large, {uniform:.3f} and {coarse:.3f} of JKR's;
for 200 nm the lines meet about where the tension is largest. A grid that resolves the neck has none
of this. **The stopping rule** makes scatter: left, states are {residual} z0 from equilibrium at
worst, and the largest tension is that of single states: for σ = 8.7 and retreats from h0 = {turns}
nm the {runs} runs give {c_each} of JKR's. From the deepest turning point it is larger than from the
shallowest in {deeper} of {runs} runs, since a deeper retreat has more states of which to be the
largest; above the shallowest turning point, where all retreats pass, it is {c_common}. The rule scatters more than the paper's
words suggest. How its mixing ratio changes the paper says in words only (here it is halved when the
change of the central displacement turns round or doubles, else it grows by 5 %); how large its
steps of h0 are it does not say, nor how its kernel was integrated, on which the strength of the
pinning depends. A ratio that is kept from one h0 to the next gives smooth loops, and all that the paper says
of them: [readings of the mixing rule](#fig-10s-smooth-loops-readings-of-the-mixing-rule)."""

_PANELS = (
    # Letter, sigma as the paper gives it, limits of load [uN] and displacement [nm].
    ("a", "1.7", (-330, 520), (-2.6, 6.2)),
    ("b", "4.4", (-720, 780), (-4.4, 6.4)),
    ("c", "8.7", (-1500, 1900), (-6.6, 12.4)),
)
_COLORS = (style.ORANGE, style.GREEN, style.PURPLE, style.SKY)
_MARKERS = ("s", "^", "D", "v")


def _deeper(runs):
    """Return in how many runs the deepest retreat of Fig. 10(c) has a larger tension than the
    shallowest."""
    shallow, *_, deep = penetrations.of_runs(runs.draws("fig10c_paper"))
    return sum(two.ratio > one.ratio for one, two in zip(shallow, deep))


def _loading_of_unloading(results):
    """Return the largest tension of the loading over that of the unloadings."""
    return (-results.branch("loading")["load"].min()
            / np.max(results.summary["unload_max_tension"]))


def _reached(runs):
    """Say which approaches pass through the largest tension: it lies below the jump in."""
    yes, no = [], []
    for letter, sigma, *_ in _PANELS:
        summary = runs[f"fig10{letter}_converged"].summary
        (yes if summary["max_tension_h0"] < summary["jump_in_h0"] else no).append(sigma)
    return ("The approach passes through the largest tension for sigma = "
            f"{' and '.join(yes)}, just after the jump, but not for {' and '.join(no)}")


def _common(results):
    """Return the largest tension over JKR's of each retreat where all retreats pass."""
    summary, found = results.summary, []
    turns = np.atleast_1d(summary["unload_from"])
    for number in range(1, turns.size + 1):
        curve = results.branch(f"unloading_{number}")
        inside = curve["h0"] > turns.max() - 1e-13
        found.append(-curve["load"][inside].min() / summary["jkr_pull_off"])
    return found


def _first_jump(runs):
    columns = runs["fig07_converged"].sweep
    first = int(np.flatnonzero(np.isfinite(columns["jump_in_h0"]))[0])
    return columns["sigma"][first - 1], columns["sigma"][first]


def _pulls(runs):
    """Return the converged Pulls of each cycle."""
    return {letter: penetrations.of_cycle(runs[f"fig10{letter}_converged"])
            for letter in penetrations.FIG10}


def _rule_pulls(runs):
    """Return the Pulls by the paper's rule: of each cycle a tuple of all runs an unloading."""
    return {letter: penetrations.of_runs(runs.draws(f"fig10{letter}_paper"))
            for letter in penetrations.FIG10}


def _residuals(runs, letter):
    return [results.summary["worst_residual"] for results in runs.draws(f"fig10{letter}_paper")]


def numbers(runs):
    """Return what the caption quotes."""
    rule, true = _rule_pulls(runs), _pulls(runs)
    uniform = penetrations.of_cycle(runs["fig10c_uniform"])
    none, some = _first_jump(runs)
    return {
        "runs": len(rule["c"][0]), "others": len(rule["c"][0]) - 1,
        "turns": penetrations.turns([pulls[0] for pulls in rule["c"]]),
        "c_each": penetrations.ranged(rule["c"]), "deeper": _deeper(runs),
        "c_common": draws.several(zip(*map(_common, runs.draws("fig10c_paper")))),
        "residual": draws.ranged(_residuals(runs, "c"), 0),
        **{letter: pulls[0].ratio for letter, pulls in true.items()},
        "agree": draws.within(max(penetrations.spread(pulls) for pulls in true.values())),
        "uniform": uniform[-1].ratio,
        "coarse": penetrations.of_cycle(runs["fig10c_coarse"])[-1].ratio,
        "fraction": penetrations.between(runs["fig10c_coarse"]),
        "fraction_100": penetrations.between(runs["fig10c_uniform"]),
        "neck": 100 / runs["fig10c_uniform"].summary["spacing_over_neck"],
        "none": none, "some": some, "jkr": 100 * penetrations.jkr_apart(runs["fig10c_converged"]),
        "jkr_a": 100 * penetrations.jkr_apart(runs["fig10a_converged"]),
        "reached": _reached(runs).replace("sigma", "σ"),
    }


def draw(runs):
    """Return the picture."""
    page, panels = style.figure(4, 2, height=10.6, sharex="row", sharey="row")
    for pair, (letter, sigma, x_range, y_range) in zip(panels, _PANELS):
        for panel, kind, name in zip(pair, ("paper", "converged"),
                                     ("paper's grid and rule", "converged")):
            results = runs[f"fig10{letter}_{kind}"]
            displacement, load = penetrations.jkr(results, 1e-6 * x_range[1])
            panel.plot(load * 1e6, displacement * 1e9, color=style.BLACK, dashes=(5, 2),
                       linewidth=1.2, zorder=6)
            if kind == "paper":
                for other in runs.draws(f"fig10{letter}_paper")[1:]:
                    panel.plot(other.curve["load"] * 1e6, other.curve["displacement"] * 1e9, "o",
                               color=style.GREY, markersize=1.5, markeredgewidth=0, alpha=0.7,
                               zorder=1)
            (_draw_rule if kind == "paper" else _draw_converged)(panel, results, x_range, y_range)
            panel.set_xlim(*x_range)
            panel.xaxis.set_major_locator(MaxNLocator(4))
            panel.set_ylim(*y_range)
            style.label(panel, "load [µN]", "central displacement [nm]" if panel is pair[0] else "",
                        "xy")
            panel.set_title(f"({letter})", loc="left", fontweight="bold")
            panel.set_title(f"$\\sigma$ = {sigma}, {name}", fontsize=9.5)
        _legend(pair[0], runs[f"fig10{letter}_paper"])
    for panel, deck, spacing in zip(panels[3], ("fig10c_uniform", "fig10c_coarse"), (100, 200)):
        _draw_grid(panel, runs[deck])
        panel.set_title("(d)", loc="left", fontweight="bold")
        panel.set_title(f"$\\sigma$ = 8.7, {spacing} nm grid, solved", fontsize=9.5)
        style.label(panel, "load [µN]", "central displacement [nm]" if spacing == 100 else "", "xy")
    _legend(panels[3, 0], runs["fig10c_uniform"])
    style.statement(panels[3, 1], "paper: unloading differs\nwith penetration, JKR\nlies between",
                    0.985, 0.32, align="right")
    panels[0, 1].legend(
        *_handles([({"color": style.BLUE}, "loading"), ({"color": style.ORANGE}, "unloading: all"),
                   ({"color": style.BLACK, "dashes": (5, 2)}, "JKR theory")]), loc="lower right")
    return page


def _handles(entries):
    return [Line2D([], [], **kind) for kind, _ in entries], [name for _, name in entries]


def _legend(panel, results):
    entries = [({"color": style.BLUE, "marker": "o", "markersize": 3.5, "linewidth": 0.5},
                "loading")]
    entries += [({"color": color, "marker": marker, "markersize": 3.5, "linewidth": 0.5},
                 f"from {penetrations.turns([pull])} nm".replace("-", "\N{MINUS SIGN}"))
                for color, marker, pull in zip(_COLORS, _MARKERS, penetrations.of_cycle(results))]
    panel.legend(*_handles(entries), loc="lower right", bbox_to_anchor=(1.02, 0.05),
                 handlelength=1.4, labelspacing=0.35)


def _draw_rule(panel, results, x_range, y_range):
    """Draw every state, joined in the order in which they were computed."""
    count = np.atleast_1d(results.summary["unload_from"]).size
    branches = ["loading"] + [f"unloading_{i}" for i in range(1, count + 1)]
    kinds = [(style.BLUE, "o")] + list(zip(_COLORS, _MARKERS))
    outside = 0
    for branch, (color, marker) in zip(branches, kinds):
        curve = results.branch(branch)
        x, y = curve["load"] * 1e6, curve["displacement"] * 1e9
        panel.plot(x, y, marker=marker, color=color, linewidth=0, markersize=2.4,
                   markeredgewidth=0, zorder=3 if branch != "loading" else 4)
        panel.plot(x, y, color=color, linewidth=0.5, alpha=0.45, zorder=2)
        outside += int(((x < x_range[0]) | (x > x_range[1]) | (y < y_range[0])
                        | (y > y_range[1])).sum())
    if outside:
        panel.text(0.985, 0.015, f"{outside} of the run's states outside",
                   transform=panel.transAxes, ha="right", va="bottom", fontsize=8, color="#555555")


def _draw_grid(panel, results):
    """Draw the cycles as lines, broken at the jumps into contact and apart."""
    displacement, load = penetrations.jkr(results, 2e-4)
    panel.plot(load * 1e6, displacement * 1e9, color=style.BLACK, dashes=(5, 2), linewidth=1.2,
               zorder=6)
    count = np.atleast_1d(results.summary["unload_from"]).size
    kinds = [("loading", style.BLUE, "o", "contact")]
    kinds += [(f"unloading_{i + 1}", _COLORS[i], _MARKERS[i], "apart") for i in range(count)]
    for branch, color, marker, way in kinds:
        curve = results.branch(branch)
        x, y = curves.broken(curve, ("load", "displacement"), curves.jump(curve, way)[0])
        panel.plot(x * 1e6, y * 1e9, marker=marker, color=color, linewidth=0.9, markersize=3,
                   markeredgewidth=0, zorder=5 if branch == "loading" else 4)
        if branch in ("loading", penetrations.deepest(results)):
            _jump(panel, curve, *curves.jump(curve, way), color)
    panel.set_xlim(-850, 420)
    panel.set_ylim(-7, 5.2)


def _draw_converged(panel, results, x_range, y_range):
    """Draw the cycles, one on the other, and their jumps."""
    count = np.atleast_1d(results.summary["unload_from"]).size
    for number in range(count, 0, -1):
        curve = results.branch(f"unloading_{number}")
        before, _ = curves.jump(curve, "apart")
        x, y = curves.broken(curve, ("load", "displacement"), before)
        panel.plot(x * 1e6, y * 1e9, color=style.ORANGE, linewidth=3.4, zorder=2)
    loading = results.branch("loading")
    before, after = curves.jump(loading, "contact")
    x, y = curves.broken(loading, ("load", "displacement"), before)
    panel.plot(x * 1e6, y * 1e9, color=style.BLUE, linewidth=1.4, zorder=5)
    _jump(panel, loading, before, after, style.BLUE)
    deepest = results.branch(penetrations.deepest(results))
    _jump(panel, deepest, *curves.jump(deepest, "apart"), style.VERMILION)
    for number, pull in enumerate(penetrations.of_cycle(results), 1):
        curve = results.branch(f"unloading_{number}")
        x, y = curve["load"][0] * 1e6, curve["displacement"][0] * 1e9
        if x_range[0] < x < x_range[1] and y_range[0] < y < y_range[1]:
            panel.plot(x, y, "o", color=style.VERMILION, markersize=4.5, zorder=7)
            turn = penetrations.turns([pull]).replace("-", "\N{MINUS SIGN}")
            panel.annotate(f"{turn} nm", (x, y), (-8, 0), textcoords="offset points",
                           fontsize=8.5, ha="right", va="center", color=style.VERMILION)


def _jump(panel, curve, before, after, color):
    ends = [(curve["load"][i] * 1e6, curve["displacement"][i] * 1e9) for i in (before, after)]
    style.arrow(panel, *ends, color)


def rows(runs):
    """Return the statements of the paper, and how it computed."""
    rule, true = _rule_pulls(runs), _pulls(runs)
    uniform = penetrations.of_cycle(runs["fig10c_uniform"])
    coarse = penetrations.of_cycle(runs["fig10c_coarse"])
    words = {"a": "independent of penetration, within the noise", "b": "depends on penetration",
             "c": "greater for larger penetrations"}
    one = "The grid and the stopping rule decide: converged there is one contact branch"
    verdict = {"a": "The paper is right; here its rule scatters more than in its own hands",
               "b": one,
               "c": f"{one}; nodes 100 nm apart, solved: {penetrations.listed(uniform, 3)}; "
                    f"200 nm: {penetrations.listed(coarse, 3)} (from "
                    f"{penetrations.turns(coarse)} nm)"}
    found = [Row(f"Fig. 10({letter}), largest tension over JKR, sigma = {sigma}", words[letter],
                 penetrations.ranged(rule[letter]), penetrations.listed(true[letter], 5), "",
                 f"{len(rule[letter][0])} runs, unloading from h0 = "
                 f"{penetrations.turns(true[letter])} nm. {verdict[letter]}")
             for letter, sigma, *_ in _PANELS]
    none, some = _first_jump(runs)
    converged = [runs[f"fig10{letter}_converged"] for letter in penetrations.FIG10]
    some_runs = {letter: runs.draws(f"fig10{letter}_paper") for letter in penetrations.FIG10}
    iterations = np.concatenate([results.curve["iterations"] for letter in penetrations.FIG10
                                 for results in some_runs[letter]])
    products = np.concatenate([results.curve["iterations"] for results in converged])
    middle, high = np.percentile(iterations, (50, 95))
    found += [Row(f"Fig. 10({letter}), the same above the shallowest turning point", None,
                  draws.several(zip(*map(_common, some_runs[letter]))),
                  draws.several([[ratio] for ratio in _common(runs[f"fig10{letter}_converged"])]),
                  "", f"{len(some_runs[letter])} runs, where all retreats pass. "
                  "By the paper's rule a deeper retreat has more "
                  "states, each stopped anywhere, to be the one of largest tension")
              for letter, *_ in _PANELS]
    return [
        *found,
        Row("Fig. 10, largest tension of the loading over that of the unloading",
            "much less than 1",
            draws.several([_loading_of_unloading(results) for results in some_runs[letter]]
                          for letter in penetrations.FIG10),
            ", ".join(f"{_loading_of_unloading(results):.3f}" for results in converged), "",
            "sigma = 1.7, 4.4, 8.7, at steps of h0. "
            + _reached(runs)),
        Row("Fig. 10(c), JKR theory between loading (0) and unloading (1)",
            "approximately bisects, somewhat closer to loading",
            penetrations.between(runs["fig10c_coarse"]), "loading and unloading coincide", "",
            "computed: nodes 200 nm apart, equations solved, in load at displacements from -1 to 1 "
            f"nm; 100 nm: {penetrations.between(runs['fig10c_uniform']):.2f}. The loops are the "
            "grid's: the contact edge is held between nodes"),
        Row("Fig. 10, JKR theory beside the contact branch", "not really applicable", None,
            ", ".join(f"{100 * penetrations.jkr_apart(results):.1f}" for results in converged), "%",
            "largest difference in load from the contact branch at the same displacement under "
            "tension, over the pull-off, sigma = 1.7, 4.4, 8.7: JKR theory "
            "follows it"),
        Row("Fig. 10, sigma above which there is hysteresis", "about unity", None,
            f"{none:.3f} to {some:.3f}", "", "where the two jumps begin to differ"),
        Row("method, largest residual", "converged to within about 1e-4 nm",
            draws.ranged([0.5 * max(worst) for worst in zip(
                *(_residuals(runs, letter) for letter in penetrations.FIG10))], 0),
            draws.within(max(results.summary["worst_residual"] for results in converged) * 0.5),
            "nm",
            "the rule judges the change in one iteration, at a mixing ratio that the contact "
            "keeps small; what is left of the equations is the residual"),
        Row("method, iterations for one equilibrium", "50 to 1000",
            f"{middle:.0f} (median), {high:.0f} (95 %)",
            f"{np.median(products):.0f} (median), {np.percentile(products, 95):.0f} (95 %)", "",
            "mixing ratio up to 0.2, nodes 50 nm apart; converged: operator products of "
            "Anderson acceleration"),
        Row("method, nodes", "200-1500, 10-100 nm apart", "500-600, 50 nm apart",
            "panels locked to the contact edge", "",
            "not very sensitive to the grid, except for compliant bodies with large adhesion: "
            f"right; 100 nm puts the pull-off at sigma = 8.7 "
            f"{100 * (uniform[0].ratio / true['c'][0].ratio - 1):.1f} % too high"),
    ]
