"""Hertz, JKR, DMT and Maugis-Dugdale theory, and formulas fitted to the last: classical.f90,
maugis.f90 and transition_fits.f90 in src/theory.

`theory` is "hertz", "jkr", "dmt" or "maugis"; radii at a load and pull-off also "carpick" and
"pietrement_troyon". `radius` is R [m], `stiffness` E/(1-nu^2) of two identical bodies [Pa],
`surface_energy` gamma [J/m^2], `strength` the cohesive tension of Maugis-Dugdale [Pa]; a theory
needs only those that it uses. NaN marks values without an equilibrium.
"""

import _snapin
import numpy as np
from numpy.typing import ArrayLike

from .arguments import Array, not_negative, one_of, positive, positive_vector, vector

_flat = _snapin.flat_theory

# The material constants each theory needs, besides radius and stiffness.
_NEEDS = {
    "hertz": (),
    "jkr": ("surface_energy",),
    "dmt": ("surface_energy",),
    "maugis": ("surface_energy", "strength"),
    "carpick": ("surface_energy", "strength"),
    "pietrement_troyon": ("surface_energy", "strength"),
}
_CONTROLS = ("load", "displacement", "edge_ratio")


def _material(theory, radius, stiffness, surface_energy, strength=0.0):
    """Return radius, stiffness, surface energy, strength; those not in use may be 0."""
    one_of("theory", theory, _NEEDS)
    needed = {"surface_energy": surface_energy, "strength": strength}
    checked = [
        (positive if name in _NEEDS[theory] else not_negative)(name, value)
        for name, value in needed.items()
    ]
    return positive("radius", radius), positive("stiffness", stiffness), *checked


def _values(theory, quantity, x, material, a=0.0):
    """Return a quantity of a theory at values `x`; `a` is a contact radius."""
    values, stat = _flat.classical_values(theory, quantity, x, a, *material)
    if stat:
        raise ValueError(f"theory: {theory!r} has no {quantity.replace('_', ' ')}")
    return values


def contact_radius(theory: str, control: str, values: ArrayLike, *, radius: float,
                   stiffness: float, surface_energy: float = 0.0,
                   strength: float = 0.0) -> Array:
    """Return the contact radii at given values of `control`.

    `control` is "load" [N] or "displacement" [m], on the branch that is stable at fixed control, or
    for Maugis-Dugdale "edge_ratio", the outer radius of the cohesive zone over the contact radius.
    """
    material = _material(theory, radius, stiffness, surface_energy, strength)
    one_of("control", control, _CONTROLS)
    values = vector("values", values)
    if control == "edge_ratio" and not (values > 1).all():
        raise ValueError("values: every edge_ratio must be above 1")
    return _values(theory, f"radius at {control}", values, material)


def contact_curve(theory: str, contact_radius: ArrayLike, *, radius: float, stiffness: float,
                  surface_energy: float = 0.0, strength: float = 0.0) -> tuple[Array, Array]:
    """Return load [N] and displacement [m] at contact radii [m], all above zero."""
    material = _material(theory, radius, stiffness, surface_energy, strength)
    a = positive_vector("contact_radius", contact_radius)
    return _values(theory, "load", a, material), _values(theory, "displacement", a, material)


def profile(theory: str, r: ArrayLike, contact_radius: float, *, radius: float, stiffness: float,
            surface_energy: float = 0.0) -> tuple[Array, Array]:
    """Return pressure [Pa] and gap [m] at distances `r` [m] from the axis (Hertz and JKR)."""
    material = _material(theory, radius, stiffness, surface_energy, strength=1.0)
    r = vector("r", r)
    if (r < 0).any():
        raise ValueError("r: must not be negative")
    a = positive("contact_radius", contact_radius)
    return _values(theory, "pressure", r, material, a), _values(theory, "gap", r, material, a)


def load_at_displacement(theory: str, displacement: ArrayLike, *, radius: float,
                         stiffness: float, surface_energy: float = 0.0) -> Array:
    """Return loads [N] at displacements [m], on the branch stable at fixed displacement."""
    material = _material(theory, radius, stiffness, surface_energy, strength=1.0)
    return _values(theory, "load at displacement", vector("displacement", displacement), material)


def pull_off(theory: str, *, radius: float, stiffness: float, surface_energy: float = 0.0,
             strength: float = 0.0, control: str = "load") -> float:
    """Return the load [N], negative, at which the bodies separate at a fixed `control`."""
    material = _material(theory, radius, stiffness, surface_energy, strength)
    one_of("control", control, _CONTROLS)
    return float(_values(theory, f"pull_off at {control}", np.zeros(1), material)[0])


def cohesive_zone(contact_radius: ArrayLike, *, radius: float, stiffness: float,
                  surface_energy: float, z0: float) -> tuple[float, float, Array]:
    """Return strength [Pa], lambda and edge ratios of Maugis-Dugdale for a Lennard-Jones law.

    `z0` [m] is the law's equilibrium separation; the strength is its largest tension.
    """
    return _flat.maugis_numbers(
        positive_vector("contact_radius", contact_radius), positive("radius", radius),
        positive("stiffness", stiffness), positive("surface_energy", surface_energy),
        positive("z0", z0))
