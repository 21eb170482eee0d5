"""Wu (2010) and Attard and Parker (1992): the place of the jump into contact."""

import functools

import numpy as np
import spheres
import style
from report import Comparison

_SOURCE = "Attard and Parker (1992), equation (37), printed"
TABORS = (0.8, 1.0, 2.0, 5.0, 10.0, 100.0)
_MANY = spheres.spaced(0.7, 1000, 40)
_FROM = 3.0


@functools.lru_cache(maxsize=None)
def jump(tabor):
    """Return h0, gap on the axis and tension [pi w R] at the jump, solved and by equation (37)."""
    found = spheres.run(tabor, -3.0 - 1.5 * spheres.unit(tabor) ** 2, approximations={})
    summary, curve = found.summary, found.curve
    at = int(np.argmin(abs(curve["h0"] - summary["jump_in_h0"])
                       + abs(curve["load"] - summary["jump_in_load"]) / spheres.sigma(tabor)))
    loads = np.pi * spheres.sigma(tabor)
    return ((summary["jump_in_h0"], curve["h_centre"][at], -summary["jump_in_load"] / loads),
            (summary["jump_equation_37_h0"], summary["jump_equation_37_gap"],
             -summary["jump_equation_37_load"] / loads))


@functools.lru_cache(maxsize=None)
def _curves():
    """Return h0, gap and tension over _MANY, solved and by (37), and the errors [%] of (37)."""
    solved, printed = (np.array(each) for each in zip(*map(jump, _MANY)))
    return solved, printed, 100 * (printed / solved - 1)


def numbers(_):
    *_, errors = _curves()
    worst = int(np.argmax(abs(errors[:, 0])))
    top = _MANY[-1]
    above = np.array([each >= _FROM for each in _MANY])
    ratio = 1 / (1 + errors[above, 0] / 100)
    factor = (ratio.max() + ratio.min()) / 2
    constant = jump(top)[0][0] / top ** (3 / 7)
    return {"constant": constant, "power_from": spheres.where(
                lambda tabor: abs(constant * tabor ** (3 / 7) / jump(tabor)[0][0] - 1) < 0.01, 0.8,
                100, 1e-2),
            "h0": errors[-1, 0], "gap": errors[-1, 1], "top": top, "h0_worst": errors[worst, 0],
            "h0_at": _MANY[worst], "factor": factor, "fixed_from": _FROM,
            "fixed": 100 * max(abs(factor / ratio - 1)), "slope_from": 100.0,
            "slope": np.log(jump(top)[0][0] / jump(100.0)[0][0]) / np.log(top / 100.0)}


def draw(_):
    page, (left, right) = style.figure(1, 2, height=3.6)
    solved, printed, errors = _curves()
    for i, (name, color) in enumerate((("$h_0$", style.BLACK), ("gap $h(0)$", style.BLUE))):
        left.loglog(_MANY, solved[:, i], color=color, label=f"{name}, solved")
        left.loglog(_MANY, printed[:, i], color=color, dashes=(4, 2), linewidth=1,
                    label=f"{name}, (37)")
        right.semilogx(_MANY, errors[:, i], color=color)
    style.label(left, "Tabor's parameter $\\mu$", "at the jump into contact $[z_0]$")
    style.label(right, "Tabor's parameter $\\mu$", "error of (37) [%]", "y")
    style.legend(page, 4)
    return page


def rows(_):
    return [Comparison(f"mu = {tabor:g}, {what} at the jump into contact", "formula", printed,
                       solved, unit, _SOURCE)
            for tabor in TABORS
            for what, unit, solved, printed in zip(("h0", "gap on the axis", "tension"),
                                                   ("z0", "z0", "pi w R"), *jump(tabor))]
