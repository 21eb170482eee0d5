"""Random relatives of decks of fits: starts that are far off, and a bow of the baseline of which
the deck says nothing. The curves are those of the independent solution (`study_fits`)."""

import numpy as np
from support import study_fits
from support.relatives import Judged


def bow(curve, rng):
    """A bow of a few to thirty times the noise, which the deck does not mention."""
    return study_fits.bow(curve, rng)[0], {}


KINDS = {"start": "clean", "bow_left_out": "bow_left_out"}


def examine(job):
    """The verdict on one relative."""
    kinds = {**study_fits.KINDS, "bow_left_out": bow}
    (found,) = study_fits.examine(
        study_fits.Job(KINDS[job.kind], 1000 * job.seed + job.number), kinds)
    judged = Judged(job, f"sigma {found.sigma:g}, number {found.job.number}, off "
                         f"{np.round(found.off, 1)}, {' | '.join(found.warned)[:80]}")
    told = any("fit" in text for text in found.warned) or any(
        text.startswith("refused") for text in found.wrong)
    judged.within = sum(abs(x) < study_fits.FAR for x in found.off)
    (judged.told if told else judged.silent).extend(found.wrong)
    return judged
