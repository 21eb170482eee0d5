"""What an experiment is about: a force law, two bodies, and how far apart they may be.

`radius`, `stiffness`, `rigid` and `law` as in `force_curve`.
"""

from typing import NamedTuple

import numpy as np

from .arguments import flag, instance, positive
from .numerics import law_arguments, law_numbers

# As in src/scene/scene_keys.f90.
_ACCURACIES = 1e-10, 1e-1
# What was tried, and ends in seconds. Beyond these the library may search for a very long time.
# h0 in lengths of the law; sigma for laws that attract, the coupling of others.
_FARTHEST = 1e8
_STRONGEST, _SOFTEST = 1e8, 1e100
_STIFFEST = 1e-100


class ForceLaw(NamedTuple):
    """A force law with its parameters, from `lennard_jones` or `exponential`."""

    law: str
    part: str
    hamaker: float
    z0: float
    p0: float
    decay_length: float


def lennard_jones(*, hamaker, z0, part="full"):
    """Return the law with Hamaker constant `hamaker` [J] and separation of zero force `z0` [m].

    `part` is "full", "repulsive" or "attractive".
    """
    return ForceLaw(*law_arguments("lennard_jones", part, {"hamaker": hamaker, "z0": z0}))


def exponential(*, p0, decay_length):
    """Return the repulsion p0 exp(-h/decay_length), `p0` [Pa], `decay_length` [m]."""
    parameters = {"p0": p0, "decay_length": decay_length}
    return ForceLaw(*law_arguments("exponential", "full", parameters))


# --- Checks


def scene_of(law, radius, stiffness, rigid):
    """Return what the library takes for a law, R, stiffness and whether the bodies are rigid."""
    law = law_of(law)
    radius, rigid = positive("radius", radius), flag("rigid", rigid)
    if rigid:
        if stiffness is not None:
            raise ValueError("stiffness: rigid bodies have none")
        return *law, radius, 1.0, rigid
    if stiffness is None:
        raise TypeError("stiffness: needed unless rigid=True")
    stiffness = positive("stiffness", stiffness)
    unit = _numbers(law)
    coupling = unit.pressure_unit / stiffness * np.sqrt(radius / unit.length)
    most = _STRONGEST if unit.surface_energy > 0 else _SOFTEST
    if coupling > most:
        raise ValueError(
            f"stiffness: too soft for this law and radius, (40) or (39) is {coupling:.3g} and "
            f"must not be above {most:g}"
        )
    if coupling < _STIFFEST:
        raise ValueError("stiffness: so stiff for this law and radius that rigid=True is meant")
    return *law, radius, stiffness, rigid


def law_of(law):
    """Return `law` checked, since anyone can make a `ForceLaw` of anything."""
    instance("law", law, ForceLaw, "lennard_jones(...) or exponential(...)")
    try:
        given = law._asdict()
        name, part = given.pop("law"), given.pop("part")
        used = {key: value for key, value in given.items() if not _is_zero(value)}
        return ForceLaw(*law_arguments(name, part, used))
    except (TypeError, ValueError) as problem:
        raise type(problem)(f"law: {problem}") from None


def within_reach(name, h0, law):
    """Refuse h0 that is beyond what was ever tried, in lengths of the law."""
    most = _FARTHEST * _numbers(law).length
    if (np.abs(h0) > most).any():
        raise ValueError(f"{name}: must be within {most:g} m, {_FARTHEST:g} lengths of the law")


def accuracy_of(accuracy):
    """Return the accuracy asked for, checked."""
    accuracy = positive("accuracy", accuracy)
    least, most = _ACCURACIES
    if not least <= accuracy <= most:
        raise ValueError(f"accuracy: must be from {least} to {most}, not {accuracy}")
    return accuracy


def _is_zero(value):
    """Whether this is the zero that stands for a parameter which the law does not have."""
    return isinstance(value, float) and value == 0


def _numbers(law):
    """Return the law's `LawNumbers`."""
    given = law._asdict()
    used = {key: given[key] for key in ("hamaker", "z0", "p0", "decay_length") if given[key]}
    return law_numbers(law.law, part=law.part, **used)
