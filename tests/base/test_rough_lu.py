"""Claims about LU factors in single precision: solutions are as good as LAPACK's in this precision,
whatever the number of rows is beside that of a panel; matrices that single precision does not hold
get factors in double precision, and what has no factors is not solved."""

import _snapin
import numpy as np
import pytest

solution = _snapin.flat_numerics.linear_solution
# Below, at and above multiples of the panel's columns, and on either side of the size from which
# LAPACK takes over.
SIZES = [*range(1, 34), 73, 120, 127, 319, 320, 321]


def backward_error(a, b, x):
    """The least relative change of the matrix that makes x the solution (Rigal and Gaches 1967)."""
    return np.abs(a @ x - b).max() / (np.abs(a).sum(axis=1).max() * np.abs(x).max())


def matrices(n, rng):
    """Matrices that need every row exchanged, few exchanged, and rows of very different sizes."""
    yield np.roll(np.eye(n), 1, axis=0) + 1e-3 * rng.standard_normal((n, n))
    yield np.eye(n) + 0.3 * rng.standard_normal((n, n))
    yield rng.standard_normal((n, n)) * 10.0 ** rng.uniform(-8, 8, (n, 1))


@pytest.mark.parametrize("n", SIZES)
def test_solutions_are_as_good_as_those_of_lapack(n):
    rng = np.random.default_rng(n)
    for a in matrices(n, rng):
        b = rng.standard_normal(n) * np.abs(a).max(axis=1)
        x, regular = solution(a, b)
        assert regular
        single = np.linalg.solve(a.astype(np.float32), b.astype(np.float32)).astype(float)
        # Both are some units of rounding; which is smaller is chance.
        assert backward_error(a, b, x) < 10 * (
            backward_error(a, b, single) + n * np.finfo(np.float32).eps)


@pytest.mark.parametrize("size", [1e-60, 1e60])
@pytest.mark.parametrize("n", [1, 9, 73, 330])
def test_what_single_precision_does_not_hold_has_factors_in_double(n, size):
    rng = np.random.default_rng(n)
    a = np.eye(n) + 0.3 * rng.standard_normal((n, n))
    b = rng.standard_normal(n)
    x, regular = solution(size * a, b)
    assert regular
    assert backward_error(size * a, b, x) < 10 * n * np.finfo(float).eps


@pytest.mark.parametrize("n", [1, 5, 8, 9, 73])
def test_a_matrix_without_factors_is_said_to_have_none(n):
    regular = np.eye(n)
    assert solution(regular, np.ones(n))[1]
    for column in (0, n // 2, n - 1):
        broken = regular.copy()
        broken[:, column] = 0
        assert not solution(broken, np.ones(n))[1], column
