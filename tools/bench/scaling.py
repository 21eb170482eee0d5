"""How time grows with adhesion, nodes and threads."""

import io
import os
import subprocess

import pictures
import problems
from program import ROOT

_PIECES = ("assembly", "dgemv", "residual", "mixing", "dgetrs", "anderson", "dgesv", "newton")


def measure_sigma(program, quick, say):
    """Return the time of path and cycle against the strength of adhesion."""
    exponents = range(-3, 5, 2) if quick else [k / 2 for k in range(-6, 9)]
    cases = {}
    for exponent in exponents:
        problem = problems.lennard_jones(float(f"{10.0**exponent:.3g}"))
        cases[problem.name, "path"] = problem.path("accuracy = 1e-6")
        cases[problem.name, "cycle"] = problem.cycle("accuracy = 1e-6")
    runs = program.best_of(2 if quick else 5, cases)
    rows = []
    for (name, kind), run in runs.items():
        rows.append({
            "sigma": float(name.split("_")[1]), "deck": kind, "seconds": run.seconds,
            "kernel_seconds": run.kernel_seconds, "solve_seconds": run.solve_seconds,
            "estimate_seconds": run.estimate_seconds, "nodes": run.nodes, "states": run.states,
            "products": run.products, "factorisations": run.factorisations,
            "estimate": run.estimate, "failure": run.failure, "warning": run.warning})
    say(f"{len(rows)} runs")
    return rows


def draw_sigma(rows, folder):
    """Draw time, nodes and states against sigma."""
    page, panels = pictures.figure(1, 2, (9.0, 4.2))
    pictures.dress(panels[0, 0], "accuracy 1e-6, one core", "σ", "time [s]")
    pictures.dress(panels[0, 1], "the path", "σ", "number")
    for kind, colour, marker in (("path", pictures.BLUE, "o"),
                                 ("cycle of 102 states", pictures.VERMILION, "s")):
        mine = sorted((row for row in rows if row["deck"] == kind.split()[0]),
                      key=lambda row: row["sigma"])
        good = [row for row in mine if not row["failure"]]
        panels[0, 0].plot([row["sigma"] for row in good], [row["seconds"] for row in good], marker,
                          color=colour, linestyle="-", label=kind)
        failed = [row["sigma"] for row in mine if row["failure"]]
        panels[0, 0].plot(failed, [0.97] * len(failed), "x", color=colour, markersize=9,
                          markeredgewidth=2, transform=panels[0, 0].get_xaxis_transform())
        if kind == "path":
            for key, tone, shape in (("nodes", pictures.GREEN, "^"),
                                     ("states", pictures.PURPLE, "D")):
                panels[0, 1].plot([row["sigma"] for row in good], [row[key] for row in good],
                                  shape, color=tone, linestyle="-", label=key)
    pictures.plain_ticks(panels[0, 0], (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2), "y")
    pictures.plain_ticks(panels[0, 1], (50, 100, 200, 500, 1000), "y")
    for panel in panels.flat:
        panel.legend(frameon=False, fontsize=9)
    pictures.save(page, folder / "sigma.png")


def limits(program, nodes, threads=1):
    """Return the driver's rows for the given numbers of nodes."""
    subprocess.run([str(ROOT / ".venv/bin/ninja"), "-C", str(program.build), "linear_limits"],
                   check=True, capture_output=True)
    output = subprocess.run(
        [str(program.build / "linear_limits"), *map(str, nodes)],
        env=program.environment(threads), check=True, capture_output=True, text=True).stdout
    lines = io.StringIO(output)
    header = next(lines).strip().split(",")
    return [dict(zip(header, map(float, line.split(",")))) for line in lines]


def measure_nodes(program, quick, say):
    """Return seconds of the library's pieces against nodes."""
    rows = limits(program, (100, 200, 400) if quick else (100, 200, 300, 400, 600, 800, 1000, 1500,
                                                          2000))
    say(f"{len(rows)} grids")
    return rows


def draw_nodes(rows, folder):
    """Draw the pieces' times."""
    page, panels = pictures.figure(1, 2, (9.0, 4.4))
    nodes = [row["nodes"] for row in rows]
    pictures.dress(panels[0, 0], "one core", "nodes", "time [s]")
    pictures.dress(panels[0, 1], "over the linear algebra in it", "nodes", "ratio", log="x")
    for piece, colour, marker in zip(_PIECES, pictures.COLOURS, pictures.MARKERS):
        plain = piece.startswith("dge")
        panels[0, 0].plot(nodes, [row[piece] for row in rows], marker, color=colour,
                          linestyle=":" if plain else "-", markersize=5, linewidth=1.2,
                          markerfacecolor="white" if plain else colour,
                          label=piece.upper() if plain else piece)
    for name, colour, marker, ratio in (
            ("mixing / DGEMV", pictures.ORANGE, "D", lambda row: row["mixing"] / row["dgemv"]),
            ("Anderson / DGEMV", pictures.SKY, "P", lambda row: row["anderson"] / row["dgemv"]),
            ("Anderson / (DGEMV + DGETRS)", pictures.GREEN, "^",
             lambda row: row["anderson"] / (row["dgemv"] + row["dgetrs"])),
            ("Newton / DGESV", pictures.BLACK, "h", lambda row: row["newton"] / row["dgesv"])):
        panels[0, 1].plot(nodes, [ratio(row) for row in rows], marker, color=colour, linestyle="-",
                          markersize=5, label=name)
    ticks = [count for count in (100, 200, 400, 800, 1500) if nodes[0] <= count <= nodes[-1]]
    for panel in panels.flat:
        pictures.plain_ticks(panel, ticks)
    panels[0, 1].axhline(1.3, color=pictures.GREY, linewidth=1, linestyle=(0, (4, 2)))
    panels[0, 1].set_ylim(0, None)
    panels[0, 0].set_ylim(5e-7, 100)
    panels[0, 0].legend(frameon=False, fontsize=9, ncols=2, loc="upper left")
    panels[0, 1].legend(frameon=False, fontsize=9)
    pictures.save(page, folder / "nodes.png")


def measure_threads(program, quick, say):
    """Return kernel and solve seconds of large uniform runs against threads."""
    rows = []
    problem = problems.ADHESIVE[1]
    for nodes in (400,) if quick else (400, 1000, 2000):
        deck = problem.cycle(f"grid = 'uniform', nodes = {nodes}, accuracy = 1e-2",
                             20 * problem.step)
        for threads in (1, 2, 4):
            if threads > os.cpu_count():
                continue
            run = program.best_of(1 if nodes > 1000 else 2, {0: deck}, 180, threads=threads)[0]
            rows.append({
                "nodes": nodes, "threads": threads, "kernel_seconds": run.kernel_seconds,
                "solve_seconds": run.solve_seconds, "estimate_seconds": run.estimate_seconds,
                "seconds": run.seconds, "failure": run.failure, "warning": run.warning})
        say(f"{nodes} nodes: kernel " + ", ".join(
            f"{row['kernel_seconds']:.3f}" for row in rows if row["nodes"] == nodes) + " s")
    return rows


def draw_threads(rows, folder):
    """Draw the speed-up by threads."""
    page, panels = pictures.figure(1, 2, (9.0, 4.0), sharey=True)
    for panel, key, title in zip(panels.flat, ("kernel_seconds", "solve_seconds"),
                                 ("kernel assembly", "solution")):
        pictures.dress(panel, title, "threads", "speed-up" if key[0] == "k" else "", log="")
        panel.plot((1, 4), (1, 4), color=pictures.GREY, linewidth=1, linestyle=(0, (4, 2)),
                   label="as many times")
        sizes = sorted({row["nodes"] for row in rows})
        for nodes, colour, marker in zip(sizes, pictures.COLOURS, pictures.MARKERS):
            mine = [row for row in rows if row["nodes"] == nodes and row[key] == row[key]]
            if mine:
                panel.plot([row["threads"] for row in mine],
                           [mine[0][key] / row[key] for row in mine], marker, color=colour,
                           linestyle="-", label=f"{nodes:.0f} nodes")
        panel.set_xticks((1, 2, 4))
    panels[0, 1].legend(frameon=False)
    pictures.save(page, folder / "threads.png")


def tables_threads(rows):
    """Return the guide's table."""
    return {"threads": (
        ["nodes", "threads", "kernel [s]", "solution [s]", "estimate [s]"],
        [[f"{row['nodes']:.0f}", f"{row['threads']:.0f}", row["kernel_seconds"],
          row["solve_seconds"], row["estimate_seconds"]] for row in rows])}
