"""A spring in a field of force: start and end of its jumps, as in Fig. 11 of the paper.

One end of the spring is fixed; on the other end acts the force p(h) of a wall at a gap h (positive:
repulsion; negative: attraction). Without force the gap would be h_rest, so that in equilibrium

    stiffness (h - h_rest) = p(h).

Approach and retract change h_rest. At p'(h) = stiffness the equilibrium is lost, since the two
forces change at the same rate. The spring jumps to the next gap at which the forces balance. By the
mean-value theorem p' equals the stiffness once more between start and end of a jump. If p' exceeds
the stiffness on one interval of gaps only, its two ends are the starts, and each jump ends beyond
the start of the other: no gap within the interval is a stable equilibrium.

Forces are functions of arrays of gaps; units are the caller's.
"""

from typing import NamedTuple

import curves
import numpy as np

# Of a walk: steps in one go, growth from one step to the next, and the most goes.
_STEPS, _GROWTH, _GOES = 400, 1.002, 30


class Jump(NamedTuple):
    """A jump: the gaps at its start and its end, and the position of the spring's base."""

    start: float
    end: float
    rest: float


class Jumps(NamedTuple):
    """The jump of the approach and that of the retract."""

    inward: Jump
    outward: Jump


def library_force(law):
    """Return (p, p') of a force law of the library with a pole at gap 0, functions of the gap [m]:
    Pa and Pa/m."""
    import snapin

    def pressure(gap):
        gap = np.atleast_1d(gap)
        # A walk towards contact may pass the pole, where the repulsion has no bound.
        found = np.full(gap.shape, np.inf)
        found[gap > 0] = snapin.force_law(law, gap[gap > 0]).pressure
        return found

    def slope(gap):
        return snapin.force_law(law, np.atleast_1d(gap)).slope

    return pressure, slope


def jumps(force, slope, stiffness, nearest, farthest, count=4000):
    """Return the Jumps of a spring, None if there are none.

    They start between the gaps `nearest` and `farthest`; `count` gaps in between are sampled.
    If the slope exceeds the stiffness on more than one interval, or at either end of the range,
    ValueError is raised.
    """
    gaps = np.linspace(nearest, farthest, count)
    excess = slope(gaps) - stiffness
    crossings = np.flatnonzero((excess[:-1] > 0) != (excess[1:] > 0))
    if crossings.size == 0 and excess[0] <= 0:
        return None
    if crossings.size != 2 or excess[0] > 0:
        raise ValueError(f"the slope passes the stiffness {crossings.size} times in the range")
    outward, inward = (
        _root(lambda gap: slope(gap) - stiffness, gaps[i], gaps[i + 1]) for i in crossings)
    # One step from the start, the spring moves by itself.
    step = 1e-4 * (inward - outward)
    return Jumps(*(
        Jump(start, settle(force, stiffness, rest, start + direction * step, step), rest)
        for start, direction, rest in (
            (inward, -1, rest_position(force, stiffness, inward)),
            (outward, 1, rest_position(force, stiffness, outward)))))


def rest_position(force, stiffness, gap):
    """Return h_rest of a spring in equilibrium at a gap."""
    return gap - _at(force, gap) / stiffness


def settle(force, stiffness, rest, gap, step):
    """Return the gap at which a spring released at `gap` comes to rest, without inertia.

    The spring moves in the direction of the total force; `step` is the length of the first step.
    """
    def net(gaps):
        return force(gaps) - stiffness * (gaps - rest)

    direction = np.sign(_at(net, gap))
    if direction == 0:
        return gap
    for _ in range(_GOES):
        strides = step * _GROWTH ** np.arange(_STEPS)
        walk = gap + direction * np.concatenate([[0], np.cumsum(strides)])
        turned = np.flatnonzero(np.sign(net(walk)) != direction)
        if turned.size:
            return _root(net, *sorted((walk[turned[0] - 1], walk[turned[0]])))
        gap, step = walk[-1], strides[-1] * _GROWTH
    raise ValueError("nothing stops the spring")


def _at(function, gap):
    return float(np.asarray(function(np.array([gap])))[0])


def _root(function, low, high):
    """Return a zero between two gaps at which the signs differ."""
    above = _at(function, high) > 0
    return curves.bisected(lambda gap: (_at(function, gap) > 0) == above, low, high)
