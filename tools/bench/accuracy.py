"""What each accuracy costs, how errors fall, and how honest the error estimate is."""

import math

import pictures
import problems
import tables as tables_module
from program import read_table

ACCURACIES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10)
_LAW = (problems.ADHESIVE[1], problems.ADHESIVE[2], problems.ADHESIVE[3], problems.REPULSIVE[1])


def measure(program, quick, say):
    """Return one row for every problem and accuracy, for the path and for the cycle."""
    rows = []
    accuracies = ACCURACIES[::4] if quick else ACCURACIES
    for problem in problems.ALL:
        reference = program.reference(problem)
        decks = {}
        for accuracy in accuracies:
            decks["path", accuracy] = problem.path(f"accuracy = {accuracy}")
            decks["cycle", accuracy] = problem.cycle(f"accuracy = {accuracy}")
        runs = program.best_of(2 if quick else 5, decks)
        for (kind, accuracy), run in runs.items():
            rows.append(_row(problem, kind, accuracy, run, reference, problem.length))
        again = program.reference(problem, order=20).errors(reference, problem.length)
        say(f"{problem.label}: done; the reference is known to {max(again.values()):.0e}")
    return rows


def _row(problem, kind, value, run, reference, length):
    errors = run.errors(reference, length)
    return {
        "problem": problem.name, "deck": kind, "accuracy": value, "nodes": run.nodes,
        "states": run.states, "seconds": run.seconds, "estimate_seconds": run.estimate_seconds,
        "products": run.products, "factorisations": run.factorisations,
        **{f"error_{key}": errors.get(key, math.nan) for key in ("pull_off", "jump_in", "load")},
        "error": max(errors.values()), "estimate": run.estimate,
        "failure": run.failure, "warning": run.warning,
    }


def draw(rows, folder):
    """Draw error and estimate against the accuracy asked for, and time against error."""
    page, panels = pictures.figure(1, 2, (9.0, 4.6))
    pictures.dress(panels[0, 0], "what is asked and what is got", "accuracy asked for",
                   "relative error")
    pictures.dress(panels[0, 1], "what it costs", "accuracy asked for", "time [s]")
    for problem, colour, marker in zip(problems.ALL, pictures.COLOURS, pictures.MARKERS):
        mine = [row for row in rows if row["problem"] == problem.name and row["deck"] == "path"]
        asked = [row["accuracy"] for row in mine]
        panels[0, 0].plot(asked, [max(row["error"], 1e-15) for row in mine], marker, color=colour,
                          linestyle="-", linewidth=1.2, label=problem.label)
        panels[0, 0].plot(asked, [row["estimate"] for row in mine], marker, color=colour,
                          linestyle=":", linewidth=1.0, markersize=4, markerfacecolor="white")
        panels[0, 1].plot(asked, [row["seconds"] for row in mine], marker, color=colour,
                          linestyle="-", linewidth=1.2)
    panels[0, 0].plot(ACCURACIES, ACCURACIES, color=pictures.GREY, linewidth=2, zorder=0,
                      label="error = accuracy")
    panels[0, 0].plot([], [], "o:", color="#555555", markersize=4, markerfacecolor="white",
                      label="error_estimate")
    for panel in panels.flat:
        panel.invert_xaxis()
    pictures.legend(page, panels[0, 0], 4)
    pictures.save(page, folder / "accuracy.png")


def tables(rows):
    """Return the guide's tables: each accuracy, and the ratios of estimate and error."""
    lines = []
    for problem in _LAW:
        for row in rows:
            if (row["problem"] == problem.name and row["deck"] == "path"
                    and row["accuracy"] in (1e-2, 1e-4, 1e-6, 1e-8, 1e-10)):
                lines.append([problem.label, f"{row['accuracy']:.0e}", f"{row['nodes']:.0f}",
                              row["error"], row["estimate"], f"{row['seconds']:.2g}"])
    return {"accuracy": (["", "accuracy", "nodes", "true error", "error_estimate", "seconds"],
                         lines)}


def measure_law(program, quick, say):
    """Return errors against panel order, reach of the mesh, and spacing of a uniform grid."""
    rows = []
    fine = "accuracy = 1e-10, residual_tolerance = 1e-12"
    orders = (4, 8, 12) if quick else (4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14)
    reaches = ACCURACIES[::4] if quick else ACCURACIES
    nodes = (100, 200) if quick else (50, 71, 100, 141, 200, 283, 400, 566, 800)
    for problem in _LAW:
        reference = program.reference(problem)
        for order in orders:
            run = program.run(problem.path(f"{fine}, panel_order = {order}"))
            rows.append(_law_row(problem, "order", order, run, reference))
        for accuracy in reaches if problem.adhesive else ():
            h0 = 0.5 * problem.turn * problem.length
            run = program.run(problem.path(
                f"accuracy = {accuracy}, panel_order = 16, residual_tolerance = 1e-12",
                f"&profiles h0 = {h0!r} /"))
            profile = read_table(program.scratch / "deck", "profiles.csv")
            reach = profile["r"].max() / math.sqrt(1.5e-2 * problem.length)
            rows.append(_law_row(problem, "reach", reach, run, reference))
        if problem.label != "σ = 1000":
            # One approach is enough, and what it takes is not measured here.
            for count in nodes:
                run = program.run(problem.cycle(
                    f"grid = 'uniform', nodes = {count}, accuracy = 1e-4", 4 * problem.step))
                rows.append(_law_row(problem, "nodes", count, run, reference))
        say(f"{problem.label}: done")
    return rows


def _law_row(problem, knob, value, run, reference):
    row = _row(problem, "path" if knob != "nodes" else "cycle", 0, run, reference, problem.length)
    row["nodes"] = run.nodes
    spacing = run.summary.get("spacing_over_neck", math.nan) if run.states else math.nan
    return {"knob": knob, "value": value, "spacing_over_neck": spacing, **row}


def draw_law(rows, folder):
    """Draw the three laws."""
    page, panels = pictures.figure(1, 3, (10.5, 4.4), sharey=True)
    pictures.dress(panels[0, 0], "order of the panels", "nodes in a panel",
                   "largest relative error", log="y")
    pictures.dress(panels[0, 1], "reach of the mesh", "reach / $(R z_0)^{1/2}$")
    pictures.dress(panels[0, 2], "uniform grid", "nodes")
    for problem, colour, marker in zip(_LAW, pictures.COLOURS[1:], pictures.MARKERS[1:]):
        for panel, knob in zip(panels.flat, ("order", "reach", "nodes")):
            mine = [row for row in rows if row["problem"] == problem.name and row["knob"] == knob
                    and not row["failure"]]
            key = "error_load" if knob == "nodes" else "error"
            panel.plot([row["value"] for row in mine], [row[key] for row in mine], color=colour,
                       linewidth=1.2)
            for row in mine:
                panel.plot(row["value"], row[key], marker, color=colour, linestyle="none",
                           markerfacecolor="white" if row["warning"] else colour)
            panel.plot([], [], marker, color=colour, linestyle="-", label=problem.label)
    panels[0, 2].plot([], [], "o", color="#555555", markerfacecolor="white", linestyle="none",
                      label="with a warning")
    pictures.guide(panels[0, 1], (20, 120), 1e-8, -5, "reach$^{-5}$")
    pictures.guide(panels[0, 2], (50, 800), 0.1, -2, "nodes$^{-2}$")
    pictures.legend(page, panels[0, 0], 5)
    pictures.save(page, folder / "error_law.png")


def honesty(folder):
    """Draw the estimate against the true error over all that was measured; return the ratios."""
    measured = {}
    for name in ("accuracy", "error_law", "work_precision"):
        for row in tables_module.read(folder / f"{name}.csv"):
            if row["failure"] or not 0 < row["estimate"] < math.inf or not row["error"] > 0:
                continue
            method = row.get("method", "")
            paper = method.endswith("rule")
            fixed = method.startswith(("uniform", "fixed")) or row.get("knob") == "nodes"
            kind = ("the paper's stopping rule" if paper else
                    "fixed grids, with a warning" if fixed and row["warning"] else
                    "fixed grids" if fixed else "edge-locked panels")
            measured.setdefault(kind, []).append((row["error"], row["estimate"]))
    page, panels = pictures.figure(1, 1, (6.6, 5.2))
    panel = panels[0, 0]
    pictures.dress(panel, "", "true relative error", "error_estimate")
    ends = (1e-13, 10.0)
    panel.plot(ends, ends, color=pictures.GREY, linewidth=2, label="estimate = error")
    panel.plot(ends, [100 * end for end in ends], color=pictures.GREY, linewidth=1,
               linestyle=(0, (4, 2)), label="100 × error")
    for (kind, pairs), colour, marker in zip(sorted(measured.items()), pictures.COLOURS,
                                             pictures.MARKERS):
        panel.plot(*zip(*pairs), marker, color=colour, linestyle="none", markersize=5, alpha=0.8,
                   label=kind, markerfacecolor="white" if "warning" in kind else colour)
    panel.legend(frameon=False, fontsize=9, loc="lower right")
    pictures.save(page, folder / "estimate.png")
    lines = []
    for kind, pairs in sorted(measured.items()):
        # Below this the reference itself is not known.
        ratio = sorted(estimate / error for error, estimate in pairs if error > 1e-11)
        if not ratio:
            continue
        lines.append([kind, f"{len(ratio)}", ratio[0], ratio[len(ratio) // 2], ratio[-1],
                      f"{sum(value < 1 for value in ratio)}",
                      f"{sum(value > 100 for value in ratio)}"])
    return {"estimate": (["", "runs", "least", "median", "largest", "below 1", "above 100"], lines)}
