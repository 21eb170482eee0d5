"""Fits of many measured curves in memory: one sweep of the program, a record for each curve."""

import contextlib
import os
import tempfile
import warnings
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from .arguments import Array, Path, SnapinError, SnapinWarning, folder_path
from .curve_fit import columns_of, fit_groups, header_of, names_in, values_of, with_groups
from .deck import Deck
from .experiment import run
from .results import Result

# The column that numbers the curves, the files, and the keys of a curve's place.
_NUMBER, _CURVES, _CASES = "curve", "curves.csv", "cases.csv"
_PLACES = ("measurement.x", "measurement.y")
_TOLD = ("verdict", "warning", "failure")


class Shared(NamedTuple):
    """The parameters with one value for all curves, SI. Dictionaries have their names as keys.

    Attributes:
        estimate: the value of each parameter.
        standard_error: its standard error.
        interval_95: the ends of its 95 % interval.
        correlation: the correlations of the estimates.
        chi_squared: that of all curves together, with all unknowns.
        degrees_of_freedom: likewise.
        curves: number of the curves that were fitted together: those that the model describes
            alone.
        warnings: those of the fit of all; a warning of one curve is in its record.
    """

    estimate: dict[str, float]
    standard_error: dict[str, float]
    interval_95: dict[str, tuple[float, float]]
    correlation: Array
    chi_squared: float
    degrees_of_freedom: float
    curves: int
    warnings: list[str]


class Fits:
    """The fits of many curves, SI. `table` has a row for each curve, in their order: the columns of
    sweep.csv. `parameters`: the names of the unknowns; `units`: of the columns. `shared`: if some
    of them have one value for all curves, the fit of these; None without them. `result`: that of
    the whole run."""

    result: Result
    parameters: tuple[str, ...]
    table: np.ndarray
    units: dict[str, str]
    shared: Optional[Shared]

    def __init__(self, result, parameters, broken):
        self.result, self.parameters = result, parameters
        self.table, self.units = result.sweep, result.units["sweep"]
        self.shared = None
        if "fit" in result.fitted:
            found = result.fitted["fit"]
            self.shared = Shared(
                *values_of(found), int(found["curves"][0]), names_in(found.get("warnings")))
        for i, why in broken.items():
            self.table["failure"][i] = why[:self.table["failure"].dtype.itemsize // 4]

    def __len__(self):
        return len(self.table)

    def __getitem__(self, i):
        """Return the record of a curve, a dictionary."""
        return dict(zip(self.table.dtype.names, self.table[i].tolist()))

    def records(self):
        """Return a list of all records."""
        return [self[i] for i in range(len(self))]

    def of_each(self, ending):
        """Return for each parameter the numbers of all curves: "estimate", "standard_error",
        "lower_95" or "upper_95"."""
        return {name: self.table[f"{name}_{ending}"] for name in self.parameters}

    @property
    def estimate(self):
        """The value of each parameter by curve."""
        return self.of_each("estimate")

    @property
    def standard_error(self):
        """Its standard error by curve."""
        return self.of_each("standard_error")

    @property
    def interval_95(self):
        """Return the ends of the 95 % intervals of each parameter: (curves, 2)."""
        low, high = self.of_each("lower_95"), self.of_each("upper_95")
        return {name: np.stack([low[name], high[name]], axis=1) for name in self.parameters}

    @property
    def described(self):
        """Return which curves the model describes."""
        return np.isin(self.table["verdict"], ("described", "warned"))

    def worst(self, count=5):
        """Return the indices of the curves that are fitted worst: those without a fit, then by the
        excess of their residuals."""
        return worst_of(self.table, count)

    def draw_maps(self, values=None, *, columns=None):
        """Return a figure of Matplotlib with maps of columns of the table, by default of work of
        adhesion, modulus, contact height, Tabor's parameter and verdict, over the places of the
        curves or, with so many `columns`, their order."""
        from .plots.curve_map import draw_maps

        return draw_maps(self.table, self.units, values, columns=columns)

    def to_xarray(self):
        """Return an `xarray.Dataset` with units as attributes. Its dimensions are y and x if the
        places of the curves are all points of a grid, else `curve`."""
        import xarray

        data = xarray.Dataset(attrs={"parameters": list(self.parameters)})
        places = [self.table[key] for key in _PLACES if key in self.table.dtype.names]
        shape, order = grid_of(places) if len(places) == 2 else (None, slice(None))
        dims = ("y", "x") if shape else ("curve",)
        for name in self.table.dtype.names:
            values = self.table[name][order]
            data[name] = dims, values.reshape(shape) if shape else values
            if self.units.get(name):
                data[name].attrs["units"] = self.units[name]
        if shape:
            data = data.assign_coords(x=np.unique(places[0]), y=np.unique(places[1]))
        else:
            data = data.assign_coords(curve=np.arange(len(self)))
            data = data.assign_coords(
                {name: ("curve", place) for name, place in zip("xy", places)})
        for name in {"x", "y"} & set(data.coords):
            data[name].attrs["units"] = "m"
        return data

    def __repr__(self):
        return f"<Fits: {len(self)} curves, {self.described.sum()} described>"


def worst_of(table, count):
    """Return the indices of the rows of sweep.csv whose fits are worst."""
    excess = np.where(np.isfinite(table["excess"]), table["excess"], np.inf)
    return np.argsort(-excess, kind="stable")[:count]


def grid_of(places):
    """Return the shape (y, x) of a grid of which the places are all points, and the order of its
    points, x fastest; None and all in their order if they are not."""
    x, y = (np.asarray(place) for place in places)
    shape = len(np.unique(y)), len(np.unique(x))
    if shape[0] * shape[1] != len(x) or len(set(zip(x, y))) != len(x):
        return None, slice(None)
    return shape, np.lexsort((x, y))


def fit_many(curves: Iterable[Sequence[ArrayLike]], *, deck: Deck,
             parameters: Union[str, Sequence[str], None] = None,
             shared: Union[str, Sequence[str], None] = None,
             own: Union[str, Sequence[str], None] = None,
             spring_constant: Optional[ArrayLike] = None, places: Optional[ArrayLike] = None,
             over_radius: bool = False, each: Optional[Mapping[str, Any]] = None,
             out: Optional[Path] = None,
             resume: bool = False, quiet: bool = True, **further: Any) -> Fits:
    """Fit numbers of a deck to each of many measured curves and return the `Fits`.

    As many processes as OMP_NUM_THREADS says fit curves at the same time.

    Args:
        curves: an iterable of (z, force), (z, force, segment) or (z, force, segment,
            contact_radius), as of `fit`; one that is no curve is a record with the reason.
        deck: the scene, as of `fit`.
        parameters: the unknowns of each curve, which is fitted alone.
        shared: instead, the unknowns with one value for all curves, which are fitted together.
        own: with `shared`, the unknowns with a value for each curve.
        spring_constant: one number, or one for each curve [N/m].
        places: x and y of each curve [m].
        over_radius: whether the forces are over the radius.
        each: values of further keys of the deck, one for each curve, such as
            {"bodies.radius": [...]}.
        out: the folder for curves and results.
        resume: whether to go on in `out` with the curves that are left.
        quiet: whether to show no progress.
        further: other arguments of `fit`.
    """
    each = dict(each or {})
    if np.ndim(spring_constant) > 0:
        each["measurement.spring_constant"] = spring_constant
        spring_constant = float(np.asarray(spring_constant).flat[0])
    if places is not None:
        each.update(zip(_PLACES, np.asarray(places, float).T))
    with contextlib.ExitStack() as stack:
        folder = folder_path(
            "out", stack.enter_context(tempfile.TemporaryDirectory()) if out is None else out)
        folder.mkdir(parents=True, exist_ok=True)
        count, columns, broken = _write_curves(folder / _CURVES, curves, over_radius)
        _write_cases(folder / _CASES, count, each)
        groups = fit_groups(
            folder / _CURVES, columns, spring_constant=spring_constant, parameters=parameters,
            shared=shared, own=own, **further)
        groups["measurement"].update(curves=_NUMBER, curve=0)
        groups["sweep"] = {"file": os.fspath((folder / _CASES).absolute())}
        with warnings.catch_warnings():
            # What is said of a curve is in its record.
            warnings.simplefilter("ignore", SnapinWarning)
            result = run(with_groups(deck, groups, "fit_many"), out, resume=resume, quiet=quiet)
    names = [groups["fit"][key] for key in ("parameters", "shared", "own")]
    return Fits(result, tuple(name for of_key in names for name in of_key or ()), broken)


def _write_curves(path, curves, over_radius):
    """Write all curves into one file; return their number, the names of their columns, and why some
    are no curves."""
    broken, names, count = {}, None, 0
    with path.open("w", encoding="utf-8") as file:
        for count, curve in enumerate(curves, 1):
            try:
                columns = columns_of(*curve)
                if names is None:
                    names = [*columns]
                    file.write(f"{_NUMBER},{header_of(columns, over_radius)}\n")
                if [*columns] != names:
                    raise ValueError(f"this curve has {', '.join(columns)}, and is not like the "
                                     f"first, with {', '.join(names)}")
                if not len(columns["force"]):
                    raise ValueError("a curve without samples")
            except (TypeError, ValueError) as problem:
                broken[count - 1] = str(problem).replace(",", ";").replace("\n", " ")
                continue
            number = np.full(len(columns["force"]), count - 1)
            np.savetxt(file, np.column_stack([number, *columns.values()]),
                       ["%d"] + ["%.17g"] * len(columns), ",")
    if names is None:
        raise SnapinError("curves: there is no curve" + "".join(
            f"; the first: {why}" for why in list(broken.values())[:1]))
    return count, names, broken


def _write_cases(path, count, each):
    """Write the table of cases: the number of each curve and the values of further keys."""
    for key, values in each.items():
        if np.shape(values) != (count,):
            raise ValueError(f"{key}: {count} numbers are needed, one for each curve")
    columns = [np.arange(count), *(np.asarray(values, float) for values in each.values())]
    np.savetxt(path, np.column_stack(columns), ["%d"] + ["%.17g"] * len(each), ",",
               header=",".join([f"measurement.{_NUMBER}", *each]), comments="")
