"""Checks of the arguments of the Fortran library, and its exceptions.

f2py converts arguments without checks, so that kind, shape, sign and size are checked here; every
exception begins with the argument's name. An argument is accepted if a contiguous float64 copy has
the same values; no argument is changed.
"""

import operator
import os
import pathlib
import reprlib
from decimal import Decimal
from numbers import Real
from typing import Union

import numpy as np
from numpy.typing import ArrayLike, NDArray


#: What functions return: arrays of float64, and of bool.
Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
#: A path of a file or folder.
Path = Union[str, "os.PathLike[str]"]


class SnapinError(RuntimeError):
    """A valid calculation failed."""


class DeckError(SnapinError, ValueError):
    """A deck is wrong; the message has line, group and key of all mistakes."""


class SnapinWarning(UserWarning):
    """A state did not converge, or a result is not resolved."""


# Sizes go to Fortran as C ints.
_MOST_VALUES = 2**27
# Limits of a physical quantity in SI units: within them no product in the formulas leaves the range
# of float64, which would give a NaN that means "no such state".
_LEAST, _MOST = 1e-50, 1e50


def shown(value):
    """Return a short text for a message."""
    try:
        return reprlib.repr(value)
    # The repr of an unknown class may fail in any way, that of an int beyond 4300 digits.
    except Exception:
        return f"this {type(value).__name__}"


def folder_path(name: str, value: Path) -> pathlib.Path:
    """Return the path of a folder."""
    if not isinstance(value, (str, os.PathLike)):
        raise TypeError(f"{name}: the path of a folder is needed, not {shown(value)}")
    # Often a variable that was not set, by which pathlib means the folder of the process.
    if not os.fspath(value):
        raise ValueError(f"{name}: an empty name is no folder; '.' is the present one")
    return pathlib.Path(value)


# --- Numbers


def reals(name: str, values: ArrayLike, most: float = np.inf) -> Array:
    """Return `values`, of any shape, as a contiguous float64 array within +-`most`."""
    refusal = f"{name}: real numbers are needed, not {shown(values)}"
    try:
        given = np.asanyarray(values)
    except (TypeError, ValueError, OverflowError) as problem:
        raise TypeError(refusal) from problem
    if given.size > _MOST_VALUES:
        raise ValueError(f"{name}: at most {_MOST_VALUES} values are taken, not {given.size}")
    if np.ma.is_masked(given):
        raise ValueError(f"{name}: values are masked")
    given = np.asarray(given)
    # NumPy makes an empty list an array of floats.
    if given.dtype.kind not in "fiu" and not (given.dtype.kind == "O" and _all_real(given)):
        raise TypeError(refusal)
    try:
        with np.errstate(over="ignore"):
            array = np.ascontiguousarray(given, dtype=np.float64).reshape(given.shape)
    except OverflowError:
        raise ValueError(f"{name}: too large for float64") from None
    if not np.isfinite(array).all():
        raise ValueError(f"{name}: must be finite, not {shown(values)}")
    if (abs(array) > most).any():
        raise ValueError(f"{name}: must be within {most:g}, not {shown(values)}")
    if given.dtype.kind != "f" and not _exact(given, array):
        raise ValueError(f"{name}: whole numbers this large are not exact in float64")
    return array


def _all_real(objects):
    """Return whether these objects are real numbers other than bools."""
    return all(
        isinstance(one, (Real, Decimal)) and not isinstance(one, (bool, np.bool_))
        for one in objects.flat
    )


def _exact(given, array):
    """Return whether the conversion kept whole numbers, as it does below 2**53."""
    large = abs(array) >= 2.0**53
    return all(
        int(one) == int(number)
        for one, number in zip(given[large].flat, array[large].flat)
        if one == int(one)
    )


def vector(name: str, values: ArrayLike, *, most: float = _MOST) -> Array:
    """Return `values`, also a single number, as a one-dimensional array of finite float64."""
    array = reals(name, values, most)
    if array.ndim > 1:
        raise ValueError(f"{name}: one dimension is needed, not shape {array.shape}")
    return array.reshape(-1)


def positive_vector(name: str, values: ArrayLike) -> Array:
    """Return `values` as `vector` does; all must be above zero."""
    array = vector(name, values)
    if not (array >= _LEAST).all():
        raise ValueError(f"{name}: all values must be positive, and at least {_LEAST:g}")
    return array


def ascending(name: str, values: ArrayLike, least_size: int) -> Array:
    """Return `values` as a vector of at least `least_size` numbers, each above the one before."""
    array = vector(name, values)
    if array.size < least_size:
        raise ValueError(f"{name}: at least {least_size} values are needed, not {array.size}")
    if not (np.diff(array) > 0).all():
        raise ValueError(f"{name}: each value must be above the one before")
    return array


def as_long_as(name: str, values: ArrayLike, size: int) -> Array:
    """Return `values` as a vector of `size` numbers."""
    array = vector(name, values)
    if array.size != size:
        raise ValueError(f"{name}: {size} values are needed, not {array.size}")
    return array


def flags(name: str, values: ArrayLike, size: int) -> Flags:
    """Return `values`, one bool or `size` of them, as an array of `size` bools."""
    known = isinstance(values, (bool, np.bool_, list, tuple, np.ndarray))
    if isinstance(values, (list, tuple)):
        known = all(isinstance(one, (bool, np.bool_)) for one in values)
    given = np.asarray(values, dtype=None if known else object)
    if not known or np.ma.is_masked(values) or given.dtype != bool or given.ndim > 1:
        raise TypeError(f"{name}: True, False or an array of these is needed, not {shown(values)}")
    if given.ndim == 1 and given.size != size:
        raise ValueError(f"{name}: {size} values are needed, not {given.size}")
    return np.full(size, given)


def scalar(name: str, value: float) -> float:
    """Return `value` as a finite float."""
    array = reals(name, value, _MOST)
    if array.ndim > 0:
        raise TypeError(f"{name}: one number is needed, not shape {array.shape}")
    return float(array)


def positive(name: str, value: float) -> float:
    """Return `value` as a finite float above zero."""
    number = scalar(name, value)
    if not number >= _LEAST:
        raise ValueError(f"{name}: must be positive, and at least {_LEAST:g}, not {number}")
    return number


def not_negative(name: str, value: float) -> float:
    """Return `value` as a finite float that is zero or more."""
    number = scalar(name, value)
    if number < 0:
        raise ValueError(f"{name}: must not be negative, not {number}")
    return number


def count(name: str, value: int, least: int, most: int = 2**31 - 1) -> int:
    """Return `value` as an int within the limits; floats are refused."""
    try:
        if isinstance(value, (bool, np.bool_)) or np.ndim(value) > 0:
            raise TypeError
        number = operator.index(value)
    except (TypeError, ValueError):
        raise TypeError(f"{name}: a whole number is needed, not {shown(value)}") from None
    if not least <= number <= most:
        raise ValueError(f"{name}: must be from {least} to {most}, not {shown(number)}")
    return number


# --- Names


def one_of(name, value, choices):
    """Return `value` as a str if it is one of `choices`."""
    if not isinstance(value, str) or value not in choices:
        raise ValueError(f"{name}: must be one of {', '.join(choices)}, not {shown(value)}")
    return str(value)


def instance(name, value, kind, origin):
    """Return `value` if it is of this class; `origin` names the functions that make one."""
    if not isinstance(value, kind):
        raise TypeError(f"{name}: must come from {origin}, not {shown(value)}")
    return value


# --- Memory


def room_for(name, needed):
    """Raise MemoryError if a calculation needs more memory [bytes] than there is; without memory
    the library would end Python."""
    text = f"{name}: {needed / 1e9:.3g} GB of memory are needed"
    try:
        # Takes only address space, and fails if that is limited.
        np.empty(needed, dtype=np.uint8)
    except MemoryError:
        raise MemoryError(f"{text}, more than this process may have") from None
    free = _free_memory()
    if needed > free:
        raise MemoryError(f"{text}, {free / 1e9:.3g} GB are free")


def _free_memory():
    """Return the available memory [bytes]; infinite if it is not known."""
    try:
        with open("/proc/meminfo", encoding="ascii") as table:
            rows = dict(line.split(":", 1) for line in table)
        return 1024 * int(rows["MemAvailable"].split()[0])
    except (OSError, KeyError, ValueError):
        return float("inf")
