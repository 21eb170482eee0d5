"""Claims about any force law, given as a function of separations that returns `LawValues`: the
slope is the derivative of the pressure, the energy its integral."""

import numpy as np


def claim_slope(of, gap, unit, size=None):
    """By central differences at separations `gap` [m]; unit: the law's numbers.

    size: the parts of the slope, which set the rounding where the slope passes through zero; by
    default the slope itself.
    """
    # Extrapolated twice: the error is that of the sixth order in a step of 1 % of the gap or
    # length, 1e-12 times the ninth power's coefficients.
    step = 1e-2 * np.minimum(gap - unit.origin, unit.length)
    d = [
        (of(gap + h).pressure - of(gap - h).pressure) / (2 * h)
        for h in (step, step / 2, step / 4)
    ]
    d = [(4 * d[1] - d[0]) / 3, (4 * d[2] - d[1]) / 3]
    derivative = (16 * d[1] - d[0]) / 15
    slope = of(gap).slope
    size = abs(slope) if size is None else size
    assert (abs(slope - derivative) <= 1e-8 * size).all()


def claim_energy(of, gap, unit, size=None):
    """By quadrature between neighbouring separations; the energy vanishes at large separations.

    size: the parts of the energy, which set its rounding; by default the integrand.
    """
    x, w = np.polynomial.legendre.leggauss(30)
    low, high = gap[:-1], gap[1:]
    at = low[:, None] + (high - low)[:, None] * (x + 1) / 2
    pressure = of(at.ravel()).pressure.reshape(at.shape)
    integral = pressure @ (w / 2) * (high - low)
    energy = of(gap).energy
    if size is None:
        size = abs(pressure) @ (w / 2) * (high - low) + np.abs(energy[:-1])
    assert (abs(energy[:-1] - energy[1:] - integral) <= 1e-13 * size).all()
    far = of([unit.origin + 1e8 * unit.length]).energy
    assert abs(far[0]) <= 1e-15 * abs(energy).max()
