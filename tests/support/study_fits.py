"""Fits of curves of the independent solution: clean ones of strongly adhering bodies from starts
that are far off, and curves of several kinds of noise and baseline, whose intervals must hold the
truth.

The curves are those of `reference_curves`, spoilt here by an instrument: filtered noise, digits of
a converter, a bow of the baseline, a drift in time, interference.
"""

import resource
import tempfile
import warnings
from typing import NamedTuple

import numpy as np
import snapin
from support.measured import write
from support.reference_curves import RADIUS, Z0, measure, truth

# Strengths of adhesion of clean curves, and of the others.
STRONG = (30.0, 45.0, 60.0, 90.0, 120.0, 160.0, 220.0, 300.0)
ANY = (0.3, 1.0, 5.0, 20.0, 60.0, 200.0)
PARAMETERS = ("force.surface_energy", "bodies.stiffness", "measurement.contact_point")
# Standard errors from the truth at which a fit is wrong, and the relative error of the energy that
# a clean curve may have.
FAR, CLOSE = 6.0, 0.1
# Half-width of a 95 % interval, in standard errors.
WITHIN = 1.959964


class Job(NamedTuple):
    """told: whether the deck has the part of the baseline that the kind adds."""

    kind: str
    number: int
    told: bool = True


class Finding(NamedTuple):
    """off: errors of the estimates over their standard errors; inside: whether each 95 % interval
    holds the truth; wrong: what is wrong."""

    job: Job
    sigma: float
    off: tuple
    inside: tuple
    seconds: float
    warned: tuple
    wrong: list


def clean_jobs(count, folder=None, *, seed=0):
    return [Job("clean", seed + i) for i in range(count)]


def noisy_jobs(count, folder=None, *, seed=0):
    names = tuple(KINDS)
    return [Job(names[i % len(names)], seed + i) for i in range(count)]


def untold_jobs(count, folder=None, *, seed=0):
    """Curves whose deck has a straight baseline."""
    return [Job(BENT[i % len(BENT)], seed + i, told=False) for i in range(count)]


def filtered(curve, rng):
    """Noise of an instrument that filters: an autoregression of the first order."""
    white = curve.noise * rng.standard_normal(len(curve.z))
    share = rng.uniform(0.3, 0.8)
    for i in range(1, len(white)):
        if curve.segment[i] == curve.segment[i - 1]:
            white[i] = share * white[i - 1] + np.sqrt(1 - share**2) * white[i]
    return curve.force + white, {}


def white(curve, rng):
    return curve.force + curve.noise * rng.standard_normal(len(curve.z)), {}


def digits(curve, rng):
    """The steps of a converter, twice the noise."""
    step = 2 * curve.noise
    return step * np.round(white(curve, rng)[0] / step), {}


def bow(curve, rng):
    x = (curve.z - curve.z.min()) / np.ptp(curve.z)
    bent = curve.noise * rng.uniform(-30, 30) * x**2
    return white(curve, rng)[0] + bent, {"baseline": "quadratic"}


def drift(curve, rng):
    """A drift in time: the slope of the baseline is another one on the way back."""
    time = np.linspace(0, 1, len(curve.z))
    return (white(curve, rng)[0] + curve.noise * rng.uniform(-30, 30) * time,
            {"slope_each_way": True})


def interference(curve, rng):
    """A ripple of one period along the position, with its own phase on each way."""
    period = np.ptp(curve.z) / rng.uniform(3, 12)
    phase = rng.uniform(0, 2 * np.pi, 2)[curve.segment]
    wave = curve.noise * rng.uniform(1.5, 5) * np.sin(2 * np.pi * curve.z / period + phase)
    return white(curve, rng)[0] + wave, {"ripple": True}


def outliers(curve, rng):
    hit = rng.random(len(curve.z)) < 0.03
    off = rng.uniform(10, 40, len(curve.z)) * rng.choice([-1, 1], len(curve.z))
    return white(curve, rng)[0] + curve.noise * hit * off, {}


KINDS = {function.__name__: function for function in (
    white, outliers, filtered, digits, bow, drift, interference)}
# Kinds that need a key of &measurement, and what a warning of a part of the baseline has.
BENT = ("bow", "drift", "interference")
DOUBTED = "would lower chi squared"


def made(job, kinds=None):
    """The truth, the curve's z, force and segment, and the starting values over the true ones."""
    rng = np.random.default_rng((job.number, len(job.kind)))
    strengths = STRONG if job.kind == "clean" else ANY
    true = truth(strengths[rng.integers(len(strengths))], 10 ** rng.uniform(-2.3, 1))
    noise = 10 ** rng.uniform(-2.5, -2 if job.kind == "clean" else -1.3)
    samples = int(10 ** rng.uniform(2.3, 3.2))
    smooth = measure(true, samples, 0.0, rng, push=10 ** rng.uniform(-1, 0.9),
                     baseline=10 ** rng.uniform(-1, 0.6))
    pull_off = 1.5 * np.pi * true.energy * RADIUS
    curve = smooth._replace(noise=noise * pull_off)
    tilted = curve._replace(force=curve.force + curve.noise * (
        rng.normal(0, 20, 2)[curve.segment] + rng.normal(0, 20) * curve.z / np.ptp(curve.z)))
    force, keys = (kinds or KINDS).get(job.kind, white)(tilted, rng)
    start = 10 ** rng.uniform(-1, 1, 2)
    return true, (curve.z, force, curve.segment), start, keys if job.told else {}


def deck_of(true, file, start, keys):
    return {
        "bodies": {"radius": RADIUS, "stiffness": true.stiffness * start[1]},
        "force": {"law": "lennard_jones", "z0": Z0, "surface_energy": true.energy * start[0]},
        "measurement": {"file": file, "columns": ["z", "force", "segment"],
                        "spring_constant": true.spring, **keys},
        "fit": {"parameters": list(PARAMETERS)},
        "numerics": {"accuracy": 1e-4},
    }


def cpu():
    """Seconds of the processor that runs of the program took."""
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime


def examine(job, kinds=None):
    """A list of the finding of a job; kinds: other ways to spoil a curve than `KINDS`."""
    true, curve, start, keys = made(job, kinds)
    began = cpu()
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore", snapin.SnapinWarning)
        file = write(f"{folder}/curve.csv", *curve, digits=8)
        try:
            result = snapin.run(deck_of(true, file, start, keys))
        except snapin.SnapinError as refused:
            return [Finding(job, true.sigma, (), (), cpu() - began, (), [f"refused: {refused}"])]
    seconds = cpu() - began
    fit, warned = result.fitted["fit"], tuple(result.summary.get("warnings", []))
    truths = np.array([true.energy, true.stiffness, 0.0])
    estimate, error = np.array(fit["estimate"]), np.array(fit["standard_error"])
    off = np.append(np.log(estimate[:2] / truths[:2]) * estimate[:2], estimate[2]) / error
    inside = tuple((np.array(fit["lower_95"]) <= truths) & (truths <= np.array(fit["upper_95"])))
    wrong = [f"{name} {distance:.1f} standard errors off" for name, distance
             in zip(PARAMETERS, off) if not abs(distance) < FAR and (job.told or not warned)]
    if job.kind == "clean":
        share = estimate[0] / true.energy
        if abs(share - 1) > CLOSE:
            wrong.append(f"{PARAMETERS[0]} {share:.3f} of the truth")
    return [Finding(job, true.sigma, tuple(off), inside, seconds, warned, wrong)]


def table(findings):
    """Lines of a report by kind: wrong fits (without a key that they need, those without a
    warning), fits that are called wrong, warnings of the baseline, seconds, and the share of 95 %
    intervals that hold the truth."""
    lines = []
    for kind in sorted({finding.job.kind for finding in findings}):
        ones = [finding for finding in findings if finding.job.kind == kind]
        inside = np.array([one.inside for one in ones if one.inside])
        shares = " ".join(f"{x:6.1%}" for x in inside.mean(axis=0)) if len(inside) else "none"
        alarms = sum(any("does not describe" in text for text in one.warned) for one in ones)
        doubted = sum(any(DOUBTED in text for text in one.warned) for one in ones)
        seconds = [one.seconds for one in ones]
        wrong = sum(bool(one.wrong) for one in ones)
        lines.append(f"{kind:<14} {len(ones):4d} curves, wrong {wrong:3d}, called wrong "
                     f"{alarms:3d}, baseline doubted {doubted:3d}, seconds "
                     f"{np.median(seconds):5.1f} median {max(seconds):5.1f} most, 95 % intervals "
                     f"hold {shares}")
        lines += [f"    {one.job.number} sigma {one.sigma:g}: {'; '.join(one.wrong)}; warned: "
                  f"{' | '.join(one.warned)[:150]}" for one in ones if one.wrong]
    return lines
