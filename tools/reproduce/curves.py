"""Formulas and small operations on curves that several figures need."""

import numpy as np


def hertz_load(displacement, radius, stiffness):
    """Return the load [N] of Hertz theory, (6), at central displacements >= 0 [m]."""
    return 2 / 3 * stiffness * np.sqrt(radius) * np.maximum(displacement, 0) ** 1.5


def hertz_displacement(load, radius, stiffness):
    """Return the central displacement [m] of Hertz theory, (6), at loads >= 0 [N]."""
    return (1.5 * np.maximum(load, 0) / (stiffness * np.sqrt(radius))) ** (2 / 3)


def jkr(contact_radius, radius, stiffness, surface_energy):
    """Return displacement (11) [m] and load [N] of JKR theory at contact radii [m]."""
    a = np.asarray(contact_radius, float)
    displacement = a**2 / radius - np.sqrt(4 * np.pi * surface_energy * a / stiffness)
    load = (2 / 3 * stiffness * a**3 / radius
            - np.sqrt(4 * np.pi * surface_energy * stiffness * a**3))
    return displacement, load


def jkr_curve(radius, stiffness, surface_energy, largest_load):
    """Return contact radius, displacement and load of JKR theory, stable at a given displacement.

    It begins where the bodies part when the displacement is held, at -5/6 pi gamma R, (12).
    """
    # d(displacement)/da = 0 there.
    least = (radius**2 * np.pi * surface_energy / (4 * stiffness)) ** (1 / 3)
    highest = least
    while jkr(highest, radius, stiffness, surface_energy)[1] < largest_load:
        highest *= 1.3
    a = np.linspace(least, highest, 800)
    displacement, load = jkr(a, radius, stiffness, surface_energy)
    shown = load <= largest_load
    return a[shown], displacement[shown], load[shown]


def jump(curve, towards):
    """Return the indices of the last state before and the first after a branch's jump.

    `towards` is "contact" or "apart": the step in which the gap on the axis falls or rises most.
    """
    step = np.diff(curve["h_centre"])
    before = int(np.argmin(step) if towards == "contact" else np.argmax(step))
    return before, before + 1


def broken(curve, columns, cut):
    """Return columns of a branch with NaN after row `cut`, so that no line crosses a jump."""
    return [np.insert(curve[column], cut + 1, np.nan) for column in columns]


def at_load(load, values, wanted):
    """Return values where a rising load passes `wanted`."""
    return np.interp(wanted, load, values)
