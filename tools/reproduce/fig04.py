"""Fig. 4: profiles of separation and pressure under an exponential repulsion."""

import curves
import numpy as np
import style

DECKS = ("fig04",)
_WITHIN = 0.1 * np.sqrt(curves.RADIUS * 1e-9)


def numbers(runs):
    states, curve = curves.states(runs["fig04"]), runs["fig04"].curve
    first, last = states[0], states[-1]
    steady = all((np.diff(state["pressure"]) <= 0).all() for state in states)
    hertz = curves.hertz_displacement(curve["load"][-1], 1e10)
    return {"gap": last["separation"][0] * 1e9, "curved": 100 * curves.curvature(last, _WITHIN),
            "first": 100 * curves.curvature(first, _WITHIN),
            "least": last["separation"].min() * 1e9,
            "steady": "decays monotonically" if steady else "does not",
            "pressure": last["pressure"][0] / 1e6, "load": curve["load"][-1] * 1e6,
            "hertz": 100 * (hertz / curve["displacement"][-1] - 1)}


def draw(runs):
    page, (gaps, pressures) = style.figure(1, 2, height=4.2)
    states = curves.states(runs["fig04"])
    colors = style.profiles(gaps, states, "separation", 1e-9)
    style.profiles(pressures, states, "pressure", 1e6)
    away = "distance from the axis [µm]"
    style.label(gaps, away, "separation [nm]", letter="a", xlim=(0, 16), ylim=(0, 12))
    style.label(pressures, away, "pressure [MPa]", letter="b", xlim=(0, 16), ylim=(0, None))
    style.statement(gaps, "paper: no flat region,\nno contact at h = 0", 0.05, 0.97)
    style.statement(pressures, "paper: highest on the axis,\nfalls steadily outwards", 0.98, 0.97,
                    align="right")
    style.bar(page, (gaps, pressures), colors)
    return page
