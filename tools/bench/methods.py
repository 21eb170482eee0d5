#!/usr/bin/env python3
"""The ladder of methods: what each iteration needs for a step of h0, and where it stops working.

    tools/bench/methods.py          ten minutes; docs/bench/methods.*, the table of docs/records/ladder.md
    tools/bench/methods.py --draw   picture and table again, from the present measurements

Each state is solved from the state a tenth of a length before, at constant separation, as a step of
the paper begins; so all methods have the same start and the same residual to reach, 1e-8. The
states themselves come from the program's path, and Newton's method on the mesh in question. The
matrix is that of one mesh, uniform or with panels about the contact edge. The spectrum of 1 - W p'
is that of the dense matrix at the solution. Beside the states stand whole cycles, with their times.
"""

import argparse
import pathlib
import sys
import warnings

import numpy as np

TOP = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(TOP / "tools" / "bench"), str(TOP / "tools"), str(TOP / "build" / "pywrap"),
                str(TOP / "pywrap")]

import methods_page  # noqa: E402 (found through the lines above)
import pages  # noqa: E402
import snapin  # noqa: E402
import tables  # noqa: E402
from snapin.command import as_command  # noqa: E402

# Scenes in units of the law's length are beyond small strains, which does not matter here.
warnings.simplefilter("ignore", snapin.SnapinWarning)

TABLE, CYCLES, PICTURE = (TOP / "docs" / "bench" / name for name in (
    "methods.csv", "methods_cycles.csv", "methods.png"))
GUIDE = TOP / "docs" / "records" / "ladder.md"

SIGMAS = (0.0087, 0.087, 0.3, 0.87, 8.7, 100.0, 1000.0)
LAMBDAS = (1.0, 1e2, 1e4)
CONTACTS = (1.0, 0.0, -1.0, -2.0)
STEP, TOLERANCE = 0.1, 1e-8
NODES = 600
# Largest numbers of iterations.
MOST = {"mixing": 20000, "anderson_mixing": 4000, "anderson": 200, "newton": 60}
METHODS = (
    ("mixing", {}),
    *(("anderson_mixing", {"depth": depth, "mixing_limit": 0.2}) for depth in (1, 2, 5, 10, 20)),
    *(("anderson_mixing", {"depth": 10, "mixing_limit": ratio}) for ratio in (0.05, 0.02)),
    *(("anderson", {"depth": depth}) for depth in (0, 1, 5, 20)),
    ("newton", {}))
FIELDS = ("law", "strength", "mesh", "nodes", "resolution", "method", "depth", "ratio", "states",
          "converged", "products", "factorisations", "rejected", "least", "largest")

# Cycles: name, settings, and the largest sigma at which it ends within a minute.
CYCLE_METHODS = (
    ("mixing", {"method": "mixing", "grid": "uniform", "nodes": 300}, 0.87),
    ("anderson_mixing, depth 5",
     {"method": "anderson_mixing", "grid": "uniform", "nodes": 300, "anderson_depth": 5}, 0.87),
    ("anderson_mixing, 10", {"method": "anderson_mixing", "grid": "uniform", "nodes": 300}, 0.87),
    ("anderson_mixing, 20",
     {"method": "anderson_mixing", "grid": "uniform", "nodes": 300, "anderson_depth": 20}, 0.87),
    ("anderson", {"method": "anderson", "grid": "uniform", "nodes": 300}, 0.87),
    ("newton", {"method": "newton", "grid": "uniform", "nodes": 300}, 0.87),
    ("newton, edge-locked", {"method": "newton"}, 1000.0),
    ("default", {}, 1000.0))
CYCLE_FIELDS = ("method", "strength", "states", "converged", "milliseconds", "products",
                "factorisations", "rejected")


class LennardJones:
    name, symbol = "lennard_jones", "sigma"
    force = snapin.lennard_jones(hamaker=1.0, z0=1.0)

    @staticmethod
    def slope(gap):
        return 8 / 3 * (3 * gap**-4.0 - 9 * gap**-10.0)

    @staticmethod
    def deck(strength):
        return {"law": "lennard_jones", "hamaker": 16 * np.pi * strength, "z0": 1.0}

    @staticmethod
    def radius(strength, h0):
        """The contact radius of JKR theory."""
        a = 1.0
        for _ in range(200):
            a = np.sqrt(max(1 - h0, 0) + np.sqrt(4 * np.pi * strength * a))
        return a

    @staticmethod
    def feature(strength, a):
        """The width of the cohesive zone, or what the repulsion resolves."""
        return min(0.375 / strength, 0.5, (0.01 / a) ** (1 / 3))


class Exponential:
    name, symbol = "exponential", "Lambda"
    force = snapin.exponential(p0=1.0, decay_length=1.0)

    @staticmethod
    def slope(gap):
        return -np.exp(-gap)

    @staticmethod
    def deck(strength):
        return {"law": "exponential", "p0": strength, "decay_length": 1.0}

    @staticmethod
    def radius(strength, h0):
        return np.sqrt(1 + max(np.log(2 * strength) - h0, 0))

    @staticmethod
    def feature(strength, a):
        return min(0.5, (1 / a) ** (1 / 3))


def profiles(law, strength, h0s):
    """Return positions and gaps at each h0, from the program's own method."""
    deck = {"bodies": {"radius": 1.0, "stiffness": 1.0}, "force": law.deck(strength),
            "profiles": {"h0": list(h0s)}, "numerics": {"accuracy": 1e-6}}
    deck["equilibrium_path"] = {"h0_end": min(h0s) - 0.5}
    if law.name == "lennard_jones":
        deck["loading"] = {"h0_start": max(h0s), "h0_end": min(h0s), "h0_step": 10.0}
    rows = snapin.run(deck).profiles
    found = {}
    for h0 in h0s:
        mine = rows[np.isclose(rows["h0"], h0, atol=1e-9)]
        if law.name == "lennard_jones":
            mine = mine[mine["branch"] == "loading"]
        found[h0] = mine["r"], mine["separation"]
    return found


def meshes(law, strength, h0):
    """Yield name and mesh: uniform, and panels that are graded about the contact edge."""
    a = law.radius(strength, h0)
    reach = 1.3 * a + 4
    yield "uniform", snapin.uniform_mesh(NODES, reach)
    least = law.feature(strength, a)
    inner = least * 1.6 ** np.arange(60)
    inner = np.cumsum(inner[np.cumsum(inner) < a - least])
    outer = least * 1.6 ** np.arange(60)
    outer = np.cumsum(outer)
    outer = outer[: np.searchsorted(outer, 3 * reach) + 1]
    yield "edge", snapin.panel_mesh([-a, *(-inner[::-1]), 0.0, *outer], 8, centre=a)


def measure(say):
    rows = []
    for law, strengths in ((LennardJones, SIGMAS), (Exponential, LAMBDAS)):
        for strength in strengths:
            wanted = [h0 for h0 in CONTACTS] if law is LennardJones else [1.0, 0.0]
            known = profiles(law, strength, sorted({*wanted, *(h + STEP for h in wanted)})[::-1])
            for mesh_name in ("uniform", "edge"):
                states = list(_states(law, strength, wanted, known, mesh_name))
                for method, options in METHODS:
                    rows.append(_row(law, strength, mesh_name, states, method, options))
                    say(f"{law.symbol} {strength:g}, {mesh_name}: {method} {options}: "
                        f"{rows[-1]['converged']}/{rows[-1]['states']}, "
                        f"{rows[-1]['products']:.0f} products")
    return rows


def _states(law, strength, wanted, known, mesh_name):
    """Yield each step: h0, mesh, start, spectrum. Where the mesh has no such state, the start is
    the gap of the path, and the spectrum is that there."""
    for h0 in wanted:
        mesh = dict(meshes(law, strength, h0))[mesh_name]
        gaps = []
        for at in (h0 + STEP, h0):
            r, gap = known[at]
            first = gap - at - r**2 / 2
            # Beyond the profile the rise of the gap decreases as 1/r.
            rise = np.interp(mesh.x, r, first)
            rise = np.where(mesh.x > r[-1], first[-1] * r[-1] / np.maximum(mesh.x, r[-1]), rise)
            state = snapin.equilibrium(
                law.force, mesh, at, strength, method="newton", most_iterations=100,
                start=at + mesh.x**2 / 2 + rise)
            gaps.append(state.gap if state.converged else at + mesh.x**2 / 2 + rise)
        slope = law.slope(gaps[1])
        matrix = 2 * strength * mesh.matrix().nodes
        effect = abs(slope) * abs(matrix).sum(axis=0)
        kept = effect > 1e-8 * effect.max()
        values = np.linalg.eigvals(matrix[np.ix_(kept, kept)] * slope[kept]).real
        yield h0, mesh, gaps[0], (1 - values.max(), 1 - values.min())


def _row(law, strength, mesh_name, states, method, options):
    products, factorisations, rejected = [], [], 0
    for h0, mesh, start, _ in states:
        state = snapin.equilibrium(
            law.force, mesh, h0, strength, method=method, start=start, tolerance=TOLERANCE,
            most_iterations=MOST[method], **options)
        rejected += state.rejected_steps
        if state.converged:
            products.append(state.operator_products)
            factorisations.append(state.factorisations)
    sizes = [mesh.x.size for _, mesh, *_ in states]
    spectra = np.array([spectrum for *_, spectrum in states])
    spacing = max(mesh.x[-1] / (mesh.x.size - 1) for _, mesh, *_ in states)
    resolution = spacing * strength / 0.375 if law is LennardJones and mesh_name == "uniform" else 0
    return dict(zip(FIELDS, (
        law.name, strength, mesh_name, max(sizes), resolution, method, options.get("depth", ""),
        options.get("mixing_limit", ""), len(states), len(products), _median(products),
        _median(factorisations), rejected, spectra[:, 0].min(), spectra[:, 1].max())))


def measure_cycles(say):
    """Return a row for each cycle, from far apart to h0 = -2 and back; the best time of three."""
    rows = []
    for sigma in SIGMAS:
        far = 6.0 + 6.0 * sigma ** (2 / 3)
        for name, numerics, largest in CYCLE_METHODS:
            if sigma > largest:
                continue
            deck = {"bodies": {"radius": 1.0, "stiffness": 1.0}, "force": LennardJones.deck(sigma),
                    "loading": {"h0_start": far, "h0_end": -2.0, "h0_step": (far + 2) / 100},
                    "unloading": {"from": [-2.0], "h0_end": far, "h0_step": (far + 2) / 100},
                    "numerics": numerics}
            runs = [snapin.run(deck) for _ in range(3)]
            run = min(runs, key=lambda run: run.cost["solve_seconds"])
            cost = run.cost
            rows.append(dict(zip(CYCLE_FIELDS, (
                name, sigma, len(run.curve), int((run.curve["residual"] <= 1e-7).sum()),
                1e3 * cost["solve_seconds"], cost["operator_products"], cost["factorisations"],
                cost.get("rejected_steps", 0)))))
            say(f"cycle at sigma {sigma:g}: {name}: {rows[-1]['milliseconds']:.3g} ms")
    return rows


def _median(values):
    return float(np.median(values)) if values else float("nan")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--draw", action="store_true", help="from the present measurements")
    if not parser.parse_args().draw:
        def say(text):
            print(text, file=sys.stderr, flush=True)

        tables.write(TABLE, measure(say), [])
        tables.write(CYCLES, measure_cycles(say), [])
    rows, cycles = tables.read(TABLE), tables.read(CYCLES)
    methods_page.draw(rows, cycles, PICTURE)
    pages.insert(GUIDE, "methods", methods_page.lines(rows, cycles))


if __name__ == "__main__":
    sys.exit(as_command(main)())
