"""Fig. 8: displacement and load before contact, beside the slowly varying deformation."""

import draws
import numpy as np
import style
from published import Row
from drawing import smooth

DECKS = ("fig08", "fig07_exact_sigma", "fig10c_paper")
TITLE = "Fig. 8: before the jump into contact"
CAPTION = """Central displacement (a) and load (b) against h0 for σ = {sigma:.1f}, before contact.
Symbols: the equations, in steps of 0.1 nm, the last one (filled) just before the jump; the dot is
the fold of the path at which they jump, h0 = **{fold:.4f} nm**. Solid: (35a) and (36a), dashed:
(35b) and (36b), the attraction alone, each up to the jump by criterion (29), which is (37) for the
attraction alone.

The paper calls the approximation remarkably accurate. So it is: (36a) is {load_far:.1f} % off in
load and (35a) {displacement_far:.1f} % in displacement at h0 = 4 nm; at the h0 of the jump by (29),
{at:.2f} nm, {load:.0f} and {displacement:.0f} %, being near its own fold, though only
{load_gap:.0f} and {displacement_gap:.0f} % where the separations on the axis are the same. The
repulsion may indeed be neglected (dashed on solid, {parts:.2f} % apart). Criterion (29) puts the
jump {early:.2f} nm too early. The curve (35a) itself goes on to a fold (cross) at h0 = {closed:.4f}
nm, nearer to the equations' by {nearer:.3f} nm: (29) is the stricter condition. The paper's rule on
its grid gives the last state at h0 = {paper} ± {paper_step:.2f} nm in {paper_runs} runs."""

_Z0, _RADIUS = 0.5e-9, 1.5e-2
_FORMS = {
    "closed_form": ("jump_criterion_29", "(35a), (36a)", {"color": style.BLUE, "zorder": 2}),
    "attractive_only": ("jump_equation_37", "(35b), (36b): attraction alone",
                        {"color": style.VERMILION, "dashes": (4, 2.5), "zorder": 3}),
}


def _before(runs):
    """Return the states of the approach before the jump."""
    curve = runs["fig08"].branch("loading")
    last = int(np.argmin(np.diff(curve["h_centre"])))
    return {name: values[:last + 1] for name, values in curve.items()}


def _form(runs, name):
    """Return one approximation, in order of falling h0, up to its jump."""
    rows = runs["fig08"].branch(name, "approximations")
    jump = runs["fig08"].branch(_FORMS[name][0], "approximations")
    keep = rows["h0"] > jump["h0"][0]
    order = np.argsort(-rows["h0"][keep])
    return {column: np.append(rows[column][keep][order], jump[column])
            for column in ("h0", "displacement", "load")}


def _at(columns, name, h0):
    order = np.argsort(columns["h0"])
    return float(np.interp(h0, columns["h0"][order], columns[name][order]))


def _path(runs):
    """Return the path of equilibria from afar to its first fold."""
    curve = runs["fig08"].branch("path")
    order = slice(None) if curve["h0"][0] > curve["h0"][-1] else slice(None, None, -1)
    h0 = curve["h0"][order]
    fold = int(np.flatnonzero(np.diff(h0) > 0)[0])
    return {name: curve[name][order][:fold + 1] for name in ("h0", "displacement", "load")}


def numbers(runs):
    """Return what the caption quotes."""
    summary, path, full = runs["fig08"].summary, _path(runs), _form(runs, "closed_form")
    # One of these is at the h0 far from the jump.
    before = _before(runs)
    part, paper = _form(runs, "attractive_only"), runs.draws("fig10c_paper")
    at, far = full["h0"][-1], 4e-9

    def off(name, h0, states):
        return 100 * (_at(full, name, h0) / _at(states, name, h0) - 1)

    def off_at_gap(name):
        gap = path["h0"] + path["displacement"]
        order = np.argsort(gap)
        wanted = full["h0"][-1] + full["displacement"][-1]
        return 100 * (full[name][-1] / np.interp(wanted, gap[order], path[name][order]) - 1)

    return {
        "sigma": summary["sigma"], "fold": summary["jump_in_h0"] * 1e9,
        "displacement": abs(off("displacement", at, path)),
        "load": abs(off("load", at, path)), "load_far": abs(off("load", far, before)),
        "displacement_far": abs(off("displacement", far, before)),
        "at": at * 1e9, "load_gap": abs(off_at_gap("load")),
        "displacement_gap": abs(off_at_gap("displacement")),
        "parts": 100 * abs(_at(part, "load", part["h0"][-1]) / _at(full, "load", part["h0"][-1])
                           - 1),
        "early": (at - summary["jump_in_h0"]) * 1e9,
        "closed": summary["fold_closed_form_h0"] * 1e9,
        "nearer": (at - summary["fold_closed_form_h0"]) * 1e9,
        "paper": draws.ranged([run.summary["jump_in_h0"] * 1e9 for run in paper]),
        "paper_step": paper[0].summary["jump_in_uncertainty"] * 1e9, "paper_runs": len(paper),
    }


def draw(runs):
    """Return the picture."""
    page, panels = style.figure(1, 2, height=4.0, sharex=True)
    summary, before = runs["fig08"].summary, _before(runs)
    fold = _path(runs)
    closed = runs["fig08"].branch("fold_closed_form", "approximations")
    for panel, name, unit in zip(panels, ("displacement", "load"), (1e-9, 1e-6)):
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
        panel.set_xlim(2.75, 6.3)
    style.label(panels[0], "$h_0$ [nm]", "central displacement [nm]")
    style.label(panels[1], "$h_0$ [nm]", "load [µN]")
    panels[0].set_ylim(-1.28, 0.03)
    panels[1].set_ylim(-54, 1)
    style.letter(panels[0], "a")
    style.letter(panels[1], "b")
    panels[0].legend(loc="lower right")
    style.statement(panels[1], "paper: remarkably accurate,\nrepulsion may be neglected",
                    0.98, 0.28, align="right")
    return page


def rows(runs):
    """Return the statements of the paper, and the jumps at sigma = 8.7 to all digits."""
    found, exact, summary = numbers(runs), _exact(runs), runs["fig08"].summary
    step = runs["fig10c_paper"].summary
    jumps = [run.summary["jump_in_h0"] * 1e9 for run in runs.draws("fig10c_paper")]
    return [
        Row("Fig. 8, error of the displacement (35a) before contact", "remarkably accurate", None,
            found["displacement_far"], "%", f"at h0 = 4 nm; {found['displacement']:.1f} % at "
            f"the h0 of criterion (29), {found['displacement_gap']:.1f} % at its separation h(0)"),
        Row("Fig. 8, error of the load (36a) before contact", "remarkably accurate", None,
            found["load_far"], "%", f"at h0 = 4 nm; {found['load']:.1f} % at the h0 of criterion "
            f"(29), {found['load_gap']:.1f} % at its separation h(0)"),
        Row("Fig. 8, (36b) beside (36a)", "very good agreement", None, found["parts"], "%",
            "difference of the loads at the jump by (37)"),
        Row("Fig. 8, h0 at the jump", "predicted by criterion (29)", draws.ranged(jumps),
            summary["jump_in_h0"] * 1e9, "nm",
            f"(29): {summary['jump_criterion_29_h0'] * 1e9:.4f} nm. Computed, {len(jumps)} "
            "runs, to half a step, "
            f"{step['jump_in_uncertainty'] * 1e9:.2f} nm: before contact the bodies are soft, and "
            "the paper's grid and rule do well"),
        *(Row(f"sigma = 8.7, {name}", known, None, f"{value:.{digits}f}", unit, note)
          for name, known, value, digits, unit, note in (
              ("criterion (29), h0", "6.3203", exact["jump_criterion_29_h0"], 4, "z0",
               "published: evaluated independently"),
              ("criterion (29), load", "-0.37286", exact["jump_criterion_29_load"], 5, "gamma R",
               "published: evaluated independently"),
              ("(37), separation h(0)", "4.7403", exact["jump_equation_37_gap"], 4, "z0",
               "published: evaluated independently"),
              ("fold of (35a), h0", "6.2995", exact["fold_closed_form_h0"], 4, "z0",
               "published: evaluated independently"),
              ("fold of (35a), load", "-0.4138", exact["fold_closed_form_load"], 4, "gamma R",
               "published: evaluated independently"),
              ("jump in, h0", "5.9728350", exact["jump_in_h0"], 7, "z0",
               "published: an independent high-order solution"),
              ("jump in, load", "-0.4076839", exact["jump_in_load"], 7, "gamma R",
               "published: an independent high-order solution"),
              ("jump out, h0", "11.9352327", exact["jump_out_h0"], 7, "z0",
               "published: an independent high-order solution"),
              ("jump out, load", "-2.6534864", exact["jump_out_load"], 7, "gamma R",
               "published: an independent high-order solution"))),
    ]


def _exact(runs):
    """Return jumps at sigma = 8.7 in units of z0 and gamma R."""
    columns = runs["fig07_exact_sigma"].sweep
    unit = columns["surface_energy"][1] * _RADIUS
    return {name: values[1] / (unit if name.endswith("_load") else _Z0)
            for name, values in columns.items()
            if name.startswith(("jump_", "fold_")) and values.dtype.kind == "f"}
