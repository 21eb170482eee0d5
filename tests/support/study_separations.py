"""Fits of force against separation, as of a surface force apparatus: forces over the radius of
curves of the independent solution (`reference_curves`), with a spring that was subtracted, or held
by something much stiffer than the contact. Intervals must hold the truth."""

import math
import tempfile
import warnings

import numpy as np
import snapin
from support.measured import write
from support.reference_curves import Z0, Driven, Truth
from support.study_fits import FAR, PARAMETERS, Finding, Job, cpu, table  # noqa: F401

RADIUS = 0.01
STRENGTHS = (0.3, 1.0, 5.0, 20.0, 60.0)
# Noise over the pull-off, and samples of a way.
NOISE, SAMPLES = 0.02, (100, 400)
KINDS = ("spring", "stiff")


def separation_jobs(count, folder=None, *, seed=0):
    return [Job(KINDS[i % len(KINDS)], seed + i) for i in range(count)]


def made(job):
    """The truth, the curve's separation, F/R and segment, and starting values over the true
    ones."""
    rng = np.random.default_rng((job.number, len(job.kind)))
    sigma = STRENGTHS[rng.integers(len(STRENGTHS))]
    stiffness = 1e10
    energy = sigma * stiffness * Z0**1.5 / math.sqrt(RADIUS)
    length = Z0 * max(1.0, 3.4 * sigma ** (2 / 3))
    spring = math.inf
    if job.kind == "spring":
        spring = 1.5 * math.pi * energy * RADIUS / (10 ** rng.uniform(-1, 1.5) * length)
    true = Truth(sigma, energy, stiffness, spring, RADIUS)
    driven = Driven(true)
    pulled = driven.load.argmin()
    near = np.interp(rng.uniform(0.3, 2) * driven.pull_off, driven.load[pulled:],
                     driven.z[pulled:])
    reach = max(driven.jump_out, 8 * Z0)
    samples = int(rng.integers(*SAMPLES))
    base = np.linspace(reach + 0.5 * (reach - near), near, samples)
    base = np.concatenate([base, base[::-1]]) + rng.uniform(-0.5, 0.5) * (base[1] - base[0])
    segment = np.repeat([0, 1], samples)
    force = np.concatenate([driven.force(base[:samples], True),
                            driven.force(base[samples:], False)])
    force += NOISE * driven.pull_off * rng.standard_normal(len(force))
    return true, (base + force / spring, force / RADIUS, segment), 10 ** rng.uniform(-0.5, 0.5, 2)


def deck_of(true, file, start):
    spring = {} if math.isinf(true.spring) else {"spring_constant": true.spring}
    return {
        "bodies": {"radius": RADIUS, "stiffness": true.stiffness * start[1]},
        "force": {"law": "lennard_jones", "z0": Z0, "surface_energy": true.energy * start[0]},
        "measurement": {"file": file, "columns": ["D (m)", "F/R (N/m)", "segment"],
                        "quantity": "separation", **spring},
        "fit": {"parameters": list(PARAMETERS)},
        "numerics": {"accuracy": 1e-4},
    }


def examine(job):
    """A list of the finding of a job."""
    true, curve, start = made(job)
    with tempfile.TemporaryDirectory() as folder:
        file = write(f"{folder}/curve.csv", *curve, header="D (m),F/R (N/m),segment", digits=8)
        return [found(job, true.sigma, deck_of(true, file, start),
                      np.array([true.energy, true.stiffness, 0.0]))]


def found(job, sigma, deck, truths):
    """The finding of a fit whose unknowns have these true values; the contact point is the last."""
    began = cpu()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", snapin.SnapinWarning)
        try:
            result = snapin.run(deck)
        except snapin.SnapinError as refused:
            return Finding(job, sigma, (), (), cpu() - began, (), [f"refused: {refused}"])
    fit, warned = result.fitted["fit"], tuple(result.summary.get("warnings", []))
    estimate, error = np.array(fit["estimate"]), np.array(fit["standard_error"])
    off = tuple((estimate - truths) / error)
    inside = tuple((np.array(fit["lower_95"]) <= truths) & (truths <= np.array(fit["upper_95"])))
    wrong = [f"{name} {distance:.1f} standard errors off"
             for name, distance in zip(fit["parameters"], off) if not abs(distance) < FAR]
    return Finding(job, sigma, off, inside, cpu() - began, warned, wrong)
