#!/usr/bin/env python3
"""Fits thousands of curves of the independent model in one sweep, and compares them with the truth.

    .venv/bin/python tools/verify/many_curves.py [--curves 2000] [--seed 0] [--rows FILE]
    .venv/bin/python tools/verify/many_curves.py --map 20 --picture docs/curves.png

Every group of curves has one instrument (sigma, spring, z0) and is one sweep, as a map is: the work
of adhesion and the modulus of its curves vary by some per cent from place to place, the noise, the
number of samples, outliers and drift from curve to curve. The starting values are wrong by factors
up to three. It prints the bias, how often 95 % intervals hold the truth, the verdicts, fits that
are wrong without a warning, and the price. Threads: OMP_NUM_THREADS. With `--rows` the rows of each
sweep are added to a file, and a run with the same arguments goes on after those that it has. `--map` draws a map of a stiff
and sticky hill instead, some of whose curves are spoilt.
"""

import argparse
import json
import math
import pathlib
import sys
import tempfile
import time

import numpy as np
import snapin
from snapin.command import as_command

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.append(str(ROOT / "tests"))

from support.reference_curves import RADIUS, Z0, measure, path_of, truth  # noqa: E402
from support.study_fits import cpu  # noqa: E402

SIGMAS = (0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0)
KEYS = ("force.work_of_adhesion", "bodies.stiffness", "measurement.contact_point")
# Curves of a sweep; standard errors from the truth at which a fit is wrong; half-width of a 95 %
# interval in standard errors.
GROUP, FAR, WITHIN = 50, 6.0, 1.959964
# Spreads of the work of adhesion over a map: its curves are those of strengths of adhesion of which
# the independent path is known, scaled to other moduli, which leaves sigma as it is.
SPREAD = 0.2


def curve_of(sigma, softness, rng):
    """A curve as measured, the truth, and its noise."""
    modulus = 1e10 * math.exp(SPREAD * rng.normal())
    true = truth(sigma, softness, modulus)
    noise = 10 ** rng.uniform(math.log10(0.003), math.log10(0.05))
    samples = int(10 ** rng.uniform(2, math.log10(2500)))
    curve = measure(true, samples, noise, rng, rng.choice([0.0, 0.01, 0.03]))
    return curve, true, noise, 2 * samples


def group(number, seed, size, folder):
    """The rows of one sweep: the fits and the truth of its curves."""
    rng = np.random.default_rng((seed, number))
    sigma = SIGMAS[number % len(SIGMAS)]
    softness = 10 ** rng.uniform(-0.7, 1)
    path_of(sigma)
    made = [curve_of(sigma, softness, rng) for _ in range(size)]
    off = 3 ** rng.uniform(-1, 1, 2)
    middle = truth(sigma, softness)
    deck = {"bodies": {"radius": RADIUS, "stiffness": middle.stiffness * off[0]},
            "force": {"law": "lennard_jones", "z0": Z0,
                      "work_of_adhesion": middle.energy * off[1]},
            "numerics": {"accuracy": 1e-4}}
    began, used = time.perf_counter(), cpu()
    fits = snapin.fit_many(
        ((curve.z, curve.force, curve.segment) for curve, *_ in made), deck=deck, parameters=KEYS,
        spring_constant=[true.spring for _, true, *_ in made], out=folder)
    took = time.perf_counter() - began, cpu() - used
    rows = []
    for i, (_, true, noise, samples) in enumerate(made):
        record = fits[i]
        truths = np.array([true.energy, true.stiffness, 0.0])
        estimate = np.array([record[f"{key}_estimate"] for key in KEYS])
        error = np.array([record[f"{key}_standard_error"] for key in KEYS])
        inside = [record[f"{key}_lower_95"] <= value <= record[f"{key}_upper_95"]
                  for key, value in zip(KEYS, truths)]
        with np.errstate(all="ignore"):
            far = np.where(truths == 0, estimate, np.log(estimate / truths) * estimate) / error
            # Of works of adhesion and moduli the errors over the truth.
            part = np.append(estimate[:2] / truths[:2] - 1, np.nan)
        rows.append({"sigma": sigma, "noise": noise, "samples": samples,
                     "inside": [bool(held) for held in inside],
                     "far": far.tolist(), "part": part.tolist(), "verdict": record["verdict"],
                     "error": (error / np.append(estimate[:2], np.nan)).tolist(),
                     "told": record["failure"] or record["warning"], "seconds": took[1] / size})
    return rows, took


def share(values):
    return f"{100 * np.mean(values):5.1f} %" if len(values) else "   none"


def draw_map(size, picture, folder, rng):
    """Fit a map of size x size curves and draw it."""
    x, y = (of.ravel() for of in np.meshgrid(*2 * [np.linspace(0, 1, size)]))
    hill = 1 + 0.8 * np.exp(-((x - 0.4) ** 2 + (y - 0.6) ** 2) / 0.05)
    curves, springs = [], []
    for i, modulus in enumerate(1e10 * hill):
        true = truth(5.0, 1.5, modulus)
        curve = measure(true, 300, 0.01, rng)
        force, z = curve.force, curve.z
        if i % 97 == 5:
            force = curve.noise * rng.standard_normal(len(force))
        elif i % 101 == 7:
            force = force + 20 * curve.noise * np.sin(z / 1e-9)
        elif i % 103 == 9:
            force = force[:-1]
        curves.append((z, force, curve.segment))
        springs.append(true.spring)
    middle = truth(5.0, 1.5)
    fits = snapin.fit_many(
        curves, spring_constant=springs, places=np.stack([x, y], axis=1) * 1e-5, parameters=KEYS,
        deck={"bodies": {"radius": RADIUS, "stiffness": middle.stiffness},
              "force": {"law": "lennard_jones", "z0": Z0, "work_of_adhesion": middle.energy},
              "numerics": {"accuracy": 1e-4}}, out=folder)
    fits.draw_maps().savefig(picture, dpi=100)
    print(fits)


def report(rows, took):
    """Print the table."""
    print(f"{len(rows)} curves, {sum(t[0] for t in took):.0f} s, of the processors "
          f"{sum(t[1] for t in took):.0f} s")
    print("  sigma  tabor curves  described  warned  not described  refused  wrong in silence  "
          "intervals hold w, E, contact       median error of w, E     seconds a curve")
    for sigma in sorted({row["sigma"] for row in rows}):
        print(line(f"{sigma:7g} {(4 * sigma**2) ** (1 / 3):6.2f}",
                   [row for row in rows if row["sigma"] == sigma]))
    print(line("    all       ", rows))


def line(name, rows):
    verdicts = [row["verdict"] for row in rows]
    fitted = [row for row in rows if row["verdict"] in ("described", "warned")]
    silent = [row for row in rows if row["verdict"] == "described"
              and not np.abs(row["far"]).max() < FAR]
    held = " ".join(share([row["inside"][k] for row in fitted]) for k in range(3))
    # The mean over the curves, weighted by their errors: what a map would be wrong by.
    bias = []
    for k in range(2):
        part = np.array([row["part"][k] for row in fitted])
        weight = np.array([row["error"][k] for row in fitted]) ** -2.0
        bias.append(f"{100 * np.average(part, weights=weight):+6.2f} %" if len(part) else "  none")
    counts = [verdicts.count(word) for word in (
        "described", "warned", "not_described", "refused")]
    return (f"{name} {len(rows):6d} {counts[0]:10d} {counts[1]:7d} {counts[2]:14d} {counts[3]:8d} "
            f"{len(silent):17d}  {held}   bias {' '.join(bias)}  "
            f"{np.median([row['seconds'] for row in rows]):6.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--curves", type=int, default=2000)
    parser.add_argument("--size", type=int, default=GROUP, help="curves of a sweep")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", help="folder that keeps curves and results")
    parser.add_argument("--rows", help="file that keeps the rows, from which a run goes on")
    parser.add_argument("--map", type=int, help="number of curves in a row of a map to draw")
    parser.add_argument("--picture", default="curve_map.png", help="of the map")
    options = parser.parse_args()
    if options.map:
        draw_map(options.map, options.picture, options.out, np.random.default_rng(options.seed))
        return
    rows, took, kept = [], [], []
    if options.rows and pathlib.Path(options.rows).is_file():
        kept = [json.loads(text) for text in open(options.rows, encoding="utf-8")]
    with tempfile.TemporaryDirectory() as folder:
        for number in range(-(-options.curves // options.size)):
            place = pathlib.Path(options.out or folder, f"{number:03d}")
            size = min(options.size, options.curves - len(rows))
            if number < len(kept):
                new, seconds = kept[number]
            else:
                new, seconds = group(number, options.seed, size, place)
                if options.rows:
                    with open(options.rows, "a", encoding="utf-8") as file:
                        file.write(json.dumps([new, seconds]) + "\n")
            rows += new
            took.append(seconds)
            for row in new:
                if row["verdict"] != "described" or not np.abs(row["far"]).max() < FAR:
                    print(f"  {number} sigma {row['sigma']:g} noise {100 * row['noise']:.1f} % "
                          f"samples {row['samples']} off {np.round(row['far'], 1)} "
                          f"{row['verdict']}: {row['told'][:120]}")
            print(line(f"{number:4d} {rows[-1]['sigma']:7g}", new), flush=True)
    report(rows, took)


if __name__ == "__main__":
    sys.exit(as_command(main)())
