"""The numbers that an experiment with stepped h0 must report, from the reference path.

The bodies stay on a stable branch to its end and then jump to the other branch: the length of the
steps makes no difference. Units: z0 for h0, gamma R for loads.
"""

import math
from typing import NamedTuple


class Leg(NamedTuple):
    """A part of one branch, from one point of the path to another."""

    first: object
    last: object


class Cycle(NamedTuple):
    """The branches of an experiment: each a list of legs, with a jump between successive legs."""

    path: object
    loading: list
    unloadings: list


def cycle(path, start, end, turning=(), retreat=None):
    """Loading from `start` down to `end`; from each turning point back up to `retreat`."""
    loading = approach(path, start, end)
    unloadings = [withdrawal(path, start, turn, retreat) for turn in turning]
    return Cycle(path, loading, unloadings)


def in_contact(path, start, h0):
    """Whether an approach whose first state is at `start` has jumped into contact at h0."""
    return bool(path.folds) and min(start, h0) < path.jump_in.h0


def approach(path, start, end):
    far, contact = path.far_branch, path.contact_branch
    if not path.folds or not in_contact(path, start, end):
        return [Leg(path.on(far, start), path.on(far, end))]
    fold = path.jump_in.h0
    if start < fold:
        return [Leg(path.on(contact, start), path.on(contact, end))]
    return [
        Leg(path.on(far, start), path.jump_in), Leg(path.on(contact, fold), path.on(contact, end))]


def withdrawal(path, start, turn, retreat):
    far, contact = path.far_branch, path.contact_branch
    if not in_contact(path, start, turn):
        return [Leg(path.on(far, turn), path.on(far, retreat))]
    fold = path.jump_out.h0
    if retreat <= fold:
        return [Leg(path.on(contact, turn), path.on(contact, retreat))]
    return [
        Leg(path.on(contact, turn), path.jump_out), Leg(path.on(far, fold), path.on(far, retreat))]


def largest_tension(path, legs):
    """The point of largest tension on a branch; None if all loads are positive."""
    passed = [point for leg in legs for point in path.swept(leg.first, leg.last)]
    lowest = min(passed, key=lambda point: point.load)
    return lowest if lowest.load < 0 else None


def reported(found):
    """The numbers of a summary. None: the key is absent; NaN: no value at this turning point."""
    path = found.path
    branches = [largest_tension(path, legs) for legs in (found.loading, *found.unloadings)]
    tensions = [point for point in branches if point]
    largest = min(tensions, key=lambda point: point.load) if tensions else None
    end = found.loading[-1].last
    numbers = {
        "max_tension": largest and -largest.load, "max_tension_h0": largest and largest.h0,
        "end_load": end.load, "end_displacement": end.displacement}
    jumps_in = len(found.loading) > 1
    jumps_out = any(len(legs) > 1 for legs in found.unloadings)
    for name, there, fold in (("in", jumps_in, path.jump_in), ("out", jumps_out, path.jump_out)):
        numbers[f"jump_{name}_h0"] = fold.h0 if there else None
        numbers[f"jump_{name}_load"] = fold.load if there else None
    if found.unloadings:
        numbers["unload_max_tension"] = [-p.load if p else math.nan for p in branches[1:]]
        numbers["unload_max_tension_h0"] = [p.h0 if p else math.nan for p in branches[1:]]
        numbers["unload_jump_out_h0"] = [
            path.jump_out.h0 if len(legs) > 1 else math.nan for legs in found.unloadings]
        # A list without any value is absent.
        numbers.update({key: None for key, values in numbers.items()
                        if isinstance(values, list) and all(map(math.isnan, values))})
    return numbers


def reported_of_path(path, h0_end):
    """The same for the whole path of equilibria down to h0_end on its last branch."""
    end = path.on(path.contact_branch, h0_end)
    passed = [p for p in path.load_folds if p.place < end.place]
    pull_off = path.pull_off
    numbers = {
        "max_tension": -pull_off.load,
        "max_tension_h0": pull_off.h0,
        "end_load": end.load,
        "end_displacement": end.displacement,
        "load_folds_h0": [p.h0 for p in passed],
        "load_folds_load": [p.load for p in passed],
        "folds_h0": [p.h0 for p in path.folds],
        "folds_load": [p.load for p in path.folds],
    }
    for name, fold in (("in", path.jump_in), ("out", path.jump_out)):
        numbers[f"jump_{name}_h0"] = fold and fold.h0
        numbers[f"jump_{name}_load"] = fold and fold.load
    numbers["energy_lost"] = path.energy_lost
    return numbers
