"""Random relatives of decks on fixed grids, and of decks that end at their largest tension, judged
by the independent path of `reference`. Lengths are in z0, radii in sqrt(R z0), loads in gamma R.

Each function draws the groups of a deck; what it judges are the numbers of the cycle or the path.
"""

import math

from support.comparison import deviations, missing
from support.decks_in_units import report
from support.experiment import cycle, largest_tension, reported, reported_of_path
from support.reference import CUSP, Path
from support.relatives import UNITS_OF, Judged, is_told, numbers_verdict
from support.scenes import loading
from support.study_cycles import logarithmic

# Turns this close to a fold [z0], and strengths this close to the cusp (relative), are undecided:
# on a grid of a hundred nodes the fold may be on the other side.
BESIDE_FOLD, BESIDE_CUSP = 0.05, 2e-3
# A deck takes at most so many seconds of the processor.
SECONDS = 15


class Scene:
    """A strength, the turn and the start of a cycle, and the keys of &numerics."""

    def __init__(self, rng, low, high, *, deep=(0.5, 3.0)):
        self.sigma = float(f"{logarithmic(rng, low, high):.6g}")
        reach = 3 + 3.5 * self.sigma ** (2 / 3)
        self.start = round(reach * rng.uniform(1.05, 1.4), 3)
        self.end = round(-rng.uniform(*deep), 3)
        self.step = round(logarithmic(rng, 0.06, 0.6), 4)
        # JKR's contact radius at the turn, and some more.
        self.contact = math.sqrt(1 - self.end + (4 * math.pi * self.sigma) ** (2 / 3))
        self.numerics = {}

    @property
    def cycle(self):
        return {"loading": loading(self.start, self.end, self.step),
                "unloading": {"from_": [self.end], "h0_end": self.start, "h0_step": self.step}}

    def grid(self, rng, kind, nodes, wider):
        self.numerics |= {
            "grid": kind, "nodes": int(rng.uniform(*nodes)),
            "r_max": round(self.contact * rng.uniform(*wider), 4)}


def uniform_jump(rng):
    scene = Scene(rng, 0.3, 3)
    scene.grid(rng, "uniform", (120, 420), (2, 6))
    scene.numerics |= {"method": rng.choice(("anderson", "newton", "auto")),
                       "accuracy": float(f"{logarithmic(rng, 1e-7, 1e-3):.1g}")}
    return scene


def small_jump(rng):
    scene = Scene(rng, 0.27, 0.36, deep=(-1.0, 0.5))
    scene.grid(rng, "uniform", (120, 300), (2.5, 4))
    scene.numerics |= {"method": rng.choice(("anderson", "newton"))}
    return scene


def end_of_panels(rng):
    scene = Scene(rng, 0.1, 3)
    scene.grid(rng, "panels", (60, 260), (1.3, 8))
    scene.numerics |= {"method": rng.choice(("mixing", "newton")), "convergence": "residual",
                       "mixing_limit": round(rng.uniform(0.3, 0.9), 3),
                       "accuracy": float(f"{logarithmic(rng, 1e-6, 1e-4):.1g}")}
    return scene


def short_limit(rng):
    scene = Scene(rng, 0.3, 1.5)
    scene.grid(rng, rng.choice(("panels", "uniform")), (100, 220), (2, 20))
    scene.numerics |= {"method": "mixing", "convergence": "residual",
                       "mixing_limit": round(logarithmic(rng, 0.02, 0.3), 4),
                       "max_iterations": int(logarithmic(rng, 200, 6000)), "accuracy": 1e-5}
    return scene


def unconverged(rng):
    scene = Scene(rng, 1.0, 4)
    scene.grid(rng, "uniform", (120, 240), (1.8, 4))
    scene.numerics |= {"method": "mixing", "convergence": "residual",
                       "mixing_limit": round(rng.uniform(0.3, 0.9), 3),
                       "max_iterations": int(logarithmic(rng, 500, 6000)), "accuracy": 2e-5}
    return scene


def two_iterates(rng):
    """The paper's stopping rule."""
    scene = Scene(rng, 0.2, 1.5)
    scene.grid(rng, "uniform", (100, 240), (2, 4))
    scene.numerics |= {"method": "mixing", "convergence": "displacement_change",
                       "displacement_tolerance": float(f"{logarithmic(rng, 1e-7, 1e-3):.2g}")}
    return scene


def ends(rng):
    """A cycle, a loading alone or a path that may end before its pull-off."""
    scene = Scene(rng, 0.01, 30)
    reach = 3 + 3.5 * scene.sigma ** (2 / 3)
    scene.end = round(rng.uniform(-1.5, 0.8 * reach), 3)
    scene.way = rng.choice(("cycle", "loading", "path"))
    scene.numerics |= {"accuracy": float(f"{logarithmic(rng, 1e-8, 1e-3):.1g}")}
    return scene


KINDS = {function.__name__: function for function in (
    uniform_jump, small_jump, end_of_panels, short_limit, unconverged, two_iterates, ends)}


def examine(job):
    """The verdict on one relative."""
    rng, folder = job.rng, job.folder
    scene = KINDS[job.kind](rng)
    way = getattr(scene, "way", "cycle")
    reach = 3 + 3.5 * scene.sigma ** (2 / 3)
    path = Path(scene.sigma, min(1.05 * scene.end, -0.5), max(1.1 * scene.start, reach))
    text = (f"sigma {scene.sigma:g} {way} {scene.start:g} to {scene.end:g} by {scene.step:g} "
            f"{scene.numerics}")
    undecided = abs(scene.sigma / CUSP - 1) < BESIDE_CUSP or any(
        abs(scene.end - fold.h0) < BESIDE_FOLD for fold in path.folds)
    if undecided or (way == "path" and not below_folds(path, scene.end)):
        return Judged.undecided(job, text)
    groups = {**scene.cycle, "numerics": scene.numerics}
    if way != "cycle":
        del groups["unloading"]
    if way == "path":
        groups = {"equilibrium_path": {"h0_end": scene.end}, "numerics": scene.numerics}
        expected = reported_of_path(path, scene.end)
        at_end = False
    else:
        turning = [scene.end] if way == "cycle" else []
        found_cycle = cycle(path, scene.start, scene.end, turning, scene.start)
        expected = reported(found_cycle)
        at_end = is_at_end(path, found_cycle)
    units = UNITS_OF[job.number % len(UNITS_OF)]
    if "r_max" in scene.numerics:
        groups["numerics"] = {**scene.numerics, "r_max": scene.numerics["r_max"] * math.sqrt(
            units.radius * units.z0)}
    if "displacement_tolerance" in scene.numerics:
        groups["numerics"]["displacement_tolerance"] = (
            scene.numerics["displacement_tolerance"] * units.z0)
    found = report(scene.sigma, groups, folder, "deck", seconds=SECONDS, units=units)
    return verdict(job, text, found, expected, path, at_end)


def below_folds(path, h0):
    """Whether a path that ends here ends in contact, on its last branch."""
    return not path.folds or h0 < path.jump_in.h0


def is_at_end(path, found):
    """Whether the largest tension of a cycle is that of a first or last state."""
    branches = [found.loading, *found.unloadings]
    points = [(largest_tension(path, legs), legs) for legs in branches]
    points = [(point, legs) for point, legs in points if point]
    if not points:
        return None
    point, legs = min(points, key=lambda item: item[0].load)
    # A turn belongs to two branches; a fold from which the bodies jump is a pull-off.
    return point in (legs[0].first, legs[-1].last) and point not in path.folds


def verdict(job, text, found, expected, path, at_end):
    told = is_told(found.warnings, found.status)
    if not found.numbers:
        return Judged.lost(job, text, told, found.stderr)
    absent = [] if told else missing(found, expected)
    # A fixed grid may have energies where jumps are known; the path's are known without a cycle.
    off = [(one.key, one.error, max(one.allowed, FLOOR * max(abs(one.value), 1)))
           for one in deviations(found, expected, path)]
    judged = numbers_verdict(job, text, told, off, absent)
    if at_end is not None and not told and at_end:
        judged.silent.append("a tension at an end is called a pull-off")
    return judged


# The reference's own error, and that of rounding.
FLOOR = 1e-9
