"""The solved contact law of two elastic spheres under a force of finite range, on arrays.

`ContactLaw` is the law of `contact_law/snapin_contact.h` with the same coefficients, which
contact_law.json has; tools/contact_law.py makes both out of a deck. docs/tables.md explains the
law. Here are SI units and arguments; `_contact_path` has the law without units.
"""

from collections.abc import Mapping
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike

from .arguments import Array, Flags, flags, positive, vector
from ._contact_path import ContactPath
from ._contact_tables import coefficients, tabor_of


class ContactLaw:
    """Load, contact radius, stiffness and energy of two spheres over h0, the gap that they would
    have without deformation, in SI units.

    `radius` is R, 1/R = 1/R1 + 1/R2; `reduced_modulus` is `E*`, where
    `1/E* = (1-nu1^2)/E1 + (1-nu2^2)/E2`; `z0` is the length of the force law, for the law 9-3 the
    gap of zero force. `table` has the coefficients of another force, as
    `tools/contact_law.py --deck` writes them.

    `load`, `contact_radius`, `stiffness` and `energy` take h0 and whether the bodies were in
    contact before, for all h0 or for each, and return arrays. Where the bodies cannot be in this
    state they have jumped to the other; `in_contact` tells. `history` follows a sequence of h0.
    """

    def __init__(self, radius: float, reduced_modulus: float, work_of_adhesion: float, z0: float,
                 *, table: Optional[Mapping[str, Any]] = None) -> None:
        radius, modulus = positive("radius", radius), positive("reduced_modulus", reduced_modulus)
        work, z0 = positive("work_of_adhesion", work_of_adhesion), positive("z0", z0)
        table = coefficients() if table is None else table
        self.radius, self.reduced_modulus = radius, modulus
        self.work_of_adhesion, self.z0 = work, z0
        log_mu = (np.log(radius) + 2*(np.log(work) - np.log(modulus)))/3 - np.log(z0)
        self.tabor = tabor_of(log_mu)
        low, high = table["lowest"], table["highest"] or np.inf
        if not low*(1 - 1e-12) <= self.tabor <= high*(1 + 1e-12) or np.isinf(self.tabor):
            raise ValueError("Tabor's parameter is beyond the range of the law")
        self._load_unit, self._radius_unit = np.pi*work*radius, np.sqrt(radius*z0)
        self._path = ContactPath(table, log_mu)

    # --- Numbers of the law

    @property
    def jumps(self) -> bool:
        """Whether there are jumps when h0 is prescribed."""
        return self._path.jumps

    @property
    def pull_off(self) -> float:
        """Pull-off force [N]: the largest tension, at which a dead load separates the bodies."""
        return -self._load_unit*self._path.load_at(self._path.tension)

    @property
    def pull_off_h0(self) -> float:
        """h0 [m] of the largest tension."""
        return self.z0*self._path.tension.gap

    @property
    def snap_in(self) -> float:
        """h0 [m] of snap-in; NaN without jumps."""
        return self.z0*self._path.snap_in.gap if self.jumps else np.nan

    @property
    def snap_off(self) -> float:
        """h0 [m] of snap-off; NaN without jumps."""
        return self.z0*self._path.snap_off.gap if self.jumps else np.nan

    @property
    def snap_in_load(self) -> float:
        """Load [N] just before snap-in."""
        return self._load_unit*self._path.load_at(self._path.snap_in) if self.jumps else np.nan

    @property
    def snap_off_load(self) -> float:
        """Load [N] just before snap-off: minus the pull-off force at given h0."""
        return self._load_unit*self._path.load_at(self._path.snap_off) if self.jumps else np.nan

    @property
    def energy_lost(self) -> float:
        """Energy [J] lost in both jumps; 0 without jumps."""
        if not self.jumps:
            return 0.0
        ends = np.array([self.snap_in, self.snap_off])
        outside, contact = self.energy(ends, False), self.energy(ends, True)
        return float(outside[0] - outside[1] - contact[0] + contact[1])

    # --- Functions of h0

    def in_contact(self, h0: ArrayLike, before: ArrayLike = False) -> Flags:
        """Return whether the bodies are in contact at h0 [m] if they were or were not before."""
        gap = vector("h0", h0)/self.z0
        return self._path.contact(gap, flags("before", before, gap.size))

    def history(self, h0: ArrayLike, before: ArrayLike = False) -> Flags:
        """Return whether the bodies are in contact at each of a sequence of h0 [m]."""
        gap = vector("h0", h0)/self.z0
        state, found = flags("before", before, 1), np.empty(gap.shape, bool)
        for index in range(gap.size):
            state = self._path.contact(gap[index:index + 1], state)
            found[index] = state[0]
        return found

    def load(self, h0: ArrayLike, in_contact: ArrayLike = False) -> Array:
        """Return the load [N]: positive under pressure."""
        return self._load_unit*self._path.load(*self._arguments(h0, in_contact))

    def contact_radius(self, h0: ArrayLike, in_contact: ArrayLike = False) -> Array:
        """Return the contact radius [m], 0 outside contact."""
        return self._radius_unit*self._path.radius(*self._arguments(h0, in_contact))

    def stiffness(self, h0: ArrayLike, in_contact: ArrayLike = False) -> Array:
        """Return -dF/dh0 [N/m], which goes to minus infinity at a jump."""
        return self._load_unit/self.z0*self._path.stiffness(*self._arguments(h0, in_contact))

    def energy(self, h0: ArrayLike, in_contact: ArrayLike = False) -> Array:
        """Return the energy [J] of bodies and surfaces, 0 far apart: dE/dh0 = -F."""
        return self._load_unit*self.z0*self._path.energy(*self._arguments(h0, in_contact))

    def _arguments(self, h0, in_contact):
        """Return h0 in z0, and whether the bodies were in contact, as arrays."""
        gap = vector("h0", h0)/self.z0
        return gap, flags("in_contact", in_contact, gap.size)
