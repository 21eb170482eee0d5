"""The common part of the chapters on formulas fitted to Maugis-Dugdale theory."""

import functools

import numpy as np
import spheres
import style
from report import Comparison

LAMBDAS = (0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0)
_MANY = spheres.LAMBDAS
# Here the range of the force is so short that bodies have a contact radius.
SOFT = 1.0


def _over(theory):
    """Return pull-offs and radii without load of a theory over _MANY."""
    return np.transpose([spheres.theory(theory, lam) for lam in _MANY])


def _errors(theory):
    """Return errors [%] of pull-off and of radius without load: a dict by reference, of arrays
    over _MANY."""
    solved = [spheres.errors(theory.split("_")[0], lam)[:2] for lam in _MANY]
    return {"maugis": 100 * (_over(theory) / _over("maugis") - 1),
            "solved": 100 * np.transpose(solved)}


def numbers(theory, _):
    """Return largest and typical (median) errors against both references, and the places of the
    largest."""
    found = {"from": SOFT}
    for against, values in _errors(theory).items():
        for what, each in zip(("pull", "radius"), abs(values)):
            if (against, what) == ("solved", "radius"):
                each = np.where(np.array(_MANY) >= SOFT, each, 0.0)
            found |= {f"{against}_{what}": each.max(), f"{against}_{what}_typical": np.median(each),
                      f"{against}_{what}_at": _MANY[int(np.argmax(each))]}
    return found


def draw(theory, name, _):
    """Return the picture: the formula over lambda, and its errors."""
    page, ((one, two), (three, four)) = style.figure(2, 2, height=5.6, sharex=True)
    found = _errors(theory)
    for panel, below, unit, formula, maugis, solved, *errors in zip(
            (one, two), (three, four), ("pull-off $/\\pi wR$", "radius without load $\\hat a_0$"),
            _over(theory), _over("maugis"), np.transpose([*map(spheres.solved_at, _MANY)]),
            found["maugis"], found["solved"]):
        panel.semilogx(_MANY, formula, color=style.BLUE, label=name)
        panel.semilogx(_MANY, maugis, **spheres.MAUGIS)
        panel.semilogx(_MANY, solved, **spheres.SOLVED)
        panel.set_ylabel(unit)
        below.axhspan(-1, 1, color=style.GREY, alpha=0.2, linewidth=0)
        below.semilogx(_MANY, errors[0], **spheres.MAUGIS)
        below.semilogx(_MANY, errors[1], **spheres.SOLVED)
        style.label(below, "Maugis' parameter $\\lambda$", "error of the formula [%]", "y")
    style.word(three, 0.02, 0.03, "grey: within 1 %", style.BLACK, transform=three.transAxes,
               va="baseline")
    two.set_ylim(1.2, 2.4)
    four.set_ylim(-12, 4)
    style.legend(page, 3, one)
    return page


def rows(theory, source, _):
    return [Comparison(f"lambda = {lam:g}, {what}, {against}", "formula", mine, other, unit, source)
            for lam in LAMBDAS
            for what, unit, mine, *others in zip(
                ("pull-off", "radius without load"), ("pi w R", "(pi w R^2/K)^(1/3)"),
                spheres.theory(theory, lam), spheres.solved_at(lam), spheres.theory("maugis", lam))
            for against, other in zip(("Lennard-Jones", "Maugis-Dugdale"), others)]


def chapter(theory, name, source):
    """Return `numbers`, `draw` and `rows` of a chapter on a formula."""
    return (functools.partial(numbers, theory), functools.partial(draw, theory, name),
            functools.partial(rows, theory, source))
