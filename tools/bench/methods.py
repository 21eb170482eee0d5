#!/usr/bin/env python3
"""The ladder of methods: what each iteration needs for a step of h0, and where it stops working.

    tools/bench/methods.py          ten minutes; docs/bench/methods.*, the table of docs/methods.md
    tools/bench/methods.py --draw   picture and table again, from the present measurements

Each state is solved from the state a tenth of a length before, at constant separation, as a step of
the paper begins; so all methods have the same start and the same residual to reach, 1e-8. The
states themselves come from the program's path, and Newton's method on the mesh in question. The
matrix is that of one mesh, uniform or with panels about the contact edge. The spectrum of 1 - W p'
is that of the dense matrix at the solution.
"""

import argparse
import csv
import pathlib
import sys
import time

import numpy as np

TOP = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(TOP / "tools" / "bench"), str(TOP / "tools"), str(TOP / "build" / "pywrap"),
                str(TOP / "pywrap"), str(TOP / "pywrap" / "plots")]

import pictures  # noqa: E402 (found through the lines above)
import snapin  # noqa: E402

TABLE, PICTURE = (TOP / "docs" / "bench" / f"methods.{kind}" for kind in ("csv", "png"))
GUIDE = TOP / "docs" / "methods.md"
BEGIN, END = "<!-- methods -->", "<!-- end of methods -->"

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
          "converged", "products", "factorisations", "rejected", "milliseconds", "least", "largest")


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
        """The width of the neck, or what the repulsion resolves."""
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
    products, factorisations, rejected, took, converged = [], [], 0, [], 0
    for h0, mesh, start, _ in states:
        def solve(most):
            began = time.perf_counter()
            state = snapin.equilibrium(law.force, mesh, h0, strength, method=method, start=start,
                                       tolerance=TOLERANCE, most_iterations=most, **options)
            return state, time.perf_counter() - began

        _, before = solve(1)
        state, whole = solve(MOST[method])
        rejected += state.rejected_steps
        if state.converged:
            converged += 1
            products.append(state.operator_products)
            factorisations.append(state.factorisations)
            took.append(1e3 * max(whole - before, 1e-6))
    sizes = [mesh.x.size for _, mesh, *_ in states]
    spectra = np.array([spectrum for *_, spectrum in states])
    spacing = max(mesh.x[-1] / (mesh.x.size - 1) for _, mesh, *_ in states)
    resolution = spacing * strength / 0.375 if law is LennardJones and mesh_name == "uniform" else 0
    return dict(zip(FIELDS, (
        law.name, strength, mesh_name, max(sizes), resolution, method, options.get("depth", ""),
        options.get("mixing_limit", ""), len(states), converged, *map(_median, (
            products, factorisations)), rejected, _median(took), spectra[:, 0].min(),
        spectra[:, 1].max())))


def _median(values):
    return float(np.median(values)) if values else float("nan")


def save(rows):
    with TABLE.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, FIELDS, lineterminator="\n")
        writer.writeheader()
        writer.writerows({key: f"{value:.4g}" if isinstance(value, float) else value
                          for key, value in row.items()} for row in rows)


def load():
    with TABLE.open(encoding="utf-8") as file:
        return [{key: _value(value) for key, value in row.items()} for row in csv.DictReader(file)]


def _value(cell):
    try:
        return float(cell)
    except ValueError:
        return cell


SHOWN = (("mixing", "", "", "mixing"), ("anderson_mixing", 5, 0.2, "anderson_mixing, depth 5"),
         ("anderson_mixing", 10, 0.2, "anderson_mixing, 10"),
         ("anderson_mixing", 20, 0.2, "anderson_mixing, 20"),
         ("anderson", 0, "", "frozen Jacobian alone"), ("anderson", 1, "", "anderson, depth 1"),
         ("anderson", 5, "", "anderson, 5"), ("anderson", 20, "", "anderson, 20"),
         ("newton", "", "", "newton"))


def _of(rows, mesh, method, depth, ratio):
    return [row for row in rows if (row["mesh"], row["method"], row["depth"], row["ratio"]) ==
            (mesh, method, depth, ratio)]


def table(rows):
    """Return the table: products, factorisations in brackets, a note where states are lost."""
    cases = list(dict.fromkeys((row["law"], row["strength"]) for row in rows))
    names = [f"{'σ' if law == LennardJones.name else 'Λ'} = {strength:g}"
             for law, strength in cases]
    lines = []
    for mesh, title in (("uniform", f"Uniform, {NODES} nodes"), ("edge", "Panels about the edge")):
        lines += [f"| {title} | " + " | ".join(names) + " |", "|---" * (len(cases) + 1) + "|"]
        one = {case: next(row for row in rows if (row["law"], row["strength"], row["mesh"]) ==
                          (*case, mesh)) for case in cases}
        lines.append("| smallest eigenvalue | " + " | ".join(
            f"{one[case]['least']:.2g}" for case in cases) + " |")
        lines.append("| largest eigenvalue | " + " | ".join(
            f"{one[case]['largest']:.2g}".replace("e+0", "e") for case in cases) + " |")
        for method, depth, ratio, name in SHOWN:
            cells = []
            for case in cases:
                row = next(row for row in _of(rows, mesh, method, depth, ratio)
                           if (row["law"], row["strength"]) == case)
                cells.append(_cell(row))
            lines.append(f"| {name} | " + " | ".join(cells) + " |")
        lines.append("")
    return "\n".join(lines)


def _cell(row):
    if not row["converged"]:
        return "–"
    text = f"{row['products']:.0f}"
    if row["factorisations"]:
        text += f" ({row['factorisations']:.0f})"
    if row["converged"] < row["states"]:
        text += f", {row['converged']:.0f} of {row['states']:.0f}"
    return text


def draw(rows):
    page, panels = pictures.figure(2, 2, (9.0, 7.0), sharex="col")
    for column, (mesh, title) in enumerate((("uniform", f"uniform, {NODES} nodes"),
                                            ("edge", "panels about the contact edge"))):
        for line, (y, name) in enumerate((("products", "products for a state"),
                                          ("milliseconds", "milliseconds for a state"))):
            panel = panels[line][column]
            pictures.dress(panel, title if line == 0 else "", "σ" if line else "", name)
            for (method, depth, ratio, label), look in zip(
                    [SHOWN[k] for k in (0, 1, 2, 3, 4, 6, 8)], pictures.LOOKS):
                mine = [row for row in _of(rows, mesh, method, depth, ratio)
                        if row["law"] == "lennard_jones"]
                kept = [row for row in mine if row["converged"]]
                panel.plot([row["strength"] for row in kept], [row[y] for row in kept], **look,
                           label=label, markersize=5)
                lost = [row for row in kept if row["converged"] < row["states"]]
                panel.plot([row["strength"] for row in lost], [row[y] for row in lost],
                           linestyle="none", **look, markerfacecolor="white", markersize=7)
    pictures.explain(panels[0][0], "some states lost", linestyle="none", **pictures.OPEN)
    pictures.legend(page, 4)
    pictures.save(page, PICTURE)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--draw", action="store_true", help="from the present measurements")
    if not parser.parse_args().draw:
        save(measure(lambda text: print(text, file=sys.stderr, flush=True)))
    rows = load()
    draw(rows)
    text = GUIDE.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    GUIDE.write_text(f"{before}{BEGIN}\n\n{table(rows)}\n{END}{rest.split(END)[1]}",
                     encoding="utf-8")


if __name__ == "__main__":
    main()
