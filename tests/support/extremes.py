"""Random decks with extreme values of all keys, and the claims about each of them.

As a command it tries more decks than the suite, and keeps those that break a claim:

    export SNAPIN=build-traps/snapin PYTHONPATH=tests
    .venv/bin/python -m support.extremes --first 0 --count 2000 --out FOLDER

Deck number k is always the same deck.
"""

import argparse
import collections
import functools
import math
import pathlib
import random
import re
import resource
import sys

import numpy as np
from support.decks_in_units import run_deck
from support.scenes import deck, read_groups, read_table, several
from support.spread import spread

# --- Decks


def power(rng, low, high):
    """A number whose logarithm is uniform."""
    return 10 ** rng.uniform(low, high)


def bodies(rng, radius, stiffness):
    way = rng.random()
    if way < 0.15:
        return {"radius": radius, "rigid": True}
    if way < 0.3:
        nu = [rng.choice([-0.999999, 0.0, 0.3, 0.5]) for _ in range(2)]
        return {
            "radius": radius, "young": [stiffness, stiffness * power(rng, -3, 12)], "poisson": nu}
    return {"radius": radius, "stiffness": stiffness}


def force(rng, radius, stiffness):
    """A law and its length: lengths and pressures of matter and beyond, or a random coupling."""
    if rng.random() < 0.65:
        z0 = power(rng, -12, -3)
        if rng.random() < 0.5:
            hamaker = power(rng, -30, -10)
        else:
            sigma = power(rng, -12, 12) if rng.random() < 0.5 else power(rng, -4, 5)
            hamaker = 16 * math.pi * sigma * stiffness * z0**3.5 / math.sqrt(radius)
        part = rng.choice(["full"] * 4 + ["repulsive", "attractive"])
        return {"law": "lennard_jones", "hamaker": hamaker, "z0": z0, "part": part}, z0
    decay = power(rng, -12, -3)
    if rng.random() < 0.5:
        p0 = power(rng, -6, 15)
    else:
        p0 = power(rng, -12, 12) * stiffness * math.sqrt(decay / radius)
    return {"law": "exponential", "p0": p0, "decay_length": decay}, decay


def ranges(rng, length):
    """Loading, unloading and path, in the law's lengths: far, deep, empty, overlapping, coarse."""
    start = rng.choice([8.0, 60.0, 1.5, 1.0, 0.0, -3.0, 1e3, 1e6, rng.uniform(-5, 10)])
    depth = rng.choice([1e-15, 1e-9, 1e-3, 1.0, 5.0, 10.0, 100.0, 1e4])
    end = start - depth
    if not end * length < start * length:
        end = start - 1.0
    steps = rng.choice([0.3, 1.0, 3.7, 10.0, 30.0])
    groups = {}
    if rng.random() < 0.75:
        span = start * length - end * length
        groups["loading"] = {
            "h0_start": start * length, "h0_end": end * length, "h0_step": span / steps}
        if rng.random() < 0.6:
            low, high = groups["loading"]["h0_end"], groups["loading"]["h0_start"]
            turning = [low] + [rng.uniform(low, high) for _ in range(rng.choice([0, 0, 1, 3]))]
            groups["unloading"] = {"from_": [t for t in turning if low <= t < high]}
            if rng.random() < 0.3:
                groups["unloading"]["h0_end"] = high + abs(span) * power(rng, -3, 3)
                groups["unloading"]["h0_step"] = (groups["unloading"]["h0_end"] - low) / steps
    if rng.random() < 0.4 or not groups:
        groups["equilibrium_path"] = {"h0_end": end * length}
        if rng.random() < 0.2:
            groups["equilibrium_path"]["h0_start"] = max(start, 0.0) * length + 2 * length
    return groups


def effects(rng, groups):
    if rng.random() < 0.15:
        groups["stability"] = {}
    if rng.random() < 0.2:
        groups["classical"] = {"count": rng.choice([2, 7])}
    if rng.random() < 0.2:
        groups["approximations"] = {"count": rng.choice([2, 7])}
    if rng.random() < 0.2 and "loading" in groups:
        low, high = groups["loading"]["h0_end"], groups["loading"]["h0_start"]
        groups["profiles"] = {"h0": [low, 0.5 * (low + high)]}


def numerics(rng, radius, length):
    """Grids of two nodes and of hundreds, iterations that cannot end, tolerances at both ends."""
    keys = {}
    keys["method"] = rng.choice(["auto"] * 4 + ["anderson", "newton", "mixing", "anderson_mixing"])
    if rng.random() < 0.35:
        keys["grid"] = rng.choice(["uniform", "panels"])
    fixed = keys.get("grid") == "uniform" or "mixing" in keys["method"]
    if fixed or rng.random() < 0.1:
        keys["nodes"] = rng.choice([2, 3, 10, 50, 120])
    if rng.random() < 0.1:
        keys["r_max"] = math.sqrt(radius * length) * power(rng, -6, 6)
    if rng.random() < 0.4:
        keys["accuracy"] = power(rng, -10, -1)
    if rng.random() < 0.1:
        keys["residual_tolerance"] = power(rng, -13, -2)
    if rng.random() < 0.1 or "mixing" in keys["method"]:
        keys["max_iterations"] = rng.choice([1, 2, 10, 300])
    if rng.random() < 0.1:
        keys["mixing_limit"] = power(rng, -12, 0)
    if rng.random() < 0.1:
        keys["convergence"] = "displacement_change"
        keys["displacement_tolerance"] = length * power(rng, -12, 3)
    if rng.random() < 0.1:
        keys["panel_order"] = rng.choice([4, 24])
    if rng.random() < 0.1:
        keys["anderson_depth"] = rng.choice([0, 1, 20, 60])
    return keys


def extreme_deck(number):
    rng = random.Random(number)
    radius, stiffness = power(rng, -9, 6), power(rng, 0, 15)
    law, length = force(rng, radius, stiffness)
    groups = ranges(rng, length)
    effects(rng, groups)
    sweep = None
    if rng.random() < 0.05:
        sweep = {"key": "bodies.radius", "from_": radius, "to": 1e3 * radius, "count": 2}
        # A sweep has no states.
        groups = {name: keys for name, keys in groups.items()
                  if name not in ("stability", "profiles")}
    return deck(
        bodies=bodies(rng, radius, stiffness), force=law, **groups, sweep=sweep,
        numerics=numerics(rng, radius, length))


# --- Claims

# Fortran's output for a number that does not fit, is infinite or is NaN.
NO_NUMBER = re.compile(r"\*|\b(nan|inf|infinity)\b", re.IGNORECASE)
# Columns of theories have NaN where a theory gives no number; arrays of the summary have NaN for a
# turning point without a jump.
MAY_BE_NAN = ("classical.csv", "approximations.csv", "sweep.csv", "summary.nml")
# Columns of curve.csv that have NaN where a criterion does not apply, a row is no equilibrium, or
# an eigenvalue is not certain.
STABILITY = ("smallest_eigenvalue", "criterion_28", "criterion_29")


class Broken(AssertionError):
    """A claim that does not hold."""


def claim(holds, text):
    if not holds:
        raise Broken(text)


def check_run(status, stderr, folder):
    """Checks all claims about any deck; returns the status."""
    claim(status in (0, 1, 2), f"status {status}: {stderr[-1500:]}")
    claim("SIG" not in stderr and "Fortran runtime" not in stderr, stderr[-1500:])
    if status == 2:
        claim(not folder.exists(), "a refused deck wrote results")
        return status
    for path in folder.iterdir():
        claim(path.name != "unfinished", "unfinished files were left")
        body = [line for line in path.read_text().splitlines() if not line.startswith(("#", "!"))]
        for line in body:
            if path.name == "curve.csv" and body[0].endswith(STABILITY[-1]):
                *line, a, b, c = line.split(",")
                line = ",".join([*line, *(cell for cell in (a, b, c) if cell != "NaN")])
            found = NO_NUMBER.search(re.sub(r"'[^']*'", "", line))
            if found and found.group().lower() == "nan" and path.name in MAY_BE_NAN:
                continue
            claim(not found, f"{path.name}: {line}")
    groups = read_groups(folder / "summary.nml")
    summary = groups["summary"]
    warnings = several(summary.get("warnings", []))
    claim(summary["converged"] == (status == 0), "converged and status differ")
    claim(status == 0 or warnings, "a failed run does not say why")
    for key in ("max_tension", "jump_in_load", "jump_out_load", "error_estimate"):
        if key in summary:
            claim(math.isfinite(summary[key]), f"{key} = {summary[key]}")
    if not (folder / "curve.csv").exists():
        return status
    curve = read_table(folder / "curve.csv")
    if STABILITY[0] in curve.names and not any("eigenvalue" in text for text in warnings):
        known = ~np.isnan(curve[STABILITY[0]])
        claim((known == (curve["converged"] == 1)).all(), "an eigenvalue is missing in silence")
    tolerance = tolerance_of(groups["numerics"])
    if status == 0:
        claim(len(curve) > 0, "nothing computed, and status 0")
        worst = max(curve["residual"])
        claim(summary["worst_residual"] >= worst * (1 - 1e-12), "worst_residual hides a state")
        # Where gaps are many of the law's lengths, rounding sets a lower limit of the residual. The
        # limit is never high, and a warning reports it where it may matter.
        told = any("rounding leaves" in text for text in warnings)
        excused = 1e-3 if told else max(1e-8, groups["numerics"]["accuracy"])
        claim(worst <= max(tolerance, excused), f"residual {worst} above {tolerance}, untold")
        claim((curve["converged"] == 1).all(), "a state that did not converge, and status 0")
        if "error_estimate" in summary and summary["error_estimate"] >= 1:
            claim(any("error" in text for text in warnings), "an error of everything, untold")
    claim(
        (curve["residual"][curve["converged"] == 1] <= max(tolerance, 1e-3)).all(),
        "a row counts as converged with a large residual")
    return status


def tolerance_of(keys):
    return keys.get("residual_tolerance", min(1e-8, 0.01 * keys.get("accuracy", 1e-6)))


def try_deck(number, out, seconds):
    """Runs deck `number`; returns its status, or the broken claim, and its processor time."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    try:
        result = check_run(*run_deck(out, f"deck{number}", extreme_deck(number), seconds))
    except Broken as broken:
        result = str(broken)
    return result, resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    numbers = range(arguments.first, arguments.first + arguments.count)
    found = spread(functools.partial(try_deck, out=arguments.out, seconds=arguments.seconds),
                   numbers, workers=arguments.jobs, name="decks")
    broken = {number: text for number, (text, _) in zip(numbers, found) if isinstance(text, str)}
    for number, text in broken.items():
        print(f"deck{number}: {text}")
    statuses = collections.Counter(status for status, _ in found if not isinstance(status, str))
    taken, slowest = max((taken, number) for number, (_, taken) in zip(numbers, found))
    print(f"statuses {dict(statuses)}, broken {len(broken)}, "
          f"slowest {taken:.1f} s (deck{slowest})")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
