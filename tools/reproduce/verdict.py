"""The results of the paper that hold, and those due to its grid or its stopping rule."""

import draws
import fig03
import fig05
import numpy as np
import penetrations

DECKS = ("fig03", *fig05.DECKS, "fig06_converged", "fig06_uniform", "fig06_paper",
         "fig10c_converged", "fig10c_uniform", "fig10c_paper")


def numbers(runs):
    weak, adhesion = runs[fig05.DECKS[2]].summary, fig05.numbers(runs)
    kinds = ("converged", "uniform")
    low, grid = (runs[f"fig06_{kind}"].summary["max_tension"] for kind in kinds)
    pulls = {kind: penetrations.over_jkr(runs[f"fig10c_{kind}"]) for kind in kinds}
    rule = runs.draws("fig10c_paper")
    paper = np.array([penetrations.over_jkr(results) for results in rule])
    return {
        "hertz": -fig03.at(fig03.errors(runs), "hertz", 1e4),
        "jkr": max(abs(adhesion[f"off_{i}"]) for i in range(3)),
        "weak": weak["max_tension"] / weak["jkr_pull_off"],
        "grid_low": 100 * abs(grid / low - 1),
        "spacing": runs["fig10c_uniform"].summary["spacing_over_neck"],
        **{kind: each[-1] for kind, each in pulls.items()},
        **{f"{kind}_spread": draws.within(float(np.ptp(each) / np.mean(each)))
           for kind, each in pulls.items()},
        "paper": draws.several(paper.T), "count": len(rule),
        "residual": draws.ranged([results.summary["worst_residual"] for results in rule], 0),
        "shallowest": pulls["converged"][0],
        "paper_ends": "; ".join(map(draws.ranged, paper.T[[0, -1]]))}
