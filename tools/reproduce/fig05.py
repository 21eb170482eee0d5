"""Fig. 5: displacement against load for three strengths of adhesion."""

import curves
import numpy as np
import style
from published import Row

DECKS = ("fig05_hamaker_1e-19", "fig05_hamaker_2e-20", "fig05_hamaker_1e-21")
TITLE = "Fig. 5: low and moderate adhesion"
CAPTION = """Central displacement against load for three Hamaker constants, approach (symbols) and
retreat (thin lines), beside JKR theory (black). The paper finds JKR theory very good, a jump for
σ = {sigma_0:.2f} alone, and no difference between approach and retreat. At 1 mN JKR's
displacement is off by {off_0:+.1f} %, {off_1:+.1f} % and {off_2:+.1f} % for σ = {sigma_0:.2f},
{sigma_1:.2f} and {sigma_2:.4f}. Only the first has folds: it jumps into contact at h0 =
{jump_in:.4f} nm and apart at {jump_out:.4f} nm, a hysteresis of {between:.3f} nm that the paper's
scale does not show. The pull-off, {ratio_0:.3f}, {ratio_1:.3f} and {ratio_2:.3f} of JKR's, moves
to DMT's 4/3."""

_RADIUS, _STIFFNESS = 1.5e-2, 1e11
_STYLES = (("s", style.VERMILION), ("D", style.BLUE), ("^", style.GREEN))
_LOAD = 1e-3


def _jkr_error(results, load=_LOAD):
    """Return the relative error [%] of JKR's displacement at a load."""
    curve = results.branch("loading")
    pressed = curve["load"] > 0
    exact = np.interp(load, curve["load"][pressed], curve["displacement"][pressed])
    _, displacement, loads = curves.jkr_curve(
        _RADIUS, _STIFFNESS, results.summary["surface_energy"], 4 * load)
    lowest = int(np.argmin(loads))
    return 100 * (np.interp(load, loads[lowest:], displacement[lowest:]) / exact - 1)


def numbers(runs):
    """Return what the caption quotes."""
    found = {}
    for i, deck in enumerate(DECKS):
        summary = runs[deck].summary
        found[f"sigma_{i}"] = summary["sigma"]
        found[f"off_{i}"] = _jkr_error(runs[deck])
        found[f"ratio_{i}"] = summary["max_tension"] / summary["jkr_pull_off"]
    summary = runs[DECKS[0]].summary
    found["jump_in"], found["jump_out"] = (summary[f"jump_{way}_h0"] * 1e9 for way in ("in", "out"))
    return {**found, "between": found["jump_out"] - found["jump_in"]}


def draw(runs):
    """Return the picture: the whole range, and low loads."""
    page, (whole, near) = style.figure(1, 2, height=4.5)
    for panel in (whole, near):
        for deck, (marker, color) in zip(DECKS, _STYLES):
            results = runs[deck]
            summary, loading = results.summary, results.branch("loading")
            _, displacement, load = curves.jkr_curve(
                _RADIUS, _STIFFNESS, summary["surface_energy"], 3e-3)
            panel.plot(load * 1e6, displacement * 1e9, color=style.BLACK, linewidth=1,
                       label="JKR theory" if deck == DECKS[0] else None)
            digits = 2 if summary["sigma"] > 0.1 else 4
            name = f"σ = {summary['sigma']:.{digits}f}"
            cut = None
            if "jump_in_h0" in summary:
                cut, after = curves.jump(loading, "contact")
                start = (loading["load"][cut] * 1e6, loading["displacement"][cut] * 1e9)
                style.arrow(panel, start, (loading["load"][after] * 1e6,
                                           loading["displacement"][after] * 1e9), color)
            _symbols(panel, loading, cut, marker, color, name)
            retreat = results.branch("unloading_1")
            apart = curves.jump(retreat, "apart")[0] if "jump_out_h0" in summary else -1
            x, y = (curves.broken(retreat, ("load", "displacement"), apart) if apart >= 0
                    else (retreat["load"], retreat["displacement"]))
            panel.plot(x * 1e6, y * 1e9, color=color, linewidth=1, label=None)
        style.label(panel, "load [µN]", "central displacement [nm]", "xy")
    whole.set_xlim(-700, 2300)
    whole.set_ylim(-1.1, 4.6)
    near.set_xlim(-660, 130)
    near.set_ylim(-1.1, 1.3)
    style.heading(whole, "whole range")
    style.heading(near, "pull-off and jump")
    style.statement(whole, "paper: JKR very good for σ < 1", 0.97, 0.1, align="right")
    style.statement(near, "paper: a jump for\nσ = 0.87 alone", 0.97, 0.17, align="right")
    style.legend(page, 4)
    return page


def _symbols(panel, curve, cut, marker, color, name):
    pieces = [slice(None)] if cut is None else [slice(None, cut + 1), slice(cut + 1, None)]
    for piece in pieces:
        panel.plot(curve["load"][piece] * 1e6, curve["displacement"][piece] * 1e9, marker,
                   color=color, markersize=4.5, markevery=0.04, markerfacecolor="white",
                   label=name)
        name = None


def rows(runs):
    """Return the statements of the paper."""
    found = []
    published = ("0.87", "0.17", "0.0087")
    for deck, sigma in zip(DECKS, published):
        summary = runs[deck].summary
        found.append(Row(f"Fig. 5, sigma of {deck}", float(sigma), None, summary["sigma"], "",
                         "(40)"))
    for deck, sigma in zip(DECKS, published):
        found.append(Row(f"Fig. 5, JKR displacement, sigma = {sigma}", "very good", None,
                         _jkr_error(runs[deck]), "%", "relative error at 1 mN"))
    for deck, sigma in zip(DECKS, published):
        summary = runs[deck].summary
        jumps = "jump_in_h0" in summary
        note = (f"into contact at h0 = {summary['jump_in_h0'] * 1e9:.4f} nm, from "
                f"{summary['jump_in_load'] * 1e6:.2f} µN" if jumps else "no fold on the path")
        found.append(Row(f"Fig. 5, jump, sigma = {sigma}", "yes" if sigma == "0.87" else "no", None,
                         "yes" if jumps else "no", "", note))
    first = runs[DECKS[0]]
    found.append(Row(
        "Fig. 5, hysteresis at sigma = 0.87", "none visible", None,
        (first.summary["jump_out_h0"] - first.summary["jump_in_h0"]) * 1e9, "nm",
        "jump apart less jump into contact, in h0; in contact both run through the same states"))
    weak = runs[DECKS[2]].branch("loading")
    excess = curves.hertz_displacement(weak["load"], _RADIUS, _STIFFNESS) - weak["displacement"]
    below = np.flatnonzero((excess < 0) & (weak["load"] > 0))
    found.append(Row(
        "Fig. 5, Hertz curve beside the lowest adhesion's", "just below", None,
        weak["load"][below[-1]] * 1e6 if below.size else "nowhere below", "µN",
        "highest load with Hertz below the computed displacement; above that the finite range "
        f"counts for more than the adhesion, and Hertz lies above, by {excess[-1] * 1e9:.3f} nm "
        f"at {weak['load'][-1] * 1e6:.0f} µN"))
    return found
