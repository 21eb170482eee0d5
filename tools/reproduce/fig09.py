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


def _rule(runs):
    """Return sigma and, in rows for runs by the paper's rule, tensions of jumps and the largest."""
    columns = [_columns(results) for results in runs.draws("fig09_paper")]
    return columns[0]["sigma"], *(np.array([each[name] for each in columns])
                                  for name in ("jump", "largest"))


def numbers(runs):
    exact, (sigma, rule, _) = _columns(runs["fig09_converged"]), _rule(runs)
    jumps = np.isfinite(exact["jump"])
    # Where the equations have a jump too.
    rule = np.where(sigma >= exact["sigma"][jumps][0], rule, np.nan)
    true = np.exp(np.interp(np.log(sigma), np.log(exact["sigma"][jumps]),
                            np.log(exact["jump"][jumps])))
    off = 100 * (1 - exact["criterion_29"] / exact["jump"])
    both = np.flatnonzero(np.isfinite(off))
    ten = int(np.argmin(abs(np.log(exact["sigma"] / 10))))
    found = {
        "close": off[both[-1]], "far": off[both[0]], "lowest": exact["sigma"][both[0]],
        "apart": 100 * abs(exact["equation_37"][ten] / exact["criterion_29"][ten] - 1),
        "rule": draws.ranged(np.nanmax(100 * abs(rule / true - 1)[:, sigma > 1], axis=1), 0),
        "late": draws.ranged([sigma[np.isfinite(run)][0] for run in rule]), "count": len(rule),
        "high": exact["sigma"][-1], "low_close": -off[both[-1]], "low_far": -off[both[0]]}
    for key, name in (("", "jump"), ("_29", "criterion_29")):
        # The last sigma without a jump and the first with a jump.
        first = int(np.flatnonzero(np.isfinite(exact[name]))[0])
        found[f"none{key}"], found[f"some{key}"] = exact["sigma"][first - 1 : first + 1]
    some = np.flatnonzero(np.isfinite(rule).any(axis=0))
    for number, wanted in enumerate(_CHOSEN):
        i = some[np.argmin(abs(np.log(sigma[some] / wanted)))]
        here = rule[np.isfinite(rule[:, i]), i]
        estimate = np.exp(np.interp(np.log(sigma[i]), np.log(exact["sigma"]),
                                    np.log(exact["criterion_29"])))
        found |= {f"sigma_{number}": sigma[i], f"estimate_{number}": estimate,
                  f"rule_{number}": draws.ranged(here, 4), f"true_{number}": true[i],
                  f"off_{number}": 100 * (estimate / true[i] - 1), f"runs_{number}": here.size}
    return found


def draw(runs):
    page, panel = style.figure(height=4.3)
    exact = _columns(runs["fig09_converged"])
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
    places, found, largest = _rule(runs)
    largest = np.where(np.isfinite(found), np.nan, largest)
    for values, marker, size, name in ((found, "x", 7, "paper's grid and rule"),
                                       (largest, "+", 8, "the same, no jump found")):
        some = np.isfinite(values).any(axis=0)
        style.spread(panel, places[some], values[:, some], marker, style.VERMILION, name,
                     markersize=size, markeredgewidth=1.5)
    style.label(panel, "$\\sigma$", "tension before the jump [$\\gamma R$]", log="xy",
                xlim=(0.7e-2, 1.3e2), ylim=(0.07, 22),
                ticks=((0.01, 0.1, 1, 10, 100), (0.1, 0.3, 1, 3, 10)))
    panel.legend(loc="lower left")
    style.statement(panel, "paper: (29) and (37) are a quite\nacceptable estimate of the jump",
                    0.985, 0.97, align="right")
    return page
