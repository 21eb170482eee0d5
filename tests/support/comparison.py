"""Comparison of the numbers of a run with those of the reference."""

import math
from typing import NamedTuple

# Largest relative difference between two resolutions of the reference. It is largest for the place
# of an extremum of the load; at strong adhesion rounding sets the limit.
KNOWN, KNOWN_PLACE, KNOWN_BY_SIGMA = 3e-11, 3e-10, 2e-14


class Deviation(NamedTuple):
    """A number of a run: what it should be, how far it is off, and how far it may be, it says.

    error and allowed are in the number's own unit; relative is error over the larger of the value
    and its scale (the pull-off for loads, z0 for lengths), strict error over the value itself.
    own: whether the summary has an estimate for this very number; known: whether the error is above
    the reference's own.
    """

    key: str
    value: float
    error: float
    allowed: float
    relative: float
    strict: float
    own: bool
    known: bool


def missing(report, expected):
    """Keys that are present or absent by mistake, and arrays of wrong shape."""
    wrong = []
    for key, value in expected.items():
        there = key in report.numbers
        wanted = value is not None and value != []
        if there != wanted:
            wrong.append(f"{key} {'missing' if wanted else 'invented'}")
        elif there and isinstance(value, list):
            mine, theirs = aslist(report.numbers[key]), value
            if [math.isnan(x) for x in mine] != [math.isnan(x) for x in theirs]:
                wrong.append(f"{key} has {mine} for {theirs}")
    return wrong


def aslist(value):
    return value if isinstance(value, list) else [value]


def deviations(report, expected, path):
    """The deviations of all numbers that both have."""
    pull_off = path.pull_off.load
    found = []
    for key, value in expected.items():
        if key not in report.numbers or value is None:
            continue
        mine, theirs = aslist(report.numbers[key]), aslist(value)
        errors = aslist(report.errors[key]) if key in report.errors else None
        if len(mine) != len(theirs):
            continue
        for i, (one, other) in enumerate(zip(mine, theirs)):
            if math.isnan(one) or math.isnan(other):
                continue
            scale = scale_of(key, pull_off)
            made = deviation(key, one, other, scale, report, errors, i)
            found.append(made._replace(known=made.relative > floor(key, path.sigma)))
    return found


def deviation(key, mine, value, scale, report, errors, i):
    error, size = abs(mine - value), max(abs(value), scale)
    own = errors is not None and i < len(errors)
    allowed = errors[i] if own else report.estimate * size
    strict = error / abs(value) if value else math.inf
    return Deviation(key, value, error, allowed, error / size, strict, own, True)


def floor(key, sigma):
    """The relative error of the reference."""
    place = key.endswith(("tension_h0", "load_folds_h0"))
    return max(KNOWN_PLACE if place else KNOWN, KNOWN_BY_SIGMA * sigma)


def scale_of(key, pull_off):
    """The scale to which errors of a small number are relative."""
    if key == "energy_lost":
        return 0.0
    return 1.0 if key.endswith(("h0", "displacement")) else abs(pull_off)
