"""What the paper's stopping rule gives is known to within its scatter alone: ranges over runs of
one deck that differ in nothing but rounding.

Each run has the Hamaker constant changed in its twelfth digit, which changes the equations'
solution by as little. Another build, kernel of the linear algebra or processor does the same.
"""

import f90nml
import numpy as np

# Runs of a deck; of one that takes minutes, fewer.
COUNT = 9
_FEWER = {"history_c_paper": 3}
# Relative change of the Hamaker constant from one run to the next.
_CHANGE = 1e-12
_KEY = "_draw"
# Differences below this are rounding's and the stopping of iterations, another one in every build.
_ROUNDING = 1e-9


def names(stem, count=None):
    """Return the names of a deck's runs, its own first."""
    wanted = min(count or COUNT, _FEWER.get(stem, COUNT)) if "_paper" in stem else 1
    return [stem] + [f"{stem}{_KEY}{number}" for number in range(1, wanted)]


def parts(name):
    """Return deck and number of a run; 0 is the deck as it stands."""
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


def read(path):
    """Return a deck as a namelist that can be changed."""
    return f90nml.read(path)


def ranged(values, digits=2, form="f"):
    """Return the range of values as text, one number where both ends look alike."""
    values = np.ravel(np.asarray(values, float))
    low, high = (f"{value:.{digits}{form}}" for value in (np.nanmin(values), np.nanmax(values)))
    return low if low == high else f"{low} to {high}"


def several(columns, digits=2):
    """Return the ranges of a list of sets of values, one after the other."""
    return ", ".join(ranged(values, digits) for values in columns)


def within(value):
    """Return a difference as text; of what is left to rounding no digit means anything."""
    text = f"{value:.0e}" if value >= _ROUNDING else f"better than {_ROUNDING:.0e}"
    return text.replace("e-0", "e-")
