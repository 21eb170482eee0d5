"""Claims about the spring of Fig. 11: where it jumps, where jumps end, and what lies between."""

import numpy as np
import pytest
import snapin
import spring

Z0, HAMAKER = 0.5e-9, 1e-19
# The slope of the Lennard-Jones law is largest where its second derivative vanishes.
STEEPEST = 7.5 ** (1 / 6) * Z0
LARGEST_SLOPE = HAMAKER / (6 * np.pi * Z0**4) * (3 * 7.5 ** (-2 / 3) - 9 * 7.5 ** (-10 / 6))


def lennard_jones():
    """Force and slope of the library's law, in SI, and the range of gaps to look at."""
    return *spring.library_force(snapin.lennard_jones(hamaker=HAMAKER, z0=Z0)), 0.6 * Z0, 60 * Z0


def cubic():
    """A field whose jumps have closed forms, largest slope 1."""
    return lambda h: h - h**3, lambda h: 1 - 3 * h**2, -3.0, 3.0


def morse():
    """2 y (y - 1) with y = exp(-h); its largest slope is 1/4."""
    return (lambda h: 2 * np.exp(-h) * (np.exp(-h) - 1),
            lambda h: 2 * np.exp(-h) * (1 - 2 * np.exp(-h)), -2.0, 20.0)


def power_laws(seed):
    """A repulsion and an attraction by two powers of the gap chosen at random, zero at gap 1."""
    far, near = np.sort(np.random.default_rng(seed).uniform(1.5, 14, 2))
    near += 0.5

    def force(h):
        # A walk towards the wall looks beyond it.
        h = np.maximum(h, 1e-3)
        return h**-near - h**-far

    return force, lambda h: far * h ** -(far + 1) - near * h ** -(near + 1), 0.5, 60.0


FIELDS = {"lennard_jones": lennard_jones(), "cubic": cubic(), "morse": morse()}
FIELDS |= {f"power_laws_{seed}": power_laws(seed) for seed in range(8)}
# Places at which a slow cycle rests, on each way.
STEPS = 61
# Of the field's largest slope: from springs that all but follow the field to the softest.
FRACTIONS = (1e-3, 1e-2, 0.1, 0.3, 0.6, 0.9, 0.9999)


def stiffness_of(field, fraction):
    """A stiffness as a fraction of the field's largest slope, found on a grid of gaps."""
    _, slope, nearest, farthest = FIELDS[field]
    return fraction * slope(np.linspace(nearest, farthest, 200001)).max()


def jumps_of(field, fraction):
    """The jumps and the stiffness of the spring."""
    force, slope, nearest, farthest = FIELDS[field]
    stiffness = stiffness_of(field, fraction)
    return spring.jumps(force, slope, stiffness, nearest, farthest, count=100001), stiffness


@pytest.mark.parametrize("fraction", FRACTIONS)
@pytest.mark.parametrize("field", FIELDS)
def test_jump_ends_bracket_jump_starts(field, fraction):
    (inward, outward), _ = jumps_of(field, fraction)
    assert inward.end < outward.start < inward.start < outward.end


@pytest.mark.parametrize("fraction", FRACTIONS)
@pytest.mark.parametrize("field", FIELDS)
def test_jumps_start_where_the_slope_is_the_stiffness_and_end_where_forces_balance(field, fraction):
    force, slope, *_ = FIELDS[field]
    both, stiffness = jumps_of(field, fraction)
    for start, end, rest in both:
        scale = abs(start) + abs(end) + abs(rest)
        assert slope(np.array([start]))[0] == pytest.approx(stiffness, rel=1e-9)
        for gap in (start, end):
            here = force(np.array([gap]))[0] / stiffness
            assert gap - rest == pytest.approx(here, abs=1e-12 * scale)
        # At the end the spring is the stiffer one, so that it stays there.
        assert slope(np.array([end]))[0] < stiffness


@pytest.mark.parametrize("field", FIELDS)
def test_between_start_and_end_of_a_jump_the_mean_slope_is_the_stiffness(field):
    # So that by the mean-value theorem the slope passes the stiffness between them.
    force, *_ = FIELDS[field]
    for fraction in (0.01, 0.5, 0.99):
        both, stiffness = jumps_of(field, fraction)
        for start, end, _ in both:
            rise = np.diff(force(np.array([end, start])))[0]
            assert rise / (start - end) == pytest.approx(stiffness, rel=1e-6)


@pytest.mark.parametrize("fraction", [
    pytest.param(0.05, marks=pytest.mark.long), pytest.param(0.3, marks=pytest.mark.long), 0.8])
@pytest.mark.parametrize("field", FIELDS)
def test_a_slow_cycle_jumps_there_and_never_rests_between_the_starts(field, fraction):
    force, *_ = FIELDS[field]
    (inward, outward), stiffness = jumps_of(field, fraction)
    width = inward.start - outward.start
    away = 0.3 * (inward.rest - outward.rest)
    low, high = sorted((inward.rest, outward.rest))
    rests = np.linspace(low - abs(away), high + abs(away), STEPS)
    gap, visited = outward.end + 10 * width, []
    for rest in np.concatenate([rests[::-1], rests]):
        gap = spring.settle(force, stiffness, rest, gap, 1e-4 * width)
        visited.append(gap)
    visited = np.array(visited)
    inside = (visited > outward.start + 1e-6 * width) & (visited < inward.start - 1e-6 * width)
    assert not inside.any()
    # The approach comes to the inward start and the retreat to the outward one.
    approach, retreat = visited[:STEPS], visited[STEPS:]
    assert approach[approach > inward.start].min() - inward.start < 0.2 * width
    assert outward.start - retreat[retreat < outward.start].max() < 0.2 * width
    assert (np.diff(approach) < 0).all()
    assert (np.diff(retreat) > 0).all()


@pytest.mark.parametrize("stiffness", [1e-3, 0.2, 0.5, 0.9, 0.999])
def test_jumps_of_a_cubic_end_at_twice_the_other_side(stiffness):
    # The starts are double roots of a cubic without square term: the third is -2 times these.
    inward, outward = spring.jumps(cubic()[0], cubic()[1], stiffness, -3.0, 3.0)
    start = np.sqrt((1 - stiffness) / 3)
    np.testing.assert_allclose([inward.start, inward.end], [start, -2 * start], rtol=1e-9)
    np.testing.assert_allclose([outward.start, outward.end], [-start, 2 * start], rtol=1e-9)
    # The approach jumps with the spring held closer than the retreat.
    assert inward.rest < outward.rest


@pytest.mark.parametrize("stiffness", [1e-3, 0.05, 0.2, 0.249])
def test_jumps_in_a_morse_field_start_at_the_roots_of_a_quadratic(stiffness):
    force, slope, nearest, farthest = morse()
    inward, outward = spring.jumps(force, slope, stiffness, nearest, farthest)
    y = (1 + np.array([-1, 1]) * np.sqrt(1 - 4 * stiffness)) / 4
    np.testing.assert_allclose([inward.start, outward.start], -np.log(y), rtol=1e-9)


def test_the_softest_springs_jump_from_the_attraction_alone():
    force, slope, nearest, farthest = lennard_jones()
    stiffness = 1e-5 * LARGEST_SLOPE
    inward, outward = spring.jumps(force, slope, stiffness, nearest, farthest)
    assert inward.start == pytest.approx((HAMAKER / (2 * np.pi * stiffness)) ** 0.25, rel=1e-6)
    # And let go at the largest tension.
    assert outward.start == pytest.approx(3 ** (1 / 6) * Z0, rel=1e-4)


def test_springs_stiffer_than_the_field_do_not_jump():
    force, slope, nearest, farthest = lennard_jones()
    assert slope(np.array([STEEPEST]))[0] == pytest.approx(LARGEST_SLOPE, rel=1e-12)
    assert spring.jumps(force, slope, 1.0001 * LARGEST_SLOPE, nearest, farthest) is None
    inward, outward = spring.jumps(
        force, slope, 0.99999 * LARGEST_SLOPE, nearest, farthest, count=100000)
    assert inward.start == pytest.approx(STEEPEST, rel=5e-3)
    assert outward.start == pytest.approx(STEEPEST, rel=5e-3)


def test_a_field_that_nothing_stops_is_refused():
    force, slope = spring.library_force(
        snapin.lennard_jones(hamaker=HAMAKER, z0=Z0, part="attractive"))
    with pytest.raises(ValueError, match="1 times"):
        spring.jumps(force, slope, 0.1 * LARGEST_SLOPE, 0.6 * Z0, 60 * Z0)
