"""Maugis (1992): Dugdale's law, its theory and its solved equations, beside Lennard-Jones."""

import functools

import numpy as np
import spheres
import style
from report import Comparison

_SOURCE = "Maugis-Dugdale theory as src/theory/maugis.f90 solves it; the print was not read"
LAMBDAS = (0.1, 0.3, 0.5, 1.0, 2.0, 5.0)
_MANY = spheres.spaced(0.01, 100, 81)
# Smoothing of the step over the range of the tension; the decay length of the repulsion is half of it.
SMOOTHINGS = (0.1, 0.04, 0.02, 0.01)
_SOLVED = (0.3, 1.0, 3.0)


@functools.lru_cache(maxsize=None)
def dugdale(lam, smoothing):
    """Return the solved pull-off over pi w R under Dugdale's law, the pull-off of the theory
    with the same work and largest tension, and their lambda."""
    # Range, R and E/(1-nu^2) are 1, K = 2/3: lambda = 2 w (pi w K^2)^(-1/3) with w the stress.
    stress = (lam / 2) ** 1.5 * (4 * np.pi / 9) ** 0.5
    summary = spheres.solved(
        bodies={"radius": 1.0, "stiffness": 1.0},
        dugdale={"stress": stress, "range": 1.0, "smoothing": smoothing},
        force={"law": "exponential", "p0": 3 * stress, "decay_length": smoothing / 2},
        equilibrium_path={"h0_end": -(1.5 * np.pi * stress) ** (2 / 3)}, classical={}).summary
    work = np.pi * summary["work_of_adhesion"]
    return summary["max_tension"] / work, summary["maugis_pull_off"] / work, summary["maugis_lambda"]


def _error(lam, number=0):
    """Return the error [%] of pull-off or radius without load (1) against Lennard-Jones."""
    return 100 * abs(spheres.contact(spheres.tabor_of(lam), 0.0).errors["maugis"][number])


def numbers(_):
    pull = [_error(lam) for lam in _MANY]
    left = [100 * (solved / theory - 1) for solved, theory, _ in
            (dugdale(1.0, smoothing) for smoothing in SMOOTHINGS)]
    return {"smooth": SMOOTHINGS[-1], "smooths": ", ".join(f"{each:g}" for each in SMOOTHINGS),
            "left": ", ".join(f"{each:.2f}" for each in left) + " %",
            "worst": max(pull), "worst_at": _MANY[int(np.argmax(pull))],
            "low": spheres.where(lambda lam: _error(lam) > 1, 0.01, 0.3, 1e-3),
            "high": spheres.where(lambda lam: _error(lam) < 1, 1, 30, 1e-3),
            **{name: spheres.where(lambda lam: _error(lam, 1) < percent, 0.1, 30, 1e-3)
               for name, percent in (("ten", 10), ("one", 1))}}


def draw(_):
    page, (left, right) = style.figure(1, 2, height=3.6)
    pull, radius = np.transpose([spheres.theory("maugis", lam) for lam in _MANY])
    tabors = [spheres.tabor_of(lam) for lam in _MANY]
    for panel, theory, exact, name in (
            (left, pull, [spheres.sphere(each).tension for each in tabors], "pull-off $/\\pi wR$"),
            (right, radius, [spheres.contact(each, 0.0).radius for each in tabors],
             "radius without load $\\hat a_0$")):
        panel.semilogx(_MANY, theory, color=style.VERMILION, dashes=(5, 1.5),
                       label="Maugis-Dugdale theory")
        panel.semilogx(_MANY, exact, color=style.BLACK, label="Lennard-Jones, solved")
        style.label(panel, "Maugis' parameter $\\lambda$", name)
    right.set_ylim(1.2, 3)
    for lam in _SOLVED:
        tension, _, exact = dugdale(lam, SMOOTHINGS[-1])
        left.plot(exact, tension, "o", color=style.VERMILION,
                  label="Dugdale's law, solved" if lam == _SOLVED[0] else None)
    style.legend(page, 3)
    return page


def rows(_):
    found = []
    for lam in LAMBDAS:
        tabor = spheres.tabor_of(lam)
        for what, unit, theory, solved in zip(
                ("pull-off of Lennard-Jones", "radius without load"),
                ("pi w R", "(pi w R^2/K)^(1/3)"), spheres.theory("maugis", lam),
                (spheres.sphere(tabor).tension, spheres.contact(tabor, 0.0).radius)):
            found.append(Comparison(f"lambda = {lam:g}, {what}", "theory", theory, solved, unit,
                                    _SOURCE))
    for lam in _SOLVED:
        for smoothing in SMOOTHINGS:
            solved, theory, exact = dugdale(lam, smoothing)
            found.append(Comparison(
                f"lambda = {exact:.4g}, pull-off of Dugdale's law, smoothed over {smoothing:g} of its "
                "range", "theory", theory, solved, "pi w R", _SOURCE))
    return found
