"""The cost of each accuracy, the decrease of errors, and the reliability of the error estimate."""

import math

import numpy as np
import pictures
import problems
import tables as tables_module

ACCURACIES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10)
# Below this value the error of the reference matters.
_KNOWN = 1e-10
# In units of sqrt(R z0).
_REACHES = (16, 23, 32, 45, 64, 90)
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
        say(f"{problem.label}: done; "
            f"the reference is estimated to be off by {reference.estimate:.0e}")
    return rows


def _row(problem, kind, value, run, reference, length):
    errors = run.errors(reference, length)
    return {
        "problem": problem.name, "deck": kind, "accuracy": value, "nodes": run.nodes,
        "states": run.states, "price": run.price, "least_price": run.least_price,
        "price_of_estimate": run.price - run.price_of_run, "products": run.products,
        "factorisations": run.factorisations,
        **{f"error_{key}": errors.get(key, math.nan) for key in ("pull_off", "jump_in", "load")},
        "error": max(errors.values(), default=math.nan),
        "worst": max(errors, key=errors.get, default=""), "estimate": run.estimate,
        "failure": run.failure, "warning": run.warning}


def draw(rows, folder):
    """Draw error and estimate against the requested accuracy, and the cost of each."""
    page, panels = pictures.figure(1, 2, (9.0, 4.6))
    pictures.dress(panels[0, 0], "what is asked and what is got", "accuracy asked for",
                   "relative error")
    pictures.dress(panels[0, 1], "what it costs", "accuracy asked for", "time [G]")
    for problem, colour, marker in zip(problems.ALL, pictures.COLOURS, pictures.MARKERS):
        mine = [row for row in rows if row["problem"] == problem.name and row["deck"] == "path"]
        asked = [row["accuracy"] for row in mine]
        panels[0, 0].plot(asked, [max(row["error"], 1e-15) for row in mine], marker, color=colour,
                          linestyle="-", linewidth=1.2, label=problem.label)
        panels[0, 0].plot(asked, [row["estimate"] for row in mine], marker, color=colour,
                          linestyle=":", linewidth=1.0, markersize=4, markerfacecolor="white")
        panels[0, 1].plot(asked, [row["price"] for row in mine], marker, color=colour,
                          linestyle="-", linewidth=1.2)
        panels[0, 1].plot(asked, [row["least_price"] for row in mine], color=colour,
                          linestyle=":", linewidth=1.0)
    panels[0, 0].plot(ACCURACIES, ACCURACIES, color=pictures.GREY, linewidth=2, zorder=0,
                      label="error = accuracy")
    panels[0, 1].plot([], [], ":", color="#555555", label="linear algebra and rows alone")
    panels[0, 1].legend(frameon=False, fontsize=8)
    panels[0, 0].plot([], [], "o:", color="#555555", markersize=4, markerfacecolor="white",
                      label="error_estimate")
    for panel in panels.flat:
        panel.invert_xaxis()
    pictures.plain_ticks(panels[0, 1], (1, 2, 5, 10, 20, 50, 100), "y")
    pictures.legend(page, 4)
    pictures.save(page, folder / "accuracy.png")


def tables(rows, before):
    """Return the table of costs: the path at each accuracy, and its cost in the previous
    version."""
    lines = []
    earlier = {(row["problem"], row["deck"], row["accuracy"]): row.get("price", math.nan)
               for row in before}
    for problem in problems.ALL:
        for row in rows:
            if row["problem"] == problem.name and row["deck"] == "path":
                key = row["problem"], row["deck"], row["accuracy"]
                lines.append([problem.label, f"{row['accuracy']:.0e}", row["price"],
                              row["least_price"], earlier.get(key, math.nan),
                              f"{row['nodes']:.0f}", f"{row['states']:.0f}",
                              f"{row['products']:.0f}", f"{row['factorisations']:.0f}",
                              row["error"], row["estimate"]])
    return {"accuracy": (["", "accuracy", "G", "limit", "before", "nodes", "states", "products",
                          "factorisations", "true error", "error_estimate"], lines)}


def measure_law(program, quick, say):
    """Return errors against nodes, reach of fixed panels, and spacing of a uniform grid."""
    rows = []
    nodes = (100, 200) if quick else (50, 71, 100, 141, 200, 283, 400, 566, 800)
    for problem in _LAW:
        reference = program.reference(problem)
        for accuracy in ACCURACIES[::4] if quick else ACCURACIES[:-1]:
            run = program.run(problem.path(f"accuracy = {accuracy}, residual_tolerance = 1e-12"))
            rows.append(_law_row(problem, "locked", run.nodes, run, reference))
        if problem.adhesive and problem is not problems.ADHESIVE[3]:
            rows += _reach_rows(program, problem, _REACHES[::3] if quick else _REACHES)
        if problem is not problems.ADHESIVE[3]:
            # If the neck is far from resolved, there is no law, and a run takes minutes.
            for count in nodes if problem is not problems.ADHESIVE[2] else nodes[:6]:
                run = program.run(problem.cycle(
                    f"grid = 'uniform', nodes = {count}, accuracy = 1e-4", 4 * problem.step))
                rows.append(_law_row(problem, "nodes", count, run, reference))
        say(f"{problem.label}: done")
    return rows


def _reach_rows(program, problem, reaches):
    """Return rows for the same state before contact on fixed panels with the given reaches."""
    near = 1.5 * program.reference(problem).values["jump_in"]
    lateral = math.sqrt(1.5e-2 * problem.length)

    def run(reach):
        return program.run(problem.approach(
            near, f"grid = 'panels', method = 'mixing', panel_order = 16, accuracy = 1e-10, "
                  f"nodes = 600, r_max = {reach * lateral!r}"))

    reference = run(2 * _REACHES[-1])
    return [_law_row(problem, "reach", reach, run(reach), reference) for reach in reaches]


def _law_row(problem, knob, value, run, reference):
    row = _row(problem, "path" if knob != "nodes" else "cycle", 0, run, reference, problem.length)
    row["nodes"] = run.nodes
    spacing = run.summary.get("spacing_over_neck", math.nan) if run.states else math.nan
    return {"knob": knob, "value": value, "spacing_over_neck": spacing, **row}


def draw_law(rows, folder):
    """Draw the three laws."""
    page, panels = pictures.figure(1, 3, (10.5, 4.4), sharey=True)
    pictures.dress(panels[0, 0], "edge-locked meshes", "nodes of all meshes",
                   "largest relative error", log="y")
    pictures.dress(panels[0, 1], "reach of the mesh", "reach / $(R z_0)^{1/2}$")
    pictures.dress(panels[0, 2], "uniform grid: pull-off, or load", "nodes")
    for problem, colour, marker in zip(_LAW, pictures.COLOURS[1:], pictures.MARKERS[1:]):
        for panel, knob in zip(panels.flat, ("locked", "reach", "nodes")):
            mine = [row for row in rows if row["problem"] == problem.name and row["knob"] == knob
                    and not row["failure"]]
            key = _key(knob, problem)
            mine = [row for row in mine if row[key] > 1e-14]
            panel.plot([row["value"] for row in mine], [row[key] for row in mine], color=colour,
                       linewidth=1.2)
            for row in mine:
                panel.plot(row["value"], row[key], marker, color=colour, linestyle="none",
                           markerfacecolor="white" if row["warning"] else colour)
            panel.plot([], [], marker, color=colour, linestyle="-", label=problem.label)
    panels[0, 2].plot([], [], "o", color="#555555", markerfacecolor="white", linestyle="none",
                      label="with a warning")
    pictures.guide(panels[0, 1], (16, 90), 5e-4, -5, "reach$^{-5}$")
    pictures.guide(panels[0, 2], (70, 800), 3e-2, -2, "nodes$^{-2}$")
    pictures.plain_ticks(panels[0, 1], (20, 30, 50, 90))
    pictures.plain_ticks(panels[0, 2], (50, 100, 200, 400, 800))
    pictures.legend(page, 5)
    pictures.save(page, folder / "error_law.png")


def tables_law(rows, before):
    """Return the guide's table: laws fitted to errors above rounding of runs without a warning."""
    lines = []
    for knob, name in (("locked", "edge-locked: factor for each ten nodes"),
                       ("reach", "fixed panels: power of the reach"),
                       ("nodes", "uniform grid: power of the number of nodes")):
        cells = [name]
        for problem in _LAW:
            key = _key(knob, problem)
            points = [(row["value"], row[key]) for row in rows
                      if row["problem"] == problem.name and row["knob"] == knob
                      and not row["failure"] and row[key] > _KNOWN
                      and not row["warning"]]
            if len(points) < 3:
                cells.append("–")
                continue
            x, y = zip(*points)
            if knob == "locked":
                cells.append(f"{np.exp(10 * np.polyfit(x, np.log(y), 1)[0]):.2g}")
            else:
                cells.append(f"{np.polyfit(np.log(x), np.log(y), 1)[0]:.1f}")
        lines.append(cells)
    return {"error_law": (["", *(problem.label for problem in _LAW)], lines)}


def _key(knob, problem):
    """Return the error that follows a law: others are limited by reach, or by bracketed jumps."""
    if knob != "nodes":
        return "error"
    return "error_pull_off" if problem.adhesive else "error_load"


def honesty(folder):
    """Draw the estimate against the true error for all measurements; return the ratios."""
    measured = {}
    for name in ("accuracy", "error_law", "work_precision"):
        for row in tables_module.read(folder / f"{name}.csv"):
            error = row.get("error_claimed", row["error"])
            if row.get("knob") == "nodes" and name == "error_law":
                error = max(row["error_load"], row["error_pull_off"])
            if row["failure"] or not 0 < row["estimate"] < math.inf or not error > 0:
                continue
            method = row.get("method", "")
            paper = method.endswith("rule")
            fixed = method.startswith(("uniform", "fixed")) or (
                name == "error_law" and row["knob"] == "nodes")
            kind = ("the paper's stopping rule" if paper else
                    "fixed grids, with a warning" if fixed and row["warning"] else
                    "fixed grids" if fixed else "edge-locked panels")
            measured.setdefault(kind, []).append((error, row["estimate"]))
    page, panels = pictures.figure(1, 1, (7.0, 5.6))
    panel = panels[0, 0]
    pictures.dress(panel, "", "true relative error", "error_estimate")
    ends = (1e-15, 10.0)
    panel.plot(ends, ends, color=pictures.GREY, linewidth=2, label="estimate = error")
    panel.plot(ends, [100 * end for end in ends], color=pictures.GREY, linewidth=1,
               linestyle=(0, (4, 2)), label="estimate = 100 × error")
    panel.axvspan(1e-16, _KNOWN, color="#eeeeee", zorder=0, label="reference not known so well")
    for (kind, pairs), colour, marker in zip(sorted(measured.items()), pictures.COLOURS,
                                             pictures.MARKERS):
        panel.plot(*zip(*pairs), marker, color=colour, linestyle="none", markersize=5, alpha=0.8,
                   label=kind, markerfacecolor="white" if "warning" in kind else colour)
    panel.set_xlim(1e-15, 10)
    panel.set_ylim(1e-14, 1e3)
    pictures.legend(page)
    pictures.save(page, folder / "estimate.png")
    lines = []
    for kind, pairs in sorted(measured.items()):
        ratio = sorted(estimate / error for error, estimate in pairs if error > _KNOWN)
        if not ratio:
            continue
        lines.append([kind, f"{len(ratio)}", ratio[0], ratio[len(ratio) // 2], ratio[-1],
                      f"{sum(value < 1 for value in ratio)}",
                      f"{sum(value > 100 for value in ratio)}"])
    return {"estimate": (["", "runs", "least", "median", "largest", "below 1", "above 100"], lines)}
