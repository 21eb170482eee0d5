"""Comparison of the numbers of a run with those of the reference, and tables of the errors."""

import collections
import math
from typing import NamedTuple

import numpy as np
from support.scenes import several

# Largest relative difference between two resolutions of the reference. It is largest for the place
# of an extremum of the load; at strong adhesion rounding sets the limit.
KNOWN, KNOWN_PLACE, KNOWN_BY_SIGMA = 3e-11, 3e-10, 2e-14
# The smallest acceptable ratio of a true error and its estimate.
PESSIMISTIC = 1 / 30


class Deviation(NamedTuple):
    """A number of a run: what it should be, how far it is off, and how far it may be, it says.

    error and allowed are in the number's own unit; relative is error over the larger of the value
    and its scale (the pull-off for loads, z0 for lengths). known: whether the error is above the
    reference's own.
    """

    key: str
    value: float
    error: float
    allowed: float
    relative: float = math.nan
    known: bool = True

    @property
    def ratio(self):
        """True error over the estimated error; 0 if the reference is not more accurate."""
        if not self.known:
            return 0.0
        return self.error / self.allowed if self.allowed else math.inf


def is_bad(finding):
    """Something is missing, invented or failed, or an error is larger than its estimate."""
    return bool(finding.wrong) or any(one.ratio > 1 for one in finding.deviations)


def missing(report, expected):
    """Keys that are present or absent by mistake, and arrays of wrong shape."""
    wrong = []
    for key, value in expected.items():
        there = key in report.numbers
        wanted = value is not None and value != []
        if there != wanted:
            wrong.append(f"{key} {'missing' if wanted else 'invented'}")
        elif there and isinstance(value, list):
            mine, theirs = several(report.numbers[key]), value
            if [math.isnan(x) for x in mine] != [math.isnan(x) for x in theirs]:
                wrong.append(f"{key} has {mine} for {theirs}")
    return wrong


def deviations(report, expected, path):
    found = []
    for key, value in expected.items():
        mine, theirs = several(report.numbers.get(key, [])), several(value)
        if value is None or len(mine) != len(theirs):
            continue
        errors, scale = several(report.errors.get(key, [])), scale_of(key, path.pull_off.load)
        for i, (one, other) in enumerate(zip(mine, theirs)):
            if math.isnan(one) or math.isnan(other):
                continue
            error, size = abs(one - other), max(abs(other), scale)
            allowed = errors[i] if i < len(errors) else report.estimate * size
            found.append(Deviation(key, other, error, allowed, error / size,
                                   error / size > floor(key, path.sigma)))
    return found


def floor(key, sigma):
    """The relative error of the reference."""
    place = key.endswith(("tension_h0", "load_folds_h0"))
    return max(KNOWN_PLACE if place else KNOWN, KNOWN_BY_SIGMA * sigma)


def scale_of(key, pull_off):
    """The scale to which errors of a small number are relative."""
    if key == "energy_lost":
        return 0.0
    return 1.0 if key.endswith(("h0", "displacement")) else abs(pull_off)


def table(named, most=25):
    """Lines of a report: the ratios of true and estimated errors of each number, and the largest;
    named: (name, kind, finding) of all findings."""
    named = list(named)
    by_key = collections.defaultdict(list)
    for _, kind, finding in named:
        for one in finding.deviations:
            if one.known:
                by_key[f"{kind} {one.key}"].append(one.ratio)
    every = {"all numbers": [ratio for ratios in by_key.values() for ratio in ratios]}
    lines = [f"{'true error over estimated':<34} {'number':>6} {'least':>9}{'5 %':>9}{'median':>9}"
             f"{'95 %':>9}{'largest':>9} {'above 1':>8} {'below 1/30':>11}"]
    for name, ratios in [*sorted(by_key.items()), *every.items()]:
        if ratios:
            cells = "".join(f"{x:9.1e}" for x in np.quantile(ratios, (0, 0.05, 0.5, 0.95, 1)))
            lines.append(f"{name:<34} {len(ratios):6d} {cells} {sum(r > 1 for r in ratios):8d} "
                         f"{sum(r < PESSIMISTIC for r in ratios):11d}")
    above = [(one, name) for name, _, f in named for one in f.deviations if one.ratio > 1]
    above.sort(key=lambda item: -item[0].ratio)
    lines += [f"  {name} {one.key}: {one.ratio:.1e} (off by {one.error:.1e} of {one.value:.6g})"
              for one, name in above[:most]]
    return lines + [f"  {name}: {'; '.join(f.wrong)[:200]}" for name, _, f in named if f.wrong][
        :most]
