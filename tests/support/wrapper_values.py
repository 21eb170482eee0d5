"""Values, good and bad, for every kind of argument in tests/support/wrapper_registry.py.

A case is a label, a value, and what is claimed of it: REFUSED, or the clean value whose result it
must give (a contiguous float64 array, a float, an int, a str), if it is not refused. Cases are
sorted by the property that makes the value unusual. One argument of each kind is tested with all
cases, every other argument with the first case of each sort, which shows the checks of the
argument.
"""

import array
import types
from decimal import Decimal
from fractions import Fraction

import numpy as np

REFUSED = object()
EXTREMES = (5e-324, 1e-150, 1e-30, 1e30, 1e150, np.finfo(float).max)
# Values that are not numbers.
FOREIGN = {
    "str": "1.0", "bool": True, "complex without imaginary part": complex(2.0, 0.0),
    "masked": np.ma.masked, "bytes": b"1", "object": object(), "dict": {}, "set": {1.0},
    "datetime": np.datetime64("2020-01-01"), "timedelta": np.timedelta64(3, "s"),
    "structured": np.zeros((), dtype=[("x", float), ("y", float)]), "type": float,
    "lambda": lambda: 1.0, "complex": 1 + 1j, "nested": [[1.0], [1.0, 2.0]], "numpy bool": np.True_}
NOT_FINITE = {"nan": np.nan, "inf": np.inf, "-inf": -np.inf}
NONE = {"None": None}


def refused(values):
    return [(label, value, REFUSED) for label, value in values.items()]


def taken(values, clean):
    """Cases of values that are equivalent to a clean value."""
    return [(label, value, clean) for label, value in values.items()]


def own(values):
    return [(label, value, value) for label, value in values.items()]


def scalars(good):
    many = {"list": [good], "1-d": np.array([good]), "2-d": np.array([[good]]),
            "empty": np.array([]), "two": np.array([good, good])}
    large = {"too large": 10**400, "far too large": 10**5000, "inexact whole": 2**53 + 1}
    kinds = {"longdouble": np.longdouble(good), "0-d": np.array(good), "Decimal": Decimal(good),
             "big-endian": np.array(good, dtype=">f8"), "Fraction": Fraction(good)}
    extreme = {f"{sign * value:g}": sign * value for value in EXTREMES for sign in (1, -1)}
    return {"foreign": refused(FOREIGN), "none": refused(NONE), "shape": refused(many),
            "finite": refused({**NOT_FINITE, "Decimal nan": Decimal("nan")}),
            "large": refused(large),
            "kind": taken(kinds, good), "whole": taken(
                {"int": 2, "numpy int": np.int16(2), "unsigned": np.uint8(2)}, 2.0),
            "short": [(np.dtype(kind).name, kind(good), float(kind(good)))
                      for kind in (np.float32, np.float16)],
            "sign": own({"minus one": -1.0}), "zero": own({"zero": 0.0, "minus zero": -0.0}),
            "extreme": own(extreme)}


def positives(good):
    return {sort: [(label, value, clean if clean is not REFUSED and clean > 0 else REFUSED)
                   for label, value, clean in cases] for sort, cases in scalars(good).items()}


def vectors(good):
    """Cases of a one-dimensional array."""
    n = good.size
    shapes = {"row": good[None, :], "column": good[:, None], "3-d": good.reshape(1, n, 1),
              "empty 2-d": np.empty((0, 4))}
    other = {
        "strings": good.astype(str), "complex array": good * (1 + 1j), "bools": good > good[0],
        "complex array without imaginary parts": good.astype(complex), "list of bools": [True] * n,
        "bytes array": good.astype("S"), "list of strings": [str(x) for x in good],
        "dates": np.arange(n).astype("M8[D]"), "durations": np.arange(n).astype("m8[s]"),
        "Nones": [None] * n, "one None": np.array([*good[:-1], None]),
        "a bool among objects": np.array([*good[:-1], True], dtype=object),
        "records": np.zeros(n, dtype=[("x", float)]), "void": np.zeros(n, dtype="V8"),
        "generator": (x for x in good)}
    large = {"huge": np.broadcast_to(good[0], 2**31), "enormous": np.broadcast_to(good[0], 2**40),
             "inexact wholes": np.arange(n) + 2**53, "too large": [10**400] * n}
    spread, table = np.zeros(3 * n), np.zeros((n, 3))
    spread[::3] = table[:, 1] = good
    frozen = good.copy()
    frozen.flags.writeable = False
    same = {
        "list": list(good), "strided": spread[::3], "tuple": tuple(good),
        "reversed": good[::-1].copy()[::-1], "column of a table": table[:, 1],
        "column of a Fortran table": np.asfortranarray(table)[:, 1],
        "row of a Fortran table": np.asfortranarray(table.T)[1],
        "unaligned": np.frombuffer(b"x" + good.tobytes(), offset=1, dtype=float),
        "read-only": frozen, "big-endian": good.astype(">f8"),
        "longdouble": good.astype(np.longdouble), "objects": good.astype(object),
        "Decimals": [Decimal(x) for x in good], "Fractions": [Fraction(x) for x in good],
        "array.array": array.array("d", good), "memoryview": memoryview(good.copy()),
        "nothing masked": np.ma.array(good)}
    whole = np.arange(2.0, 2.0 + n)
    ends = {f"{label} at {at}": np.r_[good[:at], value, good[at + 1:]]
            for label, value in NOT_FINITE.items() for at in (0, n - 1)}
    with np.errstate(over="ignore"):
        extreme = {label: array for value in (*EXTREMES, 0.0) for label, array in (
            (f"all {value:g}", np.full(n, value)), (f"all {-value:g}", np.full(n, -value)),
            (f"times {value:g}", good * value), (f"last {value:g}", np.r_[good[:-1], value]),
            (f"first {-value:g}", np.r_[-value, good[1:]]))}
    return {
        "foreign": refused(FOREIGN), "none": refused(NONE), "finite": refused(ends),
        "shape": refused(shapes), "values": refused(other), "large": refused(large),
        "masked": refused({"masked values": np.ma.array(good, mask=np.arange(n) == 1)}),
        "same": taken(same, good), "broadcast": taken(
            {"broadcast": np.broadcast_to(good[0], n)}, np.full(n, good[0])),
        "short": [(np.dtype(kind).name, good.astype(kind), good.astype(kind).astype(float))
                  for kind in (np.float32, np.float16)],
        "whole": [(f"wholes {np.dtype(kind)}", whole.astype(kind), whole)
                  for kind in (np.int8, np.uint16, np.int64, np.uint64, ">i4")],
        "one": taken({"float": float(good[0]), "0-d": np.array(good[0])}, good[:1].copy()),
        "empty": own({"empty": np.array([])}), "sign": own({"negative": -good}),
        "order": taken({"descending": good[::-1]}, good[::-1].copy()), "extreme": own(extreme)}


def pairs(good):
    """Cases of a vector whose length is prescribed."""
    found = {sort: [(label, value, clean if clean is not REFUSED and clean.size == good.size
                     else REFUSED) for label, value, clean in cases]
             for sort, cases in vectors(good).items()}
    return {**found, "less": refused({"one less": good[:-1].copy()}),
            "more": refused({"one more": np.r_[good, good[-1]]})}


def counts(good):
    fractions = {"float": float(good), "half": good + 0.5, "numpy float": np.float64(good),
                 "Decimal": Decimal(good)}
    large = {"2**32 + good": 2**32 + good, "2**31": 2**31, "2**63": 2**63,
             "2**64 + good": 2**64 + good, "far too large": 10**5000}
    return {"foreign": refused(FOREIGN), "none": refused(NONE), "finite": refused(NOT_FINITE),
            "fraction": refused(fractions), "shape": refused(
                {"list": [good], "1-d": np.array([good])}), "large": refused(large),
            "sign": refused({"negative": -1, "most negative": -(2**63)}),
            "kind": taken({np.dtype(kind).name: kind(good) for kind in
                           (np.int8, np.uint8, np.int64, np.uint64)}
                          | {"0-d": np.array(good)}, good),
            "few": own({"zero": 0, "one": 1, "two": 2})}


def names(good):
    wrong = {"number": 1, "bytes": good.encode(), "blank": "", "NUL behind": good + "\0",
             "long": good * 100_000, "not ASCII": "é" * 300, "lone surrogate": "\ud800"}
    return {"foreign": refused(FOREIGN), "none": refused(NONE), "finite": refused(NOT_FINITE),
            "wrong": refused(wrong), "blank": refused({"space behind": good + " "}),
            "case": refused({"upper case": good.upper()}),
            "shape": refused({"list": [good], "tuple": (good,)}), "array": refused(
                {"array": np.array([good]), "two": np.array([good, good])}),
            "kind": taken({"numpy str": np.str_(good)}, good)}


def in_deck(make, like_good, left_out=()):
    """Cases of the same as a key of a deck: it may be omitted, one value may be a list, and the
    deck determines the range."""
    def cases(good):
        return {sort: [(label, value, good if label in like_good else clean)
                       for label, value, clean in each if label not in left_out]
                for sort, each in make(good).items() if sort != "none"}
    return cases


def switches(good):
    foreign = {label: value for label, value in FOREIGN.items() if "bool" not in label}
    return {"foreign": refused(foreign), "finite": refused(NOT_FINITE),
            "number": refused({"0": 0, "1": 1}), "shape": refused(
                {"list": [good], "array": np.array([good])}), "name": refused({"name": "False"}),
            "kind": taken({"numpy bool": np.bool_(good)}, good)}


def flags(good):
    """Cases of as many bools as the call has values."""
    n = good.size
    foreign = {label: value for label, value in FOREIGN.items() if "bool" not in label}
    return {"foreign": refused(foreign), "none": refused(NONE), "finite": refused(NOT_FINITE),
            "number": refused({"0": 0, "1": 1, "numbers": good.astype(float)}),
            "shape": refused({
                "row": good[None, :], "one more": np.r_[good, True], "empty": good[:0]}),
            "masked": refused({"masked": np.ma.array(good, mask=np.arange(n) == 0)}),
            "one": taken({"bool": True, "numpy bool": np.True_}, np.full(n, True)),
            "same": taken({"list": good.tolist(), "strided": np.repeat(good, 2)[::2]}, good)}


def laws(good):
    """Cases of a law: a group, with one key exchanged."""
    keys = good["force"]
    number = next(key for key, value in keys.items() if isinstance(value, float))
    forms = {"name": keys["law"], "keys without a group": keys,
             "group of another kind": {"force": list(keys)}, "group without keys": {"force": True},
             "unknown group": {**good, "frog": {}},
             "name of a group that ends it": {"force / &x": keys}, "name of no kind": {1: keys}}
    changes = {
        "unknown": {"law": "none"}, "unknown part": {"part": "half"}, "no name": {"law": None},
        "name of bytes": {"law": keys["law"].encode()}, "negative": {number: -1.0},
        "nan": {number: np.nan}, "strings": {number: "1"}, "complex": {number: 1 + 1j},
        "arrays": {number: np.ones(2)}, "unknown key": {"frog": 1.0},
        "key that ends another": {"frog = 1, x": 1.0},
        "text that ends itself": {"part": "full' / &loading /"}, "line end": {"part": "full\n"},
        "NUL": {"part": "full\0"}}
    return {"foreign": refused(FOREIGN), "none": refused(NONE), "finite": refused(NOT_FINITE),
            "form": refused(forms), "key": refused(
                {label: {"force": {**keys, **change}} for label, change in changes.items()}),
            "mapping": taken({"another mapping": types.MappingProxyType(good)}, good),
            "whole": taken({"whole number": {"force": {**keys, number: 5}}},
                           {"force": {**keys, number: 5.0}})}


def meshes(good):
    return {"foreign": refused(FOREIGN), "none": refused(NONE), "finite": refused(NOT_FINITE),
            "kind": refused({"nodes": good.x, "class": type(good)})}


_CASES = {
    "vector": vectors, "paired": pairs, "scalar": scalars, "positive": positives, "count": counts,
    "name": names, "law": laws, "mesh": meshes, "switch": switches,
    "flags": flags,
    # An integer that float64 cannot represent is rounded to the nearest, as in a deck.
    "number": in_deck(scalars, ("list", "1-d"), ("inexact whole",)),
    "whole": in_deck(counts, ("list", "1-d")),
    # Case and trailing blanks have no effect.
    "word": in_deck(names, ("space behind", "upper case", "list", "tuple")),
}


def cases(kind, good, every=True):
    """The cases of a kind of argument that has a good value, or the first of each sort."""
    return [case for sort in _CASES[kind](good).values() for case in (sort if every else sort[:1])]
