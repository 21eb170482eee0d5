"""The dependence of time on adhesion, nodes and threads."""

import os

import pictures
import problems

_PIECES = ("assembly", "dgemv", "residual", "mixing", "dgetrs", "anderson", "dgesv", "newton")


def measure_sigma(program, quick, say):
    """Return the cost of path and cycle against the strength of adhesion."""
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
            "sigma": float(name.split("_")[1]), "deck": kind, "price": run.price,
            "least_price": run.least_price, "kernel": run.kernel_seconds / run.unit,
            "solution": run.solve_seconds / run.unit,
            "error_estimate": run.estimate_seconds / run.unit, "nodes": run.nodes,
            "states": run.states,
            "products": run.products, "factorisations": run.factorisations,
            "estimate": run.estimate, "failure": run.failure, "warning": run.warning})
    say(f"{len(rows)} runs")
    return rows


def draw_sigma(rows, folder):
    """Draw cost, nodes and states against sigma."""
    page, panels = pictures.figure(1, 2, (9.0, 4.2))
    pictures.dress(panels[0, 0], "accuracy 1e-6, one core", "σ", "time [G]")
    pictures.dress(panels[0, 1], "the path", "σ", "number")
    for kind, colour, marker in (("path", pictures.BLUE, "o"),
                                 ("cycle of 102 states", pictures.VERMILION, "s")):
        mine = sorted((row for row in rows if row["deck"] == kind.split()[0]),
                      key=lambda row: row["sigma"])
        good = [row for row in mine if not row["failure"]]
        panels[0, 0].plot([row["sigma"] for row in good], [row["price"] for row in good], marker,
                          color=colour, linestyle="-", label=kind)
        panels[0, 0].plot([row["sigma"] for row in good], [row["least_price"] for row in good],
                          color=colour, linestyle=":", linewidth=1)
        failed = [row["sigma"] for row in mine if row["failure"]]
        panels[0, 0].plot(failed, [0.97] * len(failed), "x", color=colour, markersize=9,
                          markeredgewidth=2, transform=panels[0, 0].get_xaxis_transform())
        if kind == "path":
            for key, tone, shape in (("nodes", pictures.GREEN, "^"),
                                     ("states", pictures.PURPLE, "D")):
                panels[0, 1].plot([row["sigma"] for row in good], [row[key] for row in good],
                                  shape, color=tone, linestyle="-", label=key)
    pictures.plain_ticks(panels[0, 0], (1, 2, 5, 10, 20, 50, 100), "y")
    pictures.plain_ticks(panels[0, 1], (50, 100, 200, 500, 1000), "y")
    for panel in panels.flat:
        panel.legend(frameon=False, fontsize=9)
    pictures.save(page, folder / "sigma.png")


def measure_nodes(program, quick, say):
    """Return times of the library's pieces against nodes, in G."""
    rows = program.gauge.pieces((100, 200, 400) if quick else (100, 200, 400, 800, 1500))
    unit = next(row["dgesv"] for row in rows if row["nodes"] == 400)
    rows = [{key: value if key == "nodes" else value / unit for key, value in row.items()}
            for row in rows]
    say(f"{len(rows)} grids")
    return rows


def draw_nodes(rows, folder):
    """Draw the pieces' times."""
    page, panels = pictures.figure(1, 2, (9.0, 4.4))
    nodes = [row["nodes"] for row in rows]
    pictures.dress(panels[0, 0], "one core", "nodes", "time [G]")
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
    panels[0, 0].set_ylim(5e-4, 1e5)
    panels[0, 0].legend(frameon=False, fontsize=9, ncols=2, loc="upper left")
    panels[0, 1].legend(frameon=False, fontsize=9)
    pictures.save(page, folder / "nodes.png")


def measure_threads(program, quick, say):
    """Return the times of large uniform runs against threads, in G of one thread."""
    rows = []
    problem = problems.ADHESIVE[1]
    for nodes in (400,) if quick else (400, 1000):
        deck = problem.cycle(f"grid = 'uniform', nodes = {nodes}, accuracy = 1e-2",
                             20 * problem.step)
        for threads in (1, 2, 4):
            if threads > os.cpu_count():
                continue
            run = program.best_of(1 if nodes > 1000 else 2, {0: deck}, 180, threads=threads)[0]
            rows.append({
                "nodes": nodes, "threads": threads, "kernel": run.kernel_seconds / run.unit,
                "solution": run.solve_seconds / run.unit,
                "error_estimate": run.estimate_seconds / run.unit,
                "price": run.wall / run.unit, "failure": run.failure, "warning": run.warning})
        say(f"{nodes} nodes: kernel " + ", ".join(
            f"{row['kernel']:.3g}" for row in rows if row["nodes"] == nodes) + " G")
    return rows


def draw_threads(rows, folder):
    """Draw the speed-up by threads."""
    page, panels = pictures.figure(1, 2, (9.0, 4.0), sharey=True)
    for panel, key, title in zip(panels.flat, ("kernel", "solution"),
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


def tables_threads(rows, before):
    """Return the guide's table."""
    return {"threads": (
        ["nodes", "threads", "kernel [G]", "solution [G]", "estimate [G]"],
        [[f"{row['nodes']:.0f}", f"{row['threads']:.0f}", row["kernel"], row["solution"],
          row["error_estimate"]] for row in rows])}
