"""Fig. 8: displacement and load before contact, beside the slowly varying deformation."""

import curves
import draws
import numpy as np
import style
from snapin.plots.drawing import smooth

DECKS = ("fig08", "fig07_exact_sigma", "fig10c_paper")
_Z0 = 0.5e-9
_FORMS = {
    "closed_form": ("jump_criterion_29", "(35a), (36a)", {"color": style.BLUE, "zorder": 2}),
    "attractive_only": ("jump_equation_37", "(35b), (36b): attraction alone",
                        {"color": style.VERMILION, "dashes": (4, 2.5), "zorder": 3}),
}


def _before(runs):
    """Return the states of the approach before the jump."""
    curve = runs["fig08"].branch("loading")
    return curve[:np.argmin(np.diff(curve["h_centre"])) + 1]


def _form(runs, name):
    """Return one approximation, in order of falling h0, up to its jump."""
    rows = runs["fig08"].branch(name, "approximations")
    jump = runs["fig08"].branch(_FORMS[name][0], "approximations")
    rows = rows[rows["h0"] > jump["h0"][0]]
    return np.append(rows[np.argsort(-rows["h0"])], jump)


def _path(runs):
    """Return the path of equilibria from large separation to its first fold."""
    curve = runs["fig08"].branch("path")
    curve = curve if curve["h0"][0] > curve["h0"][-1] else curve[::-1]
    return curve[:np.flatnonzero(np.diff(curve["h0"]) > 0)[0] + 1]


def exact(runs):
    """Return jumps at sigma = 8.7 in units of z0 and gamma R."""
    case = runs["fig07_exact_sigma"].sweep[1]
    unit = case["surface_energy"] * curves.RADIUS
    return {name: case[name] / (unit if name.endswith("_load") else _Z0)
            for name in case.dtype.names
            if name.startswith(("jump_", "fold_")) and case.dtype[name].kind == "f"}


def numbers(runs):
    summary, path, full = runs["fig08"].summary, _path(runs), _form(runs, "closed_form")
    part, paper, at = _form(runs, "attractive_only"), runs.draws("fig10c_paper"), full["h0"][-1]
    jumps = draws.ranged([run.summary["jump_in_h0"] * 1e9 for run in paper])
    found = {}
    for name in ("displacement", "load"):
        # At the jump by (29), at the same gap on the axis, and at a state far from the jump.
        for key, h0, states in (("", at, path), ("_far", 4e-9, _before(runs))):
            ratio = curves.at(h0, full, name) / curves.at(h0, states, name)
            found[name + key] = 100 * abs(ratio - 1)
        same = curves.at(at + full["displacement"][-1], path, name, "h_centre")
        found[f"{name}_gap"] = 100 * abs(full[name][-1] / same - 1)
    end = part["h0"][-1]
    return {
        **found, **{f"exact_{name}": value for name, value in exact(runs).items()},
        "sigma": summary["sigma"], "fold": summary["jump_in_h0"] * 1e9, "at": at * 1e9,
        "parts": 100 * abs(part["load"][-1] / curves.at(end, full, "load") - 1),
        "early": (at - summary["jump_in_h0"]) * 1e9, "closed": summary["fold_closed_form_h0"] * 1e9,
        "nearer": (at - summary["fold_closed_form_h0"]) * 1e9, "paper": jumps,
        "paper_step": np.ptp(paper[0].branch("loading")["h0"][:2]) / 2 * 1e9,
        "paper_runs": len(paper),
        "criterion": summary["jump_criterion_29_h0"] * 1e9}


def draw(runs):
    page, panels = style.figure(1, 2, height=4.0, sharex=True)
    summary, before, fold = runs["fig08"].summary, _before(runs), _path(runs)
    closed = runs["fig08"].branch("fold_closed_form", "approximations")
    for panel, letter, name, unit, axis, limits in zip(
            panels, "ab", ("displacement", "load"), (1e-9, 1e-6),
            ("central displacement [nm]", "load [µN]"), ((-1.28, 0.03), (-54, 1))):
        for form, (_, label, kind) in _FORMS.items():
            curve = _form(runs, form)
            panel.plot(curve["h0"] * 1e9, curve[name] / unit, label=label, **kind)
        panel.plot(closed["h0"] * 1e9, closed[name] / unit, "x", color=style.BLUE, markersize=6.5,
                   markeredgewidth=1.5, label="fold of (35a)", zorder=5)
        x, y = before["h0"] * 1e9, before[name] / unit
        panel.plot(x[:-1], y[:-1], "s", color=style.BLACK, markerfacecolor="white", markersize=4.5,
                   markeredgewidth=1.1, label="the equations", zorder=4)
        panel.plot(x[-1], y[-1], "s", color=style.BLACK, markersize=5.5, zorder=5,
                   label="last before the jump")
        panel.plot(summary["jump_in_h0"] * 1e9, fold[name][-1] / unit, "o", color=style.BLACK,
                   markersize=3.5, label="fold: the jump", zorder=5)
        line = smooth(np.column_stack([fold["h0"] * 1e9, fold[name] / unit]))
        panel.plot(*line.T, color=style.BLACK, linewidth=0.8, zorder=3)
        style.label(panel, "$h_0$ [nm]", axis, letter=letter, xlim=(2.75, 6.3), ylim=limits)
    panels[0].legend(loc="lower right")
    style.statement(panels[1], "paper: remarkably accurate,\nrepulsion may be neglected",
                    0.98, 0.28, align="right")
    return page
