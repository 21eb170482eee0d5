"""Fig. 6: profiles of separation, pressure and energy under adhesion, and the contact radius."""

import curves
import draws
import numpy as np
import style

DECKS = ("fig06_converged", "fig06_uniform", "fig06_paper", "fig06_paper_tolerance")
_Z0 = 0.5e-9
# Letter, column, unit, name of the axis, limits.
_PANELS = (("a", "separation", 1e-9, "separation [nm]", (0, 16), (0, 15)),
           ("b", "separation", 1e-9, "separation [nm]", (0, 9.5), (0.42, 0.8)),
           ("c", "pressure", 1e6, "pressure [MPa]", (0, 9.5), (-18, 15.5)),
           ("d", "energy", 1e-3, "energy [mJ/m²]", (0, 9.5), (-8.9, 0.5)))


def _radii_differ(results):
    """Return the largest relative excess of the contact radius in unloading at the same load."""
    # In this part of the approach the load increases, so that a load belongs to one state.
    loading, retreat = (rows[(rows["contact_radius"] > 0) & (rows["load"] > 0)]
                        for rows in map(results.branch, ("loading", "unloading_1")))
    loading = np.sort(loading, order="load")
    low, high = loading["load"][[0, -1]]
    retreat = retreat[(retreat["load"] >= low) & (retreat["load"] <= high)]
    radius = curves.cubic(retreat["load"], loading["load"], loading["contact_radius"])
    return float(np.max(abs(retreat["contact_radius"] / radius - 1)))


def _edge(state):
    """Return radius and size [m, Pa] of the greatest tension of a profile, and the radius at which
    the pressure changes sign, between the nodes: from cubics through the four nearest."""
    r, tension = state["r"], -state["pressure"]
    most = int(np.argmax(tension))
    at = np.linspace(r[most - 1], r[most + 1], 4001)
    fine = curves.cubic(at, r, tension)
    near = np.linspace(*r[[np.flatnonzero(tension[:most] < 0)[-1] + i for i in (0, 1)]], 4001)
    zero = np.interp(0, curves.cubic(near, r, tension), near)
    return at[np.argmax(fine)], fine.max(), zero


def _tolerances(runs):
    """Return tolerances [nm] and, for each, the largest tensions of all runs over JKR's."""
    sweeps = [run.sweep for run in runs.draws("fig06_paper_tolerance")]
    ratios = np.transpose([sweep["max_tension"] / sweep["jkr_pull_off"] for sweep in sweeps])
    return zip(sweeps[0]["numerics.displacement_tolerance"] * 1e9, ratios)


def numbers(runs):
    results, grid, rule = runs["fig06_converged"], runs["fig06_uniform"], runs.draws("fig06_paper")
    summary, states = results.summary, curves.states(results)
    # The last profile before contact, and the last of all profiles.
    before, last = [s for s in states if s["separation"][0] > 2 * _Z0][-1], states[-1]
    neck, tension, edge = _edge(last)
    deepest, *stopped = (min(s["energy"].min() for s in curves.states(run)) * 1e3
                         for run in (results, *rule))
    steps = {"rule": np.concatenate([run.curve["iterations"] for run in rule]),
             "solved": grid.curve["iterations"]}
    apart, rules = _radii_differ(results), np.array([_radii_differ(run) for run in rule])
    over, grid_over = (run.summary["max_tension"] / run.summary["jkr_pull_off"]
                       for run in (results, grid))
    tolerances = list(_tolerances(runs))
    return {
        "sigma": summary["sigma"], "last": before["h0"][0] * 1e9,
        "drawn": curves.curvature(before, 0.25e-6), "gamma": summary["surface_energy"] * 1e3,
        "radii": draws.within(abs(apart)), "grid": 100 * (grid_over / over - 1),
        "count": len(rule), "few": np.median(steps["rule"]),
        "residual": draws.ranged([run.summary["worst_residual"] for run in rule], 1),
        "rule_radii": draws.ranged(100 * rules, 0),
        "tolerances": ", ".join(f"{draws.ranged(ratios, 3)} at {value:.0e} nm"
                                for value, ratios in tolerances),
        "ratio": over, "neck": neck * 1e6, "tension": tension / 1e6, "edge": edge * 1e6,
        "retreat": draws.ranged(1 + rules, 3), "retreat_converged": 1 + apart,
        "curved": last["separation"][0] / _Z0, "centre": last["pressure"][0] / 1e6,
        "stopped": draws.ranged(stopped, 4), "deepest": deepest, "grid_over": grid_over,
        **{name: f"{np.min(each):.0f}-{np.max(each):.0f}" for name, each in steps.items()},
        **{f"{what}_{i}": value for i, (tolerance, ratios) in enumerate(tolerances)
           for what, value in (("at", f"{tolerance:.0e}"), ("stopped", draws.ranged(ratios, 4)),
                               ("runs", ratios.size))}}


def draw(runs):
    """Return the picture: (a) with its inset above (b), (c), (d)."""
    page, panels = style.figure(mosaic=[["a", "a", "a"], ["b", "c", "d"]], height=6.8)
    rule = [state for run in runs.draws("fig06_paper") for state in curves.states(run)
            if round(state["h0"][0] * 1e9, 1) in (0.1, -2.0)]
    for name, column, unit, y, x_range, y_range in _PANELS:
        panel = panels[name]
        colors = style.profiles(panel, curves.states(runs["fig06_converged"]), column, unit)
        for state in rule if name != "a" else ():
            panel.plot(state["r"] * 1e6, state[column] / unit, color="#555555", linewidth=0.6,
                       linestyle=(0, (3, 1.5)), zorder=4)
        style.label(panel, "r [µm]", y, "y", name, xlim=x_range, ylim=y_range)
    style.word(panels["b"], 0.3, 0.455, "dashed: paper's rule")
    style.statement(panels["a"], "paper: drawn out\nbefore the jump,\na neck after it",
                    0.985, 0.195, align="right")
    gamma = runs["fig06_converged"].summary["surface_energy"] * 1e3
    for at, text in ((-gamma, f"−γ = −{gamma:.2f}"), (-0.80, "paper:\n−0.80")):
        panels["d"].axhline(at, color=style.VERMILION, linewidth=1, linestyle=":")
        style.word(panels["d"], 0.3, at - 0.1, text, style.VERMILION)
    _inset(panels["a"].inset_axes((0.085, 0.53, 0.42, 0.46)), runs)
    style.bar(page, [panels[name] for name in "abcd"], colors)
    return page


def _inset(inset, runs):
    results, rule = runs["fig06_converged"], runs.draws("fig06_paper")
    radius, _, load = curves.jkr_curve(curves.RADIUS, 1e11, results.summary["surface_energy"], 8e-4)
    inset.plot(load * 1e6, radius * 1e6, color=style.BLACK, linewidth=1.2, label="JKR")
    looks = [(run, {"color": style.GREY, "markersize": 1.6, "markeredgewidth": 0.4}, style.GREY)
             for run in rule]
    looks.append((results, {"color": style.VERMILION, "markersize": 4, "markeredgewidth": 0.8,
                            "markevery": 0.07}, style.VERMILION))
    for branch, name in (("loading", "approach"), ("unloading_1", "retract")):
        for source, look, color in looks:
            curve = source.branch(branch)
            curve = curve[curve["contact_radius"] > 0]
            inset.plot(curve["load"] * 1e6, curve["contact_radius"] * 1e6, "o", **look,
                       markerfacecolor="white" if branch == "loading" else color,
                       label=name if source is results else None)
    inset.plot([], [], "o", color=style.GREY, markersize=2.5, label="paper's rule")
    inset.set(xlim=(-980, 800), ylim=(0, 9))
    inset.set_xlabel("load [µN]", fontsize=8.5, labelpad=1)
    inset.set_ylabel("contact radius [µm]", fontsize=8.5, labelpad=1)
    inset.tick_params(labelsize=8)
    inset.legend(fontsize=7.5, loc="lower right", handlelength=1.4, labelspacing=0.25,
                 borderpad=0.1)
