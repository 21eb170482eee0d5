"""Formulas and small operations on curves and profiles that several figures need."""

import numpy as np

RADIUS = 1.5e-2


def hertz_load(displacement, stiffness):
    """Return the load [N] of Hertz theory, (6), at central displacements >= 0 [m]."""
    return 2 / 3 * stiffness * np.sqrt(RADIUS) * np.maximum(displacement, 0) ** 1.5


def hertz_displacement(load, stiffness):
    """Return the central displacement [m] of Hertz theory, (6), at loads >= 0 [N]."""
    return (1.5 * np.maximum(load, 0) / (stiffness * np.sqrt(RADIUS))) ** (2 / 3)


def jkr(a, radius, stiffness, surface_energy):
    """Return displacement (11) [m] and load [N] of JKR theory at contact radii [m]."""
    displacement = a**2 / radius - np.sqrt(4 * np.pi * surface_energy * a / stiffness)
    load = (2 / 3 * stiffness * a**3 / radius
            - np.sqrt(4 * np.pi * surface_energy * stiffness * a**3))
    return displacement, load


def jkr_curve(radius, stiffness, surface_energy, largest_load):
    """Return contact radius, displacement and load of JKR theory, stable at a given displacement.

    It begins at the jump out of contact at fixed displacement, at -5/6 pi gamma R, (12).
    """
    # There d(displacement)/da = 0.
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


def drawn(curve, towards=None):
    """Return load [uN] and displacement [nm], with NaN at a jump, so that no line crosses it."""
    x, y = curve["load"] * 1e6, curve["displacement"] * 1e9
    return (x, y) if towards is None else np.insert([x, y], jump(curve, towards)[1], np.nan, axis=1)


def jump_ends(curve, towards):
    """Return the start and the end of a jump, in uN and nm."""
    x, y = drawn(curve)
    return [(x[i], y[i]) for i in jump(curve, towards)]


def bisected(found, low, high, accuracy=0.0):
    """Return the number at which `found(x)` turns from false to true, between two numbers, by
    default to rounding."""
    while high - low > accuracy:
        middle = (low + high) / 2
        if not low < middle < high:
            break
        low, high = (low, middle) if found(middle) else (middle, high)
    return (low + high) / 2


def cubic(at, x, y):
    """Return y at points between x by cubics through the four nearest."""
    values = []
    for point in np.atleast_1d(at):
        first = int(np.clip(np.searchsorted(x, point) - 2, 0, max(x.size - 4, 0)))
        near, scale = slice(first, first + 4), np.ptp(x[first : first + 4])
        fit = np.polynomial.polynomial.polyfit((x[near] - point) / scale, y[near],
                                               min(3, x[near].size - 1))
        values.append(fit[0])
    return np.array(values)


def at(x, columns, name, by="h0"):
    """Return a column of a branch at values of another column, by linear interpolation."""
    rows = columns[np.argsort(columns[by])]
    return np.interp(x, rows[by], rows[name])


def states(results, branch="loading"):
    """Return the profiles of a branch in order, each a table that begins at r = 0."""
    rows = results.branch(branch, "profiles")
    return np.split(rows, np.flatnonzero(rows["r"] == 0)[1:])


def curvature(state, within):
    """Return the curvature of the gap on the axis over that of undeformed bodies, 1/R."""
    near = state["r"] <= within
    fit = np.polynomial.polynomial.polyfit(state["r"][near] ** 2, state["separation"][near], 1)
    return 2 * RADIUS * fit[1]
