"""Fig. 2: Hertz theory and the slowly varying deformation, for three repulsive forces."""

import curves
import numpy as np
import style
from published import Row

DECKS = ("fig02_exponential_short", "fig02_exponential_long", "fig02_lennard_jones_repulsive")
TITLE = "Fig. 2: repulsion, Hertz theory and the slowly varying deformation"
CAPTION = """Central displacement against load for exponential repulsions over 0.2 nm (diamonds)
and 1.0 nm (squares) and the repulsive part of the Lennard-Jones law (triangles); Hertz theory
solid, and in the inset (31) and (32) dashed. The paper finds that Hertz theory overestimates the
displacement, less so for shorter ranges, and that (31) and (32) are the better ones at small
load, above all for the longer range. So it is: at 1 mN Hertz theory is {short:+.1f} % off for 0.2
nm, {lennard_jones:+.1f} % for Lennard-Jones and {long:+.1f} % for 1.0 nm; (31) with (32) is the
better one up to {cross_short:.3g} µN for 0.2 nm and up to {cross_long:.3g} µN for 1.0 nm."""

_RADIUS, _STIFFNESS, _P0 = 1.5e-2, 1e10, 2.5e8
_STYLES = {
    "fig02_exponential_short": ("D", style.BLUE, "exponential, 0.2 nm"),
    "fig02_lennard_jones_repulsive": ("^", style.VERMILION, "Lennard-Jones, repulsive part"),
    "fig02_exponential_long": ("s", style.GREEN, "exponential, 1.0 nm"),
}
_DECAY = {"fig02_exponential_short": 0.2e-9, "fig02_exponential_long": 1e-9}
_LARGE = 1e-3


def _slow(load, decay):
    """Return the displacement that (31) and (32) give at a load: they are proportional."""
    return 2 * load / (_STIFFNESS * np.sqrt(2 * np.pi * _RADIUS * decay))


def _hertz_error(curve, load):
    exact = curves.at_load(curve["load"], curve["displacement"], load)
    return 100 * (curves.hertz_displacement(load, _RADIUS, _STIFFNESS) / exact - 1)


def _crossing(curve, decay):
    """Return the load [N] above which Hertz theory is nearer than (31) with (32)."""
    load, exact = curve["load"], curve["displacement"]
    better = (abs(_slow(load, decay) - exact)
              < abs(curves.hertz_displacement(load, _RADIUS, _STIFFNESS) - exact))
    last = int(np.flatnonzero(better)[-1])
    return (load[last] + load[last + 1]) / 2


def numbers(runs):
    """Return what the caption quotes."""
    short, long, lennard_jones = (runs[deck].curve for deck in DECKS)
    return {"short": _hertz_error(short, _LARGE), "long": _hertz_error(long, _LARGE),
            "lennard_jones": _hertz_error(lennard_jones, _LARGE),
            "cross_short": _crossing(short, 0.2e-9) * 1e6,
            "cross_long": _crossing(long, 1e-9) * 1e6}


def draw(runs):
    """Return the picture."""
    page, panel = style.figure(height=4.6)
    inset = panel.inset_axes((0.625, 0.1, 0.37, 0.35))
    load = np.linspace(0, 1, 1000) ** 2 * 1.2e-3
    for axes in (panel, inset):
        axes.plot(load * 1e6, curves.hertz_displacement(load, _RADIUS, _STIFFNESS) * 1e9,
                  color=style.BLACK, label="Hertz theory")
        for deck, (marker, color, name) in _STYLES.items():
            curve = runs[deck].curve
            axes.plot(curve["load"] * 1e6, curve["displacement"] * 1e9, marker, color=color,
                      markerfacecolor="white" if marker == "s" else color, label=name,
                      markersize=4.5, markevery=0.03 if axes is panel else 0.06)
    for deck, decay in _DECAY.items():
        inset.plot(load * 1e6, _slow(load, decay) * 1e9, color=_STYLES[deck][1], dashes=(5, 2))
    panel.plot([], [], color=style.GREY, dashes=(5, 2), label="(31) and (32), inset")
    style.label(panel, "load [µN]", "central displacement [nm]")
    style.label(inset, "load [µN]", "displacement [nm]")
    for axes in (inset.xaxis, inset.yaxis):
        axes.label.set_size(8.5)
    inset.tick_params(labelsize=8)
    inset.set_xlim(0, 40)
    inset.set_ylim(0, 1.45)
    panel.set_xlim(-10, 1150)
    panel.set_ylim(0, 15.5)
    panel.legend(loc="upper left")
    style.statement(panel, "paper: Hertz overestimates the displacement,\nless for shorter ranges",
                    0.98, 0.985, align="right")
    return page


def rows(runs):
    """Return the statements of the paper."""
    short, long, lennard_jones = (runs[deck].curve for deck in DECKS)
    found = []
    for name, curve in (("exponential 0.2 nm", short), ("Lennard-Jones repulsive part",
                                                        lennard_jones),
                        ("exponential 1.0 nm", long)):
        found.append(Row(
            f"Fig. 2, Hertz displacement at a given load, {name}", "overestimates", None,
            _hertz_error(curve, _LARGE), "%",
            "relative error at 1 mN; the paper: more accurate for more rapidly decaying forces"))
    for name, curve, decay in (("0.2 nm", short, 0.2e-9), ("1.0 nm", long, 1e-9)):
        found.append(Row(
            f"Fig. 2, (31) and (32) better than Hertz below this load, {name}",
            "in the small load regime", None, _crossing(curve, decay) * 1e6, "µN"))
        load = _crossing(curve, decay)
        small = curve["load"] <= load
        above = _slow(curve["load"][small], decay) - curve["displacement"][small]
        found.append(Row(
            f"Fig. 2 inset, curve of (31) and (32), {name}", "above the exact results", None,
            "above" if (above > 0).all() else "not everywhere above", "",
            f"up to {load * 1e6:.3g} µN; by {above[-1] * 1e9:.2g} nm there"))
    return found
