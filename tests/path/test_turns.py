"""Turns of a curve that is known by values and slopes."""

import numpy as np
import pytest

import snapin


def parabola(x, top, sign):
    return sign * (x - top) ** 2, 2 * sign * (x - top)


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("top", [-0.5, -1e-13, -0.0, 0.0, 1e-13, 0.5])
def test_a_turn_is_in_one_interval_even_where_it_is_a_state_of_the_curve(top, sign):
    x = np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
    value, slope = parabola(x, top, sign)
    assert snapin.turning_intervals(x, value, slope).sum() == 1


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_slope_of_minus_zero_is_one_of_zero(sign):
    x = np.array([-1.0, 0.0, 1.0])
    value, slope = parabola(x, 0.0, sign)
    slope[1] = -0.0
    assert snapin.turning_intervals(x, value, slope).sum() == 1
