"""Bodies that are driven in time."""

from support.scenes import lennard_jones


def scene(sigma, relaxed=None, *, velocity=1.0, start=15.0, turn=-1.0, accuracy=1e-4, creep=None,
          **drive):
    """Bodies of strength sigma at once, and of `relaxed` at rest."""
    if relaxed is not None:
        creep = {"stiffness_relaxed": sigma / relaxed, "retardation_time": 1.0}
    return lennard_jones(
        sigma, drive={"velocity": velocity, "z_start": start, "z_turn": turn, **drive},
        viscoelastic=creep, numerics={"accuracy": accuracy})


def at_rest(run, sigma):
    return run(lennard_jones(sigma, equilibrium_path={"h0_end": -1.0})).summary


def near(summary, key, value, times=1.0):
    return abs(summary[key] - value) <= times * summary[key + "_error"]
