"""Random relatives of decks whose numbers were once wrong: what a verdict on one of them is.

A number is within its error, or outside but told by a warning about the numbers, or wrong in
silence. A relative at which the right answer itself is not decided is not judged.
"""

import random
from typing import NamedTuple

from support.decks_in_units import PLAIN, REAL, Units
from support.scenes import of_numbers

# Units of length of the law, crossed cylinders, and a tip.
UNITS_OF = (PLAIN, REAL, Units(1e-7, 2e9, 0.3e-9))
# Warnings that say nothing of the numbers' accuracy.
OF_OTHERS = ("metastable", "the folder")


class Job(NamedTuple):
    """The kind of the relative, its number, and the seed of the study."""

    kind: str
    number: int
    seed: int
    folder: object

    @property
    def rng(self):
        return random.Random(f"{self.kind} {self.seed} {self.number}")


class Judged:
    """A relative with its numbers: how many are within their errors, which are outside with a
    warning, and which in silence."""

    def __init__(self, job, text):
        self.job, self.text = job, text
        self.within, self.told, self.silent, self.doubt = 0, [], [], ""

    @classmethod
    def undecided(cls, job, text):
        judged = cls(job, text)
        judged.doubt = "undecided"
        return judged

    @classmethod
    def lost(cls, job, text, told, why):
        """No results: told if the program says so; a run that takes too long is not judged."""
        judged = cls(job, text)
        if why.startswith("more than"):
            judged.doubt = "undecided"
        (judged.told if told else judged.silent).append(f"no results: {why.strip()[-150:]}")
        return judged

    @property
    def verdict(self):
        if self.doubt:
            return self.doubt
        return "silent" if self.silent else "told" if self.told else "within"


def is_told(warnings, status=0):
    """Whether a run says that its numbers are not what was asked for."""
    return status != 0 or any(
        not any(other in text for other in OF_OTHERS) for text in of_numbers(warnings))


def numbers_verdict(job, text, told, off, absent=()):
    """The verdict from (key, error, allowed error) of each number, and what is absent."""
    judged = Judged(job, text)
    outside = [f"{key} off by {error:.2e}, said {allowed:.2e}" for key, error, allowed in off
               if not error <= allowed]
    judged.within = len(off) - len(outside)
    (judged.told if told else judged.silent).extend([*outside, *absent])
    return judged
