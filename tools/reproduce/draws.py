"""Results under the paper's stopping rule have a scatter: ranges over runs of one deck that differ
by rounding alone.

Each run has the Hamaker constant changed in its twelfth digit, which changes the solution of the
equations equally little. Another build, kernel of the linear algebra or processor has the same
effect.
"""

import numpy as np

# Number of runs of a deck; fewer for a deck that takes minutes.
COUNT = 9
_FEWER = {"history_c_paper": 3}
# Relative change of the Hamaker constant from one run to the next.
_CHANGE = 1e-12
_KEY = "_draw"
# Differences below this are due to rounding and the stopping of iterations, and vary with the
# build.
_ROUNDING = 1e-9


def names(stem, count=None):
    """Return the names of a deck's runs, beginning with the deck's own name."""
    wanted = min(count or COUNT, _FEWER.get(stem, COUNT)) if "_paper" in stem else 1
    return [stem] + [f"{stem}{_KEY}{number}" for number in range(1, wanted)]


def parts(name):
    """Return deck and number of a run; 0 is the unchanged deck."""
    stem, _, number = name.partition(_KEY)
    return stem, int(number or 0)


def changed(groups, number):
    """Return the namelist of a run: all Hamaker constants larger by `number` units of change."""
    factor = 1 + number * _CHANGE
    groups["force"]["hamaker"] *= factor
    sweep = groups.get("sweep", {})
    if sweep.get("key") == "force.hamaker":
        for key in {"values", "from", "to"} & set(sweep):
            value = sweep[key]
            sweep[key] = ([each * factor for each in value] if isinstance(value, list)
                          else value * factor)
    return groups


def ranged(values, digits=2, form="f"):
    """Return the range of values as text, or one number if both ends look alike."""
    values = np.ravel(np.asarray(values, float))
    low, high = (f"{value:.{digits}{form}}" for value in (np.nanmin(values), np.nanmax(values)))
    return low if low == high else f"{low} to {high}"


def several(columns, digits=2):
    """Return the ranges of a list of sets of values, one after the other."""
    return ", ".join(ranged(values, digits) for values in columns)


def within(value):
    """Return a difference as text; a difference due to rounding has no significant digit."""
    text = f"{value:.0e}" if value >= _ROUNDING else f"better than {_ROUNDING:.0e}"
    return text.replace("e-0", "e-")
