"""Fits of many curves over the places of the curves: work of adhesion, modulus, contact height,
Tabor's parameter, verdict.

    snapin-plot curves results/map
    snapin-plot curves results/map --value fitted_reduced_modulus
    snapin-plot curves results/map --worst 5

Places are measurement.x and measurement.y of the sweep, or with `--columns` the order of the
curves. Outliers, and fits that do not describe their curve, are grey. `--worst` prints the curves
whose fits are worst, with what is said of them.
"""

from ..arguments import SnapinError
from ..curve_maps import draw_maps
from ..many_curves import worst_of
from ..results import ResultsError, read_results
from .drawing import Picture, entitle, has_fits, title_of


def draw_curve_map(folder, value=(), columns=None, worst=0):
    """Return a figure of maps of the sweep in `folder`; print the `worst` curves."""
    result = read_results(folder)
    table = result.tables.get("sweep")
    if table is None or "verdict" not in table.dtype.names:
        raise ResultsError(f"{folder} has no fits of many curves; map.py draws other sweeps")
    for i in worst_of(table, worst):
        row = dict(zip(table.dtype.names, table[i].tolist()))
        keys = ", ".join(f"{name} = {row[name]}" for name in row
                         if name in ("measurement.file", "measurement.curve"))
        print(f"curve {i + 1}: {keys}: {row['verdict']}; {row['failure'] or row['warning']}")
    try:
        figure = draw_maps(table, result.units["sweep"], list(value) or None, columns=columns)
    except SnapinError as problem:
        raise ResultsError(f"{folder}: {problem}") from problem
    entitle(figure, title_of(folder, {**result.summary, "converged": True}))
    return figure


def _options(parser):
    parser.add_argument("--value", nargs="+", default=(), help="columns of sweep.csv")
    parser.add_argument("--columns", type=int, help="number of curves in a row of the map")
    parser.add_argument("--worst", type=int, default=0, help="number of worst curves to print")


PICTURE = Picture(
    "curves", draw_curve_map, "curve_map.png", "Draw the fits of many curves over their places.",
    has_fits, _options)
