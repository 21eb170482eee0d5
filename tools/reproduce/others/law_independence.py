"""Greenwood (2007), Barthel (1998) and others: the weak dependence of contact on the law of
force."""

import functools

import law_independence as tool
import numpy as np
import style
from report import Comparison

TABORS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)
_COLORS = (style.BLACK, style.BLUE, style.GREEN, style.ORANGE, style.PURPLE)


@functools.cache
def pull_offs(tabor):
    """Return a dict of pull-offs over pi w R by law, and that of Maugis-Dugdale theory."""
    pairs = {name: tool.pull_offs(law, tabor, accuracy=1e-7) for name, law in tool.LAWS.items()}
    return {name: pair[0] for name, pair in pairs.items()}, next(iter(pairs.values()))[1]


def numbers(_):
    spreads, below = [], []
    for tabor in TABORS:
        laws, theory = pull_offs(tabor)
        values = np.array(list(laws.values()))
        spreads.append(np.ptp(values) / values.min())
        below += list(1 - theory / values)
    return {"laws": 100 * max(spreads), "low": 100 * min(below), "high": 100 * max(below)}


def draw(_):
    page, (left, right) = style.figure(1, 2, height=3.6)
    theory = np.array([pull_offs(tabor)[1] for tabor in TABORS])
    left.semilogx(TABORS, theory, color=style.VERMILION, dashes=(5, 1.5), label="Maugis-Dugdale")
    for name, color, marker in zip(tool.LAWS, _COLORS, "osD^v"):
        values = np.array([pull_offs(tabor)[0][name] for tabor in TABORS])
        label = name.replace(", ", "-")
        left.semilogx(TABORS, values, color=color, marker=marker, markersize=3.5, linewidth=0.8,
                      label=label)
        right.semilogx(TABORS, 100 * (theory / values - 1), color=color, marker=marker,
                       markersize=3.5, linewidth=0.8)
    style.label(left, "Tabor's parameter by range", "pull-off $/\\pi wR$")
    style.label(right, "Tabor's parameter by range", "error of Maugis-Dugdale theory [%]", "y")
    style.legend(page, 6)
    return page


def rows(_):
    return [Comparison(f"{name.replace(', ', '-')} at Tabor's parameter {tabor:g} by range, "
                       "pull-off", "theory", pull_offs(tabor)[1], tension, "pi w R",
                       "Maugis-Dugdale theory with the same w and largest tension")
            for tabor in TABORS for name, tension in pull_offs(tabor)[0].items()]
