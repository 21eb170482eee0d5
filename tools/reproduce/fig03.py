"""Fig. 3: errors of Hertz theory and of (31) and (32) for exponential repulsion."""

import curves
import numpy as np
import style

DECKS = ("fig03",)
_STIFFNESS, _P0, _DECAY = 1e10, 2.581988897471611e6, 1e-9
# Key of errors, colour, line and its width, name in the legend.
_LINES = (("hertz", style.BLACK, "-", 2, "Hertz load at given displacement"),
          ("displacement", style.BLUE, ":", 2, "(31), displacement at given h(0)"),
          ("load", style.VERMILION, "--", 2, "(32), load at given h(0)"),
          ("displacement_h0", style.BLUE, ":", 0.9, "(31) at given $h_0$"),
          ("load_h0", style.VERMILION, "--", 0.9, "(32) at given $h_0$"))


def errors(runs):
    """Return Lambda and the relative errors, a dict of arrays."""
    curve = runs["fig03"].curve
    h0, gap = curve["h0"], curve["h_centre"]
    displacement, load = curve["displacement"], curve["load"]
    # (31) and (32) without exp(-kappa h(0)).
    to_displacement = 2 / _STIFFNESS * np.sqrt(2 * np.pi * curves.RADIUS * _DECAY) * _P0
    to_load = 2 * np.pi * curves.RADIUS * _DECAY * _P0
    # The separation on the axis in (31): h = h0 + displacement(h).
    alone = np.maximum(h0, 0.0)
    for _ in range(100):
        raised = to_displacement * np.exp(-alone / _DECAY)
        alone = alone - (alone - h0 - raised) / (1 + raised / _DECAY)
    return {
        "lambda": np.sqrt(curves.RADIUS / _DECAY) / _STIFFNESS * _P0 * np.exp(-h0 / _DECAY),
        "hertz": curves.hertz_load(displacement, _STIFFNESS) / load - 1,
        "displacement": to_displacement * np.exp(-gap / _DECAY) / displacement - 1,
        "load": to_load * np.exp(-gap / _DECAY) / load - 1,
        "displacement_h0": (alone - h0) / displacement - 1,
        "load_h0": to_load * np.exp(-alone / _DECAY) / load - 1}


def at(found, key, value):
    """Return an error [%] at a value of Lambda."""
    # Lambda increases during the approach.
    return 100 * float(np.interp(np.log(value), np.log(found["lambda"]), found[key]))


def numbers(runs):
    """Return the errors at some Lambda, `displacement_1e4` and so on; those named `low` without
    sign."""
    found = errors(runs)
    named = {f"{key}_{name}": at(found, key, value) for key, *_ in _LINES
             for name, value in (("1e-3", 1e-3), ("001", 0.01), ("1", 1), ("1e4", 1e4),
                                 ("1e6", 1e6))}
    # The Lambda at which (32) becomes worse than Hertz theory.
    excess = found["load"] - found["hertz"]
    i = int(np.flatnonzero(excess > 0)[-1])
    cross = np.interp(0, [-excess[i], -excess[i + 1]], np.log(found["lambda"][i : i + 2]))
    return {"states": runs["fig03"].curve["h0"].size, "seconds": runs.record("fig03")["seconds"],
            **named, **{f"low_{key}": -value for key, value in named.items()},
            "falls": "decreases throughout" if (np.diff(found["hertz"]) > 0).all() else "does not",
            "cross": float(np.exp(cross))}


def draw(runs):
    page, panel = style.figure(height=4.7)
    found = errors(runs)
    panel.axhspan(-20, -10, color=style.ORANGE, alpha=0.25, linewidth=0)
    for key, color, line, width, name in _LINES:
        panel.semilogx(found["lambda"], 100 * found[key], line, color=color, linewidth=width,
                       label=name)
    for where in (1e4, 1.0, 0.01):
        value = at(found, "hertz", where)
        panel.plot([where], [value], "o", color=style.BLACK)
        if where == 1e4:
            style.note(panel, f"paper: 10–20 % at $\\Lambda\\approx 10^4$\nhere: {-value:.1f} %",
                       (where, value), (9e5, -31), align="right")
        else:
            style.word(panel, where * 0.75, value + 1.5, f"−{-value:.1f} %", style.BLACK,
                       ha="right", va="bottom")
    style.label(panel, r"$\Lambda = (\kappa R)^{1/2}\,P_0\,\exp(-\kappa h_0)\,(1-\nu^2)/E$",
                "relative error [%]", "y", xlim=(1e-3, 1e6), ylim=(-100, 4))
    style.legend(page, 2)
    return page
