"""Fig. 9: tension just before the jump into contact, and the paper's estimates of it."""

import curves
import draws
import numpy as np
import style

DECKS = ("fig09_paper", "fig09_converged")
_CHOSEN = (0.87, 1.7, 4.4, 8.7)


def _columns(results):
    """Return sigma and tensions in units of gamma R, NaN where there is no jump."""
    sweep = results.sweep
    unit = sweep["surface_energy"] * curves.RADIUS
    found = {"sigma": sweep["sigma"], "jump": -sweep["jump_in_load"] / unit,
             "largest": sweep["max_tension"] / unit}
    for name in ("criterion_29", "equation_37"):
        if f"jump_{name}_load" in sweep.dtype.names:
            found[name] = -sweep[f"jump_{name}_load"] / unit
    return found


def _at_jumps_of_the_rule(rule, exact):
    """Return sigma, the tension by the paper's rule and the exact one for runs in which both
    jump."""
    jumps = np.isfinite(exact["jump"])
    both = np.isfinite(rule["jump"]) & (rule["sigma"] >= exact["sigma"][jumps][0])
    true = np.exp(np.interp(np.log(rule["sigma"][both]), np.log(exact["sigma"][jumps]),
                            np.log(exact["jump"][jumps])))
    return rule["sigma"][both], rule["jump"][both], true


def numbers(runs):
    exact = _columns(runs["fig09_converged"])
    jumps = [_at_jumps_of_the_rule(_columns(results), exact)
             for results in runs.draws("fig09_paper")]
    off = 100 * (1 - exact["criterion_29"] / exact["jump"])
    both = np.flatnonzero(np.isfinite(off))
    ten = int(np.argmin(abs(np.log(exact["sigma"] / 10))))
    found = {
        "close": off[both[-1]], "far": off[both[0]], "lowest": exact["sigma"][both[0]],
        "apart": 100 * abs(exact["equation_37"][ten] / exact["criterion_29"][ten] - 1),
        "rule": draws.ranged([100 * abs(rule / true - 1)[sigma > 1].max()
                              for sigma, rule, true in jumps], 0),
        "late": draws.ranged([sigma[0] for sigma, *_ in jumps]), "count": len(jumps),
        "high": exact["sigma"][-1], "low_close": -off[both[-1]], "low_far": -off[both[0]]}
    for key, name in (("", "jump"), ("_29", "criterion_29")):
        # The last sigma without a jump and the first with a jump.
        first = int(np.flatnonzero(np.isfinite(exact[name]))[0])
        found[f"none{key}"], found[f"some{key}"] = exact["sigma"][first - 1 : first + 1]
    for number, wanted in enumerate(_CHOSEN):
        # For the runs with a jump, the nearest one.
        near = [int(np.argmin(abs(np.log(sigma / wanted)))) for sigma, *_ in jumps]
        away = [abs(np.log(sigma[i] / wanted)) for (sigma, *_), i in zip(jumps, near)]
        here = [(run, i) for run, i, one in zip(jumps, near, away) if one < min(away) + 1e-6]
        (sigma, _, true), i = here[0]
        estimate = np.exp(np.interp(np.log(sigma[i]), np.log(exact["sigma"]),
                                    np.log(exact["criterion_29"])))
        found |= {f"sigma_{number}": sigma[i], f"estimate_{number}": estimate,
                  f"rule_{number}": draws.ranged([run[1][j] for run, j in here], 4),
                  f"true_{number}": true[i], f"off_{number}": 100 * (estimate / true[i] - 1),
                  f"runs_{number}": len(here)}
    return found


def draw(runs):
    page, panel = style.figure(height=4.3)
    exact = _columns(runs["fig09_converged"])
    rules = [_columns(results) for results in runs.draws("fig09_paper")]
    sigma, jumps = exact["sigma"], np.isfinite(exact["jump"])
    told = np.isfinite(exact["criterion_29"])
    panel.plot(sigma, exact["equation_37"], color=style.BLACK, zorder=2, label="(37)")
    # (36a) has its maximum, 2 pi, at the separation z0 on the axis.
    for shown, values, marker, color, fill, order, name in (
            (jumps, exact["jump"], "s", style.BLUE, None, 4, "exact"),
            (~jumps, exact["largest"], "s", style.BLUE, "white", 4,
             "exact, no jump: largest tension"),
            (told, exact["criterion_29"], "^", style.ORANGE, None, 3,
             "criterion (29) with (35a), (36a)"),
            (~told, np.full(sigma.size, 2 * np.pi), "^", style.ORANGE, "white", 3,
             "(36a), no jump: largest tension")):
        panel.plot(sigma[shown], values[shown], marker, color=color, markersize=4.8, zorder=order,
                   markerfacecolor=fill or color, label=name)
    found = np.array([rule["jump"] for rule in rules])
    largest = np.where(np.isfinite(found), np.nan, [rule["largest"] for rule in rules])
    for values, marker, size, name in ((found, "x", 7, "paper's grid and rule"),
                                       (largest, "+", 8, "the same, no jump found")):
        some = np.isfinite(values).any(axis=0)
        style.spread(panel, rules[0]["sigma"][some], values[:, some], marker, style.VERMILION, name,
                     markersize=size, markeredgewidth=1.5)
    style.label(panel, "$\\sigma$", "tension before the jump [$\\gamma R$]", log="xy",
                xlim=(0.7e-2, 1.3e2), ylim=(0.07, 22),
                ticks=((0.01, 0.1, 1, 10, 100), (0.1, 0.3, 1, 3, 10)))
    panel.legend(loc="lower left")
    style.statement(panel, "paper: (29) and (37) are a quite\nacceptable estimate of the jump",
                    0.985, 0.97, align="right")
    return page
