"""Turns of a curve that is known by values and slopes."""

import numpy as np
import pytest

import snapin


@pytest.mark.parametrize("zero", [0.0, -0.0])
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("top", [-0.5, -1e-13, 0.0, 1e-13, 0.5])
def test_a_turn_is_in_one_interval_even_where_it_is_a_state_of_the_curve(top, sign, zero):
    """A slope of minus zero is one of zero."""
    x = np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
    value, slope = sign * (x - top) ** 2, 2 * sign * (x - top)
    slope[slope == 0] = zero
    assert snapin.turning_intervals(x, value, slope).sum() == 1
