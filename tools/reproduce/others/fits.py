"""What the chapters on formulas fitted to Maugis-Dugdale theory have in common."""

import closed_forms
import numpy as np
import spheres
import style
from published import Comparison

LAMBDAS = (0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0)
_MANY = tuple(float(each) for each in np.geomspace(0.01, 100, 81))
# Where the range of the force is short enough for bodies to have a contact radius.
SOFT = 1.0
NAMES = {"carpick": "carpick", "pietrement_troyon": "pietrement"}


def tabor_of(lam):
    """Return the Tabor parameter of a Lennard-Jones law with this Maugis parameter."""
    return lam / spheres.maugis_lambda(1.0)


def errors(theory):
    """Return errors [%] of pull-off and of radius without load: a dict by what they are against, of
    arrays over _MANY."""
    fit, maugis = (np.array(closed_forms.over(name, _MANY)) for name in (theory, "maugis"))
    solved = np.array([spheres.contact(tabor_of(lam), 0.0).errors[NAMES[theory]][:2]
                       for lam in _MANY]).T
    return {"maugis": 100 * (fit / maugis - 1), "solved": 100 * solved}


def numbers(theory):
    """Return largest and typical (median) errors against both, and where they are largest."""
    found = {"from": SOFT}
    for against, values in errors(theory).items():
        for what, each in zip(("pull", "radius"), abs(values)):
            if (against, what) == ("solved", "radius"):
                each = np.where(np.array(_MANY) >= SOFT, each, 0.0)
            found |= {f"{against}_{what}": each.max(), f"{against}_{what}_typical": np.median(each),
                      f"{against}_{what}_at": _MANY[int(np.argmax(each))]}
    return found


def draw(theory, name):
    """Return the picture: the formula over lambda, and its errors."""
    page, ((one, two), (three, four)) = style.figure(2, 2, height=5.6, sharex=True)
    solved = {one: [spheres.sphere(tabor_of(lam)).tension for lam in _MANY],
              two: [spheres.contact(tabor_of(lam), 0.0).radius for lam in _MANY]}
    fit, maugis = (closed_forms.over(each, _MANY) for each in (theory, "maugis"))
    for i, (panel, unit) in enumerate(((one, "pull-off $/\\pi wR$"),
                                       (two, "radius without load $\\hat a_0$"))):
        panel.semilogx(_MANY, fit[i], color=style.BLUE, label=name)
        panel.semilogx(_MANY, maugis[i], color=style.VERMILION, dashes=(5, 1.5),
                       label="Maugis-Dugdale theory")
        panel.semilogx(_MANY, solved[panel], color=style.BLACK, label="Lennard-Jones, solved")
        panel.set_ylabel(unit)
    found = errors(theory)
    for i, panel in enumerate((three, four)):
        panel.axhspan(-1, 1, color=style.GREY, alpha=0.2, linewidth=0)
        panel.semilogx(_MANY, found["maugis"][i], color=style.VERMILION, dashes=(5, 1.5))
        panel.semilogx(_MANY, found["solved"][i], color=style.BLACK)
        style.label(panel, "Maugis' parameter $\\lambda$", "error of the formula [%]", "y")
    three.text(0.02, 0.03, "grey: within 1 %", transform=three.transAxes, fontsize=8.5)
    two.set_ylim(1.2, 2.4)
    four.set_ylim(-12, 4)
    style.legend(page, 3, one)
    return page


def rows(theory, source):
    """Return the formula beside Maugis' theory and the solved law."""
    found = []
    for lam in LAMBDAS:
        pull, radius = closed_forms.pull_off(theory, lam), closed_forms.radius(theory, lam)
        tabor, name = tabor_of(lam), f"lambda = {lam:g}"
        unit = "(pi w R^2/K)^(1/3)"
        found += [
            Comparison(f"{name}, pull-off, Lennard-Jones", "formula", pull,
                       spheres.sphere(tabor).tension, "pi w R", source),
            Comparison(f"{name}, pull-off, Maugis-Dugdale", "formula", pull,
                       closed_forms.pull_off("maugis", lam), "pi w R", source),
            Comparison(f"{name}, radius without load, Lennard-Jones", "formula", radius,
                       spheres.contact(tabor, 0.0).radius, unit, source),
            Comparison(f"{name}, radius without load, Maugis-Dugdale", "formula", radius,
                       closed_forms.radius("maugis", lam), unit, source)]
    return found
