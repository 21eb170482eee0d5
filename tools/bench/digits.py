"""The cost of each accuracy, the decrease of errors, and the reliability of the error estimate."""

import math

import numpy as np
import pictures
import problems
from tables import chosen, earlier, read, whole

ACCURACIES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10)
# Those in the short table.
_SHOWN = (1e-3, 1e-6, 1e-9)
# Below this value the error of the reference matters.
_KNOWN = 1e-10
# In units of sqrt(R z0).
_REACHES = (16, 23, 32, 45, 64, 90)
_LAW = (problems.ADHESIVE[1], problems.ADHESIVE[2], problems.ADHESIVE[3], problems.REPULSIVE[1])
# Knobs of the decrease of errors, and what the guide calls the law of each.
_KNOBS = {"locked": "edge-locked: factor for each ten nodes",
          "reach": "fixed panels: power of the reach",
          "nodes": "uniform grid: power of the number of nodes"}


def measure(program, quick, say):
    """Return one row for every problem and accuracy, for the path and for the cycle."""
    rows = []
    for problem in problems.ALL:
        reference = program.reference(problem)
        decks = {(kind, accuracy): getattr(problem, kind)(f"accuracy = {accuracy}")
                 for accuracy in (ACCURACIES[::4] if quick else ACCURACIES)
                 for kind in ("path", "cycle")}
        calculation = {
            (kind, accuracy): seconds
            for kind in ("path", "cycle")
            for accuracy, seconds in _calculations(program, getattr(problem, kind)(), quick)}
        for (kind, accuracy), run in program.best_of(2 if quick else 5, decks).items():
            rows.append(_row(problem, kind, accuracy, run, reference)
                        | {"calculation": 1e3 * calculation[kind, accuracy]})
        say(f"{problem.label}: done; the reference is "
            + (f"estimated to be off by {reference.estimate:.0e}" if reference.estimate
               else "the independent solution"))
    return rows


def _calculations(program, deck, quick):
    """Return each accuracy and the processor time of its calculation, by a sweep over them."""
    values = ACCURACIES[::4] if quick else ACCURACIES
    swept = f"&sweep key = 'numerics.accuracy', values = {', '.join(map(str, values))} /\n"
    return zip(values, program.costs(deck + swept)["seconds"])


def _row(problem, kind, value, run, reference):
    # A run with the accuracy of a reference that is a run too says nothing about its own error.
    errors = {} if reference.estimate and value == ACCURACIES[-1] else run.errors(
        reference, problem.length)
    return {
        "problem": problem.name, "deck": kind, "accuracy": value,
        **run.cells("nodes", "states", "price", "least_price"),
        "milliseconds": 1e3 * run.seconds,
        "price_of_estimate": run.price - run.price_of_run,
        **run.cells("products", "factorisations"),
        **{f"error_{key}": errors.get(key, math.nan) for key in ("pull_off", "jump_in", "load")},
        "error": max(errors.values(), default=math.nan),
        "worst": max(errors, key=errors.get, default=""),
        **run.cells("estimate", "failure", "warning")}


def draw(rows, folder):
    """Draw error and estimate against the requested accuracy, and the cost of each."""
    page, (errors, times) = pictures.figure(1, 2, (9.0, 4.6))
    pictures.dress(errors, "what is asked and what is got", "accuracy asked for", "relative error")
    pictures.dress(times, "what it costs", "accuracy asked for", "time [ms]")
    for problem, look in zip(problems.ALL, pictures.LOOKS):
        mine = chosen(rows, problem=problem.name, deck="path")
        pictures.line(errors, mine, "accuracy", "error", 1e-15, **look, linewidth=1.2,
                      label=problem.label)
        pictures.line(errors, mine, "accuracy", "estimate", **look, **pictures.OPEN, linestyle=":",
                      linewidth=1.0, markersize=4)
        pictures.line(times, mine, "accuracy", "milliseconds", **look, linewidth=1.2)
        pictures.line(times, mine, "accuracy", "calculation", color=look["color"], linestyle=":",
                      linewidth=1.2)
    errors.plot(ACCURACIES, ACCURACIES, color=pictures.GREY, linewidth=2, zorder=0,
                label="error = accuracy")
    pictures.explain(times, "calculation, without start and files", ":")
    unit = float(np.median([row["milliseconds"] / row["price"] for row in rows]))
    beside = times.secondary_yaxis("right", functions=(lambda time: time / unit,
                                                       lambda time: time * unit))
    beside.set_ylabel("time [G]")
    pictures.explain(errors, "error_estimate", "o:", markersize=4, **pictures.OPEN)
    for panel in (errors, times):
        panel.invert_xaxis()
    pictures.plain_ticks(times.yaxis, 1, 2, 5, 10, 20, 50, 100)
    pictures.plain_ticks(beside.yaxis, 1, 2, 5, 10, 20, 50)
    pictures.legend(page, 4)
    pictures.save(page, folder / "accuracy.png")


def tables(rows, before):
    """Return the table of costs, the path at each accuracy with its cost in the previous version;
    and a short one."""
    price_before = earlier(before, "price", "problem", "deck", "accuracy")
    short = [[problem.label, f"{row['accuracy']:.0e}", row["calculation"], row["milliseconds"],
              row["price"], *whole(row, "nodes", "states"), row["error"], row["estimate"]]
             for problem in problems.ALL for accuracy in _SHOWN
             for row in chosen(rows, problem=problem.name, deck="path", accuracy=accuracy)]
    lines = [[problem.label, f"{row['accuracy']:.0e}", row["price"], row["least_price"],
              price_before(row), *whole(row, "nodes", "states", "products", "factorisations"),
              row["error"], row["estimate"]]
             for problem in problems.ALL
             for row in chosen(rows, problem=problem.name, deck="path")]
    return {"accuracy": (["", "accuracy", "G", "limit", "before", "nodes", "states", "products",
                          "factorisations", "true error", "error_estimate"], lines),
            "price": (["", "accuracy", "ms, calculation", "ms, whole run", "G", "nodes", "states",
                       "true error", "error_estimate"], short)}


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
            # If the cohesive zone is far from resolved, there is no law, and a run takes minutes.
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
    return {"knob": knob, "value": value,
            "spacing_over_neck": run.summary.get("spacing_over_neck", math.nan),
            **_row(problem, "path" if knob != "nodes" else "cycle", 0, run, reference)}


def draw_law(rows, folder):
    page, panels = pictures.figure(1, 3, (10.5, 4.4), sharey=True)
    pictures.dress(panels[0], "edge-locked meshes", "nodes of all meshes",
                   "largest relative error", log="y")
    pictures.dress(panels[1], "reach of the mesh", "reach / $(R z_0)^{1/2}$")
    pictures.dress(panels[2], "uniform grid: pull-off, or load", "nodes")
    for problem, look in zip(_LAW, pictures.LOOKS[1:]):
        for panel, knob in zip(panels, _KNOBS):
            key = _key(knob, problem)
            mine = [row for row in chosen(rows, problem=problem.name, knob=knob, failure="")
                    if row[key] > 1e-14]
            pictures.line(panel, mine, "value", key, color=look["color"], linewidth=1.2)
            pictures.marks(panel, mine, "value", key, look)
            panel.plot([], [], **look, label=problem.label)
    pictures.explain(panels[2], "with a warning", linestyle="none", **pictures.OPEN)
    pictures.guide(panels[1], (16, 90), 5e-4, -5, "reach$^{-5}$")
    pictures.guide(panels[2], (70, 800), 3e-2, -2, "nodes$^{-2}$")
    pictures.plain_ticks(panels[1].xaxis, 20, 30, 50, 90)
    pictures.plain_ticks(panels[2].xaxis, 50, 100, 200, 400, 800)
    pictures.legend(page, 5)
    pictures.save(page, folder / "error_law.png")


def tables_law(rows, before):
    """Return the guide's table: laws fitted to errors above rounding of runs without a warning."""
    def cell(knob, problem):
        key = _key(knob, problem)
        points = [(row["value"], row[key]) for row in chosen(
            rows, problem=problem.name, knob=knob, failure="", warning="") if row[key] > _KNOWN]
        if len(points) < 3:
            return "–"
        x, y = zip(*points)
        if knob == "locked":
            return f"{np.exp(10 * np.polyfit(x, np.log(y), 1)[0]):.2g}"
        return f"{np.polyfit(np.log(x), np.log(y), 1)[0]:.1f}"

    return {"error_law": (["", *(problem.label for problem in _LAW)],
                          [[name, *(cell(knob, problem) for problem in _LAW)]
                           for knob, name in _KNOBS.items()])}


def _key(knob, problem):
    """Return the error that follows a law: others are limited by reach, or by bracketed jumps."""
    if knob != "nodes":
        return "error"
    return "error_pull_off" if problem.adhesive else "error_load"


def _error_and_kind(name, row):
    """Return the true error of a measurement, and the kind of its method."""
    method = row.get("method", "")
    of_nodes = name == "error_law" and row["knob"] == "nodes"
    error = (max(row["error_load"], row["error_pull_off"]) if of_nodes
             else row.get("error_claimed", row["error"]))
    if method.endswith("rule"):
        return error, "the paper's stopping rule"
    if of_nodes or method.startswith(("uniform", "fixed")):
        return error, "fixed grids, with a warning" if row["warning"] else "fixed grids"
    return error, "edge-locked panels"


def honesty(folder):
    """Draw the estimate against the true error for all measurements; return the ratios."""
    measured = {}
    for name in ("accuracy", "error_law", "work_precision"):
        for row in read(folder / f"{name}.csv"):
            error, kind = _error_and_kind(name, row)
            if not row["failure"] and 0 < row["estimate"] < math.inf and error > 0:
                measured.setdefault(kind, []).append((error, row["estimate"]))
    page, panel = pictures.figure(1, 1, (7.0, 5.6))
    pictures.dress(panel, "", "true relative error", "error_estimate")
    ends = (1e-15, 10.0)
    panel.plot(ends, ends, color=pictures.GREY, linewidth=2, label="estimate = error")
    panel.plot(ends, [100 * end for end in ends], **pictures.THIN, label="estimate = 100 × error")
    panel.axvspan(1e-16, _KNOWN, color="#eeeeee", zorder=0, label="reference not known so well")
    lines = []
    for (kind, pairs), look in zip(sorted(measured.items()), pictures.LOOKS):
        panel.plot(*zip(*pairs), **look, linestyle="none", markersize=5, alpha=0.8, label=kind,
                   markerfacecolor="white" if "warning" in kind else look["color"])
        ratio = sorted(estimate / error for error, estimate in pairs if error > _KNOWN)
        if ratio:
            lines.append([kind, f"{len(ratio)}", ratio[0], ratio[len(ratio) // 2], ratio[-1],
                          f"{sum(value < 1 for value in ratio)}",
                          f"{sum(value > 100 for value in ratio)}"])
    panel.set(xlim=(1e-15, 10), ylim=(1e-14, 1e3))
    pictures.legend(page)
    pictures.save(page, folder / "estimate.png")
    return {"estimate": (["", "runs", "least", "median", "largest", "below 1", "above 100"], lines)}
