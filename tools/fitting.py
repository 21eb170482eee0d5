#!/usr/bin/env python3
"""Renew the pictures of docs/fitting.md: the example, and a right and a wrong model of one curve.

    .venv/bin/python tools/fitting.py

The curve is that of the independent solution of the tests (sigma = 5, noise of 2 % of the pull-off,
three outliers in a hundred samples). The fits begin with a third of the work of adhesion; those of
the wrong model with twice the true z0. Prints the numbers that the page quotes.
"""

import pathlib
import subprocess
import sys
import tempfile
import warnings

import numpy as np
import snapin
from snapin.command import as_command

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests"))
from support.measured import write  # noqa: E402
from support.reference_curves import RADIUS, Z0, measure, truth  # noqa: E402

DPI = "110"
ENERGY = "force.work_of_adhesion"
SIGMA, SOFTNESS, SAMPLES, NOISE, OUTLIERS = 5.0, 0.3, 500, 0.02, 0.03


def draw(folder, name):
    """Draw the fit in a folder of results as a picture of the page."""
    subprocess.run([sys.executable, ROOT / "pywrap/plots/fit.py", folder, "--dpi", DPI,
                    "-o", ROOT / f"docs/{name}.png"], check=True, stdout=subprocess.DEVNULL)


def scene(true, curve, longer):
    """The deck of a fit; longer: z0 over its true value."""
    return {
        "scene": {"title": "right model" if longer == 1 else "wrong model: z0 twice as large"},
        "bodies": {"radius": RADIUS, "stiffness": true.stiffness},
        "force": {"law": "lennard_jones", "z0": longer * Z0, "work_of_adhesion": true.energy / 3},
        "measurement": {"file": str(curve), "columns": ["z", "force", "segment"],
                        "spring_constant": true.spring},
        "fit": {"parameters": [ENERGY, "measurement.contact_point"]}}


def main():
    warnings.simplefilter("ignore", snapin.SnapinWarning)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        snapin.run(ROOT / "inputs/examples/fit.nml", folder / "example")
        draw(folder / "example", "fitting")
        true = truth(SIGMA, SOFTNESS)
        curve = measure(true, SAMPLES, NOISE, np.random.default_rng(1), outliers=OUTLIERS)
        file = folder / "curve.csv"
        write(file, curve.z, curve.force, curve.segment)
        for name, longer in (("fitting_right", 1), ("fitting_wrong", 2)):
            found = snapin.run(scene(true, file, longer), folder / name).fitted["fit"]
            draw(folder / name, name)
            energy, error = found["estimate"], found["standard_error"]
            per_freedom, = found["chi_squared"] / found["degrees_of_freedom"]
            print(f"{name}: work of adhesion {100 * (energy[0] / true.energy - 1):.2f} % off, error "
                  f"{100 * error[0] / true.energy:.2f} %, chi squared per freedom {per_freedom:.3g}")


if __name__ == "__main__":
    sys.exit(as_command(main)())
