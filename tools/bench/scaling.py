"""The dependence of time on adhesion, nodes and threads."""

import os

import pictures
import problems
from tables import chosen, whole

_PIECES = ("assembly", "dgemv", "residual", "mixing", "dgetrs", "anderson", "dgesv", "newton")
# Names of ratios of pieces, the piece, the pieces that it is compared with, and the look.
_RATIOS = (("mixing / DGEMV", "mixing", ("dgemv",), pictures.LOOKS[3]),
           ("Anderson / DGEMV", "anderson", ("dgemv",), {"color": pictures.SKY, "marker": "P"}),
           ("Anderson / (DGEMV + DGETRS)", "anderson", ("dgemv", "dgetrs"), pictures.LOOKS[2]),
           ("Newton / DGESV", "newton", ("dgesv",), {"color": pictures.BLACK, "marker": "h"}))


def _parts(run):
    """Return the times of the parts of a run in G."""
    return {"kernel": run.kernel_seconds / run.unit, "solution": run.solve_seconds / run.unit,
            "error_estimate": run.estimate_seconds / run.unit}


def measure_sigma(program, quick, say):
    """Return the cost of path and cycle against the strength of adhesion."""
    exponents = range(-3, 5, 2) if quick else [k / 2 for k in range(-6, 9)]
    cases = {}
    for exponent in exponents:
        problem = problems.lennard_jones(float(f"{10.0**exponent:.3g}"))
        cases[problem.name, "path"] = problem.path("accuracy = 1e-6")
        cases[problem.name, "cycle"] = problem.cycle("accuracy = 1e-6")
    rows = [{"sigma": float(name.split("_")[1]), "deck": kind, **run.cells("price", "least_price"),
             **_parts(run), **run.cells("nodes", "states", "products", "factorisations",
                                        "estimate", "failure", "warning")}
            for (name, kind), run in program.best_of(2 if quick else 5, cases).items()]
    say(f"{len(rows)} runs")
    return rows


def draw_sigma(rows, folder):
    """Draw cost, nodes and states against sigma."""
    page, (times, numbers) = pictures.figure(1, 2, (9.0, 4.2))
    pictures.dress(times, "accuracy 1e-6, one core", "σ", "time [G]")
    pictures.dress(numbers, "the path", "σ", "number")
    rows = sorted(rows, key=lambda row: row["sigma"])
    for kind, name, look in zip(("path", "cycle"), ("path", "cycle of 102 states"), pictures.LOOKS):
        good = chosen(rows, deck=kind, failure="")
        pictures.line(times, good, "sigma", "price", **look, label=name)
        pictures.line(times, good, "sigma", "least_price", color=look["color"], linestyle=":",
                      linewidth=1)
        failed = [row["sigma"] for row in rows if row["deck"] == kind and row["failure"]]
        times.plot(failed, [0.97] * len(failed), "x", color=look["color"], markersize=9,
                   markeredgewidth=2, transform=times.get_xaxis_transform())
    for key, look in (("nodes", pictures.LOOKS[2]), ("states", {"color": pictures.PURPLE,
                                                                "marker": "D"})):
        pictures.line(numbers, chosen(rows, deck="path", failure=""), "sigma", key, **look,
                      label=key)
    pictures.plain_ticks(times.yaxis, 1, 2, 5, 10, 20, 50, 100)
    pictures.plain_ticks(numbers.yaxis, 50, 100, 200, 500, 1000)
    for panel in (times, numbers):
        panel.legend(frameon=False, fontsize=9)
    pictures.save(page, folder / "sigma.png")


def measure_nodes(program, quick, say):
    """Return times of the library's pieces against nodes, in G."""
    rows = program.gauge.pieces((100, 200, 400) if quick else (100, 200, 400, 800, 1500))
    unit = next(row["dgesv"] for row in rows if row["nodes"] == 400)
    say(f"{len(rows)} grids")
    return [{key: value if key == "nodes" else value / unit for key, value in row.items()}
            for row in rows]


def draw_nodes(rows, folder):
    page, (times, ratios) = pictures.figure(1, 2, (9.0, 4.4))
    nodes = [row["nodes"] for row in rows]
    ticks = [count for count in (100, 200, 400, 800, 1500) if nodes[0] <= count <= nodes[-1]]
    pictures.dress(times, "one core", "nodes", "time [G]")
    pictures.dress(ratios, "over the linear algebra in it", "nodes", "ratio", log="x")
    for piece, look in zip(_PIECES, pictures.LOOKS):
        plain = piece.startswith("dge")
        pictures.line(times, rows, "nodes", piece, **look, linestyle=":" if plain else "-",
                      markersize=5, linewidth=1.2, label=piece.upper() if plain else piece,
                      markerfacecolor="white" if plain else look["color"])
    for name, piece, others, look in _RATIOS:
        ratios.plot(nodes, [row[piece] / sum(row[other] for other in others) for row in rows],
                    **look, markersize=5, label=name)
    for panel in (times, ratios):
        pictures.plain_ticks(panel.xaxis, *ticks)
    ratios.axhline(1.3, **pictures.THIN)
    ratios.set_ylim(0, None)
    times.set_ylim(5e-4, 1e5)
    times.legend(frameon=False, fontsize=9, ncols=2, loc="upper left")
    ratios.legend(frameon=False, fontsize=9)
    pictures.save(page, folder / "nodes.png")


def measure_threads(program, quick, say):
    """Return the times of large uniform runs against threads, in G of one thread."""
    rows = []
    problem = problems.ADHESIVE[1]
    for nodes in (400,) if quick else (400, 1000):
        deck = problem.cycle(f"grid = 'uniform', nodes = {nodes}, accuracy = 1e-2",
                             20 * problem.step)
        for threads in (count for count in (1, 2, 4) if count <= os.cpu_count()):
            run = program.best_of(2, {0: deck}, 180, threads=threads)[0]
            rows.append({"nodes": nodes, "threads": threads, **_parts(run),
                         "price": run.wall / run.unit, **run.cells("failure", "warning")})
        kernels = ", ".join(f"{row['kernel']:.3g}" for row in chosen(rows, nodes=nodes))
        say(f"{nodes} nodes: kernel {kernels} G")
    return rows


def draw_threads(rows, folder):
    page, panels = pictures.figure(1, 2, (9.0, 4.0), sharey=True)
    for panel, key, title in zip(panels, ("kernel", "solution"), ("kernel assembly", "solution")):
        pictures.dress(panel, title, "threads", "speed-up" if key == "kernel" else "", log="")
        panel.plot((1, 4), (1, 4), **pictures.THIN, label="as many times")
        for nodes, look in zip(sorted({row["nodes"] for row in rows}), pictures.LOOKS):
            mine = [row for row in chosen(rows, nodes=nodes) if row[key] == row[key]]
            if mine:
                panel.plot([row["threads"] for row in mine],
                           [mine[0][key] / row[key] for row in mine], **look,
                           label=f"{nodes:.0f} nodes")
        panel.set_xticks((1, 2, 4))
    panels[1].legend(frameon=False)
    pictures.save(page, folder / "threads.png")


def tables_threads(rows, before):
    return {"threads": (
        ["nodes", "threads", "kernel [G]", "solution [G]", "estimate [G]"],
        [[*whole(row, "nodes", "threads"), row["kernel"], row["solution"], row["error_estimate"]]
         for row in rows])}
