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
    """Return sigma, turning point and, in rows, the ratios of all runs with the paper's grid and
    rule, for each sigma and penetration."""
    sweeps = [results.sweep for results in runs.draws("fig07_paper")]
    ratios = np.moveaxis([penetrations.of_sweep(sweep, len(_TURNS)) for sweep in sweeps], 0, -1)
    rows = sorted(((sigma, turn, ratio) for turn, each in zip(_TURNS, ratios)
                   for sigma, ratio in zip(sweeps[0]["sigma"], each)), key=lambda row: row[:2])
    for letter, cycle in penetrations.of_rule(runs).items():
        summary = runs[f"fig10{letter}_paper"].summary
        rows += [(summary["sigma"], turn, ratio)
                 for turn, ratio in zip(summary["unload_from"], cycle)]
    return [np.array(column) for column in zip(*rows)]


def _converged(runs, deck="fig07_converged"):
    columns = runs[deck].sweep
    return columns["sigma"], columns["max_tension"] / columns["jkr_pull_off"]


def numbers(runs):
    (sigma, ratio), (_, exact) = _converged(runs), _converged(runs, "fig07_exact_sigma")
    rule, cycles, (sigmas, turns, ratios) = (
        penetrations.of_rule(runs), penetrations.converged(runs), _paper(runs))
    coarse, columns = penetrations.over_jkr(runs["fig10c_uniform"]), runs["fig07_converged"].sweep
    best = runs["fig10c_converged"].summary
    true = curves.cubic(np.log(sigmas), np.log(sigma), ratio)
    scattered = abs(ratios / true[:, None] - 1) > 0.1
    factors = (ratios.max(axis=1) / ratios.min(axis=1))[sigmas > 1]
    weak = np.flatnonzero((turns == 0) & (sigmas < 0.02))[0]
    one = np.flatnonzero(abs(sigmas - 0.8717) < 0.01)[::-1]
    slopes = 1 + np.gradient(np.log(ratio), np.log(sigma))
    found = {
        "at_small": ratio[0], "at_large": ratio[-1], "at_087": exact[0], "at_87": exact[1],
        "agree": draws.within(max(map(np.ptp, cycles.values()))), "coarse_count": coarse.size,
        "coarse_off": 100 * (coarse[0] / (best["max_tension"] / best["jkr_pull_off"]) - 1),
        "scattered": draws.ranged(scattered.sum(axis=0), 0), "count": ratios.shape[1],
        "first": sigmas[scattered.any(axis=1)].min(), "points": sigmas.size,
        "outside": draws.ranged((ratios > _BROKEN).sum(axis=0), 0),
        "factor": np.median(factors), "factor_most": factors.max(), "broken": _BROKEN,
        "weak": draws.ranged(ratios[weak], 5), "weak_sigma": sigmas[weak],
        "least_sigma": sigma[0], "near_one": draws.several(ratios[one], 3),
        "one_turns": penetrations.turns(turns[one]), "coarse": penetrations.listed(coarse, 4),
        "coarse_turns": penetrations.turns(runs["fig10c_uniform"].summary["unload_from"]),
        "most_sigma": sigma[-1], "over_jkr": 100 * (ratio[-1] - 1),
        # The paper's figures for mica: gamma 0.1 J/m^2, E 1e10 Pa, R 1e-2 m, z0 0.1 nm.
        "mica": 0.1 / 1e10 * np.sqrt(1e-2 / 1e-10**3),
        "apart": -columns["jump_out_load"][-1] / columns["jkr_pull_off"][-1],
        "steepest": slopes.min(), "steepest_at": sigma[np.argmin(slopes)]}
    for letter, cycle in cycles.items():
        summary = runs[f"fig10{letter}_paper"].summary
        found |= {f"sigma_{letter}": summary["sigma"],
                  f"rule_{letter}": draws.several(rule[letter]),
                  f"true_{letter}": f"{cycle[0]:.6f}", f"runs_{letter}": rule[letter].shape[1],
                  f"turns_{letter}": penetrations.turns(summary["unload_from"]),
                  f"agree_{letter}": draws.within(np.ptp(cycle))}
    found["error_0"], found["error_1"] = runs["fig07_exact_sigma"].sweep["error_estimate"]
    return found


def draw(runs):
    """Return the picture; its axis is broken at a range with unconverged values only."""
    page, (upper, lower) = style.figure(
        2, 1, height=5.0, sharex=True, gridspec_kw={"height_ratios": (1, 2.3), "hspace": 0.03})
    sigmas, turns, ratios = _paper(runs)
    for panel in (upper, lower):
        panel.plot(*_converged(runs), color=style.BLACK, zorder=4, label="the equations")
        shallowest = 1.0
        for number, (deepest, marker, color, name) in enumerate(_MARKERS):
            chosen = (deepest < turns) & (turns <= shallowest)
            # Penetrations side by side, so that their bars do not hide each other.
            x = sigmas[chosen] * (1 + 0.09 * number)
            panel.vlines(x, ratios[chosen].min(axis=1), ratios[chosen].max(axis=1), color=color,
                         linewidth=1.1, zorder=4.5)
            middle = np.median(ratios[chosen], axis=1)
            here = (middle > _BROKEN) == (panel is upper)
            panel.plot(x[here], middle[here], marker, color=color, markerfacecolor="white",
                       markersize=4.5, zorder=5, linestyle="none", markeredgewidth=1.2, label=name)
            shallowest = deepest
        cycles = [(runs[f"fig10{letter}_converged"].summary["sigma"], ratio)
                  for letter, cycle in penetrations.converged(runs).items() for ratio in cycle]
        panel.plot(*(np.transpose(cycles) if panel is lower else ([], [])), "x",
                   color=style.VERMILION, markersize=6.5, markeredgewidth=1.6, zorder=6,
                   label="cycles of Fig. 10")
    upper.set_ylim(_BROKEN - 0.1, 1.12 * ratios.max())
    style.label(lower, "$\\sigma$", "pull-off / JKR", log="x", xlim=(0.28e-3, 1.3e3),
                ylim=(min(0.75, 0.96 * ratios.min()), _BROKEN), ticks=[10.0 ** np.arange(-3, 4)])
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
