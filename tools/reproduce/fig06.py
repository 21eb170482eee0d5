"""Fig. 6: profiles of separation, pressure and energy under adhesion, and the contact radius."""

import curves
import draws
import numpy as np
import profile_lines
import style
from published import Row

DECKS = ("fig06_converged", "fig06_uniform", "fig06_paper", "fig06_paper_tolerance")
TITLE = "Fig. 6: profiles under adhesion, before and after the jump into contact"
CAPTION = """Separation (a, enlarged in b), pressure (c) and energy of the surface force (d)
against the distance from the axis, from h0 = 4.3 to −2.0 nm in steps of 0.7 nm; σ = {sigma:.2f}.
Inset: contact radius, where h < 1.1 z0, against load, approach and retreat beside JKR theory. As
the paper says, the bodies are drawn out before the jump (their curvature on the axis at h0 =
{last:.1f} nm is {drawn:.2f} times the undeformed one), and a neck under tension surrounds the
contact after it. The energy in the contact comes near **−{gamma:.2f} mJ/m²**, the surface energy
of A = 1e-19 J; the 0.80 mJ/m² of the text is that of Fig. 1. The paper finds slightly larger
radii in retreat at the same load: the equations have one contact branch, and the radii agree to
{radii} of themselves.

The grid of the paper, nodes 50 nm apart, is fine enough here: with the equations solved on it
(`fig06_uniform`) the largest tension is {grid:+.3f} % off. The stopping rule is not. Stopped when
the central displacement changes by less than 1e-4 nm (`fig06_paper`, grey dashes: {count} runs that
differ in A's twelfth digit), with a mixing ratio that the stiff contact keeps low, the iteration
ends after {few:.0f} iterations in the median, the paper's 50–1000 being more, and {residual} z0 from
equilibrium at worst; the radii then do differ between approach and retreat, by {rule_radii} % at most.
The largest tension, in units of JKR's, follows from tolerance and rounding: {tolerances};
converged {ratio:.4f}. The paper's curves, smooth as they are, must come from a stricter rule than
this reading of its text."""

_Z0 = 0.5e-9


def _states(runs, deck="fig06_converged"):
    return profile_lines.states(runs[deck])


def _open_states(runs):
    """Return the profiles before contact."""
    return [state for state in _states(runs) if state["separation"][0] > 2 * _Z0]


def _curvature(state):
    """Return the curvature of the gap on the axis over that of undeformed bodies, 1/R."""
    near = state["r"] <= 0.25e-6
    fit = np.polynomial.polynomial.polyfit(state["r"][near] ** 2, state["separation"][near], 1)
    return 2 * 1.5e-2 * fit[1]


def _radii_differ(results):
    """Return the largest relative excess of the retreat's contact radius at the same load."""
    loading, retreat = results.branch("loading"), results.branch("unloading_1")
    # Where the load rises with the approach, so that a load belongs to one state.
    inside = (loading["contact_radius"] > 0) & (loading["load"] > 0)
    back = (retreat["contact_radius"] > 0) & (retreat["load"] > 0)
    order = np.argsort(loading["load"][inside])
    load = loading["load"][inside][order]
    at = np.clip(retreat["load"][back], load[0], load[-1])
    keep = at == retreat["load"][back]
    radius = _interpolated(at, load, loading["contact_radius"][inside][order])
    return float(np.max(abs(retreat["contact_radius"][back] / radius - 1)[keep]))


def _interpolated(at, x, y):
    """Return y at points between x by cubics through the four nearest."""
    values = []
    for point in at:
        first = int(np.clip(np.searchsorted(x, point) - 2, 0, max(x.size - 4, 0)))
        near, scale = slice(first, first + 4), np.ptp(x[first : first + 4])
        fit = np.polynomial.polynomial.polyfit((x[near] - point) / scale, y[near],
                                               min(3, x[near].size - 1))
        values.append(fit[0])
    return np.array(values)


def _tolerances(runs):
    """Return tolerances and, for each, the largest tensions of all runs over JKR's."""
    sweeps = [run.sweep for run in runs.draws("fig06_paper_tolerance")]
    ratios = np.transpose([sweep["max_tension"] / sweep["jkr_pull_off"] for sweep in sweeps])
    return list(zip(sweeps[0]["numerics.displacement_tolerance"], ratios))


def _edge(state):
    """Return radius and size [m, Pa] of the greatest tension of a profile, and the radius at which
    the pressure changes sign, between the nodes: from cubics through the four nearest."""
    r, tension = state["r"], -state["pressure"]
    most = int(np.argmax(tension))
    at = np.linspace(r[most - 1], r[most + 1], 4001)
    fine = _interpolated(at, r, tension)
    near = np.linspace(*r[[np.flatnonzero(tension[:most] < 0)[-1] + i for i in (0, 1)]], 4001)
    zero = np.interp(0, _interpolated(near, r, tension), near)
    return at[np.argmax(fine)], fine.max(), zero


def numbers(runs):
    """Return what the caption quotes."""
    summary, rule = runs["fig06_converged"].summary, runs.draws("fig06_paper")
    last = _open_states(runs)[-1]
    return {
        "sigma": summary["sigma"], "last": last["h0"][0] * 1e9, "drawn": _curvature(last),
        "gamma": summary["surface_energy"] * 1e3,
        "radii": draws.within(abs(_radii_differ(runs["fig06_converged"]))),
        "grid": 100 * (runs["fig06_uniform"].summary["max_tension"] / summary["max_tension"] - 1),
        "count": len(rule),
        "few": np.median(np.concatenate([run.curve["iterations"] for run in rule])),
        "residual": draws.ranged([run.summary["worst_residual"] for run in rule], 1),
        "rule_radii": draws.ranged([100 * _radii_differ(run) for run in rule], 0),
        "tolerances": ", ".join(f"{draws.ranged(ratios, 3)} at {value * 1e9:.0e} nm"
                                for value, ratios in _tolerances(runs)),
        "ratio": summary["max_tension"] / summary["jkr_pull_off"],
    }


def draw(runs):
    """Return the picture: (a) with its inset above (b), (c), (d)."""
    page, panels = style.mosaic([["a", "a", "a"], ["b", "c", "d"]], height=6.8)
    states = _states(runs)
    rule = [state for run in runs.draws("fig06_paper") for state in profile_lines.states(run)
            if round(state["h0"][0] * 1e9, 1) in (0.1, -2.0)]
    for name, column, unit, y in (("a", "separation", 1e-9, "separation [nm]"),
                                  ("b", "separation", 1e-9, "separation [nm]"),
                                  ("c", "pressure", 1e6, "pressure [MPa]"),
                                  ("d", "energy", 1e-3, "energy [mJ/m²]")):
        panel = panels[name]
        colors = profile_lines.draw(panel, states, column, unit)
        if name != "a":
            for state in rule:
                panel.plot(state["r"] * 1e6, state[column] / unit, color="#555555",
                           linewidth=0.6, linestyle=(0, (3, 1.5)), zorder=4)
        style.label(panel, "r [µm]", y, "y")
        style.letter(panel, name)
        panel.set_xlim(0, 16 if name == "a" else 9.5)
    panels["a"].set_ylim(0, 15)
    panels["b"].set_ylim(0.42, 0.8)
    panels["c"].set_ylim(-18, 15.5)
    panels["d"].set_ylim(-8.9, 0.5)
    panels["b"].text(0.3, 0.455, "dashed: paper's rule", fontsize=8.5, va="top", color="#555555")
    style.statement(panels["a"], "paper: drawn out\nbefore the jump,\na neck after it",
                    0.985, 0.195, align="right")
    gamma = runs["fig06_converged"].summary["surface_energy"] * 1e3
    panels["d"].axhline(-gamma, color=style.VERMILION, linewidth=1, linestyle=":")
    panels["d"].text(0.3, -gamma - 0.1, f"−γ = −{gamma:.2f}", fontsize=8.5, va="top",
                     color=style.VERMILION)
    panels["d"].text(0.3, -0.9, "paper:\n−0.80", fontsize=8.5, va="top", color=style.VERMILION)
    panels["d"].axhline(-0.80, color=style.VERMILION, linewidth=1, linestyle=":")
    _inset(panels["a"].inset_axes((0.085, 0.53, 0.42, 0.46)), runs)
    profile_lines.bar(page, [panels[name] for name in "abcd"], colors)
    return page


def _inset(inset, runs):
    results = runs["fig06_converged"]
    radius, _, load = curves.jkr_curve(1.5e-2, 1e11, results.summary["surface_energy"], 8e-4)
    inset.plot(load * 1e6, radius * 1e6, color=style.BLACK, linewidth=1.2, label="JKR")
    sources = [(run, style.GREY, 1.6) for run in runs.draws("fig06_paper")]
    for branch, fill, name in (("loading", "white", "approach"),
                               ("unloading_1", style.VERMILION, "retreat")):
        for source, color, size in (*sources, (results, style.VERMILION, 4)):
            curve = source.branch(branch)
            inside = curve["contact_radius"] > 0
            inset.plot(curve["load"][inside] * 1e6, curve["contact_radius"][inside] * 1e6, "o",
                       color=color, markersize=size,
                       markeredgewidth=0.8 if source is results else 0.4,
                       markerfacecolor=color if fill != "white" else "white",
                       markevery=0.07 if source is results else None,
                       label=name if source is results else None)
    inset.plot([], [], "o", color=style.GREY, markersize=2.5, label="paper's rule")
    inset.set_xlim(-980, 800)
    inset.set_ylim(0, 9)
    inset.set_xlabel("load [µN]", fontsize=8.5, labelpad=1)
    inset.set_ylabel("contact radius [µm]", fontsize=8.5, labelpad=1)
    inset.tick_params(labelsize=8)
    inset.legend(fontsize=7.5, loc="lower right", handlelength=1.4, labelspacing=0.25,
                 borderpad=0.1)


def rows(runs):
    """Return the statements of the paper."""
    results, grid = runs["fig06_converged"], runs["fig06_uniform"]
    rule = runs.draws("fig06_paper")
    summary = results.summary
    before, last = _open_states(runs)[-1], _states(runs)[-1]
    neck, tension, edge = _edge(last)
    deepest, stopped = (
        [min(state["energy"].min() for state in profile_lines.states(run)) * 1e3 for run in some]
        for some in ([results], rule))
    iterations = {"solved": grid.curve["iterations"],
                  "rule": np.concatenate([run.curve["iterations"] for run in rule])}
    found = [
        Row("Fig. 6(a), before the jump", "elongated, the curvature increases", None,
            _curvature(before), "", "curvature of the gap on the axis times R at h0 = "
            f"{before['h0'][0] * 1e9:.1f} nm; 1 for undeformed bodies"),
        Row("Fig. 6(a), after the jump", "a neck under tension", None, neck * 1e6, "µm",
            f"radius of the greatest tension, {tension / 1e6:.3f} MPa, at h0 = -2.0 nm, between "
            f"nodes; pressure changes sign at {edge * 1e6:.3f} µm"),
        Row("Fig. 6(a) inset, contact radius in retreat over approach, same load",
            "slightly larger", draws.ranged([1 + _radii_differ(run) for run in rule], 3),
            1 + _radii_differ(results), "",
            "largest ratio at compressive loads; one contact branch once the equations hold"),
        Row("Fig. 6(b), surfaces in the contact", "remain curved", None,
            last["separation"][0] / _Z0, "z0",
            "separation on the axis at h0 = -2.0 nm; it grows to 1.1 z0 at the contact radius"),
        Row("Fig. 6(c), pressure towards the centre", "increasingly repulsive", None,
            last["pressure"][0] / 1e6, "MPa", "on the axis at h0 = -2.0 nm; finite at the edge"),
        Row("Fig. 6(d), least energy", -0.80, draws.ranged(stopped, 4), deepest[0],
            "mJ/m^2", f"misprint: gamma = {summary['surface_energy'] * 1e3:.4f} mJ/m^2 for A = "
            "1e-19 J, z0 = 0.5 nm by (34); 0.80 belongs to A = 1e-20 J of Fig. 1"),
        Row("Fig. 6, largest tension over JKR's, grid alone", None,
            grid.summary["max_tension"] / summary["jkr_pull_off"],
            summary["max_tension"] / summary["jkr_pull_off"], "",
            "nodes 50 nm apart, equations solved: the grid hardly matters at sigma = 0.87"),
        Row("Method, iterations for one state", "50-1000",
            f"{np.min(iterations['rule']):.0f}-{np.max(iterations['rule']):.0f}",
            f"{np.min(iterations['solved']):.0f}-{np.max(iterations['solved']):.0f}", "",
            "mixing at no more than 0.2; computed: stopped on a change of 1e-4 nm; converged: "
            "until the residual is small (fig06_uniform)"),
    ]
    for value, ratios in _tolerances(runs):
        found.append(Row(
            f"Method, largest tension over JKR's, stopped at {value * 1e9:.0e} nm",
            None, draws.ranged(ratios, 4), summary["max_tension"] / summary["jkr_pull_off"], "",
            f"Fig. 6's deck, {ratios.size} runs; the paper stops at about 1e-4 nm"))
    return found
