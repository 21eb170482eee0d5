"""Fig. 5: displacement against load for three strengths of adhesion."""

import curves
import numpy as np
import style

DECKS = ("fig05_hamaker_1e-19", "fig05_hamaker_2e-20", "fig05_hamaker_1e-21")
_STIFFNESS, _LOAD = 1e11, 1e-3
_STYLES = (("s", style.VERMILION), ("D", style.BLUE), ("^", style.GREEN))


def numbers(runs):
    """Return the numbers in the text of the page, for each deck with its number."""
    found = {}
    for i, deck in enumerate(DECKS):
        summary, curve = runs[deck].summary, runs[deck].branch("loading")
        pressed = curve[curve["load"] > 0]
        exact = np.interp(_LOAD, pressed["load"], pressed["displacement"])
        _, displacement, load = curves.jkr_curve(curves.RADIUS, _STIFFNESS,
                                                 summary["surface_energy"], 4 * _LOAD)
        lowest = int(np.argmin(load))
        jkr = np.interp(_LOAD, load[lowest:], displacement[lowest:])
        jumps = "jump_in_h0" in summary
        found |= {f"sigma_{i}": summary["sigma"],
                  f"off_{i}": 100 * (jkr / exact - 1),
                  f"ratio_{i}": summary["max_tension"] / summary["jkr_pull_off"],
                  f"jumps_{i}": "yes" if jumps else "no",
                  f"where_{i}": f"into contact at h0 = {summary['jump_in_h0'] * 1e9:.4f} nm, from "
                                f"{summary['jump_in_load'] * 1e6:.2f} µN" if jumps
                                else "no fold on the path"}
    first, weak = runs[DECKS[0]].summary, runs[DECKS[2]].branch("loading")
    found["jump_in"], found["jump_out"] = (first[f"jump_{way}_h0"] * 1e9 for way in ("in", "out"))
    excess = curves.hertz_displacement(weak["load"], _STIFFNESS) - weak["displacement"]
    below = np.flatnonzero((excess < 0) & (weak["load"] > 0))
    return {**found, "between": found["jump_out"] - found["jump_in"],
            "below": f"{weak['load'][below[-1]] * 1e6:.6g}" if below.size else "nowhere below",
            "excess": excess[-1] * 1e9, "last": weak["load"][-1] * 1e6}


def draw(runs):
    """Return the picture: the whole range, and low loads."""
    page, (whole, near) = style.figure(1, 2, height=4.5)
    for panel in (whole, near):
        for deck, (marker, color) in zip(DECKS, _STYLES):
            summary, loading = runs[deck].summary, runs[deck].branch("loading")
            _, displacement, load = curves.jkr_curve(curves.RADIUS, _STIFFNESS,
                                                     summary["surface_energy"], 3e-3)
            panel.plot(load * 1e6, displacement * 1e9, color=style.BLACK, linewidth=1,
                       label="JKR theory" if deck == DECKS[0] else None)
            jumps, retreat = "jump_in_h0" in summary, runs[deck].branch("unloading_1")
            x, y = curves.drawn(loading)
            cut = curves.jump(loading, "contact")[1] if jumps else 0
            if jumps:
                style.arrow(panel, *curves.jump_ends(loading, "contact"), color)
            # The count of markers begins again beyond the jump.
            for part in (slice(cut), slice(cut, None))[0 if jumps else 1:]:
                name = f"σ = {summary['sigma']:.{2 if summary['sigma'] > 0.1 else 4}f}"
                panel.plot(x[part], y[part], marker, color=color, markersize=4.5, markevery=0.04,
                           markerfacecolor="white",
                           label=name if part.start is None or not jumps else None)
            panel.plot(*curves.drawn(retreat, "apart" if jumps else None), color=color, linewidth=1)
    axes = "load [µN]", "central displacement [nm]", "xy"
    style.label(whole, *axes, xlim=(-700, 2300), ylim=(-1.1, 4.6))
    style.label(near, *axes, xlim=(-660, 130), ylim=(-1.1, 1.3))
    style.heading(whole, "whole range")
    style.heading(near, "pull-off and jump")
    style.statement(whole, "paper: JKR very good for σ < 1", 0.97, 0.1, align="right")
    style.statement(near, "paper: a jump for\nσ = 0.87 alone", 0.97, 0.17, align="right")
    style.legend(page, 4)
    return page
