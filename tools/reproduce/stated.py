"""What the program says of its numbers on the paper's grids, beside what is right."""

import report

# Decks, and the deck that has the converged numbers.
CASES = {
    "fig06_uniform": "fig06_converged", "fig06_paper": "fig06_converged",
    "fig10a_paper": "fig10a_converged", "fig10b_paper": "fig10b_converged",
    "fig10c_uniform": "fig10c_converged"}
DECKS = (*CASES, *dict.fromkeys(CASES.values()))
# Numbers, their names, units and factors, and the ends of the names of their errors.
NUMBERS = {
    "max_tension": ("largest tension", "µN", 1e6), "jump_in_h0": ("snap-in", "nm", 1e9),
    "jump_out_h0": ("snap-off", "nm", 1e9), "energy_lost": ("energy lost", "fJ", 1e15)}
ERRORS = ("_error", "_uncertainty")
# What warnings of numbers begin with or contain, and how the table says it.
SAID = {
    "not convergence": "not converged", "could not be estimated": "error unknown",
    "error is estimated": "less accurate than asked for", "under-resolved": "under-resolved",
    "did not converge": "states did not converge", "is not known": "a jump is not known"}


def numbers(runs):
    rows = [row for deck, right in CASES.items()
            for row in rows_of(deck, runs[deck].summary, runs[right].summary)]
    outside = [row for row in rows if row[-1] != "within"]
    return {"table": "\n".join("| " + " | ".join(map(report.escaped, row)) + " |" for row in rows),
            "count": len(rows), "outside": len(outside),
            "silent": sum(row[-2] == "nothing" for row in outside)}


def rows_of(deck, summary, right):
    """The rows of a deck: number, its error, what is right, what is said, whether it is within."""
    said = warnings_of(summary)
    found = []
    for key, (name, unit, factor) in NUMBERS.items():
        if not (key in right and key in summary):
            continue
        errors = [summary[key + end] for end in ERRORS if key + end in summary]
        value, error, exact = (factor * one for one in (summary[key], errors[0], right[key]))
        within = "within" if abs(value - exact) <= error else f"off by {abs(value - exact):.3g}"
        found.append([deck, f"{name} [{unit}]", f"{value:.6g}", f"{error:.2g}", f"{exact:.6g}",
                      said, within])
    return found


def warnings_of(summary):
    """The warnings about numbers, in short."""
    texts = summary.get("warnings", [])
    texts = [texts] if isinstance(texts, str) else texts
    short = [name for part, name in SAID.items() if any(part in text for text in texts)]
    return ", ".join(short) or "nothing"
