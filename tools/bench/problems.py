"""The measured problems, and their decks."""

import dataclasses
import math
import pathlib
import re
from typing import Optional

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "inputs" / "examples"
RADIUS, _Z0, _HAMAKER = 1.5e-2, 0.5e-9, 1e-19
_P0, _DECAY = 2.5e8, 0.2e-9


@dataclasses.dataclass(frozen=True)
class Problem:
    """Two bodies, their force, and the range of h0; `length` [m] is that of the force law."""

    name: str
    label: str
    physics: str
    length: float
    start: float
    turn: float
    step: float
    adhesive: bool = True
    # Strength of adhesion of a Lennard-Jones problem, whose numbers are known independently.
    sigma: Optional[float] = None

    @property
    def load(self):
        """Return gamma R [N]."""
        return _HAMAKER / (16 * math.pi * _Z0**2) * RADIUS

    def cycle(self, numerics="", step=None):
        """Return a deck that loads by steps of h0 and, if the force adheres, unloads."""
        step = step or self.step
        parts = [f"&loading h0_start = {self.start * self.length!r}, "
                 f"h0_end = {self.turn * self.length!r}, h0_step = {step * self.length!r} /"]
        if self.adhesive:
            parts.append(f"&unloading from = {self.turn * self.length!r} /")
        return self._deck("\n".join(parts), numerics)

    def approach(self, h0, numerics):
        """Return a deck that approaches h0 [m], before the jump into contact."""
        return self._deck(f"&loading h0_start = {2 * h0!r}, h0_end = {h0!r}, h0_step = {h0!r} /",
                          numerics)

    def path(self, numerics=""):
        """Return a deck for the whole path of equilibria, down to the turning point."""
        return self._deck(f"&equilibrium_path h0_end = {self.turn * self.length!r} /", numerics)

    def _deck(self, parts, numerics):
        return f"&scene title = '{self.name}' /\n{self.physics}\n{parts}\n&numerics {numerics} /\n"


def lennard_jones(sigma):
    """Return the Lennard-Jones problem of a strength of adhesion sigma, (40) of the paper."""
    stiffness = stiffness_of(sigma)
    # Unloading, the bodies snap off at about this h0, in units of z0, and a little more.
    start = 5 + 3.2 * sigma ** (2 / 3)
    start, turn = float(f"{start:.2g}"), -float(f"{0.25 * start:.1g}")
    return Problem(
        f"sigma_{sigma:g}", f"σ = {sigma:g}",
        f"&bodies radius = {RADIUS}, stiffness = {stiffness!r} /\n"
        f"&force law = 'lennard_jones', hamaker = {_HAMAKER}, z0 = {_Z0} /",
        _Z0, start, turn, (start - turn) / 50, sigma=sigma)


def in_two_parts(problem):
    """Return a Lennard-Jones problem with the law as attraction and repulsion."""
    physics = re.sub(r"&force.*", f"&van_der_waals hamaker = {_HAMAKER} /\n&born z0 = {_Z0} /",
                     problem.physics)
    return dataclasses.replace(problem, name=f"{problem.name}_parts", physics=physics,
                               label=f"van der Waals + Born, {problem.label}")


def example(name):
    """Return the problem of an example's deck, for the range of its path."""
    deck = (EXAMPLES / f"{name}.nml").read_text(encoding="utf-8")
    turn = float(re.search(r"h0_end *= *([-+.\de]+)", deck)[1])
    left_out = "loading|unloading|equilibrium_path|scene|classical|numerics"
    physics = re.sub(rf"&({left_out})\b[^/]*/.*\n?", "", deck)
    return Problem(name, name, physics.strip(), 1e-9, math.nan, turn / 1e-9, math.nan)


def experiment(name, accuracy):
    """Return an example's whole deck at an accuracy."""
    deck = (EXAMPLES / f"{name}.nml").read_text(encoding="utf-8")
    return re.sub(r"&numerics\b[^/]*/.*\n?", "", deck) + f"&numerics accuracy = {accuracy} /\n"


def stiffness_of(sigma):
    """Return the E/(1-nu^2) [Pa] for a sigma."""
    gamma = _HAMAKER / (16 * math.pi * _Z0**2)
    return gamma / sigma * math.sqrt(RADIUS / _Z0**3)


def exponential(big_lambda):
    """Return the problem of an exponential repulsion, Lambda (39) of the paper at h0 = 0."""
    stiffness = _P0 / big_lambda * math.sqrt(RADIUS / _DECAY)
    start = 3 + math.ceil(math.log(big_lambda))
    return Problem(
        f"lambda_{big_lambda:g}", f"exponential, Λ = {big_lambda:g}",
        f"&bodies radius = {RADIUS}, stiffness = {stiffness!r} /\n"
        f"&force law = 'exponential', p0 = {_P0}, decay_length = {_DECAY} /",
        _DECAY, float(start), 0.0, start / 30, adhesive=False)


def sweep_of_paths(count):
    """Return a deck of `count` paths, sigma from 1e-3 to 1e3."""
    # The stiffness is proportional to 1/sigma.
    soft, stiff = (stiffness_of(sigma) for sigma in (1e3, 1e-3))
    return (f"{lennard_jones(1e3).physics}\n&equilibrium_path h0_end = {-5 * _Z0!r} /\n"
            f"&sweep key = 'bodies.stiffness', from = {soft!r}, to = {stiff!r}, count = {count}, "
            "scale = 'log' /\n&numerics accuracy = 1e-6 /\n")


FIGURE_10C = (
    "&bodies radius = 1.5e-2, stiffness = 1e10 /\n"
    "&force law = 'lennard_jones', hamaker = 1e-19, z0 = 0.5e-9 /\n"
    "&loading h0_start = 7e-9, h0_end = -5.5e-9, h0_step = 0.05e-9 /\n"
    "&unloading from = -5.5e-9 /\n")

ADHESIVE = [lennard_jones(sigma) for sigma in (0.0087, 0.87, 8.7, 1000.0)]
REPULSIVE = [exponential(big_lambda) for big_lambda in (1.0, 1e4)]
ALL = ADHESIVE + REPULSIVE
