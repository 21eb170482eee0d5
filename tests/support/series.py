"""Parts of the path as Chebyshev series in its parameter, halved until they are resolved."""

import math
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from support.states import Lost, State, solve


class Resolution(NamedTuple):
    """Widths of panels in z, nodes in a panel, distance of nodes, terms of a series."""

    width: float = 1.5
    order: int = 18
    scale: float = 0.2
    terms: int = 17
    tail: float = 1e-10


USUAL = Resolution()
FINE = Resolution(width=1.2, order=20, scale=0.15, terms=21, tail=1e-11)


class Piece(NamedTuple):
    """A part of the path as Chebyshev series over [-1, 1]."""

    h0: np.ndarray
    load: np.ndarray
    axis: np.ndarray
    start: float
    end: float
    last: State


def nodes(terms):
    """Chebyshev's extreme points from -1 to 1."""
    return -np.cos(math.pi * np.arange(terms) / (terms - 1))


def series(values):
    """Coefficients of the polynomial through values at the nodes."""
    n = len(values) - 1
    return np.linalg.solve(chebyshev.chebvander(nodes(n + 1), n), values)


def stretch(sigma, mesh, parameter, limits, state, resolution):
    """The pieces from one value of the logarithmic parameter to another, halved until resolved."""
    places = (limits[0] + limits[1]) / 2 + (limits[1] - limits[0]) / 2 * nodes(resolution.terms)
    known = []
    try:
        for place in places:
            log_gap, h0 = ahead(known, place) if known else (np.log(state.gap), state.h0)
            found = solve(sigma, mesh, parameter(place), log_gap, h0)
            known.append((place, found))
    except Lost:
        if abs(limits[1] - limits[0]) < 1e-3:
            raise
    else:
        columns = [[getattr(s, name) for _, s in known] for name in ("h0", "load", "axis")]
        found = [series(column) for column in columns]
        sizes = max(1.0, abs(found[0]).max()), abs(found[1]).max()
        rest = max(abs(c[-2:]).max() / size for c, size in zip(found, sizes))
        if rest <= resolution.tail or abs(limits[1] - limits[0]) < 0.02:
            return [Piece(*found, *limits, known[-1][1])]
    middle = sum(limits) / 2
    first = stretch(sigma, mesh, parameter, (limits[0], middle), state, resolution)
    second = (middle, limits[1])
    return first + stretch(sigma, mesh, parameter, second, first[-1].last, resolution)


def ahead(known, place):
    """Gaps and h0 at `place`, extrapolated from the last few states."""
    few = known[-5:]
    log_gap, h0 = 0.0, 0.0
    for i, (mine, state) in enumerate(few):
        others = [other for j, (other, _) in enumerate(few) if j != i]
        weight = math.prod((place - other) / (mine - other) for other in others)
        log_gap, h0 = log_gap + weight * np.log(state.gap), h0 + weight * state.h0
    return log_gap, h0


def trimmed(coefficients):
    """A series without last coefficients that are only rounding errors and would move roots."""
    kept = np.flatnonzero(abs(coefficients) > 1e-15 * abs(coefficients).max())
    return coefficients[: kept[-1] + 1] if len(kept) else coefficients[:1]
