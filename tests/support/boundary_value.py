"""Pressure between charged surfaces by collocation of the Poisson-Boltzmann equation.

This solution is independent of the program. The unknown is the profile of the potential at
Chebyshev points of the gap, which is divided into pieces that are narrow at the surfaces.
"""

import numpy as np


def _differentiation(n):
    """Return the n + 1 Chebyshev points of [-1, 1] and the matrix of the derivative there."""
    x = -np.cos(np.pi * np.arange(n + 1) / n)
    c = np.r_[2, np.ones(n - 1), 2] * (-1) ** np.arange(n + 1)
    d = np.outer(c, 1 / c) / (x[:, None] - x[None, :] + np.eye(n + 1))
    return x, d - np.diag(d.sum(axis=1))


def pressure(potential, regulation, gap, order=24, pieces=4):
    """Return P = cosh y - 1 - y'^2/2, in 2 n kT, and its spread over the gap.

    potential: y of each surface alone; regulation: p of each; gap in Debye lengths.
    """
    y_alone, p = np.array(potential, float), np.array(regulation, float)
    s_alone, capacity = 2 * np.sinh(y_alone / 2), np.cosh(y_alone / 2)
    # The thickness of layers is exp(-|y|/2): the pieces shrink geometrically towards the surfaces.
    thin = min(0.5, 4 * np.exp(-abs(y_alone).max() / 2) / gap)
    half = np.r_[0, np.geomspace(thin, 0.5, pieces)] if thin < 0.5 else np.array([0, 0.5])
    ends = gap * np.unique(np.r_[half, 1 - half])
    x, d = _differentiation(order)
    m, n = ends.size - 1, order + 1
    y = np.concatenate(
        [
            sum(
                4 * np.arctanh(np.tanh(alone / 4) * np.exp(-distance))
                for alone, distance in ((y_alone[0], at), (y_alone[1], gap - at))
            )
            for at in (a + (b - a) * (x + 1) / 2 for a, b in zip(ends, ends[1:]))
        ]
    )
    first = np.zeros((m * n, m * n))
    for k in range(m):
        own = slice(k * n, (k + 1) * n)
        first[own, own] = d * 2 / (ends[k + 1] - ends[k])
    second = first @ first
    inner = np.ones(m * n, bool)
    inner[::n] = inner[n - 1 :: n] = False

    def equations(y):
        r = second @ y - np.sinh(y)
        j = second - np.diag(np.cosh(y))
        j[~inner] = 0
        for k in range(m - 1):
            left, right = (k + 1) * n - 1, (k + 1) * n
            r[left], j[left, left], j[left, right] = y[left] - y[right], 1, -1
            r[right] = (first[left] - first[right]) @ y
            j[right] = first[left] - first[right]
        for row, side, sign in ((0, 0, -1), (-1, 1, 1)):
            stiff = (1 - p[side]) * capacity[side]
            r[row] = p[side] * (sign * first[row] @ y - s_alone[side])
            r[row] += stiff * (y[row] - y_alone[side])
            j[row] = p[side] * sign * first[row]
            j[row, row] += stiff
        return r, j

    for _ in range(100):
        r, j = equations(y)
        step = np.linalg.solve(j, -r)
        y = y + step / max(1, abs(step).max())
        if abs(step).max() <= 1e-12 * abs(y).max():
            break
    found = 2 * np.sinh(y / 2) ** 2 - (first @ y) ** 2 / 2
    # Where the potential is smallest the pressure is not a difference of large numbers.
    calm = np.argsort(abs(y))[:8]
    return np.median(found[calm]), np.ptp(found[calm])
