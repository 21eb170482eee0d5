"""Zeros, derivatives and integrals of functions that tests can evaluate."""

import functools

import numpy as np


@functools.cache
def gauss(count, low=0.0, high=1.0):
    """Points and weights of Gauss's rule between two places."""
    points, weights = np.polynomial.legendre.leggauss(count)
    return low + (high - low) / 2 * (points + 1), (high - low) / 2 * weights


@functools.cache
def graded_rule(least=1e-16, order=24):
    """Points and weights of a rule on [0, 1] whose panels grow threefold away from 0."""
    ends = np.concatenate([[0.0], np.geomspace(least, 1, int(-2 * np.log10(least)) + 1)])
    points, weights = gauss(order)
    length = np.diff(ends)[:, None]
    return (ends[:-1, None] + length * points).ravel(), (length * weights).ravel()


def zero(function, low, high):
    """A place between two others at which a function changes its sign, by bisection."""
    sign = function(low) > 0
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if (function(middle) > 0) == sign else (low, middle)
    return low


def derivative(function, at, step):
    """The derivative by central differences, extrapolated twice: of the sixth order."""
    d = [(function(at + h) - function(at - h)) / (2 * h) for h in (step, step / 2, step / 4)]
    d = [(4 * d[1] - d[0]) / 3, (4 * d[2] - d[1]) / 3]
    return (16 * d[1] - d[0]) / 15


def integrals(function, ends, order=30):
    """The integrals of a function and of its size between successive ends, by Gauss's rule."""
    x, w = gauss(order)
    low, length = ends[:-1, None], np.diff(ends)[:, None]
    values = function((low + length * x).ravel()).reshape(-1, order) * length
    return values @ w, abs(values) @ w


def hermite(at, x, y, slope):
    """Cubics between points with given slopes; constant beyond the first and the last."""
    i = np.clip(np.searchsorted(x, at) - 1, 0, len(x) - 2)
    width = x[i + 1] - x[i]
    t = np.clip((at - x[i]) / width, 0, 1)
    return (
        (1 + 2 * t) * (1 - t) ** 2 * y[i] + t * (1 - t) ** 2 * width * slope[i]
        + t**2 * (3 - 2 * t) * y[i + 1] + t**2 * (t - 1) * width * slope[i + 1])
