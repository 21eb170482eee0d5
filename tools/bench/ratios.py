"""The cost model: what is claimed of time, products and factorisations, and what is measured."""

import problems
import scaling


def measure(program, quick, say):
    """Return one row for every claim: quantity, measured, limit, and whether it holds."""
    rows = []

    def claim(quantity, case, value, limit, least=False):
        holds = value >= limit if least else value <= limit
        rows.append({"quantity": quantity, "case": case, "measured": value, "limit": limit,
                     "sense": "at least" if least else "at most",
                     "holds": "yes" if holds else "no"})

    for row in scaling.limits(program, (200, 400) if quick else (200, 400, 800, 1500)):
        case = f"{row['nodes']:.0f} nodes"
        claim("mixing iteration / DGEMV", case, row["mixing"] / row["dgemv"], 1.3)
        claim("Anderson iteration / DGEMV", case, row["anderson"] / row["dgemv"], 1.3)
        claim("Anderson iteration / (DGEMV + DGETRS)", case,
              row["anderson"] / (row["dgemv"] + row["dgetrs"]), 1.3)
        claim("Newton step / DGESV", case, row["newton"] / row["dgesv"], 1.5)

    path, wide = problems.ADHESIVE[2], problems.ADHESIVE[3]
    cycles = {
        "Fig. 10(c) cycle": problems.FIGURE_10C + "&numerics accuracy = 1e-6 /\n",
        "σ = 8.7 cycle, 500 states": path.cycle("accuracy = 1e-6", path.step / 5),
        "σ = 1000 cycle, 500 states": wide.cycle("accuracy = 1e-6", wide.step / 5),
    }
    paths = {
        "σ = 8.7 path": path.path("accuracy = 1e-6"),
        "σ = 1000 path": wide.path("accuracy = 1e-6"),
    }
    runs = program.best_of(3 if quick else 15, {**cycles, **paths})
    for case, limit in (("Fig. 10(c) cycle", 0.2), ("σ = 8.7 cycle, 500 states", 0.2),
                        ("σ = 1000 cycle, 500 states", 0.5), ("σ = 8.7 path", 0.1),
                        ("σ = 1000 path", 0.5)):
        claim("seconds, one core", case, runs[case].seconds, limit)
        claim("seconds without the error estimate", case, runs[case].seconds_of_run, limit)
        claim("kernel assembly / run", case, runs[case].kernel_seconds / runs[case].seconds, 0.2)
    for case in cycles:
        run = runs[case]
        claim("operator products a state, median", case, run.median_products, 6.0)
        claim("operator products a state, mean", case, run.products / run.states, 6.0)
        claim("states a factorisation", case, run.states / run.factorisations, 20.0, least=True)
    say(f"{sum(row['holds'] == 'yes' for row in rows)} of {len(rows)} hold")
    return rows


def tables(rows):
    """Return the guide's table."""
    return {"ratios": (
        ["", "", "measured", "goal", "holds"],
        [[row["quantity"], row["case"], row["measured"], f"{row['sense']} {row['limit']:g}",
          row["holds"]] for row in rows])}
