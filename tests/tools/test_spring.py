"""Claims about the spring of Fig. 11: where it jumps, where jumps end, and what lies between."""

import numpy as np
import pytest
import snapin
import spring

Z0, HAMAKER = 0.5e-9, 1e-19
# The slope of the Lennard-Jones law is largest where its second derivative vanishes.
STEEPEST = 7.5 ** (1 / 6) * Z0
LARGEST_SLOPE = HAMAKER / (6 * np.pi * Z0**4) * (3 * 7.5 ** (-2 / 3) - 9 * 7.5 ** (-10 / 6))
# Of the field's largest slope: from springs that all but follow the field to the softest.
FRACTIONS = (1e-3, 0.1, 0.6, 0.9999)
# Force, slope, and the range of gaps to look at.
LIBRARY = (*spring.library_force(snapin.lennard_jones(hamaker=HAMAKER, z0=Z0)), 0.6 * Z0, 60 * Z0)
CUBIC = (lambda h: h - h**3, lambda h: 1 - 3 * h**2, -3.0, 3.0)
MORSE = (lambda h: 2 * np.exp(-h) * (np.exp(-h) - 1),
         lambda h: 2 * np.exp(-h) * (1 - 2 * np.exp(-h)), -2.0, 20.0)
FIELDS = {"lennard_jones": LIBRARY, "cubic": CUBIC, "morse": MORSE}


@pytest.mark.parametrize("fraction", FRACTIONS)
@pytest.mark.parametrize("field", FIELDS)
def test_jumps_start_where_the_slope_is_the_stiffness_and_their_ends_bracket_the_starts(
        field, fraction):
    force, slope, nearest, farthest = FIELDS[field]
    stiffness = fraction * slope(np.linspace(nearest, farthest, 200001)).max()
    both = spring.jumps(force, slope, stiffness, nearest, farthest, count=100001)
    assert both.inward.end < both.outward.start < both.inward.start < both.outward.end
    for start, end, rest in both:
        scale = abs(start) + abs(end) + abs(rest)
        assert slope(np.array([start]))[0] == pytest.approx(stiffness, rel=1e-9)
        for gap in (start, end):
            here = force(np.array([gap]))[0] / stiffness
            assert gap - rest == pytest.approx(here, abs=1e-12 * scale)
        # At the end the spring is the stiffer one, so that it stays there.
        assert slope(np.array([end]))[0] < stiffness


@pytest.mark.parametrize("stiffness", [1e-3, 0.2, 0.9, 0.999])
def test_jumps_of_a_cubic_end_at_twice_the_other_side(stiffness):
    # The starts are double roots of a cubic without square term: the third is -2 times these.
    inward, outward = spring.jumps(*CUBIC[:2], stiffness, -3.0, 3.0)
    start = np.sqrt((1 - stiffness) / 3)
    np.testing.assert_allclose([inward.start, inward.end], [start, -2 * start], rtol=1e-9)
    np.testing.assert_allclose([outward.start, outward.end], [-start, 2 * start], rtol=1e-9)
    # The approach jumps with the spring held closer than the retreat.
    assert inward.rest < outward.rest


def test_the_softest_springs_jump_from_the_attraction_alone_and_stiff_ones_not_at_all():
    force, slope, nearest, farthest = LIBRARY
    stiffness = 1e-5 * LARGEST_SLOPE
    inward, outward = spring.jumps(force, slope, stiffness, nearest, farthest)
    assert inward.start == pytest.approx((HAMAKER / (2 * np.pi * stiffness)) ** 0.25, rel=1e-6)
    # And separate at the largest tension.
    assert outward.start == pytest.approx(3 ** (1 / 6) * Z0, rel=1e-4)
    assert slope(np.array([STEEPEST]))[0] == pytest.approx(LARGEST_SLOPE, rel=1e-12)
    assert spring.jumps(force, slope, 1.0001 * LARGEST_SLOPE, nearest, farthest) is None


def test_a_field_that_nothing_stops_is_refused():
    force, slope = spring.library_force(
        snapin.lennard_jones(hamaker=HAMAKER, z0=Z0, part="attractive"))
    with pytest.raises(ValueError, match="1 times"):
        spring.jumps(force, slope, 0.1 * LARGEST_SLOPE, 0.6 * Z0, 60 * Z0)
