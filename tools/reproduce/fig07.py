"""Fig. 7: pull-off against sigma, one value each, and the scatter under the paper's stopping
rule."""

import curves
import draws
import numpy as np
import penetrations
import style

DECKS = ("fig07_paper", "fig07_converged", "fig07_exact_sigma", "fig10a_paper", "fig10b_paper",
         "fig10c_paper", "fig10a_converged", "fig10b_converged", "fig10c_converged",
         "fig10c_uniform")
_TURNS = (0.0, -2e-9, -5e-9)
_BROKEN = 1.5
_MARKERS = (
    # Shallower than this [m], marker, colour, name.
    (-1e-9, "o", style.BLUE, "$h_0$ = 0 or 1 nm"),
    (-3e-9, "s", style.ORANGE, "$-$2 nm"),
    (-7e-9, "^", style.GREEN, "$-$4 or $-$5 nm"),
    (-1.0, "D", style.PURPLE, "$-$10 nm"),
)


def _paper(runs):
    """Return the Pulls with the paper's grid and rule: one tuple for each sigma and penetration,
    with all runs."""
    found = list(zip(*(penetrations.of_sweep(results, _TURNS)
                       for results in runs.draws("fig07_paper"))))
    return found + [pulls for cycle in penetrations.of_rule(runs).values() for pulls in cycle]


def _converged(runs, deck="fig07_converged"):
    columns = runs[deck].sweep
    return columns["sigma"], columns["max_tension"] / columns["jkr_pull_off"]


def numbers(runs):
    (sigma, ratio), (_, exact) = _converged(runs), _converged(runs, "fig07_exact_sigma")
    paper, rule, cycles = _paper(runs), penetrations.of_rule(runs), penetrations.converged(runs)
    coarse = penetrations.of_cycle(runs["fig10c_uniform"])
    columns, best = runs["fig07_converged"].sweep, runs["fig10c_converged"].summary
    # One list for each run; sigma is the same in all of them to twelve digits.
    true = [curves.cubic(np.log(pulls[0].sigma), np.log(sigma), ratio)[0] for pulls in paper]
    scattered = [[pull for pull, value in zip(run, true) if abs(pull.ratio / value - 1) > 0.1]
                 for run in zip(*paper)]
    factors = [max(ratios) / min(ratios) for pulls in paper if pulls[0].sigma > 1
               for ratios in [[pull.ratio for pull in pulls]]]
    weak = [pulls for pulls in paper if pulls[0].turn == 0 and pulls[0].sigma < 0.02]
    one = [pulls for pulls in paper[::-1] if abs(pulls[0].sigma - 0.8717) < 0.01]
    slopes = 1 + np.gradient(np.log(ratio), np.log(sigma))
    found = {
        "at_small": ratio[0], "at_large": ratio[-1], "at_087": exact[0], "at_87": exact[1],
        "agree": draws.within(max(map(penetrations.spread, cycles.values()))),
        "coarse_count": len(coarse),
        "coarse_off": 100 * (coarse[0].ratio / (best["max_tension"] / best["jkr_pull_off"]) - 1),
        "scattered": draws.ranged([len(run) for run in scattered], 0), "count": len(scattered),
        "first": min(pull.sigma for run in scattered for pull in run), "points": len(paper),
        "outside": draws.ranged([sum(pull.ratio > _BROKEN for pull in run)
                                 for run in zip(*paper)], 0),
        "factor": np.median(factors), "factor_most": max(factors), "broken": _BROKEN,
        "weak": penetrations.ranged(weak[:1], 5), "weak_sigma": weak[0][0].sigma,
        "least_sigma": sigma[0], "near_one": penetrations.ranged(one, 3),
        "one_turns": penetrations.turns([pulls[0] for pulls in one]),
        "coarse": penetrations.listed(coarse, 4), "coarse_turns": penetrations.turns(coarse),
        "most_sigma": sigma[-1], "over_jkr": 100 * (ratio[-1] - 1),
        # The paper's figures for mica: gamma 0.1 J/m^2, E 1e10 Pa, R 1e-2 m, z0 0.1 nm.
        "mica": 0.1 / 1e10 * np.sqrt(1e-2 / 1e-10**3),
        "apart": -columns["jump_out_load"][-1] / columns["jkr_pull_off"][-1],
        "steepest": slopes.min(), "steepest_at": sigma[np.argmin(slopes)]}
    for letter, pulls in cycles.items():
        found |= {f"sigma_{letter}": rule[letter][0][0].sigma,
                  f"rule_{letter}": penetrations.ranged(rule[letter]),
                  f"true_{letter}": f"{pulls[0].ratio:.6f}", f"runs_{letter}": len(rule[letter][0]),
                  f"turns_{letter}": penetrations.turns([each[0] for each in rule[letter]]),
                  f"agree_{letter}": draws.within(penetrations.spread(pulls))}
    found["error_0"], found["error_1"] = runs["fig07_exact_sigma"].sweep["error_estimate"]
    return found


def draw(runs):
    """Return the picture; its axis is broken at a range with unconverged values only."""
    page, (upper, lower) = style.figure(
        2, 1, height=5.0, sharex=True, gridspec_kw={"height_ratios": (1, 2.3), "hspace": 0.03})
    paper = _paper(runs)
    for panel in (upper, lower):
        panel.plot(*_converged(runs), color=style.BLACK, zorder=4, label="the equations")
        shallowest = 1.0
        for number, (deepest, marker, color, name) in enumerate(_MARKERS):
            chosen = [pulls for pulls in paper if deepest < pulls[0].turn <= shallowest]
            ratios = np.array([[pull.ratio for pull in pulls] for pulls in chosen])
            # Penetrations side by side, so that their bars do not hide each other.
            x = np.array([pulls[0].sigma for pulls in chosen]) * (1 + 0.09 * number)
            panel.vlines(x, ratios.min(axis=1), ratios.max(axis=1), color=color, linewidth=1.1,
                         zorder=4.5)
            middle = np.median(ratios, axis=1)
            here = (middle > _BROKEN) == (panel is upper)
            panel.plot(x[here], middle[here], marker, color=color, markerfacecolor="white",
                       markersize=4.5, zorder=5, linestyle="none", markeredgewidth=1.2, label=name)
            shallowest = deepest
        cycles = [pull for pulls in penetrations.converged(runs).values() for pull in pulls
                  if panel is lower]
        panel.plot([pull.sigma for pull in cycles], [pull.ratio for pull in cycles], "x",
                   color=style.VERMILION, markersize=6.5, markeredgewidth=1.6, zorder=6,
                   label="cycles of Fig. 10")
    found = [pull.ratio for pulls in paper for pull in pulls]
    upper.set_ylim(_BROKEN - 0.1, 1.12 * max(found))
    style.label(lower, "$\\sigma$", "pull-off / JKR", log="x", xlim=(0.28e-3, 1.3e3),
                ylim=(min(0.75, 0.96 * min(found)), _BROKEN), ticks=[10.0 ** np.arange(-3, 4)])
    lower.axhline(1, color=style.GREY, linewidth=0.9, linestyle="--", zorder=1)
    style.word(lower, 0.31e-3, 0.99, "JKR theory")
    style.arrow(lower, (0.3e-3, 4 / 3), (0.62e-3, 4 / 3), style.BLACK)
    style.word(lower, 0.31e-3, 1.35, "DMT\ntheory", style.BLACK, va="bottom", linespacing=1.0)
    upper.spines["bottom"].set_visible(False)
    upper.tick_params(bottom=False)
    for panel, at in ((upper, 0), (lower, 1)):
        panel.plot([0, 0], [at, at], transform=panel.transAxes, marker=[(-1, -0.6), (1, 0.6)],
                   markersize=9, linestyle="none", color=style.BLACK, clip_on=False)
    handles, names = upper.get_legend_handles_labels()
    upper.add_artist(upper.legend(
        [handles[0], handles[5]], [names[0], names[5]], title="converged", loc="upper right",
        bbox_to_anchor=(1.0, 1.05), alignment="left"))
    upper.legend(handles[1:5], names[1:5], title="paper's grid and rule,\nunloading from",
                 loc="upper right", bbox_to_anchor=(0.34, 1.05), alignment="left", ncols=1)
    style.statement(lower, "paper: several results for each large $\\sigma$,\n"
                    "neither theory appropriate", 0.015, 0.22)
    return page
