"""Measure the data to which the mesh rule of src/mesh/mesh_rule.f90 was fitted.

For a strength of adhesion sigma and a band of contact radii, states are solved at given radii on
mapped meshes and compared with states on a much finer mesh. Errors are of load and h0, relative to
the pull-off or the load, and to h0 or the law's length, whichever is larger.

    PYTHONPATH=build/pywrap .venv/bin/python tools/bench/mesh_study.py [--sigma 8.7 ...]

The equations and Newton's method are written here; nodes and matrices are the library's.
"""

import argparse
import math
from typing import NamedTuple

import _snapin
import numpy as np

EDGE = 3 ** (1 / 6)
DECAY = 6.0
MORE_NODES = 3
WIDEST_BAND = 30.0

flat = _snapin.flat_numerics


class Mesh:
    """A contact mesh: sinh panels inside and outside the edge, then the tail."""

    def __init__(self, d, reach, density, tail, digits):
        """Choose integer numbers of nodes; d and reach, in contact radii, are adjusted."""
        inside = math.asinh(1 / d)
        inner = math.ceil(density * inside + MORE_NODES)
        inside = (inner - MORE_NODES) / density
        d = 1 / math.sinh(inside)
        outer = math.ceil(density * math.asinh(reach / d) + MORE_NODES)
        lengths = [inside, (outer - MORE_NODES) / density]
        self.shape = ("mapped", 1.0, lengths, [inner, outer, tail], (d, DECAY, digits))
        self.size = inner + outer + tail
        self.x, self.weight, _ = flat.mesh_nodes(*self.shape, self.size)
        matrix = flat.mesh_matrix(*self.shape, self.size)
        self.edge_row, self.matrix = matrix[1], matrix[2:]

    def interpolate(self, values, at):
        return flat.mesh_interpolation(*self.shape, values, at)


class State(NamedTuple):
    """A state at a contact radius, with its gaps minus the parabola."""

    mesh: Mesh
    radius: float
    h0: float
    load: float
    gap: np.ndarray
    raised: np.ndarray


def pressure(gap):
    return 8 / 3 * gap**-3 * (gap**-6 - 1)


def slope(gap):
    return 8 * gap**-4 * (1 - 3 * gap**-6)


def solve(mesh, sigma, radius, gap, h0, most=40):
    """Return the state at a contact radius, by Newton's method from a guess; None: not found."""
    coupling, parabola = 2 * sigma * radius, 0.5 * (radius * mesh.x) ** 2
    n = mesh.size
    jacobian = np.empty((n + 1, n + 1))
    for _ in range(most):
        p, by_gap = pressure(gap), coupling * slope(gap)
        defect = np.append(
            gap - h0 - parabola - coupling * (mesh.matrix @ p),
            EDGE - h0 - 0.5 * radius**2 - coupling * (mesh.edge_row @ p))
        jacobian[:n, :n] = np.eye(n) - mesh.matrix * by_gap
        jacobian[n, :n] = -mesh.edge_row * by_gap
        jacobian[:, n] = -1
        try:
            step = np.linalg.solve(jacobian, -defect)
        except np.linalg.LinAlgError:
            return None
        if not np.isfinite(step).all():
            return None
        part = min(1.0, 0.3 / max(1e-300, (-step[:n] / gap).max()))
        gap, h0 = gap + part * step[:n], h0 + part * step[n]
        if part == 1 and abs(step / (1 + np.append(gap, abs(h0)))).max() < 1e-11:
            load = 2 * math.pi * radius**2 * (mesh.weight @ pressure(gap))
            return State(mesh, radius, h0, load, gap, gap - h0 - parabola)
    return None


def guess(state, mesh, radius):
    """Return the gaps of a state on another mesh, at another radius."""
    r = radius * mesh.x
    return state.h0 + 0.5 * r**2 + state.mesh.interpolate(state.raised, r / state.radius)


def jkr_gaps(mesh, sigma, radius):
    """Return gaps and h0 of JKR theory, with the gap of rest inside the contact."""
    x = np.maximum(mesh.x, 1)
    hertz = radius**2 / math.pi * (np.sqrt(x**2 - 1) + (x**2 - 2) * np.arccos(1 / x))
    drop = math.sqrt(4 * math.pi * radius * sigma)
    return 1 + hertz + drop * 2 / math.pi * np.arccos(1 / x), 1 - radius**2 + drop


# --- The rule, as in src/mesh/mesh_rule.f90 and contact_scales.f90


def feature(sigma, radius):
    return min(0.375 / sigma, 0.5, (0.01 / max(radius, 1)) ** (1 / 3))


def widest_radius(sigma, h0):
    radius = 1.0
    for _ in range(200):
        radius = math.sqrt(max(1 - h0, 0) + math.sqrt(4 * math.pi * sigma * radius))
    return max(1.0, 1.2 * radius)


def first_radius(sigma):
    return min(0.25 * 0.375 / sigma, 0.25 * math.sqrt(EDGE - 1))


def tail_begins(sigma):
    return max(5.0, 1.3 * math.sqrt(max(5.0, 2 * (27 * sigma) ** (2 / 7))))


def density(sigma, high, digits):
    """Return nodes per unit of z for a band up to the radius `high`."""
    return (
        (0.15 + digits * (0.24 + 0.0105 * digits))
        * (1 + 0.25 * math.log(1 + high / (math.pi * sigma)))
        * (1 + 0.03 * math.log(1 + sigma / (1 + high) ** 2))
    )


def rule_mesh(sigma, low, high, digits):
    return Mesh(
        min(0.5 * feature(sigma, high) / high, 1.0), max(3.0, tail_begins(sigma) / low),
        density(sigma, high, digits), math.ceil(1 + 0.6 * digits), max(5.0, 0.5 + 0.85 * digits))


# --- The study


def reference(sigma, h0_end):
    """Return states from the widest radius down to the first, on meshes much finer than
    necessary."""
    radius, least = widest_radius(sigma, h0_end), first_radius(sigma)
    band, mesh, states, step = math.inf, None, [], 0.05
    while radius > least:
        if mesh is None or radius < band / 3:
            band = radius
            mesh = Mesh(0.2 * feature(sigma, band) / band,
                        max(6.0, 2.5 * tail_begins(sigma) / (band / 3)),
                        2.2 * density(sigma, band, 8), 16, 14.0)
            if states:
                last = states[-1]
                found = solve(mesh, sigma, last.radius, guess(last, mesh, last.radius), last.h0)
            else:
                found = solve(mesh, sigma, radius, *jkr_gaps(mesh, sigma, radius), 200)
            if found is None:
                raise ArithmeticError(f"sigma {sigma}: no state at {radius}")
            states[-1:] = [found]
        last = states[-1]
        next_radius = max(last.radius * math.exp(-step), least)
        gap, h0 = last.gap, last.h0
        if len(states) > 1 and states[-2].mesh is mesh:
            before = states[-2]
            share = math.log(next_radius / last.radius) / math.log(last.radius / before.radius)
            gap, h0 = gap + share * (gap - before.gap), h0 + share * (h0 - before.h0)
        found = solve(mesh, sigma, next_radius, gap, h0, 15) if gap.min() > 0 else None
        if found is None:
            step /= 2
            if step < 1e-4:
                raise ArithmeticError(f"sigma {sigma}: lost at {last.radius}")
            continue
        states.append(found)
        radius, step = next_radius, min(1.2 * step, 0.1)
    return states


def error(mesh, sigma, states, pull_off):
    """Return the largest error of the states on a mesh; infinite if one is not found."""
    worst = 0.0
    for state in states:
        found = solve(mesh, sigma, state.radius, guess(state, mesh, state.radius), state.h0)
        if found is None:
            return math.inf
        worst = max(worst, abs(found.load - state.load) / max(pull_off, abs(state.load)),
                    abs(found.h0 - state.h0) / max(1.0, abs(state.h0)))
    return worst


def bands(sigma, h0_end):
    """Return the bands of contact radii of new_mesh_family, widest first."""
    least, most = first_radius(sigma), widest_radius(sigma, h0_end)
    count = math.ceil(math.log(most / least) / math.log(WIDEST_BAND))
    ends = [most * (least / most) ** (k / count) for k in range(count + 1)]
    return list(zip(ends[1:], ends))


def main():
    """Print a row for every band: nodes and error for each number of digits of the rule."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sigma", type=float, nargs="+",
                        default=[1e-4, 0.0087, 0.1, 0.87, 8.7, 100, 1e3, 1e4])
    parser.add_argument("--digits", type=float, nargs="+", default=[4, 5, 6, 7, 8, 10, 12])
    parser.add_argument("--h0-end", type=float, default=-5.0, help="in units of z0")
    asked = parser.parse_args()
    for sigma in asked.sigma:
        states = reference(sigma, asked.h0_end)
        pull_off = -min(state.load for state in states)
        for low, high in bands(sigma, asked.h0_end):
            within = [s for s in states if 0.999 * low <= s.radius <= 1.001 * high]
            within = within[:: max(1, len(within) // 8)] + within[-1:]
            cells = []
            for digits in asked.digits:
                mesh = rule_mesh(sigma, low, high, digits)
                cells.append(f"{digits:g}: {mesh.size} {error(mesh, sigma, within, pull_off):.0e}")
            print(f"sigma {sigma:<8g} c {low:.3g} to {high:.3g}   " + "   ".join(cells), flush=True)


if __name__ == "__main__":
    main()
