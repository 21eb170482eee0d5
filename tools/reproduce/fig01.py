"""Fig. 1: displacement against load, with and without adhesion."""

import curves
import draws
import numpy as np
import style

DECKS = ("fig01_hertz_exponential", "fig01_lennard_jones", "fig06_paper", "fig06_uniform")
_STIFFNESS, _PUBLISHED = 1e10, 59e-6


def numbers(runs):
    summary, grid = (runs[deck].summary for deck in ("fig01_lennard_jones", "fig06_uniform"))
    repulsion, rules = runs["fig01_hertz_exponential"].curve, runs.draws("fig06_paper")
    # Figs. 1 and 6 are one problem, sigma = 0.87, with all loads ten times larger in Fig. 6.
    factor = summary["jkr_pull_off"] / grid["jkr_pull_off"] * 1e6
    hertz = curves.hertz_displacement(repulsion["load"][-1], _STIFFNESS)
    return {
        "sigma": summary["sigma"], "tension": summary["max_tension"] * 1e6,
        "over": 100 * (summary["max_tension"] / summary["jkr_pull_off"] - 1),
        "error": summary["error_estimate"], "window": _window(runs) * 1e9,
        "jump_in": summary["jump_in_h0"] * 1e9, "jump_out": summary["jump_out_h0"] * 1e9,
        "between": (summary["jump_out_h0"] - summary["jump_in_h0"]) * 1e9,
        "least": -summary["max_tension"] * 1e6, "grid": -grid["max_tension"] * factor,
        "stopped": draws.ranged([-run.last("unload_max_tension") * factor for run in rules], 1),
        "left": draws.ranged([run.summary["worst_residual"] for run in rules], 1),
        "count": len(rules), "jkr": -summary["jkr_pull_off"] * 1e6,
        "dmt": -summary["dmt_pull_off"] * 1e6, "scale": repulsion["load"].max() * 1e3,
        "hertz": (hertz / repulsion["displacement"][-1] - 1) * 100}


def _window(runs):
    """Return the range of h0 [m] in which the tension is above the published one."""
    curve = runs["fig01_lennard_jones"].branch("unloading_1")
    curve = curve[curve["h_centre"] < 1e-9]
    fine = np.linspace(*curve["h0"][[0, -1]], 100001)
    above = fine[np.interp(fine, curve["h0"], -curve["load"]) > _PUBLISHED]
    return above[-1] - above[0]


def draw(runs):
    """Return the picture: the whole range, and the tension at small loads."""
    page, (whole, near) = style.figure(1, 2, height=4.4)
    adhesion, summary = (runs["fig01_lennard_jones"].branch("loading"),
                         runs["fig01_lennard_jones"].summary)
    load = np.linspace(0, 1.6e-3, 2000) ** 2 / 1.6e-3
    _, jkr, jkr_load = curves.jkr_curve(
        curves.RADIUS, _STIFFNESS, summary["surface_energy"], 1.6e-3)
    (x, y), (_, after) = curves.drawn(adhesion), curves.jump(adhesion, "contact")
    tail, head = curves.jump_ends(adhesion, "contact")
    for panel, text, x_range, y_range in ((whole, "whole range", (-120, 1450), (-1.8, 14.8)),
                                          (near, "small loads", (-84, 74), (-1.25, 3.3))):
        panel.plot(load * 1e6, curves.hertz_displacement(load, _STIFFNESS) * 1e9,
                   color=style.BLACK, label="Hertz theory")
        panel.plot(jkr_load * 1e6, jkr * 1e9, color=style.BLACK, **style.DASHED, label="JKR theory")
        panel.plot(*curves.drawn(runs["fig01_hertz_exponential"].curve), "s", color=style.BLUE,
                   markerfacecolor="white", markevery=0.035, label="exponential repulsion, 0.2 nm")
        for part, name in ((slice(after, None), "Lennard-Jones adhesion"), (slice(after), None)):
            panel.plot(x[part], y[part], "^", color=style.VERMILION, markevery=0.035, label=name)
        style.arrow(panel, tail, head, style.VERMILION)
        style.label(panel, "load [µN]", "central displacement [nm]", "xy", xlim=x_range,
                    ylim=y_range)
        style.heading(panel, text)
    style.legend(page, 2)
    for value, name in ((-75, "DMT"), (-56.25, "JKR")):
        near.axvline(value, color=style.GREY, linewidth=1, linestyle=":", zorder=0)
        style.word(near, value + 1.5, 3.3, name, style.GREY)
    lowest, least = int(np.argmin(adhesion["load"])), -summary["max_tension"] * 1e6
    style.note(near, f"paper −59 µN\nhere −{-least:.1f} µN",
               (least, np.interp(least, x[lowest:], y[lowest:])), (-53, 2.35),
               color=style.VERMILION)
    style.word(near, (tail[0] + head[0]) / 2 + 7, (tail[1] + head[1]) / 2, "jump", style.VERMILION,
               va="center")
    return page
