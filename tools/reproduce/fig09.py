"""Fig. 9: tension just before the jump into contact, and the paper's estimates of it."""

import draws
import numpy as np
import style
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator
from published import Row

DECKS = ("fig09_paper", "fig09_converged")
TITLE = "Fig. 9: the tension at the jump into contact"
CAPTION = """Tension just before the jump against σ, in units of γR. Squares: exact, at the fold of
the path; triangles: criterion (29) with (35a) and (36a); line: (37), continued to small σ; open
symbols: the largest tension where there is no jump. Crosses: the paper's grid and stopping rule,
where that finds a jump in an approach in steps of 0.1 nm, the median of {count} runs that differ in
A's twelfth digit, with a bar from the least to the largest.

The paper is right that (29) and (37) are quite acceptable: with {close:.0f} % too little tension at
large σ and {far:.0f} % at σ = {lowest:.2f}, and {apart:.2f} % between each other at σ = 10. The
equations jump above σ = {none:.2f}–{some:.2f}, criterion (29) above {none_29:.2f}–{some_29:.2f}:
between them it promises jumps that do not happen. Before contact, where the bodies are soft, the
paper's grid and rule do less harm than in contact: for σ > 1 the tensions are at most {rule} %
from the exact ones, which the steps of h0 have a part in, the last one being up to 0.1 nm short of
the jump. The smallest σ of the sweep at which a run finds a jump is {late}; pluses are the
largest tension of the approach where a run finds none."""

_RADIUS = 1.5e-2


def _columns(results):
    """Return sigma and tensions in units of gamma R, NaN where there is no jump."""
    sweep = results.sweep
    unit = sweep["surface_energy"] * _RADIUS
    found = {"sigma": sweep["sigma"], "jump": -sweep["jump_in_load"] / unit,
             "largest": sweep["max_tension"] / unit}
    if "jump_criterion_29_load" in sweep:
        found["criterion"] = -sweep["jump_criterion_29_load"] / unit
        found["equation_37"] = -sweep["jump_equation_37_load"] / unit
    return found


def _at_jumps_of_the_rule(runs, results):
    """Return sigma, the tension in a run by the paper's rule and the exact one where both jump."""
    rule, exact = _columns(results), _columns(runs["fig09_converged"])
    jumps = np.isfinite(exact["jump"])
    both = np.isfinite(rule["jump"]) & (rule["sigma"] >= exact["sigma"][jumps][0])
    true = np.exp(np.interp(np.log(rule["sigma"][both]), np.log(exact["sigma"][jumps]),
                            np.log(exact["jump"][jumps])))
    return rule["sigma"][both], rule["jump"][both], true


def _bracket(sigma, values):
    """Return the last sigma without and the first with a jump."""
    first = int(np.flatnonzero(np.isfinite(values))[0])
    return sigma[first - 1], sigma[first]


def numbers(runs):
    """Return what the caption quotes."""
    exact = _columns(runs["fig09_converged"])
    late, deviation = [], []
    for results in runs.draws("fig09_paper"):
        sigma, rule, true = _at_jumps_of_the_rule(runs, results)
        late.append(sigma[0])
        deviation.append(100 * abs(rule / true - 1)[sigma > 1].max())
    off = 100 * (1 - exact["criterion"] / exact["jump"])
    both = np.flatnonzero(np.isfinite(off))
    ten = int(np.argmin(abs(np.log(exact["sigma"] / 10))))
    none, some = _bracket(exact["sigma"], exact["jump"])
    none_29, some_29 = _bracket(exact["sigma"], exact["criterion"])
    return {
        "close": off[both[-1]], "far": off[both[0]], "lowest": exact["sigma"][both[0]],
        "apart": 100 * abs(exact["equation_37"][ten] / exact["criterion"][ten] - 1),
        "none": none, "some": some, "none_29": none_29, "some_29": some_29,
        "rule": draws.ranged(deviation, 0), "late": draws.ranged(late), "count": len(late),
    }


def draw(runs):
    """Return the picture."""
    page, panel = style.figure(height=4.3)
    exact = _columns(runs["fig09_converged"])
    rules = [_columns(results) for results in runs.draws("fig09_paper")]
    sigma = exact["sigma"]
    panel.set_xscale("log")
    panel.set_yscale("log")
    panel.plot(sigma, exact["equation_37"], color=style.BLACK, zorder=2, label="(37)")
    jumps = np.isfinite(exact["jump"])
    panel.plot(sigma[jumps], exact["jump"][jumps], "s", color=style.BLUE, markersize=4.8, zorder=4,
               label="exact")
    panel.plot(sigma[~jumps], exact["largest"][~jumps], "s", color=style.BLUE, markersize=4.8,
               markerfacecolor="white", zorder=4, label="exact, no jump: largest tension")
    jumps = np.isfinite(exact["criterion"])
    panel.plot(sigma[jumps], exact["criterion"][jumps], "^", color=style.ORANGE, markersize=4.8,
               zorder=3, label="criterion (29) with (35a), (36a)")
    # (36a) is largest, 2 pi, where the separation on the axis is z0.
    panel.plot(sigma[~jumps], np.full((~jumps).sum(), 2 * np.pi), "^", color=style.ORANGE,
               markersize=4.8, markerfacecolor="white", zorder=3,
               label="(36a), no jump: largest tension")
    found = np.array([rule["jump"] for rule in rules])
    largest = np.array([np.where(np.isfinite(rule["jump"]), np.nan, rule["largest"])
                        for rule in rules])
    for values, marker, size, name in ((found, "x", 7, "paper's grid and rule"),
                                       (largest, "+", 8, "the same, no jump found")):
        some = np.isfinite(values).any(axis=0)
        at, values = rules[0]["sigma"][some], values[:, some]
        panel.vlines(at, np.nanmin(values, axis=0), np.nanmax(values, axis=0),
                     color=style.VERMILION, linewidth=1.2, zorder=4.5)
        panel.plot(at, np.nanmedian(values, axis=0), marker, color=style.VERMILION,
                   markersize=size, markeredgewidth=1.5, zorder=5, label=name)
    style.label(panel, "$\\sigma$", "tension before the jump [$\\gamma R$]")
    panel.set_xlim(0.7e-2, 1.3e2)
    panel.set_ylim(0.07, 22)
    for axis, ticks in ((panel.xaxis, (0.01, 0.1, 1, 10, 100)),
                        (panel.yaxis, (0.1, 0.3, 1, 3, 10))):
        axis.set_major_locator(FixedLocator(ticks))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_locator(NullLocator())
    panel.legend(loc="lower left")
    style.statement(panel, "paper: (29) and (37) are a quite\nacceptable estimate of the jump",
                    0.985, 0.97, align="right")
    return page


def rows(runs):
    """Return the statements of the paper."""
    found = numbers(runs)
    exact, some = _columns(runs["fig09_converged"]), runs.draws("fig09_paper")
    jumps = [_at_jumps_of_the_rule(runs, results) for results in some]
    chosen = []
    for wanted in (0.87, 1.7, 4.4, 8.7):
        # Of the runs that find a jump there.
        near = [(abs(np.log(sigma / wanted)).min(), int(np.argmin(abs(np.log(sigma / wanted)))), i)
                for i, (sigma, *_) in enumerate(jumps)]
        least = min(near)[0]
        here = [(i, at) for off, at, i in near if off < least + 1e-6]
        rule = [jumps[i][1][at] for i, at in here]
        sigma, _, true = jumps[here[0][0]]
        at = here[0][1]
        estimate = np.exp(np.interp(np.log(sigma[at]), np.log(exact["sigma"]),
                                    np.log(exact["criterion"])))
        chosen.append(Row(
            f"Fig. 9, tension before the jump, sigma = {sigma[at]:.2f}",
            f"near (29): {estimate:.4f}", draws.ranged(rule, 4), true[at], "gamma R",
            f"(29) {100 * (estimate / true[at] - 1):+.1f} %; computed: at the last step before the "
            f"jump, the {len(rule)} of {len(some)} runs that jump there; "
            "converged and (29): interpolated in the sweep"))
    return [
        *chosen,
        Row("Fig. 9, tension by (29) beside the exact one, large sigma", "very good approximation",
            None, -found["close"], "%", f"at sigma = {exact['sigma'][-1]:.0f}; "
            f"{-found['far']:.1f} % at {found['lowest']:.2f}. The paper is right"),
        Row("Fig. 9, (37) beside (29)", "good representation", None, found["apart"], "%",
            "at sigma = 10"),
        Row("Fig. 9, smallest sigma with a jump", "open symbols", found["late"],
            f"{found['none']:.3f} to {found['some']:.3f}", "",
            f"by (29): {found['none_29']:.3f} to {found['some_29']:.3f}"),
    ]
