"""Claims about the elastic kernel k(r, t) and the quadrature built for it."""

import math

import mpmath
import numpy as np
import pytest
import snapin

# Distances over sums: far (1 is t = 0) and near, down to the last digit of r and t.
RATIOS = np.concatenate(
    [[1.0], 1 - np.logspace(-15, -1, 15), np.logspace(-1, -15, 57), np.linspace(0.02, 0.98, 49)])


def reference(total, distance):
    """Return k as the paper has it, 4/(pi max) K(m), from the exact values of the doubles."""
    total, distance = mpmath.mpf(float(total)), mpmath.mpf(float(distance))
    large, small = (total + distance) / 2, (total - distance) / 2
    return 4 / (mpmath.pi * large) * mpmath.ellipk((small / large) ** 2)


@pytest.mark.parametrize("total", [1.0, 3e-9, 7e6])
def test_kernel_has_thirteen_digits_however_close_t_is_to_r(total):
    """Equation (15)."""
    with mpmath.workdps(40):
        distance = total * RATIOS
        found = snapin.kernel(np.full_like(distance, total), distance)
        errors = [abs(k / reference(total, d) - 1) for k, d in zip(found, distance)]
    assert max(errors) < 1e-13


def test_kernel_less_its_logarithm_is_smooth_through_t_equal_r():
    # At r + t = 1 what is left is 4 ln(4)/pi + O(d^2 ln d), while the kernel grows to 46.
    distance = np.logspace(-15, -8.5, 27)
    ones = np.ones_like(distance)
    a = snapin.kernel_log_coefficient(ones, distance)
    k = snapin.kernel(ones, distance)
    # The kernel is good to 3e-15 at the smallest distance.
    np.testing.assert_allclose(k + a * np.log(distance), 4 * math.log(4) / math.pi, atol=2e-13)


# --- Quadrature


@pytest.mark.parametrize("points", [2, 8, 16, 24])
def test_barycentric_weights_interpolate_polynomials(points):
    rule = snapin.gauss_rule(points)
    at = np.linspace(0.013, 0.991, 37)
    ratio = rule.barycentric / (at[:, None] - rule.x)
    for degree in (0, 1, points - 1):
        found = ratio @ rule.x**degree / ratio.sum(1)
        np.testing.assert_allclose(found, at**degree, atol=1e-13)
