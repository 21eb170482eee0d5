"""Fig. 2: Hertz theory and the slowly varying deformation, for three repulsive forces."""

import curves
import numpy as np
import style

_STIFFNESS, _LARGE = 1e10, 1e-3
# Name of a number, deck, name in the legend, decay length [m], marker, colour.
_KINDS = (
    ("short", "fig02_exponential_short", "exponential, 0.2 nm", 0.2e-9, "D", style.BLUE),
    ("lennard_jones", "fig02_lennard_jones_repulsive", "Lennard-Jones, repulsive part", None, "^",
     style.VERMILION),
    ("long", "fig02_exponential_long", "exponential, 1.0 nm", 1e-9, "s", style.GREEN))
DECKS = ("fig02_exponential_short", "fig02_exponential_long", "fig02_lennard_jones_repulsive")


def _slow(load, decay):
    """Return the displacement of (31) and (32) at a load: they are proportional."""
    return 2 * load / (_STIFFNESS * np.sqrt(2 * np.pi * curves.RADIUS * decay))


def numbers(runs):
    """Return errors of Hertz theory and, for exponentials, the range in which (31) with (32) is
    better."""
    found = {}
    for key, deck, _, decay, *_ in _KINDS:
        load, exact = runs[deck].curve["load"], runs[deck].curve["displacement"]
        found[key] = 100 * (curves.hertz_displacement(_LARGE, _STIFFNESS)
                            / np.interp(_LARGE, load, exact) - 1)
        if decay:
            better = (abs(_slow(load, decay) - exact)
                      < abs(curves.hertz_displacement(load, _STIFFNESS) - exact))
            last = int(np.flatnonzero(better)[-1])
            cross = (load[last] + load[last + 1]) / 2
            above = (_slow(load, decay) - exact)[load <= cross]
            found |= {f"cross_{key}": cross * 1e6, f"by_{key}": above[-1] * 1e9,
                      f"above_{key}": "above" if (above > 0).all() else "not everywhere above"}
    return found


def draw(runs):
    page, panel = style.figure(height=4.6)
    inset = panel.inset_axes((0.625, 0.1, 0.37, 0.35))
    load = np.linspace(0, 1, 1000) ** 2 * 1.2e-3
    for axes in (panel, inset):
        axes.plot(load * 1e6, curves.hertz_displacement(load, _STIFFNESS) * 1e9, color=style.BLACK,
                  label="Hertz theory")
        for _, deck, name, decay, marker, color in _KINDS:
            axes.plot(*curves.drawn(runs[deck].curve), marker, color=color, label=name,
                      markerfacecolor="white" if marker == "s" else color, markersize=4.5,
                      markevery=0.03 if axes is panel else 0.06)
            if axes is inset and decay:
                inset.plot(load * 1e6, _slow(load, decay) * 1e9, color=color, **style.DASHED)
    panel.plot([], [], color=style.GREY, **style.DASHED, label="(31) and (32), inset")
    style.label(panel, "load [µN]", "central displacement [nm]", xlim=(-10, 1150), ylim=(0, 15.5))
    style.label(inset, "load [µN]", "displacement [nm]", xlim=(0, 40), ylim=(0, 1.45))
    for axis in (inset.xaxis, inset.yaxis):
        axis.label.set_size(8.5)
    inset.tick_params(labelsize=8)
    panel.legend(loc="upper left")
    style.statement(panel, "paper: Hertz overestimates the displacement,\nless for shorter ranges",
                    0.98, 0.985, align="right")
    return page
