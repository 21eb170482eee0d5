#!/usr/bin/env python3
"""The made-up force curves of docs/tutorial.md, as an instrument might write them.

    .venv/bin/python tools/tutorial.py [FOLDER]

A silica sphere on a cantilever approaches a polymer and is withdrawn. The true curve is that of the
program at a high accuracy, with the noise, the tilt and the zero of an instrument; the other files
are the same curve, spoilt in five ways.
"""

import pathlib
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests"))
from support.measured import Branches  # noqa: E402

FOLDER = ROOT / "inputs/tutorial"
#: What the fit should find.
TRUTH = {"force.work_of_adhesion": 0.042, "bodies.young(2)": 1.3e9}
SPRING = 42.0
_SCENE = {
    "bodies": {"radius": 5e-6, "young": [70e9, TRUTH["bodies.young(2)"]], "poisson": [0.17, 0.4]},
    "force": {"law": "lennard_jones", "surface_energy": TRUTH["force.work_of_adhesion"], "z0": 5e-10},
}
# Nearest and farthest position of the drive [m], samples of each way, noise of the force [N], its
# tilt along the base [N/m], and the position of the base at which undeformed bodies would touch [m].
_NEAR, _FAR, _SAMPLES, _NOISE, _TILT, _CONTACT = -6e-8, 8e-8, 400, 4e-9, 0.02, 3.2171e-6
_HEAD = ("Force-Distance Curve", "Instrument:\tDemo Probe", "Mode:\tSingle", "Speed:\t0.1 um/s", "")


def curve():
    """Return base [m], force [N] and segment (0, 1) of the samples."""
    branches = Branches(_SCENE, SPRING, far=1e-7, h0_end=-2.5e-8, step=2e-11)
    inward = np.linspace(_FAR, _NEAR, _SAMPLES)
    z = np.concatenate([inward, inward[::-1]])
    segment = np.repeat([0, 1], _SAMPLES)
    force = np.concatenate([branches.force(z[:_SAMPLES], True), branches.force(z[_SAMPLES:], False)])
    noise = np.random.default_rng(20260504).standard_normal(len(z))
    return z + _CONTACT, force + _NOISE * noise + 3e-9 + _TILT * z, segment


def text_of(z, force, segment, words=("Extend", "Retract")):
    """Return the text of a file: names with units, words for the segments, tabs between cells."""
    lines = [*_HEAD, "Z (µm)\tForce (nN)\tSegment"]
    lines += [f"{1e6 * a:.5f}\t{1e9 * b:.3f}\t{words[int(c)]}" for a, b, c in zip(z, force, segment)]
    return "\n".join(lines) + "\n"


def spoilt(z, force, segment):
    """Return the texts of the spoilt files by name."""
    ripple = 2.5e-8 * np.sin(2 * np.pi * z / 4.2e-8)
    short = (segment == 0) | (z < z.min() + 2.5e-8)
    return {
        "sign": text_of(z, -force, segment),
        "exchanged": text_of(z, force, 1 - segment),
        "ripple": text_of(z, force + ripple, segment),
        "bow": text_of(z, force + 6e-8 * ((z - _CONTACT) / 8e-8) ** 2, segment),
        "short": text_of(z[short], force[short], segment[short]),
    }


def main(folder=FOLDER):
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    samples = curve()
    (folder / "probe.txt").write_text(text_of(*samples), encoding="utf-8")
    for name, text in spoilt(*samples).items():
        (folder / f"probe_{name}.txt").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:2])
