"""Chebyshev series and polynomials of xi from -1 to 1, for the contact law."""

import numpy as np
from numpy.polynomial import chebyshev, polynomial


def folded(table, place):
    """Return the Chebyshev coefficients of a function at a place in a panel of parameters."""
    width = max(1, *map(len, table["rows"]))
    rows = np.array([row + [0]*(width - len(row)) for row in table["rows"]], float)
    return chebyshev.chebval(place, rows)*table["unit"]


def local(value, low, high):
    """Return a value between low and high as -1 to 1."""
    return (2*value - low - high)/(high - low)


def powers(series, direction=1):
    """Return coefficients of powers of xi, or of -xi."""
    return composed(chebyshev.cheb2poly(series), 0, direction)


def series(values):
    """Return the Chebyshev coefficients of values at the points."""
    count = len(values)
    found = chebyshev.chebvander(chebyshev.chebpts1(count), count - 1).T @ values*2/count
    found[0] /= 2
    return found


def composed(outer, middle, half):
    """Return the coefficients of a polynomial of middle + half xi."""
    found = np.zeros(1)
    for coefficient in outer[::-1]:
        found = polynomial.polyadd(polynomial.polymul(found, [middle, half]), [coefficient])
    return found


def real_roots(coefficients, low=-1, high=1):
    """Return the real roots between low and high, ascending."""
    # Leading coefficients of rounding errors would give roots of rounding errors.
    trimmed = polynomial.polytrim(coefficients, 1e-13*np.abs(coefficients).max())
    roots = polynomial.polyroots(trimmed)
    real = np.sort(roots[np.abs(roots.imag) < 1e-9].real)
    return real[(real >= low) & (real <= high)]


def solved(coefficients, values, low, high):
    """Return xi at which a polynomial that falls between low and high has the values."""
    values = np.asarray(values, float)
    slope = polynomial.polyder(coefficients)
    low, high = np.full(values.shape, float(low)), np.full(values.shape, float(high))
    xi = (low + high)/2
    for _ in range(80):
        excess = polynomial.polyval(xi, coefficients) - values
        low, high = np.where(excess > 0, xi, low), np.where(excess > 0, high, xi)
        with np.errstate(divide="ignore", invalid="ignore"):
            following = xi - excess/polynomial.polyval(xi, slope)
        inside = (following >= low) & (following <= high)
        following = np.where(inside, following, (low + high)/2)
        settled = np.all(np.abs(following - xi) < 1e-13)
        xi = following
        if settled:
            break
    return xi
