"""A measured force curve with the fitted model, and the residuals.

    snapin-plot fit results/fit
"""

import numpy as np
from matplotlib.figure import Figure

from ..results import ResultFiles
from .drawing import (
    BLUE, GREY, SKY, VERMILION, Picture, dress, entitle, scale, title_of)

# Directions of the table, their names and colours.
_WAYS = {"approach": ("approach", SKY), "retreat": ("retract", BLUE)}
# Margin of the picture beyond the last sample with a force, over the extent of these samples.
_BEYOND = 0.15
# Outliers with larger residuals are drawn at this multiple of the largest residual in use.
_EDGE = 1.1
# Numbers of fit.nml that follow from the fitted ones, and their units.
_DERIVED = (("work_of_adhesion", "work of adhesion", "J/m^2"),
            ("reduced_modulus", "reduced modulus", "Pa"),
            ("young_of_sample", "Young's modulus of the sample", "Pa"))
# A signal above this many times the median residual is a force.
_STANDS_OUT = 10


def draw_fit(folder, whole=False):
    """Return a figure of the fit in `folder`; `whole` shows all of the baseline."""
    files = ResultFiles(folder)
    summary, table = files.summary(), files.table("fit.csv")
    # Contact radii beside a signal have a scale of their own, and are left out.
    alike = table["radius"] == table["radius"][0]
    table = {name: column[alike] for name, column in table.items()}
    across, up = "position of the base, from its least", "signal less baseline"
    under_loads, least = table["radius"][0] == 1, table["z"].min()
    if under_loads:
        across, up, least = "load", "contact radius", 0.0
    force = table["measured"] - table["baseline"]
    lengths = scale(np.ptp(table["z"]), "N" if under_loads else "m")
    fit = files.fit()
    unit = fit["signal_unit"][0] if "signal_unit" in fit else None
    signals = _scale_of_signal(force, unit)
    lefts = _scale_of_signal(table["residual"][table["used"] == 1], unit)
    z = (table["z"] - least) / lengths[0]

    outlier = table["outlier"] == 1
    edge = _EDGE * np.abs(table["residual"][table["used"] == 1]).max()
    figure = Figure(figsize=(7.5, 5.6), layout="constrained")
    panel, below = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    for way, (name, color) in _WAYS.items():
        mine = table["direction"] == way
        if not mine.any():
            continue
        used = mine & (table["used"] == 1)
        kept = mine & ~outlier
        panel.plot(z[kept], force[kept] / signals[0], ".", markersize=2.5, color=color,
                   label="data" if under_loads else name)
        model = (table["model"] - table["baseline"])[mine] / signals[0]
        panel.plot(z[mine], model, color=VERMILION, linewidth=1.0,
                   label="model" if way == table["direction"][0] else None)
        below.plot(z[used], table["residual"][used] / lefts[0], ".", markersize=2.5, color=color)
    if outlier.any():
        panel.plot(z[outlier], force[outlier] / signals[0], "x", markersize=4, color=GREY,
                   label="outlier, left out", zorder=1)
        beyond = np.clip(table["residual"], -edge, edge)[outlier] / lefts[0]
        for side, marker in ((beyond > 0, "^"), (beyond <= 0, "v")):
            below.plot(z[outlier][side], beyond[side], marker, markersize=4, color=GREY)
    below.set_ylim(-1.1 * edge / lefts[0], 1.1 * edge / lefts[0])
    dress(panel, "", f"{up} [{signals[1]}]")
    dress(below, f"{across} [{lengths[1]}]", f"residual [{lefts[1]}]")
    if not whole:
        _show_contact(panel, z, table, np.where(outlier, 0, force))
    # As entries of the legend the numbers lie where no curve is.
    for line in _numbers_of(fit):
        panel.plot([], [], " ", label=line)
    panel.legend(frameon=False, markerscale=3, fontsize="small")
    entitle(figure, title_of(folder, summary))
    return figure


def _numbers_of(fit):
    """Return lines with the fitted values and what follows from them, of a group of fit.nml."""
    names, values, errors, units = (np.atleast_1d(fit[key]) for key in (
        "parameters", "estimate", "standard_error", "units"))
    derived = [(words, fit[key][0], fit[key + "_error"][0], unit)
               for key, words, unit in _DERIVED if key in fit]
    # A work of adhesion or a modulus that is fitted itself is there once, in the field's words.
    rows = [(name.split(".", 1)[1].replace("_", " "), *row)
            for name, *row in zip(names, values, errors, units)
            if not any(np.isclose(row[0], number, rtol=1e-9, atol=0) and unit == row[2]
                       for _, number, _, unit in derived)]
    return [f"{name} {_with_error(value, error, unit)}"
            for name, value, error, unit in [*rows, *derived]]


def _with_error(value, error, unit):
    """Return a value down to the second digit of its error, in the unit or a multiple of it."""
    size, unit = scale([value], unit) if unit in ("m", "Pa") else (1.0, unit)
    value, error = value / size, error / size
    if not (np.isfinite(error) and error > 0):
        return f"{value:.3g} {unit}"
    digits = max(0, 1 - int(np.floor(np.log10(error))))
    return f"{value:.{digits}f} \u00b1 {error:.{digits}f} {unit}".replace("^2", "²")


def _scale_of_signal(values, unit):
    """Return the factor and the name of the unit; a prefix needs a unit that is known."""
    return scale(values, unit) if unit else (1.0, "V or m")


def _show_contact(panel, z, table, force):
    """Show the samples with a force and the largest tension, and little of the baseline."""
    level = _STANDS_OUT * np.median(np.abs(table["residual"]))
    stands = np.abs(force) > level
    if not stands.any():
        return
    # What a wrong model leaves may exceed the tension.
    stands[np.argmin(force)] = True
    stands = z[stands]
    margin = _BEYOND * np.ptp(stands)
    panel.set_xlim(max(z.min(), stands.min() - margin), min(z.max(), stands.max() + margin))


PICTURE = Picture(
    "fit", draw_fit, "fit.png", "Draw a measured force curve and the fitted model.",
    lambda files: "fit.nml" in files.texts,
    lambda parser: parser.add_argument("--whole", action="store_true",
                                       help="show all of the baseline"))
