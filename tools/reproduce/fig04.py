"""Fig. 4: profiles of separation and pressure under an exponential repulsion."""

import curves
import numpy as np
import profile_lines
import style
from published import Row

DECKS = ("fig04",)
TITLE = "Fig. 4: profiles under an exponential repulsion"
CAPTION = """Separation (a) and pressure (b) against the distance from the axis, from h0 = 4.3 to
−2.0 nm in steps of 0.7 nm; exponential repulsion of 10 MPa over 1 nm. The paper reports that the
bodies grow flatter under load, but nowhere flat or at h = 0, and that the pressure falls steadily
from the axis outwards. At h0 = −2.0 nm the gap on the axis is **{gap:.3f} nm**, and the surfaces
keep {curved:.1f} % of their undeformed curvature there ({first:.0f} % at h0 = 4.3 nm)."""

_RADIUS, _STIFFNESS = 1.5e-2, 1e10


def _curvature(state):
    """Return the curvature of the gap on the axis over that of undeformed bodies, 1/R."""
    near = state["r"] <= 0.1 * np.sqrt(_RADIUS * 1e-9)
    fit = np.polynomial.polynomial.polyfit(state["r"][near] ** 2, state["separation"][near], 1)
    return 2 * _RADIUS * fit[1]


def numbers(runs):
    """Return what the caption quotes."""
    states = profile_lines.states(runs["fig04"])
    return {"gap": states[-1]["separation"][0] * 1e9, "curved": 100 * _curvature(states[-1]),
            "first": 100 * _curvature(states[0])}


def draw(runs):
    """Return the picture."""
    page, (gaps, pressures) = style.figure(1, 2, height=4.2)
    states = profile_lines.states(runs["fig04"])
    colors = profile_lines.draw(gaps, states, "separation", 1e-9)
    profile_lines.draw(pressures, states, "pressure", 1e6)
    style.label(gaps, "distance from the axis [µm]", "separation [nm]")
    style.label(pressures, "distance from the axis [µm]", "pressure [MPa]")
    style.letter(gaps, "a")
    style.letter(pressures, "b")
    gaps.set_xlim(0, 16)
    gaps.set_ylim(0, 12)
    pressures.set_xlim(0, 16)
    pressures.set_ylim(0, None)
    style.statement(gaps, "paper: no flat region,\nno contact at h = 0", 0.05, 0.97)
    style.statement(pressures, "paper: highest on the axis,\nfalls steadily outwards", 0.98, 0.97,
                    align="right")
    profile_lines.bar(page, (gaps, pressures), colors)
    return page


def rows(runs):
    """Return the statements of the paper."""
    states = profile_lines.states(runs["fig04"])
    last = states[-1]
    steady = all((np.diff(state["pressure"]) <= 0).all() for state in states)
    curve = runs["fig04"].curve
    hertz = curves.hertz_displacement(curve["load"][-1], _RADIUS, _STIFFNESS)
    return [
        Row("Fig. 4(a), flat region", "none", None, 100 * _curvature(last), "%",
            "curvature of the gap on the axis over the undeformed 1/R, at h0 = -2.0 nm"),
        Row("Fig. 4(a), least separation", "nowhere in contact at h = 0", None,
            last["separation"].min() * 1e9, "nm", "on the axis at h0 = -2.0 nm"),
        Row("Fig. 4(b), pressure", "highly compressive in the centre, decays monotonically", None,
            "decays monotonically" if steady else "does not", "",
            f"all ten profiles; {last['pressure'][0] / 1e6:.2f} MPa on the axis at h0 = -2.0 nm"),
        Row("Fig. 4, Hertz displacement at the load of h0 = -2.0 nm", "can be quite good", None,
            100 * (hertz / curve["displacement"][-1] - 1), "%",
            f"relative error at {curve['load'][-1] * 1e6:.0f} µN, 1/kappa = 1 nm"),
    ]
