"""Runs the cases of entries of wrapper_registry.py and writes the result of each as a line of JSON.
It is a separate process, since a failing case may end it.

    python -m support.wrapper_child ENTRY ...
"""

import inspect
import json
import signal
import sys
import warnings

import numpy as np
import snapin
from support.wrapper_registry import REGISTRY
from support.wrapper_values import REFUSED, cases

# The entry and the argument of each kind with which every value is tried.
KINDS_FIRST = {}
for _which, _entry in REGISTRY.items():
    for _name, _kind in _entry.kinds.items():
        KINDS_FIRST.setdefault(_kind, (_which, _name))
# A case that takes longer is assumed to hang [s of processor time, independent of other load].
PATIENCE = 300


def flat(result):
    """All numbers and texts of a result, in order."""
    if isinstance(result, (tuple, list)):
        return [part for item in result for part in flat(item)]
    if hasattr(result, "__dataclass_fields__"):
        return flat([getattr(result, name) for name in result.__dataclass_fields__])
    if isinstance(result, snapin.Result):
        # The cost is in seconds too.
        return flat([list(result.tables.values()), list(result.summary.values())])
    return [result]


def same(one, other):
    one, other = flat(one), flat(other)
    return len(one) == len(other) and all(map(same_part, one, other))


def same_part(one, other):
    if isinstance(one, np.ndarray):
        return (
            one.dtype == other.dtype and one.shape == other.shape
            and one.tobytes() == other.tobytes()
        )
    return one == other or (one != one and other != other)


def bits(value):
    """The part of an argument that must not change; other objects are returned unchanged."""
    plain = type(value) is np.ndarray and value.nbytes < 10**6
    return value.tobytes() if plain else None


def attempt(entry, name, value):
    """The result, or the exception, of the entry's call with one argument exchanged."""
    arguments = {**entry.good, name: value}
    before = {key: bits(given) for key, given in arguments.items()}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", snapin.SnapinWarning)
        try:
            result = entry.call(**arguments)
        except Exception as problem:
            result = problem
    if before != {key: bits(given) for key, given in arguments.items()}:
        return RuntimeError("an argument was changed in place")
    return result


def may_be_left_out(entry, name):
    """Whether None stands for an argument that is not given."""
    parameter = inspect.signature(entry.call).parameters.get(name)
    return parameter is not None and parameter.default is None


def names_one(problem, names, kinds):
    """Whether a message names one of these arguments: it begins with the name, or the mistake of a
    deck is in the key, or that of a law in its groups."""
    text = str(problem)
    known = [f"{one}: " for one in names]
    in_deck = [f'key "{one}' for one in names]
    if any(kinds[one] == "law" for one in names):
        # Names of groups and keys are not arguments.
        known += ["deck: ", "force: ", "hamaker: ", "p0: ", "part: ", "law: "]
        in_deck += ["&force", "&frog"]
    if isinstance(problem, snapin.DeckError):
        return any(one in text for one in in_deck)
    return text.startswith(tuple(known))


def fault(entry, name, value, clean):
    """The error in the reaction of the entry's call to this value; None if there is no error."""
    result = attempt(entry, name, value)
    if isinstance(result, Exception):
        if not isinstance(result, (ValueError, TypeError, MemoryError, snapin.SnapinError)):
            return f"raised {type(result).__name__}: {str(result)[:200]}"
        # A case without any state is an error of the calculation, not of an argument.
        if isinstance(result, snapin.SnapinError) and not isinstance(result, snapin.DeckError):
            return None
        # A value that is right by itself may be inconsistent with another argument.
        alone = clean is REFUSED and entry.kinds[name] != "paired"
        if not names_one(result, [name] if alone else entry.good, entry.kinds):
            return f"the message names no argument: {type(result).__name__}: {str(result)[:200]}"
        if max(map(len, str(result).splitlines())) > 500:
            return "the message has more than 500 characters in a line"
        return None
    if clean is REFUSED:
        return f"was taken: {str(result)[:100]}"
    expected = attempt(entry, name, clean)
    if isinstance(expected, Exception) or not same(result, expected):
        return f"differs from the clean value: {str(result)[:200]} / {str(expected)[:200]}"
    return None


def main(which):
    entry = REGISTRY[which]
    signal.signal(signal.SIGPROF, signal.SIG_DFL)
    for name, kind in entry.kinds.items():
        every = KINDS_FIRST[kind] == (which, name)
        for label, value, clean in cases(kind, entry.good[name], every):
            if label == "None" and may_be_left_out(entry, name):
                continue
            signal.setitimer(signal.ITIMER_PROF, PATIENCE)
            print(json.dumps({"case": f"{which}, {name}: {label}"}), flush=True)
            print(json.dumps({"fault": fault(entry, name, value, clean)}), flush=True)
            signal.setitimer(signal.ITIMER_PROF, 0)


if __name__ == "__main__":
    for each in sys.argv[1:]:
        main(each)
