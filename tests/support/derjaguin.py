"""Loads between rigid bodies, by an independent quadrature over the logarithm of r, in pieces."""

import math

import numpy as np
import snapin
from support.calculus import integrals

# Part of the equator's radius up to which the program has spheroids; beyond, the body is straight.
REACHING = 0.98


class Body:
    """A deck's &shape with its gap f(r) and the inverse [m], and the r where f has a break."""

    def __init__(self, kind, height, position, *, breaks=(), radius=None, **keys):
        self.groups = {
            "bodies": {"rigid": True, **({"radius": radius} if radius else {})},
            "shape": {"kind": kind, **keys}}
        self.height, self.position, self.breaks = height, position, breaks


def parabola(radius):
    return Body("parabola", lambda r: r**2 / (2 * radius), lambda f: np.sqrt(2 * radius * f),
                radius=radius)


def power(n, b):
    return Body("power", lambda r: b * r**n, lambda f: (f / b) ** (1 / n), exponent=n,
                coefficient=b)


def cone(half_angle):
    t = math.tan(half_angle)
    return Body("cone", lambda r: r / t, lambda f: f * t, half_angle=half_angle)


def rounded_punch(radius, flat):
    return Body(
        "rounded_punch", lambda r: np.maximum(r - flat, 0) ** 2 / (2 * radius),
        lambda f: flat + np.sqrt(2 * radius * f), breaks=(flat,), radius=radius, flat_radius=flat)


def spheroid(radius, b, kind="spheroid"):
    a = math.sqrt(radius * b)
    depth = b - b * math.sqrt(1 - REACHING**2)
    steepness = b / a * REACHING / math.sqrt(1 - REACHING**2)

    def height(r):
        s = np.minimum(r / a, REACHING)
        return b * s**2 / (1 + np.sqrt(1 - s**2)) + np.maximum(r - REACHING * a, 0) * steepness

    def position(f):
        inside = np.minimum(f, depth) / b
        return a * np.sqrt(inside * (2 - inside)) + np.maximum(f - depth, 0) / steepness

    keys = {"semi_axis": b} if kind == "spheroid" else {}
    return Body(kind, height, position, breaks=(REACHING * a,), radius=radius, **keys)


def profile(path, r, radius):
    """Points of a parabola, through which the program's spline is the parabola."""
    np.savetxt(path, np.column_stack([r, r**2 / (2 * radius)]), fmt="%.17e")
    return Body("profile", lambda x: x**2 / (2 * radius), lambda f: np.sqrt(2 * radius * f),
                file=str(path))


def breaks_of(groups):
    """Return gaps [m] where the pressure is not smooth, each with its width or 0."""
    found = []
    if "steric" in groups:
        keys = groups["steric"]
        found.append((keys.get("sides", 2) * keys["brush_thickness"], 0))
    for law, key in {"depletion": "diameter", "dugdale": "range"}.items():
        if law in groups:
            at = groups[law][key]
            found.append((at, groups[law].get("smoothing", 0.02 * at)))
    if "capillary" in groups:
        # The keys' defaults, at a contact angle of 0.
        keys = groups["capillary"]
        kelvin = 1.807e-5 * 0.0728 / (8.31446261815324 * 293.15 * -math.log(keys["humidity"]))
        found.append((2 * kelvin, keys.get("smoothing", 0.04 * kelvin)))
    if "tabulated" in groups:
        found += [(gap, 0) for gap in np.loadtxt(groups["tabulated"]["file"])[:, 0]]
    return found


def load(law, body, h0):
    """Return 2 pi Int p(h0 + f) r dr [N] at one h0 [m], and the same of |p|."""
    ends = list(math.log(body.position(1e-10)) + np.arange(-30, 60.1, 0.25))
    for gap, width in breaks_of(law):
        at = gap + width * np.linspace(-8, 8, 17) if width else np.array([gap])
        ends += list(np.log(body.position(at[at > h0] - h0)))
    ends = np.unique(ends + [math.log(r) for r in body.breaks])

    def of_ring(log_r):
        r = np.exp(log_r)
        return 2 * math.pi * snapin.force_law(law, h0 + body.height(r)).pressure * r**2

    (rough, _), (total, size) = (map(sum, integrals(of_ring, ends, order)) for order in (24, 32))
    assert abs(total - rough) <= 2e-12 * size
    return total, size
