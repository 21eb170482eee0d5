"""Checks on what goes into the Fortran library, and on what it says about it.

f2py passes on whatever it can convert, so that shapes, signs and NaN are looked at here; every
exception names the argument.
"""

import math

import numpy as np


class SnapinError(RuntimeError):
    """The library was asked for something sensible and could not do it."""


class SnapinWarning(UserWarning):
    """A result is not all that was asked for: something did not converge, or is not resolved."""


def vector(name, values):
    """Return `values` as a one-dimensional, contiguous array of finite float64."""
    try:
        array = np.ascontiguousarray(values, dtype=np.float64)
    except (TypeError, ValueError) as problem:
        raise TypeError(f"{name}: real numbers are needed, not {values!r}") from problem
    if np.ndim(values) > 1:
        raise ValueError(f"{name}: one dimension is needed, not shape {array.shape}")
    if not np.isfinite(array).all():
        raise ValueError(f"{name}: all values must be finite")
    return array.reshape(-1)


def positive_vector(name, values):
    """Return `values` as `vector` does, refusing any that is not above zero."""
    array = vector(name, values)
    if not (array > 0).all():
        raise ValueError(f"{name}: all values must be positive")
    return array


def scalar(name, value):
    """Return `value` as a finite float."""
    try:
        number = float(value)
    except (TypeError, ValueError) as problem:
        raise TypeError(f"{name}: a real number is needed, not {value!r}") from problem
    if not math.isfinite(number):
        raise ValueError(f"{name}: must be finite, not {number}")
    return number


def positive(name, value):
    """Return `value` as a finite float above zero."""
    number = scalar(name, value)
    if number <= 0:
        raise ValueError(f"{name}: must be positive, not {number}")
    return number


def accept(stat, message):
    """Raise what the library reported; `stat` is 0, or the kind in src/failure.f90."""
    if stat == 0:
        return
    text = message.decode().strip()
    raise ValueError(text) if stat == 1 else SnapinError(text)
