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


def of(r, t):
    """Return k(r, t) for arrays."""
    return snapin.kernel(np.add(r, t), np.abs(np.subtract(r, t)))


@pytest.mark.parametrize("total", [1.0, 3e-9, 7e6])
def test_kernel_has_thirteen_digits_however_close_t_is_to_r(total):
    with mpmath.workdps(40):
        distance = total * RATIOS
        found = snapin.kernel(np.full_like(distance, total), distance)
        errors = [abs(k / reference(total, d) - 1) for k, d in zip(found, distance)]
    assert max(errors) < 1e-13


def test_kernel_is_symmetric():
    r, t = np.random.default_rng(1).random((2, 200))
    np.testing.assert_array_equal(of(r, t), of(t, r))


def test_kernel_is_homogeneous_of_degree_minus_one():
    r, t = np.random.default_rng(2).random((2, 200))
    # A power of two scales without rounding.
    np.testing.assert_array_equal(of(8 * r, 8 * t), of(r, t) / 8)
    total, distance = r + t, abs(r - t)
    scaled = snapin.kernel(1e-8 * total, 1e-8 * distance)
    np.testing.assert_allclose(scaled, 1e8 * snapin.kernel(total, distance), rtol=1e-14)


def test_kernel_on_the_axis_is_two_over_t():
    t = np.geomspace(1e-9, 1e9, 50)
    np.testing.assert_allclose(of(np.zeros_like(t), t), 2 / t, rtol=1e-15)


def test_kernel_far_away_is_that_of_a_point_force():
    # k(r, t) = (2/r) (1 + (t/r)^2/4 + ...).
    r = np.array([1e4, 1e6, 1e8])
    np.testing.assert_allclose(of(r, np.ones(3)), 2 / r * (1 + 1 / (4 * r**2)), rtol=4e-15)


def test_kernel_falls_steadily_with_the_distance():
    ratios = np.unique(RATIOS)
    assert (np.diff(snapin.kernel(np.ones_like(ratios), ratios)) < 0).all()


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
