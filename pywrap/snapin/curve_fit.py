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

# What a column of a file of curves is, if its name does not say it.
_QUANTITIES = {"force": "load"}


class Fit(NamedTuple):
    """The result of a fit, SI. Dictionaries have the parameters of the fit as keys.

    Attributes:
        estimate: the value of each parameter.
        standard_error: its standard error.
        interval_95: the ends of its 95 % interval.
        correlation: the correlations of the estimates, in the order of the parameters.
        chi_squared: the sum of the squares of the residuals over the noise.
        degrees_of_freedom: the number of samples less that of the unknowns.
        noise: the standard deviation of the signal.
        warnings: what limits the result; empty if the model describes the data.
        samples: position [m], signal as measured and by the model, and residual of each sample.
        result: the whole result; `result.fitted` has the classical theories too.
    """

    estimate: dict[str, float]
    standard_error: dict[str, float]
    interval_95: dict[str, tuple[float, float]]
    correlation: Array
    chi_squared: float
    degrees_of_freedom: float
    noise: float
    warnings: list[str]
    samples: np.ndarray
    result: Result


def fit(z: Optional[ArrayLike], force: ArrayLike, *, deck: Deck,
        parameters: Union[str, Sequence[str]], spring_constant: Optional[float] = None,
        segment: Optional[ArrayLike] = None, contact_radius: Optional[ArrayLike] = None,
        quantity: str = "position", over_radius: bool = False,
        sensitivity: Optional[float] = None, contact_point: Optional[float] = None,
        branches: Optional[str] = None, lower: Optional[ArrayLike] = None,
        upper: Optional[ArrayLike] = None, prior: Optional[ArrayLike] = None,
        noise: Optional[ArrayLike] = None) -> Fit:
    """Fit numbers of a deck to a measured curve and return a `Fit`.

    Samples without a finite z and force do not count. A wrong deck raises `DeckError`, a curve that
    cannot be fitted `SnapinError` with the reason.

    Args:
        z: position of the base of the spring [m], or with quantity = "separation" the separation of
            the bodies; None for contact radii under loads.
        force: force [N], repulsion positive; the signal [V] if `sensitivity` [m/V] is given; the
            force over the radius of the deck [N/m] with `over_radius`.
        deck: the scene as a dictionary of groups, a text or a path, without &measurement and &fit.
        parameters: the unknowns, such as "force.surface_energy", "bodies.stiffness",
            "measurement.contact_point".
        spring_constant: that of the spring [N/m]; only separations and loads do not need it.
        segment: 0 for each sample of the approach, 1 for the retract; without it the curve is
            divided where z turns.
        contact_radius: radius of the contact [m] in each sample, 0 or NaN if it was not observed.
        quantity: "position" or "separation", what z is.
        over_radius: whether `force` is over the radius.
        sensitivity: deflection of the spring for a volt of the signal [m/V].
        contact_point: position of the base at which undeformed bodies would touch [m].
        branches: "both", "approach" or "retract".
        lower: the least value of each parameter.
        upper: the largest value of each parameter.
        prior: the standard deviation of each parameter about its value in the deck.
        noise: standard deviation of the signal, if it is known, and then that of the radius.
    """
    columns = columns_of(z, force, segment, contact_radius)
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "curve.csv")
        np.savetxt(file, np.column_stack([*columns.values()]), "%.17g", ",",
                   header=header_of(columns, over_radius), comments="")
        groups = fit_groups(
            file, columns, spring_constant=spring_constant, parameters=parameters,
            quantity=quantity, sensitivity=sensitivity, contact_point=contact_point,
            branches=branches, lower=lower, upper=upper, prior=prior, noise=noise)
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always", SnapinWarning)
            result = run(with_groups(deck, groups, "fit"))
    return _fit_of(result, [str(one.message) for one in said])


def columns_of(z, force, segment=None, contact_radius=None):
    """Return the columns of a curve by their names."""
    if force is None:
        raise TypeError("force: a curve needs a load; separations and radii stay as they are if "
                        "all forces and moduli change by the same factor")
    columns = {name: np.asarray(column, float) for name, column in (
        ("z", z), ("force", force), ("contact_radius", contact_radius)) if column is not None}
    for name, column in columns.items():
        if column.ndim != 1:
            raise ValueError(f"{name}: one dimension is needed, not shape {column.shape}")
    if segment is not None:
        columns["segment"] = vector("segment", segment)
    if len({len(column) for column in columns.values()}) > 1:
        raise ValueError(", ".join(columns) + ": " + ", ".join(
            str(len(column)) for column in columns.values()) + " values; the numbers must be equal")
    return columns


def header_of(columns, over_radius):
    """Return the line of names of a file of curves."""
    return ",".join(name + " (N/m)" * (over_radius and name == "force") for name in columns)


def fit_groups(file, columns, *, parameters=None, shared=None, own=None, spring_constant=None,
               quantity="position", sensitivity=None, contact_point=None, branches=None, lower=None,
               upper=None, prior=None, noise=None):
    """Return the groups &measurement and &fit of a deck for a file of curves with these columns."""
    return {
        "measurement": {
            "file": os.fspath(pathlib.Path(file).absolute()), "columns": list(columns),
            "quantity": [quantity if name == "z" else _QUANTITIES.get(name, name)
                         for name in columns],
            "spring_constant": spring_constant, "sensitivity": sensitivity,
            "contact_point": contact_point, "segment": branches},
        "fit": {"parameters": names_in(parameters) or None, "shared": names_in(shared) or None,
                "own": names_in(own) or None, "lower": lower, "upper": upper, "prior": prior,
                "noise": noise}}


def names_in(names):
    """Return one name or several as a list."""
    return [names] if isinstance(names, str) else list(names or ())


def with_groups(deck, groups, asker):
    """Return the text of a deck and of further groups, which the function `asker` makes."""
    if isinstance(deck, Mapping):
        for name in groups:
            if deck.get(name) is not None:
                raise DeckError(f"deck: &{name} is made of the arguments of {asker}")
        return deck_text({**deck, **groups})
    return deck_of(deck)[1].decode() + "\n" + deck_text(groups)


def values_of(found):
    """Return estimate, standard error and ends of the 95 % interval of each parameter of a fit, as
    dictionaries, and the correlations, chi squared and its degrees of freedom."""
    names = names_in(found["parameters"])

    def of_each(key):
        return dict(zip(names, map(float, found[key])))

    low, high = of_each("lower_95"), of_each("upper_95")
    return (of_each("estimate"), of_each("standard_error"),
            {name: (low[name], high[name]) for name in names}, found["correlation"],
            float(found["chi_squared"][0]), float(found["degrees_of_freedom"][0]))


def _fit_of(result, said):
    found = result.fitted["fit"]
    return Fit(*values_of(found), float(found["noise"][0]), said, result.tables["fit"], result)
