"""Values, good and bad, for every kind of argument in tests/support/wrapper_registry.py.

A case is a label, a value, and what is claimed of it: REFUSED, or the clean value whose result it
must give (a contiguous float64 array, a float, an int, a str), if it is not refused.
"""

import array
import types
from decimal import Decimal
from fractions import Fraction

import numpy as np

REFUSED = object()
EXTREMES = (5e-324, 1e-308, 1e-150, 1e-30, 1e30, 1e150, 1e300, np.finfo(float).max)
# No number of any kind.
FOREIGN = {
    "str": "1.0",
    "bytes": b"1",
    "object": object(),
    "dict": {},
    "set": {1.0},
    "datetime": np.datetime64("2020-01-01"),
    "timedelta": np.timedelta64(3, "s"),
    "structured": np.zeros((), dtype=[("x", float), ("y", float)]),
    "type": float,
    "lambda": lambda: 1.0,
    "complex": 1 + 1j,
    "complex without imaginary part": complex(2.0, 0.0),
    "masked": np.ma.masked,
    "nested": [[1.0], [1.0, 2.0]],
    "bool": True,
    "numpy bool": np.True_,
}
NOT_FINITE = {"nan": np.nan, "inf": np.inf, "-inf": -np.inf}


def scalars(good):
    """Cases of a real number."""
    for label, value in {**FOREIGN, **NOT_FINITE}.items():
        yield label, value, REFUSED
    for label, value in {
        "None": None,
        "list": [good],
        "1-d": np.array([good]),
        "2-d": np.array([[good]]),
        "empty": np.array([]),
        "two": np.array([good, good]),
        "too large": 10**400,
        "far too large": 10**5000,
        "inexact whole": 2**53 + 1,
        "Decimal nan": Decimal("nan"),
    }.items():
        yield label, value, REFUSED
    single = np.float32(good)
    yield "float32", single, float(single)
    yield "float16", np.float16(good), float(np.float16(good))
    yield "longdouble", np.longdouble(good), good
    yield "0-d", np.array(good), good
    yield "big-endian", np.array(good, dtype=">f8"), good
    yield "Decimal", Decimal(good), good
    yield "Fraction", Fraction(good), good
    yield "int", 2, 2.0
    yield "numpy int", np.int16(2), 2.0
    yield "unsigned", np.uint8(2), 2.0
    for value in EXTREMES:
        yield f"{value:g}", value, value
        yield f"{-value:g}", -value, -value
    yield "zero", 0.0, 0.0
    yield "minus zero", -0.0, -0.0


def positives(good):
    """Cases of a number above zero."""
    for label, value, clean in scalars(good):
        refused = clean is REFUSED or not clean > 0
        yield label, value, REFUSED if refused else clean


def vectors(good):
    """Cases of a one-dimensional array."""
    n = good.size
    for label, value in FOREIGN.items():
        yield label, value, REFUSED
    for label, value in NOT_FINITE.items():
        for at in 0, n - 1:
            bad = good.copy()
            bad[at] = value
            yield f"{label} at {at}", bad, REFUSED
    masked = np.ma.array(good, mask=np.arange(n) == 1)
    for label, value in {
        "None": None,
        "row": good[None, :],
        "column": good[:, None],
        "3-d": good.reshape(1, n, 1),
        "empty 2-d": np.empty((0, 4)),
        "complex array": good * (1 + 1j),
        "complex array without imaginary parts": good.astype(complex),
        "bools": good > good[0],
        "list of bools": [True] * n,
        "strings": good.astype(str),
        "bytes array": good.astype("S"),
        "list of strings": [str(x) for x in good],
        "dates": np.arange(n).astype("M8[D]"),
        "durations": np.arange(n).astype("m8[s]"),
        "Nones": [None] * n,
        "one None": np.array([*good[:-1], None]),
        "a bool among objects": np.array([*good[:-1], True], dtype=object),
        "records": np.zeros(n, dtype=[("x", float)]),
        "void": np.zeros(n, dtype="V8"),
        "masked values": masked,
        "generator": (x for x in good),
        "inexact wholes": np.arange(n) + 2**53,
        "too large": [10**400] * n,
        "huge": np.broadcast_to(good[0], 2**31),
        "enormous": np.broadcast_to(good[0], 2**40),
    }.items():
        yield label, value, REFUSED
    spread = np.zeros(3 * n)
    spread[::3] = good
    table = np.zeros((n, 3), order="C")
    table[:, 1] = good
    shifted = np.frombuffer(b"x" + good.tobytes(), offset=1, dtype=float)
    frozen = good.copy()
    frozen.flags.writeable = False
    for label, value in {
        "list": list(good),
        "tuple": tuple(good),
        "strided": spread[::3],
        "reversed": good[::-1].copy()[::-1],
        "column of a table": table[:, 1],
        "column of a Fortran table": np.asfortranarray(table)[:, 1],
        "row of a Fortran table": np.asfortranarray(table.T)[1],
        "unaligned": shifted,
        "read-only": frozen,
        "big-endian": good.astype(">f8"),
        "longdouble": good.astype(np.longdouble),
        "objects": good.astype(object),
        "Decimals": [Decimal(x) for x in good],
        "Fractions": [Fraction(x) for x in good],
        "array.array": array.array("d", good),
        "memoryview": memoryview(good.copy()),
        "nothing masked": np.ma.array(good),
    }.items():
        yield label, value, good
    for kind in np.float32, np.float16:
        yield np.dtype(kind).name, good.astype(kind), good.astype(kind).astype(float)
    whole = np.arange(2.0, 2.0 + n)
    for kind in np.int8, np.uint16, np.int64, np.uint64, ">i4":
        yield f"wholes {np.dtype(kind)}", whole.astype(kind), whole
    yield "broadcast", np.broadcast_to(good[0], n), np.full(n, good[0])
    yield "0-d", np.array(good[0]), good[:1].copy()
    yield "float", float(good[0]), good[:1].copy()
    yield "empty", np.array([]), np.array([])
    for value in (0.0, *EXTREMES):
        yield f"all {value:g}", np.full(n, value), np.full(n, value)
        yield f"all {-value:g}", np.full(n, -value), np.full(n, -value)
        with np.errstate(over="ignore"):
            scaled = good * value
        yield f"times {value:g}", scaled, scaled
        yield f"last {value:g}", np.r_[good[:-1], value], np.r_[good[:-1], value]
        yield f"first {-value:g}", np.r_[-value, good[1:]], np.r_[-value, good[1:]]
    yield "negative", -good, -good
    yield "descending", good[::-1], good[::-1].copy()


def pairs(good):
    """Cases of a vector whose length is prescribed."""
    for label, value, clean in vectors(good):
        other = clean is not REFUSED and clean.size != good.size
        yield label, value, REFUSED if other else clean
    yield "one less", good[:-1].copy(), REFUSED
    yield "one more", np.r_[good, good[-1]], REFUSED


def counts(good):
    """Cases of a whole number."""
    for label, value in {**FOREIGN, **NOT_FINITE}.items():
        yield label, value, REFUSED
    for label, value in {
        "None": None,
        "float": float(good),
        "half": good + 0.5,
        "numpy float": np.float64(good),
        "list": [good],
        "1-d": np.array([good]),
        "negative": -1,
        "most negative": -(2**63),
        "2**31": 2**31,
        "2**32 + good": 2**32 + good,
        "2**63": 2**63,
        "2**64 + good": 2**64 + good,
        "far too large": 10**5000,
        "Decimal": Decimal(good),
    }.items():
        yield label, value, REFUSED
    for kind in np.int8, np.uint8, np.int64, np.uint64:
        yield np.dtype(kind).name, kind(good), good
    yield "0-d", np.array(good), good
    yield "zero", 0, 0
    yield "one", 1, 1
    yield "two", 2, 2


def names(good):
    """Cases of a name."""
    for label, value in {**FOREIGN, **NOT_FINITE}.items():
        yield label, value, REFUSED
    for label, value in {
        "None": None,
        "number": 1,
        "bytes": good.encode(),
        "blank": "",
        "space behind": good + " ",
        "NUL behind": good + "\0",
        "upper case": good.upper(),
        "long": good * 100_000,
        "not ASCII": "é" * 300,
        "lone surrogate": "\ud800",
        "list": [good],
        "tuple": (good,),
        "array": np.array([good]),
        "two": np.array([good, good]),
    }.items():
        yield label, value, REFUSED
    yield "numpy str", np.str_(good), good


def numbers(good):
    """Cases of a number in a deck: one value may be a list; which are in range the deck says."""
    for label, value, clean in scalars(good):
        if label in ("list", "1-d"):
            clean = good
        # Beyond float64's whole numbers the nearest is taken, as from a deck that someone wrote.
        if label not in ("None", "inexact whole"):
            yield label, value, clean


def wholes(good):
    """Cases of a whole number in a deck."""
    for label, value, clean in counts(good):
        if label in ("list", "1-d"):
            clean = good
        if label != "None":
            yield label, value, clean


def words(good):
    """Cases of a word in a deck, which minds neither case nor blanks at the end."""
    for label, value, clean in names(good):
        if label in ("space behind", "upper case", "list", "tuple"):
            clean = good
        if label != "None":
            yield label, value, clean


def switches(good):
    """Cases of True or False in a deck."""
    for label, value in {**FOREIGN, **NOT_FINITE}.items():
        if not isinstance(value, (bool, np.bool_)):
            yield label, value, REFUSED
    for label, value in {
        "0": 0, "1": 1, "list": [good], "array": np.array([good]), "name": "False",
    }.items():
        yield label, value, REFUSED
    yield "numpy bool", np.bool_(good), good


def laws(good):
    """Cases of a law: a group, with one key exchanged."""
    for label, value in {**FOREIGN, **NOT_FINITE}.items():
        yield label, value, REFUSED
    keys = good["force"]
    number = next(key for key, value in keys.items() if isinstance(value, float))
    for label, value in {
        "None": None,
        "name": keys["law"],
        "keys without a group": keys,
        "group of another kind": {"force": list(keys)},
        "group without keys": {"force": True},
        "unknown group": {**good, "frog": {}},
        "name of a group that ends it": {"force / &x": keys},
        "name of no kind": {1: keys},
    }.items():
        yield label, value, REFUSED
    for label, change in {
        "unknown": {"law": "none"},
        "unknown part": {"part": "half"},
        "no name": {"law": None},
        "name of bytes": {"law": keys["law"].encode()},
        "negative": {number: -1.0},
        "nan": {number: np.nan},
        "strings": {number: "1"},
        "complex": {number: 1 + 1j},
        "arrays": {number: np.ones(2)},
        "unknown key": {"frog": 1.0},
        "key that ends another": {"frog = 1, x": 1.0},
        "text that ends itself": {"part": "full' / &loading /"},
        "line end": {"part": "full\n"},
        "NUL": {"part": "full\0"},
    }.items():
        yield label, {"force": {**keys, **change}}, REFUSED
    yield "another mapping", types.MappingProxyType(good), good
    yield "whole number", {"force": {**keys, number: 5}}, {"force": {**keys, number: 5.0}}


def meshes(good):
    """Cases of a mesh."""
    for label, value in {**FOREIGN, **NOT_FINITE}.items():
        yield label, value, REFUSED
    for label, value in {"None": None, "nodes": good.x, "class": type(good)}.items():
        yield label, value, REFUSED


CASES = {
    "vector": vectors,
    "paired": pairs,
    "scalar": scalars,
    "positive": positives,
    "count": counts,
    "name": names,
    "number": numbers,
    "whole": wholes,
    "word": words,
    "switch": switches,
    "law": laws,
    "mesh": meshes,
}
