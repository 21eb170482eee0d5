"""DLVO forces from their equations, without the program: Gregory's retarded attraction, a Born
repulsion, and the Poisson-Boltzmann equation by collocation. SI units.
"""

import math

import numpy as np
from numpy.polynomial import chebyshev
from support import boundary_value
from support.calculus import gauss

BOLTZMANN, CHARGE, AVOGADRO, VACUUM = 1.380649e-23, 1.602176634e-19, 6.02214076e23, 8.8541878128e-12
# Gap in Debye lengths beyond which double layers decay as exp(-x) to all significant digits.
FAR = 24.0


class Dlvo:
    """Pressure, slope and energy at gaps [m]; the keys are those of a deck."""

    def __init__(self, *, hamaker, retardation_length, z0, potential, regulation, salt,
                 permittivity=78.4, temperature=298.15):
        self.hamaker, self.c, self.z0 = hamaker, 5.32 / retardation_length, z0
        thermal = BOLTZMANN * temperature / CHARGE
        ions = 2 * AVOGADRO * salt * CHARGE**2
        self.debye = math.sqrt(permittivity * VACUUM * BOLTZMANN * temperature / ions)
        self.osmotic = permittivity * VACUUM * (thermal / self.debye) ** 2
        # ln(p exp(x)) is smooth; its series in x = gap/debye: short pieces where layers overlap.
        y = [potential / thermal] * 2
        nodes = chebyshev.chebpts1(48)
        at = FAR * ((nodes + 1) / 2) ** 2
        both = [regulation] * 2
        values = [math.log(boundary_value.pressure(y, both, x, 32, 6)[0]) + x for x in at]
        self.series = chebyshev.chebfit(nodes, values, 47)
        self.derivative = chebyshev.chebder(self.series)

    def double_layer(self, gap):
        x = gap / self.debye
        u = 2 * np.sqrt(np.minimum(x, FAR) / FAR) - 1
        pressure = self.osmotic * np.exp(chebyshev.chebval(u, self.series) - x)
        bend = np.where(x < FAR, chebyshev.chebval(u, self.derivative) * 2 / (FAR * (u + 1)), 0)
        return pressure, pressure * (bend - 1) / self.debye

    def __call__(self, gap):
        gap = np.asarray(gap, float)
        a, c = self.hamaker / (6 * math.pi), self.c
        retarded = (1 + 1.5 * c * gap) / (1 + c * gap) ** 2
        change = (1.5 * c * (1 + c * gap) - 2 * c * (1 + 1.5 * c * gap)) / (1 + c * gap) ** 3
        born = a * self.z0**6 / gap**9
        layers, fall = self.double_layer(gap)
        pressure = -a / gap**3 * retarded + born + layers
        slope = a * (3 * retarded / gap**4 - change / gap**3) - 9 * born / gap + fall
        energy = -a / (2 * gap**2 * (1 + c * gap)) + born * gap / 8 + self.energy_of_layers(gap)
        return pressure, slope, energy

    def energy_of_layers(self, gap):
        """The integral of the pressure of the double layers from each gap to infinity."""
        flat = np.atleast_1d(gap).ravel()
        # Over z = 1 - exp(-(t - gap)/debye), in which the integrand is nearly constant.
        z, w = gauss(60)
        t = flat[:, None] - self.debye * np.log1p(-z)
        pressure = self.double_layer(t)[0]
        return (self.debye * (pressure / (1 - z)) @ w).reshape(np.shape(gap))
