"""The price of other laws and shapes than the paper's: paths of examples, calculation alone."""

import math

import problems

ACCURACIES = (1e-3, 1e-6)
# Runs are judged against this accuracy, which the dear ones still reach in seconds.
_REFERENCE = 1e-9
_EXAMPLES = ("dlvo", "hydrophobic", "dugdale", "capillary", "sphere", "cone")


def measure(program, quick, say):
    """Return one row for every problem and accuracy."""
    asked = [problems.in_two_parts(problem) for problem in problems.ADHESIVE]
    asked += [problems.example(name) for name in _EXAMPLES]
    rows = []
    for problem in asked:
        reference = program.run(problem.path(f"accuracy = {_REFERENCE}"))
        decks = {accuracy: problem.path(f"accuracy = {accuracy}") for accuracy in ACCURACIES}
        runs = program.best_of(3 if quick else 5, decks, enough=0.3)
        for accuracy, run in runs.items():
            errors = run.errors(reference, problem.length)
            parts = run.kernel_seconds + run.solve_seconds + run.estimate_seconds
            rows.append({
                "problem": problem.label, "accuracy": accuracy,
                "price": run.price * parts / run.wall, "nodes": run.nodes, "states": run.states,
                "factorisations": run.factorisations,
                "error": max(errors.values(), default=math.nan), "estimate": run.estimate})
            say(f"{problem.label}, {accuracy:g}: {rows[-1]['price']:.3g} G")
    return rows


def tables(rows, before):
    """Return the price list."""
    earlier = {(row["problem"], row["accuracy"]): row["price"] for row in before}
    return {"laws": (
        ["", "accuracy", "G, calculation", "before", "nodes", "states", "factorisations",
         "true error", "error_estimate"],
        [[row["problem"], f"{row['accuracy']:.0e}", row["price"],
          earlier.get((row["problem"], row["accuracy"]), math.nan), f"{row['nodes']:.0f}",
          f"{row['states']:.0f}", f"{row['factorisations']:.0f}", row["error"], row["estimate"]]
         for row in rows])}
