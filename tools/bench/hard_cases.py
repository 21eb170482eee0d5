"""Hard cases: cycles of Lennard-Jones bodies from weak to very strong adhesion, by each method.

A scene is lost if the run did not end in time, did not converge, or has no jump where there is one,
or one where there is none. Errors are those of pull-off and load at the turning point, against the
independent solution; the places of jumps are brackets on grids that are fixed in space.
"""

import math
import subprocess

import numpy as np
import pictures
import problems
from tables import chosen

# Name, settings of &numerics, and words that the program must know for them.
METHODS = (
    ("auto", "", ()),
    ("Newton, mesh locked to the edge", "method = 'newton'", ("newton",)),
    ("Anderson, uniform grid", "grid = 'uniform', nodes = 400, method = 'anderson'", ("anderson",)),
    ("Newton, uniform grid", "grid = 'uniform', nodes = 400, method = 'newton'", ("newton",)),
    ("Anderson mixing, mesh locked to the edge", "method = 'anderson_mixing', grid = 'auto'",
     ("anderson_mixing",)),
    ("Anderson mixing, uniform grid", "method = 'anderson_mixing', grid = 'uniform', nodes = 400",
     ("anderson_mixing",)),
    ("mixing, uniform grid", "method = 'mixing', nodes = 400", ("mixing",)),
    ("mixing, the paper's rule", "method = 'mixing', nodes = 400, "
     "convergence = 'displacement_change'", ("mixing",)),
)
# Seconds after which a run is given up.
_PATIENCE = {True: 1.0, False: 4.0}
_CLAIMED = ("pull_off", "load")


def measure(program, quick, say):
    """Return one row for every strength of adhesion and method that the program knows."""
    words = subprocess.run([str(program.snapin), "--keys", "numerics.method"], check=True,
                           capture_output=True, text=True).stdout
    known = [method for method in METHODS if all(f"'{word}'" in words for word in method[2])]
    rows = []
    for sigma in np.geomspace(1e-4, 1e4, 5 if quick else 17):
        problem = problems.lennard_jones(float(f"{sigma:.3g}"))
        true = program.reference(problem)
        for name, numerics, _ in known:
            run = program.best_of(1 if quick else 3, {0: problem.cycle(numerics)},
                                  _PATIENCE[quick], enough=0.3)[0]
            rows.append(_row(problem, name, run, true))
        say(f"{problem.label}: " + ", ".join(
            row["method"] for row in rows[-len(known):] if row["failure"]))
    return rows


def _row(problem, name, run, true):
    errors = run.errors(true, problem.length)
    failure = run.failure
    for key in ("jump_in", "jump_out"):
        if not failure and (key in run.values) != (key in true.values):
            failure = f"{'no' if key in true.values else 'a'} {key}"
    return {"sigma": problem.sigma, "method": name,
            "milliseconds": 1e3 * (run.calculation if run.calculation > 0 else run.seconds),
            "error": max((errors.get(key, math.nan) for key in _CLAIMED), default=math.nan),
            "estimate": run.estimate, **run.cells("products", "factorisations"),
            # That strains are large is no matter of the method.
            "warning": "; ".join(text for text in run.summary.get("warnings", [])
                                 if not text.startswith("beyond the model")),
            "failure": failure}


def draw(rows, folder):
    """Draw error, time and lost scenes of each method against the strength of adhesion."""
    page, (errors, times, lost) = pictures.figure(
        3, 1, (8.0, 9.6), sharex=True, height_ratios=(3, 3, 1.4))
    pictures.dress(errors, "", "", "error of pull-off and load")
    pictures.dress(times, "", "", "time [ms]")
    pictures.dress(lost, "", "strength of adhesion $\\sigma$", "", log="x")
    names = list(dict.fromkeys(row["method"] for row in rows))
    for place, (name, look) in enumerate(zip(names, pictures.LOOKS)):
        mine = chosen(rows, method=name)
        done = [row for row in mine if not row["failure"]]
        for panel, key in ((errors, "error"), (times, "milliseconds")):
            pictures.line(panel, done, "sigma", key, color=look["color"], linewidth=1.0)
            pictures.marks(panel, done, "sigma", key, look, markersize=5)
            panel.plot([], [], **look, label=name, linewidth=1.0)
        lost.plot([row["sigma"] for row in done], [place] * len(done), linestyle="none", **look,
                  markersize=4)
        lost.plot([row["sigma"] for row in mine if row["failure"]],
                  [place] * (len(mine) - len(done)), "x", color=look["color"], markersize=7)
    lost.set_yticks(range(len(names)), names, fontsize=8)
    lost.set_ylim(len(names) - 0.5, -0.5)
    pictures.explain(errors, "with a warning", linestyle="none", **pictures.OPEN)
    pictures.explain(lost, "lost", "x", linestyle="none")
    pictures.legend(page, 3)
    pictures.save(page, folder / "hard_cases.png")


def tables(rows, before):
    """Return for each method the lost scenes, the largest error and the times."""
    lines = []
    for name in dict.fromkeys(row["method"] for row in rows):
        mine = chosen(rows, method=name)
        done = [row for row in mine if not row["failure"]]
        sure = [row for row in done if not row["warning"]]
        good = sum(row["error"] <= 1e-3 for row in done)
        lines.append([
            name, str(len(mine)), str(len(mine) - len(done)), str(good),
            max((row["error"] for row in done), default=math.nan),
            max((row["error"] for row in sure), default=math.nan),
            min((row["milliseconds"] for row in done), default=math.nan),
            max((row["milliseconds"] for row in done), default=math.nan)])
    return {"hard_cases": (
        ["", "scenes", "lost", "errors below 1e-3", "largest error",
         "the same without a warning", "least ms", "most ms"], lines)}
