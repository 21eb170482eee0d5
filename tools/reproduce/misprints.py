"""The paper's misprints, each with a computation that decides."""

import curves
import numpy as np

DECKS = ("fig01_lennard_jones", "fig06_converged")


def elliptic(m):
    """Return K of parameter m by the arithmetic-geometric mean."""
    a, b = np.ones_like(m), np.sqrt(1 - m)
    for _ in range(6):
        a, b = (a + b) / 2, np.sqrt(a * b)
    return np.pi / (2 * a)


def numbers(runs):
    nodes, weights = np.polynomial.legendre.leggauss(60)
    nodes, weights = (nodes + 1) / 2, weights / 2
    # Displacement 2 (1-nu^2)/E * Int p k t dt on the axis over a^2/R, for p of (3) and t = a sin x.
    x = np.pi / 2 * nodes
    pressure, kernel = np.cos(x) / np.pi, 4 / np.pi * elliptic(0.0)
    axis = 2 * np.sum(np.pi / 2 * weights * pressure * kernel * np.cos(x))
    angular = np.sum(2 * np.pi * weights / np.sqrt(1 + 0.25 - np.cos(2 * np.pi * nodes)))
    # d/da of the elastic energy E*(delta^2 a - 2 delta a^3/(3 R) + a^5/(5 R^2)) at fixed delta must
    # be c*2*pi*a*gamma, with E* = stiffness/2.
    a, stiffness, gamma = 5e-6, 1e10, 8e-4
    delta, _ = curves.jkr(a, curves.RADIUS, stiffness, gamma)
    slope = stiffness / 2 * (delta - a**2 / curves.RADIUS) ** 2
    return {
        "right": axis, "without": np.pi * axis, "printed": np.pi**2 * axis, "angular": angular,
        "parameter": 4 * elliptic(0.25), "modulus": 4 * elliptic(0.25**2),
        "coefficient": slope / (2 * np.pi * a * gamma),
        "pull_off": runs["fig01_lennard_jones"].summary["jkr_pull_off"] * 1e6,
        "gamma": runs["fig06_converged"].summary["surface_energy"] * 1e3,
        "energy": runs["fig06_converged"].profiles["energy"].min() * 1e3}
