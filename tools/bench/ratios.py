"""The cost model: goals for time, products and factorisations, and the measured values."""

import math

import problems
from tables import earlier

# sigma, the goal for its path [G], steps of the loading of its cycle, and the goal for that.
_GOALS = ((0.0087, 3, 0, 0), (0.87, 3, 0, 0), (8.7, 4, 350, 10), (1000.0, 10, 500, 20))


def measure(program, quick, say):
    """Return one row for every claim: measured, limit, goal, and whether it holds."""
    rows = []

    def claim(quantity, case, value, goal, limit=math.nan):
        rows.append({"quantity": quantity, "case": case, "measured": value, "limit": limit,
                     "goal": goal,
                     "holds": "–" if math.isnan(goal) else "yes" if value <= goal else "no"})

    for row in program.gauge.pieces((400,) if quick else (200, 400, 800)):
        case = f"{row['nodes']:.0f} nodes"
        claim("mixing iteration / DGEMV", case, row["mixing"] / row["dgemv"], 1.3)
        claim("Anderson iteration / DGEMV", case, row["anderson"] / row["dgemv"], 1.3)
        claim("Anderson iteration / (DGEMV + DGETRS)", case,
              row["anderson"] / (row["dgemv"] + row["dgetrs"]), 1.3)
        claim("Newton step / DGESV", case, row["newton"] / row["dgesv"], 1.5)

    cases = {}
    for sigma, path_goal, steps, cycle_goal in _GOALS:
        problem = problems.lennard_jones(sigma)
        # The goal for three digits is half of that for six.
        for numerics, part, at in (("accuracy = 1e-6", 1, ""),
                                   ("accuracy = 1e-3", 0.5, ", accuracy 1e-3")):
            cases[f"{problem.label} path{at}"] = part * path_goal, problem.path(numerics)
            if steps:
                cases[f"{problem.label} cycle, {2 * steps + 2} states{at}"] = (
                    part * cycle_goal,
                    problem.cycle(numerics, (problem.start - problem.turn) / steps))
    cases["Fig. 10(c) cycle"] = 10, problems.FIGURE_10C + "&numerics accuracy = 1e-6 /\n"
    runs = program.best_of(3 if quick else 9, {case: deck for case, (_, deck) in cases.items()})
    for case, (goal, _) in cases.items():
        run = runs[case]
        # For a path the goal is for the calculation, for a cycle for the files too.
        if "path" in case:
            claim("G, calculation", case, run.calculation / run.unit, goal, run.least_price)
        claim("G, whole run", case, run.price, math.nan if "path" in case else goal,
              run.least_price)
        claim("kernel assembly / run", case, run.kernel_seconds / run.wall, 0.2)
        if "cycle" in case:
            claim("operator products a state, mean", case, run.products / run.states, 6.0)
            # Factors are renewed as soon as that costs no more than further iterations: no goal.
            claim("states a factorisation", case, run.states / run.factorisations, math.nan)
    start = program.start_up()
    claim("G, whole run", "start alone (snapin --version)", start, 2)
    # A user waits here: elapsed time.
    deck = problems.lennard_jones(0.87).path("accuracy = 1e-6")
    claim("G, elapsed", "σ = 0.87 path from Python", program.from_python(deck), 5)
    scenes = 100 if quick else 1000
    run = program.best_of(1, {0: problems.sweep_of_paths(scenes)}, cap=300)[0]
    claim("G a scene", f"sweep of {scenes} paths, σ = 0.001 to 1000", run.price / scenes, 10,
          run.least_price / scenes)
    say(f"{scenes / run.seconds:.0f} scenes a second and core")
    goals = [row["holds"] for row in rows if not math.isnan(row["goal"])]
    say(f"{goals.count('yes')} of {len(goals)} hold")
    return rows


def tables(rows, before):
    measured_before = earlier(before, "measured", "quantity", "case")
    return {"ratios": (
        ["", "", "measured", "limit", "before", "goal", "holds"],
        [[row["quantity"], row["case"], row["measured"], row["limit"], measured_before(row),
          "–" if math.isnan(row["goal"]) else f"at most {row['goal']:g}", row["holds"]]
         for row in rows])}
