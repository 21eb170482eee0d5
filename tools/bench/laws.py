"""The cost of laws and shapes other than the paper's, and of experiments along a path.

For laws and shapes it is the cost of the paths of examples, for experiments that of whole examples;
calculation alone.
"""

import math
import shutil

import numpy as np
import pictures
import problems
from tables import chosen, earlier

ACCURACIES = (1e-3, 1e-6, 1e-9)
# Accuracy of the reference of all runs; largest number of seconds of a run.
_REFERENCE, _PATIENCE = 1e-10, 60
_EXAMPLES = ("van_der_waals", "lennard_jones_10_4", "morse", "hydration", "hydrophobic", "dlvo",
             "depletion", "dugdale", "capillary", "steric", "structural", "tabulated", "sphere",
             "cone", "punch", "profile")
# The first is a cycle.
_EXPERIMENTS = ("van_der_waals", "table", "fixed_load", "device", "regime", "sensitivity", "fit")
# A number does not test its estimate if the reference is hardly better.
_BETTER = 10


def measure(program, quick, say):
    """Return one row for every path of a problem and accuracy."""
    asked = [problems.in_two_parts(problem) for problem in problems.ADHESIVE]
    asked += [problems.example(name) for name in _EXAMPLES]
    _lay_out_data(program)
    rows = []
    for problem in asked:
        reference = (program.reference(problem) if problem.sigma is not None else
                     program.run(problem.path(f"accuracy = {_REFERENCE}"), _PATIENCE))
        for accuracy, run in _runs(program, quick, {
                accuracy: problem.path(f"accuracy = {accuracy}") for accuracy in ACCURACIES}):
            errors = run.errors(reference, problem.length)
            rows.append(_row(problem.label, accuracy, run)
                        | {"error": max(errors.values(), default=math.nan)})
            say(f"{problem.label}, {accuracy:g}: {rows[-1]['price']:.3g} G")
    return rows


def measure_experiments(program, quick, say):
    _lay_out_data(program)
    rows = []
    for name in _EXPERIMENTS:
        reference = program.run(problems.experiment(name, _REFERENCE), _PATIENCE)
        for accuracy, run in _runs(program, quick, {
                accuracy: problems.experiment(name, accuracy) for accuracy in ACCURACIES}):
            rows.append(_row(name, accuracy, run) | {"ratio": _error_over_estimate(run, reference)})
            say(f"{name}, {accuracy:g}: {rows[-1]['price']:.3g} G")
    return rows


def draw(rows, folder):
    """Draw the cost of each law and shape at each accuracy, the cheapest at the top."""
    middle = chosen(rows, accuracy=1e-6)
    names = [row["problem"] for row in sorted(middle, key=lambda row: -row["price"])]
    page, panel = pictures.figure(1, 1, (8.0, 0.28 * len(names) + 1.4))
    pictures.dress(panel, "", "time of a path [G]", log="x")
    for accuracy, look in zip(ACCURACIES, pictures.LOOKS):
        for reached in (True, False):
            these = [row for row in chosen(rows, accuracy=accuracy)
                     if (row["error"] <= accuracy) == reached]
            panel.plot([row["price"] for row in these],
                       [names.index(row["problem"]) for row in these], **look, linestyle="none",
                       markerfacecolor=look["color"] if reached else "white",
                       label=f"accuracy {accuracy:g}" if reached else None)
    pictures.explain(panel, "accuracy missed, or not known", linestyle="none", **pictures.OPEN)
    panel.set_yticks(range(len(names)), names)
    pictures.legend(page, 4)
    pictures.save(page, folder / "laws.png")


def tables(rows, before):
    """Return the whole table, and one with a line for each law and shape."""
    return {"laws": _price_list(rows, before, "error", "true error"),
            "price_of_laws": _short_list(rows, "error", "true error at 1e-6")}


def tables_experiments(rows, before):
    return {"experiments": _price_list(rows, before, "ratio", "true error / estimate, largest"),
            "price_of_experiments": _short_list(rows, "estimate", "estimated error at 1e-6")}


def _price_list(rows, before, judged, title):
    price_before = earlier(before, "price", "problem", "accuracy")
    return (
        ["", "accuracy", "G, calculation", "before", "nodes", "states", "factorisations",
         "error_estimate", title],
        [[row["problem"], f"{row['accuracy']:.0e}", row["price"], price_before(row),
          *(f"{row[key]:.0f}" if row[key] else math.nan
            for key in ("nodes", "states", "factorisations")), row["estimate"], row[judged]]
         for row in rows])


def _short_list(rows, judged, title):
    """Return a table with the time at each accuracy, and one number at 1e-6."""
    lines = []
    for name in dict.fromkeys(row["problem"] for row in rows):
        of_name = {row["accuracy"]: row for row in chosen(rows, problem=name)}
        lines.append([name, *(of_name[accuracy]["price"] for accuracy in ACCURACIES),
                      of_name[1e-6][judged]])
    return (["G at accuracy", *(f"{accuracy:.0e}" for accuracy in ACCURACIES), title], lines)


def _runs(program, quick, decks):
    return program.best_of(3 if quick else 5, decks, _PATIENCE, enough=0.3).items()


def _row(name, accuracy, run):
    # A fit, which has many paths, does not report its parts.
    return {"problem": name, "accuracy": accuracy,
            "price": run.calculation / run.unit if run.calculation else run.price,
            "nodes": run.nodes, "states": run.states, "factorisations": run.factorisations,
            "estimate": run.estimate}


def _lay_out_data(program):
    """Put the data files of decks into the folder of the runs."""
    for path in problems.EXAMPLES.iterdir():
        if path.suffix in (".csv", ".txt"):
            shutil.copy(path, program.scratch)


def _error_over_estimate(run, reference):
    """Return the largest error of a number over its estimate, if the reference is good enough."""
    ratios = []
    for key in reference.summary:
        if f"{key}_error" in reference.summary and f"{key}_error" in run.summary:
            values, exact, estimates, least = (
                np.ravel(summary[name]) for name in (key, f"{key}_error")
                for summary in (run.summary, reference.summary))
            ratios += [abs(value - right) / estimate
                       for value, right, estimate, known in zip(values, exact, estimates, least)
                       if estimate > _BETTER * known > 0]
    return max(ratios, default=math.nan)
