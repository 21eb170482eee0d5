#!/usr/bin/env python3
"""The true numbers of Lennard-Jones scenes, from the independent solution of the tests.

    tools/bench/truth.py    renews docs/bench/independent.csv, the numbers of inputs/accuracy.nml
"""

import functools
import math
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "pywrap"), str(ROOT / "build" / "pywrap")]

from support.experiment import cycle, reported, reported_of_path  # noqa: E402
from support.reference import Path  # noqa: E402
from support.series import FINE  # noqa: E402

DECK, NUMBERS = ROOT / "inputs" / "accuracy.nml", ROOT / "docs" / "bench" / "independent.csv"
# Numbers that are lengths in units of z0; energies are in gamma R z0 and all others are loads.
_LENGTHS = ("_h0", "_displacement")


# With the usual resolution the displacement of a weak contact is known to 1e-9 only.
@functools.cache
def _path(sigma, end, far):
    return Path(sigma, end, far, FINE)


def numbers(sigma, start, end, *, length, load, whole_path=False):
    """Return the numbers of a cycle from h0 = `start` to `end` (in z0) and back, or of the path.

    length: z0 [m]; load: gamma R [N]. Numbers that do not exist are left out.
    """
    path = _path(sigma, end, max(start, 4 + 3.5 * sigma ** (2 / 3)) + 1)
    found = (reported_of_path(path, end) if whole_path
             else reported(cycle(path, start, end, [end], start)))
    if not whole_path:
        found["energy_lost"] = path.energy_lost if found["jump_out_h0"] is not None else None
    return {name: value * _unit(name, length, load) for name, value in found.items()
            if isinstance(value, float)}


def _unit(name, length, load):
    if name == "energy_lost":
        return length * load
    return length if name.endswith(_LENGTHS) else load


def of_deck(text):
    """Return the numbers of a cycle's deck with parabolas and a Hamaker constant."""
    def value(key):
        return float(re.search(rf"\b{key} *= *([-+.\de]+)", text)[1])

    radius, z0 = value("radius"), value("z0")
    gamma = value("hamaker") / (16 * math.pi * z0**2)
    sigma = gamma / value("stiffness") * math.sqrt(radius / z0**3)
    return numbers(sigma, value("h0_start") / z0, value("h0_end") / z0, length=z0,
                   load=gamma * radius)


def main():
    lines = ["# The numbers of inputs/accuracy.nml by the independent solution of tests/support, "
             "SI: tools/bench/truth.py"]
    lines += [f"{name},{value:.14e}"
              for name, value in of_deck(DECK.read_text(encoding="utf-8")).items()]
    NUMBERS.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
