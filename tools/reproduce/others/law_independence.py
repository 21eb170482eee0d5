"""Greenwood (2007), Barthel (1998) and others: how little contact depends on the law of force."""

import warnings

import law_independence as tool
import numpy as np
import snapin
import style
from published import Comparison

DECKS = ()
TITLE = "Five laws at the same range: how little the pull-off depends on them"
CAPTION = """E. Barthel, J. Colloid Interface Sci. **200**, 7 (1998), and J. A. Greenwood, Phil. Mag. **89**,
945 (2009), compared laws of force. Pull-off of five laws, solved, over Tabor's parameter with the range δ =
w/σ_max in place of z0, where σ_max is the largest tension: Lennard-Jones laws of exponents 9-3, 10-4, 12-6
and 6-3 between half-spaces, and Morse's. The five are within {laws:.1f} % of each other; Maugis-Dugdale
theory, Dugdale's law, is below all of them, by {low:.1f} to {high:.1f} %. It is the range that counts, not
z0. The same numbers stand in [docs/forces.md](../forces.md). Both prints were not read."""

TABORS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)
_COLORS = (style.BLACK, style.BLUE, style.GREEN, style.ORANGE, style.PURPLE)
_found = {}


def pull_offs(tabor):
    """Return a dict of pull-offs over pi w R by law, and that of Maugis-Dugdale theory."""
    if tabor not in _found:
        with warnings.catch_warnings():
            # R is 1, and so is the separation at rest.
            warnings.simplefilter("ignore", snapin.SnapinWarning)
            pairs = {name: tool.pull_offs(law, tabor, accuracy=1e-7)
                     for name, law in tool.LAWS.items()}
        _found[tabor] = ({name: pair[0] for name, pair in pairs.items()},
                         next(iter(pairs.values()))[1])
    return _found[tabor]


def numbers(_):
    """Return what the caption quotes."""
    spreads, below = [], []
    for tabor in TABORS:
        laws, theory = pull_offs(tabor)
        values = np.array(list(laws.values()))
        spreads.append(np.ptp(values) / values.min())
        below += list(1 - theory / values)
    return {"laws": 100 * max(spreads), "low": 100 * min(below), "high": 100 * max(below)}


def draw(_):
    """Return the picture."""
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
    """Return the theory beside each law."""
    return [Comparison(f"{name.replace(', ', '-')} at Tabor's parameter {tabor:g} by range, pull-off",
                       "theory", pull_offs(tabor)[1], tension, "pi w R",
                       "Maugis-Dugdale theory with the same w and largest tension")
            for tabor in TABORS for name, tension in pull_offs(tabor)[0].items()]
