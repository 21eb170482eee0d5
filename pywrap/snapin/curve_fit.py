"""Fits of measured curves in memory."""

import os
import pathlib
import tempfile
import warnings
from collections.abc import Mapping, Sequence
from typing import NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from .arguments import Array, DeckError, SnapinWarning, vector
from .deck import Deck, deck_of, deck_text
from .experiment import run
from .results import Result

# The columns of a file of curves, of which the last may be missing.
_COLUMNS = ("z", "force", "segment")


class Fit(NamedTuple):
    """The result of a fit, SI. Dictionaries have the parameters of the fit as keys."""

    estimate: dict[str, float]
    standard_error: dict[str, float]
    #: The ends of the 95 % interval of each parameter.
    interval_95: dict[str, tuple[float, float]]
    correlation: Array
    chi_squared: float
    degrees_of_freedom: float
    #: Standard deviation of the signal.
    noise: float
    #: What limits the result; empty where the model describes the data.
    warnings: list[str]
    #: Position [m], signal as measured and by the model, and residual of each sample.
    samples: np.ndarray
    #: The whole result: `result.fitted` has the classical theories too.
    result: Result


def fit(z: ArrayLike, force: ArrayLike, *, spring_constant: float, deck: Deck,
        parameters: Union[str, Sequence[str]], segment: Optional[ArrayLike] = None,
        sensitivity: Optional[float] = None, contact_point: Optional[float] = None,
        branches: Optional[str] = None, lower: Optional[ArrayLike] = None,
        upper: Optional[ArrayLike] = None, prior: Optional[ArrayLike] = None,
        noise: Optional[float] = None) -> Fit:
    """Fit numbers of a deck to a measured curve and return a `Fit`.

    z: position of the base of the spring [m]; force: force [N], repulsion positive, or the signal
    [V] if `sensitivity` [m/V] is given; segment: 0 for each sample of the approach, 1 for the
    retract; without it the curve is divided where z turns. deck: the scene as a dictionary of
    groups, a text or a path, without &measurement and &fit. parameters: the unknowns, such as
    "force.surface_energy", "bodies.stiffness", "measurement.contact_point"; lower, upper, prior:
    one number for each. branches: "both", "approach" or "retract". noise: standard deviation of the
    signal, if it is known.

    Samples without a finite z and force do not count. A wrong deck raises `DeckError`, a curve that
    cannot be fitted `SnapinError` with the reason.
    """
    columns = columns_of(z, force, segment)
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "curve.csv")
        np.savetxt(file, np.column_stack(columns), "%.17g", ",",
                   header=",".join(_COLUMNS[:len(columns)]), comments="")
        groups = fit_groups(
            file, len(columns) == 3, spring_constant=spring_constant, parameters=parameters,
            sensitivity=sensitivity, contact_point=contact_point, branches=branches, lower=lower,
            upper=upper, prior=prior, noise=noise)
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always", SnapinWarning)
            result = run(with_groups(deck, groups, "fit"))
    return _fit_of(result, [str(one.message) for one in said])


def columns_of(z, force, segment=None):
    """Return position, signal and, if there are any, segments of a curve as arrays."""
    columns = [np.asarray(z, float), np.asarray(force, float)]
    for name, column in zip(("z", "force"), columns):
        if column.ndim != 1:
            raise ValueError(f"{name}: one dimension is needed, not shape {column.shape}")
    if segment is not None:
        columns.append(vector("segment", segment))
    if len({len(column) for column in columns}) > 1:
        raise ValueError("z, force and segment: " + ", ".join(str(len(c)) for c in columns)
                         + " values; the numbers must be equal")
    return columns


def fit_groups(file, segments, *, spring_constant, parameters, sensitivity=None, contact_point=None,
               branches=None, lower=None, upper=None, prior=None, noise=None):
    """Return the groups &measurement and &fit of a deck for a file of curves."""
    return {
        "measurement": {
            "file": os.fspath(pathlib.Path(file).absolute()),
            "columns": list(_COLUMNS[:3 if segments else 2]),
            "spring_constant": spring_constant, "sensitivity": sensitivity,
            "contact_point": contact_point, "segment": branches},
        "fit": {"parameters": [parameters] if isinstance(parameters, str) else list(parameters),
                "lower": lower, "upper": upper, "prior": prior, "noise": noise}}


def with_groups(deck, groups, asker):
    """Return the text of a deck and of further groups, which the function `asker` makes."""
    if isinstance(deck, Mapping):
        for name in groups:
            if deck.get(name) is not None:
                raise DeckError(f"deck: &{name} is made of the arguments of {asker}")
        return deck_text({**deck, **groups})
    return deck_of(deck)[1].decode() + "\n" + deck_text(groups)


def _fit_of(result, said):
    found = result.fitted["fit"]
    names = found["parameters"]
    names = [names] if isinstance(names, str) else list(names)

    def of_each(key):
        return dict(zip(names, map(float, found[key])))

    low, high = of_each("lower_95"), of_each("upper_95")
    return Fit(
        of_each("estimate"), of_each("standard_error"),
        {name: (low[name], high[name]) for name in names}, found["correlation"],
        float(found["chi_squared"][0]), float(found["degrees_of_freedom"][0]),
        float(found["noise"][0]), said, result.tables["fit"], result)
