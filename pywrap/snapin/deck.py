"""Decks: their text from a dictionary of groups, a text or a file.

Only the program knows the groups and keys and their ranges: a mistake is a `DeckError` with the
program's message.
"""

import os
import re
from collections.abc import Mapping
from typing import Any, Optional, Union

import numpy as np

from .arguments import DeckError, Path, SnapinError, reals, shown

#: Groups of a deck by name: each a dictionary of its keys, True for one without keys, or None.
Groups = Mapping[str, Any]
#: A deck: its groups, its text, or its path.
Deck = Union[Groups, Path]

_BAD_INPUT, _NO_ROOM = 1, 3
# f2py counts bytes in C ints; the program's own limit for decks is far lower.
_MOST_BYTES = 2**30


def deck_of(deck: Deck) -> tuple[str, bytes]:
    """Return name and text of a deck: a dictionary of groups, a text (it has an &), or a path."""
    if isinstance(deck, Mapping):
        return "deck", deck_text(deck).encode()
    if isinstance(deck, str) and "&" in deck:
        try:
            return "deck", deck.encode()
        except UnicodeEncodeError:
            raise ValueError("deck: a deck is plain text") from None
    if not isinstance(deck, (str, os.PathLike)):
        raise TypeError(f"deck: a dictionary, a text or a path is needed, not {shown(deck)}")
    with open(deck, "rb") as file:
        return os.fspath(deck), file.read(_MOST_BYTES)


def deck_text(groups: Groups) -> str:
    """Return the text of a deck, one key on each line.

    `groups` maps names of groups to dictionaries of their keys. True is a group without keys; a
    group or key whose value is None is left out.
    """
    if not isinstance(groups, Mapping):
        raise TypeError(f"deck: a dictionary of groups is needed, not {shown(groups)}")
    return "".join(_group_text(name, keys) for name, keys in groups.items() if keys is not None)


def _group_text(group, keys):
    if keys is True:
        keys = {}
    if not isinstance(keys, Mapping):
        raise TypeError(f"{_name(group)}: a dictionary of keys is needed, not {shown(keys)}")
    lines = [
        f"  {_name(key)} = {_value_text(key, value)}\n"
        for key, value in keys.items()
        if value is not None
    ]
    return f"&{_name(group)}\n{''.join(lines)}/\n"


def _name(word):
    """Return the name of a group or a key, if it is valid."""
    if not isinstance(word, str) or not re.fullmatch(r"[A-Za-z]\w*", word, re.ASCII):
        raise ValueError(f"deck: a name of a group or key is needed, not {shown(word)}")
    return word


def _value_text(name, value):
    """Return a value in namelist form; numbers with all digits."""
    if isinstance(value, (bool, np.bool_)):
        return ".true." if value else ".false."
    if isinstance(value, str):
        return _quoted(name, value)
    if isinstance(value, (list, tuple)) and value and all(isinstance(one, str) for one in value):
        return ", ".join(_quoted(name, one) for one in value)
    numbers = reals(name, value)
    if numbers.ndim > 1 or numbers.size == 0:
        raise ValueError(f"{name}: one or more values are needed, not shape {numbers.shape}")
    kind = int if np.asarray(value).dtype.kind in "iu" else float
    return ", ".join(repr(kind(number)) for number in numbers.flat)


def _quoted(name, text):
    if not text.isprintable():
        raise ValueError(f"{name}: text of printable characters is needed, not {shown(text)}")
    return "'" + text.replace("'", "''") + "'"


def accept_deck(stat: int, message: bytes) -> None:
    """Raise the error that the library reported; `stat` is 0 or a kind of src/base/failure.f90."""
    if stat:
        text = message.decode(errors="replace").rstrip()
        kinds = {_BAD_INPUT: DeckError, _NO_ROOM: MemoryError}
        raise kinds.get(stat, SnapinError)(text)


# --- Groups from a few arguments


def force(law: str, **keys: Any) -> dict[str, dict[str, Any]]:
    """Return the group of a force law by its name in &force, with its keys."""
    return {"force": {"law": law, **keys}}


def lennard_jones(**keys: Any) -> dict[str, dict[str, Any]]:
    """Return the group of the Lennard-Jones law; its keys are those of &force."""
    return force("lennard_jones", **keys)


def exponential(**keys: Any) -> dict[str, dict[str, Any]]:
    """Return the group of the exponential repulsion; its keys are those of &force."""
    return force("exponential", **keys)


def scene(law: Groups, radius: float, stiffness: Optional[float], rigid: bool,
          **groups: Any) -> dict[str, Any]:
    """Return the groups of a deck: the two bodies, those of a law, and others."""
    if not isinstance(law, Mapping):
        raise TypeError(f"law: a dictionary of groups is needed, not {shown(law)}")
    return {"bodies": {"radius": radius, "stiffness": stiffness, "rigid": rigid}, **law, **groups}


def problem_deck(law: Groups, radius: float = 1.0, stiffness: Optional[float] = None,
                 rigid: bool = True) -> bytes:
    """Return the text of a deck with law and bodies, for a problem without an experiment."""
    nothing = {"h0_start": 1e-50, "h0_end": 0.0}
    return deck_text(scene(law, radius, stiffness, rigid, classical=nothing)).encode()
