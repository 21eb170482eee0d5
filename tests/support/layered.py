"""Waves of pressure on layered bodies, solved directly with enough digits to avoid any loss of
accuracy: each layer has four waves, and all conditions together are one linear system."""

import mpmath
from mpmath import mpf

DIGITS = 60


def surface_yield(k, thickness, shear, poisson, base=None):
    """L(k) of layers from the top down on a base, (shear modulus, Poisson's ratio), or rigid."""
    with mpmath.workdps(DIGITS):
        k = mpf(k)
        layers = [tuple(map(mpf, layer)) for layer in zip(thickness, shear, poisson)]
        columns = 4 * len(layers) + (2 if base else 0)
        rows, right = [], []
        # No shear and unit pressure on the surface.
        top = waves(layers[0][1], layers[0][2], k, 0, layers[0][0])
        for component, value in ((2, 0), (3, -1)):
            rows.append([wave[component] for wave in top] + [0] * (columns - 4))
            right.append(value)
        for i, (t, g, n) in enumerate(layers):
            above = waves(g, n, k, t, t)
            before = [0] * (4 * i)
            if i + 1 < len(layers):
                below = waves(layers[i + 1][1], layers[i + 1][2], k, 0, layers[i + 1][0])
            elif base:
                below = waves(*map(mpf, base), k, 0, 0)[:2]
            else:
                below = []
            for component in range(4 if below else 2):
                row = before + [wave[component] for wave in above]
                row += [-wave[component] for wave in below]
                rows.append(row + [0] * (columns - len(row)))
                right.append(0)
        amplitude = mpmath.lu_solve(mpmath.matrix(rows), mpmath.matrix(right))
        deflection = sum(a * wave[1] for a, wave in zip(amplitude, top))
        # A half-space of the top layer: (1 - nu)/(G k).
        return float(deflection * layers[0][1] * k / (1 - layers[0][2]))


def waves(g, n, k, z, thickness):
    """(u, w, tau, sigma) at depth z of the four waves of a layer: two that decay downwards, and two
    that decay upwards from its lower side. Papkovich and Neuber: u = -(phi + z psi)',
    w = 4 (1 - nu) psi - (phi + z psi)'."""
    found = []
    for sign, size in ((-1, mpmath.exp(-k * z)), (1, mpmath.exp(k * (z - thickness)))):
        # Displacements u sin(k x), w cos(k x) from phi, psi ~ exp(sign k z) cos(k x).
        rate = sign * k
        for phi, psi in ((1, 0), (0, 1)):
            value = phi + z * psi
            u = k * value
            w = 4 * (1 - n) * psi - rate * value - psi
            u_z = k * (rate * value + psi)
            w_z = rate * (4 * (1 - n) * psi - psi) - rate * (rate * value + psi)
            tau = g * (u_z - k * w)
            # The dilatation is 2 (1 - 2 nu) psi', so that lambda times it is finite at 1/2.
            sigma = 2 * g * w_z + 4 * g * n * rate * psi
            found.append([size * part for part in (u, w, tau, sigma)])
    return found
