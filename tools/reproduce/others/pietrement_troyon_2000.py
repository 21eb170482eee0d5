"""Pietrement and Troyon (2000): contact radius and indentation under a load, in closed form."""

import numpy as np
import spheres
from others import fits
from published import Comparison

DECKS = ()
TITLE = "Pietrement and Troyon 2000: radius and indentation in closed form"
CAPTION = """O. Pietrement and M. Troyon, J. Colloid Interface Sci. **226**, 166 (2000), gave pull-off and
radius without load as polynomials of Carpick's α, and the indentation, which Carpick's formula lacks:

    F0/πwR = −(0.267 α² − 0.767 α + 2)
    a0/(πwR²/K)^(1/3) = −0.451 α⁴ + 1.417 α³ − 1.365 α² + 0.950 α + 1.264
    δ = (a0²/R) (z^(4/3) − S z^(2β/3)),  z = (α + √(1 − F/F0))/(1 + α)
    S = −2.160 α^0.019 + 2.7531 α^0.064 + 0.073 α^1.919,  β = 0.516 α⁴ − 0.683 α³ + 0.235 α² + 0.429 α

**Against Maugis-Dugdale theory**, α from λ, pull-off is off by at most {maugis_pull:.2f} % (at λ =
{maugis_pull_at:.2f}), a0 by at most {maugis_radius:.2f} % (at {maugis_radius_at:.2f}). Most of that is the relation
between α and λ: where α is fitted to the theory's curve of radius against load, as an
experimenter does, it is {fitted_pull:.2f} % and {fitted_radius:.2f} %. **Against Lennard-Jones spheres**,
solved, it is at most {solved_pull:.2f} % (at {solved_pull_at:.2f}) and {solved_radius:.2f} % (at
{solved_radius_at:.2f}, for λ from {from:g} on). The indentation without load is off by at most {indentation:.1f} % of a²/R for λ from
{indentation_low:g} to 100. S passes through zero at α = {zero:.4f}, λ = {zero_lambda:.4f}, and
then changes its sign although DMT theory, α = 0, has none of it: below that the indentation is not to be used.
The program has the formulas as `&classical theories = 'pietrement_troyon'`."""

_SOURCE = "coefficients as they are quoted, those of the caption; the print was not read"
_LOW = 0.1


def _fitted(lam):
    """Return errors [%] of pull-off and radius against Maugis' theory with alpha fitted to it."""
    import closed_forms

    least, rest = closed_forms.pull_off("maugis", lam), closed_forms.radius("maugis", lam)
    loads = np.linspace(-0.99999 * least, least, 200)
    curve = np.array([closed_forms.radius("maugis", lam, float(load)) for load in loads]) / rest
    alphas = np.linspace(0, 1, 2001)[:, None]
    form = ((alphas + np.sqrt(1 + loads / least)) / (1 + alphas)) ** (2 / 3)
    alpha = float(alphas[np.argmin(((form - curve) ** 2).sum(axis=1)), 0])
    pull = 0.267 * alpha**2 - 0.767 * alpha + 2
    radius = -0.451 * alpha**4 + 1.417 * alpha**3 - 1.365 * alpha**2 + 0.950 * alpha + 1.264
    return 100 * (pull / least - 1), 100 * (radius / rest - 1)


def numbers(_):
    """Return what the caption quotes."""
    fitted = abs(np.array([_fitted(float(lam)) for lam in np.geomspace(0.01, 100, 33)])).max(axis=0)
    lambdas = [float(each) for each in np.geomspace(_LOW, 100, 31)]
    indentation = max(abs(spheres.contact(fits.tabor_of(lam), 0.0).errors["pietrement"][2])
                      for lam in lambdas)
    zero = spheres.where(lambda a: _pull(a) > 0, 1e-3, 1e-2, 1e-6)
    return {**fits.numbers("pietrement_troyon"), "fitted_pull": fitted[0], "fitted_radius": fitted[1],
            "indentation": 100 * indentation, "indentation_low": _LOW, "zero": zero,
            "zero_lambda": -0.924 * np.log(1 - 1.02 * zero)}


def _pull(alpha):
    return -2.160 * alpha**0.019 + 2.7531 * alpha**0.064 + 0.073 * alpha**1.919


def draw(_):
    """Return the picture."""
    return fits.draw("pietrement_troyon", "Pietrement and Troyon")


def rows(_):
    """Return the formula beside theory and solution."""
    found = fits.rows("pietrement_troyon", _SOURCE)
    for lam in fits.LAMBDAS:
        one = spheres.contact(fits.tabor_of(lam), 0.0)
        error = one.errors["pietrement"][2] * one.radius**2
        found.append(Comparison(
            f"lambda = {lam:g}, indentation without load, Lennard-Jones", "formula",
            one.displacement + error, one.displacement, "(pi^2 w^2 R/K^2)^(1/3)", _SOURCE))
    return found
