"""Random relatives of decks under sums of forces: steps outside a repulsion, outer contacts,
springs that jump beyond the end of the path, and rounded punches on thin layers.

The numbers of a run at a low accuracy are compared with those at a high one; folds and the last
load of the latter with `second_mesh`, which shares no mesh, matrix or iteration with the program.
"""

import math

import numpy as np
from support.relatives import Judged, is_told, numbers_verdict
from support.relatives_forces import results_of
from support.scenes import deck, read_table, several
from support.second_mesh import SecondMesh
from support.study_cycles import logarithmic

LOADS = ("max_tension", "end_load", "jump_in_load", "jump_out_load", "folds_load")
PLACES = ("max_tension_h0", "jump_in_h0", "jump_out_h0", "folds_h0", "device_jump_in_z",
          "device_jump_out_z")
SPRINGS = ("device_jump_in_load", "device_jump_in_load_after", "device_jump_out_load",
           "device_jump_out_load_after")
FINE = 1e-8
# How far from a fold states are read, in lengths of the law; beyond several errors of the truth.
BESIDE, SURE = 2e-3, 3
# The second mesh may be so far off: three times the difference of two of its resolutions, and this
# part of the largest load or of the length (the deformation is constant beyond it).
ROUGH = 2e-7


def step(rng):
    """Around `step_outside_repulsion`."""
    reach = 2.84e-9 * rng.uniform(0.7, 1.5)
    groups = {
        "bodies": {"stiffness": 1.42e6 * logarithmic(rng, 0.3, 30)},
        "shape": {"kind": "power", "exponent": rng.uniform(1.7, 2.4)},
        "dugdale": {"stress": 2.27e5 * logarithmic(rng, 0.3, 5), "range": reach,
                    "smoothing": reach * logarithmic(rng, 0.008, 0.1)},
        "force": {"law": "exponential", "p0": 5.5e8 * logarithmic(rng, 0.2, 5),
                  "decay_length": 2.82e-10 * rng.uniform(0.6, 1.3)},
        "equilibrium_path": {"h0_end": -9.28e-9 * logarithmic(rng, 0.1, 1.5)},
    }
    # The same height at the width of the contact.
    exponent = groups["shape"]["exponent"]
    groups["shape"]["coefficient"] = 22135.0 * (3e-7) ** (1.944 - exponent)
    return groups, reach, {}


def outer(rng):
    """Around `ends_in_which_contact`."""
    z0 = 1.3e-9 * rng.uniform(0.5, 1.3)
    groups = {
        "bodies": {"radius": 9.17e-4 * logarithmic(rng, 0.3, 3),
                   "stiffness": 1.03e10 * logarithmic(rng, 0.3, 3)},
        "capillary": {"humidity": rng.uniform(0.2, 0.6), "contact_angle": rng.uniform(0, 1)},
        "van_der_waals": {"hamaker": 1e-20 * logarithmic(rng, 0.3, 10)},
        "born": {"z0": z0},
        "equilibrium_path": {"h0_end": -6.18e-9 * logarithmic(rng, 0.3, 2)},
    }
    return groups, z0, {}


def spring(rng):
    """Around `springs_beyond_the_end`."""
    z0 = 5.2e-10 * rng.uniform(0.8, 1.2)
    radius, stiffness = 2.26e-6 * logarithmic(rng, 0.5, 30), 1.47e9 * logarithmic(rng, 0.5, 2)
    scale = stiffness * math.sqrt(radius * z0)
    groups = {
        "bodies": {"radius": radius, "stiffness": stiffness},
        "van_der_waals": {"hamaker": 2.78e-18 * logarithmic(rng, 0.3, 1.5)},
        "born": {"z0": z0},
        "hydration": {"energy": 0.39 * logarithmic(rng, 0.2, 1.3),
                      "decay_length": 6.07e-10 * rng.uniform(0.8, 1.5)},
        "equilibrium_path": {"h0_end": -2.53e-9 * logarithmic(rng, 0.3, 3)},
        "device": {"stiffness": [scale * logarithmic(rng, 0.5, 200),
                                 scale * logarithmic(rng, 0.02, 2)]},
    }
    return groups, z0, {"softness": True}


def punch(rng):
    """Around `lost_punches`: flat faces of a few thicknesses."""
    z0 = 3.1e-10 * logarithmic(rng, 1, 30)
    thickness = z0 * logarithmic(rng, 30, 300)
    flat = thickness * logarithmic(rng, 0.3, 6)
    young = 10 ** rng.uniform(6.5, 9.5)
    groups = {
        "bodies": {"rigid": True, "radius": flat * logarithmic(rng, 3, 30)},
        "shape": {"kind": "rounded_punch", "flat_radius": flat},
        "layer": {"thickness": thickness, "young": young, "poisson": rng.uniform(0.3, 0.49)},
        "force": {"law": "lennard_jones", "z0": z0,
                  "surface_energy": young * z0 * logarithmic(rng, 1e-3, 0.3)},
        "equilibrium_path": {"h0_end": -z0 * rng.uniform(1, 6)},
    }
    return groups, z0, {"layers": True}


KINDS = {function.__name__: function for function in (step, outer, spring, punch)}


def examine(job):
    """The verdict on one relative."""
    rng = job.rng
    groups, length, more = KINDS[job.kind](rng)
    accuracy = float(f"{logarithmic(rng, 1e-6, 1e-2):.1g}")
    text = deck(**groups, numerics={"accuracy": accuracy})
    shown = " ".join(text.split())
    mine, warnings, status, stderr, _ = results_of(job, text)
    told = is_told(warnings, status)
    if "end_load" not in mine:
        return Judged.lost(job, shown, told, stderr)
    truth, doubts, fine, _, _ = results_of(job, deck(**groups, numerics={"accuracy": FINE}))
    if fine != 0 or "end_load" not in truth or any("could not be estimated" in x for x in doubts):
        judged = Judged.undecided(job, shown)
        if told:
            judged.doubt = ""
            judged.told.append("neither run is sure")
        return judged
    unit = max(map(abs, (truth["end_load"], truth.get("max_tension", 0.0))))
    off, absent = compared(mine, truth, unit, length)
    judged = numbers_verdict(job, shown, told, off, absent)
    if not told:
        judged.silent += loading_elsewhere(job, groups, truth, unit)
    if not more.get("layers") and not is_told(doubts):
        checked, wrong = confirmed(job, groups, truth, unit, length)
        judged.within += checked - len(wrong)
        judged.silent += wrong
    return judged


def compared(mine, truth, unit, length):
    """Errors of the numbers of a run, and what is absent or more than in the truth."""
    off, absent = [], []
    for key in (*LOADS, *PLACES, *SPRINGS):
        ours, theirs = (several(one.get(key, [])) for one in (mine, truth))
        if [math.isnan(x) for x in ours] != [math.isnan(x) for x in theirs]:
            absent.append(f"{key} has {ours} for {theirs}")
            continue
        errors, finer = (several(one.get(f"{key}_error", [])) for one in (mine, truth))
        scale = length if key in PLACES else unit
        for i, (a, b) in enumerate(zip(ours, theirs)):
            if math.isnan(a):
                continue
            allowed = (errors[i] if i < len(errors) else mine["error_estimate"] * scale)
            known = finer[i] if i < len(finer) else truth["error_estimate"] * scale
            off.append((key, abs(a - b), allowed + SURE * known))
    return off, absent


def loading_elsewhere(job, groups, truth, unit):
    """A loading to the same h0 ends in the same contact as the path, if no fold is between."""
    far = max(map(abs, several(truth.get("folds_h0", [0.0])))) + 3e-8
    end = groups["equilibrium_path"]["h0_end"]
    if "device" in groups or truth["end_h0"] != end:
        return []
    stepped = {key: value for key, value in groups.items() if key != "equilibrium_path"}
    stepped["loading"] = {"h0_start": far, "h0_end": end, "h0_step": (far - end) / 40}
    found, warnings, status, _, _ = results_of(
        job, deck(**stepped, numerics={"accuracy": 1e-4}))
    if is_told(warnings, status) or "end_load" not in found:
        return []
    error = abs(found["end_load"] - truth["end_load"])
    allowed = found["end_load_error"] + SURE * truth["end_load_error"]
    if error <= max(allowed, ROUGH * unit):
        return []
    return [f"a loading ends at {found['end_load']:.6g}, the path at {truth['end_load']:.6g}"]


def confirmed(job, groups, truth, unit, length):
    """How many numbers of the truth a second mesh has judged, and which are wrong."""
    folds = several(truth.get("folds_h0", []))
    end = truth["end_h0"]
    places = [end, *(h0 + side * BESIDE * length for h0 in folds for side in (-1, 1))]
    others = {key: value for key, value in groups.items() if key != "device"}
    found, _, status, _, folder = results_of(job, deck(
        **others, profiles={"h0": sorted(set(places))}, numerics={"accuracy": 1e-6}))
    if status != 0 or not found:
        return 0, []
    shapes = read_table(folder / "profiles.csv")
    checked, wrong = 0, []

    def judge(name, value, error, right, doubt, scale):
        nonlocal checked
        checked += 1
        if not abs(value - right) <= error + SURE * doubt + ROUGH * scale:
            wrong.append(f"{name} {value:.9g} is {right:.9g} +- {doubt:.1e} on a second mesh")

    last = states_at(shapes, end)[-1:]
    right = SecondMesh.twice(groups, last, lambda one: one.load_at(end)) if last else None
    if right:
        judge("end_load", truth["end_load"], truth["end_load_error"], *right[0], unit)
    names = [f"folds_{name}{error}" for error in ("", "_error") for name in ("h0", "load")]
    known = list(zip(*(several(truth.get(name, [])) for name in names)))
    for h0 in folds:
        pair = nearest_pair([states_at(shapes, h0 + side * BESIDE * length) for side in (-1, 1)])
        right = SecondMesh.fold(groups, pair) if pair else None
        if right:
            # The pair may belong to a neighbour of this fold.
            (x, _), (y, _) = right
            fold = min(known, key=lambda one: abs(one[0] - x) / length + abs(one[1] - y) / unit)
            judge("fold", fold[0], fold[2], *right[0], length)
            judge("load of a fold", fold[1], fold[3], *right[1], unit)
    return checked, wrong


def states_at(shapes, h0):
    """Profiles (h0, r, gap) of all states at h0, along the path."""
    here = abs(shapes["h0"] - h0) <= 1e-12 * abs(h0)
    states = sorted(set(shapes["state"][here]))
    masks = [here & (shapes["state"] == state) for state in states]
    return [(h0, shapes["r"][mask], shapes["separation"][mask]) for mask in masks]


def nearest_pair(sides):
    """The two states that are closest to each other on that side of a fold which has more states,
    or None."""
    states = max(sides, key=len)
    pairs = [(apart(one, two), (one, two)) for one, two in zip(states, states[1:])]
    return min(pairs, key=lambda item: item[0])[1] if pairs and len(min(sides, key=len)) < len(
        states) else None


def apart(one, two):
    """The largest ratio of the gaps of two states, as its logarithm."""
    r = one[1][one[1] <= two[1][-1]]
    return abs(np.log(np.interp(r, two[1], two[2]) / np.interp(r, one[1], one[2]))).max()
