"""Claims about the modules of `base` by themselves: closed forms, and values of mpmath and NumPy.

tests/support/base_values.f90 calls them.
"""

import math
import subprocess

import mpmath
import numpy as np
import pytest
from support.calculus import gauss
from support.processes import HANG


@pytest.fixture(scope="module")
def ask(snapin_path):
    """ask(name, count, *numbers) -> the numbers, or with `text` the lines, that come back."""

    def run(name, count, *values, text=None):
        words = " ".join(repr(value) for each in values for value in np.ravel(each).tolist())
        done = subprocess.run([snapin_path.parent / "base_values"], capture_output=True, text=True,
                              check=True, timeout=HANG,
                              input=f"'{name}' {count}\n{text or words}\n")
        return done.stdout.splitlines() if text or name == "decimal" else np.array(
            done.stdout.split(), float)

    return run


def test_bessel_functions_are_those_of_mpmath(ask):
    x = np.r_[0, np.sort(10 ** np.random.default_rng(1).uniform(-3, 5.9, 400)), 1e6]
    expected = [float(mpmath.besselj(0, value)) for value in x.tolist()]
    # Of a phase of 10^5 and more its last digits are rounding's.
    assert (abs(ask("bessel", x.size, x) - expected) < np.where(x < 1e5, 1e-14, 4e-14)).all()


def test_carlson_s_integral_is_that_of_mpmath_and_has_its_closed_forms(ask):
    x, y, z = 10 ** np.random.default_rng(2).uniform(-6, 6, (3, 100))
    x[0] = 0
    expected = [float(mpmath.elliprf(*triple)) for triple in np.transpose([x, y, z]).tolist()]
    np.testing.assert_allclose(ask("elliptic", 100, x, y, z), expected, rtol=4e-15)
    # R_F(x, x, x) = 1/sqrt(x), R_F(0, y, y) = pi/(2 sqrt(y)).
    np.testing.assert_allclose(ask("elliptic", 2, [4, 0], [4, 9], [4, 9]), [0.5, math.pi / 6],
                               rtol=1e-15)


@pytest.mark.parametrize("numbers", [
    [3.0], [2.0, 2.0, 2.0, 2.0], [1.0, np.nextafter(1.0, 2.0)], [np.nextafter(1.0, 0.0), 1.0, 1.0],
    [1e300, -1e300, 0.0, 5e-324, 1e-300],
    *(10 ** np.random.default_rng(3).uniform(-20, 20, n) for n in (50, 51)),
    np.random.default_rng(4).integers(-3, 4, 40).astype(float)], ids=lambda numbers: len(numbers))
def test_ranks_are_those_of_sorted_numbers(ask, numbers):
    """Exactly: between neighbouring numbers, over many decades, and of numbers that repeat."""
    n = len(numbers)
    *ranked, median = ask("ranks", n, numbers)
    assert ranked == sorted(numbers)
    assert median == sorted(numbers)[(n - 1) // 2]


@pytest.mark.parametrize("n", [1, 2, 5, 12, 40])
def test_rules_are_those_of_numpy_and_a_logarithm_has_its_moments(ask, n):
    x, w, log_w, basis, legendre = ask("quadrature", n).reshape(5, n)
    node, weight = gauss(n)
    np.testing.assert_allclose(x, node, rtol=0, atol=2e-16)
    np.testing.assert_allclose(w, weight, rtol=1e-12)
    powers = x ** np.arange(n)[:, None]
    # The integral of s^k ln(s) is -1/(k + 1)^2.
    moments = -1 / np.arange(1, n + 1) ** 2
    np.testing.assert_allclose(powers @ log_w, moments, rtol=1e-12, atol=1e-13)
    np.testing.assert_allclose(powers @ basis, 0.3 ** np.arange(n), rtol=1e-11, atol=1e-13)
    np.testing.assert_allclose(
        legendre, [float(mpmath.legendre(k, -0.4)) for k in range(n)], rtol=0, atol=1e-14)


def test_waves_are_integrated_however_short_they_are(ask):
    """The integral of exp(-k) cos(k x) is 1/(1 + x^2)."""
    x = np.array([1.0, 3.0, 10.0, 30.0])
    np.testing.assert_allclose(ask("wave", 4, x), 1 / (1 + x**2), rtol=0, atol=1e-11)


def test_a_chebyshev_series_has_value_slope_and_integral_of_its_function(ask):
    value, slope, integral = ask("chebyshev", 25)
    exact = math.exp(0.6)
    assert [value, slope, integral] == pytest.approx(
        [exact, 2 * exact, (exact - math.exp(-2)) / 2], rel=1e-13)


def test_splines_go_through_their_points_and_are_smooth_or_monotone(ask):
    x = np.array([0.0, 0.3, 1.0, 1.4, 2.5, 3.0])
    y = np.array([1.0, 0.2, 0.1, 0.1, -0.5, -2.0])
    width = np.diff(x)
    for number, c in enumerate(ask("cubic", 6, x, y).reshape(2, 5, 4)):
        np.testing.assert_allclose(c[:, 0], y[:-1], atol=1e-15)
        ends = [np.polynomial.polynomial.polyval(w, p) for w, p in zip(width, c)]
        np.testing.assert_allclose(ends, y[1:], atol=1e-14)
        slopes = c[:-1, 1] + 2 * c[:-1, 2] * width[:-1] + 3 * c[:-1, 3] * width[:-1] ** 2
        np.testing.assert_allclose(slopes, c[1:, 1], atol=1e-13)
        if number == 0:
            bends = 2 * c[:-1, 2] + 6 * c[:-1, 3] * width[:-1]
            np.testing.assert_allclose(bends, 2 * c[1:, 2], atol=1e-12)
            assert c[0, 3] == pytest.approx(c[1, 3], rel=1e-12)
            assert c[-1, 1] + 2 * c[-1, 2] * width[-1] + 3 * c[-1, 3] * width[-1] ** 2 == \
                pytest.approx(0, abs=1e-12)
        else:
            within = [np.polynomial.polynomial.polyval(np.linspace(0, w, 50), p)
                      for w, p in zip(width, c)]
            assert max(np.diff(piece).max() for piece in within) <= 1e-15


def test_polynomials_and_hermite_s_are_exact_to_their_degree(ask):
    x = np.array([-0.8, -0.2, 0.1, 0.9])
    cubic = np.polynomial.Polynomial([1.0, -2.0, 0.5, -0.7])
    value, slope, *_ = ask("interpolation", 4, x, cubic(x), cubic.deriv()(x))
    assert [value, slope] == pytest.approx([cubic(0.3), cubic.deriv()(0.3)], rel=1e-13)
    seventh = np.polynomial.Polynomial(np.random.default_rng(3).standard_normal(8))
    *_, value, slope = ask("interpolation", 4, x, seventh(x), seventh.deriv()(x))
    assert [value, slope] == pytest.approx([seventh(0.3), seventh.deriv()(0.3)], rel=1e-12)


@pytest.mark.parametrize(("name", "ends", "root", "most"), [
    ("cosine", (0, 2), 0.7390851332151607, 10), ("cube", (-1, 5), 2 ** (1 / 3), 12),
    ("flat", (0, 1.7), 1.0, 60), ("step", (0, 1), 1 / 3, 60), ("cube", (5, -1), 2 ** (1 / 3), 12)])
def test_roots_are_found_to_rounding_by_few_values(ask, name, ends, root, most):
    found, asked = ask(f"root:{name}", 2, ends)
    assert found == pytest.approx(root, rel=1e-9 if name == "flat" else 5e-16)
    assert asked <= most


def test_a_maximum_is_found_by_golden_sections(ask):
    assert ask("maximum:hump", 2, [0, 3])[0] == pytest.approx(0.7, abs=2e-8)


@pytest.mark.parametrize(("name", "ends", "exact"), [
    ("root", (0, 1), 2 / 3), ("kink", (0, 1), 5 / 18), ("step", (0, 1), 1 / 3),
    ("waves", (0, 1, 3), 1.5 - math.sin(300) / 200)])
def test_integrals_have_all_digits_whatever_the_function(ask, name, ends, exact):
    value, error, _ = ask(f"integral:{name}", len(ends), ends)
    assert value == pytest.approx(exact, rel=1e-14)
    assert abs(value - exact) <= error < 1e-13


def test_linear_systems_and_singular_values_are_numpy_s(ask):
    rng = np.random.default_rng(4)
    middle, beside, right = rng.uniform(2, 3, 9), rng.uniform(-1, 1, 9), rng.uniform(-1, 1, 9)
    matrix = np.diag(middle) + np.diag(beside[1:], 1) + np.diag(beside[1:], -1)
    np.testing.assert_allclose(ask("tridiagonal", 9, middle, beside, right),
                               np.linalg.solve(matrix, right), rtol=1e-13)
    table = rng.standard_normal((6, 4))
    np.testing.assert_allclose(ask("singular", 4, table.T), np.linalg.svd(table)[1], rtol=1e-13)


def test_numbers_are_written_with_all_their_digits(ask):
    rng = np.random.default_rng(5)
    some = rng.standard_normal(300) * 10.0 ** rng.integers(-300, 300, 300)
    some = np.r_[some, 0.0, -0.0, 1.0, 0.1, 1e22, 1e23, 9007199254740993.0, 5e-324,
                 np.finfo(float).max]
    for value, text in zip(some.tolist(), ask("decimal", some.size, some)):
        mantissa, exponent = f"{value:.16E}".split("E")
        assert text == f"{mantissa}E{int(exponent):+04d}"


def test_text_is_made_small_quoted_and_unquoted(ask):
    (line,) = ask("text", 3, text="It's A Test")
    assert line.split("\t") == ["it's a test", "'It''s A Test'", "It's A Test", "0.3"]
