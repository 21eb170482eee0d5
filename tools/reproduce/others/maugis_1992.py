"""Maugis (1992): Dugdale's law, its theory and its equations solved, beside Lennard-Jones."""

import functools
import warnings

import closed_forms
import numpy as np
import snapin
import spheres
import style
from published import Comparison

DECKS = ()
TITLE = "Maugis 1992: from DMT to JKR theory by a constant tension"
CAPTION = """D. Maugis, J. Colloid Interface Sci. **150**, 243 (1992). Pull-off (left) and contact radius
without load (right) against λ: Maugis-Dugdale theory, and Lennard-Jones spheres with the same work of
adhesion and the same largest tension, solved; dots are Dugdale's law itself, solved as `&dugdale` with a
step smoothed over {smooth:g} of its range.

The theory is right about its own law: with smoothing of {smooths} of the range the solved pull-off is too
large by {left} at λ = 1: what is left goes with the smoothing, and with the decay length of the
exponential repulsion that carries the contact, half as long. A Lennard-Jones law pulls harder than the
theory says, by at most {worst:.1f} %, at λ = {worst_at:.2f}, and by less than 1 % below λ = {low:.3f} and
above {high:.1f}. Its radius without load is too small by 10 % at λ = {ten:.2f} and by 1 % at
{one:.1f}. At small λ no theory's radius is that of the largest tension: where the range of the force
is longer than what the bodies yield, the radius of a contact is a matter of definition."""

_SOURCE = "Maugis-Dugdale theory as src/theory/maugis.f90 solves it; the print was not read"
LAMBDAS = (0.1, 0.3, 0.5, 1.0, 2.0, 5.0)
# Smoothing of the step over the range of the tension; the decay length of the repulsion is half of it.
SMOOTHINGS = (0.1, 0.04, 0.02, 0.01)
_SOLVED = (0.3, 1.0, 3.0)


def tabor_of(lam):
    """Return the Tabor parameter of a Lennard-Jones law with this Maugis parameter."""
    return lam / spheres.maugis_lambda(1.0)


@functools.lru_cache(maxsize=None)
def dugdale(lam, smoothing):
    """Return pull-off over pi w R under Dugdale's law, solved, that of the theory with the same work
    and largest tension, and lambda of these."""
    # Range, R and E/(1-nu^2) are 1, K = 2/3: lambda = 2 w (pi w K^2)^(-1/3) with w the stress.
    stress = (lam / 2) ** 1.5 * (4 * np.pi / 9) ** 0.5
    deep = (1.5 * np.pi * stress) ** (2 / 3)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", snapin.SnapinWarning)
        summary = snapin.run({
            "bodies": {"radius": 1.0, "stiffness": 1.0},
            "dugdale": {"stress": stress, "range": 1.0, "smoothing": smoothing},
            "force": {"law": "exponential", "p0": 3 * stress, "decay_length": smoothing / 2},
            "equilibrium_path": {"h0_end": -deep}, "classical": {}}).summary
    work = np.pi * summary["work_of_adhesion"]
    return summary["max_tension"] / work, summary["maugis_pull_off"] / work, summary["maugis_lambda"]


def _errors(lambdas):
    """Return the errors [%] of pull-off and radius without load against Lennard-Jones."""
    found = [spheres.contact(tabor_of(lam), 0.0).errors["maugis"] for lam in lambdas]
    return 100 * np.array(found)[:, :2].T


def numbers(_):
    """Return what the caption quotes."""
    lambdas = [float(each) for each in np.geomspace(0.01, 100, 81)]
    pull, _ = _errors(lambdas)
    worst = int(np.argmax(abs(pull)))

    def error(lam):
        return abs(_errors([lam])[0][0])

    left = [100 * (solved / theory - 1) for solved, theory, _ in
            (dugdale(1.0, smoothing) for smoothing in SMOOTHINGS)]
    return {"smooth": SMOOTHINGS[-1], "smooths": ", ".join(f"{each:g}" for each in SMOOTHINGS),
            "left": ", ".join(f"{each:.2f}" for each in left) + " %",
            "worst": abs(pull[worst]), "worst_at": lambdas[worst],
            "low": spheres.where(lambda lam: error(lam) > 1, 0.01, 0.3, 1e-3),
            "high": spheres.where(lambda lam: error(lam) < 1, 1, 30, 1e-3),
            **{name: spheres.where(lambda lam: abs(_errors([lam])[1][0]) < percent, 0.1, 30, 1e-3)
               for name, percent in (("ten", 10), ("one", 1))}}


def draw(_):
    """Return the picture."""
    page, (left, right) = style.figure(1, 2, height=3.6)
    lambdas = [float(each) for each in np.geomspace(0.01, 100, 81)]
    pull, radius = closed_forms.over("maugis", lambdas)
    solved = [spheres.sphere(tabor_of(lam)).tension for lam in lambdas]
    radii = [spheres.contact(tabor_of(lam), 0.0).radius for lam in lambdas]
    for panel, theory, exact, name in ((left, pull, solved, "pull-off $/\\pi wR$"),
                                       (right, radius, radii, "radius without load $\\hat a_0$")):
        panel.semilogx(lambdas, theory, color=style.VERMILION, dashes=(5, 1.5),
                       label="Maugis-Dugdale theory")
        panel.semilogx(lambdas, exact, color=style.BLACK, label="Lennard-Jones, solved")
        style.label(panel, "Maugis' parameter $\\lambda$", name)
    right.set_ylim(1.2, 3)
    for lam in _SOLVED:
        tension, _, exact = dugdale(lam, SMOOTHINGS[-1])
        left.plot(exact, tension, "o", color=style.VERMILION,
                  label="Dugdale's law, solved" if lam == _SOLVED[0] else None)
    style.legend(page, 3)
    return page


def rows(_):
    """Return the theory beside the solved laws."""
    found = []
    for lam in LAMBDAS:
        tabor = tabor_of(lam)
        found += [
            Comparison(f"lambda = {lam:g}, pull-off of Lennard-Jones", "theory",
                       closed_forms.pull_off("maugis", lam), spheres.sphere(tabor).tension,
                       "pi w R", _SOURCE),
            Comparison(f"lambda = {lam:g}, radius without load", "theory",
                       closed_forms.radius("maugis", lam), spheres.contact(tabor, 0.0).radius,
                       "(pi w R^2/K)^(1/3)", _SOURCE)]
    for lam in _SOLVED:
        for smoothing in SMOOTHINGS:
            solved, theory, exact = dugdale(lam, smoothing)
            found.append(Comparison(
                f"lambda = {exact:.4g}, pull-off of Dugdale's law, smoothed over {smoothing:g} of its "
                "range", "theory", theory, solved, "pi w R", _SOURCE))
    return found
