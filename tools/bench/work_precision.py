"""Error against cost, for every iteration on every grid."""

import math

import pictures
import problems
from program import QUANTITIES, Run
from tables import chosen

NAMES = {"pull_off": "pull-off", "jump_in": "jump-in $h_0$", "load": "load at fixed $h_0$"}

_ACCURACY = (1e-2, 1e-4, 1e-6, 1e-8, 1e-10)
# A run expected to take much longer than this, by the time of the last run on a coarser grid, is
# not started.
_CAP = {True: 2.0, False: 5.0}

# Name, settings of &numerics, the parameter of the cost (nodes or accuracy), and the power of the
# nodes in the cost of a step.
_METHODS = (
    ("uniform, mixing, paper's rule",
     "grid = 'uniform', method = 'mixing', convergence = 'displacement_change'", "nodes", 2),
    ("uniform, mixing", "grid = 'uniform', method = 'mixing'", "nodes", 2),
    ("uniform, Anderson", "grid = 'uniform', method = 'anderson'", "nodes", 3),
    ("uniform, Newton", "grid = 'uniform', method = 'newton'", "nodes", 3),
    ("fixed panels, mixing", "grid = 'panels', method = 'mixing'", "accuracy", 0),
    ("edge-locked, Anderson", "grid = 'panels', method = 'anderson'", "accuracy", 0),
    ("edge-locked, Newton", "grid = 'panels', method = 'newton'", "accuracy", 0),
    ("whole path", "", "accuracy", 0),
)


def measure(program, quick, say):
    """Return one row for every problem, method and fineness."""
    fineness = {"nodes": (50, 100) if quick else (100, 200, 400, 800),
                "accuracy": _ACCURACY[1::2] if quick else _ACCURACY}
    rows = []
    for problem in problems.ALL:
        reference = program.reference(problem)
        for method, numerics, knob, power in _METHODS:
            make = problem.path if method == "whole path" else problem.cycle
            decks = {value: make(f"{numerics}{',' if numerics else ''} {knob} = {value}")
                     for value in fineness[knob]}
            mine = [_row(problem, method, knob, value, run, reference)
                    for value, run in _runs(program, decks, power, quick)]
            say(f"{problem.label}: {method}: {', '.join(map(_outcome, mine))}")
            rows += mine
    return rows


def _runs(program, decks, power, quick):
    """Yield the run of each deck by its fineness, unless the one before shows that it would not
    finish."""
    cap, before, run = _CAP[quick], None, None
    for value, deck in decks.items():
        if run is not None and (run.failure.startswith("not ") or
                                run.seconds * (value / before) ** power > 2 * cap):
            run = Run(failure="not run: a coarser one took "
                      f"{'all its time' if run.failure else f'{run.seconds:.0f} s'}")
        else:
            run = program.best_of(1 if quick else 3, {0: deck}, cap, enough=0.5)[0]
        before = value
        yield value, run


def _row(problem, method, knob, value, run, reference):
    errors = run.errors(reference, problem.length)
    # The numbers of the error estimate: on fixed grids jumps are bracketed and reported separately.
    fixed = method.startswith(("uniform", "fixed"))
    claimed = [error for key, error in errors.items() if not (fixed and key.startswith("jump"))]
    errors = {key: errors[key] for key in QUANTITIES if key in errors}
    known = [error for error in errors.values() if error == error]
    lost = [NAMES[key].replace("$", "") for key, error in errors.items() if error != error]
    failure = run.failure
    if lost and not failure:
        failure = f"found no {' and no '.join(lost)}"
    return {
        "problem": problem.name, "method": method, "knob": knob, "value": value,
        "price": run.price_of_run if run.states else run.price,
        **run.cells("least_price", "products", "factorisations", "states", "nodes"),
        **{f"error_{key}": errors.get(key, math.nan) for key in QUANTITIES},
        "error": max(known, default=math.nan), "error_claimed": max(claimed, default=math.nan),
        "estimate": run.estimate, "failure": failure, "warning": run.warning}


def _outcome(row):
    return "failed" if row["failure"] else f"{row['error']:.0e} for {row['price']:.2g} G"


def draw(rows, folder):
    """Draw the largest error against time and products, and each error against time."""
    for cost, unit in (("price", "time [G]"), ("products", "operator products")):
        page, panels = pictures.figure(3, 2, (9.0, 11.0), sharey=True)
        for panel, problem in zip(panels.flat, problems.ALL):
            pictures.dress(panel, problem.label, unit, "")
            _panel(panel, rows, problem, "error", cost)
        for panel in panels[:, 0]:
            panel.set_ylabel("largest relative error")
        _finish(page, panels[0, 0])
        pictures.save(page, folder / f"work_precision_{cost}.png")
    page, panels = pictures.figure(3, 3, (9.6, 10.0), sharex=True, sharey="row")
    for column, problem in enumerate(problems.ADHESIVE[1:]):
        for row, key in enumerate(QUANTITIES):
            pictures.dress(panels[row, column], problem.label if row == 0 else "",
                           "time [G]" if row == 2 else "")
            _panel(panels[row, column], rows, problem, f"error_{key}", "price")
    for row, key in enumerate(QUANTITIES):
        panels[row, 0].set_ylabel(f"error of {NAMES[key]}")
    _finish(page, panels[0, 0])
    pictures.save(page, folder / "work_precision_quantities.png")


def _panel(panel, rows, problem, key, cost):
    """Draw one problem: filled marks are valid runs, open marks have a warning, crosses failed."""
    for place, ((method, *_), look) in enumerate(zip(_METHODS, pictures.LOOKS)):
        mine = chosen(rows, problem=problem.name, method=method)
        done = [row for row in mine if not row["failure"] and row[key] == row[key]]
        pictures.line(panel, done, cost, key, 1e-13, color=look["color"], linewidth=1.0, alpha=0.7)
        pictures.marks(panel, done, cost, key, look, 1e-13, markersize=6)
        panel.plot([], [], **look, label=method, linewidth=1.0)
        failed = [row[cost] for row in mine if row["failure"] and row[cost] > 0]
        # Runs stopped at the same time would coincide.
        panel.plot(failed, [1e2 * 6.0**place] * len(failed), "x", color=look["color"], markersize=7,
                   markeredgewidth=1.8)
    panel.axhline(30, color=pictures.GREY, linewidth=0.8)
    panel.set_ylim(5e-14, 1e9)
    panel.set_yticks([10.0**k for k in range(-13, 2, 2)])


def _finish(page, panel):
    """Explain the marks below the panels."""
    pictures.explain(panel, "with a warning", linestyle="none", **pictures.OPEN)
    pictures.explain(panel, "failed (above the line)", "x", markersize=8, markeredgewidth=2,
                     linestyle="none")
    pictures.legend(page)


def tables(rows, before):
    """Return the guide's table: the cheapest run of each method within an error of 1e-3."""
    def cheapest(method, problem):
        prices = [row["price"] for row in chosen(rows, problem=problem.name, method=method,
                                                 failure="") if row["error"] <= 1e-3]
        return f"{min(prices):.2g}" if prices else "–"

    return {"work_precision": (
        ["G", *(problem.label for problem in problems.ALL)],
        [[method, *(cheapest(method, problem) for problem in problems.ALL)]
         for method, *_ in _METHODS])}
