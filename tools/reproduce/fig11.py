"""Fig. 11: a spring in a field of force, and profiles of loading and unloading at the same h0."""

import functools

import curves
import draws
import numpy as np
import penetrations
import snapin
import spring
import style
from published import Row

DECKS = ("fig10c_converged", "fig10c_coarse")
TITLE = "Fig. 11: why there is hysteresis"
CAPTION = """(a) A spring in the attraction of a Lennard-Jones wall. It rests where the line of the
spring's force, whose slope is its stiffness, meets the force of the wall. Where the line touches it
as a tangent (dots) the spring jumps, along the line to the next crossing (arrows). As the paper
says, the ends of the jumps bracket their starts and the shaded gaps between the starts are never
reached: it held for all of {count} stiffnesses from {softest:.0e} to {stiffest} of the largest
slope, and `tests/tools/test_spring.py` has other laws, closed forms among them. By the mean-value
theorem the slope passes the stiffness between the ends of a jump; where it exceeds the stiffness on
one interval only, that is beyond the other start.

(b), (c) Separations of σ = 8.7 at the same h0 in loading and unloading, the undeformed bodies
dotted. Converged (b), h0 = {h0:.0f} nm lies between the two jumps: in loading the bodies are apart,
in unloading in contact, with a radius of {radius:.1f} µm. Once both are in contact the two are the
same to {same}. The paper's sketch has two contacts of different radii at one h0. Such states
are there on a grid that does not resolve the neck, here (c) with nodes 200 nm apart at h0 =
{h0_coarse:.0f} nm: {loading:.1f} µm in loading, {unloading:.1f} µm in unloading. Each node by
itself is then a spring that jumps; without a grid the surface moves as one."""

_Z0, _HAMAKER = 0.5e-9, 1e-19
_RADIUS = 1.5e-2
_H0, _H0_COARSE = 4e-9, 0.0
_FRACTIONS = np.concatenate([np.geomspace(1e-4, 0.1, 40), np.linspace(0.12, 0.99, 60)])
# Of the picture: stiffness over the largest slope of the field.
_SHOWN = 0.28


def _field():
    """Return force, slope and the largest slope, which is where h^6 = 7.5 z0^6, in SI."""
    force, slope = spring.library_force(snapin.lennard_jones(hamaker=_HAMAKER, z0=_Z0))
    return force, slope, float(slope(np.array([7.5 ** (1 / 6) * _Z0]))[0])


def _jumps(fraction):
    force, slope, largest = _field()
    return spring.jumps(force, slope, fraction * largest, 0.6 * _Z0, 100 * _Z0, count=100001)


def _brackets():
    """Return for how many of the stiffnesses the ends of jumps bracket their starts."""
    return _brackets_of(tuple(_FRACTIONS))


@functools.cache
def _brackets_of(fractions):
    return sum(inward.end < outward.start < inward.start < outward.end
               for inward, outward in map(_jumps, fractions))


def _profile(results, branch, h0):
    rows = results.branch(branch, "profiles")
    chosen = abs(rows["h0"] - h0) < 1e-13
    return rows["r"][chosen], rows["separation"][chosen]


def _radius(results, branch, h0):
    rows = results.branch(branch)
    return float(rows["contact_radius"][np.argmin(abs(rows["h0"] - h0))])


def _both_in_contact(results):
    """Return contact radii of loading and deepest unloading at the h0 where both are in contact."""
    loading = results.branch("loading")
    unloading = results.branch(penetrations.deepest(results))
    order = np.argsort(loading["h0"])
    here = np.interp(unloading["h0"], loading["h0"][order], loading["contact_radius"][order])
    before, after = curves.jump(loading, "contact")
    both = (unloading["h0"] <= loading["h0"][after]) & (unloading["contact_radius"] > 0)
    return here[both], unloading["contact_radius"][both]


def _same(results):
    loading, unloading = _both_in_contact(results)
    return float(abs(unloading / loading - 1).max())


def _least_excess(results):
    """Return the least excess of the unloading tension at the same h0, over JKR's pull-off."""
    loading = results.branch("loading")
    unloading = results.branch(penetrations.deepest(results))
    order = np.argsort(loading["h0"])
    excess = np.interp(unloading["h0"], loading["h0"][order], loading["load"][order])
    inside = unloading["h0"] <= loading["h0"].max()
    return float((excess - unloading["load"])[inside].min() / results.summary["jkr_pull_off"])


def numbers(runs):
    """Return what the caption quotes."""
    converged, coarse = runs["fig10c_converged"], runs["fig10c_coarse"]
    held = _brackets()
    if held != _FRACTIONS.size:
        raise ValueError(f"jump ends bracket the starts for {held} of {_FRACTIONS.size} springs")
    return {
        "count": _FRACTIONS.size, "softest": _FRACTIONS.min(), "stiffest": _FRACTIONS.max(),
        "h0": _H0 * 1e9, "radius": _radius(converged, "unloading_4", _H0) * 1e6,
        "same": draws.within(_same(converged)), "h0_coarse": _H0_COARSE * 1e9,
        "loading": _radius(coarse, "loading", _H0_COARSE) * 1e6,
        "unloading": _radius(coarse, "unloading_3", _H0_COARSE) * 1e6,
    }


def draw(runs):
    """Return the picture: the spring above, profiles below."""
    page, panels = style.figure(2, 2, height=6.4, gridspec_kw={"height_ratios": (1.25, 1)})
    grid = panels[0, 0].get_gridspec()
    for panel in panels[0]:
        panel.remove()
    _draw_spring(page.add_subplot(grid[0, :]))
    for panel, letter, deck, branch, h0, name in (
            (panels[1, 0], "b", "fig10c_converged", "unloading_4", _H0, "converged"),
            (panels[1, 1], "c", "fig10c_coarse", "unloading_3", _H0_COARSE, "200 nm grid")):
        _draw_profiles(panel, runs[deck], branch, h0)
        panel.set_title(f"({letter})", loc="left", fontweight="bold")
        panel.set_title(f"{name}, $h_0$ = {h0 * 1e9:.0f} nm", fontsize=9.5)
    panels[1, 1].set_ylabel("")
    return page


def _draw_spring(panel):
    force, _, largest = _field()
    unit = -float(force(np.array([3 ** (1 / 6) * _Z0]))[0])
    gap = np.linspace(0.9, 4.4, 800)
    panel.plot(gap, -force(gap * _Z0) / unit, color=style.BLACK, label="attraction of the wall")
    inward, outward = _jumps(_SHOWN)
    panel.axvspan(outward.start / _Z0, inward.start / _Z0, color=style.GREY, alpha=0.18,
                  linewidth=0)
    panel.text(0.5 * (outward.start + inward.start) / _Z0, 1.2, "inaccessible", ha="center",
               fontsize=8.5, color="#555555")
    for jump, color, name in ((inward, style.BLUE, "approach"),
                              (outward, style.VERMILION, "retreat")):
        def pull(gap, rest=jump.rest):
            return _SHOWN * largest * (rest - gap) / unit
        ends = np.array([0.95 * min(jump), jump.rest])
        panel.plot(ends / _Z0, pull(ends), color=color, linewidth=0.9, dashes=(4, 2),
                   label=f"force of the spring, {name}")
        panel.plot(jump.start / _Z0, pull(jump.start), "o", color=color, markersize=6, zorder=6)
        style.arrow(panel, (jump.start / _Z0, pull(jump.start)), (jump.end / _Z0, pull(jump.end)),
                    color, linewidth=2)
    for text, at, shift, align, color in (
            ("starts", inward.start, (8, 8), "left", style.BLUE),
            ("ends", inward.end, (4, -18), "left", style.BLUE),
            ("starts", outward.start, (-9, 4), "right", style.VERMILION),
            ("ends", outward.end, (8, 7), "left", style.VERMILION)):
        panel.annotate(text, (at / _Z0, -float(force(np.array([at]))[0]) / unit), shift,
                       textcoords="offset points", ha=align, fontsize=8.5, color=color)
    style.label(panel, "gap $h$ [$z_0$]", "force [largest attraction]", "y")
    style.letter(panel, "a")
    panel.set_xlim(0.85, 4.4)
    panel.set_ylim(-0.25, 1.75)
    panel.legend(loc="upper right")
    style.statement(panel, "paper: jump ends always\nbracket the jump starts", 0.985, 0.62,
                    align="right")


def _draw_profiles(panel, results, branch, h0):
    r = np.linspace(-20e-6, 20e-6, 400)
    panel.plot(r * 1e6, (h0 + r**2 / (2 * _RADIUS)) * 1e9, ":", color=style.GREY, linewidth=1.3,
               label="undeformed")
    for name, color, kind, label in ((branch, style.VERMILION, "-", "unloading"),
                                     ("loading", style.BLUE, "--", "loading")):
        x, y = _profile(results, name, h0)
        panel.plot(np.append(-x[::-1], x) * 1e6, np.append(y[::-1], y) * 1e9, kind, color=color,
                   linewidth=1.5, label=label)
    style.label(panel, "r [µm]", "separation [nm]")
    panel.set_xlim(-18, 18)
    panel.set_ylim(-0.4, 9)
    panel.legend(loc="upper center", handlelength=1.8, labelspacing=0.3)


def rows(runs):
    """Return the statements of the paper."""
    converged, coarse = runs["fig10c_converged"], runs["fig10c_coarse"]
    caught, freed = _both_in_contact(coarse)
    inside = caught > 0
    return [
        Row("Fig. 11, jump ends bracket jump starts", "always", None,
            f"{_brackets()} of {_FRACTIONS.size} stiffnesses", "", "a spring before a "
            "Lennard-Jones wall, where the slope of the force exceeds the stiffness on one "
            "interval. The paper is right"),
        Row("Fig. 11, contact radius of unloading over loading at the same h0",
            "always larger", float(np.median(freed[inside] / caught[inside])),
            f"1, to {draws.within(_same(converged))}", "",
            "sigma = 8.7, both in contact. Computed: nodes 200 nm apart, equations solved, median. "
            "Converged, the radii differ only between the jumps, where the loading has no contact"),
        Row("section III D, unloading tension less loading tension at the same h0, the least",
            "greater than or equal to 0", None,
            f"0, to {draws.within(abs(_least_excess(converged)))}", "JKR pull-off",
            "sigma = 8.7. The paper is right"),
    ]
