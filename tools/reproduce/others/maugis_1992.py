"""Maugis (1992): Dugdale's law, its theory and its solved equations, beside Lennard-Jones."""

import functools

import numpy as np
import spheres
import style
from report import Comparison

_SOURCE = ("Maugis-Dugdale theory, derived and solved in src/theory/maugis.f90; Dugdale's law, "
           "solved, tends to it")
LAMBDAS = (0.1, 0.3, 0.5, 1.0, 2.0, 5.0)
_MANY = spheres.LAMBDAS
# Smoothing of the step over the range of the tension; the decay length of the repulsion is half.
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
    return (summary["max_tension"] / work, summary["maugis_pull_off"] / work,
            summary["maugis_lambda"])


def _error(lam, number=0):
    """Return the error [%] of pull-off or radius without load (1) against Lennard-Jones."""
    return 100 * abs(spheres.errors("maugis", lam)[number])


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
    page, panels = style.figure(1, 2, height=3.6)
    for panel, theory, exact, name in zip(
            panels, np.transpose([spheres.theory("maugis", lam) for lam in _MANY]),
            np.transpose([*map(spheres.solved_at, _MANY)]),
            ("pull-off $/\\pi wR$", "radius without load $\\hat a_0$")):
        panel.semilogx(_MANY, theory, **spheres.MAUGIS)
        panel.semilogx(_MANY, exact, **spheres.SOLVED)
        style.label(panel, "Maugis' parameter $\\lambda$", name)
    panels[1].set_ylim(1.2, 3)
    tensions, _, lambdas = zip(*(dugdale(lam, SMOOTHINGS[-1]) for lam in _SOLVED))
    panels[0].plot(lambdas, tensions, "o", color=style.VERMILION, label="Dugdale's law, solved")
    style.legend(page, 3)
    return page


def rows(_):
    found = [Comparison(f"lambda = {lam:g}, {what}", "theory", theory, solved, unit, _SOURCE)
             for lam in LAMBDAS
             for what, unit, theory, solved in zip(
                 ("pull-off of Lennard-Jones", "radius without load"),
                 ("pi w R", "(pi w R^2/K)^(1/3)"), spheres.theory("maugis", lam),
                 spheres.solved_at(lam))]
    for lam in _SOLVED:
        for smoothing in SMOOTHINGS:
            solved, theory, exact = dugdale(lam, smoothing)
            found.append(Comparison(
                f"lambda = {exact:.4g}, pull-off of Dugdale's law, smoothed over {smoothing:g} of "
                "its range", "theory", theory, solved, "pi w R", _SOURCE))
    return found
