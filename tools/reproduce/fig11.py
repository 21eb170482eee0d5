"""Fig. 11: a spring in a field of force, and profiles of loading and unloading at the same h0."""

import curves
import draws
import numpy as np
import penetrations
import snapin
import spring
import style

DECKS = ("fig10c_converged", "fig10c_coarse")
_Z0, _HAMAKER = 0.5e-9, 1e-19
_H0, _H0_COARSE = 4e-9, 0.0
FRACTIONS = np.concatenate([np.geomspace(1e-4, 0.1, 40), np.linspace(0.12, 0.99, 60)])
# Stiffness in the picture, over the largest slope of the field.
_SHOWN = 0.28


def _field():
    """Return force, slope and the largest slope, at h^6 = 7.5 z0^6, in SI units."""
    force, slope = spring.library_force(snapin.lennard_jones(hamaker=_HAMAKER, z0=_Z0))
    return force, slope, float(slope(np.array([7.5 ** (1 / 6) * _Z0]))[0])


def _jumps(fraction):
    force, slope, largest = _field()
    return spring.jumps(force, slope, fraction * largest, 0.6 * _Z0, 100 * _Z0, count=100001)


def _radius(results, branch, h0):
    rows = results.branch(branch)
    return float(rows["contact_radius"][np.argmin(abs(rows["h0"] - h0))])


def both_in_contact(results):
    """Return contact radii of loading and deepest unloading at the h0 with contact on both."""
    loading, unloading = penetrations.outermost(results)
    last = loading["h0"][curves.jump(loading, "contact")[1]]
    unloading = unloading[(unloading["h0"] <= last) & (unloading["contact_radius"] > 0)]
    return curves.at(unloading["h0"], loading, "contact_radius"), unloading["contact_radius"]


def least_excess(results):
    """Return the least excess of the unloading tension at the same h0, over JKR's pull-off."""
    loading, unloading = penetrations.outermost(results)
    unloading = unloading[unloading["h0"] <= loading["h0"].max()]
    excess = curves.at(unloading["h0"], loading, "load") - unloading["load"]
    return float(excess.min() / results.summary["jkr_pull_off"])


def numbers(runs):
    converged, coarse = runs["fig10c_converged"], runs["fig10c_coarse"]
    held, count = 0, FRACTIONS.size
    for inward, outward in map(_jumps, FRACTIONS):
        held += inward.end < outward.start < inward.start < outward.end
    if held != count:
        raise ValueError(f"jump ends bracket the starts for {held} of {count} springs")
    (caught, freed), (in_, out) = both_in_contact(coarse), both_in_contact(converged)
    return {
        "count": count, "softest": FRACTIONS.min(), "stiffest": FRACTIONS.max(),
        "h0": _H0 * 1e9, "radius": _radius(converged, "unloading_4", _H0) * 1e6,
        "same": draws.within(float(abs(out / in_ - 1).max())), "h0_coarse": _H0_COARSE * 1e9,
        "loading": _radius(coarse, "loading", _H0_COARSE) * 1e6,
        "unloading": _radius(coarse, "unloading_3", _H0_COARSE) * 1e6,
        "larger": float(np.median((freed / np.where(caught > 0, caught, np.nan))[caught > 0])),
        "excess": draws.within(abs(least_excess(converged)))}


def draw(runs):
    """Return the picture: the spring above, profiles below."""
    page, panels = style.figure(mosaic=[["a", "a"], ["b", "c"]], height=6.4,
                                gridspec_kw={"height_ratios": (1.25, 1)})
    _draw_spring(panels["a"])
    r = np.linspace(-20e-6, 20e-6, 400)
    for letter, deck, branch, h0, name in (
            ("b", "fig10c_converged", "unloading_4", _H0, "converged"),
            ("c", "fig10c_coarse", "unloading_3", _H0_COARSE, "200 nm grid")):
        panel = panels[letter]
        panel.plot(r * 1e6, (h0 + r**2 / (2 * curves.RADIUS)) * 1e9, ":", color=style.GREY,
                   linewidth=1.3, label="undeformed")
        for part, color, kind, label in ((branch, style.VERMILION, "-", "unloading"),
                                         ("loading", style.BLUE, "--", "loading")):
            (state,) = [state for state in curves.states(runs[deck], part)
                        if abs(state["h0"][0] - h0) < 1e-13]
            x, y = state["r"] * 1e6, state["separation"] * 1e9
            panel.plot(np.append(-x[::-1], x), np.append(y[::-1], y), kind, color=color,
                       linewidth=1.5, label=label)
        style.label(panel, "r [µm]", "separation [nm]" if letter == "b" else "", letter=letter,
                    xlim=(-18, 18), ylim=(-0.4, 9))
        style.heading(panel, f"{name}, $h_0$ = {h0 * 1e9:.0f} nm", loc="center", fontsize=9.5)
        panel.legend(loc="upper center", handlelength=1.8, labelspacing=0.3)
    return page


def _draw_spring(panel):
    force, _, largest = _field()
    unit = -float(force(np.array([3 ** (1 / 6) * _Z0]))[0])
    gap = np.linspace(0.9, 4.4, 800)
    panel.plot(gap, -force(gap * _Z0) / unit, color=style.BLACK, label="attraction of the wall")
    inward, outward = _jumps(_SHOWN)
    panel.axvspan(outward.start / _Z0, inward.start / _Z0, color=style.GREY, alpha=0.18,
                  linewidth=0)
    style.word(panel, 0.5 * (outward.start + inward.start) / _Z0, 1.2, "inaccessible", ha="center",
               va="baseline")
    # Shifts [points] and sides of the words at start and end.
    for jump, color, name, words in (
            (inward, style.BLUE, "approach",
             (("starts", (8, 8), "left"), ("ends", (4, -18), "left"))),
            (outward, style.VERMILION, "retract",
             (("starts", (-9, 4), "right"), ("ends", (8, 7), "left")))):
        def pull(gap, rest=jump.rest):
            return _SHOWN * largest * (rest - gap) / unit
        ends = np.array([0.95 * min(jump), jump.rest])
        panel.plot(ends / _Z0, pull(ends), color=color, linewidth=0.9, dashes=(4, 2),
                   label=f"force of the spring, {name}")
        panel.plot(jump.start / _Z0, pull(jump.start), "o", color=color, markersize=6, zorder=6)
        style.arrow(panel, *((at / _Z0, pull(at)) for at in jump[:2]), color, linewidth=2)
        for at, (text, shift, align) in zip(jump, words):
            panel.annotate(text, (at / _Z0, -float(force(np.array([at]))[0]) / unit), shift,
                           textcoords="offset points", ha=align, fontsize=8.5, color=color)
    style.label(panel, "gap $h$ [$z_0$]", "force [largest attraction]", "y", "a",
                xlim=(0.85, 4.4), ylim=(-0.25, 1.75))
    panel.legend(loc="upper right")
    style.statement(panel, "paper: jump ends always\nbracket the jump starts", 0.985, 0.62,
                    align="right")
