"""Theories in Maugis' units: loads in pi w R, radii in (pi w R^2/K)^(1/3), K = 4 E*/3."""

import math

import numpy as np
import spheres  # noqa: F401 (makes snapin importable)
import snapin  # noqa: E402 isort: skip

# With R = 1 and K = 1 pi w is unit load and 1/pi w the cube of the radii's unit.
_STIFFNESS, _GAMMA = 1.5, 1 / math.pi


def material(lam):
    """Return the bodies of a Maugis parameter, with both units 1, as keywords of snapin's theories."""
    return {"radius": 1.0, "stiffness": _STIFFNESS, "surface_energy": _GAMMA, "strength": lam / 2}


def pull_off(theory, lam):
    """Return the pull-off, positive, of a theory at a Maugis parameter."""
    return -snapin.pull_off(theory, **material(lam))


def radius(theory, lam, load=0.0):
    """Return the contact radius of a theory under a load, stable there."""
    return float(snapin.contact_radius(theory, "load", [load], **material(lam))[0])


def over(theory, lambdas):
    """Return pull-offs and radii without load at Maugis parameters."""
    return (np.array([pull_off(theory, float(lam)) for lam in lambdas]),
            np.array([radius(theory, float(lam)) for lam in lambdas]))
