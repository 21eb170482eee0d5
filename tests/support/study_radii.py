"""Fits of JKR tests by the closed form (Johnson, Kendall and Roberts, 1971): contact radii under
loads, and loads and radii against the separation on the way out. Intervals must hold the truth; the
program's Lennard-Jones bodies have a Tabor parameter at which they are JKR's."""

import tempfile

import numpy as np
from support.study_fits import Job, table  # noqa: F401
from support.study_separations import found

RADIUS, Z0 = 0.01, 1e-9
# Standard deviations over pull-off and contact radius without load; samples of a curve.
NOISE, SAMPLES = 0.02, (60, 300)
KINDS = ("loads", "separations")
ENERGY, STIFFNESS = "force.work_of_adhesion", "bodies.stiffness"
POINT = "measurement.contact_point"


def radius_jobs(count, folder=None, *, seed=0):
    return [Job(KINDS[i % len(KINDS)], seed + i) for i in range(count)]


def load_of(a, energy, modulus):
    return 4 * modulus * a**3 / (3 * RADIUS) - np.sqrt(8 * np.pi * energy * modulus * a**3)


def separation_of(a, energy, modulus):
    return np.sqrt(2 * np.pi * energy * a / modulus) - a**2 / RADIUS


def truth(rng):
    """Work of adhesion [J/m^2] and reduced modulus [Pa] at Tabor parameters from 60 to 120."""
    energy = 10 ** rng.uniform(-2, -1)
    tabor = rng.uniform(60, 120)
    return energy, np.sqrt(RADIUS * energy**2 / (tabor * Z0) ** 3)


def radii(energy, modulus, samples, rng, smallest):
    """Contact radii, of which the smallest is that of pull-off at prescribed h0, or under loads;
    the largest are those of loads up to some times the pull-off."""
    unit = (RADIUS**2 * energy / modulus) ** (1 / 3)
    low = smallest * unit
    high = unit * (0.75 * rng.uniform(4, 20) * np.pi) ** (1 / 3)
    return np.linspace(high, low, samples), unit * (9 * np.pi / 2) ** (1 / 3)


def made(job):
    """The truth, the columns of the file, and its starting values over the true ones."""
    rng = np.random.default_rng((job.number, len(job.kind)))
    energy, modulus = truth(rng)
    samples = int(rng.integers(*SAMPLES))
    pull_off = 1.5 * np.pi * energy * RADIUS
    # The turning points of the load and of h0.
    smallest = (9 * np.pi / 8) ** (1 / 3) if job.kind == "loads" else (np.pi / 8) ** (1 / 3)
    a, a0 = radii(energy, modulus, samples, rng, smallest * 1.02)
    load = load_of(a, energy, modulus)
    seen = a + NOISE * a0 * rng.standard_normal(samples)
    start = 10 ** rng.uniform(-0.5, 0.5, 2)
    if job.kind == "loads":
        return (energy, 2 * modulus), (load, seen), start
    h0 = separation_of(a, energy, modulus)
    apart = np.linspace(h0[-1], h0[-1] + 0.4 * np.ptp(h0), samples // 2 + 2)[2:]
    h0 = np.append(h0, apart)
    load = np.append(load, 0 * apart) + NOISE * pull_off * rng.standard_normal(len(h0))
    return (energy, 2 * modulus), (h0, load, np.append(seen, 0 * apart)), start


def deck_of(kind, true, file, start):
    columns, keys = ["F (N)", "a (m)"], {"quantity": ["load", "contact_radius"]}
    if kind != "loads":
        columns = ["D (m)", *columns]
        keys = {"quantity": ["separation", "load", "contact_radius"], "segment": "retract",
                "baseline": "constant"}
    return {
        "bodies": {"radius": RADIUS, "stiffness": true[1] * start[1]},
        "force": {"law": "lennard_jones", "z0": Z0, "work_of_adhesion": true[0] * start[0]},
        "measurement": {"file": file, "columns": columns, **keys},
        "fit": {"parameters": [ENERGY, STIFFNESS] + [POINT] * (kind != "loads")},
        "numerics": {"accuracy": 1e-4},
    }


def examine(job):
    """A list of the finding of a job."""
    true, columns, start = made(job)
    header = "F (N),a (m)" if job.kind == "loads" else "D (m),F (N),a (m)"
    with tempfile.TemporaryDirectory() as folder:
        file = f"{folder}/test.csv"
        np.savetxt(file, np.column_stack(columns), "%.9e", ",", header=header, comments="")
        # JKR's surfaces touch without a gap, the program's at z0.
        truths = np.array([*true, -Z0][:2 + (job.kind != "loads")])
        return [found(job, 0.0, deck_of(job.kind, true, file, start), truths)]
