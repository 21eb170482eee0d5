"""The table and the picture of the ladder of methods, from the measurements of `methods`."""

import pages
import pictures
from tables import chosen

# Method, depth, ratio and name of the methods in the table; those in the picture.
_SHOWN = (
    ("mixing", "", "", "mixing"), ("anderson_mixing", 5, 0.2, "anderson_mixing, depth 5"),
    ("anderson_mixing", 10, 0.2, "anderson_mixing, 10"),
    ("anderson_mixing", 20, 0.2, "anderson_mixing, 20"),
    ("anderson", 0, "", "frozen Jacobian alone"), ("anderson", 1, "", "anderson, depth 1"),
    ("anderson", 5, "", "anderson, 5"), ("anderson", 20, "", "anderson, 20"),
    ("newton", "", "", "newton"))
_DRAWN = [_SHOWN[place] for place in (0, 1, 2, 3, 4, 6, 8)]
# Cycles in the picture, and the look of each.
_CYCLES = {"mixing": 0, "anderson_mixing, depth 5": 1, "anderson_mixing, 10": 2,
           "anderson_mixing, 20": 3, "anderson": 5, "newton": 6, "default": 7}


def lines(rows, cycles):
    """Return what stands between the marks of docs/records/ladder.md."""
    return ["", *_table(rows), *_cycle_table(cycles), ""]


def _table(rows):
    """Return the lines of the table of states: products, factorisations in brackets, a note where
    states are lost."""
    cases = list(dict.fromkeys((row["law"], row["strength"]) for row in rows))
    names = [f"{'σ' if law == 'lennard_jones' else 'Λ'} = {strength:g}" for law, strength in cases]
    found = []
    for mesh, title in (("uniform", f"Uniform, {_nodes(rows):.0f} nodes"),
                        ("edge", "Panels about the edge")):
        of_case = [chosen(rows, mesh=mesh, law=law, strength=strength) for law, strength in cases]
        first = [mine[0] for mine in of_case]
        cells = [["smallest eigenvalue", *(f"{row['least']:.2g}" for row in first)],
                 ["largest eigenvalue", *(_short(row["largest"]) for row in first)]]
        if mesh == "uniform":
            cells.insert(0, ["spacing over the cohesive zone", *(
                _short(row["resolution"]) if row["resolution"] else "" for row in first)])
        for method, depth, ratio, name in _SHOWN:
            cells.append([name, *(
                _cell(chosen(mine, method=method, depth=depth, ratio=ratio)[0])
                for mine in of_case)])
        found += [*pages.table([title, *names], cells), ""]
    return found


def _cycle_table(cycles):
    """Return the lines of the table of cycles: milliseconds, products in brackets."""
    sigmas = list(dict.fromkeys(row["strength"] for row in cycles))
    cells = []
    for name in dict.fromkeys(row["method"] for row in cycles):
        mine = {row["strength"]: row for row in chosen(cycles, method=name)}
        cells.append([name, *(_cycle_cell(mine[sigma]) if sigma in mine else "–"
                              for sigma in sigmas)])
    return pages.table([f"{_title(cycles)}, ms (products)",
                        *(f"σ = {sigma:g}" for sigma in sigmas)], cells)


def draw(rows, cycles, path):
    """Draw products for a state and times of cycles against adhesion."""
    page, panels = pictures.figure(1, 3, (12.0, 4.4))
    for panel, mesh, title in (
            (panels[0], "uniform", f"one state, {_nodes(rows):.0f} equal steps of r"),
            (panels[1], "edge", "one state, panels about the edge")):
        pictures.dress(panel, title, "σ", "products for a state")
        for (method, depth, ratio, label), look in zip(_DRAWN, pictures.LOOKS):
            mine = chosen(rows, mesh=mesh, law="lennard_jones", method=method, depth=depth,
                          ratio=ratio)
            # Where no state converged, the number is NaN, and the line is interrupted.
            panel.plot([row["strength"] for row in mine], [row["products"] for row in mine], **look,
                       label=label, markersize=5)
            lost = [row for row in mine if row["converged"] < row["states"]]
            panel.plot([row["strength"] for row in lost], [row["products"] for row in lost],
                       linestyle="none", **look, markerfacecolor="white", markersize=7)
        panel.set_ylim(2, 6000)
    pictures.dress(panels[2], f"a {_title(cycles)}", "σ", "time [ms]")
    for name, place in _CYCLES.items():
        mine = chosen(cycles, method=name)
        label = {"default": "default: edge-locked, along the path"}.get(name)
        panels[2].plot([row["strength"] for row in mine], [row["milliseconds"] for row in mine],
                       **pictures.LOOKS[place], label=label, markersize=5)
    pictures.explain(panels[0], "some states lost", linestyle="none", **pictures.OPEN)
    pictures.legend(page, 5)
    pictures.save(page, path)


def _nodes(rows):
    return chosen(rows, mesh="uniform")[0]["nodes"]


def _title(cycles):
    return f"cycle of {cycles[0]['states']:.0f} states"


def _short(value):
    return f"{value:.2g}".replace("e+0", "e")


def _cell(row):
    if not row["converged"]:
        return "–"
    text = f"{row['products']:.0f}"
    if row["factorisations"]:
        text += f" ({row['factorisations']:.0f})"
    return text + _lost(row)


def _cycle_cell(row):
    digits = 0 if row["milliseconds"] > 10 else 1
    return f"{row['milliseconds']:.{digits}f} ({row['products']:.0f})" + _lost(row)


def _lost(row):
    if row["converged"] < row["states"]:
        return f", {row['converged']:.0f} of {row['states']:.0f}"
    return ""
